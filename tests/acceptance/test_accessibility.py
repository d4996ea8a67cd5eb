"""Every page in both themes, on a desk and on a phone: nothing that axe complains of, no sideways scrolling."""

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

Check = Callable[[Page], None]

THEMES = ("light", "dark")
ALIKE = {
    "clip-frame",
    "clip-lacking",
    "mixture",
    "convergence",
    "slider",
    "tiled",
    "videos-tiled",
}  # no colours of their own
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


def settle(page: Page) -> None:
    """Wait until the pictures that are in sight are there."""
    page.wait_for_function("() => [...document.images].every(image => image.loading === 'lazy' || image.complete)")


@pytest.mark.parametrize("theme", THEMES)
def test_axe_finds_no_violation_on_any_page(
    visitors: Any, pages: dict[str, str], theme: str, assert_accessible: Check, screenshot: Callable[..., None]
) -> None:
    visitors.refusals_expected = True
    page = visitors.visit(color_scheme=theme)
    for name, address in pages.items():
        if theme == "dark" and name in ALIKE:
            continue
        page.goto(address)
        settle(page)
        assert_accessible(page)
        screenshot(page, f"{name}-{theme}")


def test_pages_fit_a_phone(visitors: Any, pages: dict[str, str], screenshot: Callable[..., None]) -> None:
    """Nothing scrolls sideways, and what is to be touched is 24 pixels at least; themes differ in colours only."""
    visitors.refusals_expected = True
    page = visitors.visit(color_scheme="dark", **PHONE)
    for name, address in pages.items():
        page.goto(address)
        settle(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, name
        small = page.evaluate(
            """() => [...document.querySelectorAll("button, .button, input, select, summary, nav a")]
                .map(element => [element, element.getBoundingClientRect()])
                .filter(([element, box]) => box.width > 1 && box.height > 1 && (box.width < 24 || box.height < 24))
                .map(([element]) => element.outerHTML.slice(0, 80))"""
        )
        assert small == [], name
        screenshot(page, f"{name}-phone")


@pytest.mark.parametrize("theme", THEMES)
def test_refused_forms_and_waiting_rooms_are_accessible(
    visitors: Any, theme: str, assert_accessible: Check, screenshot: Callable[..., None]
) -> None:
    visitors.refusals_expected = True
    page = visitors.visit("/samples/grass_jungle002?width=8192&height=8192&size=free", color_scheme=theme)
    page.get_by_role("button", name="Synthesise").click()
    expect(page.get_by_role("progressbar")).to_be_visible()
    assert_accessible(page)
    screenshot(page, f"waiting-{theme}")
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="Cancelled")).to_be_visible()
    assert_accessible(page)
    page.goto("/samples/scene_china?seed=-1")
    page.get_by_role("button", name="Synthesise").click()
    expect(page.locator(".summary")).to_be_visible()
    assert_accessible(page)
    screenshot(page, f"refused-{theme}")
