"""One run without a service: photographs or clips in, one file out."""

import os
import re
import shutil
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInputError, NotFoundError
from app.experiments.model import Experiment, ExperimentInput, Sample
from app.experiments.submission import Allowed, NewExperiment, NewInput, prepare
from app.images.convert import Format, convert
from app.images.crop import Frames, Rectangle
from app.images.decode import Decoded, Limits, decode
from app.methods.model import Context, Film, Method, Picture, Progress, Source
from app.methods.registry import method as method_named
from app.numbers import said
from app.settings import Settings

FORMATS: dict[str, Format] = {
    ".png": "png",
    ".jpg": "jpeg",
    ".jpeg": "jpeg",
    ".webp": "webp",
    ".tif": "tiff",
    ".tiff": "tiff",
}
FILMS = {".webm": "video/webm", ".mp4": "video/mp4"}


@dataclass(frozen=True)
class Request:
    """What was typed: ``parameters``, ``crop`` and ``time`` still as text."""

    photos: tuple[Path, ...]
    out: Path
    method: str
    crop: tuple[str, ...]
    time: tuple[str, ...]
    size: str | None
    depth: int
    overwrite: bool
    parameters: Mapping[str, Any]


def run(request: Request, settings: Settings, progress: Progress) -> str:
    """Make the texture and write it; nothing is left at ``out`` if that fails.

    Returns
    -------
    str
        One line about what was made.

    Raises
    ------
    AppError
        Whatever is wrong with the request, the photographs or the parameters, as over the REST API.
    OSError
        If a file can be neither read nor written.
    """
    started = time.perf_counter()
    method = method_named(request.method)
    depth = _check_target(request, method)
    photos = {str(path): _read(path, settings) for path in request.photos}
    experiment = _experiment(request, photos, settings)
    sources = [
        _source(photos[each.sample], each, moving=method.slot(index).moving)
        for index, each in enumerate(experiment.inputs)
    ]
    params = method.params.model_validate(experiment.parameters)
    with tempfile.TemporaryDirectory() as scratch:
        context = Context(depth, settings.threads, progress, Path(scratch))
        # The first pictures are the texture; the steps that the pages show after it are not computed.
        pictures = list(islice(method.run(sources, params, context), method.textures))
        texture = _write(request.out, pictures)
    seconds = time.perf_counter() - started
    size = f"{texture.width} × {texture.height} pixels"
    if texture.frames > 1:
        size += f", {texture.frames} frames"
    return f"{request.out}: {size}, {method.name}, seed {params.seed}, {seconds:.2f} s"


def _check_target(request: Request, method: Method) -> Literal[8, 16]:
    if not request.photos:
        raise InvalidInputError("Name a photograph, or a clip, and then the file to write.")
    suffix = request.out.suffix.lower()
    known = FILMS if method.moving else FORMATS
    if suffix not in known:
        what = "a video" if method.moving else "a picture"
        raise InvalidInputError(
            f"The method {method.name} makes {what}: the name of the file to write ends with one of "
            f"{', '.join(known)}; got {request.out.name!r}."
        )
    if request.depth not in (8, 16):
        raise InvalidInputError(f"--depth is 8 or 16; got {request.depth}.")
    if request.depth == 16 and FORMATS.get(suffix) not in ("png", "tiff"):
        raise InvalidInputError("16 bits per channel fit into PNG and TIFF only: name the file to write .png or .tif.")
    if not request.out.parent.is_dir():
        raise NotFoundError(f"There is no directory {request.out.parent}: make it first.")
    if request.out.exists() and not request.overwrite:
        raise InvalidInputError(f"{request.out} is there already: choose another name, or add --overwrite.")
    return 16 if request.depth == 16 else 8


def _read(path: Path, settings: Settings) -> Decoded:
    if not path.is_file():
        raise NotFoundError(f"There is no file {path}.")
    return decode(path, Limits.by(settings))


def _experiment(request: Request, photos: Mapping[str, Decoded], settings: Settings) -> Experiment:
    """Validate what was typed, as the service does."""
    for given, what in ((request.crop, "crops"), (request.time, "time ranges")):
        if len(given) > len(request.photos):
            raise InvalidInputError(f"There are more {what} ({len(given)}) than files ({len(request.photos)}).")
    crops = [Rectangle.parse(text) for text in request.crop]
    times = [Frames.parse(text) for text in request.time]
    inputs = tuple(NewInput(str(path), crop, part) for path, crop, part in zip_longest(request.photos, crops, times))
    parameters = dict(request.parameters)
    if request.size is not None:
        if {"width", "height"} & parameters.keys():
            raise InvalidInputError("Give either --size or --width and --height.")
        first = photos[inputs[0].sample]
        base = inputs[0].crop or Rectangle(0, 0, first.pixels.shape[1], first.height)
        parameters["width"], parameters["height"] = output_size(request.size, base)
    return prepare(
        NewExperiment(request.method, inputs, parameters),
        "",
        sample=lambda name: _as_sample(name, photos[name]),
        transparent=lambda sample, crop, frames: _holds_transparency(photos[sample.id], crop, frames),
        allowed=Allowed.by(settings),
    )


def output_size(text: str, crop: Rectangle) -> tuple[int, int]:
    """Width and height of ``WIDTHxHEIGHT``, or of a multiple of the crop, ``x1.5``.

    Raises
    ------
    InvalidInputError
        If it is neither.

    Examples
    --------
    >>> output_size("1024x768", Rectangle(0, 0, 5, 5)), output_size("x1.5", Rectangle(0, 0, 256, 199))
    ((1024, 768), (384, 299))
    """
    if found := re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", text, re.ASCII):
        return int(found[1]), int(found[2])
    if (found := re.fullmatch(r"[x×](\d{1,3}(?:\.\d{1,3})?)", text, re.ASCII)) and float(found[1]) > 0:
        return crop.scaled(float(found[1]))
    raise InvalidInputError(
        f"--size is WIDTHxHEIGHT, for example 1024x1024, or a multiple of the crop, x2; got {said(text)}."
    )


def _as_sample(name: str, photo: Decoded) -> Sample:
    _, width, channels = photo.pixels.shape
    return Sample(
        id=name,
        digest="",
        width=width,
        height=photo.height,
        channels=channels,
        depth=photo.depth,
        transparent=photo.alpha is not None,
        created_at=datetime.now(UTC),
        frames=photo.frames,
        media_type=photo.media_type,
        rate=photo.rate,
    )


def _cut(strip: NDArray[Any], photo: Decoded, crop: Rectangle, frames: Frames) -> NDArray[Any]:
    """Cut a crop of some frames, (T, H, W, …), out of the frames of a photograph or clip, one below the other."""
    film = strip.reshape(photo.frames, photo.height, *strip.shape[1:])
    rows, columns = slice(crop.y, crop.y + crop.height), slice(crop.x, crop.x + crop.width)
    return film[frames.first : frames.first + frames.count, rows, columns]


def _source(photo: Decoded, item: ExperimentInput, *, moving: bool) -> Source:
    frames = _cut(photo.pixels, photo, item.crop, item.frames)
    film = Film(np.ascontiguousarray(frames), photo.rate) if moving else None
    return Source(frames[0].astype(np.float32), 2**photo.depth - 1, film)


def _holds_transparency(photo: Decoded, crop: Rectangle, frames: Frames) -> bool:
    if photo.alpha is None:
        return False
    return bool((_cut(photo.alpha, photo, crop, frames) < 2**photo.depth - 1).any())


def _write(out: Path, pictures: list[Picture]) -> Picture:
    """Write the picture that is asked for by the file's name; returns it."""
    suffix = out.suffix.lower()
    unfinished = out.with_name(f".{out.name}.{os.getpid()}")
    try:
        if suffix in FILMS:
            texture = next(picture for picture in pictures if picture.media_type == FILMS[suffix])
            assert isinstance(texture.data, Path)
            shutil.copyfile(texture.data, unfinished)
        else:
            texture = pictures[0]
            unfinished.write_bytes(convert(texture.data, FORMATS[suffix])[0])
        unfinished.replace(out)
        return texture
    finally:
        unfinished.unlink(missing_ok=True)
