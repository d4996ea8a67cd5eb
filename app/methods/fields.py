"""Form fields of a method's parameters, of which forms, command-line options and pages are made."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

from pydantic import BaseModel

Kind = Literal["integer", "number", "choice", "switch", "text"]


@dataclass(frozen=True)
class FormField:
    """Form field of one parameter; ``default`` is empty for a size that follows the crop."""

    name: str
    label: str
    help: str
    kind: Kind
    default: str
    minimum: str = ""
    maximum: str = ""
    step: str = ""
    choices: tuple[str, ...] = ()
    advanced: bool = False


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "on" if value else ""
    return f"{value:g}" if isinstance(value, float) else str(value)


def _kind(schema: Mapping[str, Any]) -> Kind:
    if "enum" in schema:
        return "choice"
    kinds: dict[str, Kind] = {"integer": "integer", "number": "number", "boolean": "switch"}
    return kinds.get(str(schema.get("type")), "text")


def _bound(schema: Mapping[str, Any], *names: str) -> str:
    return next((_text(schema[name]) for name in names if name in schema), "")


def _step(kind: Kind, default: Any) -> str:
    """Step of a number's arrow keys: the last digit of the default written with two."""
    if kind == "integer":
        return "1"
    if kind != "number":
        return ""
    return f"{10.0 ** (math.floor(math.log10(abs(default))) - 1):g}" if default else "0.1"


@cache
def fields(params: type[BaseModel]) -> tuple[FormField, ...]:
    """Make a form field of every parameter of a Params class, in the order of its declaration.

    Examples
    --------
    >>> from app.methods.model import StillParams
    >>> [(field.name, field.kind, field.default, field.minimum) for field in fields(StillParams)]
    [('width', 'integer', '', '1'), ('height', 'integer', '', '1'), ('seed', 'integer', '0', '0')]
    """
    document = params.model_json_schema()
    found = []
    for name, declared in document["properties"].items():
        # An optional value is `anyOf: [what it is, null]`, and an Enum a reference into `$defs`.
        inner = next((part for part in declared.get("anyOf", ()) if part.get("type") != "null"), declared)
        if "$ref" in inner:
            inner = document["$defs"][inner["$ref"].rsplit("/", 1)[-1]]
        kind = _kind(inner)
        found.append(
            FormField(
                name=name,
                label=declared.get("title", name),
                help=declared.get("description", ""),
                kind=kind,
                default=_text(declared.get("default")),
                minimum=_bound(inner, "minimum", "exclusiveMinimum"),
                maximum=_bound(inner, "maximum", "exclusiveMaximum"),
                step=_step(kind, declared.get("default")),
                choices=tuple(str(choice) for choice in inner.get("enum", ())),
                advanced=bool(declared.get("advanced", False)),
            )
        )
    return tuple(found)


def reason(problem: str) -> str:
    """Word a validator's own message as the end of a sentence."""
    words = problem.removeprefix("Value error, ").rstrip(".")
    return f"{words[:1].lower()}{words[1:]}"


def requirement(entry: FormField, problem: str = "") -> str:
    """Describe a field's valid values in a sentence; for free text use the validator's message, ``problem``.

    Examples
    --------
    >>> from app.methods.model import StillParams
    >>> requirement(fields(StillParams)[0])
    'Width is a whole number from 1 to 1000000.'
    """
    if entry.kind == "text":
        return f"{entry.label}: {reason(problem)}."
    if entry.kind == "switch":
        return f"{entry.label} is true or false."
    if entry.kind == "choice":
        return f"{entry.label} is one of: {', '.join(entry.choices)}."
    noun = "a whole number" if entry.kind == "integer" else "a number"
    if entry.minimum and entry.maximum:
        return f"{entry.label} is {noun} from {entry.minimum} to {entry.maximum}."
    if entry.minimum:
        return f"{entry.label} is {noun} from {entry.minimum} on."
    return f"{entry.label} is {noun}."
