"""Where the viewer puts its pictures, measured on the screen: wheel, zoom, pan, cut, tiles, two fingers."""

from io import BytesIO
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, expect

TEXTURE = ".pane:nth-child(2) img"
STAGE = ".pane:not([hidden]) .stage"
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
HINT = "To zoom: Ctrl + wheel"


def opened(visitors: Any, experiment: dict[str, Any], query: str = "", **options: Any) -> Page:
    page: Page = visitors.visit(f"/experiments/{experiment['id']}{query}", **options)
    expect(page.locator(".viewer.live")).to_be_visible()
    return page


def rectangle(page: Page, selector: str) -> np.ndarray:
    """Left, top, right and bottom on the screen, in pixels."""
    measure = (
        "element => { const box = element.getBoundingClientRect(); return [box.x, box.y, box.right, box.bottom]; }"
    )
    return np.array(page.locator(selector).first.evaluate(measure), dtype=float)


def place(page: Page, across: float, down: float) -> np.ndarray:
    """A point of the second stage: parts of its width and height from its left and top."""
    left, top, right, bottom = rectangle(page, ".pane:nth-child(2) .stage")
    return np.array([left + across * (right - left), top + down * (bottom - top)])


def scale(page: Page) -> float:
    """Screen pixels of a pixel of the texture."""
    left, _, right, _ = rectangle(page, TEXTURE)
    return float(right - left) / int(page.locator(TEXTURE).get_attribute("width") or 0)


def under(page: Page, point: np.ndarray) -> np.ndarray:
    """The texture's pixel, with a fraction, that lies under a point of the screen."""
    return np.array((point - rectangle(page, TEXTURE)[:2]) / scale(page))


def wheel(page: Page, *, up: float, ctrl: bool = False) -> None:
    if ctrl:
        page.keyboard.down("Control")
    page.mouse.wheel(0, -up)
    if ctrl:
        page.keyboard.up("Control")


def zoomed(page: Page, before: float) -> None:
    page.wait_for_function(
        "before => document.querySelector('.scale').textContent !== before", arg=f"{before:.0%}".replace("%", " %")
    )


def test_the_wheel_scrolls_the_page_over_the_pictures(visitors: Any, experiment: dict[str, Any]) -> None:
    """It zooms with Ctrl, or once the pictures have the focus; and scrolls again when they have lost it."""
    page = opened(visitors, experiment)
    expect(page.get_by_text(HINT)).to_be_visible()
    page.mouse.move(*place(page, 0.5, 0.5))
    fitted = scale(page)
    wheel(page, up=-240)
    page.wait_for_function("() => scrollY === 240")
    assert scale(page) == fitted
    page.evaluate("scrollTo(0, 0)")
    page.mouse.move(*place(page, 0.5, 0.5))
    wheel(page, up=240, ctrl=True)
    zoomed(page, fitted)
    assert scale(page) > 1.3 * fitted
    assert page.evaluate("scrollY") == 0
    page.mouse.click(*place(page, 0.5, 0.5))
    expect(page.locator(".panes")).to_be_focused()
    before = scale(page)
    wheel(page, up=-120)
    zoomed(page, before)
    assert scale(page) < before
    assert page.evaluate("scrollY") == 0
    page.get_by_role("heading", level=1).click()
    before = scale(page)
    page.mouse.move(*place(page, 0.5, 0.5))
    wheel(page, up=-240)
    page.wait_for_function("() => scrollY === 240")
    assert scale(page) == before


def test_a_trackpads_pinch_zooms_by_its_small_steps(visitors: Any, experiment: dict[str, Any]) -> None:
    """It comes as a wheel with Ctrl, some pixels a step, and twenty of these are a gesture."""
    page = opened(visitors, experiment)
    page.mouse.move(*place(page, 0.5, 0.5))
    before = scale(page)
    for _ in range(20):
        wheel(page, up=4, ctrl=True)
    page.wait_for_function("() => parseInt(document.querySelector('.scale').textContent) >= 222")
    assert scale(page) == pytest.approx(before * np.exp(20 * 4 * 0.01), rel=0.01)


def test_what_lies_under_the_pointer_stays_there(visitors: Any, experiment: dict[str, Any]) -> None:
    """While one zooms in and out, also where the pictures have been moved already."""
    page = opened(visitors, experiment)
    for across, down, up in ((0.3, 0.4, 400), (0.7, 0.6, 300), (0.6, 0.3, -250)):
        point = place(page, across, down)
        page.mouse.move(*point)
        lies, before = under(page, point), scale(page)
        wheel(page, up=up, ctrl=True)
        zoomed(page, before)
        assert abs(np.log(scale(page) / before)) > 0.4
        # Pictures begin at whole pixels of the screen.
        assert under(page, point) == pytest.approx(lies, abs=1 / before + 1 / scale(page))


def test_pictures_cannot_be_thrown_out_of_sight(visitors: Any, experiment: dict[str, Any]) -> None:
    """However far they are dragged, the middle of the stage shows something of the larger one."""
    page = opened(visitors, experiment)
    for way in (-1, 1):
        for _ in range(4):
            start = place(page, 0.5 - 0.4 * way, 0.5 - 0.4 * way)
            page.mouse.move(*start)
            page.mouse.down()
            page.mouse.move(*place(page, 0.5 + 0.4 * way, 0.5 + 0.4 * way), steps=3)
            page.mouse.up()
        left, top, right, bottom = rectangle(page, TEXTURE)
        nearest = [left, top] if way > 0 else [right, bottom]
        assert nearest == pytest.approx(place(page, 0.5, 0.5), abs=1)


def shot(page: Page, hide: str) -> np.ndarray:
    """The pixels (H, W, 3) of the stage, without the dividers upon it."""
    page.evaluate("hide => document.querySelectorAll(hide).forEach(each => (each.style.opacity = 0))", hide)
    picture = page.locator(STAGE).first.screenshot()
    return np.asarray(Image.open(BytesIO(picture)).convert("RGB")).astype(int)


def test_the_sliders_cut_is_where_its_divider_is(visitors: Any, experiment: dict[str, Any]) -> None:
    """Left of it is all crop, right of it all texture, to the pixel, also of pictures that are zoomed and moved."""
    page = opened(visitors, experiment, "?view=slider")
    for _ in range(6):
        page.get_by_role("button", name="Zoom in").click()
    left, top, right, _bottom = rectangle(page, STAGE)
    page.mouse.move(left + 600, top + 300)
    page.mouse.down()
    page.mouse.move(left + 430, top + 340, steps=3)
    page.mouse.up()
    divider = page.get_by_role("slider")
    divider.press("End")
    crop = shot(page, ".divider")
    divider.press("Home")
    texture = shot(page, ".divider")
    for _ in range(3):
        divider.press("PageUp")
    cut = shot(page, ".divider")
    at = round(0.3 * (right - left))
    assert np.array_equal(cut[:, : at - 1], crop[:, : at - 1])
    assert np.array_equal(cut[:, at + 1 :], texture[:, at + 1 :])
    # And there is something to tell apart on both sides.
    assert np.abs(crop - texture)[:, at - 20 : at].mean() > 4
    assert np.abs(crop - texture)[:, at : at + 20].mean() > 4


@pytest.mark.parametrize("tiles", [2, 3])
def test_tiles_fit_the_stage(visitors: Any, experiment: dict[str, Any], tiles: int) -> None:
    """All n × n of them are seen, at the scale that is told, with some of the ground around them."""
    page = opened(visitors, experiment, "?view=tiled")
    page.get_by_role("button", name=f"{tiles} × {tiles}").click()
    told = int(page.locator(".scale").inner_text().removesuffix(" %")) / 100
    for number, name in ((1, "crop"), (2, "texture")):
        size = next((each["width"], each["height"]) for each in experiment["outputs"] if each["name"] == name)
        left, top, right, bottom = rectangle(page, f".pane:nth-child({number}) .tile")
        assert (right - left, bottom - top) == pytest.approx(np.array(size) * tiles * told, rel=0.02)
        stage = rectangle(page, f".pane:nth-child({number}) .stage")
        assert left > stage[0] + 4
        assert top > stage[1] + 4
        assert right < stage[2] - 4
        assert bottom < stage[3] - 4


def test_two_fingers_zoom_as_they_part(visitors: Any, experiment: dict[str, Any]) -> None:
    """Twice as far apart is twice as large, half as far half as large, about the place between them."""
    page = opened(visitors, experiment, "?view=flip", **PHONE)
    expect(page.get_by_text(HINT)).to_be_hidden()
    touch = page.context.new_cdp_session(page)
    image = ".over .stage img:nth-of-type(2)"
    left, top, right, bottom = rectangle(page, STAGE)
    middle = np.array([(left + right) / 2 + 20, (top + bottom) / 2 - 10])

    def fingers(kind: str, apart: float | None) -> None:
        sides = [] if apart is None else [-apart / 2, apart / 2]
        points = [{"x": middle[0] + side, "y": middle[1], "id": number} for number, side in enumerate(sides)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    for begin, end in ((60, 120), (160, 80)):
        before = rectangle(page, image)
        fingers("touchStart", begin)
        for apart in np.linspace(begin, end, 6)[1:]:
            fingers("touchMove", float(apart))
        fingers("touchEnd", None)
        after = rectangle(page, image)
        grown = (after[2] - after[0]) / (before[2] - before[0])
        assert grown == pytest.approx(end / begin, rel=0.05)
        assert after[:2] == pytest.approx(middle + (before[:2] - middle) * grown, abs=4)
