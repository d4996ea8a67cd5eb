"""A visitor reads how a method works, runs it by its button, and looks at what came of it."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from app.methods.registry import METHODS

Shown = Callable[[Page, str], np.ndarray]
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
PAGES = ["/methods", "/catalogue", "/figures", "/methods/rpn", "/methods/mix"]


@pytest.mark.parametrize("name", METHODS)
def test_a_method_is_run_from_its_page(visitors: Any, site: Any, shown_pixels: Shown, name: str) -> None:
    """Its picture has the size that its record says, and is not one grey."""
    page = visitors.visit("/methods")
    page.get_by_role("main").locator(f'a[href="/methods/{name}"]').click()
    expect(page.get_by_role("heading", level=1)).to_have_text(METHODS[name].title)
    assert page.locator("math[display=block]").first.bounding_box()["height"] > 8
    page.get_by_role("link", name="Run it").click()
    expect(page.locator(f"#method-{name}")).to_be_checked()
    if "candidates" in METHODS[name].params.model_fields:  # a quick search: the page's own looks everywhere
        page.locator(f'[name="{name}.candidates"]').fill("20")
    if METHODS[name].moving:  # a short one: every frame is encoded five times
        page.locator('[name="time.count"]').fill("24")
        page.locator('[name="frames"]').fill("6")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url(re.compile("/experiments/"))
    expect(page.get_by_role("heading", name="Time by stage")).to_be_visible()
    identifier = page.url.rsplit("/", 1)[-1]
    texture = site.client.get(f"/api/v1/experiments/{identifier}").json()["outputs"][0]
    shown = 'video:has(source[src*="/outputs/texture?"])' if METHODS[name].moving else 'img[src*="/outputs/texture"]'
    pixels = shown_pixels(page, shown)
    assert pixels.shape == (texture["height"], texture["width"], 3)
    assert pixels.std() > 4  # grey levels; the evenest sample of any page has about 8


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_pages_of_the_laboratory_are_accessible(
    visitors: Any, theme: str, assert_accessible: Callable[[Page], None]
) -> None:
    page = visitors.visit(color_scheme=theme)
    for path in PAGES:
        page.goto(path)
        assert_accessible(page)


def test_pages_of_the_laboratory_fit_a_phone(visitors: Any) -> None:
    page = visitors.visit(**PHONE)
    for path in PAGES:
        page.goto(path)
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, path
