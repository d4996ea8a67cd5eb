"""The order of the tests."""

from pathlib import Path

import pytest

BROWSER = Path(__file__).parent / "acceptance"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the browser's tests last: Playwright keeps an event loop running here, where others start their own."""
    items.sort(key=lambda item: BROWSER in item.path.parents)
