"""Forced colours, as Windows' high contrast: whatever is chosen, filled or dragged is told by more than its colour."""

import re
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.acceptance.conftest import ROOT

WIDTHS = (390, 1440, 2560)
LEVELS = 64  # of luminance: what is less apart is not told apart
SEEN = 30  # pixels: two strokes of a letter

# How each state looks, without colours: what is compared of the element that shows it, and of what is drawn around it.
SIGNATURE = """element => {
    const shown = element.matches(".method > input") ? element.nextElementSibling : element;
    const sides = ["top", "right", "bottom", "left"].flatMap(side => [`border-${side}-width`, `border-${side}-style`]);
    const names = [...sides, "outline-width", "outline-style", "outline-offset", "text-decoration-line", "font-weight"];
    const drawn = ["content", "display", "width", "height", "transform"];
    return [null, "::before", "::after"].map(part => {
        const style = getComputedStyle(shown, part);
        const absent = part && style.content === "none";
        return absent ? "" : [...names, ...(part ? drawn : [])].map(name => style.getPropertyValue(name)).join(" ");
    }).join(" | ");
}"""

# Selector of what is chosen → how a script takes the choice back.
CHOSEN = {
    ".thumbnails .current": "e => e.classList.remove('current')",
    "button[aria-disabled=true]": "e => e.setAttribute('aria-disabled', 'false')",
    "button[aria-pressed=true]": "e => e.setAttribute('aria-pressed', 'false')",
    "[aria-current]": "e => e.removeAttribute('aria-current')",
    ".method > input:checked": "e => { e.checked = false; }",
    "[aria-invalid]": "e => e.removeAttribute('aria-invalid')",
}
# What browsers themselves draw in forced colours.
NATIVE = {"#unlisted": "e => { e.checked = !e.checked; }"}


def pixels(element: Locator, margin: int = 6) -> np.ndarray:
    """The luminance (H, W) of an element as it is on the screen, and of a margin around it."""
    element.evaluate("e => e.scrollIntoView({ block: 'center' })")
    box = element.bounding_box()
    assert box is not None
    left, top = max(0, box["x"] - margin), max(0, box["y"] - margin)
    clip: Any = {"x": left, "y": top, "width": box["width"] + 2 * margin, "height": box["height"] + 2 * margin}
    return np.asarray(Image.open(BytesIO(element.page.screenshot(clip=clip))).convert("L")).astype(int)


def apart(one: np.ndarray, other: np.ndarray) -> int:
    return int((np.abs(one - other) > LEVELS).sum())


def shown_of(element: Locator) -> Locator:
    """Of a method the label, which stands for its radio button."""
    hidden = element.evaluate("e => e.matches('.method > input')")
    return element.locator("xpath=following-sibling::label") if hidden else element


def forced(visitors: Any, **options: Any) -> Page:
    visitors.refusals_expected = True
    page: Page = visitors.visit("about:blank", forced_colors="active", reduced_motion="reduce", **options)
    return page


def settle(page: Page) -> None:
    page.wait_for_function("() => [...document.images].every(image => image.loading === 'lazy' || image.complete)")
    page.evaluate("document.activeElement?.blur()")


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_what_is_chosen_is_told_without_colours(visitors: Any, pages: dict[str, str], theme: str) -> None:
    """On every page: the same element chosen and not chosen differs in its lines or letters, and in its pixels."""
    page = forced(visitors, color_scheme=theme, viewport={"width": 1440, "height": 2000})
    found = set()
    for name, address in pages.items():
        page.goto(address)
        settle(page)
        for selector, take_back in CHOSEN.items():
            for element in page.locator(selector).all():
                shown = shown_of(element)
                if not shown.is_visible():
                    continue
                found.add(selector)
                said, seen = element.evaluate(SIGNATURE), pixels(shown)
                handle = element.element_handle()
                handle.evaluate(take_back)
                where = f"{selector} on {name}"
                assert handle.evaluate(SIGNATURE) != said, where
                box = handle.evaluate_handle(
                    "e => e.matches('.method > input') ? e.nextElementSibling : e"
                ).as_element()
                box.evaluate("e => e.setAttribute('data-seen', '')")
                after = pixels(page.locator("[data-seen]"))
                box.evaluate("e => e.removeAttribute('data-seen')")
                assert apart(seen, after) > SEEN, where
                break  # the others of this page have the same rule
    assert found == set(CHOSEN) - {"[aria-invalid]"}


def test_what_the_browser_draws_is_left_to_it(visitors: Any) -> None:
    page = forced(visitors)
    page.goto("/samples/gravel_gray")
    for selector, change in NATIVE.items():
        element = page.locator(selector).first
        before = pixels(element)
        element.evaluate(change)
        assert apart(before, pixels(element)) > SEEN, selector


def test_a_refused_field_is_told_without_colours(visitors: Any) -> None:
    page = forced(visitors)
    page.goto("/samples/gravel_gray?seed=-1")
    page.get_by_role("button", name="Synthesise").click()
    field = page.locator("#seed[aria-invalid]")
    expect(field).to_be_visible()
    expect(page.get_by_role("button", name="New seed")).to_be_visible()  # the script's, which narrows the field
    page.evaluate("document.activeElement.blur()")
    said, before = field.evaluate(SIGNATURE), pixels(field)
    page.locator("#seed").evaluate("e => e.removeAttribute('aria-invalid')")
    assert page.locator("#seed").evaluate(SIGNATURE) != said
    assert apart(before, pixels(page.locator("#seed"))) > SEEN


METER = "[data-input='1'] .structure"
# Page, what is looked at, and how it is filled to a part.
LENGTHS = {
    "meter": (
        "/samples/crazy_paving001",
        f"{METER} .meter-bar",
        "(e, part) => e.querySelector('.meter-value').setAttribute('width', 100 * part)",
    ),
    "meter of a picture": (
        "/experiments/{experiment}",
        "figcaption .meter-bar",
        "(e, part) => e.querySelector('.meter-value').setAttribute('width', 100 * part)",
    ),
    "upload": ("/", "#sent", "(e, part) => { e.closest('[hidden]')?.removeAttribute('hidden'); e.value = part; }"),
    "time range": (
        "/samples/sky_pan?method=video-rpn",
        ".track",
        "(e, part) => { const range = e.querySelector('.range'); "
        "Object.assign(range.style, { left: '0%', width: `${100 * part}%` }); "
        "for (const end of e.querySelectorAll('.end, .now')) end.hidden = true; }",
    ),
}


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("name", LENGTHS)
def test_a_length_is_seen_against_its_frame(visitors: Any, experiment: dict[str, Any], name: str, theme: str) -> None:
    """Empty it is as the page behind it, but for a frame; what is filled differs from both."""
    address, selector, fill = LENGTHS[name]
    page = forced(visitors, color_scheme=theme)
    page.goto(address.format(experiment=experiment["id"]))
    settle(page)
    element = page.locator(selector).first
    element.evaluate(fill, 0)
    empty = pixels(element)
    element.evaluate(fill, 0.5)
    half = pixels(element)
    ground = empty[1, 1]
    rows, columns = empty.shape
    middle = slice(rows // 2 - 1, rows // 2 + 2)
    at = [6 + round(part * (columns - 12)) for part in (0.18, 0.82)]
    filled, free = (half[middle, x - 2 : x + 3].mean() for x in at)
    assert abs(free - ground) < LEVELS / 2
    assert abs(filled - free) > LEVELS
    framed = np.abs(empty[rows // 2 - 9 : rows // 2 + 10, at[0]] - ground)
    assert framed.max() > LEVELS


def test_the_crop_is_seen_on_any_photograph(visitors: Any) -> None:
    """Its lines have two opposite colours; handles and box are there on black and on white."""
    page = forced(visitors)
    page.goto("/samples/gravel_gray?crop=96,96,320,320")
    page.wait_for_selector(".frame.ready")
    settle(page)
    for shade in ("#000", "#fff"):
        page.evaluate(
            """shade => {
                const parts = document.querySelectorAll("#frame img, #frame .shade");
                for (const part of parts) part.style.visibility = "hidden";
                Object.assign(document.querySelector("#frame").style, {background: shade, forcedColorAdjust: "none"});
                document.querySelector("#frame .box").style.forcedColorAdjust = "auto";
            }""",
            shade,
        )
        box = page.locator("#frame .box")
        seen = pixels(box)
        box.evaluate("e => { e.style.visibility = 'hidden'; }")
        gone = pixels(box)
        box.evaluate("e => { e.style.visibility = ''; }")
        assert apart(seen[20:-20, :14], gone[20:-20, :14]) > len(seen) - 80, shade
        assert apart(seen[:14, :14], gone[:14, :14]) > SEEN, shade


def test_the_divider_is_seen_on_any_picture(visitors: Any, experiment: dict[str, Any]) -> None:
    page = forced(visitors)
    page.goto(f"/experiments/{experiment['id']}?view=slider")
    divider = page.locator(".divider").first
    expect(divider).to_be_visible()
    settle(page)
    seen = pixels(divider, 0)
    divider.evaluate("e => { e.style.visibility = 'hidden'; }")
    gone = pixels(divider, 0)
    assert apart(seen, gone) > seen.shape[0]
    column = seen[: seen.shape[0] // 3, 8:-8]
    assert np.ptp(column, axis=1).min() > LEVELS  # light and dark side by side, all the way


@pytest.mark.parametrize("width", WIDTHS)
def test_every_page_is_there_to_be_looked_at(visitors: Any, pages: dict[str, str], screenshot: Any, width: int) -> None:
    """Nothing scrolls sideways, and a screenshot of each is left for a person."""
    page = forced(visitors, viewport={"width": width, "height": 844 if width == WIDTHS[0] else 900})
    for name, address in {**pages, "structure": "/structure", "catalogue": "/catalogue", "figures": "/figures"}.items():
        page.goto(address)
        settle(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width, name
        screenshot(page, f"{name}-forced-{width}")


def test_every_state_that_a_stylesheet_knows_is_looked_at_here() -> None:
    """A new state cannot come in by a rule of colours alone without a line above."""
    known = {"aria-pressed", "aria-current", "aria-invalid", "aria-busy", "aria-disabled", ":checked", ".current"}
    states = re.compile(r"aria-[a-z]+|:checked|\.current|\.selected|\.active|\.chosen(?= )")
    sheets = ROOT.glob("static/css/*.css")
    found = {
        state for sheet in sheets for state in states.findall(re.sub(r"/\*.*?\*/", "", sheet.read_text(), flags=re.S))
    }
    assert found - {".chosen"} <= known
