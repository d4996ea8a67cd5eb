"""The form of a sample's page: what it holds when it is opened, and what was meant when it is sent."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from urllib.parse import urlencode

from app.errors import AppError, InvalidInputError
from app.experiments.model import Experiment, Sample
from app.experiments.preparation import NewExperiment, NewInput
from app.methods.fields import fields
from app.methods.model import Method, Size
from app.methods.registry import METHODS, method
from app.web.form.inputs import Choices, input_query, opened_inputs, prefix, read_inputs, typed_query
from app.web.form.parameters import SHARED, form_name, parse, shared

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


def opened(sample: Sample, choices: Choices, query: Mapping[str, str]) -> Draft:
    """Fill the form for a sample: its defaults, changed by what the page's address says.

    Parameters
    ----------
    sample : Sample
    choices : Choices
        What further inputs are chosen from, and where crops start.
    query : mapping
        ``method``, ``size``, the method's parameters by their own names, and the inputs (see `opened_inputs`).
    """
    chosen = METHODS.get(query.get("method", "")) or _suitable(sample)
    values = {"method": chosen.name, **opened_inputs(sample, choices, query)}
    for declared in METHODS.values():
        for entry in fields(declared.params):
            said = query.get(entry.name) if declared is chosen or entry.name in shared(chosen) else None
            if declared is chosen or form_name(declared, entry.name) not in values:
                values[form_name(declared, entry.name)] = entry.default if said is None else said
    sized = values["width"] or values["height"]
    size = query.get("size", "free" if sized else "1")
    values["size"] = size if size in SIZES else "1"
    return Draft(values)


def _suitable(sample: Sample) -> Method:
    """Choose the method that a page starts with: of a clip the first moving one."""
    methods = list(METHODS.values())
    return next((entry for entry in methods if sample.moving and entry.inputs[0].moving), methods[0])


def address(experiment: Experiment) -> dict[str, str]:
    """Write an experiment as the query that opens its sample's form with its values; the opposite of `opened`."""
    used = method(experiment.method)
    query = {"method": used.name, **input_query(experiment)}
    defaults = {entry.name: entry.default for entry in fields(used.params)}
    for name, value in experiment.parameters.items():
        said = ("on" if value else "") if isinstance(value, bool) else str(value)
        if value is not None and not said == defaults.get(name) == "":
            query[name] = said
    sizes = [Size(source.crop.width, source.crop.height, 3) for source in experiment.inputs]
    asked = (experiment.parameters.get("width"), experiment.parameters.get("height"))
    if asked == used.size(sizes):
        del query["width"], query["height"]
    if used.moving and experiment.parameters.get("frames") == max(source.frames.count for source in experiment.inputs):
        del query["frames"]
    return query


def typed(values: Mapping[str, str]) -> dict[str, str]:
    """Write a form that is not sent off yet as the query that opens it again."""
    chosen = METHODS.get(values.get("method", ""), next(iter(METHODS.values())))
    query = {"method": chosen.name, **typed_query(values, chosen)}
    size = values.get("size", "1")
    query |= {"size": size} if size != "1" else {}
    for name in SHARED if size == "free" else ("seed",):
        if value := values.get(name, "").strip():
            query[name] = value
    for entry in fields(chosen.params):
        if entry.name in SHARED:
            continue
        value = values.get(form_name(chosen, entry.name), "").strip()
        if value != entry.default:
            query[entry.name] = value
    return query


def form_url(experiment: Experiment) -> str:
    """The form of the first sample, filled in as the experiment says."""
    return f"/samples/{experiment.inputs[0].sample}?{urlencode(address(experiment), safe=',:@')}"


@dataclass(frozen=True)
class Sent:
    """A submitted form: the experiment it asks for, or None and the draft to show again.

    ``numbers`` are the numbers that the experiment's inputs have in the form.
    """

    draft: Draft
    request: NewExperiment | None = None
    numbers: tuple[int, ...] = ()


def sent(sample: Sample, choices: Choices, submitted: Mapping[str, str], *, listed: bool) -> Sent:
    """Read a submitted form."""
    values = dict(submitted)
    errors: dict[str, str] = {}
    chosen = METHODS.get(values.get("method", ""))
    if chosen is None:
        return Sent(Draft(values, {"method": "Choose a method."}))
    inputs = read_inputs(sample, chosen, choices, values, errors)
    if values.get("size", "free") != "free":
        _resize(values, inputs.get(1), errors)
    parsed = parse(chosen, values)
    errors |= parsed.errors
    if errors:
        return Sent(Draft(values, errors))
    request = NewExperiment(chosen.name, tuple(inputs.values()), parsed.parameters, listed)
    return Sent(Draft(values), request, tuple(inputs))


def refused(read: Sent, chosen: Method, error: AppError) -> Draft:
    """Put the service's answer to a request at the field it is about; without a field it is about the whole form."""
    dotted = error.field if isinstance(error, InvalidInputError) and error.field else ""
    part, *rest = dotted.split(".")
    if part == "inputs" and rest:
        part = rest[1] if len(rest) > 1 else "crop"
        name = f"{prefix(read.numbers[int(rest[0])])}{'time' if part == 'frames' else part}"
    elif part == "parameters" and rest:
        name = form_name(chosen, ".".join(rest))
    else:
        name = dotted if dotted in read.draft.values or dotted == "crop" else ""
    return Draft(read.draft.values, {name: error.message})


def _resize(values: dict[str, str], first: NewInput | None, errors: dict[str, str]) -> None:
    """Give the texture the size that was chosen; once the crop's is what the method does by itself."""
    factor = values["size"]
    if factor not in SIZES:
        errors["size"] = "Choose one of the sizes, or “free” and a width and a height."
    elif factor == "1":
        values["width"] = values["height"] = ""
    elif first and first.crop:
        values["width"], values["height"] = map(str, first.crop.scaled(float(factor)))
