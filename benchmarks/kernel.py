"""Time and memory of the synthesis: ``python -m benchmarks.kernel``.

Every figure is a ratio of two things timed in turn in one run, with two threads, RGB and float32. *Pair* is the bare
`scipy.fft` real forward and inverse transforms of the texture's size and channels.
"""

import argparse
import subprocess
import sys
from collections.abc import Callable
from functools import partial

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from app.images.png_writer import PngWriter
from app.methods.context import Context
from app.methods.model import Source
from app.methods.registry import method
from app.synthesis.fourier.periodic import periodic_component, periodic_spectrum
from app.synthesis.gaussian.adsn import adsn_field
from app.synthesis.gaussian.rpn import rpn_field
from app.synthesis.parallel import Team
from app.synthesis.sinks import Levels
from benchmarks.timing import Ratio, alternate

THREADS = 2
MEGABYTE = 1_000_000
MEMORY_AIM = 300  # MB

Real = NDArray[np.float32]


def sample(side: int) -> Real:
    """A sample with the spectrum of a photograph's texture, 0–255."""
    white = np.random.default_rng(0).standard_normal((side, side, 3), np.float32)
    k = np.hypot(scipy.fft.fftfreq(side)[:, None], scipy.fft.rfftfreq(side)[None, :])[:, :, None]
    coloured = scipy.fft.irfft2(scipy.fft.rfft2(white, axes=(0, 1)) / (k + 2 / side), s=(side, side), axes=(0, 1))
    image: Real = np.round(128 + 30 * coloured / coloured.std()).clip(0, 255).astype(np.float32)
    return image


def pair(planes: Real) -> None:
    """The yardstick: real transforms of (C, H, W) forward and back."""
    spectrum = scipy.fft.rfft2(planes, workers=THREADS)
    scipy.fft.irfft2(spectrum, s=planes.shape[1:], overwrite_x=True, workers=THREADS)


def write(h: Real, side: int, rows: Callable[[int, NDArray[np.unsignedinteger]], None], rayleigh: bool) -> None:
    """RPN or ADSN of a sample as rows of bytes."""
    with Team(THREADS) as team:
        field = (adsn_field if rayleigh else rpn_field)(h, side, side, team=team, seed=1)
        field.randomise().emit(Levels(rows, 3, 0, 255, 255))


def to_array(h: Real, side: int, rayleigh: bool = False) -> NDArray[np.uint8]:
    """RPN or ADSN as an array of bytes."""
    texture = np.empty((side, side, 3), np.uint8)

    def rows(first: int, block: NDArray[np.unsignedinteger]) -> None:
        texture[first : first + len(block)] = block

    write(h, side, rows, rayleigh)
    return texture


def to_png(h: Real, side: int) -> bytes:
    """RPN as a PNG file."""
    writer = PngWriter(side, side, 3, 8)
    write(h, side, writer.write, False)
    return writer.finish()


def above_idle(work: Callable[[], object]) -> int:
    """Bytes that this process takes at most for some work, above what it holds before."""
    to_array(sample(512), 600)  # loads what is loaded once
    before = _status("VmRSS")
    with open("/proc/self/clear_refs", "w") as file:  # noqa: PTH123 - not a file but a switch: resets the peak
        file.write("5")
    work()
    return _status("VmHWM") - before


def all_outputs(side: int) -> Callable[[], None]:
    """Prepare RPN of this size with every picture."""
    rpn, source = method("rpn"), Source(sample(512), 255)
    context = Context(8, THREADS, lambda stage, fraction: None)

    def run() -> None:
        for _ in rpn.pictures([source], rpn.params(width=side, height=side), context):
            pass

    return run


def _status(field: str) -> int:
    with open("/proc/self/status") as file:  # noqa: PTH123 - not a file but a question to the kernel
        line = next(line for line in file if line.startswith(field))
    return int(line.split()[1]) * 1024


def _line(name: str, aim: float | None, ratio: Ratio) -> None:
    aim_text = "–" if aim is None else f"≤ {aim:.2f}"
    verdict = "" if aim is None else "ok" if ratio.median <= aim else "MISSED"
    print(
        f"{name:44} {ratio.median:7.2f}  {ratio.least:5.2f}–{ratio.greatest:5.2f}  {aim_text:7} {verdict:7}"
        f"{ratio.first * 1e3:8.1f} ÷ {ratio.second * 1e3:6.1f} ms",
        flush=True,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=15, help="timings of each at 1024²; fewer at larger sizes")
    parser.add_argument("--memory-of", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.memory_of:
        print(above_idle(all_outputs(options.memory_of)))
        return
    rounds = {1024: options.rounds, 2048: max(3, options.rounds * 2 // 3), 4096: max(3, options.rounds // 2)}
    print(f"{THREADS} threads, RGB, float32; ratio: median, least–greatest over the rounds; aim; median times")
    planes = {side: np.random.default_rng(1).random((3, side, side), np.float32) for side in rounds}
    h = sample(512)
    for side, aim in {1024: 2.2, 2048: 0.9, 4096: 0.7}.items():
        ratio = alternate(partial(to_array, h, side), partial(pair, planes[side]), rounds[side])
        _line(f"RPN 512² → {side}², array ÷ pair", aim, ratio)
    for side in (1024, 2048):
        ratio = alternate(partial(to_array, sample(side), side), partial(pair, planes[side]), rounds[side])
        _line(f"RPN {side}² → {side}², array ÷ pair", 1.1, ratio)
    for side, count in rounds.items():
        ratio = alternate(partial(to_array, h, side, True), partial(to_array, h, side), count)
        _line(f"ADSN ÷ RPN, 512² → {side}², array", 1.5, ratio)
    for side, png_aim in {1024: None, 2048: 1.1, 4096: 1.0}.items():
        ratio = alternate(partial(to_png, h, side), partial(pair, planes[side]), rounds[side])
        _line(f"RPN 512² → {side}², PNG ÷ pair", png_aim, ratio)
    for side in (512, 1024):
        image, single = sample(side), planes[1024][:, :side, :side].copy()
        _line(
            f"periodic component {side}² ÷ pair",
            None,
            alternate(partial(periodic_component, image, THREADS), partial(pair, single), rounds[1024]),
        )
        _line(
            f"periodic spectrum {side}² ÷ pair",
            None,
            alternate(partial(periodic_spectrum, image, THREADS), partial(pair, single), rounds[1024]),
        )
    for side in (1024, 4096):
        command = [sys.executable, "-m", "benchmarks.kernel", "--memory-of", str(side)]
        above = int(subprocess.run(command, check=True, capture_output=True, text=True).stdout) / MEGABYTE
        verdict = "ok" if above <= MEMORY_AIM else "MISSED"
        aim_text = f"≤ {MEMORY_AIM}  {verdict}" if side == 4096 else "–"
        print(f"{f'peak memory, {side}², every picture, MB above idle':51} {above:6.0f}           {aim_text}")


if __name__ == "__main__":
    main()
