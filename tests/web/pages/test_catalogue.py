"""The catalogue and the figures of the literature, with some of their experiments made and others not."""

import re
from collections.abc import Callable
from html import unescape

import httpx
import pytest

from app.gallery.catalogue import FAILURES, SUCCESSES
from app.gallery.identity import identifier
from app.gallery.literature import FIGURES

Page = Callable[[str], str]
ASKED_FOR = {4, 6, 7, 8, 10, 11, 14, 15, 16}


def test_the_catalogue_shows_every_pair(page: Page) -> None:
    text = unescape(page("/catalogue"))
    for pair in (*SUCCESSES, *FAILURES):
        assert f"<h3>{pair.title}</h3>" in text
        assert pair.note in text


def test_a_pair_that_is_made_has_a_meter_under_each_picture_and_leads_to_its_experiment(
    page: Page, gallery: httpx.Client
) -> None:
    pair = next(pair for pair in FAILURES if pair.exhibit.inputs[0][0] == "lit_plaster")
    entry = next(part for part in page("/catalogue").split('<li class="entry">') if f"<h3>{pair.title}</h3>" in part)
    name = identifier(pair.exhibit)
    assert entry.count(f'href="/experiments/{name}"') == 2
    assert entry.count('class="meter"') == 2
    for output in ("crop", "texture"):
        picture = gallery.get(f"/api/v1/experiments/{name}/outputs/{output}")
        assert (picture.status_code, picture.headers["content-type"]) == (200, "image/png")
    assert "figure-" not in page("/archive")
    change = unescape(re.search(r'href="(/samples/[^"]+)"', entry)[1])
    assert 'value="rpn"' in page(change)


def test_a_picture_that_is_not_made_says_so_and_shows_its_crop_if_the_sample_is_there(page: Page) -> None:
    text = page("/figures")
    windows = next(part for part in text.split("<figure")[1:] if 'id="windows"' in part)
    assert "Not made yet" in windows
    assert 'viewBox="96 96 80 80"' in windows
    draws = next(part for part in text.split("<figure")[1:] if 'id="nine-draws"' in part)
    assert "/outputs/" not in draws
    assert "Sample not available yet" in draws


@pytest.mark.parametrize("entry", FIGURES, ids=lambda entry: entry.name)
def test_every_figure_of_the_literature_says_what_to_see_and_where_it_comes_from(page: Page, entry) -> None:
    text = page("/figures")
    part = next(part for part in text.split("<figure")[1:] if f'id="{entry.name}"' in part)
    assert f'href="#{entry.name}"' in text
    assert f"Fig. {entry.number}</span> {entry.figure.title}" in unescape(part)
    assert f'href="{entry.article.url}"' in part


def test_all_figures_that_were_asked_for_are_there() -> None:
    assert {entry.number for entry in FIGURES} == ASKED_FOR


def test_each_made_picture_of_a_figure_is_one_click_away_from_its_experiment(page: Page) -> None:
    part = next(part for part in page("/figures").split("<figure")[1:] if 'id="sinusoids"' in part)
    links = re.findall(r'<a class="exhibit" href="([^"]+)"', part)
    changes = re.findall(r'href="(/samples/[^"]+)"', part)
    exhibits = next(entry.figure.exhibits for entry in FIGURES if entry.name == "sinusoids")
    assert len(links) == sum(len(exhibit.show) for exhibit in exhibits)
    assert len(changes) == len(exhibits)
    assert "Two sinusoids" in unescape(page(links[0]))


@pytest.mark.parametrize("path", ["/catalogue", "/figures", "/methods"])
def test_pages_need_no_script_and_no_inline_style(page: Page, path: str) -> None:
    text = page(path)
    assert 'style="' not in text
    assert "<script" not in text


def test_an_exhibit_is_public_and_so_is_what_is_run_from_it(gallery: httpx.Client) -> None:
    """It is not in the archive, but nobody hid it: a new seed of it is listed as any other run is."""
    link = re.search(r'href="(/experiments/figure-[0-9a-f]{16})"', gallery.get("/catalogue").text)
    assert link is not None
    page = gallery.get(link[1]).text
    assert "unlisted" not in page
    assert "noindex" not in page
    answer = gallery.post(f"{link[1]}/again", data={"method": "rpn", "seed": "new"})
    assert answer.status_code == 303
    record = gallery.get(f"/api/v1{answer.headers['location']}").json()
    assert record["listed"]
