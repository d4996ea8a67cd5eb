"""Files made from stored ones and cached: what a browser shows of a sample, and downloads in other formats."""

import hashlib
from collections.abc import Callable
from pathlib import Path

from app.errors import InvalidInputError
from app.experiments.cache import FileCache
from app.experiments.model import Output, Sample
from app.experiments.ports import BlobStore
from app.images.convert import PREVIEW, THUMBNAIL, Format, convert, pair, rendition, thumbnails
from app.images.png import encode_png
from app.images.strip import read_frame

DEEP_FORMATS = ("png", "tiff")
SIZES = (256, 512, 1024, 2048)
PREVIEW_NAME = ".preview"
THUMBNAIL_NAMES = (".thumbnail-crop", ".thumbnail-texture")
DERIVED = {PREVIEW_NAME: "Preview", **dict.fromkeys(THUMBNAIL_NAMES, "Thumbnail")}
PNG = "image/png"


class Pictures:
    """Renditions of samples and conversions of outputs, under the digest of what they were made from."""

    def __init__(self, blobs: BlobStore, cache: FileCache) -> None:
        self._blobs = blobs
        self._cache = cache

    def rendition(self, sample: Sample, size: int | None, frame: int = 0) -> tuple[Path, str]:
        """The picture, of a video one frame: as it is stored, or smaller.

        A smaller one's longer side is at most the next of 256, 512, 1024 and 2048 pixels.

        Raises
        ------
        InvalidInputError
            If there is no such frame.
        """
        if not 0 <= frame < sample.frames:
            raise InvalidInputError(f"The sample has {_count(sample)}; the first is number 0.", "frame")
        if size is None:
            return self._still(sample, frame), PNG
        bound = next((step for step in SIZES if step >= size), SIZES[-1])
        media_type = PNG if sample.transparent else "image/jpeg"
        name = f"{_part(sample, frame)}-{bound}.{media_type.removeprefix('image/')}"
        return self._cache.get(name, lambda: rendition(self._still(sample, frame), bound)[0]), media_type

    def _still(self, sample: Sample, frame: int) -> Path:
        stored = self._blobs.path(sample.digest)
        if not sample.moving:
            return stored
        name = f"{_part(sample, frame)}.png"
        return self._cache.get(name, lambda: encode_png(read_frame(stored, frame, sample.width, sample.height)))

    def converted(self, output: Output, file_format: Format) -> tuple[Path, str]:
        """An output in this format, and its media type."""
        stored = self._blobs.path(output.digest)
        media_type = f"image/{file_format}"
        if output.media_type == media_type:
            return stored, media_type
        return self._cache.get(f"{output.digest}.{file_format}", lambda: convert(stored, file_format)[0]), media_type

    def derived(self, name: str, crop: Output, texture: Output) -> tuple[Output, Path]:
        """One of the pictures that stand for an experiment in lists and elsewhere; made when first asked for."""
        stored = self._blobs.path(crop.digest), self._blobs.path(texture.digest)
        pair_digest = hashlib.sha256(f"{name} {crop.digest} {texture.digest}".encode()).hexdigest()

        def cached(part: str, make: Callable[[], bytes]) -> Path:
            return self._cache.get(f"{texture.digest}-{crop.digest}{part}", make)

        if name == PREVIEW_NAME:
            path, media_type = cached(name, lambda: pair(*stored)), "image/jpeg"
        else:

            def both() -> bytes:
                made = dict(zip(THUMBNAIL_NAMES, thumbnails(*stored), strict=True))
                for each, data in made.items():
                    if each != name:
                        cached(each, lambda data=data: data)  # type: ignore[misc] # a browser asks for it next
                return made[name]

            path, media_type = cached(name, both), "image/webp"
        width, height = PREVIEW if name == PREVIEW_NAME else _thumbnail_size(name, crop, texture)
        return Output(name, DERIVED[name], media_type, width, height, path.stat().st_size, pair_digest), path

    def check_deep(self, file_format: Format) -> None:
        """Raise `InvalidInputError` if files of this format have no 16 bits per channel."""
        if file_format not in DEEP_FORMATS:
            raise InvalidInputError(
                f"{file_format.upper()} has 8 bits per channel only: ask for png or tiff, or for depth 8.", "depth"
            )


def _part(sample: Sample, frame: int) -> str:
    """Begin a file's name; one strip may be cut into frames of several heights."""
    return f"{sample.digest}-{sample.height}-{frame}" if sample.moving else sample.digest


def _count(sample: Sample) -> str:
    return f"{sample.frames} frames" if sample.moving else "one frame"


def _thumbnail_size(name: str, crop: Output, texture: Output) -> tuple[int, int]:
    scale = min(1.0, THUMBNAIL / max(crop.width, crop.height, texture.width, texture.height))
    original = crop if name == THUMBNAIL_NAMES[0] else texture
    return max(1, round(original.width * scale)), max(1, round(original.height * scale))
