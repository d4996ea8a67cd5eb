"""Files made from stored ones and cached: what a browser shows of a sample, and downloads in other formats."""

import hashlib
from pathlib import Path

from app.errors import InvalidInputError
from app.experiments.cache import FileCache
from app.experiments.model import Output, Sample
from app.experiments.ports import BlobStore
from app.images.convert import PREVIEW, Format, convert, pair, rendition

DEEP_FORMATS = ("png", "tiff")
SIZES = (256, 512, 1024, 2048)
PREVIEW_NAME = ".preview"
PNG = "image/png"


class Pictures:
    """Renditions of samples and conversions of outputs, under the digest of what they were made from."""

    def __init__(self, blobs: BlobStore, cache: FileCache) -> None:
        self._blobs = blobs
        self._cache = cache

    def rendition(self, sample: Sample, size: int | None) -> tuple[Path, str]:
        """The stored PNG itself, or one whose longer side is at most the next of 256, 512, 1024 and 2048 pixels."""
        stored = self._blobs.path(sample.digest)
        if size is None:
            return stored, PNG
        bound = next((step for step in SIZES if step >= size), SIZES[-1])
        media_type = PNG if sample.transparent else "image/jpeg"
        name = f"{sample.digest}-{bound}.{media_type.removeprefix('image/')}"
        return self._cache.get(name, lambda: rendition(stored, bound)[0]), media_type

    def converted(self, output: Output, file_format: Format) -> tuple[Path, str]:
        """An output in this format, and its media type."""
        stored = self._blobs.path(output.digest)
        media_type = f"image/{file_format}"
        if output.media_type == media_type:
            return stored, media_type
        return self._cache.get(f"{output.digest}.{file_format}", lambda: convert(stored, file_format)[0]), media_type

    def preview(self, crop: Output, texture: Output) -> tuple[Output, Path]:
        """The pair of pictures that stands for an experiment elsewhere; made when first asked for."""
        stored = self._blobs.path(crop.digest), self._blobs.path(texture.digest)
        path = self._cache.get(f"{texture.digest}-{crop.digest}.jpeg", lambda: pair(*stored))
        digest = hashlib.sha256(f"{crop.digest} {texture.digest}".encode()).hexdigest()
        return Output(PREVIEW_NAME, "Preview", "image/jpeg", *PREVIEW, path.stat().st_size, digest), path

    def check_deep(self, file_format: Format) -> None:
        """Raise `InvalidInputError` if files of this format have no 16 bits per channel."""
        if file_format not in DEEP_FORMATS:
            raise InvalidInputError(
                f"{file_format.upper()} has 8 bits per channel only: ask for png or tiff, or for depth 8.", "depth"
            )
