"""Page of an experiment with videos: opened, moving or standing still, and where its videos are."""

from collections.abc import Callable
from typing import Any

import numpy as np
from playwright.sync_api import Page, expect

FRAMES = {"texture": 20, "crop": 16}
RATE = 24
VIDEOS = "[...document.querySelectorAll('.stage video')]"
PAUSED = f"{VIDEOS}.every(video => video.paused)"
PLAYING = f"{VIDEOS}.every(video => !video.paused && video.currentTime > 0.1)"
NOISE = 1.0  # mean difference of values that colour conversion may make


def difference(one: np.ndarray, other: np.ndarray) -> float:
    """Mean difference of values."""
    return float(np.abs(one.astype(np.int16) - other.astype(np.int16)).mean())


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
