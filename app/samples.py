"""Bundled samples: photographs, clips and drawings that come with the service, with a crop and whom to thank."""

import errno
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from app.images.crop import Rectangle
from app.settings import ROOT

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


def read_catalogue(directory: Path) -> list[BundledSample]:
    """Photographs of a directory in the order of its catalogue, the most telling ones first.

    Parameters
    ----------
    directory : pathlib.Path
        Holds ``catalogue.json`` and the files that it names. A directory without a catalogue has no bundled samples.

    Raises
    ------
    FileNotFoundError
        If an entry names a file that is not there: the installation is broken.
    ValueError
        If an entry is of an unknown kind.
    """
    catalogue = directory / CATALOGUE
    if not catalogue.exists():
        return []
    return [_entry(directory, **entry) for entry in json.loads(catalogue.read_text(encoding="utf-8"))]


def _entry(directory: Path, *, file: str, kind: Kind, crop: str, **rest: str) -> BundledSample:
    path = directory / file
    if kind not in get_args(Kind):
        raise ValueError(f"{directory / CATALOGUE}: the entry {file!r} is of the unknown kind {kind!r}.")
    if not path.is_file():
        raise _missing(path)
    return BundledSample(path=path, kind=kind, crop=Rectangle.parse(crop), **rest)


def require_files(samples: Path) -> None:
    """Check that everything the pages are made of is there.

    Parameters
    ----------
    samples : pathlib.Path
        The directory of the bundled samples; only Microtexture's own one must have a catalogue.

    Raises
    ------
    FileNotFoundError
        If the templates, the static files or the bundled samples are missing.
    """
    needed = [ROOT / "templates" / "base.html", ROOT / "static" / "css" / "base.css", samples]
    if samples == ROOT / "samples":
        needed.append(samples / CATALOGUE)
    for path in needed:
        if not path.exists():
            raise _missing(path)
    read_catalogue(samples)


def _missing(path: Path) -> FileNotFoundError:
    reason = "A file of Microtexture is missing; install the wheel anew, or start from a whole checkout"
    return FileNotFoundError(errno.ENOENT, reason, str(path))
