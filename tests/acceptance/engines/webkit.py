"""WebKit, Safari's engine, as WebKitGTK's MiniBrowser on a screen that is not there, driven by WebDriver."""

import os
import socket
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import httpx
from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.client_config import ClientConfig
from selenium.webdriver.remote.file_detector import UselessFileDetector
from selenium.webdriver.remote.remote_connection import RemoteConnection

from tests.acceptance.engines.children import child, program
from tests.acceptance.engines.window import PATIENCE, GoneError, Point, Window, kept_in
from tests.acceptance.waiting import until

STEP = 60  # milliseconds a pointer takes from point to point
TITLE_BAR = 200  # pixels of the screen for what MiniBrowser shows around its page
KEYS = {
    "Control": Keys.CONTROL,
    "Shift": Keys.SHIFT,
    "Tab": Keys.TAB,
    "Enter": Keys.ENTER,
    "Home": Keys.HOME,
    "End": Keys.END,
    "ArrowLeft": Keys.ARROW_LEFT,
    "ArrowRight": Keys.ARROW_RIGHT,
    "ArrowUp": Keys.ARROW_UP,
    "ArrowDown": Keys.ARROW_DOWN,
    "PageUp": Keys.PAGE_UP,
    "PageDown": Keys.PAGE_DOWN,
}

# WebKit's driver has no log. Errors are kept in the window's own storage, which outlives a page; a module that failed
# before this was there fails again when it is asked for.
WATCH = """(() => {
    if (window.watched || !/^http/.test(location.protocol)) return;
    window.watched = true;
    const note = (text) => {
        const noted = JSON.parse(sessionStorage.getItem("complaints") ?? "[]");
        sessionStorage.setItem("complaints", JSON.stringify([...noted, `${location.pathname}: ${text}`]));
    };
    addEventListener("error", (event) => note(event.message));
    addEventListener("unhandledrejection", (event) => note(event.reason));
    addEventListener("securitypolicyviolation",
        ({ violatedDirective, blockedURI }) => note(`${violatedDirective} ${blockedURI}`));
    for (const kind of ["error", "warn"]) {
        const say = console[kind];
        console[kind] = (...said) => { note(said.join(" ")); say.apply(console, said); };
    }
    const again = () => document.querySelectorAll("script[type=module][src]").forEach(
        (script) => import(script.src).catch((error) => note(`${script.src}: ${error}`)));
    if (document.readyState === "complete") again();
    else addEventListener("load", again);
})()"""
NOTED = """() => {
    const noted = JSON.parse(sessionStorage.getItem("complaints") ?? "[]");
    sessionStorage.removeItem("complaints");
    return noted;
}"""


def minibrowser() -> Path:
    """The browser that comes with the library; it is not among the programs one starts by name."""
    found = sorted(Path("/usr").glob("lib*/**/webkit2gtk-4*/MiniBrowser"))
    assert found, "WebKit's MiniBrowser is missing: run scripts/test-packages"
    return found[-1]


def environment(home: Path, kept: Path, display: str) -> dict[str, str]:
    """Nothing of the person's own settings; programs draw without a graphics card and without a desktop."""
    (home / ".config").mkdir(parents=True)
    (home / ".config" / "user-dirs.dirs").write_text(f'XDG_DOWNLOAD_DIR="{kept}"\n')
    return {
        "PATH": os.environ["PATH"],
        "LANG": "C.UTF-8",
        "HOME": str(home),
        "DISPLAY": display,
        "LIBGL_ALWAYS_SOFTWARE": "1",
        "NO_AT_BRIDGE": "1",
        "GSETTINGS_BACKEND": "memory",
        # WebKit cannot put its processes into a sandbox where it is root, or in a container.
        "WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS": "1",
    }


class WebKit(Window):
    engine = "WebKit"

    def __init__(self, url: str, directory: Path, width: int, height: int) -> None:
        self.url = url
        self.kept = directory / "kept"
        self.kept.mkdir()
        self.stack = ExitStack()
        try:
            self.driver = self._start(directory, width, height)
        except BaseException:
            self.close()
            raise

    def _start(self, directory: Path, width: int, height: int) -> webdriver.Remote:
        display = self._screen(directory / "xvfb.log", width, height + TITLE_BAR)
        with socket.create_server(("127.0.0.1", 0)) as reserved:
            port = reserved.getsockname()[1]
        around = environment(directory / "home", self.kept, display)
        driver = program("WEBKIT_DRIVER", "WebKitWebDriver")
        log = directory / "webkit.log"
        process = self.stack.enter_context(child([driver, f"--port={port}"], log, env=around))
        address = f"http://127.0.0.1:{port}"

        def ready() -> bool:
            assert process.poll() is None, f"WebKit's driver ended: {log.read_text()}"
            try:
                return bool(httpx.get(f"{address}/status").json()["value"]["ready"])
            except httpx.TransportError:
                return False

        until(ready, "WebKit's driver", PATIENCE)
        options = webdriver.WebKitGTKOptions()
        options.binary_location = str(minibrowser())
        options.add_argument("--automation")
        connection = RemoteConnection(client_config=ClientConfig(remote_server_addr=address, timeout=2 * int(PATIENCE)))
        started = webdriver.Remote(connection, options=options, file_detector=UselessFileDetector())
        self.stack.callback(started.quit)
        started.set_script_timeout(PATIENCE)
        started.get("about:blank")
        started.set_window_rect(0, 0, width, height)
        wide, high = started.execute_script("return [innerWidth, innerHeight]")
        started.set_window_rect(0, 0, 2 * width - wide, 2 * height - high)
        until(
            lambda: started.execute_script("return [innerWidth, innerHeight]") == [width, height],
            "WebKit's window",
            PATIENCE,
        )
        return started

    def _screen(self, log: Path, width: int, height: int) -> str:
        """Start a screen; its name. The number is one that is free."""
        reading, writing = os.pipe()
        with os.fdopen(reading) as told:
            try:
                sizes = ["-screen", "0", f"{width}x{height}x24"]
                command = [program("XVFB", "Xvfb"), "-displayfd", str(writing), *sizes, "-nolisten", "tcp"]
                self.stack.enter_context(child(command, log, pass_fds=[writing]))
            finally:
                os.close(writing)
            number = told.readline().strip()  # up to the end of the line: a screen that cannot write that ends
        assert number, f"no screen for WebKit: {log.read_text()}"
        return f":{number}"

    def go(self, address: str) -> None:
        self.driver.get(self.url + address)

    def run(self, expression: str) -> Any:
        script = f"const done = arguments[0]; {WATCH}; Promise.resolve({expression}).then(done);"
        try:
            return self.driver.execute_async_script(script)
        except WebDriverException as error:
            raise GoneError(error.msg) from error

    def drag(self, way: Sequence[Point]) -> None:
        actions = ActionChains(self.driver, duration=STEP)
        pointer = actions.w3c_actions.pointer_action
        for number, (x, y) in enumerate(way):
            pointer.move_to_location(round(x), round(y))
            if number == 0:
                pointer.pointer_down()
        pointer.pointer_up()
        actions.perform()

    def fingers(self, ways: Sequence[Sequence[Point]]) -> None:
        raise NotImplementedError("WebKitGTK's driver has no fingers")

    def wheel(self, at: Point, by: float) -> None:
        actions = ActionChains(self.driver, duration=STEP)
        actions.w3c_actions.wheel_action.scroll(round(at[0]), round(at[1]), 0, round(by))
        actions.perform()

    def press(self, keys: str) -> None:
        *held, last = [KEYS.get(key, key) for key in keys.split("+")]
        actions = ActionChains(self.driver)
        for key in held:
            actions.key_down(key)
        actions.send_keys(last)
        for key in reversed(held):
            actions.key_up(key)
        actions.perform()

    def write(self, text: str) -> None:
        ActionChains(self.driver).send_keys(text).perform()

    def choose(self, selector: str, path: Path) -> None:
        self.look(
            "(selector) => { document.querySelector(selector).hidden = false; }", selector
        )  # the driver asks for it
        self.driver.find_element(By.CSS_SELECTOR, selector).send_keys(str(path))

    def capture(self) -> bytes:
        return self.driver.get_screenshot_as_png()

    def download(self, act: Callable[[], None]) -> Path:
        return kept_in(self.kept, act)

    def complaints(self) -> list[str]:
        return list(self.look(NOTED))

    def close(self) -> None:
        self.stack.close()
