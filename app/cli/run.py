"""Run of `microtexture synthesize`: photographs or clips in, one file out, or all of them."""

import re
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import zip_longest
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from app.cli.files import (
    RECORD,
    check_directory,
    directory_of,
    file_name,
    put_all,
    target,
    write,
    write_record,
)
from app.errors import InvalidInputError, NotFoundError
from app.experiments.diagnostics import diagnose
from app.experiments.files.staging import pick
from app.experiments.model import Experiment, ExperimentInput, Sample
from app.experiments.preparation import Answer, NewExperiment, NewInput, prepare
from app.images.crop import Frames, Rectangle
from app.images.decode import Decoded, Limits, decode
from app.methods.allowed import Allowed
from app.methods.context import Context, Progress
from app.methods.effects import outputs_of
from app.methods.model import Clip, Method, Picture, Source
from app.methods.params import StillParams
from app.methods.registry import method as method_named
from app.methods.stages import Stages
from app.numbers import quote
from app.settings import Settings


@dataclass(frozen=True)
class Request:
    """What was typed: ``parameters``, ``crop`` and ``time`` still as text."""

    photos: tuple[Path, ...]
    out: Path | None
    method: str
    output: str
    directory: Path | None
    crop: tuple[str, ...]
    time: tuple[str, ...]
    size: str | None
    depth: int | None
    overwrite: bool
    parameters: Mapping[str, Any]


def run(request: Request, settings: Settings, progress: Progress) -> str:
    """Make an output and write it, or all of them; nothing is left if that fails, and what was there stays.

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
    if request.directory is not None:
        return _all(request.directory, request, method, settings, progress, started)
    return _one(request, method, settings, progress, started)


def _one(request: Request, method: Method, settings: Settings, progress: Progress, started: float) -> str:
    if request.out is None or not request.photos:
        raise InvalidInputError("Name a photograph, or a clip, and then the file to write.")
    depth = _depth(request.depth)
    where = target(request.out, method, request.output, depth, overwrite=request.overwrite)
    ready = _ready(request, Answer(where.output, depth), settings)
    with ready.pictures(settings.threads, progress) as pictures:
        # What is made before it is dropped, and what comes after it is not computed.
        picture = next(pick(pictures, where.output))
        write(where, picture, depth)
    size = f"{picture.width} × {picture.height} pixels"
    if picture.frames > 1:
        size += f", {picture.frames} frames"
    seconds = time.perf_counter() - started
    return f"{where.path}: {size}, {method.name}, seed {ready.params.seed}, {seconds:.2f} s"


def _all(
    directory: Path, request: Request, method: Method, settings: Settings, progress: Progress, started: float
) -> str:
    if request.output != "texture":
        raise InvalidInputError("Give either --output for one of the outputs or --all for all of them.")
    if not request.photos:
        raise InvalidInputError("Name a photograph, or a clip.")
    depth = _depth(request.depth)
    check_directory(directory, (), overwrite=request.overwrite)
    ready = _ready(request, Answer(None, depth), settings)
    names = [file_name(output) for output in outputs_of(method, ready.params, len(ready.sources))]
    check_directory(directory, [*names, RECORD], overwrite=request.overwrite)
    stages = Stages((("method", 94), ("structure", 6)), progress)
    with directory_of(directory) as unfinished, ready.pictures(settings.threads, stages.within("method")) as pictures:
        written = list(put_all(pictures, depth, unfinished))
        write_record(ready.experiment, written, diagnose(ready.sources, written, stages), unfinished)
    seconds = time.perf_counter() - started
    return f"{directory}: {len(written)} outputs and {RECORD}, {method.name}, seed {ready.params.seed}, {seconds:.2f} s"


def _depth(typed: int | None) -> Literal[8, 16] | None:
    if typed not in (None, 8, 16):
        raise InvalidInputError(f"--depth is 8 or 16; got {typed}.")
    return 16 if typed == 16 else 8 if typed == 8 else None


@dataclass(frozen=True)
class _Ready:
    """What was typed, read and checked."""

    experiment: Experiment
    sources: list[Source]
    params: StillParams

    @contextmanager
    def pictures(self, threads: int, progress: Progress) -> Iterator[Iterator[Picture]]:
        """Run it; large pictures are files until the block ends."""
        with tempfile.TemporaryDirectory() as scratch:
            context = Context(self.experiment.depth, threads, progress, Path(scratch))
            yield method_named(self.experiment.method).pictures(self.sources, self.params, context)


def _ready(request: Request, answer: Answer, settings: Settings) -> _Ready:
    method = method_named(request.method)
    photos = {str(path): _read(path, settings) for path in request.photos}
    experiment = _experiment(request, answer, photos, settings)
    sources = [
        _source(photos[each.sample], each, moving=method.slot(index).moving)
        for index, each in enumerate(experiment.inputs)
    ]
    return _Ready(experiment, sources, method.params.model_validate(experiment.parameters))


def _read(path: Path, settings: Settings) -> Decoded:
    if not path.is_file():
        raise NotFoundError(f"There is no file {path}.")
    return decode(path, Limits.from_settings(settings))


def _experiment(request: Request, answer: Answer, photos: Mapping[str, Decoded], settings: Settings) -> Experiment:
    """Validate what was typed, as the service does."""
    for listed, what in ((request.crop, "crops"), (request.time, "time ranges")):
        if len(listed) > len(request.photos):
            raise InvalidInputError(f"There are more {what} ({len(listed)}) than files ({len(request.photos)}).")
    crops = [Rectangle.parse(text) for text in request.crop]
    times = [Frames.parse(text) for text in request.time]
    inputs = tuple(NewInput(str(path), crop, part) for path, crop, part in zip_longest(request.photos, crops, times))
    parameters = dict(request.parameters)
    if request.size is not None:
        if {"width", "height"} & parameters.keys():
            raise InvalidInputError("Give either --size or --width and --height.")
        first = photos[inputs[0].sample]
        base = inputs[0].crop or Rectangle(0, 0, first.width, first.height)
        parameters["width"], parameters["height"] = output_size(request.size, base)
    return prepare(
        NewExperiment(request.method, inputs, parameters, answer=answer),
        "",
        sample=lambda name: Sample(**photos[name].properties(), id=name, digest="", created_at=datetime.now(UTC)),
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
        return crop.scale_size(float(found[1]))
    raise InvalidInputError(
        f"--size is WIDTHxHEIGHT, for example 1024x1024, or a multiple of the crop, x2; got {quote(text)}."
    )


def _cut(strip: NDArray[Any], photo: Decoded, crop: Rectangle, frames: Frames) -> NDArray[Any]:
    """Cut a crop of some frames, (T, H, W, …), out of the frames of a photograph or clip, one below the other."""
    video = strip.reshape(photo.frames, photo.height, *strip.shape[1:])
    rows, columns = slice(crop.y, crop.y + crop.height), slice(crop.x, crop.x + crop.width)
    return video[frames.first : frames.first + frames.count, rows, columns]


def _source(photo: Decoded, item: ExperimentInput, *, moving: bool) -> Source:
    frames = _cut(photo.pixels, photo, item.crop, item.frames)
    clip = Clip(np.ascontiguousarray(frames), photo.rate) if moving else None
    return Source(frames[0].astype(np.float32), 2**photo.depth - 1, clip)


def _holds_transparency(photo: Decoded, crop: Rectangle, frames: Frames) -> bool:
    if photo.alpha is None:
        return False
    return bool((_cut(photo.alpha, photo, crop, frames) < 2**photo.depth - 1).any())
