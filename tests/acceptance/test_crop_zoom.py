"""The photograph enlarged in its frame by wheel and keys: crops mean what they show, and all of it comes back."""

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page

from tests.acceptance.crops import box_of, crop_of, drag, on_screen, sight_of


def zoom_in(page: Page, x: float, y: float, turns: float) -> None:
    """Turn the wheel with Ctrl over a place of the original."""
    page.mouse.move(*on_screen(page, x, y))
    page.keyboard.down("Control")
    page.mouse.wheel(0, -100 * turns)
    page.keyboard.up("Control")


@pytest.mark.parametrize(
    ("start", "end", "crop"),
    [
        ((630.1, 400), (630.1, 420), [630, 400, 1, 20]),
        ((600, 410.2), (620, 410.2), [600, 410, 20, 1]),
        ((639.6, 400), (900, 420), [639, 400, 1, 20]),
        ((620, 426.6), (600, 900), [600, 426, 20, 1]),
    ],
)
def test_a_line_drawn_is_one_pixel_wide_where_that_is_no_slip(
    visitors: Any, start: tuple[float, float], end: tuple[float, float], crop: list[int]
) -> None:
    """Enlarged eight times, and also along the photograph's border: never a crop of no pixels."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160", viewport={"width": 1440, "height": 1400})
    page.wait_for_selector("#frame.ready")
    before = sight_of(page).scale
    zoom_in(page, 638, 425, 20)
    page.wait_for_function(
        "before => document.querySelector('#frame img').getBoundingClientRect().width / 640 > 2 * before", arg=before
    )
    assert sight_of(page).scale == pytest.approx(8)
    x, y = on_screen(page, 600, 400)
    page.mouse.move(x, y)
    page.mouse.down(button="middle")
    page.mouse.move(x - 60, y - 60, steps=3)  # to the border, which stops it
    page.mouse.up(button="middle")
    drag(page, start, end)
    assert crop_of(page) == crop
    assert box_of(page) == pytest.approx(crop, abs=0.1)


def test_the_wheel_with_ctrl_zooms_about_the_pointer_and_alone_scrolls(
    visitors: Any, screenshot: Callable[..., None]
) -> None:
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160", viewport={"width": 1440, "height": 500})
    page.wait_for_selector("#frame.ready")
    whole = sight_of(page)
    place = on_screen(page, 400, 200)
    zoom_in(page, 400, 200, 1)
    page.wait_for_function("() => document.querySelector('#frame').classList.contains('zoomed')")
    near = sight_of(page)
    assert near.scale / whole.scale == pytest.approx(2.718, rel=0.01)
    assert near.at(400, 200) == pytest.approx(place, abs=2.8)  # of a wheel, browsers tell whole pixels only
    assert crop_of(page) == [100, 100, 200, 160]
    page.mouse.down(button="middle")
    page.mouse.move(place[0] + 50, place[1] - 30, steps=3)
    page.mouse.up(button="middle")
    assert (sight_of(page).x - near.x, sight_of(page).y - near.y) == pytest.approx((50, -30), abs=0.5)
    page.mouse.wheel(0, 120)
    page.wait_for_function("() => scrollY > 0")
    assert sight_of(page).scale == near.scale


def test_keys_zoom_and_show_all_again(visitors: Any) -> None:
    """The crop stays in view; the arrow keys take the view along."""
    page = visitors.visit("/samples/scene_china?crop=20,20,60,60")
    page.wait_for_selector("#frame.ready")
    whole, frame = sight_of(page), page.locator("#frame").bounding_box()
    assert frame is not None
    page.locator("#frame .box").focus()
    for _ in range(3):
        page.keyboard.press("+")
    assert sight_of(page).scale / whole.scale == pytest.approx(2**1.5)
    for key in ("Control+ArrowRight", "Control+ArrowDown") * 30:
        page.keyboard.press(key)
        box = page.locator("#frame .box").bounding_box()
        assert box is not None
        assert box["x"] >= frame["x"] - 0.1
        assert box["y"] >= frame["y"] - 0.1
        assert box["x"] + box["width"] <= frame["x"] + frame["width"] + 0.1
        assert box["y"] + box["height"] <= frame["y"] + frame["height"] + 0.1
    assert crop_of(page) == [320, 320, 60, 60]
    page.keyboard.press("-")
    assert sight_of(page).scale / whole.scale == pytest.approx(2)
    page.keyboard.press("0")
    assert sight_of(page) == whole
    tools = page.locator("#crop-tools")
    tools.get_by_role("button", name="Zoom in").click()
    assert sight_of(page).scale > whole.scale
    tools.get_by_role("button", name="Fit").click()
    page.evaluate("scrollTo(0, 0)")
    assert sight_of(page) == whole


def test_a_crop_set_otherwise_comes_into_view(visitors: Any) -> None:
    """Typed, taken back or suggested, of an enlarged photograph."""
    page = visitors.visit("/samples/scene_china?crop=20,20,60,60")
    page.wait_for_selector("#frame.ready")
    tools = page.locator("#crop-tools")
    for _ in range(4):
        tools.get_by_role("button", name="Zoom in").click()

    def in_view() -> bool:
        box = page.locator("#frame .box").bounding_box()
        frame = page.locator("#frame").bounding_box()
        assert box is not None
        assert frame is not None
        return all(
            frame[start] - 0.1 <= box[start] and box[start] + box[long] <= frame[start] + frame[long] + 0.1
            for start, long in (("x", "width"), ("y", "height"))
        )

    assert in_view()
    page.locator("#crop-x").click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("500")
    page.keyboard.press("Tab")
    assert crop_of(page) == [500, 20, 60, 60]
    assert in_view()
    tools.get_by_role("button", name="Undo").click()
    assert crop_of(page) == [20, 20, 60, 60]
    assert in_view()
