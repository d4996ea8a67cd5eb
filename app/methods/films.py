"""From a method's frames to its files."""

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from app.images.png import encode_png
from app.images.video.cube import VideoCube
from app.images.video.encoding import Encoding
from app.images.video.writers import FilmWriter, Frame, Kind
from app.methods.model import Context, Picture, Source


class _File(NamedTuple):
    """A file of a film."""

    name: str
    title: str
    kind: Kind
    media_type: str


TEXTURE = (
    _File("texture", "Texture", "webm", "video/webm"),
    _File("texture-mp4", "Texture, as MP4", "mp4", "video/mp4"),
    _File("preview", "Preview", "webp", "image/webp"),
)
CROP = (_File("crop", "Crop", "webm", "video/webm"), _File("crop-mp4", "Crop, as MP4", "mp4", "video/mp4"))


def texture_film(
    frames: Iterable[NDArray[Any]], *, width: int, height: int, channels: int, count: int, rate: float, context: Context
) -> Iterator[Picture]:
    """Write a video texture: WebM, MP4, animated preview and video cube, in one pass over its frames.

    Parameters
    ----------
    frames : iterable of ndarray, shape (H, W, C)
        float32 or uint8, 0 to 255; values outside are cut off. Nothing of a frame is kept when the next is asked for.
        Where making them takes time, ``frames`` itself calls progress.
    width, height, channels, count : int
        What ``frames`` gives.
    rate : float
        Frames a second.
    context : Context
        Its progress is called after the last frame, while the encoders finish: stage ``encoding``, 0 to 1. So give
        ``dataclasses.replace(context, progress=context.between(…))``.

    Yields
    ------
    Picture
        ``texture``, ``texture-mp4``, ``preview``, ``cube``. Stopped before, it leaves no file and no thread behind.
    """
    cube = VideoCube(width, height, channels, count)
    yield from _written(_rounded(frames, cube), TEXTURE, (width, height, channels, count), rate, context)
    yield _cube_picture("cube", "Video cube", cube)


def crop_film(source: Source, context: Context) -> Iterator[Picture]:
    """Write a moving input: ``crop`` (WebM), ``crop-mp4`` and ``crop-cube``; stage ``crop``, 0 to 1."""
    assert source.film is not None
    frames, rate = source.film.frames, source.film.rate
    count, height, width, channels = frames.shape
    cube = VideoCube(width, height, channels, count)

    def reported() -> Iterator[Frame]:
        for index, frame in enumerate(frames):
            context.progress("crop", index / count)
            yield frame

    yield from _written(_rounded(reported(), cube), CROP, (width, height, channels, count), rate, context, "crop")
    yield _cube_picture("crop-cube", "Video cube of the crop", cube)


def _written(
    frames: Iterable[Frame],
    files: tuple[_File, ...],
    size: tuple[int, int, int, int],
    rate: float,
    context: Context,
    stage: str = "encoding",
) -> Iterator[Picture]:
    width, height, channels, count = size
    writers: list[FilmWriter] = []
    try:
        for file in files:
            path = context.scratch / uuid4().hex
            writers.append(
                FilmWriter(path, file.kind, width=width, height=height, channels=channels, count=count, rate=rate)
            )
        with Encoding(writers) as encoding:
            for frame in frames:
                encoding.write(frame)
            encoding.finish(lambda part: context.progress(stage, part))
        for file in files:
            written = writers.pop(0)  # who takes the picture owns its file
            yield Picture(
                file.name,
                file.title,
                written.width,
                written.height,
                written.path,
                kind="texture" if file.name == "texture" else "view",
                media_type=file.media_type,
                frames=count,
                rate=rate,
            )
    finally:
        for writer in writers:
            writer.close()
            writer.path.unlink(missing_ok=True)


def _rounded(frames: Iterable[NDArray[Any]], cube: VideoCube) -> Iterator[Frame]:
    for frame in frames:
        values = frame if frame.dtype == np.uint8 else np.clip(np.rint(frame), 0, 255)
        rounded = values.astype(np.uint8)
        cube.add(rounded)
        yield rounded


def _cube_picture(name: str, title: str, cube: VideoCube) -> Picture:
    picture = cube.picture()
    return Picture(name, title, picture.shape[1], picture.shape[0], encode_png(picture))
