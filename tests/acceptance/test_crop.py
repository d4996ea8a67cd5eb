"""The crop: its box and its four numbers always say the same, down to the photograph's borders."""

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

SIDES = ("x", "y", "width", "height")


def crop_of(page: Page) -> list[int]:
    return [int(page.input_value(f"#crop-{side}")) for side in SIDES]


def box_of(page: Page) -> list[float]:
    """Where the box is, in pixels of the original."""
    return page.evaluate(
        """() => {
            const frame = document.querySelector("#frame"), scale = parseFloat(frame.style.width) / frame.dataset.width;
            const box = document.querySelector(".box").style;
            return ["left", "top", "width", "height"].map(side => parseFloat(box[side]) / scale);
        }"""
    )


def on_screen(page: Page, x: float, y: float) -> tuple[float, float]:
    bounds = page.locator("#frame").bounding_box()
    assert bounds is not None
    scale = bounds["width"] / float(page.get_attribute("#frame", "data-width") or 0)
    return bounds["x"] + x * scale, bounds["y"] + y * scale


def drag(page: Page, start: tuple[float, float], end: tuple[float, float]) -> None:
    page.mouse.move(*on_screen(page, *start))
    page.mouse.down()
    page.mouse.move(*on_screen(page, *end), steps=4)
    page.mouse.up()


def test_typed_numbers_move_the_box(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china")
    for side, value in zip(SIDES, (17, 33, 101, 67), strict=True):
        page.fill(f"#crop-{side}", str(value))
    assert box_of(page) == pytest.approx([17, 33, 101, 67], abs=0.01)


def test_a_number_that_does_not_fit_makes_the_others_give_way(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china?crop=100,100,200,200")
    page.fill("#crop-x", "600")
    page.locator("#crop-x").blur()
    assert crop_of(page) == [600, 100, 40, 200]
    page.fill("#crop-width", "9999")
    page.locator("#crop-width").blur()
    assert crop_of(page) == [0, 100, 640, 200]


def test_dragging_beyond_the_borders_reaches_them_exactly(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china?crop=100,100,200,200")
    drag(page, (100, 100), (-30, -30))
    drag(page, (300, 300), (700, 460))
    assert crop_of(page) == [0, 0, 640, 427]


def test_every_handle_moves_its_own_edges(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china")
    left, top, right, bottom = 100, 100, 300, 260
    x, y = (left + right) / 2, (top + bottom) / 2
    handles = {
        (left, top): "left top", (x, top): "top", (right, top): "right top", (right, y): "right",
        (right, bottom): "right bottom", (x, bottom): "bottom", (left, bottom): "left bottom", (left, y): "left",
    }  # fmt: skip
    for (at_x, at_y), edges in handles.items():
        page.get_by_role("button", name="Suggested").click()
        for side, value in zip(SIDES, (left, top, right - left, bottom - top), strict=True):
            page.fill(f"#crop-{side}", str(value))
        drag(page, (at_x, at_y), (at_x + 20, at_y + 16))
        x0, y0, width, height = crop_of(page)
        expected = [
            left + 20 * ("left" in edges),
            top + 16 * ("top" in edges),
            right + 20 * ("right" in edges),
            bottom + 16 * ("bottom" in edges),
        ]
        assert [x0, y0, x0 + width, y0 + height] == pytest.approx(expected, abs=1), edges


def test_a_click_beside_the_box_keeps_the_crop(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china?crop=100,100,200,200")
    page.mouse.click(*on_screen(page, 500, 400))
    assert crop_of(page) == [100, 100, 200, 200]


def test_touch_draws_and_moves_on_a_phone(visitors: Any, screenshot: Callable[..., None]) -> None:
    """One finger on the photograph draws; the page does not scroll under it."""
    options = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
    page = visitors.visit("/samples/sand_desert009?crop=0,0,1024,1024", **options)
    touch = page.context.new_cdp_session(page)

    def send(kind: str, *points: tuple[float, float]) -> None:
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in points]})

    def swipe(start: tuple[float, float], end: tuple[float, float]) -> None:
        send("touchStart", on_screen(page, *start))
        for step in (0.25, 0.5, 0.75, 1):
            middle = [a + step * (b - a) for a, b in zip(start, end, strict=True)]
            send("touchMove", on_screen(page, *middle))
        send("touchEnd")

    slack = 1.5 * 1024 / 358
    swipe((200, 300), (600, 700))
    assert crop_of(page) == pytest.approx([200, 300, 400, 400], abs=slack)
    swipe((400, 500), (500, 450))
    assert crop_of(page) == pytest.approx([300, 250, 400, 400], abs=2 * slack)
    assert page.evaluate("scrollY") == 0
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    screenshot(page, "sample-phone")


def test_the_size_of_the_texture_follows_the_crop(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china?crop=100,100,101,67")
    page.select_option("#size", "1.5")
    assert [page.input_value("#width"), page.input_value("#height")] == ["152", "101"]  # halves are rounded up
    page.fill("#crop-width", "200")
    assert page.input_value("#width") == "300"
    page.fill("#height", "77")
    expect(page.locator("#size")).to_have_value("free")
    page.fill("#crop-width", "50")
    assert [page.input_value("#width"), page.input_value("#height")] == ["300", "77"]


def test_a_method_shows_its_own_parameters_and_keeps_those_in_common(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china")
    page.locator("#method-rpn ~ .own summary").click()
    page.fill("#rpn-alpha", "0.2")
    page.get_by_text("ADSN", exact=True).click()
    expect(page.locator("#rpn-alpha")).to_be_hidden()
    expect(page.locator("#adsn-alpha")).to_be_visible()
    expect(page.locator("#adsn-alpha")).to_have_value("0.2")


def test_a_new_seed_is_another_number(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china?seed=4")
    page.get_by_role("button", name="New seed").click()
    assert page.input_value("#seed") != "4"


def test_back_finds_the_form_as_it_was(visitors: Any) -> None:
    """Whether the browser kept the page or loads it anew: crop, method, parameters and size are in its address."""
    page = visitors.visit("/samples/gravel_gray")
    for side, value in zip(SIDES, (20, 30, 64, 48), strict=True):
        page.fill(f"#crop-{side}", str(value))
    page.get_by_text("ADSN", exact=True).click()
    page.select_option("#size", "2")
    page.fill("#seed", "11")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()
    page.go_back()
    for _ in range(2):
        assert crop_of(page) == [20, 30, 64, 48]
        expect(page.locator("#method-adsn")).to_be_checked()
        expect(page.locator("#size")).to_have_value("2")
        expect(page.locator("#seed")).to_have_value("11")
        assert box_of(page) == pytest.approx([20, 30, 64, 48], abs=0.01)
        page.goto(page.url)
