"""Forms come from what a method declares, and what is submitted becomes parameters or messages at the fields."""

from dataclasses import replace
from typing import Literal

import pytest
from pydantic import Field

from app.methods.fields import fields, requirement
from app.methods.model import Method
from app.methods.params import LoopParams, StillParams
from app.methods.registry import METHODS
from app.web.form.parameters import SHARED, form_name, own_fields, parse, shared_names


class Params(StillParams):
    """Every kind of parameter."""

    scale: float = Field(0.5, gt=0, le=2, title="Scale", description="How large.", json_schema_extra={"advanced": True})
    levels: int | None = Field(None, ge=1, title="Levels", description="How many; default: as many as fit.")
    kind: Literal["one", "two"] = Field("two", title="Kind", description="Which.")
    exact: bool = Field(True, title="Exact", description="Whether.")
    shares: str = Field("", max_length=5, title="Shares", description="How much of each.")


@pytest.fixture
def method() -> Method:
    return replace(METHODS["rpn"], name="test", params=Params)


def test_every_kind_of_parameter_becomes_a_field() -> None:
    found = {field.name: field for field in fields(Params)}
    assert [found[name].kind for name in ("scale", "levels", "kind", "exact", "shares")] == [
        "number",
        "integer",
        "choice",
        "switch",
        "text",
    ]
    assert found["scale"].advanced
    assert (found["scale"].minimum, found["scale"].maximum, found["scale"].default) == ("0", "2", "0.5")
    assert (found["scale"].step, found["levels"].step, found["kind"].step) == ("0.01", "1", "")
    assert (found["levels"].minimum, found["levels"].default) == ("1", "")
    assert found["kind"].choices == ("one", "two")
    assert found["exact"].default == "on"


def test_shared_parameters_are_asked_once(method: Method) -> None:
    assert [field.name for field in own_fields(method)] == ["scale", "levels", "kind", "exact", "shares"]
    assert form_name(method, "seed") == "seed"
    assert form_name(method, "scale") == "test.scale"


def test_what_moving_methods_share_is_asked_once_for_them(method: Method) -> None:
    """Each of it where a method has it; a still method's own parameter of the same name stays its own."""
    looping = replace(method, params=type("Looping", (Params, LoopParams), {}))
    assert shared_names(looping) == ("width", "height", "seed", "frames", "loop")
    assert [field.name for field in own_fields(looping)] == ["scale", "levels", "kind", "exact", "shares"]
    assert form_name(looping, "loop") == "loop"
    assert form_name(looping, "tileable") == "test.tileable"


def test_submitted_texts_become_parameters(method: Method) -> None:
    submitted = {
        "seed": "7",
        "width": "",
        "test.scale": " 1.25 ",
        "test.kind": "one",
        "test.exact": "on",
        "other.scale": "9",
    }
    parsed = parse(method, submitted)
    assert parsed.errors == {}
    assert parsed.parameters == {"seed": 7, "scale": 1.25, "kind": "one", "exact": True}


def test_a_switch_that_is_not_sent_is_off(method: Method) -> None:
    assert parse(method, {}).parameters == {"exact": False}


def test_every_field_at_fault_gets_its_own_message(method: Method) -> None:
    parsed = parse(method, {"seed": "-1", "test.scale": "wide", "test.levels": "2.5", "test.kind": "three"})
    assert set(parsed.errors) == {"seed", "test.scale", "test.levels", "test.kind"}
    assert parsed.errors["test.kind"] == 'Kind is one of: one, two; got "three".'
    assert parsed.errors["test.levels"] == 'Levels is a whole number from 1 on; got "2.5".'


def test_a_text_at_fault_gets_the_words_of_what_refused_it(method: Method) -> None:
    assert parse(method, {"test.shares": "1, 2, 3"}).errors == {
        "test.shares": 'Shares: string should have at most 5 characters; got "1, 2, 3".'
    }


@pytest.mark.parametrize(
    ("typed", "number"),
    [
        ("0,25", 0.25),
        ("0.25", 0.25),
        (" 1,5 ", 1.5),
        (",5", 0.5),
        ("1.", 1),
        ("+1", 1),
        ("1,25e0", 1.25),
        ("１，５", 1.5),
    ],
)
def test_a_decimal_comma_is_a_decimal_point(method: Method, typed: str, number: float) -> None:
    assert parse(method, {"test.scale": typed}).parameters["scale"] == number


@pytest.mark.parametrize(
    "typed", ["1.234,5", "1,234.5", "1,2,3", "1.2.3", "1 000", "1_0", "0x1", "1,5 px", ",", "nan", "½"]
)
def test_a_number_that_could_be_another_one_is_refused_with_its_name(method: Method, typed: str) -> None:
    assert parse(method, {"test.scale": typed}).errors == {
        "test.scale": f'Scale is a number from 0 to 2; got "{typed}".'
    }


@pytest.mark.parametrize(("typed", "number"), [("12", 12), (" 12 ", 12), ("007", 7), ("12.0", 12), ("12,00", 12)])
def test_whole_numbers_are_read_as_people_write_them(method: Method, typed: str, number: int) -> None:
    assert parse(method, {"test.levels": typed}).parameters["levels"] == number


@pytest.mark.parametrize("typed", ["12,5", "12.5", "1.000", "1,000", "1 000", "1_000", "1e3", "12,", "a"])
def test_what_is_no_whole_number_is_refused_with_its_name(method: Method, typed: str) -> None:
    """Not 125, and not 12 or 13 either; and 1.000 may be one or a thousand."""
    assert parse(method, {"test.levels": typed, "test.scale": "9"}).errors == {
        "test.scale": 'Scale is a number from 0 to 2; got "9".',
        "test.levels": f'Levels is a whole number from 1 on; got "{typed}".',
    }


@pytest.mark.parametrize("name", METHODS)
def test_every_method_has_a_complete_form(name: str) -> None:
    """A label and a help for each field, a default that the method itself takes, and a sentence for a wrong value."""
    method = METHODS[name]
    declared = fields(method.params)
    assert set(SHARED) <= {field.name for field in declared}
    for field in declared:
        assert field.label != field.name
        assert field.help
        assert requirement(field).endswith(".")
    submitted = {form_name(method, field.name): field.default for field in declared}
    parsed = parse(method, submitted)
    assert parsed.errors == {}
    assert method.params(**parsed.parameters) == method.params()
