"""What comes in the place of the service's answers, such as a proxy's own pages, is told in plain words."""

import re
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, Route, expect

PAGE = "<!doctype html><html><head><title>Gateway</title></head><body><h1>Sorry</h1></body></html>"
TOO_LARGE = "too large for this server or the proxy in front of it"
AWAY = "cannot be reached at the moment"
REPLACED = "answered in its place"
BROKEN = "The connection broke"
ANSWERS: list[tuple[int, str]] = [
    (413, TOO_LARGE),
    (502, AWAY),
    (503, AWAY),
    (504, AWAY),
    (200, REPLACED),
    (401, "wants a login"),
    (429, "too many requests"),
    (500, "answered 500"),
    (0, BROKEN),
]
CROP = "crop=190,60,256,256"


def stand_in(page: Page, address: str, status: int, body: str = PAGE) -> None:
    """Answer in the service's place, as a proxy does; with status 0 the connection breaks."""

    def answer(route: Route) -> None:
        if status:
            route.fulfill(status=status, content_type="text/html", body=body)
        else:
            route.abort("connectionreset")

    page.unroute(address)
    page.route(address, answer)


def hold(page: Page, address: str) -> list[Route]:
    """Keep requests unanswered."""
    held: list[Route] = []

    def keep(route: Route) -> None:
        held.append(route)

    page.route(address, keep)
    return held


def said_plainly(message: Locator, words: str) -> None:
    expect(message).to_contain_text(words)
    text = message.inner_text()
    assert not re.search(r"JSON|token|<|Error|undefined|fetch", text), text
    assert re.search(r"try again|send a smaller file", text), text
    expect(message).to_be_focused()


@pytest.fixture
def page(visitors: Any) -> Page:
    """Browsers log failed requests; here they are what is tested."""
    visitors.refusals_expected = True
    opened: Page = visitors.visit("/")
    yield opened
    failed = "Failed to load resource: "
    visitors.complaints[:] = [text for text in visitors.complaints if not text.startswith(failed)]


@pytest.mark.parametrize(("status", "words"), ANSWERS)
def test_a_first_upload(page: Page, photograph: Path, status: int, words: str) -> None:
    stand_in(page, "**/api/v1/samples", status)
    page.set_input_files("#file", photograph)
    said_plainly(page.locator("#upload-error"), words)
    expect(page.get_by_role("button", name="Choose a photograph")).to_be_visible()
    page.unroute("**/api/v1/samples")
    page.set_input_files("#file", photograph)
    page.wait_for_url("**/samples/*")


@pytest.mark.parametrize(("status", "words"), ANSWERS)
def test_an_upload_in_a_further_input(page: Page, photograph: Path, status: int, words: str) -> None:
    page.goto("/samples/gravel_gray?method=mix")
    stand_in(page, "**/api/v1/samples", status)
    page.set_input_files("#input-2-file", photograph)
    said_plainly(page.locator("#input-2 .sending"), words)
    expect(page.get_by_role("button", name="Synthesise")).to_be_enabled()
    page.unroute("**/api/v1/samples")
    before = page.input_value("#input-2-sample")
    page.set_input_files("#input-2-file", photograph)
    expect(page.locator("#input-2-sample")).not_to_have_value(before)
    expect(page.locator("#input-2 .sending")).to_be_empty()


def test_who_has_gone_on_to_other_things_is_not_called_back(page: Page, photograph: Path) -> None:
    page.goto("/samples/gravel_gray?method=mix")
    held = hold(page, "**/api/v1/samples")
    with page.expect_request("**/api/v1/samples"):
        page.set_input_files("#input-2-file", photograph)
    page.focus("#seed")
    held[0].fulfill(status=413, content_type="text/html", body=PAGE)
    expect(page.locator("#input-2 .sending")).to_contain_text(TOO_LARGE)
    expect(page.locator("#seed")).to_be_focused()


@pytest.mark.parametrize(
    ("status", "body", "words"),
    [
        (0, "", BROKEN),
        (502, PAGE, AWAY),
        (200, PAGE, REPLACED),
        (422, '{"detail": "The crop holds transparent pixels."}', "The crop holds transparent pixels."),
    ],
)
def test_the_meter_forgets_the_verdict_of_another_crop(page: Page, status: int, body: str, words: str) -> None:
    """Until it knows the new one, which it asks for as soon as the connection is back."""
    page.goto(f"/samples/rockface_pink?{CROP}")
    meter = page.locator("[data-input='1'] .structure")
    number = meter.locator(".meter-number")
    expect(meter.locator(".structure-words")).to_contain_text("Micro-texture")
    expect(number).to_be_visible()
    stand_in(page, "**/structure?crop=*", status, body)
    page.fill("#crop-x", "8")
    page.locator("#crop-x").blur()
    expect(meter).to_have_class(re.compile("unknown"))
    expect(number).to_be_hidden()
    expect(meter.locator(".structure-words")).to_have_text(re.compile(re.escape(words)))
    assert meter.get_attribute("data-verdict") is None
    page.unroute("**/structure?crop=*")
    with page.expect_response("**/structure?crop=*") as answer:
        if status == 422:
            page.fill("#crop-x", "16")
            page.locator("#crop-x").blur()
        else:
            page.evaluate("dispatchEvent(new Event('online'))")
    expect(meter).not_to_have_class(re.compile("unknown"))
    assert float(number.inner_text()) == pytest.approx(max(0, answer.value.json()["delta"]), abs=0.0051)


def test_the_meter_asks_again_by_itself(page: Page) -> None:
    """A service that was restarted is no event of the browser."""
    page.goto(f"/samples/rockface_pink?{CROP}")
    meter = page.locator("[data-input='1'] .structure")
    expect(meter.locator(".structure-words")).to_contain_text("Micro-texture")
    stand_in(page, "**/structure?crop=*", 502)
    page.fill("#crop-x", "8")
    page.locator("#crop-x").blur()
    expect(meter).to_have_class(re.compile("unknown"))
    page.unroute("**/structure?crop=*")
    expect(meter).not_to_have_class(re.compile("unknown"))


def test_the_meter_does_not_wait_for_ever(page: Page) -> None:
    """A question that nobody answers is given up, and the crop of then is not taken for the one of now."""
    page.clock.install()
    page.goto(f"/samples/rockface_pink?{CROP}")
    meter = page.locator("[data-input='1'] .structure")
    expect(meter.locator(".structure-words")).to_contain_text("Micro-texture")
    hold(page, "**/structure?crop=*")
    with page.expect_request("**/structure?crop=*"):
        page.fill("#crop-x", "8")
        page.locator("#crop-x").blur()
    page.clock.run_for(21_000)
    expect(meter).to_have_class(re.compile("unknown"))
    expect(meter.locator(".structure-words")).to_contain_text("has not answered in time")
