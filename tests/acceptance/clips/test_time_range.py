"""The time range of a clip: dragged, typed, played, kept in the address, and chosen without a script."""

from typing import Any

import pytest
from playwright.sync_api import expect

from tests.acceptance.clips.page import RATE, drag, shows, time_of
from tests.acceptance.records import record_of


def test_the_reel_says_what_it_holds(visitors: Any, uploaded: str) -> None:
    """To who looks and to who listens."""
    page = visitors.visit(f"{uploaded}?time=6,9")
    expect(page.locator("#crop .reel output")).to_have_text("6–14 of 24 frames, 0.75 s")
    ends = page.locator("#crop").get_by_role("slider")
    said = ends.evaluate_all("all => all.map((each) => [each.ariaLabel, each.ariaValueNow, each.ariaValueText])")
    assert said == [
        ["Time range", "6", "6, at 0.50 s"],
        ["First frame", "6", "6, at 0.50 s"],
        ["Last frame", "14", "14, at 1.17 s"],
    ]


def test_only_the_chosen_range_plays(visitors: Any, uploaded: str) -> None:
    """Over and over: one frame of slack, for the browser looks for the next one while the last is shown."""
    page = visitors.visit(f"{uploaded}?time=8,6")
    seen = page.evaluate(
        """rate => new Promise((done) => {
            const video = document.querySelector("#frame video");
            const seen = [];
            let rounds = 0;
            video.playbackRate = 0.25; // a third of a second for a frame: time for the script on a busy machine
            const look = (now, { mediaTime }) => {
                const frame = Math.round(mediaTime * rate);
                if (seen.length && frame < seen.at(-1)) rounds += 1;
                if (seen.length || frame >= 8) seen.push(frame);
                if (rounds < 2 || !seen.includes(8) || new Set(seen).size < 4) video.requestVideoFrameCallback(look);
                else done(seen);
            };
            video.requestVideoFrameCallback(look);
        })""",
        RATE,
    )
    assert min(seen) == 8
    assert max(seen) <= 14


def test_nothing_moves_by_itself_where_that_is_asked_for(visitors: Any, uploaded: str) -> None:
    page = visitors.visit(f"{uploaded}?time=5,12", reduced_motion="reduce")
    shows(page, 5)
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("!document.querySelector('#frame video').paused")
    page.get_by_role("button", name="Pause").click()
    page.wait_for_function("document.querySelector('#frame video').paused")


@pytest.mark.parametrize(
    ("part", "typed", "time", "words"),
    [
        ("first", "20", [12, 12], "It begins with frame 12 now: from 20 on, 12 frames do not fit."),
        ("first", "99", [12, 12], "It begins with frame 12 now"),
        ("count", "20", [4, 20], "It begins with frame 4 now: from 6 on, 20 frames do not fit."),
        ("count", "99", [0, 24], "It is 24 frames now: the clip has no more."),
        ("count", "1", [6, 2], "A video has 2 frames or more."),
    ],
)
def test_a_number_that_does_not_fit_moves_the_range_and_keeps_its_length(
    visitors: Any, uploaded: str, part: str, typed: str, time: list[int], words: str
) -> None:
    """Once its field is left; until then the reel stays where it fitted last."""
    page = visitors.visit(f"{uploaded}?time=6,12")
    expect(page.locator("#crop .reel output")).to_contain_text("6–17 of 24")
    page.locator(f"#time-{part}").click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type(typed)
    assert page.input_value(f"#time-{part}") == typed
    page.keyboard.press("Tab")
    assert time_of(page) == time
    expect(page.locator("#crop .reel output")).to_contain_text(f"{time[0]}–{sum(time) - 1} of 24")
    expect(page.locator("#crop [data-fit=time]")).to_contain_text(words)


def test_two_numbers_typed_one_after_the_other_are_the_range(visitors: Any, uploaded: str) -> None:
    """Although the first one does not fit until the second is typed; what is no whole number is named."""
    page = visitors.visit(uploaded)
    page.locator("#time-first").click()
    for number in ("15", "7"):
        page.keyboard.press("ControlOrMeta+a")
        page.keyboard.type(number)
        page.keyboard.press("Tab")
    assert time_of(page) == [15, 7]
    page.locator("#time-first").fill("3,5")
    page.keyboard.press("Tab")
    expect(page.locator("#time-error")).to_contain_text('got "3,5" for the first frame')
    expect(page.locator("#time-first")).to_have_value("3,5")
    expect(page.locator("#crop .reel output")).to_contain_text("15–21 of 24")


def test_back_finds_the_time_range(visitors: Any, uploaded: str) -> None:
    page = visitors.visit(uploaded)
    drag(page, 0, 5)
    page.fill("#frames", "30")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    page.go_back()
    for _ in range(2):
        expect(page.locator("#time-first")).to_have_value("5")
        assert time_of(page) == [5, 19]
        expect(page.locator("#frames")).to_have_value("30")
        page.goto(page.url)


def test_the_time_range_without_a_script(visitors: Any, site: Any, uploaded: str) -> None:
    """The browser's own player, and two numbers."""
    page = visitors.visit(uploaded, java_script_enabled=False)
    expect(page.locator("#frame video")).to_have_attribute("controls", "")
    page.fill("#time-first", "3")
    page.fill("#time-count", "8")
    page.get_by_role("button", name="Synthesise").click()
    assert record_of(site, page)["inputs"][0]["frames"] == {"first": 3, "count": 8}
