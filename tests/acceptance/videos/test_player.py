"""Videos on an experiment's page: Chromium plays both files, in step, frame by frame and by keys alone."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from tests.acceptance.videos.page import (
    FRAMES,
    PAUSED,
    PLAYING,
    RATE,
    VIDEOS,
    address,
    still,
    times,
)


def test_both_videos_play_in_step(visitors: Any, videos: dict[str, Any], screenshot: Callable[..., None]) -> None:
    """Their positions stay within two frames of each other half of the time, however busy the machine is."""
    page = still(visitors, address(videos))  # its begin is seen, so that rounds can be counted
    apart = page.evaluate(
        """({ rate, frames }) => new Promise(done => {
            const videos = [...document.querySelectorAll(".stage video")];
            const last = [0, 0], laps = [0, 0], found = [];
            const look = () => {
                const positions = videos.map((video, index) => {
                    if (video.currentTime < last[index] - frames[index] / rate / 2) laps[index] += 1;
                    last[index] = video.currentTime;
                    return laps[index] * frames[index] + video.currentTime * rate;
                });
                found.push(Math.abs(positions[0] - positions[1]));
                if (Math.min(...positions) > 2 * Math.max(...frames)) done(found);
                else requestAnimationFrame(look);
            };
            document.querySelector("[data-play]").click();
            look();
        })""",
        {"rate": RATE, "frames": [FRAMES["crop"], FRAMES["texture"]]},
    )
    assert np.median(apart) < 2
    page.wait_for_function(f"() => {PLAYING}")
    screenshot(page, "experiment-video", full_page=False)


def test_a_video_that_has_run_ahead_waits_for_the_other(visitors: Any, videos: dict[str, Any]) -> None:
    """Ten frames ahead it stands still, then plays slowly, and at last as fast as the other one."""
    page = still(visitors, address(videos))
    speeds = page.evaluate(
        """rate => new Promise(done => {
            const [behind, ahead] = document.querySelectorAll(".stage video");
            const speeds = [];
            const look = () => {
                speeds.push(ahead.playbackRate);
                const apart = (ahead.currentTime - behind.currentTime) * rate;
                if (Math.abs(apart) < 1.5 && ahead.playbackRate > 0) done(speeds);
                else requestAnimationFrame(look);
            };
            ahead.addEventListener("seeked", () => {
                document.querySelector("[data-play]").click();
                look();
            }, { once: true });
            ahead.currentTime = 10.5 / rate;
        })""",
        RATE,
    )
    assert speeds[0] == 0
    assert speeds[-1] > 0
    page.wait_for_function(f"() => {VIDEOS}.every(video => video.playbackRate === 1)")


@pytest.mark.parametrize("name", ["texture", "texture-mp4", "crop", "crop-mp4"])
def test_chromium_plays_every_file(visitors: Any, videos: dict[str, Any], name: str) -> None:
    """It shows frames of the right size, and comes round to the beginning again."""
    page = still(visitors, address(videos))
    size = page.evaluate(
        """async source => {
            const video = Object.assign(document.createElement("video"), { muted: true, loop: true, src: source });
            document.querySelector("main").append(video);
            let last = 0;
            const looped = new Promise(done => video.addEventListener("timeupdate", () => {
                if (video.currentTime < last) done();
                last = video.currentTime;
            }));
            await video.play();
            await looped;
            return [video.videoWidth, video.videoHeight];
        }""",
        f"/api/v1/experiments/{videos['id']}/outputs/{name}",
    )
    assert size == ([112, 80] if name.startswith("texture") else [96, 80])


def test_who_asked_for_reduced_motion_starts_it_by_hand(visitors: Any, videos: dict[str, Any]) -> None:
    page = still(visitors, address(videos))
    expect(page.locator(".player output")).to_have_text("1 / 20")
    assert page.evaluate("[...document.querySelectorAll('video')].every(video => video.paused && !video.autoplay)")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function(f"() => {PLAYING}")
    page.get_by_role("button", name="Pause").click()
    crop, texture = times(page)
    assert page.evaluate(PAUSED)
    assert texture % 1 == pytest.approx(0.5, abs=0.01)  # the middle of a frame
    expect(page.locator(".player output")).to_have_text(f"{int(texture) + 1} / 20")
    assert crop % 1 == pytest.approx(0.5, abs=0.01)


def test_steps_show_one_frame_after_the_other(
    visitors: Any, videos: dict[str, Any], in_step: Callable[[Page, int], None]
) -> None:
    """Frame for frame what another decoder finds in the files; each video goes on round its own length."""
    page = still(visitors, address(videos))
    following, previous = (page.get_by_role("button", name=name) for name in ("Next frame", "Previous frame"))
    following.click()
    in_step(page, 1)
    following.click()
    in_step(page, 2)
    for _ in range(3):
        previous.click()
    in_step(page, -1)
    expect(page.locator(".player output")).to_have_text("20 / 20")
    page.get_by_role("slider", name="Frame").fill("18")
    in_step(page, 17)


def test_the_player_works_by_keys_alone(
    visitors: Any, videos: dict[str, Any], in_step: Callable[[Page, int], None]
) -> None:
    """Space, comma and full stop on the pictures, whose arrows still pan; arrows on the slider of frames."""
    page = still(visitors, address(videos))
    panes, output = page.get_by_role("group", name="Pictures."), page.locator(".player output")
    expect(panes).to_have_accessible_name(
        "Pictures. Arrow keys move the pictures, plus and minus zoom, 0 fits them, "
        "1 shows every pixel once, F flips. Space plays and pauses, comma and full stop step by a frame."
    )
    panes.press(".")
    panes.press(".")
    panes.press(",")
    expect(output).to_have_text("2 / 20")
    panes.press("ArrowRight")
    expect(output).to_have_text("2 / 20")
    slider = page.get_by_role("slider", name="Frame")
    slider.press("ArrowRight")
    expect(output).to_have_text("3 / 20")
    expect(slider).to_have_attribute("aria-valuetext", "3 of 20")
    slider.press("End")
    in_step(page, 19)
    panes.press(" ")
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    panes.press(" ")
    expect(page.get_by_role("button", name="Play")).to_be_visible()
