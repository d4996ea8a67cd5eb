"""The order of the tests, how many examples their properties take, and the browser that some of them drive."""

import os
from pathlib import Path
from typing import Any

import pytest

from tests import profiles

BROWSER = Path(__file__).parent / "acceptance"
CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium")
ARGUMENTS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]

profiles.register()

os.environ.setdefault("MICROTEXTURE_CATALOGUE", "false")  # figures in the background would disturb what others measure
os.environ.setdefault("MICROTEXTURE_LIMITS", "false")  # one address asks for everything here


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the browser's tests last: Playwright keeps an event loop running here, where others start their own."""
    items.sort(key=lambda item: BROWSER in item.path.parents)


@pytest.fixture(scope="session")
def chromium() -> dict[str, Any]:
    """How Playwright launches Debian's Chromium, or the one that ``CHROMIUM`` names."""
    return {"executable_path": CHROMIUM, "args": ARGUMENTS}
