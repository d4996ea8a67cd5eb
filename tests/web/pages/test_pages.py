"""What holds for every page: no inline script or style, landmarks, titles, static files that are there."""

from typing import Any

import pytest

from tests.web.pages.markup import Page

PAGES = ["/", "/samples/gravel_gray", "/archive", "/archive?method=adsn", "/nothing-here"]


@pytest.mark.parametrize("path", PAGES)
def test_pages_have_no_inline_script_or_style(site: Any, path: str) -> None:
    """Only what the Content-Security-Policy lets through, and nothing from elsewhere."""
    page = Page(site.client.get(path).text)
    assert all("src" in script for script in page.all("script"))
    assert not page.all("style")
    for tag, attributes in page.elements:
        assert "style" not in attributes, tag
        assert not any(name.startswith("on") for name in attributes), tag
        if tag in {"script", "img", "link"}:
            assert (attributes.get("src") or attributes.get("href", "")).startswith("/"), attributes


@pytest.mark.parametrize("path", PAGES)
def test_pages_have_landmarks_and_a_title(site: Any, path: str) -> None:
    page = Page(site.client.get(path).text)
    assert page.title.endswith(" · Microtexture")
    assert [len(page.all(tag)) for tag in ("main", "header", "h1")] == [1, 1, 1]
    assert page.all("a", **{"class": "skip"})[0]["href"] == "#main"


def test_titles_say_what_is_on_the_page(site: Any) -> None:
    titles = [Page(site.client.get(path).text).title for path in PAGES]
    assert len(set(titles)) == len(titles)


def test_every_static_file_a_page_names_is_there(site: Any) -> None:
    for path in PAGES:
        for tag, attributes in Page(site.client.get(path).text).elements:
            name = attributes.get("src") or attributes.get("href", "")
            if tag in {"script", "link", "img"} and name.startswith("/static/"):
                assert site.client.get(name).status_code == 200, name
