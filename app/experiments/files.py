"""The files of an experiment while they are made: the method's pictures, and thumbnails of them for lists."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import imagecodecs
import numpy as np

from app.images.convert import thumbnails
from app.images.png import Pixels
from app.methods.model import Picture, Source


@dataclass(frozen=True)
class File:
    """One output before it is kept. Its size in pixels is 0 × 0 where nobody asks for it."""

    name: str
    title: str
    media_type: str
    width: int
    height: int
    data: bytes


def of_picture(picture: Picture) -> File:
    """The method's picture as a file."""
    return File(picture.name, picture.title, "image/png", picture.width, picture.height, picture.png)


def with_hidden(source: Source, pictures: Iterable[Picture]) -> Iterator[File]:
    """The method's pictures; after the texture the thumbnails of crop and texture, at one scale."""
    for picture in pictures:
        yield of_picture(picture)
        if picture.name == "texture":
            crop: Pixels = source.pixels.astype(np.uint8 if source.peak == 255 else np.uint16)
            texture = imagecodecs.png_decode(picture.png)
            for name, data in zip(("crop", "texture"), thumbnails(crop, texture), strict=True):
                yield File(f".thumbnail-{name}", f"Thumbnail of the {name}", "image/webp", 0, 0, data)
