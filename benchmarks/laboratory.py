"""Time and memory of the laboratory's methods: ``python -m benchmarks.laboratory``.

A method's whole texture, PNG included, is timed in turn with its floor: the bare transforms, or for Efros–Leung the
bare matrix product, that its algorithm cannot do without. Two threads, RGB, float32.
"""

import argparse
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from app.methods.context import Context
from app.methods.model import Source
from app.methods.registry import method
from benchmarks.kernel import MEGABYTE, THREADS, above_idle, sample
from benchmarks.timing import alternate

Real = NDArray[np.float32]


def transforms(side: int, forward: int, inverse: int) -> Callable[[], None]:
    """Real transforms of RGB images: so many forward, so many back."""
    planes = np.random.default_rng(1).random((3, side, side), np.float32)
    spectrum = scipy.fft.rfft2(planes, workers=THREADS)

    def work() -> None:
        for _ in range(forward):
            scipy.fft.rfft2(planes, workers=THREADS)
        for _ in range(inverse):
            scipy.fft.irfft2(spectrum, s=(side, side), workers=THREADS)

    return work


def product(pixels: int, positions: int, window: int) -> Callable[[], None]:
    """The scalar products of as many windows of RGB pixels with those at every position, in slices."""
    rng = np.random.default_rng(1)
    windows = rng.random((256, window * window * 3), np.float32)
    patches = rng.random((window * window * 3, positions), np.float32)

    def work() -> None:
        for _ in range(pixels // len(windows)):
            windows @ patches

    return work


@dataclass(frozen=True)
class Case:
    """A method on crops of so many pixels, and its floor in words and as work."""

    name: str
    crop: int
    parameters: dict[str, Any]
    floor: str
    prepare: Callable[[], Callable[[], None]]  # its data are made when it is timed, not where memory is measured
    rounds: int = 7
    everything: bool = False  # every picture, not the texture alone

    def job(self) -> Callable[[], None]:
        """What makes the pictures of crops that are there already."""
        entry = method(self.name)
        sources = [Source(np.roll(sample(self.crop), 31 * number, 1), 255) for number in range(len(entry.inputs))]
        params = entry.params(**self.parameters)

        def run() -> None:
            pictures = entry.pictures(sources, params, Context(8, THREADS, lambda stage, fraction: None))
            if self.everything:
                for _ in pictures:
                    pass
            else:
                next(pictures)

        return run


def cases() -> dict[str, Case]:
    """What is measured, by its title."""
    one = "one pair of transforms"
    pair = partial(transforms, 1024, 1, 1)
    many = {"order": 10**7}
    large, small = {"width": 1024, "height": 1024}, {"width": 128, "height": 128}
    search = partial(product, 128**2, 96**2, 9)
    return {
        "heeger-bergen 512²": Case("heeger-bergen", 512, {}, one, partial(transforms, 512, 1, 1), 5),
        "efros-leung 96² → 128²": Case("efros-leung", 96, small, "one pass as a matrix product", search, 3),
        "dsn 1024², n = 10": Case("dsn", 1024, {"order": 10}, one, pair),
        "dsn 1024², n = 10⁷": Case("dsn", 1024, many, one, pair),
        "dsn 512² → 1024², n = 10⁷": Case("dsn", 512, large | many, one, pair),
        "mix 512²": Case("mix", 512, {}, "transforms of 2 samples, 1 texture", partial(transforms, 512, 2, 1)),
        "mix 512², strip of 8": Case(
            "mix", 512, {}, "transforms of 2 samples, 9 textures", partial(transforms, 512, 2, 9), 7, True
        ),
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--memory-of", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.memory_of:
        print(above_idle(cases()[options.memory_of].job()))
        return
    print(f"{THREADS} threads, RGB; ratio to the floor: median, least–greatest; median times; peak memory above idle")
    for title, case in cases().items():
        ratio = alternate(case.job(), case.prepare(), case.rounds)
        command = [sys.executable, "-m", "benchmarks.laboratory", "--memory-of", title]
        memory = int(subprocess.run(command, check=True, capture_output=True, text=True).stdout) / MEGABYTE
        print(
            f"{title:28}{ratio.median:8.1f}  {ratio.least:6.1f}–{ratio.greatest:<6.1f} {case.floor:40}"
            f"{ratio.first * 1e3:9.0f} ÷ {ratio.second * 1e3:6.0f} ms {memory:6.0f} MB",
            flush=True,
        )


if __name__ == "__main__":
    main()
