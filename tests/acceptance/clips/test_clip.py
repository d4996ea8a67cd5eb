"""A clip on its page: uploaded, cropped in space and time by pointer, keyboard and on a phone, and run."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Route, expect

from tests.acceptance.clips.page import FRAMES, HEIGHT, MOVING, WIDTH, drag, shows, time_of
from tests.acceptance.crops import SIDES, crop_of
from tests.acceptance.keyboard import tab_to
from tests.acceptance.records import record_of


def test_upload_crop_in_space_and_time_and_run(
    visitors: Any, site: Any, clip: Path, screenshot: Callable[..., None]
) -> None:
    """The whole way with the pointer: the experiment is of the frames and the rectangle that were drawn."""
    page = visitors.visit()
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Choose a photograph or clip").click()
    chooser.value.set_files(clip)
    page.wait_for_url("**/samples/*")
    expect(page.locator(f"#method-{MOVING}")).to_be_checked()
    assert (crop_of(page), time_of(page)) == ([0, 0, WIDTH, HEIGHT], [0, FRAMES])
    page.wait_for_function("!document.querySelector('#frame video').paused")
    drag(page, 0, 6)
    drag(page, FRAMES, 18)
    assert time_of(page) == [6, 12]
    drag(page, 10, 8)
    assert time_of(page) == [4, 12]
    box = page.locator("#frame.ready").bounding_box()
    assert box is not None
    scale = box["width"] / WIDTH
    page.mouse.move(box["x"] + 20 * scale, box["y"] + 30 * scale)
    page.mouse.down()
    page.mouse.move(box["x"] + 100 * scale, box["y"] + 94 * scale, steps=4)
    page.mouse.up()
    crop = crop_of(page)
    assert crop == pytest.approx([20, 30, 80, 64], abs=1.5)
    expect(page.locator("#run-size")).to_contain_text(f"{crop[2]} × {crop[3]} pixels, 12 frames")
    screenshot(page, "sample-clip")
    page.get_by_role("button", name="Synthesise").click()
    expect(page.get_by_role("heading", name="Time by stage")).to_be_visible()
    record = record_of(site, page)
    assert record["status"] == "succeeded"
    assert record["inputs"][0]["crop"] == dict(zip(SIDES, crop, strict=True))
    assert record["inputs"][0]["frames"] == {"first": 4, "count": 12}
    assert [record["parameters"][name] for name in ("width", "height", "frames")] == [crop[2], crop[3], 12]


def test_the_whole_way_by_keyboard(visitors: Any, site: Any, uploaded: str) -> None:
    page = visitors.visit(uploaded)
    tab_to(page, "#frame .box")
    page.keyboard.press("Control+Shift+ArrowLeft")
    page.keyboard.press("ArrowRight")
    tab_to(page, "#crop .reel button")
    page.keyboard.press("Enter")
    page.wait_for_function("document.querySelector('#frame video').paused")
    tab_to(page, "#crop [data-part=first]")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("PageUp")
    shows(page, 11)
    tab_to(page, "#crop [data-part=last]")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    shows(page, 21)
    tab_to(page, "#crop [data-part=range]", "Shift+Tab")
    page.keyboard.press("Home")
    page.keyboard.press("ArrowUp")
    shows(page, 1)
    assert (crop_of(page), time_of(page)) == ([1, 0, 151, HEIGHT], [1, 11])
    tab_to(page, "button.main")
    page.keyboard.press("Enter")
    assert record_of(site, page)["inputs"][0]["frames"] == {"first": 1, "count": 11}


def test_a_still_method_takes_one_frame(
    visitors: Any, site: Any, uploaded: str, screenshot: Callable[..., None]
) -> None:
    """The page then speaks of a frame, shows that one, and has no second number."""
    page = visitors.visit(uploaded)
    page.get_by_text("RPN", exact=True).click()
    expect(page.locator("#crop").get_by_role("spinbutton", name="frame", exact=True)).to_have_value("0")
    expect(page.locator("#time-count")).to_be_hidden()
    expect(page.locator("#time-help").get_by_text("This method takes a single frame")).to_be_visible()
    page.fill("#time-first", "7")
    shows(page, 7)
    screenshot(page, "sample-clip-frame")
    page.get_by_role("button", name="Synthesise").click()
    assert record_of(site, page)["inputs"][0]["frames"] == {"first": 7, "count": 1}
    page.go_back()
    expect(page.locator("#method-rpn")).to_be_checked()
    expect(page.locator("#time-first")).to_have_value("7")


def test_the_meter_measures_the_frame_that_is_shown(visitors: Any, uploaded: str) -> None:
    """Typed, dragged or stepped to."""
    page = visitors.visit(uploaded)
    page.get_by_text("RPN", exact=True).click()
    with page.expect_request("**/structure?*frame=7"):
        page.fill("#time-first", "7")
        page.press("#time-first", "Tab")
    with page.expect_request("**/structure?*frame=15"):
        drag(page, 7.5, 15.5)
    with page.expect_request("**/structure?*frame=16"):
        page.locator("#crop .track [data-part=first]").press("ArrowRight")


def test_a_file_that_is_no_video_is_refused_where_it_was_chosen(visitors: Any, tmp_path: Path) -> None:
    visitors.refusals_expected = True
    broken = tmp_path / "clip.mp4"
    broken.write_bytes(b"\0\0\0\x20ftypisom" + bytes(range(256)) * 8)
    page = visitors.visit()
    page.set_input_files("#file", broken)
    expect(page.locator("#upload-error")).not_to_be_empty()
    expect(page.get_by_role("button", name="Choose a photograph or clip")).to_be_visible()


def test_a_photograph_is_told_from_a_clip_before_anything_is_sent(
    visitors: Any, screenshot: Callable[..., None]
) -> None:
    """A moving method can be looked at on a photograph's page; it says what it needs, and leads to it."""
    page = visitors.visit("/samples/gravel_gray")
    page.locator(f"[for=method-{MOVING}]").click()
    expect(page.locator(f"#method-{MOVING} ~ .own")).to_contain_text("It needs a clip")
    expect(page.locator("#run-problem")).to_contain_text("still picture")
    expect(page.locator("#sample-error")).to_contain_text("still picture")
    screenshot(page, "sample-lacks-clip")
    page.locator(f"#method-{MOVING} ~ .own .lacking li a").first.click()
    page.wait_for_url(f"**/samples/*method={MOVING}*")
    expect(page.locator("#frame video")).to_be_visible()
    expect(page.locator(f"#method-{MOVING}")).to_be_checked()


def test_a_clip_as_another_input(visitors: Any, site: Any, uploaded: str) -> None:
    """It plays nowhere, for the method takes one frame of it, which is chosen on its own reel."""
    name = uploaded.rsplit("/", 1)[-1]
    page = visitors.visit(f"/samples/gravel_gray?method=mix&crop=96,96,100,100&second={name}:10,10,100,100@3,1")
    expect(page.locator("#input-2-time-first")).to_have_value("3")
    page.locator("#input-2 [data-part=first]").focus()
    page.keyboard.press("ArrowRight")
    expect(page.locator("#input-2 .reel output")).to_contain_text("frame 4 of 24")
    page.get_by_role("button", name="Synthesise").click()
    assert [each["frames"]["first"] for each in record_of(site, page)["inputs"]] == [0, 4]


def test_a_clip_on_a_phone(visitors: Any, uploaded: str, screenshot: Callable[..., None]) -> None:
    """Nothing is wider than the screen, and a finger moves the ends of the reel."""
    options = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
    page = visitors.visit(uploaded, **options)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    track = page.locator("#crop .track")
    track.scroll_into_view_if_needed()
    bounds = track.bounding_box()
    assert bounds is not None
    touch = page.context.new_cdp_session(page)
    y = bounds["y"] + bounds["height"] / 2
    for kind, at in (("touchStart", 0.0), ("touchMove", 0.1), ("touchMove", 0.5), ("touchEnd", None)):
        points = [] if at is None else [{"x": bounds["x"] + at * bounds["width"], "y": y}]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    assert time_of(page) == [12, 12]
    screenshot(page, "sample-clip-phone")


def test_a_video_that_was_quicker_than_the_script_lies_under_its_crop_all_the_same(
    visitors: Any, uploaded: str
) -> None:
    """What was added to an odd side lies outside the frame, whichever of the two comes first."""
    page = visitors.visit("/")
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    page.route("**/js/crop/range_playback.js", hold)
    page.goto(uploaded, wait_until="commit")
    page.wait_for_function("() => document.querySelector('#frame video')?.readyState > 0")
    page.unroute("**/js/crop/range_playback.js", hold)
    for route in held:
        route.fallback()
    expect(page.locator("#frame.ready")).to_be_visible()
    video, frame = page.locator("#frame video"), page.locator("#frame")
    coded = video.evaluate("video => video.videoWidth")
    assert coded == WIDTH + 1
    sides = [each.evaluate("element => element.getBoundingClientRect().width") for each in (video, frame)]
    assert sides[0] / sides[1] == pytest.approx(coded / WIDTH, abs=1e-4)
