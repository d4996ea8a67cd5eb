"""Renditions: cached files made from stored ones, for browsers to show and people to download."""

import hashlib
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Literal, TypeVar

from app import threads
from app.errors import InvalidInputError, NotFoundError
from app.experiments.files.cache import FileCache, KeptFiles, NotKeptError
from app.experiments.files.versions import CONVERTER
from app.experiments.model import Output, Sample, check_frame
from app.experiments.ports import BlobStore
from app.images.convert import (
    PREVIEW,
    THUMBNAIL,
    Format,
    flatten,
    read_depth,
)
from app.images.intake.making import make
from app.images.png_writer import encode_png
from app.images.stored_video import read_frame
from app.images.video.reader import read_first_frame
from app.images.video.writers import write_video

VideoFormat = Literal["mp4", "webm"]
DEEP_FORMATS = ("png", "tiff")
SIZES = (256, 512, 1024, 2048)
PREVIEW_NAME = ".preview"
THUMBNAIL_NAMES = (".thumbnail-crop", ".thumbnail-texture")
POSTERS = {"crop": ".poster-crop", "texture": ".poster-texture"}
DERIVED = {
    PREVIEW_NAME: "Preview",
    **dict.fromkeys(THUMBNAIL_NAMES, "Thumbnail"),
    **dict.fromkeys(POSTERS.values(), "First frame"),
}
PNG = "image/png"
_Result = TypeVar("_Result")


class Renditions:
    """Renditions of samples and conversions of outputs, under the digest of what they were made from."""

    def __init__(self, blobs: BlobStore, cache: FileCache | KeptFiles) -> None:
        self._blobs = blobs
        self._cache = cache

    @property
    def kept(self) -> "Renditions":
        """Those that are made already: it raises `NotKeptError` instead of making one."""
        assert isinstance(self._cache, FileCache)
        return Renditions(self._blobs, KeptFiles(self._cache))

    def image(self, sample: Sample, size: int | None, frame: int = 0) -> tuple[Path, str]:
        """Make a picture, of a video one frame, that browsers show: as it is stored, or smaller; and its media type.

        A smaller one's longer side is at most the next of 256, 512, 1024 and 2048 pixels.

        Raises
        ------
        InvalidInputError
            If there is no such frame.
        """
        check_frame(sample, frame)
        if size is None:
            return self._still(sample, frame), PNG
        bound = rendition_bound(size)
        media_type = PNG if sample.transparent else "image/jpeg"
        name = f"{_part(sample, frame)}-{bound}-{CONVERTER}.{media_type.removeprefix('image/')}"
        return self._cache.file(
            name, lambda path: make("rendition", [self._still(sample, frame)], [path], longest_side=bound)
        ), media_type

    def _still(self, sample: Sample, frame: int) -> Path:
        stored = self._blobs.path(sample.digest)
        if not sample.moving:
            return stored
        name = f"{_part(sample, frame)}-{CONVERTER}.png"
        return self._cache.get(name, lambda: encode_png(read_frame(stored, frame, sample.width, sample.height)))

    def video(self, sample: Sample, file_format: VideoFormat) -> tuple[Path, str]:
        """Make a file that plays of a video, and its media type.

        MP4 plays everywhere. WebM has the pixels exactly as they are stored, if the video is not too long for that (see
        `app.images.video.writers`). Pixels that are not opaque lie on mid-grey.

        Raises
        ------
        NotFoundError
            If the sample is a still picture.
        """
        if not sample.moving:
            raise NotFoundError("This sample is a still picture: nothing of it plays; take its image instead.")
        stored = self._blobs.path(sample.digest)

        def write(path: Path) -> None:
            pictures = (read_frame(stored, frame, sample.width, sample.height) for frame in range(sample.frames))
            write_video(map(flatten, pictures), path, file_format, count=sample.frames, rate=sample.rate)

        name = f"{sample.digest}-{sample.height}-{sample.rate:g}-{CONVERTER}.{file_format}"
        return self._cache.file(name, write), f"video/{file_format}"

    def convert(self, output: Output, file_format: Format, depth: Literal[8, 16] | None = None) -> tuple[Path, str]:
        """Convert a picture to this format, to 8 bits where those are asked for; its file and media type."""
        stored = self._blobs.path(output.digest)
        media_type = f"image/{file_format}"
        narrowed: Literal[8] | None = 8 if depth == 8 and read_depth(stored) == 16 else None
        if output.media_type == media_type and not narrowed:
            return stored, media_type
        name = f"{output.digest}{'-8' if narrowed else ''}-{CONVERTER}.{file_format}"
        return self._cache.file(
            name, lambda path: make("convert", [stored], [path], file_format=file_format, depth=narrowed)
        ), media_type

    def derive(self, name: str, crop: Output, texture: Output) -> tuple[Output, Path]:
        """Make one of the pictures that stand for an experiment in lists and elsewhere.

        Of a video it shows the first frame.
        """
        if name in POSTERS.values():
            return self._poster(name, crop, texture)
        stored = self._picture(crop), self._picture(texture)

        begin = f"{texture.digest}-{crop.digest}-{CONVERTER}"
        if name == PREVIEW_NAME:
            path = self._cache.file(begin + name, lambda path: make("preview", stored, [path]))
            media_type = "image/jpeg"
        else:

            def both(path: Path) -> None:
                with tempfile.TemporaryDirectory() as directory:
                    made = [Path(directory, each) for each in THUMBNAIL_NAMES]
                    make("thumbnails", stored, made)
                    for each, file in zip(THUMBNAIL_NAMES, made, strict=True):
                        if each != name:
                            self._cache.get(begin + each, file.read_bytes)  # a browser asks for it next
                        else:
                            path.write_bytes(file.read_bytes())

            path, media_type = self._cache.file(begin + name, both), "image/webp"
        width, height = PREVIEW if name == PREVIEW_NAME else _thumbnail_size(name, crop, texture)
        size, digest = path.stat().st_size, derived_digest(name, crop, texture)
        return Output(name, DERIVED[name], width, height, media_type=media_type, bytes=size, digest=digest), path

    def _poster(self, name: str, crop: Output, texture: Output) -> tuple[Output, Path]:
        output = crop if name == POSTERS["crop"] else texture
        path = self._picture(output)
        size, digest = path.stat().st_size, derived_digest(name, crop, texture)
        return Output(name, DERIVED[name], output.width, output.height, bytes=size, digest=digest), path

    def _picture(self, output: Output) -> Path:
        stored = self._blobs.path(output.digest)
        if not output.video:
            return stored
        return self._cache.get(f"{output.digest}-first-{CONVERTER}.png", lambda: encode_png(read_first_frame(stored)))


async def found_or_made(renditions: Renditions, ask: Callable[[Renditions], _Result]) -> _Result:
    """Ask for a file: at once if it is kept, in its turn if it is to be made."""
    try:
        return await threads.run(threads.RECORDS, ask, renditions.kept)
    except NotKeptError:
        return await threads.run(threads.PICTURES, ask, renditions)


def _part(sample: Sample, frame: int) -> str:
    """Begin a file's name; one file may be cut into frames of several heights."""
    return f"{sample.digest}-{sample.height}-{frame}" if sample.moving else sample.digest


def rendition_bound(size: int) -> int:
    """Bound the longer side of a sample's picture: the next of the sizes in which there are any."""
    return next((step for step in SIZES if step >= size), SIZES[-1])


def is_derived(name: str) -> bool:
    """Whether an output is one of the pictures that stand for an experiment."""
    return name in DERIVED


def derived_digest(name: str, crop: Output, texture: Output) -> str:
    """Name the bytes of a picture that stands for an experiment, by what it is made of and by what."""
    return hashlib.sha256(f"{name} {crop.digest} {texture.digest} {CONVERTER}".encode()).hexdigest()


def check_deep(file_format: Format | VideoFormat | None) -> None:
    """Raise `InvalidInputError` if files of this format have no 16 bits per channel."""
    if file_format not in (None, *DEEP_FORMATS):
        raise InvalidInputError(
            f"{file_format.upper()} has 8 bits per channel only: ask for png or tiff, or for depth 8.", "depth"
        )


def _thumbnail_size(name: str, crop: Output, texture: Output) -> tuple[int, int]:
    scale = min(1.0, THUMBNAIL / max(crop.width, crop.height, texture.width, texture.height))
    original = crop if name == THUMBNAIL_NAMES[0] else texture
    return max(1, round(original.width * scale)), max(1, round(original.height * scale))
