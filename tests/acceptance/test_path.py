"""The whole way: a photograph comes in, a crop is drawn, one button is pressed, and the texture is on the screen."""

import base64
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import JSHandle, Page, expect

from tests.acceptance.crops import crop_of
from tests.acceptance.keyboard import tab_to

TEXTURE = ".pane:nth-child(2) img"


def assert_is_texture_of(texture: np.ndarray, sample: np.ndarray) -> None:
    """A random phase noise of the sample: its size, mean and spread, but not its pixels, and without a seam."""
    assert texture.shape == sample.shape
    a, b = texture.astype(float), sample.astype(float)
    # The mean is kept exactly; rounding moves it by less than half a level, cutting off the few values out of range by
    # less than another half.
    assert np.abs(a.mean((0, 1)) - b.mean((0, 1))).max() < 1
    # The periodic component's variance is kept, which lacks what the smooth component has.
    assert 0.7 < a.std() / b.std() < 1.05
    deviations = [(picture - picture.mean((0, 1))).ravel() for picture in (a, b)]
    assert abs(np.corrcoef(*deviations)[0, 1]) < 0.5
    # On a torus the step over the edge is one of equals: among the W + H others it is not the largest by far.
    for axis in (0, 1):
        inside = np.abs(np.diff(a, axis=axis)).mean(axis=(1 - axis, 2))
        over = np.abs(a.take(0, axis) - a.take(-1, axis)).mean()
        assert over < inside.mean() + 4 * inside.std()


def test_upload_crop_run_see(
    visitors: Any, photograph: Path, shown_pixels: Callable[..., np.ndarray], screenshot: Callable[..., None]
) -> None:
    """Upload by the file chooser, draw a crop with the mouse, run RPN: the picture shown is a texture of that crop."""
    page = visitors.visit()
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Choose a photograph").click()
    chooser.value.set_files(photograph)
    page.wait_for_url("**/samples/*")
    assert crop_of(page) == [256, 256, 512, 512]
    page.get_by_role("button", name="Whole photograph").click()
    assert crop_of(page) == [0, 0, 1024, 1024]
    frame = page.locator("#frame.ready")
    frame.scroll_into_view_if_needed()
    box = frame.bounding_box()
    assert box is not None
    scale = box["width"] / 1024
    # A new crop is drawn.
    page.mouse.move(box["x"] + 500 * scale, box["y"] + 400 * scale)
    page.mouse.down()
    page.mouse.move(box["x"] + 700 * scale, box["y"] + 592 * scale, steps=4)
    page.mouse.up()
    assert crop_of(page) == pytest.approx([500, 400, 200, 192], abs=1.5 / scale)
    # One side is dragged.
    page.mouse.move(box["x"] + 700 * scale, box["y"] + 496 * scale)
    page.mouse.down()
    page.mouse.move(box["x"] + 756 * scale, box["y"] + 510 * scale, steps=3)
    page.mouse.up()
    assert crop_of(page) == pytest.approx([500, 400, 256, 192], abs=1.5 / scale)
    # And moved.
    page.mouse.move(box["x"] + 600 * scale, box["y"] + 500 * scale)
    page.mouse.down()
    page.mouse.move(box["x"] + 620 * scale, box["y"] + 480 * scale, steps=3)
    page.mouse.up()
    x, y, width, height = crop_of(page)
    assert (x, y) == pytest.approx((520, 380), abs=2 / scale)
    expect(page.locator("#crop-size")).to_contain_text(f"{width} × {height} of 1024 × 1024")
    screenshot(page, "sample-drawn")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()
    sample = np.asarray(Image.open(photograph).convert("RGB"))[y : y + height, x : x + width]
    assert np.array_equal(shown_pixels(page, ".pane:nth-child(1) img"), sample)
    assert_is_texture_of(shown_pixels(page, TEXTURE), sample)


def data_transfer(page: Page, path: Path, media_type: str) -> JSHandle:
    return page.evaluate_handle(
        """([data, name, type]) => {
            const bytes = Uint8Array.from(atob(data), c => c.charCodeAt(0));
            const transfer = new DataTransfer();
            transfer.items.add(new File([bytes], name, {type}));
            return transfer;
        }""",
        [base64.b64encode(path.read_bytes()).decode(), path.name, media_type],
    )


def test_a_photograph_can_be_dropped_anywhere(visitors: Any, photograph: Path) -> None:
    page = visitors.visit()
    transfer = data_transfer(page, photograph, "image/png")
    page.dispatch_event("h2", "dragenter", {"dataTransfer": transfer})
    assert page.evaluate("document.documentElement.classList.contains('dragging')")
    page.dispatch_event("h2", "drop", {"dataTransfer": transfer})
    page.wait_for_url("**/samples/*")
    expect(page.get_by_text("1024 × 1024 pixels")).to_be_visible()


def test_a_photograph_can_be_pasted(visitors: Any, photograph: Path) -> None:
    page = visitors.visit()
    transfer = data_transfer(page, photograph, "image/png")
    page.evaluate(
        "t => document.body.dispatchEvent(new ClipboardEvent('paste', {clipboardData: t, bubbles: true}))", transfer
    )
    page.wait_for_url("**/samples/*")
    expect(page.get_by_text("1024 × 1024 pixels")).to_be_visible()


def test_a_file_that_is_no_photograph_is_refused_with_words(
    visitors: Any, tmp_path: Path, screenshot: Callable[..., None]
) -> None:
    """The message stands at the drop zone, has the focus, and another file can be chosen at once."""
    visitors.refusals_expected = True
    text = tmp_path / "notes.png"
    text.write_text("This is not a photograph.")
    page = visitors.visit()
    page.set_input_files("#file", text)
    message = page.locator("#upload-error")
    expect(message).to_contain_text("PNG")
    expect(message).to_be_focused()
    expect(page.get_by_role("button", name="Choose a photograph")).to_be_visible()
    screenshot(page, "home-refused")


def test_a_file_that_is_too_large_is_not_sent(visitors: Any) -> None:
    page = visitors.visit("/")
    sent: list[str] = []
    page.on("request", lambda request: sent.append(f"{request.method} {request.url}"))
    page.evaluate("document.querySelector('#upload').dataset.limit = 2 ** 20")
    page.set_input_files("#file", {"name": "large.png", "mimeType": "image/png", "buffer": bytes(3 * 2**19)})
    expect(page.locator("#upload-error")).to_have_text(
        "This file has 1.5 MB; at most 1 MB can be taken: send a smaller one."
    )
    expect(page.locator("#upload-error")).to_be_focused()
    expect(page.get_by_role("button", name="Choose")).to_be_visible()
    assert not [request for request in sent if request.startswith("POST")]


def test_the_whole_way_by_keyboard(visitors: Any, photograph: Path) -> None:
    """Upload, crop, another method, run, zoom and flip without a pointer."""
    page = visitors.visit()
    page.keyboard.press("Tab")
    expect(page.get_by_role("link", name="Skip to the content")).to_be_focused()
    with page.expect_file_chooser() as chooser:
        tab_to(page, "#choose")
        page.keyboard.press("Enter")
    chooser.value.set_files(photograph)
    page.wait_for_url("**/samples/*")
    tab_to(page, ".box")
    for _ in range(6):
        page.keyboard.press("Control+Shift+ArrowLeft")
        page.keyboard.press("Control+Shift+ArrowUp")
    page.keyboard.press("Shift+ArrowRight")
    for _ in range(3):
        page.keyboard.press("Control+ArrowDown")
    page.keyboard.press("ArrowLeft")
    assert crop_of(page) == [255, 286, 453, 452]
    tab_to(page, "#method-rpn")
    page.keyboard.press("ArrowRight")
    expect(page.locator("#method-adsn")).to_be_checked()
    tab_to(page, "button.main")
    page.keyboard.press("Enter")
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()
    expect(page.get_by_role("heading", level=1)).to_contain_text("ADSN")
    tab_to(page, ".panes")
    before = page.locator(".scale").inner_text()
    page.keyboard.press("+")
    assert page.locator(".scale").inner_text() != before
    page.keyboard.press("f")
    expect(page.locator('[data-flip="0"]')).to_have_attribute("aria-pressed", "true")
