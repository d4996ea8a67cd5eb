"""A window of each engine, and a service whose workers can be kept busy."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.acceptance.engines.chromium import Chromium
from tests.acceptance.engines.firefox import Firefox
from tests.acceptance.engines.webkit import WebKit
from tests.acceptance.engines.window import PATIENCE, Window

SCREENSHOTS = Path(__file__).parents[1] / "screenshots"
WIDTH, HEIGHT = 1440, 900
PHONE = 390, 844
WORKERS = 2  # of the service that tests drive
FAILED = pytest.StashKey[bool]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Any:
    report = yield
    item.stash[FAILED] = item.stash.get(FAILED, False) or report.failed
    return report


@contextmanager
def opened(window: Window, request: pytest.FixtureRequest, width: int, height: int) -> Iterator[Window]:
    """A window that is closed in the end; of a test that fails it leaves a picture, and none may log an error."""
    try:
        window.open("/")
        assert window.look("() => [innerWidth, innerHeight]") == [width, height]
        yield window
        if request.node.stash.get(FAILED, False):
            SCREENSHOTS.mkdir(exist_ok=True)
            (SCREENSHOTS / f"failed-{request.node.name}.png").write_bytes(window.capture())
        assert window.complaints() == []
    finally:
        window.close()


@pytest.fixture(params=["Chromium", "Firefox", "WebKit"])
def window(request: pytest.FixtureRequest, site: Any, tmp_path: Path) -> Iterator[Window]:
    """A window of each of the three engines, on the home page."""
    if request.param == "Chromium":
        made: Window = Chromium(request.getfixturevalue("browser"), site.url, tmp_path, WIDTH, HEIGHT)
    else:
        made = {"Firefox": Firefox, "WebKit": WebKit}[request.param](site.url, tmp_path, WIDTH, HEIGHT)
    with opened(made, request, WIDTH, HEIGHT) as window:
        yield window


@pytest.fixture(params=["Chromium", "Firefox"])
def phone(request: pytest.FixtureRequest, site: Any, tmp_path: Path) -> Iterator[Window]:
    """A window with the size and the touch screen of a phone; WebKit's driver has no fingers."""
    if request.param == "Chromium":
        made: Window = Chromium(request.getfixturevalue("browser"), site.url, tmp_path, *PHONE, phone=True)
    else:
        made = Firefox(site.url, tmp_path, *PHONE, phone=True)
    with opened(made, request, *PHONE) as window:
        yield window


@pytest.fixture
def busy(site: Any) -> Callable[[], AbstractContextManager[None]]:
    """Keeps every worker of the service at work, so that what is sent meanwhile waits."""

    @contextmanager
    def keep() -> Iterator[None]:
        body = {
            "method": "efros-leung",
            "inputs": [{"sample": "gravel_gray", "crop": {"x": 0, "y": 0, "width": 128, "height": 128}}],
            "parameters": {"width": 600, "height": 600},
            "listed": False,
        }
        with httpx.Client(base_url=site.url, timeout=PATIENCE) as owner, ExitStack() as sent:
            for _ in range(WORKERS):
                answer = owner.post("/api/v1/experiments", json=body).raise_for_status()
                sent.callback(owner.delete, answer.headers["Location"])
            yield

    return keep
