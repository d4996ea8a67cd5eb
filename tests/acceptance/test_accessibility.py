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
    "films-tiled",
}  # no colours of their own
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@pytest.fixture(scope="session")
def pages(site: Any, experiment: dict[str, Any]) -> dict[str, str]:
    """Name → address of every kind of page."""
    other = site.run("sand_desert009", (256, 256, 256, 192), method="adsn", width=384, height=288, seed=7)
    site.run("gravel_gray", (96, 96, 256, 256))
    mixture = site.run("gravel_gray", (96, 96, 192, 192), "mix", "towel_red", "rockface_pink", seed=2)
    convergence = site.run("gravel_gray", (96, 96, 128, 128), "dsn", convergence=True, spot="disc")
    films = site.run("sand_under_water", (40, 40, 96, 96), "video-rpn", frames=8)
    return {
        "home": "/",
        "sample": "/samples/scene_china",
        "several-samples": "/samples/gravel_gray?method=mix&third=towel_red",
        "clip": "/samples/sky_pan?method=video-patchwork&time=12,48",
        "clip-frame": "/samples/sky_pan?method=rpn&time=12,1",
        "clip-lacking": "/samples/gravel_gray?method=video-patchwork",
        "mixture": f"/experiments/{mixture['id']}",
        "convergence": f"/experiments/{convergence['id']}",
        "experiment": f"/experiments/{experiment['id']}",
        "flip": f"/experiments/{experiment['id']}?view=flip",
        "slider": f"/experiments/{experiment['id']}?view=slider",
        "tiled": f"/experiments/{experiment['id']}?view=tiled&tiles=3",
        "steps": f"/experiments/{experiment['id']}?view=steps",
        "compare": f"/compare/{experiment['id']}/{other['id']}",
        "films": f"/experiments/{films['id']}",
        "films-tiled": f"/experiments/{films['id']}?view=tiled",
        "methods": "/methods",
        "method-of-films": "/methods/video-rpn",
        "archive": "/archive",
        "nothing": "/nothing-here",
    }


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
