"""The address of a sample's page is its form: written, and read back, it is the same form."""

import json
import random
import subprocess
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.datastructures import QueryParams

from app.errors import NotFoundError
from app.experiments.model import Sample
from app.images.crop import Frames, Rectangle
from app.methods.fields import fields
from app.methods.registry import METHODS
from app.settings import ROOT
from app.web.form.address import from_query, input_values, query_of, sample_url, with_switches
from app.web.form.draft import SIZES, read_form
from app.web.form.inputs import Choices
from app.web.form.parameters import VIDEO_FIELDS, shared_names

NODE = Path(sys.executable).parent / "node"
SCRIPT = ROOT / "static" / "js" / "lib" / "address.js"
SAMPLES = {"clip": 6, "sand": 1, "grass": 1}
CHOSEN = {f"{declared.name}.{entry.name}": entry for declared in METHODS.values() for entry in fields(declared.params)}
SHARED = {entry.name: entry for declared in METHODS.values() for entry in fields(declared.params)}
ODD = [
    "",
    " ",
    "0",
    " 7 ",
    "-3",
    "1,5",
    "１２",
    "a&b=c",
    "50%",
    "%2C",
    "+",
    "~*",
    "‘“”’",
    "a\r\nb",
    "#x",
    ";",
    "½",
    "9" * 40,
]


def sample(name: str) -> Sample:
    now = datetime(2026, 1, 1, tzinfo=UTC)
    return Sample(48, 40, 3, 8, False, SAMPLES[name], 10.0, id=name, digest="0" * 64, created_at=now, title=name)


def find(name: str) -> Sample:
    if name not in SAMPLES:
        raise NotFoundError("There is no such photograph.")
    return sample(name)


CHOICES = Choices(tuple(map(sample, SAMPLES)), {}, find)


def texts(name: str, method: str) -> st.SearchStrategy[str]:
    """What a browser's form can hold in a field of this name."""
    entry = CHOSEN.get(name) or SHARED.get(name)
    if name == "method":
        return st.just(method)
    if name == "size":
        return st.sampled_from(list(SIZES))
    if name.endswith("sample"):
        return st.sampled_from(["", *SAMPLES])
    if name == "unlisted" or (entry and entry.kind == "switch"):
        return st.sampled_from(["", "on"])
    if entry and entry.kind == "choice":
        return st.sampled_from(entry.choices)
    return st.sampled_from(ODD) | st.text(st.characters(exclude_categories=["Cs"]), max_size=9)


def counts(name: str, values: Mapping[str, str]) -> bool:
    """Whether a field has a say in what the form asks for."""
    declared = METHODS[values["method"]]
    head, _, part = name.partition(".")
    if head.startswith("input-"):
        within = int(head.removeprefix("input-")) <= len(declared.inputs) + declared.more
        return within and (part == "sample" or values[f"{head}.sample"] != "")
    if head in METHODS:
        return head == declared.name
    if name in SHARED:
        asked = name in declared.params.model_fields and f"{declared.name}.{name}" not in values
        return asked and (name not in ("width", "height") or values["size"] == "free")
    return True


@pytest.mark.parametrize("method", METHODS)
@settings(deadline=None, max_examples=30)
@given(data=st.data(), page=st.sampled_from(["clip", "sand"]))
def test_a_form_comes_back_from_its_address_as_it_was(method: str, data: st.DataObject, page: str) -> None:
    """Every field that counts, whatever was typed into it, and with them the experiment that it asks for."""
    shown = sample(page)
    begun = from_query(shown, CHOICES, {"method": method}).values
    changed = data.draw(st.sets(st.sampled_from(sorted(name for name in begun if name != "size")), max_size=12)) | {
        "size"
    }
    values = begun | {name: data.draw(texts(name, method), name) for name in sorted(changed)}
    query = query_of(values)
    back = from_query(shown, CHOICES, QueryParams(query)).values
    for name in values:
        if counts(name, values):
            assert back[name] == values[name], name
    assert read_form(shown, CHOICES, back).request == read_form(shown, CHOICES, values).request
    assert query_of(back) == query


@pytest.mark.parametrize("method", METHODS)
def test_what_a_form_begins_with_is_left_out(method: str) -> None:
    """But the method, the crop and the samples, which another version may choose otherwise."""
    names = QueryParams(query_of(from_query(sample("sand"), CHOICES, {"method": method}).values)).keys()
    inputs = len(METHODS[method].inputs)
    crop = ["crop.x", "crop.y", "crop.width", "crop.height"]
    assert list(names) == ["method", *crop, *(f"input-{number}.sample" for number in range(2, inputs + 1))]


def test_a_switch_that_a_browser_left_out_is_off() -> None:
    """Written so that it does not come back on; of a link that says nothing of it, it is as it begins."""
    begun = from_query(sample("sand"), CHOICES, {"method": "rpn"}).values
    submitted = {name: text for name, text in begun.items() if name != "rpn.periodic"}
    assert begun["rpn.periodic"] == "on"
    back = from_query(sample("sand"), CHOICES, QueryParams(query_of(with_switches(submitted)))).values
    assert back["rpn.periodic"] == ""
    assert from_query(sample("sand"), CHOICES, QueryParams(query_of(submitted))).values["rpn.periodic"] == "on"


@pytest.mark.parametrize(
    ("short", "names"),
    [
        ("crop=1,2,30,31", input_values(1, Rectangle(1, 2, 30, 31))),
        ("crop=1,2,999,31", input_values(1, Rectangle(0, 0, 48, 40))),
        ("crop=1,2,30", input_values(1, Rectangle(0, 0, 48, 40))),
        ("time=2,3", {"time.first": "2", "time.count": "3"}),
        ("time=2,1", {"time.first": "2", "time.count": ""}),
        ("time=9,2", {"time.first": "", "time.count": ""}),
        ("second=sand:4,5,20,21", {"input-2.sample": "sand"} | input_values(2, Rectangle(4, 5, 20, 21))),
        (
            "second=clip:4,5,20,21@1,2&third=grass",
            {"input-2.sample": "clip", "input-3.sample": "grass"}
            | input_values(2, Rectangle(4, 5, 20, 21), Frames(1, 2)),
        ),
        ("second=clip:4,5,99,99@1,9", {"input-2.sample": "clip", "input-2.crop.x": "", "input-2.time.first": ""}),
        ("second=gone:4,5,20,21@1,2", {"input-2.sample": "sand", "input-2.crop.x": "", "input-2.time.first": ""}),
        ("third=gone:4,5,20,21", {"input-3.sample": "", "input-3.crop.x": ""}),
        ("width=50&seed=9", {"size": "free", "width": "50", "seed": "9"}),
        ("size=7", {"size": "1"}),
        ("strip=3&alpha=0.3", {"mix.strip": "3", "mix.alpha": "0.3", "rpn.alpha": "0.1"}),
        ("strip=3&mix.strip=4", {"mix.strip": "4"}),
        ("crop=1,2,30,31&crop.x=5", {"crop.x": "5", "crop.y": "2"}),
    ],
)
def test_short_addresses_are_still_read(short: str, names: dict[str, str]) -> None:
    """Those that stand in bookmarks and documents; what such a one has wrong counts as not said."""
    values = from_query(sample("clip"), CHOICES, QueryParams(f"method=mix&{short}")).values
    assert {name: values[name] for name in names} == names


def test_a_sample_that_is_gone_takes_its_crop_with_it() -> None:
    query = {"method": "mix", "input-2.sample": "gone", "input-2.crop.x": "4", "input-2.time.first": "2"}
    values = from_query(sample("clip"), CHOICES, query).values
    assert [values[f"input-2.{part}"] for part in ("sample", "crop.x", "time.first")] == ["sand", "", ""]


def test_names_that_are_no_fields_are_left_alone() -> None:
    values = from_query(sample("sand"), CHOICES, {"sample": "grass", "press": "1", "show": "2", "x": "3"}).values
    assert not {"sample", "press", "show", "x"} & set(values)


def test_an_address_needs_no_method() -> None:
    """Of a page that only leads to a crop."""
    url = sample_url("sand", input_values(1, Rectangle(4, 6, 20, 16), Frames(1, 5)))
    assert url == "/samples/sand?time.first=1&time.count=5&crop.x=4&crop.y=6&crop.width=20&crop.height=16"


def as_in_the_page(values: dict[str, str]) -> list[Any]:
    """A form as the script of the page sees it: its fields with what they begin with, and what the method asks for."""
    begun = from_query(sample("sand"), CHOICES, {"method": "rpn"}).values
    always = {"method", *input_values(1, Rectangle(0, 0, 1, 1)), "input-2.sample"} - {"time.first", "time.count"}
    fields = [
        {"name": name, "value": text, **({} if name in always else {"initial": begun[name]})}
        for name, text in values.items()
    ]
    declared = METHODS[values["method"]]
    lacks = [entry.name for entry in VIDEO_FIELDS if entry.name not in shared_names(declared)]
    return [fields, {"inputs": len(declared.inputs) + declared.more, "lacks": lacks}]


def test_script_and_service_write_every_form_alike() -> None:
    """The same fields, with the same texts; their order is that of the page in the one and of the form in the other."""
    chance = random.Random(20261130)
    forms = []
    for method in METHODS:
        begun = from_query(sample("sand"), CHOICES, {"method": method}).values
        for _ in range(12):
            values = dict(begun)
            for name in chance.sample(sorted(begun), 15):
                choice = {"method": [method], "size": list(SIZES)}.get(name, ODD)
                values[name] = chance.choice(["", *SAMPLES] if name.endswith("sample") else choice)
            forms.append(values)
    program = f"import {{ queryOf }} from {json.dumps(SCRIPT.as_uri())};" + (
        "let all = ''; for await (const part of process.stdin) all += part;"
        "console.log(JSON.stringify(JSON.parse(all).map((form) => queryOf(...form))));"
    )
    command = [str(NODE), "--input-type=module", "--eval", program]
    cases = json.dumps([as_in_the_page(values) for values in forms])
    done = subprocess.run(command, input=cases, capture_output=True, text=True, check=True)
    assert [sorted(query.split("&")) for query in json.loads(done.stdout)] == [
        sorted(query_of(values).split("&")) for values in forms
    ]
