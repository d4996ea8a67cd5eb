"""A window of a browser: a few primitives that each engine has its own way to do, and verbs made of them.

Whatever a person does goes through pointer, fingers and keys; scripts only look.
"""

import json
from abc import ABC, abstractmethod
from base64 import b64decode
from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from tests.acceptance.waiting import until

Point = tuple[float, float]
PATIENCE = 60.0  # seconds; the machine may be busy with something else

# Evaluates CALL, which may use `seen`: the elements of a selector that are on the page for the eye.
LOOK = """(async () => {
    const seen = (selector) => [...document.querySelectorAll(selector)].filter(
        (each) => each.checkVisibility({ visibilityProperty: true }));
    try { return { value: (await CALL) ?? null }; } catch (error) { return { error: `${error}` }; }
})()"""

# Where a pointer would press: the middle of what is to be pressed, once it stands still and nothing lies over it.
PLACE = """async (selector, text) => {
    const said = (each) => [each.textContent.trim(), each.getAttribute("aria-label")];
    const found = seen(selector).find((each) => !each.disabled && (text === null || said(each).includes(text)));
    if (!found) return null;
    const middle = () => {
        const { x, y, width, height } = found.getClientRects()[0];
        return [x + width / 2, y + height / 2];
    };
    const free = ([x, y]) => {
        const there = document.elementFromPoint(x, y);
        return there && (found.contains(there) || there.contains(found));
    };
    if (!free(middle())) {
        found.scrollIntoView({ block: "center", inline: "center", behavior: "instant" });
        return null; // it is looked at again, when what takes hold of pointers and fingers knows of it too
    }
    const before = middle();
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const now = middle();
    return Math.hypot(now[0] - before[0], now[1] - before[1]) < 0.5 && free(now) ? now : null;
}"""

# Scrolls to an element and waits until that is on the screen; its left, top, width and height there.
BOUNDS = """async (selector, scroll) => {
    const [found] = seen(selector);
    if (!found) return null;
    if (scroll) found.scrollIntoView({ block: "nearest", inline: "nearest", behavior: "instant" });
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const { x, y, width, height } = found.getBoundingClientRect();
    return width && [x, y, width, height];
}"""

# The pixels of an <img>, <video> or <canvas>, whatever its size on the screen.
DECODED = """async (selector) => {
    const shown = document.querySelector(selector);
    if (shown?.complete === false) return null;
    await shown?.decode?.();
    const width = shown?.naturalWidth ?? shown?.videoWidth ?? shown?.width;
    if (!width || (shown.readyState ?? 4) < 2) return null; // 2: a video has its picture
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width, height: shown.naturalHeight ?? shown.videoHeight ?? shown.height });
    canvas.getContext("2d").drawImage(shown, 0, 0);
    return canvas.toDataURL("image/png").split(",")[1];
}"""


class GoneError(Exception):
    """The document went away while a script looked at it: another page is coming."""


class Window(ABC):
    """One window with a profile of its own."""

    engine: str
    fingers_scroll = True

    @abstractmethod
    def go(self, address: str) -> None:
        """Begin to open an address."""

    @abstractmethod
    def run(self, expression: str) -> Any:
        """What a JavaScript expression, or the promise it gives, comes to, as JSON; raises `GoneError`."""

    @abstractmethod
    def drag(self, way: Sequence[Point]) -> None:
        """Press the pointer's button at the first point of the viewport, move through the others, release."""

    @abstractmethod
    def fingers(self, ways: Sequence[Sequence[Point]]) -> None:
        """Put a finger on the first point of every way at once, move all of them, and lift them together."""

    @abstractmethod
    def wheel(self, at: Point, by: float) -> None:
        """Turn the wheel over a point; positive is down."""

    @abstractmethod
    def press(self, keys: str) -> None:
        """Press a key with others held, such as ``Control+Shift+ArrowLeft``."""

    @abstractmethod
    def write(self, text: str) -> None:
        """Type a text."""

    @abstractmethod
    def choose(self, selector: str, path: Path) -> None:
        """Choose a file for a file field, as if in the browser's own dialogue."""

    @abstractmethod
    def capture(self) -> bytes:
        """What is on the screen, as PNG."""

    @abstractmethod
    def download(self, act: Callable[[], None]) -> Path:
        """Do what makes the browser keep a file; where that is, once it is whole."""

    @abstractmethod
    def complaints(self) -> list[str]:
        """The errors that pages logged since this was asked last: exceptions, rejections, breaches of the policy."""

    @abstractmethod
    def close(self) -> None:
        """End the browser and everything it started."""

    def look(self, function: str, *arguments: Any) -> Any:
        """Call a JavaScript function on the page."""
        answer = self.run(LOOK.replace("CALL", f"({function})(...{json.dumps(arguments)})"))
        assert "error" not in answer, answer["error"]
        return answer["value"]

    def until(self, function: str, *arguments: Any) -> Any:
        """Wait until a JavaScript function gives something, over as many pages as it takes; what it gave."""

        def found() -> Any:
            try:
                return self.look(function, *arguments)
            except GoneError:
                return None

        return until(found, f"{self.engine}: {function} {arguments or ''}", PATIENCE)

    def open(self, address: str) -> None:
        """Open an address and wait until all of it is there."""
        self.look("() => { window.left = true; }")
        self.go(address)
        self.until("() => !window.left && document.readyState === 'complete'")

    def at(self, path: str) -> str:
        """Wait until the window is at a path that begins so, and the page is whole; the path."""
        begins = (
            "(path) => location.pathname.startsWith(path) && document.readyState === 'complete' && location.pathname"
        )
        return str(self.until(begins, path))

    def has(self, selector: str, text: str = "") -> str:
        """Wait until an element is seen and holds a text; all of its text."""
        said = "seen(selector).map((each) => each.innerText || ' ').find((said) => said.includes(text))"
        return str(self.until(f"(selector, text) => {said}", selector, text))

    def lacks(self, selector: str) -> None:
        """Wait until no such element is seen."""
        self.until("(selector) => seen(selector).length === 0", selector)

    def place(self, selector: str, text: str | None = None) -> Point:
        """Where to press an element, which may be named by what it says; it is scrolled to if need be."""
        x, y = self.until(PLACE, selector, text)
        return x, y

    def click(self, selector: str, text: str | None = None) -> None:
        self.drag([self.place(selector, text)])

    def tap(self, selector: str, text: str | None = None) -> None:
        self.fingers([[self.place(selector, text)]])

    def fill(self, selector: str, text: str) -> None:
        """Type a text in the place of what a field has, and leave it."""
        self.click(selector)
        self.press("Control+a")
        self.write(text)
        self.press("Tab")

    def bounds(self, selector: str, scroll: bool = False) -> tuple[float, float, float, float]:
        """Left, top, width and height of the first such element that is seen, in pixels of the viewport."""
        x, y, width, height = self.until(BOUNDS, selector, scroll)
        return x, y, width, height

    def decoded(self, selector: str) -> np.ndarray:
        """The pixels (H, W, 3) uint8 of a picture, video or canvas, as the browser decoded them."""
        return pixels(b64decode(self.until(DECODED, selector)))

    def seen(self, selector: str) -> np.ndarray:
        """What is on the screen where an element is, once scrolled to, (H, W, 3) uint8, in pixels of the viewport."""
        left, top, width, height = (round(side) for side in self.bounds(selector, scroll=True))
        screen = pixels(self.capture())
        return screen[max(0, top) : max(0, top + height), max(0, left) : max(0, left + width)]

    def shows(self, selector: str, picture: np.ndarray, allowed: float = 1.0) -> None:
        """Wait until the screen has a picture (H, W, 3) where an element is, with this mean difference at most."""
        found: list[str] = []

        def same() -> bool:
            seen = self.seen(selector)
            off = difference(seen, picture) if seen.shape == picture.shape else np.inf
            found[:] = [f"{seen.shape} on the screen, {off:.1f} off"]
            return off <= allowed

        try:
            until(same, f"{self.engine} to show {picture.shape} at {selector}", PATIENCE)
        except AssertionError as error:
            raise AssertionError(f"{error}: {found}") from None


def difference(one: np.ndarray, other: np.ndarray) -> float:
    """Mean difference of values."""
    return float(np.abs(one.astype(float) - other).mean())


def pixels(data: bytes) -> np.ndarray:
    """A picture's pixels (H, W, 3) uint8."""
    return np.asarray(Image.open(BytesIO(data)).convert("RGB"))


def ways_in_steps(ways: Sequence[Sequence[Point]], steps: int = 8) -> list[list[Point]]:
    """Where all fingers are, moment by moment; every way has as many points as the others."""
    moments = [[way[0] for way in ways]]
    for number in range(1, len(ways[0])):
        for part in np.linspace(0, 1, steps + 1)[1:]:
            moments.append(
                [tuple(np.multiply(way[number], part) + np.multiply(way[number - 1], 1 - part)) for way in ways]
            )
    return moments


def kept_in(directory: Path, act: Callable[[], None]) -> Path:
    """Do what makes a browser keep a file in a directory; where that is, once it is whole."""
    before = set(directory.iterdir())
    act()

    def found() -> Path | None:
        new = sorted(set(directory.iterdir()) - before)
        whole = len(new) == 1 and new[0].suffix not in {".part", ".wkdownload"} and new[0].stat().st_size
        return new[0] if whole else None

    return Path(until(found, "a file that is kept", PATIENCE))
