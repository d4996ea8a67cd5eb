"""Form of a sample's page: its texts and messages, and the experiment that a submitted one asks for."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.errors import AppError, InvalidInputError
from app.experiments.model import Sample
from app.experiments.preparation import NewExperiment, NewInput
from app.methods.model import Method
from app.methods.registry import METHODS
from app.web.form.inputs import Choices, prefix, read_inputs
from app.web.form.parameters import form_name, parse

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
    """Texts by form name, and messages by the form name they belong to.

    ``lasting`` are those of the messages that a check of the form cannot repeat: they are not about what it says.
    """

    values: dict[str, str]
    errors: dict[str, str] = field(default_factory=dict)
    lasting: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Submission:
    """A submitted form: the experiment it asks for, or None and the draft to show again.

    ``numbers`` are the numbers that the experiment's inputs have in the form.
    """

    draft: Draft
    request: NewExperiment | None = None
    numbers: tuple[int, ...] = ()


def read_form(sample: Sample, choices: Choices, submitted: Mapping[str, str]) -> Submission:
    """Read a submitted form."""
    values = dict(submitted)
    errors: dict[str, str] = {}
    chosen = METHODS.get(values.get("method", ""))
    if chosen is None:
        return Submission(Draft(values, {"method": "Choose a method."}))
    inputs = read_inputs(sample, chosen, choices, values, errors)
    if values.get("size", "free") != "free":
        _resize(values, inputs.get(1), errors)
    parsed = parse(chosen, values)
    errors |= parsed.errors
    if errors:
        return Submission(Draft(values, errors))
    request = NewExperiment(chosen.name, tuple(inputs.values()), parsed.parameters, listed=not values.get("unlisted"))
    return Submission(Draft(values), request, tuple(inputs))


def with_error(submission: Submission, chosen: Method, error: AppError) -> Draft:
    """Put the service's error at the form field that it names; one that names none is about the whole form."""
    dotted = error.field if isinstance(error, InvalidInputError) and error.field else ""
    part, *rest = dotted.split(".")
    if part == "inputs" and rest:
        part = rest[1] if len(rest) > 1 else "crop"
        name = f"{prefix(submission.numbers[int(rest[0])])}{'time' if part == 'frames' else part}"
    elif part == "parameters" and rest:
        name = form_name(chosen, ".".join(rest))
    else:
        name = dotted if dotted in submission.draft.values or dotted == "crop" else ""
    return Draft(submission.draft.values, {name: error.message})


def _resize(values: dict[str, str], first: NewInput | None, errors: dict[str, str]) -> None:
    """Apply the size menu: 1× leaves width and height empty (the method's default), other factors multiply the crop."""
    factor = values["size"]
    if factor not in SIZES:
        errors["size"] = "Choose one of the sizes, or “free” and a width and a height."
    elif factor == "1":
        values["width"] = values["height"] = ""
    elif first and first.crop:
        values["width"], values["height"] = map(str, first.crop.scale_size(float(factor)))
