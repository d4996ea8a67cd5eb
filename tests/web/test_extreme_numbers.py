"""Numbers that nobody means, in every numeric place of every route: each is answered, in words, and none with a 500."""

import json
from collections.abc import Iterable, Iterator
from typing import Any

import httpx
import pytest
from fastapi import FastAPI
from fastapi.routing import APIRoute

from app.methods.fields import fields
from app.methods.model import Method
from app.methods.registry import METHODS
from app.web.form.parameters import SHARED, form_name

pytestmark = pytest.mark.slow

DIGITS = "9" * 5000
# As JSON writes them; Python's reader takes NaN and Infinity, too, and as many digits as it can count.
NEVER = ("1" + "0" * 320, "9" * 4000, "-1" + "0" * 320, "1e308", "1e999", "-1e999", "NaN", "Infinity", "-Infinity")
SOMETIMES = ("-0", "-1", "0", "0.0", "1.5", "7.0", "9007199254740993", "true", "null", '"7"', "[]", "{}", '"\\u0661"')
TEXTS = (
    *NEVER,
    *SOMETIMES[:7],
    DIGITS,
    "-" + DIGITS,
    "1_000",
    "\u0661\u0662",
    "\u00b2",
    "0x10",
    "+5",
    " 7 ",
    "1e5",
    "nan",
)
SHARING = ("mix", "video-rpn")  # what all methods read in the same way is tried with these
LISTS = ("crop", "time", "second", "third")  # of the form's page: several numbers each
ENOUGH = 1000  # characters of an answer's words: what came is not said back whole


def numeric(method: Method) -> list[str]:
    return [entry.name for entry in fields(method.params) if entry.kind in ("integer", "number")]


def inputs_of(method: Method, clip: str) -> list[dict[str, Any]]:
    return [{"sample": clip if slot.moving else "gravel_gray"} for slot in method.inputs]


def bodies(method: Method, clip: str, values: Iterable[str]) -> Iterator[bytes]:
    """JSON requests with one value in every numeric place, one place at a time; by hand, for JSON has no NaN."""
    body: dict[str, Any] = {"method": method.name, "inputs": inputs_of(method, clip)}
    crop = {"x": 0, "y": 0, "width": 32, "height": 24}
    places: list[tuple[Any, Any, str]] = []  # what holds the number, in which body
    for name in numeric(method):
        said = {**body, "parameters": {name: None}}
        places.append((said, said["parameters"], name))
    for name in crop if method.name in SHARING else ():
        area = dict(crop)
        said = {**body, "inputs": [{**body["inputs"][0], "crop": area}, *body["inputs"][1:]]}
        places.append((said, area, name))
    for name in ("first", "count") if method.name in SHARING else ():
        time = {"first": 0, "count": 2}
        said = {**body, "inputs": [{**body["inputs"][0], "frames": time}, *body["inputs"][1:]]}
        places.append((said, time, name))
    for said, holder, name in places:
        holder[name] = "@"
        written = json.dumps(said)
        yield from (written.replace('"@"', value).encode() for value in values)


def in_words(answer: httpx.Response, what: object) -> None:
    """Refused with a problem that names the field, and does not say thousands of digits back."""
    assert 400 <= answer.status_code < 500, (answer.status_code, what)
    problem = answer.json()
    assert len(problem["detail"]) < ENOUGH, what
    assert all(len(fault["message"]) < ENOUGH for fault in problem.get("errors", ())), what
    if answer.status_code == 422:
        assert problem["errors"][0]["field"], what


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_json_with_numbers_beyond_all_measure_is_refused(site: Any, clip: str, method: Method) -> None:
    headers = {"Content-Type": "application/json"}
    for body in bodies(method, clip, NEVER):
        for address in ("/api/v1/check", "/api/v1/experiments"):
            in_words(site.client.post(address, content=body, headers=headers), (address, body[:200]))


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_json_with_odd_numbers_is_answered(site: Any, clip: str, method: Method) -> None:
    for body in bodies(method, clip, SOMETIMES):
        answer = site.client.post("/api/v1/check", content=body, headers={"Content-Type": "application/json"})
        if answer.status_code != 200:
            in_words(answer, body[:200])


def form_of(method: Method, clip: str) -> dict[str, str]:
    """What the form of a sample sends for a method."""
    form = {"method": method.name, "sample": clip if method.inputs[0].moving else "gravel_gray", "size": "free"}
    form |= {"width": "32", "height": "32", "crop.x": "0", "crop.y": "0", "crop.width": "40", "crop.height": "40"}
    for number, slot in enumerate(method.inputs[1:], 2):
        form[f"input-{number}.sample"] = clip if slot.moving else "gravel_gray"
    return form


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_forms_with_odd_numbers_are_answered(site: Any, clip: str, method: Method) -> None:
    """The check answers for the same texts as the form that is sent off; what both refuse stays a page."""
    form = form_of(method, clip)
    crop, time = ("x", "y", "width", "height"), ("first", "count")
    names = [form_name(method, name) for name in numeric(method)]
    if method.name in SHARING:
        names += ["size", *(f"{begin}crop.{side}" for begin in ("", "input-2.") for side in crop)]
        names += [f"{begin}time.{side}" for begin in ("", "input-2.") for side in time]
    else:
        names = [name for name in names if name not in SHARED]
    for name in names:
        for value in TEXTS:
            answer = site.client.post("/experiments/check", data={**form, name: value})
            assert answer.status_code < 500, (name, value[:40])
            assert all(len(words) < ENOUGH for words in answer.json()["errors"].values()), (name, value[:40])
        for value in (NEVER[0], NEVER[4], DIGITS, "\u0661\u0662"):
            answer = site.client.post("/experiments", data={**form, name: value})
            assert answer.status_code < 500, (name, value[:40])


@pytest.mark.parametrize("method", ["rpn", "mix", "efros-leung", "video-rpn"])
def test_the_straight_way_refuses_numbers_beyond_all_measure(
    site: Any, method: str, picture: Any, film: Any, animation: Any
) -> None:
    slots = METHODS[method].inputs
    data = [animation(film()) if slot.moving else picture() for slot in slots]
    files = {"file" if not number else f"file-{number + 1}": ("p.png", each) for number, each in enumerate(data)}
    values = (NEVER[0], NEVER[4], "NaN", DIGITS)
    wanted = [{name: value} for name in numeric(METHODS[method]) for value in values]
    wanted += [{"crop": ",".join([value, "0", "9", "9"])} for value in values]
    wanted += [{"time": f"0,{value}"} for value in values]
    for said in wanted:
        answer = site.client.post("/api/v1/synthesize", data={"method": method, **said}, files=files)
        in_words(answer, {name: value[:40] for name, value in said.items()})


def routes(app: FastAPI) -> Iterator[APIRoute]:
    def below(routes: Iterable[Any]) -> Iterator[APIRoute]:
        for route in routes:
            if isinstance(route, APIRoute):
                yield route
            else:
                yield from below(getattr(getattr(route, "original_router", route), "routes", ()))

    return below(app.routes)


def test_every_query_of_every_route_takes_odd_numbers(site: Any, experiment: dict[str, Any], clip: str) -> None:
    """Also those of pages, which are in no document; the form's page takes any name of a parameter besides."""
    paths = {"sample_id": clip, "experiment_id": experiment["id"], "name": "texture", "first_id": experiment["id"]}
    paths["second_id"] = experiment["id"]
    parameters = {name for method in METHODS.values() for name in numeric(method)}
    asked = 0
    for route in routes(site.app):
        if "GET" not in (route.methods or ()):
            continue
        names = {entry.alias for entry in route.dependant.query_params}
        path = route.path
        if path.endswith("/samples/{sample_id}"):
            names |= parameters | {"method", "size", *LISTS}
        if path.startswith(("/methods/", "/api/v1/methods/")):
            path = path.replace("{name}", "rpn")
        for name in names:
            for value in TEXTS:
                lists = [f"{value},{value},{value},{value}", f"{clip}:{value},0,8,8@{value},{value}"]
                for text in [value, *(lists if name in LISTS and len(value) < 400 else ())]:
                    answer = site.client.get(path.format(**paths), params={name: text})
                    assert answer.status_code < 500, (path, name, text[:40])
                    asked += 1
    assert asked > 500


def test_every_number_in_a_header_may_be_odd(site: Any, experiment: dict[str, Any]) -> None:
    output = f"/api/v1/experiments/{experiment['id']}/outputs/texture"
    for value in (*NEVER, *TEXTS):
        written = value.strip().encode()
        for address, name, content in (
            (output, "Range", b"bytes=" + written + b"-" + written),
            (output, "Range", b"bytes=-" + written),
            ("/api/v1/experiments?limit=1", "Prefer", b"wait=" + written),
            (f"/api/v1/experiments/{experiment['id']}/events", "Last-Event-ID", written),
        ):
            answer = site.client.get(address, headers=[(name.encode(), content)])
            assert answer.status_code < 500, (address, name, value[:40])
