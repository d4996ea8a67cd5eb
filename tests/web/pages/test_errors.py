"""Error pages: a title, a reason and where to go on."""

from typing import Any

import pytest

from tests.web.pages.markup import Page


@pytest.mark.parametrize(
    ("path", "status", "words"),
    [("/nothing", 404, "Not found"), ("/experiments/unknown", 404, "Not found")],
)
def test_errors_are_pages(site: Any, path: str, status: int, words: str) -> None:
    answer = site.client.get(path)
    assert answer.status_code == status
    assert answer.headers["content-type"].startswith("text/html")
    assert words in answer.text
    assert Page(answer.text).all("a", href="/archive")
