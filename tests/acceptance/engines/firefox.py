"""Firefox, driven by WebDriver BiDi: a small program of Node.js with puppeteer-core takes orders as lines of JSON."""

import json
import subprocess
import sys
from base64 import b64decode
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from tests.acceptance.engines.children import child, program
from tests.acceptance.engines.window import PATIENCE, GoneError, Point, Window, kept_in, ways_in_steps

ROOT = Path(__file__).resolve().parents[3]
NODE = Path(sys.executable).parent / "node"

# Beyond what puppeteer-core sets for tests: nothing but this machine can be reached, and every machine draws alike.
PREFERENCES = {
    "network.proxy.type": 1,
    "network.proxy.http": "127.0.0.1",
    "network.proxy.http_port": 9,
    "network.proxy.ssl": "127.0.0.1",
    "network.proxy.ssl_port": 9,
    "network.connectivity-service.enabled": False,
    "network.captive-portal-service.enabled": False,
    "app.normandy.enabled": False,
    "app.update.auto": False,
    "browser.region.network.url": "",
    "datareporting.healthreport.uploadEnabled": False,
    "media.gmp-manager.updateEnabled": False,
    "toolkit.telemetry.enabled": False,
    "layers.acceleration.disabled": True,
    "layout.css.devPixelsPerPx": "1.0",
    "browser.download.folderList": 2,
    "browser.download.always_ask_before_handling_new_types": False,
}
TOUCH = {"dom.w3c_touch_events.enabled": 1}


class Firefox(Window):
    engine = "Firefox"
    fingers_scroll = False  # those of its driver reach the page, but not what scrolls it

    def __init__(self, url: str, directory: Path, width: int, height: int, phone: bool = False) -> None:
        self.url = url
        self.kept = directory / "kept"
        self.kept.mkdir()
        preferences = {**PREFERENCES, **(TOUCH if phone else {}), "browser.download.dir": str(self.kept)}
        told = {
            "binary": program("FIREFOX", "firefox-esr", "firefox"),
            "profile": str(directory / "profile"),
            "preferences": preferences,
            "width": width,
            "height": height,
            "patience": PATIENCE,
        }
        self.log = directory / "firefox.log"
        self.stack = ExitStack()
        command = [str(NODE), str(Path(__file__).with_suffix(".mjs")), json.dumps(told)]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self.process = self.stack.enter_context(child(command, self.log, cwd=ROOT, **pipes))
        try:
            self._answer()
        except BaseException:
            self.close()
            raise

    def _answer(self) -> Any:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        assert line, f"Firefox or its driver ended: {self.log.read_text()}"
        answer = json.loads(line)
        if "error" in answer:
            raise GoneError(answer["error"])
        return answer["value"]

    def _order(self, verb: str, *given: Any) -> Any:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps([verb, *given]) + "\n")
        self.process.stdin.flush()
        return self._answer()

    def go(self, address: str) -> None:
        self._order("go", self.url + address)

    def run(self, expression: str) -> Any:
        return self._order("run", expression)

    def drag(self, way: Sequence[Point]) -> None:
        self._order("drag", list(way))

    def fingers(self, ways: Sequence[Sequence[Point]]) -> None:
        self._order("fingers", ways_in_steps(ways))

    def wheel(self, at: Point, by: float) -> None:
        self._order("wheel", at, by)

    def press(self, keys: str) -> None:
        self._order("press", keys)

    def write(self, text: str) -> None:
        self._order("write", text)

    def choose(self, selector: str, path: Path) -> None:
        self._order("choose", selector, str(path))

    def capture(self) -> bytes:
        return b64decode(self._order("capture"))

    def download(self, act: Callable[[], None]) -> Path:
        return kept_in(self.kept, act)

    def complaints(self) -> list[str]:
        return list(self._order("complaints"))

    def close(self) -> None:
        if self.process.stdin is not None and self.process.poll() is None:
            self.process.stdin.close()
            with suppress(subprocess.TimeoutExpired):  # then it is killed
                self.process.wait(20)
        self.stack.close()
