"""From what a person asks for to a complete experiment, or to words that say what is wrong with it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from app.errors import InvalidInputError, TooLargeError
from app.experiments.model import Experiment, ExperimentInput, Sample
from app.experiments.ownership import new_identifier
from app.images.crop import Rectangle
from app.methods.model import Method, Size, StillParams
from app.methods.registry import method as method_named


@dataclass(frozen=True)
class NewInput:
    """A crop of a sample; without a crop, all of it."""

    sample: str
    crop: Rectangle | None = None


@dataclass(frozen=True)
class NewExperiment:
    """What a person asks for; ``parameters`` as they came, unchecked."""

    method: str
    inputs: tuple[NewInput, ...]
    parameters: Mapping[str, Any]
    listed: bool = True


def prepare(
    request: NewExperiment,
    owner: str,
    *,
    sample: Callable[[str], Sample],
    transparent: Callable[[Sample, Rectangle], bool],
    max_output_pixels: int,
) -> Experiment:
    """A complete experiment: crops explicit, defaults and sizes filled in.

    Parameters
    ----------
    request : NewExperiment
    owner : str
        The digest of the owner's token.
    sample : callable
        Gives the sample of an id; raises `NotFoundError`.
    transparent : callable
        Whether a crop of a sample holds pixels that are not opaque.
    max_output_pixels : int
        Width × height that a texture may have.

    Raises
    ------
    InvalidInputError
        With the field at fault, dotted as in the JSON body.
    NotFoundError
        If the method or a sample does not exist.
    TooLargeError
        If the texture would have too many pixels.
    """
    method = method_named(request.method)
    _check_count(method, len(request.inputs))
    inputs, sizes = [], []
    for index, wanted_input in enumerate(request.inputs):
        found = sample(wanted_input.sample)
        crop = _crop(wanted_input, found, f"inputs.{index}.crop", transparent)
        inputs.append(ExperimentInput(found.id, crop))
        sizes.append(Size(crop.width, crop.height, found.channels))
    params = _params(method, request.parameters)
    width, height = method.size(sizes)
    params = params.model_copy(update={"width": params.width or width, "height": params.height or height})
    _check_pixels(method, params, max_output_pixels)
    method.check(sizes, params)
    return Experiment(
        id=new_identifier(),
        method=method.name,
        inputs=tuple(inputs),
        parameters=params.model_dump(mode="json"),
        listed=request.listed,
        owner=owner,
        created_at=datetime.now(UTC),
    )


def _check_count(method: Method, given: int) -> None:
    least, most = len(method.inputs), len(method.inputs) + method.more
    if least <= given <= most:
        return
    wanted = str(least) if least == most else f"{least} to {most}"
    names = ", ".join(slot.name for slot in method.inputs)
    noun = "input" if most == 1 else "inputs"
    raise InvalidInputError(f"The method {method.name} takes {wanted} {noun} ({names}), not {given}.", "inputs")


def _check_pixels(method: Method, params: StillParams, allowed: int) -> None:
    pixels = (params.width or 0) * (params.height or 0)
    maker = "this service"
    if method.most_pixels is not None and method.most_pixels < allowed:
        maker, allowed = f"the method {method.name}", method.most_pixels
    if pixels > allowed:
        raise TooLargeError(
            f"A texture of {params.width} × {params.height} has {pixels / 1e6:.0f} megapixels; {maker} makes at most "
            f"{allowed / 1e6:.0f}: ask for a smaller width or height."
        )


def _crop(wanted: NewInput, sample: Sample, field: str, transparent: Callable[[Sample, Rectangle], bool]) -> Rectangle:
    crop = wanted.crop or Rectangle(0, 0, sample.width, sample.height)
    try:
        crop.within(sample.width, sample.height)
    except InvalidInputError as error:
        raise InvalidInputError(error.message, field) from None
    if sample.transparent and transparent(sample, crop):
        raise InvalidInputError(
            "The crop holds transparent pixels, which have no colour to synthesise from: move it to an opaque region.",
            field,
        )
    return crop


def _params(method: Method, given: Mapping[str, Any]) -> StillParams:
    try:
        return method.params.model_validate(dict(given))
    except ValidationError as error:
        raise _explained(error.errors(include_url=False)[0], method) from None


def _explained(error: ErrorDetails, method: Method) -> InvalidInputError:
    path = [str(part) for part in error["loc"]]
    field = ".".join(["parameters", *path])
    if error["type"] == "extra_forbidden":
        known = ", ".join(method.params.model_fields)
        return InvalidInputError(f"The method {method.name} has no parameter {path[-1]!r}; it has: {known}.", field)
    declared = method.params.model_fields.get(path[0]) if path else None
    title = (declared and declared.title) or ".".join(path) or "The parameters"
    reason = error["msg"].removeprefix("Value error, ")
    given = error["input"]
    shown = f"; got {given!r}" if isinstance(given, str | int | float | bool) and len(str(given)) <= 60 else ""
    return InvalidInputError(f"{title}: {reason[:1].lower()}{reason[1:]}{shown}.", field)
