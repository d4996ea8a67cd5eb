"""Preparation of experiments: completes a request, or says what is wrong with it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, Literal

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from app.errors import InvalidInputError
from app.experiments.model import Experiment, ExperimentInput, Sample
from app.experiments.tokens import new_identifier
from app.images.crop import Frames, Rectangle
from app.methods.allowed import Allowed
from app.methods.effects import output_named, outputs_of, refuse_deep, without_effect
from app.methods.fields import fields, reason, requirement
from app.methods.model import Method, Size, Slot
from app.methods.params import StillParams
from app.methods.registry import method as method_named
from app.numbers import quote

LEAST_FRAMES = 2


@dataclass(frozen=True)
class NewInput:
    """A crop of a sample; without a crop, all of it. For ``frames`` see `ExperimentInput`."""

    sample: str
    crop: Rectangle | None = None
    frames: Frames | None = None


@dataclass(frozen=True)
class Answer:
    """Output that a run for a single answer shall make: its name, None for all of them, and its bits.

    Without a ``depth`` pictures have that of the deepest sample. What was typed and changes nothing of the answer is
    refused; of an experiment that is kept all is there, and its parameters may be those of another one.
    """

    output: str | None = "texture"
    depth: Literal[8, 16] | None = None


@dataclass(frozen=True)
class NewExperiment:
    """Request for an experiment; ``parameters`` as they came, unchecked."""

    method: str
    inputs: tuple[NewInput, ...]
    parameters: Mapping[str, Any]
    listed: bool = True
    answer: Answer | None = None


def prepare(
    request: NewExperiment,
    owner: str,
    *,
    sample: Callable[[str], Sample],
    transparent: Callable[[Sample, Rectangle, Frames], bool],
    allowed: Allowed,
) -> Experiment:
    """Complete a request: crops explicit, defaults and sizes filled in.

    Parameters
    ----------
    request : NewExperiment
    owner : str
        The digest of the owner's token.
    sample : callable
        Gives the sample of an id; raises `NotFoundError`.
    transparent : callable
        Whether a crop of some frames of a sample holds pixels that are not opaque.
    allowed : Allowed

    Raises
    ------
    InvalidInputError
        With the field at fault, dotted as in the JSON body.
    NotFoundError
        If the method or a sample does not exist.
    TooLargeError
        If the texture would have too many pixels, or take more memory than there is.
    """
    method = method_named(request.method)
    _check_count(method, len(request.inputs))
    inputs, sizes = [], []
    depths = {8}
    for index, new in enumerate(request.inputs):
        found = sample(new.sample)
        frames = _frames(new, found, method.slot(index), f"inputs.{index}")
        crop = _crop(new, found, frames, f"inputs.{index}.crop", transparent)
        inputs.append(ExperimentInput(found.id, crop, frames))
        depths.add(found.depth)
        sizes.append(Size(crop.width, crop.height, found.channels, frames.count))
    params = _params(method, request.parameters)
    params = method.resolve(sizes, params, allowed).params
    if request.answer is not None:
        _check_answer(method, sizes, params, request, max(depths))
        depths.add(request.answer.depth or 8)
    allowed.refuse_memory(method.memory_of(sizes, params), moving=method.moving)
    return Experiment(
        id=new_identifier(),
        method=method.name,
        inputs=tuple(inputs),
        parameters=params.model_dump(mode="json"),
        listed=request.listed,
        owner=owner,
        created_at=datetime.now(UTC),
        depth=16 if 16 in depths else 8,
        wanted=(request.answer and request.answer.output) or "texture",
    )


def memory_of(experiment: Experiment, sample: Callable[[str], Sample]) -> int:
    """Compute the bytes that a run of a complete experiment needs, as far as its method says so; else 0."""
    method = method_named(experiment.method)
    sizes = [
        Size(item.crop.width, item.crop.height, sample(item.sample).channels, item.frames.count)
        for item in experiment.inputs
    ]
    return method.memory_of(sizes, method.params.model_validate(experiment.parameters))


def _check_count(method: Method, count: int) -> None:
    least, most = len(method.inputs), len(method.inputs) + method.more
    if least <= count <= most:
        return
    number = str(least) if least == most else f"{least} to {most}"
    names = ", ".join(slot.name for slot in method.inputs)
    noun = "input" if most == 1 else "inputs"
    raise InvalidInputError(f"The method {method.name} takes {number} {noun} ({names}), not {count}.", "inputs")


def _check_answer(method: Method, sizes: list[Size], params: StillParams, request: NewExperiment, deepest: int) -> None:
    assert request.answer is not None
    outputs = [output.name for output in outputs_of(method, params, len(sizes))]
    if request.answer.output is not None:
        output = output_named(method, request.answer.output, params, len(sizes))
        outputs = [output.name]
        if request.answer.depth == 16:
            refuse_deep(output, deepest)
    for name, words in without_effect(method, sizes, params, request.parameters.keys(), outputs).items():
        raise InvalidInputError(words, f"parameters.{name}")


def _frames(new: NewInput, sample: Sample, slot: Slot, field: str) -> Frames:
    if slot.moving and not sample.moving:
        raise InvalidInputError(
            f"The input “{slot.name}” of this method is a video, and this sample is a still picture: upload an MP4, "
            "WebM, GIF, animated WebP or APNG file, or take one of the bundled clips.",
            f"{field}.sample",
        )
    frames = new.frames or (Frames(0, sample.frames) if slot.moving else Frames())
    try:
        frames.check_within(sample.frames)
    except InvalidInputError as error:
        raise InvalidInputError(error.message, f"{field}.frames") from None
    if slot.moving and frames.count < LEAST_FRAMES:
        raise InvalidInputError(
            f"A moving texture is made from at least {LEAST_FRAMES} frames: make the time range longer.",
            f"{field}.frames",
        )
    if not slot.moving and frames.count > 1:
        raise InvalidInputError(
            f"The input “{slot.name}” of this method is a still picture: give a time range of 1 frame.",
            f"{field}.frames",
        )
    return frames


def _crop(
    new: NewInput,
    sample: Sample,
    frames: Frames,
    field: str,
    transparent: Callable[[Sample, Rectangle, Frames], bool],
) -> Rectangle:
    crop = new.crop or Rectangle(0, 0, sample.width, sample.height)
    try:
        crop.check_within(sample.width, sample.height)
    except InvalidInputError as error:
        raise InvalidInputError(error.message, field) from None
    if sample.transparent and transparent(sample, crop, frames):
        raise InvalidInputError(
            "The crop holds transparent pixels, which have no colour to synthesise from: move it to an opaque region.",
            field,
        )
    return crop


def _params(method: Method, values: Mapping[str, Any]) -> StillParams:
    try:
        return method.params.model_validate(dict(values))
    except ValidationError as error:
        raise explain(error.errors(include_url=False)[0], method) from None


def explain(fault: ErrorDetails, method: Method) -> InvalidInputError:
    """Explain a fault of a parameter: its name, what it takes and what came."""
    path = [str(part) for part in fault["loc"]]
    field = ".".join(["parameters", *path])
    if fault["type"] == "extra_forbidden":
        known = ", ".join(method.params.model_fields)
        return InvalidInputError(
            f"The method {method.name} has no parameter {quote(path[-1])}; it has: {known}.", field
        )
    entry = next((entry for entry in fields(method.params) if entry.name in path[:1]), None)
    words = reason(fault["msg"]) if entry is None else requirement(entry, fault["msg"])
    return InvalidInputError(f"{words.removesuffix('.')}; got {quote(fault['input'])}.", field)
