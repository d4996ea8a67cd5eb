"""Time and memory of patchwork and the video methods: ``python -m benchmarks.patchwork``.

Stills are timed in turn with what numpy takes to copy and scale as many float32 values nine times; videos, from their
clip to WebM, MP4, preview and cube, with writing those files from existing frames. Two threads, RGB.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.images.decode import Limits, decode
from app.images.video.reader import read_video
from app.methods.context import Context
from app.methods.model import Clip, Picture, Source
from app.methods.output.videos import encode_texture
from app.methods.registry import method
from app.settings import ROOT
from app.synthesis.patchwork.patchwork import patchwork
from benchmarks.kernel import MEGABYTE, THREADS, above_idle, sample
from benchmarks.timing import Ratio, alternate

CLIP = ROOT / "samples" / "sand_under_water.mp4"
COPIES = 9
AIM = 12.0  # times the copies
FILES = 4  # that are a video texture: WebM, MP4, preview, cube
VIDEOS = ("video-rpn", "video-patchwork", "video-transfer")


def copies(side: int) -> Callable[[], None]:
    """The yardstick of stills."""
    values = np.random.default_rng(1).random((3, side, side), np.float32)
    target = np.empty_like(values)

    def work() -> None:
        for _ in range(COPIES):
            np.multiply(values, np.float32(0.9), out=target)

    return work


def still(name: str, side: int, crop: int, **parameters: Any) -> Callable[[], object]:
    """A method's texture as PNG."""
    entry = method(name)
    sources = [Source(sample(size), 255) for size in ([crop, side] if name == "transfer" else [crop])]
    params = entry.params(width=side, height=side, **parameters)
    return lambda: next(entry.pictures(sources, params, Context(8, THREADS, lambda stage, fraction: None)))


@cache
def clip() -> Source:
    """The bundled clip of water."""
    found = decode(CLIP, Limits())
    frames = found.pixels.reshape(found.frames, found.height, -1, 3)
    return Source(frames[0].astype(np.float32), 255, Clip(frames, found.rate))


@contextmanager
def scratch() -> Iterator[Context]:
    """A context whose files are gone afterwards."""
    with tempfile.TemporaryDirectory() as directory:
        yield Context(8, THREADS, lambda stage, fraction: None, Path(directory))


def pictures(name: str, frames: int, context: Context) -> Iterator[Picture]:
    """Run a video method on the clip; the pattern, where it takes one, is a still of noise."""
    entry = method(name)
    sources = [clip(), Source(sample(320), 255)][: len(entry.inputs)]
    params = entry.params.model_validate({"width": 320, "height": 320, "frames": frames})
    return entry.pictures(sources, params, context)


def video(name: str, frames: int) -> Callable[[], None]:
    """Run a video method from its clip to its files."""

    def run() -> None:
        with scratch() as context:
            for _ in islice(pictures(name, frames, context), FILES):
                pass

    return run


def make_frames(name: str, frames: int) -> NDArray[np.uint8]:
    """The frames that a video method makes."""
    with scratch() as context:
        texture = next(pictures(name, frames, context))
        assert isinstance(texture.data, Path)
        return np.stack(list(read_video(texture.data)))


def written(frames: NDArray[np.uint8]) -> Callable[[], None]:
    """The yardstick of videos: the same files of frames that are there."""
    count, height, width, channels = frames.shape

    def run() -> None:
        with scratch() as context:
            size = {"width": width, "height": height, "channels": channels}
            for _ in encode_texture(frames, **size, count=count, rate=24.0, context=context):
                pass

    return run


def memory(*case: str) -> float:
    """Peak megabytes of a case above idle, in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.patchwork", "--memory-of", *case]
    return int(subprocess.run(command, check=True, capture_output=True, text=True).stdout) / MEGABYTE


def line(name: str, ratio: Ratio, pixels: int, megabytes: str, aim: float | None = None) -> None:
    """Print one line of the table."""
    aim_text = "–" if aim is None else f"≤ {aim:g}"
    verdict = "" if aim is None else "ok" if ratio.median <= aim else "MISSED"
    print(
        f"{name:44} {ratio.median:7.2f}  {ratio.least:5.2f}–{ratio.greatest:5.2f}  {aim_text:7} {verdict:7}"
        f"{ratio.first * 1e3:8.0f} ÷ {ratio.second * 1e3:6.0f} ms {pixels / ratio.first / 1e6:7.2f} MP/s  {megabytes}",
        flush=True,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--memory-of", nargs=2, metavar=("METHOD", "SIZE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.memory_of:
        name, size = options.memory_of[0], int(options.memory_of[1])
        print(above_idle(video(name, size) if name in VIDEOS else still(name, size, 512)))
        return
    print(f"{THREADS} threads, RGB; ratio: median, least–greatest; aim; median times; speed; peak memory above idle")
    arrays = partial(patchwork, sample(512), 2048, 2048, seed=1, threads=THREADS)
    line(
        f"patchwork 512² → 2048², array ÷ {COPIES} copies",
        alternate(arrays, copies(2048), options.rounds),
        2048**2,
        "",
        AIM,
    )
    for side in (1024, 2048, 4096):
        ratio = alternate(still("patchwork", side, 512), copies(side), options.rounds)
        line(
            f"patchwork 512² → {side}², PNG ÷ {COPIES} copies",
            ratio,
            side**2,
            f"{memory('patchwork', str(side)):.0f} MB",
        )
    for grid in (16, 32):
        ratio = alternate(still("patchwork", 1024, 512, grid=grid), copies(1024), options.rounds)
        line(f"patchwork 512² → 1024², grid {grid}, PNG", ratio, 1024**2, "")
    ratio = alternate(still("transfer", 512, 512), copies(512), options.rounds)
    line(f"transfer of 512² onto 512², PNG ÷ {COPIES} copies", ratio, 512**2, f"{memory('transfer', '512'):.0f} MB")
    for name in VIDEOS:
        frames = make_frames(name, 72)
        ratio = alternate(video(name, 72), written(frames), max(2, options.rounds // 2))
        needs = f"{memory(name, '72'):.0f} MB, 288 frames {memory(name, '288'):.0f} MB"
        line(f"{name} 320², 72 frames ÷ its files alone", ratio, 72 * 320**2, needs)


if __name__ == "__main__":
    main()
