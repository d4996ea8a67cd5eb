"""Video files of a method's frames: WebM, MP4, preview and video cube."""

from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from app.images.png_writer import encode_png
from app.images.video.cube import VideoCube
from app.images.video.encoding import Encoding
from app.images.video.writers import Frame, Kind, VideoWriter, name_repeated_edges
from app.methods.context import Context
from app.methods.model import Picture, Source
from app.synthesis.arrays import PartDone


class _File(NamedTuple):
    name: str
    title: str
    kind: Kind
    media_type: str


TEXTURE = (
    _File("texture", "Texture", "webm", "video/webm"),
    _File("texture-mp4", "Texture as MP4", "mp4", "video/mp4"),
    _File("preview", "Preview", "webp", "image/webp"),
)
BASE_BYTES, PIXEL_BYTES = 40_000_000, {1: 190, 3: 280}  # of a frame, by its channels; measured at 512² to 2048²
CROP = (_File("crop", "Crop", "webm", "video/webm"), _File("crop-mp4", "Crop as MP4", "mp4", "video/mp4"))


def encoding_bytes(width: int, height: int, channels: int) -> int:
    """Bytes that `encode_texture` needs at its peak, whatever the number of frames."""
    return BASE_BYTES + PIXEL_BYTES[channels] * width * height


def encode_texture(
    frames: Iterable[NDArray[Any]], *, width: int, height: int, channels: int, count: int, rate: float, context: Context
) -> Iterator[Picture]:
    """Write a video texture as WebM, MP4, animated preview and video cube, in one pass over its frames.

    Parameters
    ----------
    frames : iterable of ndarray, shape (H, W, C)
        float32 or uint8, 0 to 255; they are rounded, and what is outside cut off. Nothing of a frame is kept when the
        next is taken. It calls progress itself.
    width, height, channels, count : int
        Of ``frames``.
    rate : float
        Frames a second.
    context : Context
        After the last frame, while the encoders finish, its progress is called with the stage ``encoding``.

    Yields
    ------
    Picture
        ``texture``, ``texture-mp4``, ``preview``, ``cube``. The MP4 of odd sides is larger, and its title says what is
        repeated in it. Left or stopped before, no file and no thread stays.
    """
    size = width, height, channels, count
    cube = VideoCube(*size)
    finishing = partial(context.progress, "encoding")
    yield from _written(_rounded(frames, cube), TEXTURE, size, rate, context.scratch, finishing)
    yield _picture_of(cube, "cube", "Video cube")


def encode_crop(source: Source, context: Context) -> Iterator[Picture]:
    """Write a moving input: ``crop`` (WebM), ``crop-mp4`` and ``crop-cube``; the stage is ``crop``."""
    frames, rate = source.require_clip().frames, source.require_clip().rate
    count, height, width, channels = frames.shape
    size = width, height, channels, count
    cube = VideoCube(*size)

    step = context.during("crop", (("frames", 9), ("encoding", 1)))

    def reported() -> Iterator[Frame]:
        for index, frame in enumerate(frames):
            step("frames", index / count)
            yield frame

    finishing = partial(step, "encoding")
    yield from _written(_rounded(reported(), cube), CROP, size, rate, context.scratch, finishing)
    yield _picture_of(cube, "crop-cube", "Video cube of the crop")


def _rounded(frames: Iterable[NDArray[Any]], cube: VideoCube) -> Iterator[Frame]:
    for frame in frames:
        levels = frame if frame.dtype == np.uint8 else np.clip(np.rint(frame), 0, 255)
        rounded = levels.astype(np.uint8)  # a copy: its maker may use the frame's memory again
        cube.add(rounded)
        yield rounded


def _written(
    frames: Iterable[Frame],
    files: tuple[_File, ...],
    size: tuple[int, int, int, int],
    rate: float,
    scratch: Path,
    finishing: PartDone,
) -> Iterator[Picture]:
    width, height, channels, count = size
    writers: list[VideoWriter] = []
    try:
        for file in files:
            path = scratch / uuid4().hex
            writer = VideoWriter(path, file.kind, width=width, height=height, channels=channels, count=count, rate=rate)
            writers.append(writer)
        with Encoding(writers) as encoding:
            for frame in frames:
                encoding.write(frame)
            encoding.finish(finishing)
        for file in files:
            writer = writers.pop(0)  # whoever takes the picture owns the file
            twice = name_repeated_edges(width, height) if file.kind == "mp4" else ""
            yield Picture(
                file.name,
                f"{file.title}, its {twice} repeated" if twice else file.title,
                writer.width,
                writer.height,
                writer.path,
                kind="texture" if file.name == "texture" else "view",
                media_type=file.media_type,
                frames=writer.frames,
                rate=writer.rate,
            )
    finally:
        for writer in writers:
            writer.close()
            writer.path.unlink(missing_ok=True)


def _picture_of(cube: VideoCube, name: str, title: str) -> Picture:
    picture = cube.draw()
    height, width, _ = picture.shape
    return Picture(name, title, width, height, encode_png(picture))
