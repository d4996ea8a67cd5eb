"""Chromium, driven by Playwright; a phone is one with a touch screen."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, ConsoleMessage
from playwright.sync_api import Error as PlaywrightError

from tests.acceptance.engines.window import PATIENCE, GoneError, Point, Window, ways_in_steps

# Milliseconds that fingers rest: Chromium takes what follows at once for the second tap of a double one.
REST = 400
REFUSED = "Failed to load resource: the server responded with a status of 4"


class Chromium(Window):
    engine = "Chromium"

    def __init__(
        self, browser: Browser, url: str, directory: Path, width: int, height: int, phone: bool = False
    ) -> None:
        self.context = browser.new_context(
            base_url=url, viewport={"width": width, "height": height}, has_touch=phone, is_mobile=phone
        )
        self.context.set_default_timeout(PATIENCE * 1000)
        self.directory = directory
        self.noted: list[str] = []
        self.page = self.context.new_page()
        self.page.on("console", self._note)
        self.page.on("pageerror", lambda error: self.noted.append(str(error)))
        self.protocol = self.context.new_cdp_session(self.page)

    def _note(self, message: ConsoleMessage) -> None:
        # A refusal is an answer; what the page does with it is looked at on the page.
        if message.type in {"error", "warning"} and not message.text.startswith(REFUSED):
            self.noted.append(message.text)

    def go(self, address: str) -> None:
        self.page.goto(address, wait_until="commit")

    def run(self, expression: str) -> Any:
        try:
            return self.page.evaluate(expression)
        except PlaywrightError as error:
            raise GoneError(error.message) from error

    def drag(self, way: Sequence[Point]) -> None:
        self.page.mouse.move(*way[0])
        self.page.mouse.down()
        for point in way[1:]:
            self.page.mouse.move(*point, steps=4)
        self.page.mouse.up()

    def fingers(self, ways: Sequence[Sequence[Point]]) -> None:
        self.page.wait_for_timeout(REST)
        for number, points in enumerate(ways_in_steps(ways)):
            touches = [{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(points)]
            kind = "touchMove" if number else "touchStart"
            self.protocol.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})
        self.protocol.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    def wheel(self, at: Point, by: float) -> None:
        self.page.mouse.move(*at)
        self.page.mouse.wheel(0, by)

    def press(self, keys: str) -> None:
        self.page.keyboard.press(keys)

    def write(self, text: str) -> None:
        self.page.keyboard.type(text)

    def choose(self, selector: str, path: Path) -> None:
        self.page.set_input_files(selector, path)

    def capture(self) -> bytes:
        return self.page.screenshot()

    def download(self, act: Callable[[], None]) -> Path:
        with self.page.expect_download() as kept:
            act()
        path = self.directory / kept.value.suggested_filename
        kept.value.save_as(path)
        return path

    def complaints(self) -> list[str]:
        self.page.evaluate("0")  # what was logged comes while Playwright waits for an answer
        noted, self.noted = self.noted, []
        return noted

    def close(self) -> None:
        self.context.close()
