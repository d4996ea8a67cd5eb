"""Page of a clip: what stands in its fields, and how a person drags and tabs there."""

from typing import Any

from playwright.sync_api import Page

from app.methods.registry import METHODS

SIDES = ("x", "y", "width", "height")
MOVING = next(name for name, method in METHODS.items() if method.inputs[0].moving)
WIDTH, HEIGHT, FRAMES, RATE = 161, 120, 24, 12


def crop_of(page: Page) -> list[int]:
    return [int(page.input_value(f"#crop-{side}")) for side in SIDES]


def time_of(page: Page) -> list[int]:
    return [int(page.input_value(f"#time-{part}")) for part in ("first", "count")]


def record_of(site: Any, page: Page) -> dict[str, Any]:
    page.wait_for_url("**/experiments/*")
    return dict(site.client.get("/api/v1/experiments/" + page.url.rsplit("/", 1)[-1]).json())


def shows(page: Page, frame: int) -> None:
    """Wait until the video has stopped at a frame."""
    page.wait_for_function(
        """([frame, rate]) => {
            const video = document.querySelector("#frame video");
            const at = Math.floor(video.currentTime * rate);
            return video.paused && !video.seeking && video.readyState >= 2 && at === frame;
        }""",
        arg=[frame, RATE],
    )


def drag(page: Page, start: float, end: float) -> None:
    """Drag on the reel, from and to places between frames."""
    bounds = page.locator("#crop .track").bounding_box()
    assert bounds is not None
    across, y = bounds["width"] / FRAMES, bounds["y"] + bounds["height"] / 2
    page.mouse.move(bounds["x"] + start * across, y)
    page.mouse.down()
    page.mouse.move(bounds["x"] + end * across, y, steps=4)
    page.mouse.up()


def tab_to(page: Page, selector: str, key: str = "Tab") -> None:
    for _ in range(80):
        page.keyboard.press(key)
        if page.evaluate("selector => document.activeElement.matches(selector)", selector):
            return
    raise AssertionError(f"{key} does not lead to {selector}")
