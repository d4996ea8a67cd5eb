"""A finished page that is swapped into its waiting room works like the same page loaded afresh, for every method."""

import re
from collections.abc import Callable
from contextlib import AbstractContextManager
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, expect

from app.images.video.reader import read_video
from app.methods.registry import METHODS

# Whatever method has one of these parameters is quick with it, on a crop as small as this.
QUICK = {"candidates": 20, "grid": 16, "interval": 4, "iterations": 2, "frames": 6}
CROP = "8,16,96,88"
RANGE = "2,8"
NOISE = 1.0  # mean difference of values that a video's colour conversion may make
PICTURE = ":is(img, video)"
VIDEOS = "[...document.querySelectorAll('.stage video')]"

Shown = Callable[[Page, str], np.ndarray]
Waiting = Callable[[], AbstractContextManager[None]]
Works = Callable[[Page], None]


def form_of(name: str) -> str:
    method = METHODS[name]
    values: dict[str, Any] = {"method": name, "crop": CROP, "seed": 3}
    values |= {key: value for key, value in QUICK.items() if key in method.params.model_fields}
    if method.moving:
        values["time"] = RANGE
    query = "&".join(f"{key}={value}" for key, value in values.items())
    return f"/samples/{'sand_under_water' if method.moving else 'gravel_gray'}?{query}"


def assert_pictures(page: Page) -> None:
    """Every picture of the page has come, those that load late too."""
    for image in page.locator("main img").all():
        if image.is_visible():
            image.scroll_into_view_if_needed()
            expect(image).to_have_js_property("complete", value=True)
            expect(image).not_to_have_js_property("naturalWidth", 0)


def assert_views(page: Page) -> None:
    """Every view shows what it is for, and the way back to the first one."""
    panes = page.locator(".panes > .pane").count() - 1  # one is there for the pictures that lie upon each other
    beside = page.locator(f".pane:not([hidden]) .stage > {PICTURE}")
    for view in page.locator(".views a").all():
        name = view.get_attribute("data-view")
        view.click()
        expect(view).to_have_attribute("aria-current", "true")
        if name == "side":
            expect(beside).to_have_count(panes)
        elif name == "flip":
            for index in range(panes):
                page.locator(f"[data-flip='{index}']").click()
                visible = page.locator(f".over .stage > {PICTURE} >> visible=true")
                expect(visible).to_have_count(1)
        elif name == "slider":
            expect(page.locator(".divider")).to_have_count(panes - 1)
            divider = page.locator(".divider").last
            before = divider.bounding_box()
            divider.press("PageUp")
            assert divider.bounding_box() != before
        elif name == "tiled":
            page.get_by_role("button", name="3 × 3").click()
            expect(page.locator(".tile >> visible=true")).to_have_count(panes)
        elif name == "steps":
            expect(page.locator(".steps")).to_be_visible()
            assert_pictures(page)
    page.get_by_role("link", name="Side by side").click()
    page.get_by_role("button", name="Fit").click()
    scale = page.locator(".scale").inner_text()
    page.get_by_role("button", name="Zoom in").click()
    expect(page.locator(".scale")).not_to_have_text(scale)
    page.get_by_role("button", name="Fit").click()
    expect(page.locator(".scale")).to_have_text(scale)


def assert_plays(page: Page, frames: np.ndarray, shown_pixels: Shown, until: Callable[..., Any]) -> None:
    """All videos run, stand when they are told to, and step by one frame, which is the file's; (T, H, W, 3)."""
    page.wait_for_function(f"() => {VIDEOS}.every(video => !video.paused && video.readyState > 1)")
    before = page.evaluate(f"{VIDEOS}.map(video => video.currentTime)")
    page.wait_for_function(f"before => {VIDEOS}.every((video, at) => video.currentTime !== before[at])", arg=before)
    expect(page.get_by_text("cannot play")).to_be_hidden()
    page.get_by_role("button", name="Pause").click()
    page.wait_for_function(f"() => {VIDEOS}.every(video => video.paused)")
    page.get_by_role("slider", name="Frame").fill("1")
    output = page.locator(".player output")
    for number in (1, 2):
        expect(output).to_have_text(f"{number} / {len(frames)}")

        def stands(frame: np.ndarray = frames[number - 1]) -> bool:
            shown = shown_pixels(page, '.stage video:has(source[src*="/outputs/texture?"])')
            return bool(np.abs(shown.astype(int) - frame).mean() < NOISE)

        until(stands, f"frame {number} of the texture")
        page.get_by_role("button", name="Next frame").click()
    page.get_by_role("slider", name="Frame").fill("1")


def assert_downloads(page: Page) -> None:
    """Every file is there, and the first comes when its button is pressed."""
    links = page.get_by_role("region", name="Download the texture").get_by_role("link")
    assert links.count() >= 4
    for link in links.all():
        answer = page.request.get(str(link.get_attribute("href")))
        assert answer.ok
        assert len(answer.body()) > 100
    with page.expect_download() as download:
        links.first.click()
    assert Path(download.value.path()).stat().st_size > 100


def assert_texts(page: Page) -> None:
    """What can be copied is copied by its button."""
    buttons = page.get_by_role("button", name="Copy", exact=True)
    expect(buttons).to_have_count(3)
    buttons.first.click()
    expect(page.get_by_role("button", name="Copied")).to_be_visible()
    page.get_by_role("heading", level=1).click()
    page.evaluate("document.activeElement.blur()")
    expect(buttons).to_have_count(3)


@pytest.fixture
def works(visitors: Any, site: Any, shown_pixels: Shown, until: Callable[..., Any], tmp_path: Path) -> Works:
    """What a finished experiment's page has to be able to, however it came to be there."""

    def check(page: Page) -> None:
        expect(page.locator(".viewer.live")).to_be_visible()
        record = site.client.get("/api/v1/experiments/" + page.url.rsplit("/", 1)[-1]).json()
        moves = METHODS[record["method"]].moving
        texture = site.client.get(record["outputs"][0]["url"]).content
        if moves:
            (tmp_path / "texture").write_bytes(texture)
            assert_plays(page, np.stack(list(read_video(tmp_path / "texture"))), shown_pixels, until)
        else:
            shown = shown_pixels(page, '.stage img[src*="/outputs/texture"]')
            assert np.array_equal(shown, np.asarray(Image.open(BytesIO(texture)).convert("RGB")))
        assert_pictures(page)
        assert_views(page)
        assert_downloads(page)
        assert_texts(page)
        assert visitors.complaints == []

    return check


@pytest.mark.parametrize("name", METHODS)
def test_a_page_swapped_in_is_the_page_loaded_afresh(
    visitors: Any, busy: Waiting, works: Works, screenshot: Callable[..., None], name: str
) -> None:
    """From the form through the waiting room to the result; then all of it once more after a reload."""
    page = visitors.visit(form_of(name), permissions=["clipboard-read", "clipboard-write"])
    with busy():
        page.get_by_role("button", name="Synthesise").click()
        page.wait_for_url(re.compile("/experiments/"))
        expect(page.locator("[data-experiment]")).to_be_visible()
        page.evaluate("window.sameDocument = true")
    works(page)
    assert page.evaluate("window.sameDocument")
    screenshot(page, f"swapped-{name}", full_page=False)
    words, title = page.locator("main").inner_text(), page.title()
    page.reload()
    works(page)
    assert not page.evaluate("window.sameDocument")
    assert page.locator("main").inner_text() == words
    assert page.title() == title


def test_a_comparison_swapped_in_is_the_one_loaded_afresh(visitors: Any, busy: Waiting, experiment: Any) -> None:
    page = visitors.visit(f"/experiments/{experiment['id']}")
    with busy():
        page.get_by_role("button", name="ADSN with the same phase").click()
        page.wait_for_url(re.compile("/compare/"))
        expect(page.locator("[data-experiment]")).to_be_visible()
        page.evaluate("window.sameDocument = true")
    expect(page.locator(".viewer.live")).to_be_visible()
    assert page.evaluate("window.sameDocument")
    assert_pictures(page)
    assert_views(page)
    words, title = page.locator("main").inner_text(), page.title()
    page.reload()
    expect(page.locator(".viewer.live")).to_be_visible()
    assert_pictures(page)
    assert_views(page)
    assert page.locator("main").inner_text() == words
    assert page.title() == title
