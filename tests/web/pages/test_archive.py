"""Archive page: filtered by method, older and newer."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.web.pages.markup import Page, get


def test_the_archive_filters_and_pages(site: Any) -> None:
    """Older and newer lead there and back."""
    with site.visitor() as visitor:
        for seed in range(26):
            site.run(parameters={"seed": seed}, client=visitor)
    first = get(site, "/archive?method=rpn")
    assert len(first.all("a", **{"class": "pair"})) == 24
    assert not first.all("a", rel="prev")
    second = get(site, first.all("a", rel="next")[0]["href"])
    shown = {link["href"] for link in second.all("a", **{"class": "pair"})}
    assert shown
    assert shown.isdisjoint(link["href"] for link in first.all("a", **{"class": "pair"}))
    assert second.all("a", rel="prev")[0]["href"] == "/archive?method=rpn"
    assert site.run(method="adsn").json()["status"] == "succeeded"
    adsn = Page(site.client.get("/archive?method=adsn").text)
    pairs = adsn.all("a", **{"class": "pair"})
    assert pairs
    assert not shown & {link["href"] for link in pairs}


def test_an_empty_archive_says_so(serve: Callable[..., Any], tmp_path: Path) -> None:
    with serve(tmp_path) as site:
        assert "Nothing has been published here yet." in site.client.get("/archive").text
        assert "Nothing has been synthesised here yet." in site.client.get("/").text
