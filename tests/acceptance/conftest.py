"""A real server process with its data in a temporary directory, and a real browser that notes every complaint."""

import base64
import json
import os
import re
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from PIL import Image
from playwright.sync_api import Browser, BrowserContext, Page, Playwright, expect, sync_playwright

from tests.acceptance.waiting import PATIENCE, until

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "samples"
SCREENSHOTS = Path(__file__).parent / "screenshots"
WORKERS = 2
STANDARDS = {"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]}


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.acceptance)


@dataclass
class Site:
    """The served application and a client of its API."""

    url: str
    client: httpx.Client = field(repr=False)

    def run(
        self, sample: str, crop: tuple[int, int, int, int], method: str = "rpn", *others: str, **parameters: Any
    ) -> dict[str, Any]:
        """Run an experiment to its end; its record. Further samples have the first one's crop."""
        return self.submit(sample, crop, method, *others, wait=True, **parameters)

    def submit(
        self,
        sample: str,
        crop: tuple[int, int, int, int],
        method: str,
        *others: str,
        wait: bool = False,
        **parameters: Any,
    ) -> dict[str, Any]:
        """Submit an experiment; its record."""
        rectangle = dict(zip(("x", "y", "width", "height"), crop, strict=True))
        inputs = [{"sample": name, "crop": rectangle} for name in (sample, *others)]
        answer = self.client.post(
            "/api/v1/experiments",
            json={"method": method, "inputs": inputs, "parameters": parameters},
            headers={"Prefer": "wait=30"} if wait else {},
        )
        assert answer.status_code == (201 if wait else 202), answer.text
        return dict(answer.json())


def _responds(client: httpx.Client, path: str) -> httpx.Response | None:
    try:
        answer = client.get(path)
    except httpx.TransportError:
        return None
    return answer if answer.status_code == 200 else None


@contextmanager
def serving(directory: Path, **settings: str) -> Iterator[Site]:
    """Serve the application in a process of its own, with its bundled samples, until the block ends."""
    with socket.create_server(("127.0.0.1", 0)) as reserved:
        port = reserved.getsockname()[1]
    chosen = {"DATA_DIR": str(directory / "data"), "WORKERS": str(WORKERS)} | settings
    environment = os.environ | {f"MICROTEXTURE_{name}": value for name, value in chosen.items()}
    command = [str(Path(sys.executable).parent / "microtexture"), "serve", "--port", str(port)]
    log = (directory / "server.log").open("w")
    process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=log, stderr=subprocess.STDOUT)
    catalogue = json.loads((SAMPLES / "catalogue.json").read_text())
    try:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE + 5) as client:
            until(lambda: process.poll() is not None or _responds(client, "/readyz"), "a server that is ready")
            assert process.poll() is None, (directory / "server.log").read_text()
            until(lambda: len(client.get("/api/v1/samples").json()["samples"]) == len(catalogue), "the bundled samples")
            yield Site(f"http://127.0.0.1:{port}", client)
    finally:
        process.terminate()
        process.wait(PATIENCE)
        log.close()


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    with serving(tmp_path_factory.mktemp("acceptance")) as served:
        yield served


@pytest.fixture(scope="session")
def full_site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """A server whose queue is full: one long experiment runs, and as many wait as may."""
    with serving(tmp_path_factory.mktemp("full"), WORKERS="1", QUEUE_LIMIT="1") as served:
        for status in ("running", "queued"):
            record = served.submit("gravel_gray", (96, 96, 72, 72), "efros-leung", width=1024, height=1024)
            address = f"/api/v1/experiments/{record['id']}"
            until(lambda a=address, s=status: served.client.get(a).json()["status"] == s, f"one that is {status}")
        yield served


@pytest.fixture(scope="session")
def experiment(site: Site) -> dict[str, Any]:
    """A finished RPN of rippled sand, half as large again as its crop."""
    return site.run("sand_desert009", (256, 256, 256, 192), width=384, height=288, seed=7)


@pytest.fixture(scope="session")
def busy(site: Site) -> Callable[[], AbstractContextManager[None]]:
    """A context in which every worker has something to do, so that what is queued meanwhile waits until it ends."""
    crop = {"x": 0, "y": 0, "width": 96, "height": 96}
    long = {"inputs": [{"sample": "gravel_gray", "crop": crop}], "parameters": {"width": 800, "height": 800}}

    @contextmanager
    def busy() -> Iterator[None]:
        answers = [
            site.client.post("/api/v1/experiments", json={"method": "efros-leung", **long}) for _ in range(WORKERS)
        ]
        try:
            yield
        finally:
            for answer in answers:
                site.client.delete(f"/api/v1/experiments/{answer.json()['id']}")

    return busy


@pytest.fixture(scope="session")
def pages(site: Site, experiment: dict[str, Any]) -> dict[str, str]:
    """Name → address of every kind of page."""
    other = site.run("sand_desert009", (256, 256, 256, 192), method="adsn", width=384, height=288, seed=7)
    site.run("gravel_gray", (96, 96, 256, 256))
    mixture = site.run("gravel_gray", (96, 96, 192, 192), "mix", "towel_red", "rockface_pink", seed=2)
    convergence = site.run("gravel_gray", (96, 96, 128, 128), "dsn", convergence=True, spot="disc")
    videos = site.run("sand_under_water", (40, 40, 96, 96), "video-rpn", frames=8)
    return {
        "home": "/",
        "sample": "/samples/scene_china",
        "several-samples": "/samples/gravel_gray?method=mix&third=towel_red",
        "clip": "/samples/sky_pan?method=video-patchwork&time=12,48",
        "clip-frame": "/samples/sky_pan?method=rpn&time=12,1",
        "clip-lacking": "/samples/gravel_gray?method=video-patchwork",
        "mixture": f"/experiments/{mixture['id']}",
        "convergence": f"/experiments/{convergence['id']}",
        "experiment": f"/experiments/{experiment['id']}",
        "flip": f"/experiments/{experiment['id']}?view=flip",
        "slider": f"/experiments/{experiment['id']}?view=slider",
        "tiled": f"/experiments/{experiment['id']}?view=tiled&tiles=3",
        "steps": f"/experiments/{experiment['id']}?view=steps",
        "compare": f"/compare/{experiment['id']}/{other['id']}",
        "videos": f"/experiments/{videos['id']}",
        "videos-tiled": f"/experiments/{videos['id']}?view=tiled",
        "methods": "/methods",
        "method-of-videos": "/methods/video-rpn",
        "archive": "/archive",
        "nothing": "/nothing-here",
    }


@pytest.fixture(scope="session")
def playwright() -> Iterator[Playwright]:
    expect.set_options(timeout=PATIENCE * 1000)
    with sync_playwright() as started:
        yield started


@pytest.fixture(scope="session")
def browser(playwright: Playwright, chromium: dict[str, Any]) -> Iterator[Browser]:
    browser = playwright.chromium.launch(**chromium)
    yield browser
    browser.close()


@dataclass
class Visitors:
    """Opens pages; ``complaints`` are what browsers logged on them: errors, and breaches of the security policy."""

    browser: Browser
    url: str
    complaints: list[str] = field(default_factory=list)
    contexts: list[BrowserContext] = field(default_factory=list)
    refusals_expected: bool = False

    def visit(self, path: str = "/", **options: Any) -> Page:
        options = {"viewport": {"width": 1440, "height": 900}, "base_url": self.url, **options}
        context = self.browser.new_context(**options)
        context.set_default_timeout(PATIENCE * 1000)
        self.contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: self._note(message.type, message.text))
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.goto(path)
        return page

    def _note(self, kind: str, text: str) -> None:
        refusal = re.match("Failed to load resource: the server responded with a status of (4|503)", text)
        if kind in {"error", "warning"} and not (refusal and self.refusals_expected):
            self.complaints.append(text)


@pytest.fixture
def visitors(browser: Browser, site: Site) -> Iterator[Visitors]:
    """Whatever a test does, no page may log an error while it does it."""
    visitors = Visitors(browser, site.url)
    yield visitors
    for context in visitors.contexts:
        context.close()
    assert visitors.complaints == []


def shown_pixels(page: Page, selector: str) -> np.ndarray:
    """The pixels (H, W, 3) uint8 of a picture, video or canvas as the browser shows it."""
    page.wait_for_function(
        """selector => {
            const shown = document.querySelector(selector);
            if (!shown) return false;
            const canvas = new OffscreenCanvas(1, 1).getContext("2d");
            canvas.drawImage(shown, 0, 0, 1, 1);
            return canvas.getImageData(0, 0, 1, 1).data[3] > 0; // what has no picture yet draws nothing
        }""",
        arg=selector,
    )
    address = page.evaluate(
        """selector => {
            const shown = document.querySelector(selector);
            const width = shown.naturalWidth ?? shown.videoWidth ?? shown.width;
            const canvas = new OffscreenCanvas(width, shown.naturalHeight ?? shown.videoHeight ?? shown.height);
            canvas.getContext("2d").drawImage(shown, 0, 0);
            return canvas.convertToBlob({type: "image/png"}).then(blob => new Promise(done => {
                const reader = new FileReader();
                reader.onload = () => done(reader.result);
                reader.readAsDataURL(blob);
            }));
        }""",
        selector,
    )
    data = base64.b64decode(address.partition(",")[2])
    return np.asarray(Image.open(BytesIO(data)).convert("RGB"))


@pytest.fixture(scope="session", name="shown_pixels")
def shown_pixels_fixture() -> Callable[[Page, str], np.ndarray]:
    return shown_pixels


@pytest.fixture(scope="session", name="until")
def until_fixture() -> Callable[..., Any]:
    return until


@pytest.fixture(scope="session")
def photograph() -> Path:
    """What a visitor uploads: 1024 × 1024 pixels of soil."""
    return SAMPLES / "soil_ground010.png"


@pytest.fixture(scope="session")
def assert_accessible() -> Callable[[Page], None]:
    """Axe finds nothing on a page."""

    def check(page: Page) -> None:
        found = Axe().run(page, options=STANDARDS)
        assert found.violations_count == 0, f"{page.url}: {found.generate_report()}"

    return check


@pytest.fixture
def screenshot() -> Callable[[Page, str], None]:
    """Leave a picture of the page for a person to look at."""

    def take(page: Page, name: str, *, full_page: bool = True) -> None:
        SCREENSHOTS.mkdir(exist_ok=True)
        page.screenshot(path=SCREENSHOTS / f"{name}.png", full_page=full_page)

    return take
