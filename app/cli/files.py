"""Files that a run writes: checks of where they may go, and writing each whole or not at all."""

import json
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

from app.errors import InvalidInputError, NotFoundError
from app.experiments.environment import environment
from app.experiments.files.outputs import AnyFormat, name_of_file
from app.experiments.model import Experiment
from app.images.convert import convert
from app.methods.effects import possible_output, refuse_deep
from app.methods.model import Method, Picture
from app.methods.outputs import OutputSpec

STILLS: dict[str, AnyFormat] = {
    ".png": "png",
    ".jpg": "jpeg",
    ".jpeg": "jpeg",
    ".webp": "webp",
    ".tif": "tiff",
    ".tiff": "tiff",
}
VIDEOS: dict[str, AnyFormat] = {".webm": "webm", ".mp4": "mp4"}
ANIMATED: dict[str, AnyFormat] = {".webp": "webp"}
PNG = "image/png"
SUFFIXES = {PNG: ".png", "image/webp": ".webp", "video/webm": ".webm", "video/mp4": ".mp4"}
RECORD = "record.json"
DEEP = ("png", "tiff")

Depth = Literal[8, 16]


@dataclass(frozen=True)
class Target:
    """One file to write: its name gives the format and, for a video, which of the two files."""

    path: Path
    output: str
    file_format: AnyFormat


def target(path: Path, method: Method, name: str, depth: Depth | None, *, overwrite: bool) -> Target:
    """Where an output goes.

    Raises
    ------
    InvalidInputError, NotFoundError
        If a file of this name cannot be written, or not with this output in it.
    """
    output = possible_output(method, name)
    known = _formats(output)
    file_format = known.get(path.suffix.lower())
    if file_format is None:
        subject = f"The method {method.name} makes" if name == "texture" else f"The output {name!r} is"
        raise InvalidInputError(
            f"{subject} {'a video' if output.video else 'a picture'}: the name of the file to write ends with one of "
            f"{', '.join(known)}; got {path.name!r}."
        )
    if depth == 16:
        if file_format not in DEEP:
            raise InvalidInputError(
                "16 bits per channel fit into PNG and TIFF only: name the file to write .png or .tif."
            )
        refuse_deep(output, 16)
    _check_parent(path)
    _check_free(path, overwrite)
    return Target(path, name_of_file(output, file_format), file_format)


def check_directory(directory: Path, names: Iterable[str], *, overwrite: bool) -> None:
    """Refuse a directory for files of these names that cannot be made, or that has one of them already."""
    _check_parent(directory)
    if directory.exists() and not directory.is_dir():
        raise InvalidInputError(f"{directory} is a file: name a directory, which is made if it is not there.")
    for name in names:
        _check_free(directory / name, overwrite)


def file_name(output: OutputSpec | Picture) -> str:
    """Name the file of an output in a directory of all.

    Examples
    --------
    >>> file_name(OutputSpec("texture-mp4", media_type="video/mp4"))
    'texture-mp4.mp4'
    """
    return f"{output.name}{SUFFIXES[output.media_type]}"


def write(where: Target, picture: Picture, depth: Depth | None) -> None:
    """Write a picture; what is at its place until then stays if that fails."""
    unfinished = where.path.with_name(f".{where.path.name}.{os.getpid()}")
    try:
        _put(picture, where.file_format, depth, unfinished)
        unfinished.replace(where.path)
    finally:
        unfinished.unlink(missing_ok=True)


@contextmanager
def directory_of(directory: Path) -> Iterator[Path]:
    """A directory to fill; its files are moved to this one, which is made if need be, once all of them are there."""
    with tempfile.TemporaryDirectory(dir=directory.parent, prefix=f".{directory.name}.") as unfinished:
        yield Path(unfinished)
        directory.mkdir(exist_ok=True)
        for path in sorted(Path(unfinished).iterdir()):
            path.replace(directory / path.name)


def put_all(pictures: Iterable[Picture], depth: Depth | None, directory: Path) -> Iterator[tuple[Picture, Path]]:
    """Write pictures as they come; of each what it is, and the file that it is in."""
    for picture in pictures:
        path = directory / file_name(picture)
        _put(picture, "png" if picture.media_type == PNG else None, depth, path)
        yield picture, path


def write_record(
    experiment: Experiment, written: Iterable[tuple[Picture, Path]], diagnostics: dict[str, Any], directory: Path
) -> None:
    """Write down how the files of a directory were made, in the words of the service's records."""
    record = {
        "environment": environment(),
        "method": experiment.method,
        "inputs": [
            {"file": each.sample, "crop": asdict(each.crop), "frames": asdict(each.frames)}
            for each in experiment.inputs
        ],
        "parameters": dict(experiment.parameters),
        "depth": experiment.depth,
        "outputs": [
            {
                "name": picture.name,
                "title": picture.title,
                "kind": picture.kind,
                "media_type": picture.media_type,
                "width": picture.width,
                "height": picture.height,
                "bytes": path.stat().st_size,
                "frames": picture.frames,
                "rate": picture.rate,
                "file": path.name,
            }
            for picture, path in written
        ],
        "diagnostics": diagnostics,
    }
    text = json.dumps(record, indent=2, ensure_ascii=False)
    (directory / RECORD).write_text(f"{text}\n", encoding="utf-8")


def _formats(output: OutputSpec) -> dict[str, AnyFormat]:
    if output.video:
        return VIDEOS
    return STILLS if output.media_type == PNG else ANIMATED


def _put(picture: Picture, file_format: AnyFormat | None, depth: Depth | None, path: Path) -> None:
    if file_format is not None and file_format != "webm" and file_format != "mp4" and picture.media_type == PNG:
        # A picture whose sample has 16 bits is narrowed here, as the service does it.
        path.write_bytes(convert(picture.data, file_format, 8 if depth == 8 else None)[0])
    elif isinstance(picture.data, Path):
        shutil.move(picture.data, path)
    else:
        path.write_bytes(picture.data)


def _check_parent(path: Path) -> None:
    if not path.parent.is_dir():
        raise NotFoundError(f"There is no directory {path.parent}: make it first.")


def _check_free(path: Path, overwrite: bool) -> None:
    if path.exists() and not overwrite:
        raise InvalidInputError(f"{path} is there already: choose another name, or add --overwrite.")
