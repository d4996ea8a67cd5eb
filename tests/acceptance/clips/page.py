"""Page of a clip: what stands in its fields, and how a person drags on its reel."""

from playwright.sync_api import Page

from app.methods.registry import METHODS

MOVING = next(name for name, method in METHODS.items() if method.inputs[0].moving)
WIDTH, HEIGHT, FRAMES, RATE = 161, 120, 24, 12


def time_of(page: Page) -> list[int]:
    return [int(page.input_value(f"#time-{part}")) for part in ("first", "count")]


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
