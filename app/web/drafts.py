"""The form of a sample's page: what it holds when it is opened, and what was meant when it is sent."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from app.errors import AppError, InvalidInputError
from app.experiments.model import Experiment, Sample
from app.experiments.submission import NewExperiment, NewInput
from app.images.crop import Rectangle
from app.methods.fields import fields
from app.methods.model import Method
from app.methods.registry import METHODS
from app.web.forms import SHARED, form_name, parse

CROP = ("crop.x", "crop.y", "crop.width", "crop.height")
START = 512  # pixels of a side of the first crop, at most
SIZES = {
    "1": "the crop’s",
    "1.5": "crop × 1.5",
    "2": "crop × 2",
    "3": "crop × 3",
    "4": "crop × 4",
    "free": "free",
}


@dataclass(frozen=True)
class Draft:
    """Texts by form name, and messages by the form name they belong to."""

    values: dict[str, str]
    errors: dict[str, str] = field(default_factory=dict)


def opened(sample: Sample, suggested: Rectangle | None, query: Mapping[str, str]) -> Draft:
    """Fill the form for a sample: its defaults, changed by what the page's address says.

    Parameters
    ----------
    sample : Sample
    suggested : Rectangle or None
        The crop to start from; None starts from the sample's middle.
    query : mapping
        ``crop`` as ``x,y,width,height``, ``method``, ``size``, and the method's parameters by their own names.
    """
    values = {"method": query.get("method", "")}
    if values["method"] not in METHODS:
        values["method"] = next(iter(METHODS))
    crop = suggested or _start(sample)
    with suppress(InvalidInputError):  # an address typed wrongly opens the form as if it had not been said
        crop = Rectangle.parse(query["crop"]).within(sample.width, sample.height) if "crop" in query else crop
    values |= dict(zip(CROP, str(crop).split(","), strict=True))
    for method in METHODS.values():
        chosen = method.name == values["method"]
        for entry in fields(method.params):
            said = query.get(entry.name) if chosen or entry.name in SHARED else None
            values[form_name(method, entry.name)] = entry.default if said is None else said
    sized = values["width"] or values["height"]
    size = query.get("size", "free" if sized else "1")
    values["size"] = size if size in SIZES else "1"
    return Draft(values)


def address(experiment: Experiment) -> dict[str, str]:
    """Write an experiment as the query that opens its sample's form with its values; the opposite of `opened`."""
    crop = experiment.inputs[0].crop
    query = {"method": experiment.method, "crop": str(crop)}
    for name, value in experiment.parameters.items():
        if value is not None and value is not False:
            query[name] = "on" if value is True else str(value)
    if (experiment.parameters.get("width"), experiment.parameters.get("height")) == (crop.width, crop.height):
        del query["width"], query["height"]
    return query


@dataclass(frozen=True)
class Sent:
    """A submitted form: the experiment it asks for, or None and the draft to show again."""

    draft: Draft
    request: NewExperiment | None


def sent(sample: Sample, submitted: Mapping[str, str], *, listed: bool) -> Sent:
    """Read a submitted form."""
    values = dict(submitted)
    errors: dict[str, str] = {}
    crop = _crop(sample, values, errors)
    method = METHODS.get(values.get("method", ""))
    if method is None:
        errors["method"] = "Choose a method."
        return Sent(Draft(values, errors), None)
    if crop is not None and values.get("size", "free") != "free":
        _resize(values, crop, errors)
    parsed = parse(method, values)
    errors |= parsed.errors
    if errors or crop is None:
        return Sent(Draft(values, errors), None)
    request = NewExperiment(method.name, (NewInput(sample.id, crop),), parsed.parameters, listed)
    return Sent(Draft(values), request)


def refused(draft: Draft, method: Method, error: AppError) -> Draft:
    """Put the service's answer to a request at the field it is about; without a field it is about the whole form."""
    dotted = error.field if isinstance(error, InvalidInputError) and error.field else ""
    if dotted.startswith("inputs.") or dotted.split(".")[0] == "crop":
        name = "crop"
    elif dotted.startswith("parameters."):
        name = form_name(method, dotted.removeprefix("parameters."))
    else:
        name = dotted if dotted in draft.values else ""
    return Draft(draft.values, {name: error.message})


def _start(sample: Sample) -> Rectangle:
    """Start from the middle of a large photograph, which is rarely one texture as a whole."""
    width, height = min(sample.width, START), min(sample.height, START)
    return Rectangle((sample.width - width) // 2, (sample.height - height) // 2, width, height)


def _crop(sample: Sample, values: Mapping[str, str], errors: dict[str, str]) -> Rectangle | None:
    try:
        numbers = [int(values.get(name, "").strip()) for name in CROP]
    except ValueError:
        errors["crop"] = "A crop is four whole numbers: x, y, width and height in pixels."
        return None
    try:
        return Rectangle(*numbers).within(sample.width, sample.height)
    except InvalidInputError as error:
        errors["crop"] = error.message
        return None


def _resize(values: dict[str, str], crop: Rectangle, errors: dict[str, str]) -> None:
    if values["size"] not in SIZES:
        errors["size"] = "Choose one of the sizes, or “free” and a width and a height."
        return
    factor = float(values["size"])
    values["width"], values["height"] = (str(int(side * factor + 0.5)) for side in (crop.width, crop.height))
