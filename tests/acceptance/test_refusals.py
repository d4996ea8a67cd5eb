"""What the service refuses is still said, and has the focus, long after: only what mends it takes it away."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Page, Response, Route, expect

LATER = 5_000  # milliseconds
CHECK = "/experiments/check"
FIRST = {"x": "96", "y": "96", "width": "160", "height": "160"}
FORM = {"sample": "gravel_gray", **{f"crop.{side}": number for side, number in FIRST.items()}, "size": "1", "seed": "3"}
TWO = FORM | {"method": "mix", "input-2.sample": "towel_red"}


def wait_out(page: Page) -> None:
    """Let five seconds of the page's clock pass, and everything be answered that it asks in them."""
    page.clock.run_for(LATER)
    page.wait_for_load_state("networkidle")


def refused(page: Page, status: int) -> None:
    """Press the button, and get a page with this status."""
    with page.expect_response(lambda answer: answer.request.method == "POST" and CHECK not in answer.url) as answer:
        page.get_by_role("button", name="Synthesise").click()
    assert answer.value.status == status
    page.wait_for_load_state("load")


def open_form(visitors: Any, address: str, **options: Any) -> Page:
    visitors.refusals_expected = True
    page: Page = visitors.visit("about:blank", **options)
    page.clock.install()
    page.goto(address)
    page.wait_for_load_state("networkidle")
    return page


@dataclass(frozen=True)
class Sent:
    """A form as a browser without scripts sends it, with a file: its fields, the file, and the refusal's status."""

    fields: dict[str, str]
    files: dict[str, tuple[str, bytes]]
    status: int
    words: str


REFUSED_FILES = {
    "of another kind": Sent(TWO, {"input-2.file": ("notes.txt", b"This is not a photograph.")}, 422, "PNG"),
    "cut off": Sent(TWO, {"input-2.file": ("cut.png", b"\x89PNG\r\n\x1a\n" + bytes(20))}, 422, "damaged"),
}


def answered_with(page: Page, answer: httpx.Response) -> None:
    """Give the page this answer of the service to the form that it sends."""

    def fulfil(route: Route) -> None:
        kept = {name: value for name, value in answer.headers.items() if name in {"content-type", "retry-after"}}
        route.fulfill(status=answer.status_code, headers=kept, body=answer.text)

    page.route(re.compile("/experiments$"), fulfil)


def test_a_full_queue(visitors: Any, full_site: Any, assert_accessible: Any, screenshot: Any) -> None:
    """Until the form is sent again: no check knows of the queue, whatever is changed meanwhile."""
    page = open_form(visitors, f"{full_site.url}/samples/scene_china")
    refused(page, 503)
    summary = page.locator(".summary")
    wait_out(page)
    expect(summary).to_contain_text("Server busy — try again shortly")
    expect(summary).to_be_focused()
    expect(page).to_have_title(re.compile("^Error: "))
    assert_accessible(page)
    screenshot(page, "refused-busy")
    with page.expect_response(f"**{CHECK}"):
        page.fill("#seed", "4")
        page.clock.run_for(LATER)
    wait_out(page)
    expect(summary).to_contain_text("too many experiments wait")
    refused(page, 503)
    expect(summary).to_be_focused()


@pytest.mark.parametrize("kind", REFUSED_FILES)
def test_a_file_refused_in_a_further_input(visitors: Any, site: Any, kind: str) -> None:
    """Until another sample is chosen; that the one chosen before is in order is no answer to it."""
    sent = REFUSED_FILES[kind]
    answer = site.client.post("/experiments", data=sent.fields, files=sent.files)
    assert answer.status_code == sent.status
    page = open_form(visitors, "/samples/gravel_gray?method=mix&second=towel_red")
    answered_with(page, answer)
    refused(page, sent.status)
    summary, message = page.locator(".summary"), page.locator("#input-2-sample-error")
    wait_out(page)
    expect(summary).to_be_focused()
    expect(message).to_contain_text(sent.words)
    with page.expect_response(f"**{CHECK}"):
        page.fill("#seed", "4")
        page.clock.run_for(LATER)
    wait_out(page)
    expect(summary).to_be_visible()
    expect(message).to_contain_text(sent.words)
    with page.expect_response(f"**{CHECK}"):
        page.select_option("#input-2-sample", label="Mossy grass")
        page.clock.run_for(LATER)
    expect(summary).to_have_count(0)
    expect(message).to_be_hidden()
    expect(page).not_to_have_title(re.compile("^Error: "))


REFUSED_FIELDS = {
    "seed": ("/samples/gravel_gray?seed=-1", "#seed-error", ("#seed", "5")),
    "crop": ("/samples/gravel_gray", "#crop-error", ("#crop-x", "64")),
    "alpha": ("/samples/gravel_gray?alpha=0.9", "#rpn-alpha-error", ("#rpn-alpha", "0.2")),
    "grid": (
        "/samples/gravel_gray?method=patchwork&crop=96,96,64,64&grid=400",
        "#patchwork-grid-error",
        ("#patchwork-grid", "16"),
    ),
    "size": ("/samples/gravel_gray?size=free&width=99999&height=99999", "", ("#width", "64")),
}


@pytest.mark.parametrize("field", REFUSED_FIELDS)
def test_a_field_that_does_not_fit(visitors: Any, site: Any, field: str) -> None:
    """At the field and on top of the page, until the field is mended; a change elsewhere mends nothing."""
    address, selector, (mended, value) = REFUSED_FIELDS[field]
    page = open_form(visitors, address)
    if field == "crop":  # the editor would put it right
        answer = site.client.post("/experiments", data=FORM | {"method": "rpn", "crop.x": "6000"})
        answered_with(page, answer)
    refused(page, 422 if field != "size" else 413)
    summary = page.locator(".summary")
    wait_out(page)
    expect(summary).to_be_focused()
    words = summary.locator("li").inner_text()
    if selector:
        expect(page.locator(selector)).to_have_text(words)
    if field == "size":
        page.fill("#height", "64")
    with page.expect_response(f"**{CHECK}"):
        page.fill(mended, value)
        page.clock.run_for(LATER)
    expect(summary).to_have_count(0)
    if selector:
        expect(page.locator(selector)).to_be_hidden()
    assert page.locator("[aria-invalid]").count() == 0


def test_one_of_two_messages_goes_alone(visitors: Any) -> None:
    page = open_form(visitors, "/samples/gravel_gray?seed=-1&alpha=0.9")
    refused(page, 422)
    wait_out(page)
    items = page.locator(".summary li")
    expect(items).to_have_count(2)
    with page.expect_response(f"**{CHECK}"):
        page.fill("#seed", "5")
        page.clock.run_for(LATER)
    expect(items).to_have_count(1)
    expect(page.locator("#seed-error")).to_be_hidden()
    expect(page.locator("#rpn-alpha-error")).to_be_visible()


def sent_as(headers: dict[str, str]) -> Callable[[Page, Any], None]:
    """Get the answer to the same form with other headers, which no page can make a browser send."""

    def prepare(page: Page, site: Any) -> None:
        answered_with(page, site.client.post("/experiments", data=FORM | {"method": "rpn"}, headers=headers))

    return prepare


def too_large(page: Page, site: Any) -> None:
    big = {"input-2.file": ("big.png", bytes(34 << 20))}
    answered_with(page, site.client.post("/experiments", data=TWO, files=big))


def unknown_sample(page: Page, _site: Any) -> None:
    page.evaluate("document.querySelector('[name=sample]').value = 'gone'")


PAGES: dict[str, tuple[Callable[[Page, Any], None], int, str]] = {
    "another origin": (sent_as({"Origin": "http://texture.lan"}), 403, "MICROTEXTURE_BASE_URL"),
    "too large": (too_large, 413, "send a smaller one"),
    "a sample that is gone": (unknown_sample, 404, "There is no such photograph"),
    "no form at all": (sent_as({"Content-Type": "multipart/form-data"}), 400, "names no boundary"),
}


@pytest.mark.parametrize("kind", PAGES)
def test_a_refusal_with_a_page_of_its_own(visitors: Any, site: Any, kind: str) -> None:
    prepare, status, words = PAGES[kind]
    page = open_form(visitors, "/samples/gravel_gray")
    prepare(page, site)
    refused(page, status)
    wait_out(page)
    message = page.locator(".message")
    expect(message).to_contain_text(words)
    expect(message).to_be_focused()
    assert page.title()


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("notes.png", b"This is not a photograph.", "PNG"),
        ("big.png", bytes(34 << 20), "larger than 32 MB"),
        ("cut.png", b"\x89PNG\r\n\x1a\n" + bytes(20), "damaged"),
    ],
)
def test_a_file_refused_without_leaving_the_page(
    visitors: Any, tmp_path: Path, name: str, content: bytes, words: str
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    page = open_form(visitors, "/samples/gravel_gray?method=mix")

    def uploaded(answer: Response) -> bool:
        return answer.url.endswith("/api/v1/samples")

    with page.expect_response(uploaded):
        page.set_input_files("#input-2-file", path)
    message = page.locator("#input-2 .sending")
    expect(message).to_contain_text(words)
    wait_out(page)
    expect(message).to_contain_text(words)
    expect(message).to_be_focused()
    with page.expect_response(f"**{CHECK}"):
        page.evaluate("document.querySelector('#seed').dispatchEvent(new Event('input', { bubbles: true }))")
        page.fill("#seed", "4")
        page.clock.run_for(LATER)
    expect(message).to_contain_text(words)
