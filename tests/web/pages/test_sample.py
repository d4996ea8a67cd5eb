"""Sample page: its form as the server fills, reads and refuses it."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.cli.run import output_size
from app.images.crop import Rectangle
from tests.web.pages.markup import Page, get

CROP = {"crop.x": "4", "crop.y": "6", "crop.width": "20", "crop.height": "16"}
FORM = {"sample": "gravel_gray", **CROP, "method": "rpn", "size": "1", "seed": "3", "rpn.alpha": "0.1"}


def test_a_large_photograph_starts_with_its_middle(site: Any, picture: Callable[..., bytes]) -> None:
    sample = site.upload(picture(700, 90, mode="L"))
    page = get(site, f"/samples/{sample['id']}")
    assert [page.value(name) for name in CROP] == ["94", "0", "512", "90"]


def test_the_address_of_a_sample_page_fills_its_form(site: Any) -> None:
    query = "crop=1,2,30,31&method=adsn&width=100&height=90&seed=5&alpha=0.25&window=gaussian&add_smooth=on"
    page = get(site, f"/samples/gravel_gray?{query}")
    assert [page.value(name) for name in CROP] == ["1", "2", "30", "31"]
    assert "checked" in page.all("input", id="method-adsn")[0]
    assert page.value("seed") == "5"
    assert page.value("adsn.alpha") == "0.25"
    assert "checked" in page.all("input", name="adsn.add_smooth")[0]
    assert "checked" not in page.all("input", name="rpn.add_smooth")[0]
    assert "selected" in page.all("option", value="free")[0]


def test_a_wrong_address_opens_the_suggested_crop(site: Any) -> None:
    page = get(site, "/samples/gravel_gray?crop=1,2,999,31&method=none&size=7")
    assert [page.value(name) for name in CROP] == ["8", "8", "32", "32"]


def test_a_submitted_form_becomes_an_experiment(site: Any) -> None:
    answer = site.client.post("/experiments", data={**FORM, "size": "1.5", "unlisted": "on"})
    assert answer.status_code == 303
    record = site.client.get("/api/v1" + answer.headers["location"]).json()
    assert record["inputs"][0]["crop"] == {"x": 4, "y": 6, "width": 20, "height": 16}
    assert (record["parameters"]["width"], record["parameters"]["height"], record["parameters"]["seed"]) == (30, 24, 3)
    assert record["listed"] is False


def test_a_plain_form_takes_decimal_commas(site: Any) -> None:
    """As the script would have sent them, and as the record then says."""
    answer = site.client.post("/experiments", data={**FORM, "rpn.alpha": "0,25", "crop.x": " 4 ", "seed": "3.0"})
    assert answer.status_code == 303
    record = site.client.get("/api/v1" + answer.headers["location"]).json()
    assert (record["parameters"]["alpha"], record["parameters"]["seed"]) == (0.25, 3)
    assert record["inputs"][0]["crop"]["x"] == 4


def test_half_a_pixel_is_rounded_up_as_on_the_command_line(site: Any) -> None:
    odd = {**FORM, "crop.width": "31", "crop.height": "23", "size": "1.5"}
    answer = site.client.post("/experiments", data=odd)
    record = site.client.get("/api/v1" + answer.headers["location"]).json()
    size = (record["parameters"]["width"], record["parameters"]["height"])
    assert size == output_size("x1.5", Rectangle(0, 0, 31, 23)) == (47, 35)


@pytest.mark.parametrize(
    ("changed", "field", "words"),
    [
        ({"crop.x": "60"}, "crop", "reaches outside the photograph"),
        (
            {"crop.width": "abc"},
            "crop",
            "four whole numbers: x, y, width and height in pixels; got &#34;abc&#34; for width.",
        ),
        ({"crop.x": "12,5"}, "crop", "got &#34;12,5&#34; for x."),
        ({"crop.y": "1.000", "crop.x": ""}, "crop", "got &#34;&#34; for x, got &#34;1.000&#34; for y."),
        ({"rpn.alpha": "1.234,5"}, "rpn-alpha", "is a number from 0 to 0.5; got &#34;1.234,5&#34;."),
        ({"width": "64,5", "size": "free"}, "width", "Width is a whole number from 1 to 1000000; got &#34;64,5&#34;."),
        ({"seed": "-1"}, "seed", "Seed is a whole number"),
        ({"rpn.alpha": "0.9"}, "rpn-alpha", "from 0 to 0.5"),
        ({"rpn.add_smooth": "on", "size": "2"}, "rpn-add_smooth", "smooth component"),
        ({"size": "7"}, "size", "Choose one of the sizes"),
        ({"method": "none"}, "method", "Choose a method"),
    ],
)
def test_a_refused_form_says_why_at_the_field(site: Any, changed: dict[str, str], field: str, words: str) -> None:
    """With what was typed kept, and the message part of the field's description."""
    answer = site.client.post("/experiments", data=FORM | changed)
    assert answer.status_code == 422
    message = re.search(rf'id="{field}-error">([^<]*)<', answer.text)
    assert message is not None
    assert words in message[1]
    page = Page(answer.text)
    assert page.title.startswith("Error")
    targets = {attributes["id"] for _, attributes in page.elements if "id" in attributes}
    links = [link["href"] for link in page.all("a") if link["href"].startswith("#") and "class" not in link]
    assert links
    assert {link[1:] for link in links} <= targets
    for name, value in changed.items():
        if name not in {"method", "size"} and value != "on":
            assert page.value(name) == value
    if field not in {"method", "size"}:
        described = [a for _, a in page.elements if f"{field}-error" in a.get("aria-describedby", "")]
        assert described


def test_a_full_queue_keeps_the_form(
    serve: Callable[..., Any], until: Callable[[Callable[[], object]], None], tmp_path: Path
) -> None:
    """With 503 and the words of the service; the same form can be sent again."""
    with serve(tmp_path, queue_limit=1) as site, site.gate.closed():
        site.client.post("/experiments", data=FORM)
        until(lambda: site.service.waiting == 0)  # a worker has it
        site.client.post("/experiments", data=FORM)
        answer = site.client.post("/experiments", data=FORM)
        assert answer.status_code == 503
        assert Page(answer.text).value("seed") == "3"
        assert "Server busy — try again shortly" in answer.text


def test_texts_of_visitors_are_escaped(site: Any) -> None:
    answer = site.client.post("/experiments", data=FORM | {"seed": '"><script>alert(1)</script>'})
    assert "<script>alert" not in answer.text


def test_reloading_a_refused_form_leads_on(site: Any) -> None:
    assert site.client.get("/experiments").headers["location"] == "/archive"


def test_a_sample_that_is_gone_is_not_found(site: Any) -> None:
    assert site.client.get("/samples/unknown").status_code == 404
    answer: httpx.Response = site.client.post("/experiments", data=FORM | {"sample": "unknown"})
    assert answer.status_code == 404
