"""What comes with the service: photographs, clips, a few drawings; what each shows, where to crop it, whom to thank."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from app.images.crop import Rectangle

CATALOGUE = "catalogue.json"

Kind = Literal["micro-texture", "macro-texture", "structured", "non-stationary", "scene", "moving", "drawn"]


@dataclass(frozen=True)
class BundledSample:
    """One photograph, clip or drawing of the catalogue.

    ``kind`` says what the random phase models make of it: they reproduce a ``micro-texture``, lose the objects of a
    ``macro-texture`` and the edges of what is ``structured``, and cannot know of a change across the picture
    (``non-stationary``); a ``scene`` is to be cropped first; a ``moving`` one is a clip, and its title says how it was
    made; what is ``drawn`` is no photograph, but shows something that none shows. ``crop`` is a homogeneous region to
    start from. Where the licence asks for it (CC-BY), pages that show the picture name ``credit``, ``licence`` and
    ``licence_url``.
    """

    path: Path
    title: str
    kind: Kind
    crop: Rectangle
    credit: str
    licence: str
    licence_url: str

    @property
    def id(self) -> str:
        return self.path.stem


def bundled(directory: Path) -> list[BundledSample]:
    """Photographs of a directory in the order of its catalogue, the most telling ones first.

    Parameters
    ----------
    directory : pathlib.Path
        Holds ``catalogue.json`` and the files that it names. A directory without a catalogue has no bundled samples.

    Raises
    ------
    ValueError
        If an entry is of an unknown kind or names a file that is not there: the installation is broken.
    """
    catalogue = directory / CATALOGUE
    if not catalogue.exists():
        return []
    return [_entry(directory, **entry) for entry in json.loads(catalogue.read_text(encoding="utf-8"))]


def _entry(directory: Path, *, file: str, kind: Kind, crop: str, **rest: str) -> BundledSample:
    path = directory / file
    if kind not in get_args(Kind) or not path.is_file():
        raise ValueError(f"{directory / CATALOGUE}: the entry {file!r} is of an unknown kind or without its file.")
    return BundledSample(path=path, kind=kind, crop=Rectangle.parse(crop), **rest)
