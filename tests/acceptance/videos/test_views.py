"""Videos in the views of an experiment: tiled, one upon the other, out of sight, broken, and without a script."""

import re
from collections.abc import Callable
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Route, expect

from tests.acceptance.videos.page import (
    PAUSED,
    PLAYING,
    VIDEOS,
    Shows,
    address,
    opened,
    still,
)


def test_the_tiled_view_repeats_what_plays(
    visitors: Any,
    videos: dict[str, Any],
    arrays: dict[str, np.ndarray],
    shows: Shows,
    screenshot: Callable[..., None],
) -> None:
    """Nine times the frame, pixel beside pixel, and the next one after a step."""
    page = still(visitors, address(videos, "?view=tiled"))
    page.get_by_role("button", name="3 × 3").click()
    page.get_by_role("button", name="1 : 1").click()
    tile = ".pane:nth-child(2) .tile"
    expect(page.locator(tile)).to_be_visible()
    for position in (0, 1):
        shows(page, tile, np.tile(arrays["texture"][position], (3, 3, 1)))
        page.get_by_role("button", name="Next frame").click()
    page.get_by_role("button", name="Play").click()
    page.wait_for_function(f"() => {PLAYING}")
    screenshot(page, "experiment-video-tiled", full_page=False)


def test_a_video_that_comes_late_is_repeated_too(
    visitors: Any, videos: dict[str, Any], arrays: dict[str, np.ndarray], shows: Shows
) -> None:
    """Though it stands still, and nothing but its coming says that there is something to show."""
    page = visitors.visit("/", reduced_motion="reduce")
    held: list[Route] = []
    texture = re.compile(r"/outputs/texture\?")

    def hold(route: Route) -> None:
        held.append(route)

    page.route(texture, hold)
    page.goto(address(videos, "?view=tiled"), wait_until="domcontentloaded")
    expect(page.locator(".viewer.live")).to_be_visible()
    page.get_by_role("button", name="1 : 1").click()
    page.unroute(texture, hold)
    for route in held:
        route.fallback()
    shows(page, ".pane:nth-child(2) .tile", np.tile(arrays["texture"][0], (2, 2, 1)))


@pytest.mark.parametrize("view", ["Flip", "Slider"])
def test_videos_play_on_upon_each_other(visitors: Any, videos: dict[str, Any], view: str) -> None:
    """They have begun without being asked to."""
    page = opened(visitors, address(videos))
    page.get_by_role("link", name=view).click()
    expect(page.locator(".over .stage video")).to_have_count(2)
    before = page.evaluate(f"{VIDEOS}.map(video => video.currentTime)")
    page.wait_for_function(f"before => {VIDEOS}.every((video, at) => video.currentTime !== before[at])", arg=before)
    page.wait_for_function(f"() => {PLAYING}")


def test_what_is_not_seen_stands_still_until_it_is(visitors: Any, videos: dict[str, Any]) -> None:
    page = opened(visitors, address(videos))
    page.wait_for_function(f"() => {PLAYING}")
    page.get_by_role("link", name="Steps").click()
    page.wait_for_function(f"() => {PAUSED}")
    page.get_by_role("link", name="Side by side").click()
    page.wait_for_function(f"() => {PLAYING}")


def test_without_a_script_every_video_has_its_own_controls(visitors: Any, videos: dict[str, Any]) -> None:
    page = visitors.visit(address(videos), java_script_enabled=False)
    expect(page.locator(".player")).to_be_hidden()
    shown = page.locator(".stage video")
    expect(shown).to_have_count(2)
    for index, name in enumerate(("crop", "texture")):
        for attribute in ("controls", "muted", "loop", "playsinline"):
            expect(shown.nth(index)).to_have_attribute(attribute, "")
        kinds = shown.nth(index).locator("source").evaluate_all("sources => sources.map(source => source.type)")
        assert kinds == ["video/webm", "video/mp4"]
        poster = page.request.get(shown.nth(index).get_attribute("poster"))
        assert Image.open(BytesIO(poster.body())).size == ((96, 80) if name == "crop" else (112, 80))
    page.get_by_role("link", name="Tiled", exact=True).click()
    expect(page.locator(".pane img")).to_have_count(8)
    expect(page.locator(".pane video").first).to_be_hidden()
    page.get_by_role("link", name="Steps").click()
    expect(page.locator(".steps img").first).to_have_attribute("alt", "Video cube of the crop")


def test_a_video_that_cannot_be_played_is_said_to_be_so_and_keeps_no_other_waiting(
    visitors: Any, videos: dict[str, Any]
) -> None:
    visitors.refusals_expected = True
    page = visitors.visit("/")
    page.route("**/outputs/crop*", lambda route: route.fulfill(status=404))
    page.goto(address(videos))
    expect(page.get_by_text("cannot play")).to_be_visible()
    page.wait_for_function("() => document.querySelector('.pane:nth-child(2) video').currentTime > 0.1")
