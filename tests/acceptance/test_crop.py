"""The crop: its box and its four numbers always say the same, down to the photograph's borders."""

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.acceptance.crops import SIDES, box_of, crop_of, drag, on_screen


def test_typed_numbers_move_the_box(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china")
    for side, value in zip(SIDES, (17, 33, 101, 67), strict=True):
        page.fill(f"#crop-{side}", str(value))
    assert box_of(page) == pytest.approx([17, 33, 101, 67], abs=0.1)


def type_in(page: Page, field: str, text: str) -> None:
    """As a person does: take what is there, type over it key by key, and go on to the next field."""
    page.locator(field).click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type(text)


@pytest.mark.parametrize(
    ("side", "typed", "crop", "words"),
    [
        ("x", "600", [440, 100, 200, 150], "x is 440 now: from 600 on, a width of 200 does not fit."),
        ("x", "9999", [440, 100, 200, 150], "x is 440 now"),
        ("y", "426", [100, 277, 200, 150], "y is 277 now: from 426 on, a height of 150 does not fit."),
        ("width", "600", [40, 100, 600, 150], "x is 40 now: from 100 on, a width of 600 does not fit."),
        ("height", "400", [100, 27, 200, 400], "y is 27 now"),
        ("width", "9999", [0, 100, 640, 150], "The width is 640 now: there is no more."),
        ("height", "9999", [100, 0, 200, 427], "The height is 427 now: there is no more."),
        ("width", "0", [100, 100, 1, 150], "The width is 1 now"),
        ("x", "-5", [0, 100, 200, 150], "x is 0 now"),
    ],
)
def test_a_number_that_does_not_fit_moves_the_crop_and_keeps_its_size(
    visitors: Any, side: str, typed: str, crop: list[int], words: str
) -> None:
    """Once its field is left; only what no place has room for shrinks. Until then the box stays as it was."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,150")
    type_in(page, f"#crop-{side}", typed)
    assert page.input_value(f"#crop-{side}") == typed
    assert box_of(page) == pytest.approx([100, 100, 200, 150], abs=0.1)
    page.keyboard.press("Tab")
    assert crop_of(page) == crop
    assert box_of(page) == pytest.approx(crop, abs=0.1)
    expect(page.locator("[data-fit=crop]").first).to_contain_text(words)


@pytest.mark.parametrize("start", ["0,0,640,427", "100,100,200,150", "630,400,10,27"])
def test_four_numbers_typed_one_after_the_other_are_the_crop(visitors: Any, start: str) -> None:
    """Whatever crop there was, and although one of them does not fit until the next one is typed."""
    page = visitors.visit(f"/samples/scene_china?crop={start}")
    page.locator("#crop-x").click()
    for number in ("600", "380", "40", "47"):
        page.keyboard.press("ControlOrMeta+a")
        page.keyboard.type(number)
        page.keyboard.press("Tab")
    assert crop_of(page) == [600, 380, 40, 47]
    expect(page.locator("[data-fit=crop]").first).to_be_hidden()


def test_a_field_left_empty_takes_back_what_it_had(visitors: Any) -> None:
    page = visitors.visit("/samples/scene_china?crop=100,100,200,150")
    page.locator("#crop-width").click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.press("Delete")
    page.keyboard.press("Tab")
    assert crop_of(page) == [100, 100, 200, 150]


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


@pytest.mark.parametrize(
    ("start", "end", "crop"),
    [
        ((100, 180), (500, 180), [299, 100, 1, 160]),
        ((300, 180), (20, 180), [100, 100, 1, 160]),
        ((200, 100), (200, 400), [100, 259, 200, 1]),
        ((200, 260), (200, 20), [100, 100, 200, 1]),
        ((100, 100), (600, 420), [299, 259, 1, 1]),
        ((300, 260), (10, 10), [100, 100, 1, 1]),
        ((300, 100), (10, 420), [100, 259, 1, 1]),
        ((100, 260), (600, 10), [299, 100, 1, 1]),
    ],
)
def test_an_edge_dragged_over_the_opposite_one_stops_beside_it(
    visitors: Any, start: tuple[int, int], end: tuple[int, int], crop: list[int]
) -> None:
    """A crop has one pixel at least, also while it is dragged."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160")
    page.mouse.move(*on_screen(page, *start))
    page.mouse.down()
    page.mouse.move(*on_screen(page, *end), steps=4)
    assert crop_of(page) == crop
    page.mouse.up()
    assert crop_of(page) == crop
    assert box_of(page) == pytest.approx(crop, abs=0.1)


@pytest.mark.parametrize("slip", [(0, 0), (3, 0), (0, -3), (-3, 3)])
def test_a_slip_of_the_mouse_keeps_the_crop(visitors: Any, slip: tuple[int, int]) -> None:
    """Beside the box, on it and on a handle; to draw, both sides count."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160")
    page.wait_for_selector("#frame.ready")
    moves = [slip]
    for place in [(500, 400), (200, 180), (300, 260)]:
        if place == (500, 400):
            moves = [slip, (slip[0], 90), (90, slip[1])]
        for dx, dy in moves:
            x, y = on_screen(page, *place)
            page.mouse.move(x, y)
            page.mouse.down()
            page.mouse.move(x + dx, y + dy, steps=3)
            page.mouse.up()
            assert crop_of(page) == [100, 100, 200, 160]
        moves = [slip]


@pytest.mark.parametrize("start", [(500, 400), (200, 180), (300, 260)])
def test_escape_takes_back_the_drag_under_way(visitors: Any, start: tuple[int, int]) -> None:
    """Drawn, moved or resized: the mouse is let go of without anything having changed."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160")
    page.mouse.move(*on_screen(page, *start))
    page.mouse.down()
    page.mouse.move(*on_screen(page, start[0] - 40, start[1] - 60), steps=4)
    assert crop_of(page) != [100, 100, 200, 160]
    page.keyboard.press("Escape")
    assert crop_of(page) == [100, 100, 200, 160]
    page.mouse.move(*on_screen(page, start[0] + 40, start[1] + 20), steps=4)
    page.mouse.up()
    assert crop_of(page) == [100, 100, 200, 160]
    expect(page.get_by_role("button", name="Undo")).to_have_attribute("aria-disabled", "true")


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
        assert box_of(page) == pytest.approx([20, 30, 64, 48], abs=0.1)
        page.goto(page.url)
