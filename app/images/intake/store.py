"""Keeping an upload: its pixels, and nothing else of it, go into a PNG file; a video's frames as a frame stack."""

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.images.decode import STILL, Decoded, Limits, read
from app.images.formats.clip import Clip, rate_of
from app.images.png_writer import Pixels, PngWriter

STRIP_ROWS, STRIP_PIXELS = 64, 1 << 16  # small strips: a crop is read by strips
THREADS, WAITING = 2, 4


@dataclass(frozen=True)
class Kept:
    """What is in the file: a picture, upright, in sRGB, without metadata.

    It is a PNG file of ``depth`` (8 or 16) bits; ``channels`` counts colour channels, 1 or 3; if ``transparent``, an
    alpha channel follows them. A video has several ``frames``, ``rate`` of them a second, each of ``width`` ×
    ``height`` pixels, in a frame stack (`app.images.stored_video`); ``media_type`` is what it was, ``image/png`` for a
    still.
    """

    width: int
    height: int
    channels: int
    depth: int
    transparent: bool
    frames: int = 1
    rate: float = 0.0
    media_type: str = STILL


def store(path: Path, destination: Path, limits: Limits) -> Kept:
    """Decode an uploaded file and write it as PNG; of a video only a few frames are in memory at a time.

    Raises
    ------
    UnsupportedFormatError, BrokenFileError, TooLargeError
        As `app.images.decode.read`.
    """
    found = read(path, limits)
    if isinstance(found, Clip):
        return _store_clip(found, destination)
    destination.write_bytes(to_png(found))
    height, width, channels = found.pixels.shape
    return Kept(width, height, channels, found.depth, found.alpha is not None)


def to_png(picture: Decoded) -> bytes:
    """Write a picture as PNG: grey or RGB, with an alpha channel if a pixel is not opaque, and no metadata."""
    height, width, channels = picture.pixels.shape
    writer = PngWriter(width, height, channels + (picture.alpha is not None), picture.depth)
    rows = _rows(width)
    for y in range(0, height, rows):
        strip = picture.pixels[y : y + rows]
        if picture.alpha is not None:
            strip = np.concatenate([strip, picture.alpha[y : y + rows, :, None]], axis=2)
        writer.write(y, strip)
    return writer.finish()


def _store_clip(clip: Clip, destination: Path) -> Kept:
    writer = PngWriter(clip.width, None, clip.channels, 8)
    times: list[float] = []
    waiting: deque[Future[None]] = deque()
    with ThreadPoolExecutor(THREADS) as pool:
        for pixels, seconds in clip.frames:
            waiting.append(_submit(pool, writer, len(times) * clip.height, pixels))
            times.append(seconds)
            if len(waiting) > WAITING:
                waiting.popleft().result()
        for written in waiting:
            written.result()
    writer.save(destination)
    return Kept(
        clip.width,
        clip.height,
        clip.channels - 1 + clip.channels % 2,
        8,
        clip.channels % 2 == 0,
        len(times),
        rate_of(times, clip.said_rate),
        clip.media_type if len(times) > 1 else STILL,
    )


def _submit(pool: ThreadPoolExecutor, writer: PngWriter, y: int, frame: Pixels) -> Future[None]:
    try:
        return pool.submit(_write, writer, y, frame)
    except RuntimeError as error:  # "can't start new thread": there is no memory for its stack
        raise MemoryError from error


def _write(writer: PngWriter, y: int, frame: Pixels) -> None:
    rows = _rows(writer.width)
    for top in range(0, len(frame), rows):
        writer.write(y + top, frame[top : top + rows])


def _rows(width: int) -> int:
    return max(STRIP_ROWS, STRIP_PIXELS // width)
