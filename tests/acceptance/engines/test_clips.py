"""The whole way of a clip in Chromium, Firefox and WebKit: a range of its time, a run, and videos that play."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.images.video.reader import read_video
from app.images.video.writers import write_video
from tests.acceptance.engines.walk import CROP, TEXTURE, crop_of, on_sample, run, scale_of, upload
from tests.acceptance.engines.window import PATIENCE, Window, difference
from tests.acceptance.waiting import until

# Slow, so that what is looked at lies within one round of a video: in WebKitGTK 2.50 one of two that go round over
# HTTP stands still after some rounds, with or without a script that paces them.
FRAMES, RATE = 72, 3  # of the clip
FIRST, COUNT = 12, 36  # of the range that is taken
NOISE = 2.0  # levels that engines may differ by in the colours of a video without loss


def test_the_whole_way_of_a_clip(
    window: Window, site: Any, clip: Path, busy: Callable[..., Any], tmp_path: Path
) -> None:
    upload(window, clip)
    plays(window, "#frame video")
    width, height = cut(window)
    take_range(window)
    window.click("label[for=method-video-rpn]")
    window.has("#run-size", f"{width} × {height} pixels, {COUNT} frames")
    path = run(window, window.click, busy)
    assert "Running" in [status for status, _ in window.look("() => window.said")]
    videos = {}
    for name in ("crop", "texture"):
        file = tmp_path / name
        file.write_bytes(site.client.get(f"/api/v1{path}/outputs/{name}").content)
        videos[name] = np.stack(list(read_video(file)))
        assert videos[name].shape == (COUNT, height, width, 3)
    assert_result(window, videos)
    window.open(path)
    assert_result(window, videos)
    kept = window.download(lambda: window.click(".downloads a", "WebM"))
    assert np.array_equal(np.stack(list(read_video(kept))), videos["texture"])


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a visitor uploads: sand under water, 320 × 320 pixels, as MP4."""
    path = tmp_path_factory.mktemp("clip") / "water.mp4"
    frames = read_video(Path(__file__).parents[3] / "samples" / "sand_under_water.mp4")
    write_video(frames, path, "mp4", count=FRAMES, rate=RATE)
    return path


def plays(window: Window, selector: str) -> None:
    """Wait until time passes in a video, and what is on the screen changes with it."""
    time = "(selector) => { const video = seen(selector)[0]; return !video.paused && video.currentTime; }"
    before, picture = window.until(time, selector), window.seen(selector)
    window.until(f"(selector, before) => ![before, false].includes(({time})(selector))", selector, before)
    until(lambda: difference(window.seen(selector), picture) > 1, f"{window.engine} to move {selector}", PATIENCE)


def cut(window: Window) -> tuple[int, int]:
    """Draw a crop: the whole frame cannot be moved, so that a drag draws anew; its width and height."""
    window.drag([on_sample(window, *point) for point in ((60, 80), (120, 100), (220, 208))])
    crop = crop_of(window)
    assert crop == pytest.approx([60, 80, 160, 128], abs=1.5 / scale_of(window))
    return crop[2], crop[3]


def take_range(window: Window) -> None:
    """Draw the first end of the reel to a frame, and type how many to take."""
    left, _, width, _ = window.bounds("#crop .track", scroll=True)
    x, y = window.place("#crop [data-part=first]")
    window.drag([(x, y), (left + width / FRAMES * FIRST / 2, y), (left + width / FRAMES * FIRST, y)])
    taken = "() => ['first', 'count'].map((part) => Number(document.querySelector(`#time-${part}`).value))"
    assert window.look(taken) == [FIRST, FRAMES - FIRST]
    window.fill("#time-count", str(COUNT))
    assert window.look(taken) == [FIRST, COUNT]
    window.has("#crop .reel output", f"{FIRST}–{FIRST + COUNT - 1} of {FRAMES} frames")


def assert_result(window: Window, videos: dict[str, np.ndarray]) -> None:
    """Both videos play by themselves, stop where they are told to, and show one frame after the other."""
    window.has("h1", "Video RPN")
    window.has(".player")
    for video in (CROP, TEXTURE):
        plays(window, video)
    window.lacks(".unplayable")
    window.click("[data-play]", "Pause")
    window.until(
        "() => [...document.querySelectorAll('.stage video')].every((video) => video.paused && !video.seeking)"
    )
    window.click("[data-zoom=one]")
    for step in (0, 1, 1, -1):
        if step:
            before = window.has(".player output")
            window.click(f"[data-step='{step}']")
            window.until("(before) => document.querySelector('.player output').textContent !== before", before)
        number, count = window.has(".player output").split(" / ")
        assert int(count) == COUNT
        if step:
            assert (int(number) - int(before.split(" / ")[0]) - step) % COUNT == 0
        for selector, frames in zip((CROP, TEXTURE), videos.values(), strict=True):
            window.shows(selector, frames[int(number) - 1], NOISE)
            assert difference(window.decoded(selector), frames[int(number) - 1]) < NOISE
