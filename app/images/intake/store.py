"""Storage format of uploads: a PNG file of the pixels alone, without metadata; of a video a frame stack."""

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np

from app.images.decode import Decoded, Limits, read
from app.images.formats.clip import ClipStream
from app.images.media import Media
from app.images.png_writer import Pixels, PngWriter

STRIP_ROWS, STRIP_PIXELS = 64, 1 << 16  # small strips: a crop is read by strips
THREADS, WAITING = 2, 4


def store(path: Path, destination: Path, limits: Limits) -> Media:
    """Decode an uploaded file and write it as PNG.

    Of a video, whose file is a frame stack (`app.images.stored_video`), only a few frames are in memory at a time.

    Parameters
    ----------
    path : Path
        The upload.
    destination : Path
        The PNG file, which is overwritten.
    limits : Limits

    Returns
    -------
    Media
        Properties of the picture or video that is stored.

    Raises
    ------
    UnsupportedFormatError, BrokenFileError, TooLargeError
        As `app.images.decode.read`.
    """
    found = read(path, limits)
    if isinstance(found, ClipStream):
        return _store_clip(found, destination)
    destination.write_bytes(encode_picture(found))
    return found


def encode_picture(picture: Decoded) -> bytes:
    """Encode a picture as PNG: grey or RGB, with an alpha channel if a pixel is not opaque, and without metadata."""
    height, width, channels = picture.pixels.shape
    writer = PngWriter(width, height, channels + (picture.alpha is not None), picture.depth)
    rows = _rows(width)
    for y in range(0, height, rows):
        strip = picture.pixels[y : y + rows]
        if picture.alpha is not None:
            strip = np.concatenate([strip, picture.alpha[y : y + rows, :, None]], axis=2)
        writer.write(y, strip)
    return writer.finish()


def _store_clip(clip: ClipStream, destination: Path) -> Media:
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
    return clip.media(times)


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
