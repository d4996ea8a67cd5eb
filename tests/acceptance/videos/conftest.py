"""A finished video, its frames by another decoder than the browser's, and waiting until they are shown."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page

from app.images.video.reader import read_video
from tests.acceptance.videos.page import (
    FRAMES,
    NOISE,
    Shows,
    difference,
)


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
