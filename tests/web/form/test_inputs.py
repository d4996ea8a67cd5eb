"""The form of a sample's page for methods that take several samples, as the server writes and reads it."""

import html
import re
from collections.abc import Callable
from typing import Any

import pytest

CROP = {"crop.x": "4", "crop.y": "6", "crop.width": "20", "crop.height": "16"}
FORM = {"sample": "gravel_gray", **CROP, "method": "mix", "size": "1", "seed": "3", "mix.strip": "2"}
SIDES = ("x", "y", "width", "height")


@pytest.fixture(scope="module")
def other(site: Any, picture: Callable[..., bytes]) -> str:
    """The id of an uploaded sample of 600 × 90 pixels."""
    return str(site.upload(picture(600, 90, seed=5))["id"])


def crop_fields(number: int, *values: int) -> dict[str, str]:
    return {f"input-{number}.crop.{side}": str(value) for side, value in zip(SIDES, values, strict=True)}


def value(text: str, name: str) -> str:
    found = re.search(rf'name="{re.escape(name)}"[^>]* value="([^"]*)"', text)
    assert found is not None, name
    return found[1]


def chosen(text: str, number: int) -> str:
    """What the select of an input has."""
    select = text.split(f'name="input-{number}.sample"')[1].split("</select>", maxsplit=1)[0]
    found = re.search(r'<option value="([^"]*)"[^>]* selected>', select)
    return found[1] if found else ""


def record_of(site: Any, answer: Any) -> dict[str, Any]:
    assert answer.status_code == 303, answer.text
    return dict(site.client.get("/api/v1" + answer.headers["location"]).json())


def boxes(record: dict[str, Any]) -> list[tuple[Any, ...]]:
    return [(source["sample"], *(source["crop"][side] for side in SIDES)) for source in record["inputs"]]


def test_further_samples_and_their_crops_become_inputs(site: Any, other: str) -> None:
    further = {"input-2.sample": other, **crop_fields(2, 30, 10, 40, 50), "input-3.sample": ""}
    record = record_of(site, site.client.post("/experiments", data=FORM | further))
    assert boxes(record) == [("gravel_gray", 4, 6, 20, 16), (other, 30, 10, 40, 50)]
    assert (record["parameters"]["width"], record["parameters"]["height"]) == (20, 16)


def test_a_crop_left_empty_is_the_suggested_one_or_the_middle(site: Any, other: str) -> None:
    further = {"input-2.sample": "gravel_gray", "input-4.sample": other}
    record = record_of(site, site.client.post("/experiments", data=FORM | further))
    assert boxes(record)[1:] == [("gravel_gray", 8, 8, 32, 32), (other, 44, 0, 512, 90)]


def test_a_method_of_one_input_leaves_the_others_aside(site: Any, other: str) -> None:
    further = {"method": "rpn", "input-2.sample": other, **crop_fields(2, 0, 0, 9999, 9)}
    assert len(boxes(record_of(site, site.client.post("/experiments", data=FORM | further)))) == 1


def test_a_photograph_can_be_sent_along(site: Any, picture: Callable[..., bytes]) -> None:
    """Without a script the form uploads it."""
    files = {"input-2.file": ("photo.png", picture(40, 30)), "input-3.file": ("", b"")}
    answer = site.client.post("/experiments", data=FORM | {"input-2.sample": "gravel_gray"}, files=files)
    sample, *crop = boxes(record_of(site, answer))[1]
    assert sample != "gravel_gray"
    assert crop == [0, 0, 40, 30]


def test_a_file_that_is_no_photograph_is_refused_at_its_field(site: Any) -> None:
    files = {"input-2.file": ("notes.png", b"This is text.")}
    answer = site.client.post("/experiments", data=FORM | {"input-2.sample": "gravel_gray"}, files=files)
    assert answer.status_code == 422
    message = re.search(r'id="input-2-sample-error">([^<]+)<', answer.text)
    assert message is not None
    assert "PNG" in message[1]
    assert value(answer.text, "seed") == "3"


@pytest.mark.parametrize(
    ("changed", "field", "words"),
    [
        ({"input-2.sample": ""}, "input-2-sample", "Choose the second sample"),
        ({"input-2.sample": "gone"}, "input-2-sample", "no such photograph"),
        ({"input-2.crop.x": "60"}, "input-2-crop", "four whole numbers"),
        (crop_fields(2, 60, 0, 40, 40), "input-2-crop", "reaches outside the photograph"),
        ({"input-4.sample": "gravel_gray", **crop_fields(4, 0, 0, 0, 5)}, "input-4-crop", "at least 1 × 1"),
        ({"mix.weights": "1,2,3"}, "mix-weights", "weight"),
        ({"mix.weights": "much"}, "mix-weights", "number"),
        ({"method": "modulus-phase", "size": "2"}, "width", "smaller"),
    ],
)
def test_what_is_wrong_with_an_input_is_said_at_its_field(
    site: Any, changed: dict[str, str], field: str, words: str
) -> None:
    """In the field's description, and in a summary that leads to it."""
    answer = site.client.post("/experiments", data=FORM | {"input-2.sample": "gravel_gray"} | changed)
    assert answer.status_code == 422
    message = re.search(rf'id="{field}-error">([^<]*)<', answer.text)
    assert message is not None
    assert words in html.unescape(message[1])
    target = re.search(r'<li><a href="#([^"]+)">', answer.text)
    assert target is not None
    assert re.search(rf'id="{target[1]}"[^>]*aria-describedby="[^"]*{field}-error', answer.text)


def test_the_service_s_own_refusal_is_said_at_the_input_it_is_about(site: Any, picture: Callable[..., bytes]) -> None:
    clear = site.upload(picture(40, 30, mode="RGBA"))["id"]
    further = {"input-2.sample": "", "input-3.sample": clear}
    answer = site.client.post("/experiments", data=FORM | further | {"input-2.sample": "gravel_gray"})
    assert answer.status_code == 422
    assert re.search(r'id="input-3-crop-error">[^<]*transparent', answer.text)


def test_the_address_keeps_every_input(site: Any, other: str) -> None:
    address = f"/samples/gravel_gray?method=mix&crop=1,2,30,31&second={other}:10,20,30,40&third=gravel_gray"
    text = site.client.get(address).text
    assert chosen(text, 2) == other
    assert [value(text, f"input-2.crop.{side}") for side in SIDES] == ["10", "20", "30", "40"]
    assert chosen(text, 3) == "gravel_gray"
    assert [value(text, f"input-3.crop.{side}") for side in SIDES] == [""] * 4
    assert chosen(text, 4) == ""


@pytest.mark.parametrize("said", ["gone", "gone:1,2,3,4", "", ":", "gravel_gray:0,0,999,9"])
def test_a_wrong_address_offers_some_sample_and_no_crop(site: Any, said: str) -> None:
    text = site.client.get(f"/samples/gravel_gray?method=mix&second={said}").text
    assert chosen(text, 2) == "gravel_gray"
    assert value(text, "input-2.crop.x") == ""


def test_showing_what_was_chosen_keeps_the_rest_of_the_form(site: Any, other: str) -> None:
    """The button that does so without a script; it runs nothing."""
    typed = FORM | {"input-2.sample": other, "mix.weights": "1,3", "size": "free", "width": "50", "show": "2"}
    before = site.service.experiments.counts()
    answer = site.client.post("/experiments", data=typed)
    assert answer.status_code == 303
    assert site.service.experiments.counts() == before
    text = site.client.get(answer.headers["location"]).text
    assert chosen(text, 2) == other
    assert f'src="/api/v1/samples/{other}/image' in text
    for name in ("crop.x", "seed", "width", "mix.weights", "mix.strip"):
        assert value(text, name) == typed[name]


def test_an_experiment_s_form_has_all_of_its_inputs(site: Any, other: str) -> None:
    sizes = {"gravel_gray": (4, 6, 20, 16), other: (30, 10, 40, 50)}
    inputs = [{"sample": sample, "crop": dict(zip(SIDES, box, strict=True))} for sample, box in sizes.items()]
    record = site.finished(method="mix", inputs=inputs, parameters={"strip": 2})
    page = site.client.get(f"/experiments/{record['id']}").text
    link = re.search(r'href="(/samples/[^"]+)">Change crop', page)
    assert link is not None
    text = site.client.get(html.unescape(link[1])).text
    assert chosen(text, 2) == other
    assert value(text, "input-2.crop.width") == "40"
    assert value(text, "mix.strip") == "2"
