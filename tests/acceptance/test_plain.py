"""Everything without JavaScript: forms, links and plain pictures."""

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import expect


def test_the_whole_way_without_a_script(visitors: Any, photograph: Path, screenshot: Callable[..., None]) -> None:
    """Upload, numeric crop, method, size, run; the waiting page looks again by itself until the texture is there."""
    page = visitors.visit(java_script_enabled=False)
    page.set_input_files("#file", photograph)
    page.get_by_role("button", name="Upload").click()
    for side, value in {"x": 300, "y": 200, "width": 128, "height": 96}.items():
        page.fill(f"#crop-{side}", str(value))
    expect(page.locator("#adsn-alpha")).to_be_hidden()
    page.get_by_text("ADSN", exact=True).click()
    page.locator("#method-adsn ~ .own summary").click()
    expect(page.locator("#adsn-alpha")).to_be_visible()
    expect(page.locator("#rpn-alpha")).to_be_hidden()
    page.select_option("#size", "2")
    page.fill("#seed", "5")
    page.get_by_role("button", name="Synthesise").click()
    expect(page.get_by_role("heading", name="Time by stage")).to_be_visible()
    expect(page.get_by_role("heading", level=1)).to_contain_text("ADSN")
    pictures = page.locator(".pane img")
    expect(pictures).to_have_count(2)
    for index, size in enumerate([(128, 96), (256, 192)]):
        expect(pictures.nth(index)).to_be_visible()
        address = pictures.nth(index).get_attribute("src")
        assert address is not None
        assert Image.open(BytesIO(page.request.get(address).body())).size == size
    page.get_by_role("link", name="Tiled", exact=True).click()
    expect(page.locator(".pane img")).to_have_count(8)
    page.get_by_role("link", name="Steps").click()
    expect(page.locator(".steps img")).to_have_count(7)
    screenshot(page, "experiment-steps-plain")


def test_a_refused_form_keeps_what_was_typed(visitors: Any, screenshot: Callable[..., None]) -> None:
    """The message is at the field, is part of its description, and is named in a summary that has the focus."""
    visitors.refusals_expected = True
    page = visitors.visit("/samples/scene_china", java_script_enabled=False)
    page.fill("#crop-x", "600")
    page.fill("#seed", "-1")
    page.get_by_role("button", name="Synthesise").click()
    expect(page.locator(".summary")).to_be_focused()
    expect(page.locator("#crop-error")).to_contain_text("reaches outside the photograph, which is 640 × 427")
    expect(page.locator("#seed")).to_have_value("-1")
    expect(page.locator("#seed")).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#seed")).to_have_accessible_description(re.compile("Seed is a whole number from 0"))
    expect(page.locator("#crop-x")).to_have_value("600")
    screenshot(page, "sample-refused-plain")


def test_a_waiting_experiment_is_cancelled_by_a_form(visitors: Any) -> None:
    page = visitors.visit("/samples/grass_jungle002?width=8192&height=8192&size=free", java_script_enabled=False)
    page.get_by_role("button", name="Synthesise").click()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="Cancelled")).to_be_visible()
