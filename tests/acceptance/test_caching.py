"""Pictures of pages are kept by the browser: it asks for none of them twice."""

import json
from typing import Any

import pytest

SHOWN = """() => Array.from(document.images).filter((image) => image.loading !== "lazy")
    .every((image) => image.complete && image.naturalWidth > 0)"""
FETCHED = """() => JSON.stringify(performance.getEntriesByType("resource")
    .filter(({ name }) => /\\/api\\/v1\\/.*\\/(image|outputs\\/)/.test(name))
    .map(({ name, transferSize }) => [name, transferSize]))"""


@pytest.mark.parametrize("path", ["/", "/samples/gravel_gray", "/experiments/{id}"])
def test_who_comes_again_loads_no_picture_anew(visitors: Any, experiment: dict[str, Any], path: str) -> None:
    """Neither by going back nor by opening the page once more."""
    path = path.format(id=experiment["id"])
    page = visitors.visit(path)
    page.wait_for_function(SHOWN)
    first = json.loads(page.evaluate(FETCHED))
    assert first
    assert all(size > 0 for _, size in first)
    page.goto("/methods")
    page.go_back()
    page.wait_for_function(SHOWN)
    page.goto(path)
    page.wait_for_function(SHOWN)
    eager = {name for name, _ in first}
    again = [entry for entry in json.loads(page.evaluate(FETCHED)) if entry[0] in eager]
    assert again
    assert [entry for entry in again if entry[1] > 0] == []
