"""Videos on an experiment's page: Chromium plays both files, in step, frame by frame, tiled, and without a script."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, Route, expect

from app.images.video.reader import read_video

FRAMES = {"texture": 20, "crop": 16}
RATE = 24
VIDEOS = "[...document.querySelectorAll('.stage video')]"
PAUSED = f"{VIDEOS}.every(video => video.paused)"
PLAYING = f"{VIDEOS}.every(video => !video.paused && video.currentTime > 0.1)"
NOISE = 1.0  # mean difference of values that colour conversion may make


@pytest.fixture(scope="session")
def videos(site: Any) -> dict[str, Any]:
    """The record of a finished video whose texture has more frames than its crop."""
    body = {
        "method": "video-rpn",
        "inputs": [
            {
                "sample": "sand_under_water",
                "crop": {"x": 40, "y": 30, "width": 96, "height": 80},
                "frames": {"first": 4, "count": FRAMES["crop"]},
            }
        ],
        "parameters": {"width": 112, "height": 80, "frames": FRAMES["texture"], "seed": 3},
    }
    answer = site.client.post("/api/v1/experiments", json=body, headers={"Prefer": "wait=30"})
    assert answer.status_code == 201, answer.text
    record = dict(answer.json())
    assert record["status"] == "succeeded", record
    return record


def difference(one: np.ndarray, other: np.ndarray) -> float:
    """Mean difference of values."""
    return float(np.abs(one.astype(np.int16) - other.astype(np.int16)).mean())


@pytest.fixture(scope="session")
def arrays(site: Any, videos: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> dict[str, np.ndarray]:
    """Name → the frames (T, H, W, 3) of its lossless file, as another decoder than the browser's finds them."""
    found = {}
    for name in FRAMES:
        path: Path = tmp_path_factory.mktemp("videos") / name
        path.write_bytes(site.client.get(f"/api/v1/experiments/{videos['id']}/outputs/{name}").content)
        found[name] = np.stack(list(read_video(path)))
        assert min(map(difference, found[name], np.roll(found[name], 1, axis=0))) > 2 * NOISE  # none is like the next
    return found


def address(videos: dict[str, Any], query: str = "") -> str:
    return f"/experiments/{videos['id']}{query}"


def opened(visitors: Any, path: str, **options: Any) -> Page:
    """A page whose videos are loaded."""
    page: Page = visitors.visit(path, **options)
    expect(page.locator(".player")).to_be_visible()
    page.wait_for_function(f"() => {VIDEOS}.every(video => video.readyState === 4)")
    return page


def still(visitors: Any, path: str, **options: Any) -> Page:
    """One on which nothing moves by itself."""
    return opened(visitors, path, reduced_motion="reduce", **options)


def times(page: Page) -> list[float]:
    """Where crop and texture are, in frames."""
    return [float(time) for time in page.evaluate(f"{VIDEOS}.map(video => video.currentTime * {RATE})")]


Shows = Callable[[Page, str, np.ndarray], None]


@pytest.fixture(scope="session")
def shows(until: Callable[..., Any], shown_pixels: Callable[[Page, str], np.ndarray]) -> Shows:
    """Wait until a video or canvas has found a frame (H, W, 3)."""

    def wait(page: Page, selector: str, frame: np.ndarray) -> None:
        until(lambda: difference(shown_pixels(page, selector), frame) < NOISE, f"{selector} to show its frame")

    return wait


@pytest.fixture(scope="session")
def in_step(shows: Shows, arrays: dict[str, np.ndarray]) -> Callable[[Page, int], None]:
    """Wait until both videos show the frame of a position, each counted round its own length."""

    def wait(page: Page, position: int) -> None:
        for place, name in enumerate(("crop", "texture"), 1):
            shows(page, f".pane:nth-child({place}) video", arrays[name][position % FRAMES[name]])

    return wait


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

    def hold(route: Route) -> None:
        held.append(route)

    page.route("**/outputs/texture", hold)
    page.goto(address(videos, "?view=tiled"), wait_until="domcontentloaded")
    expect(page.locator(".viewer.live")).to_be_visible()
    page.get_by_role("button", name="1 : 1").click()
    page.unroute("**/outputs/texture", hold)
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
