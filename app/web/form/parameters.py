"""Parameters of the methods as form fields: names, and validation of a submitted form."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import ValidationError

from app.methods.fields import FormField, fields, requirement
from app.methods.model import Method
from app.methods.params import LoopParams, MovingParams, SeamlessParams, StillParams
from app.numbers import plain, quote

SHARED = tuple(StillParams.model_fields)  # width, height and seed: asked once for all methods
FAMILIES = (
    MovingParams,
    LoopParams,
    SeamlessParams,
)  # each has all of the one before; asked once
VIDEO_FIELDS = tuple(entry for entry in fields(SeamlessParams) if entry.name not in SHARED)


def shared_names(method: Method) -> tuple[str, ...]:
    """Name the parameters of a method that are asked once for it and others.

    Examples
    --------
    >>> from app.methods.registry import METHODS
    >>> shared_names(METHODS["rpn"])
    ('width', 'height', 'seed')
    """
    families = [family for family in FAMILIES if issubclass(method.params, family)]
    return tuple((families[-1] if families else StillParams).model_fields)


def own_fields(method: Method) -> tuple[FormField, ...]:
    """List the fields of a method beside those that it shares with others."""
    return tuple(entry for entry in fields(method.params) if entry.name not in shared_names(method))


def form_name(method: Method, name: str) -> str:
    """Name a parameter as the form does: ``rpn.alpha``, but ``seed``, which is asked once for all methods."""
    return name if name in shared_names(method) else f"{method.name}.{name}"


@dataclass(frozen=True)
class Parsed:
    """Parameters as `Service.submit` takes them, and a message for each form field that does not fit."""

    parameters: dict[str, Any] = field(default_factory=dict)
    errors: dict[str, str] = field(default_factory=dict)


def parse(method: Method, submitted: Mapping[str, str]) -> Parsed:
    """Read a method's parameters out of a submitted form; a field left empty takes its default.

    Parameters
    ----------
    method : Method
    submitted : mapping
        Form names (see `form_name`) to what was typed. A switch that is not there is off.

    Returns
    -------
    Parsed
    """
    declared = fields(method.params)
    values: dict[str, Any] = {}
    wrong: dict[str, str] = {}
    for entry in declared:
        text = submitted.get(form_name(method, entry.name), "").strip()
        if entry.kind == "switch":
            values[entry.name] = bool(text)
        elif text:
            try:
                values[entry.name] = _normalise(entry, text)
            except ValueError:
                wrong[entry.name] = requirement(entry)
    parameters: dict[str, Any] = {}
    try:
        parameters = method.params.model_validate(values).model_dump(mode="json", exclude_unset=True)
    except ValidationError as error:
        entries = {entry.name: entry for entry in declared}
        problems = {str(problem["loc"][0]): problem["msg"] for problem in error.errors() if problem["loc"]}
        wrong |= {name: requirement(entries[name], problem) for name, problem in problems.items() if name in entries}
    names = {entry.name: form_name(method, entry.name) for entry in declared if entry.name in wrong}
    errors = {at: f"{wrong[name].removesuffix('.')}; got {quote(submitted[at].strip())}." for name, at in names.items()}
    return Parsed(errors=errors) if errors else Parsed(parameters)


def _normalise(entry: FormField, text: str) -> str:
    """Read a number as people write them, and leave other texts as they are."""
    return plain(text, whole=entry.kind == "integer") if entry.kind in {"integer", "number"} else text
