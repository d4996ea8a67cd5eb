"""One run without a service: photographs in, one file out."""

import os
import re
import time
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInputError, NotFoundError
from app.experiments.model import Experiment, Sample
from app.experiments.submission import Allowed, NewExperiment, NewInput, prepare
from app.images.convert import Format, convert
from app.images.crop import Rectangle
from app.images.decode import Decoded, Limits, decode
from app.methods.model import Context, Progress, Source
from app.methods.registry import method as method_named
from app.settings import Settings

FORMATS: dict[str, Format] = {
    ".png": "png",
    ".jpg": "jpeg",
    ".jpeg": "jpeg",
    ".webp": "webp",
    ".tif": "tiff",
    ".tiff": "tiff",
}


@dataclass(frozen=True)
class Request:
    """What was typed: ``parameters`` and ``crop`` still as text."""

    photos: tuple[Path, ...]
    out: Path
    method: str
    crop: tuple[str, ...]
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
    chosen, depth = _target(request)
    photos = {str(path): _read(path, settings) for path in request.photos}
    experiment = _experiment(request, photos, settings)
    method = method_named(experiment.method)
    sources = [_source(photos[each.sample], each.crop) for each in experiment.inputs]
    params = method.params.model_validate(experiment.parameters)
    # The first picture is the texture; the steps that the pages show after it are not computed.
    texture = next(method.run(sources, params, Context(depth, settings.threads, progress)))
    _write(request.out, convert(texture.data, chosen)[0])
    seconds = time.perf_counter() - started
    size = f"{texture.width} × {texture.height} pixels"
    return f"{request.out}: {size}, {method.name}, seed {params.seed}, {seconds:.2f} s"


def _target(request: Request) -> tuple[Format, Literal[8, 16]]:
    if not request.photos:
        raise InvalidInputError("Name a photograph, and then the file to write.")
    chosen = FORMATS.get(request.out.suffix.lower())
    if chosen is None:
        raise InvalidInputError(
            f"The name of the file to write ends with one of {', '.join(FORMATS)}; got {request.out.name!r}."
        )
    if request.depth not in (8, 16):
        raise InvalidInputError(f"--depth is 8 or 16; got {request.depth}.")
    if request.depth == 16 and chosen not in ("png", "tiff"):
        raise InvalidInputError("16 bits per channel fit into PNG and TIFF only: name the file to write .png or .tif.")
    if not request.out.parent.is_dir():
        raise NotFoundError(f"There is no directory {request.out.parent}: make it first.")
    if request.out.exists() and not request.overwrite:
        raise InvalidInputError(f"{request.out} is there already: choose another name, or add --overwrite.")
    return chosen, 16 if request.depth == 16 else 8


def _read(path: Path, settings: Settings) -> Decoded:
    if not path.is_file():
        raise NotFoundError(f"There is no file {path}.")
    return decode(path, Limits(settings.max_upload_bytes, settings.max_upload_pixels))


def _experiment(request: Request, photos: Mapping[str, Decoded], settings: Settings) -> Experiment:
    """Validate what was typed, as the service does."""
    if len(request.crop) > len(request.photos):
        raise InvalidInputError(f"There are more crops ({len(request.crop)}) than photographs ({len(request.photos)}).")
    crops = [Rectangle.parse(text) for text in request.crop]
    inputs = tuple(
        NewInput(str(path), crops[index] if index < len(crops) else None) for index, path in enumerate(request.photos)
    )
    parameters = dict(request.parameters)
    if request.size is not None:
        if {"width", "height"} & parameters.keys():
            raise InvalidInputError("Give either --size or --width and --height.")
        first = photos[inputs[0].sample]
        base = inputs[0].crop or Rectangle(0, 0, first.pixels.shape[1], first.pixels.shape[0])
        parameters["width"], parameters["height"] = output_size(request.size, base)
    return prepare(
        NewExperiment(request.method, inputs, parameters),
        "",
        sample=lambda name: _as_sample(name, photos[name]),
        transparent=lambda sample, crop, frames: _holds_transparency(photos[sample.id], crop),
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
    >>> output_size("1024x768", Rectangle(0, 0, 5, 5)), output_size("x1.5", Rectangle(0, 0, 256, 200))
    ((1024, 768), (384, 300))
    """
    if found := re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", text, re.ASCII):
        return int(found[1]), int(found[2])
    if (found := re.fullmatch(r"[x×](\d{1,3}(?:\.\d{1,3})?)", text, re.ASCII)) and float(found[1]) > 0:
        return max(1, round(crop.width * float(found[1]))), max(1, round(crop.height * float(found[1])))
    raise InvalidInputError(
        f"--size is WIDTHxHEIGHT, for example 1024x1024, or a multiple of the crop, x2; got {text!r}."
    )


def _as_sample(name: str, photo: Decoded) -> Sample:
    height, width, channels = photo.pixels.shape
    return Sample(
        id=name,
        digest="",
        width=width,
        height=height,
        channels=channels,
        depth=photo.depth,
        transparent=photo.alpha is not None,
        created_at=datetime.now(UTC),
    )


def _cut(pixels: NDArray[Any], crop: Rectangle) -> NDArray[Any]:
    return pixels[crop.y : crop.y + crop.height, crop.x : crop.x + crop.width]


def _source(photo: Decoded, crop: Rectangle) -> Source:
    return Source(_cut(photo.pixels, crop).astype(np.float32), 2**photo.depth - 1)


def _holds_transparency(photo: Decoded, crop: Rectangle) -> bool:
    return photo.alpha is not None and bool((_cut(photo.alpha, crop) < 2**photo.depth - 1).any())


def _write(out: Path, data: bytes) -> None:
    unfinished = out.with_name(f".{out.name}.{os.getpid()}")
    try:
        unfinished.write_bytes(data)
        unfinished.replace(out)
    finally:
        unfinished.unlink(missing_ok=True)
