"""The files of an experiment while they are made: the method's pictures, and the small ones for lists and previews."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from app.images.convert import pair, thumbnails
from app.methods.model import Picture, Source


@dataclass(frozen=True)
class File:
    """One output before it is kept."""

    name: str
    title: str
    media_type: str
    width: int
    height: int
    data: bytes


def of_picture(picture: Picture) -> File:
    return File(picture.name, picture.title, "image/png", picture.width, picture.height, picture.png)


def with_hidden(source: Source, pictures: Iterable[Picture]) -> Iterator[File]:
    """The method's pictures; after the texture its thumbnail, the crop's at the same scale, and the pair as a preview."""
    for picture in pictures:
        yield of_picture(picture)
        if picture.name == "texture":
            yield from _hidden(source, picture)
