"""The crop under fingers: the page scrolls from the photograph, and nothing is lost by a swipe, a slip or a pinch."""

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.acceptance.crops import Fingers, box_of, crop_of, drag, on_screen, phone, sight_of

SAND = "/samples/sand_desert009"  # 1024 × 1024 pixels, 358 of the screen
PIXEL = 1024 / 358  # of the original, for one of the screen

BESIDE = [
    (80, 700),
    (500, 120),
    (900, 80),
    (960, 500),
    (940, 940),
    (500, 930),
    (120, 950),
    (60, 400),
    (700, 60),
    (200, 100),
]
CORNERS = [
    ((200, 300), (600, 700)),
    ((600, 700), (200, 300)),
    ((40, 60), (980, 1000)),
    ((900, 100), (700, 600)),
    ((300, 500), (400, 600)),
    ((500, 500), (900, 560)),
    ((512, 300), (560, 900)),
    ((100, 900), (900, 100)),
    ((0, 0), (300, 200)),
    ((1020, 1020), (640, 800)),
]


def still(page: Page) -> None:
    """Wait until the page has stopped scrolling."""
    page.evaluate(
        """() => new Promise((done) => {
            let [before, calm] = [-1, 0];
            const look = () => {
                calm = scrollY === before ? calm + 1 : 0;
                before = scrollY;
                if (calm > 8) done();
                else requestAnimationFrame(look);
            };
            look();
        })"""
    )


def scrolls_from(page: Page, fingers: Fingers, place: tuple[float, float]) -> None:
    """A swipe up that starts at a place of the photograph scrolls the page, and leaves the crop as it was."""
    page.evaluate("scrollTo(0, 0)")
    still(page)
    before = crop_of(page)
    x, y = on_screen(page, *place)
    fingers.swipe((x, y), (x + 12, y - 260 if y > 300 else y - 160))
    page.wait_for_function("() => scrollY > 60")
    still(page)
    assert crop_of(page) == before


@pytest.mark.parametrize("crop", ["crop=256,256,512,512", "crop=250,200,600,630"])
def test_a_swipe_beside_the_box_scrolls_ten_times_of_ten(visitors: Any, crop: str) -> None:
    page, fingers = phone(visitors, f"{SAND}?{crop}")
    for place in BESIDE:
        scrolls_from(page, fingers, place)


@pytest.mark.parametrize("crop", ["0,0,1024,1024", "20,40,990,960", "100,90,850,850"])
def test_a_box_that_leaves_no_room_beside_it_does_not_hold_the_page(visitors: Any, crop: str) -> None:
    """A finger on it scrolls, too; by its handles it is made smaller."""
    page, fingers = phone(visitors, f"{SAND}?crop={crop}")
    for place in [(300, 700), (700, 300), (512, 600), (250, 250), (800, 800)]:
        scrolls_from(page, fingers, place)
    page.evaluate("scrollTo(0, 0)")
    x, y, width, height = crop_of(page)
    fingers.swipe(on_screen(page, x + width, y + height), on_screen(page, 700, 700))
    assert crop_of(page) == pytest.approx([x, y, 700 - x, 700 - y], abs=1.5 * PIXEL)
    fingers.swipe(on_screen(page, 400, 400), on_screen(page, 500, 500))
    assert crop_of(page)[:2] == pytest.approx([x + 100, y + 100], abs=1.5 * PIXEL)


def test_a_crop_is_drawn_right_ten_times_of_ten(visitors: Any, screenshot: Callable[..., None]) -> None:
    """Once that was asked for, from anywhere, also within the box; the page does not scroll meanwhile."""
    page, fingers = phone(visitors, f"{SAND}?crop=256,256,512,512")
    button = page.get_by_role("button", name="Redraw")
    for start, end in CORNERS:
        button.click()
        expect(button).to_have_attribute("aria-pressed", "true")
        page.locator("#frame").scroll_into_view_if_needed()
        still(page)
        before = page.evaluate("scrollY")
        fingers.swipe(on_screen(page, *start), on_screen(page, *end))
        wanted = [min(start[0], end[0]), min(start[1], end[1]), abs(start[0] - end[0]), abs(start[1] - end[1])]
        assert crop_of(page) == pytest.approx(wanted, abs=1.5 * PIXEL)
        assert box_of(page) == pytest.approx(crop_of(page), abs=0.1)
        expect(button).to_have_attribute("aria-pressed", "false")
        assert page.evaluate("scrollY") == before
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    screenshot(page, "sample-phone")


def test_one_finger_moves_the_box_and_pulls_its_handles(visitors: Any) -> None:
    page, fingers = phone(visitors, f"{SAND}?crop=200,300,400,400")
    fingers.swipe(on_screen(page, 400, 500), on_screen(page, 500, 450))
    assert crop_of(page) == pytest.approx([300, 250, 400, 400], abs=1.5 * PIXEL)
    assert page.evaluate("scrollY") == 0
    x, y, *_ = crop_of(page)
    fingers.swipe(on_screen(page, x, y), on_screen(page, x - 100, y - 150))
    assert crop_of(page) == pytest.approx([200, 100, 500, 550], abs=3 * PIXEL)
    assert page.evaluate("scrollY") == 0


@pytest.mark.parametrize("slip", [(0, 0), (10, 10), (-14, 9), (0, 15)])
def test_a_slip_of_a_finger_does_nothing(visitors: Any, slip: tuple[float, float]) -> None:
    """On the box, on a handle, beside the box, and where a crop was to be drawn."""
    page, fingers = phone(visitors, f"{SAND}?crop=300,300,400,400")
    for place in [(500, 500), (700, 700), (100, 100)]:
        x, y = on_screen(page, *place)
        fingers.swipe((x, y), (x + slip[0], y + slip[1]))
        assert crop_of(page) == [300, 300, 400, 400]
    page.get_by_role("button", name="Redraw").click()
    x, y = on_screen(page, 100, 100)
    for dx, dy in [slip, (slip[0], 120), (120, slip[1])]:
        fingers.swipe((x, y), (x + dx, y + dy))
        assert crop_of(page) == [300, 300, 400, 400]
    fingers.swipe((x, y), (x + 20, y + 20))
    assert crop_of(page) == pytest.approx([100, 100, 20 * PIXEL, 20 * PIXEL], abs=1.5 * PIXEL)


def test_two_fingers_zoom_about_their_middle(visitors: Any, screenshot: Callable[..., None]) -> None:
    """Wherever they are, also on the box; what lies between them stays there, and the crop stays the same."""
    page, fingers = phone(visitors, f"{SAND}?crop=256,256,512,512")
    for x, y, spread in [(600, 400, 2.5), (520, 450, 1.3)]:
        before = sight_of(page)
        a, b = before.at(x - 30, y - 60), before.at(x + 30, y + 60)
        middle = before.at(x, y)
        out = [(u + spread * (p - u), v + spread * (q - v)) for (p, q), (u, v) in ((a, middle), (b, middle))]
        fingers.pinch([a, b], out)
        after = sight_of(page)
        assert after.scale / before.scale == pytest.approx(spread, rel=0.03)
        assert after.at(x, y) == pytest.approx(middle, abs=3)
        assert crop_of(page) == [256, 256, 512, 512]
        assert box_of(page) == pytest.approx([256, 256, 512, 512], abs=0.1)
    assert page.evaluate("visualViewport.scale") == 1
    assert page.evaluate("scrollY") == 0
    screenshot(page, "sample-phone-zoomed")


def test_up_and_down_two_fingers_zoom_too(visitors: Any) -> None:
    """Where one finger alone would scroll the page."""
    page, fingers = phone(visitors, f"{SAND}?crop=700,700,300,300")
    before = sight_of(page)
    x, y = before.at(300, 400)
    fingers.pinch([(x, y - 20), (x, y + 20)], [(x, y - 60), (x, y + 60)])
    assert sight_of(page).scale / before.scale == pytest.approx(3, rel=0.03)
    assert page.evaluate("scrollY") == 0


def test_an_enlarged_photograph_is_panned_and_shown_whole_again(visitors: Any) -> None:
    """By one finger beside the box, as far as there is any, or by two; drawn crops and handles mean what they show."""
    page, fingers = phone(visitors, f"{SAND}?crop=700,700,200,200")
    whole = sight_of(page)
    x, y = whole.at(200, 200)
    fingers.pinch([(x - 20, y - 20), (x + 20, y + 20)], [(x - 60, y - 60), (x + 60, y + 60)])
    near = sight_of(page)
    frame = page.locator("#frame").bounding_box()
    assert frame is not None
    x, y = frame["x"] + 250, frame["y"] + 250
    fingers.swipe((x, y), (x - 80, y - 50))
    panned = sight_of(page)
    assert (panned.x - near.x, panned.y - near.y) == pytest.approx((-80, -50), abs=2)
    assert panned.scale == near.scale
    assert page.evaluate("scrollY") == 0
    assert crop_of(page) == [700, 700, 200, 200]
    fingers.pinch([(x, y), (x + 40, y)], [(x - 60, y - 40), (x - 20, y - 40)])
    moved = sight_of(page)
    assert (moved.x - panned.x, moved.y - panned.y) == pytest.approx((-60, -40), abs=3)
    fingers.swipe((frame["x"] + 40, frame["y"] + 40), (frame["x"] + 340, frame["y"] + 340))
    fingers.swipe((frame["x"] + 40, frame["y"] + 40), (frame["x"] + 340, frame["y"] + 340))
    assert (sight_of(page).x, sight_of(page).y) == pytest.approx((frame["x"], frame["y"]), abs=1)
    page.get_by_role("button", name="Redraw").click()
    fingers.swipe(on_screen(page, 100, 100), on_screen(page, 300, 220))
    assert crop_of(page) == pytest.approx([100, 100, 200, 120], abs=PIXEL)
    fingers.swipe(on_screen(page, 300, 220), on_screen(page, 260, 300))
    assert crop_of(page) == pytest.approx([100, 100, 160, 200], abs=1.5 * PIXEL)
    page.get_by_role("button", name="Fit", exact=True).click()
    page.evaluate("scrollTo(0, 0)")
    still(page)
    assert sight_of(page) == whole


def test_a_pinch_that_begins_on_the_box_moves_nothing(visitors: Any) -> None:
    """What the first finger had begun is taken back."""
    page, fingers = phone(visitors, f"{SAND}?crop=256,256,512,512")
    a, b = on_screen(page, 400, 400), on_screen(page, 600, 600)
    fingers.put(a)
    fingers.move([a], [(a[0] + 30, a[1] + 10)])
    assert crop_of(page) != [256, 256, 512, 512]
    a = (a[0] + 30, a[1] + 10)
    fingers.put(a, b)
    fingers.move([a, b], [(a[0] - 20, a[1] - 20), (b[0] + 20, b[1] + 20)])
    fingers.lift()
    assert crop_of(page) == [256, 256, 512, 512]
    expect(page.get_by_role("button", name="Undo")).to_have_attribute("aria-disabled", "true")


def test_undo_takes_back_what_fingers_did(visitors: Any) -> None:
    page, fingers = phone(visitors, f"{SAND}?crop=256,256,512,512")
    undo, redo = page.get_by_role("button", name="Undo"), page.get_by_role("button", name="Redo")
    fingers.swipe(on_screen(page, 500, 500), on_screen(page, 600, 600))
    first = crop_of(page)
    page.get_by_role("button", name="Redraw").click()
    fingers.swipe(on_screen(page, 100, 100), on_screen(page, 900, 400))
    second = crop_of(page)
    undo.click()
    assert crop_of(page) == first
    undo.click()
    assert crop_of(page) == [256, 256, 512, 512]
    assert box_of(page) == pytest.approx([256, 256, 512, 512], abs=0.1)
    expect(undo).to_have_attribute("aria-disabled", "true")
    redo.click()
    redo.click()
    assert crop_of(page) == second


def test_the_page_says_what_fingers_do(visitors: Any) -> None:
    page, _ = phone(visitors, SAND)
    expect(page.get_by_text("To draw a new crop, press “Redraw” first.")).to_be_visible()
    expect(page.get_by_text("Drag outside the box to draw a new crop.")).to_be_hidden()
    desk = visitors.visit(SAND)
    expect(desk.get_by_text("Drag outside the box to draw a new crop.")).to_be_visible()


@pytest.mark.parametrize("number", [1, 2])
def test_a_clip_and_a_further_input_have_the_same_frame(visitors: Any, number: int) -> None:
    """Swipes, pinches and Undo of one input leave the other's crop alone."""
    clip = "/samples/sky_pan?method=transfer&crop=20,20,60,60&second=sand_desert009:256,256,512,512"
    page, fingers = phone(visitors, clip)
    prefixes = ["", "input-2-"]
    prefix, other = prefixes[number - 1], prefixes[2 - number]
    page.wait_for_selector(f"#{prefix}frame.ready")
    page.locator(f"#{prefix}frame").scroll_into_view_if_needed()
    still(page)
    rest, start = crop_of(page, other), crop_of(page, prefix)
    before = sight_of(page, prefix)
    bounds = page.locator(f"#{prefix}frame").bounding_box()
    assert bounds is not None
    x, y = bounds["x"] + bounds["width"] * 0.9, bounds["y"] + bounds["height"] * 0.8
    fingers.pinch([(x - 10, y), (x + 10, y)], [(x - 20, y), (x + 20, y)])
    assert sight_of(page, prefix).scale / before.scale == pytest.approx(2, rel=0.05)
    tools = page.locator(f"#{prefix}crop-tools")
    tools.get_by_role("button", name="Fit").click()
    tools.get_by_role("button", name="Whole").click()
    assert crop_of(page, prefix)[:2] == [0, 0]
    tools.get_by_role("button", name="Undo").click()
    assert crop_of(page, prefix) == start
    assert crop_of(page, other) == rest


def test_the_mouse_still_draws_at_once(visitors: Any) -> None:
    """Also on a screen that has both."""
    page = visitors.visit(f"{SAND}?crop=256,256,512,512", has_touch=True)
    page.wait_for_selector("#frame.ready")
    drag(page, (50, 50), (200, 150))
    assert crop_of(page) == pytest.approx([50, 50, 150, 100], abs=3)
