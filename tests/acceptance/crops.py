"""Where a crop is: in its four fields, in its box on the screen, and how mouse and fingers get there."""

from dataclasses import dataclass
from typing import Any

from playwright.sync_api import CDPSession, Page

SIDES = ("x", "y", "width", "height")
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True, "device_scale_factor": 3}

Point = tuple[float, float]


def crop_of(page: Page, prefix: str = "") -> list[int]:
    return [int(page.input_value(f"#{prefix}crop-{side}")) for side in SIDES]


@dataclass(frozen=True)
class Sight:
    """How the frame shows the photograph: its corner on the screen, and screen pixels per pixel of the original."""

    x: float
    y: float
    scale: float

    def at(self, x: float, y: float) -> Point:
        return self.x + x * self.scale, self.y + y * self.scale


def sight_of(page: Page, prefix: str = "") -> Sight:
    """Measure the photograph itself, whatever the editor says of it."""
    found = page.evaluate(
        """prefix => {
            const frame = document.querySelector(`#${prefix}frame`);
            const {x, y, width} = frame.querySelector("img, video").getBoundingClientRect();
            return [x, y, width / frame.dataset.width];
        }""",
        prefix,
    )
    return Sight(*found)


def on_screen(page: Page, x: float, y: float) -> Point:
    """Where a place of the original is."""
    return sight_of(page).at(x, y)


def box_of(page: Page) -> list[float]:
    """Where the box is, in pixels of the original."""
    sight = sight_of(page)
    bounds = page.locator("#frame .box").bounding_box()
    assert bounds is not None
    return [
        (bounds["x"] - sight.x) / sight.scale,
        (bounds["y"] - sight.y) / sight.scale,
        bounds["width"] / sight.scale,
        bounds["height"] / sight.scale,
    ]


def drag(page: Page, start: Point, end: Point) -> None:
    """With the mouse, from and to pixels of the original."""
    page.mouse.move(*on_screen(page, *start))
    page.mouse.down()
    page.mouse.move(*on_screen(page, *end), steps=4)
    page.mouse.up()


class Fingers:
    """Real touches on a page, in pixels of the screen."""

    def __init__(self, page: Page) -> None:
        self._session: CDPSession = page.context.new_cdp_session(page)

    def _send(self, kind: str, points: list[Point]) -> None:
        touched = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touched})

    def put(self, *points: Point) -> None:
        """One finger after the other, as hands do."""
        for count in range(1, len(points) + 1):
            self._send("touchStart", list(points[:count]))

    def move(self, start: list[Point], end: list[Point], steps: int = 12) -> None:
        for step in range(1, steps + 1):
            part = step / steps
            between = [
                (x0 + part * (x1 - x0), y0 + part * (y1 - y0)) for (x0, y0), (x1, y1) in zip(start, end, strict=True)
            ]
            self._send("touchMove", between)

    def lift(self) -> None:
        self._send("touchEnd", [])

    def swipe(self, start: Point, end: Point) -> None:
        self.put(start)
        self.move([start], [end])
        self.lift()

    def pinch(self, start: list[Point], end: list[Point]) -> None:
        self.put(*start)
        self.move(start, end)
        self.lift()


def phone(visitors: Any, path: str) -> tuple[Page, Fingers]:
    page = visitors.visit(path, **PHONE)
    page.wait_for_selector("#frame.ready")
    return page, Fingers(page)
