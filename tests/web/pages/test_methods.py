"""The methods' pages: complete for every method, whether its figures are made yet or not."""

import re
from collections.abc import Callable
from html import unescape

import httpx
import pytest

from app.methods.fields import fields
from app.methods.registry import METHODS
from app.web.prose import mathml

Page = Callable[[str], str]
EVERY = pytest.mark.parametrize("name", METHODS)


def test_the_overview_leads_to_every_method(page: Page) -> None:
    text = page("/methods")
    for method in METHODS.values():
        assert f'href="/methods/{method.name}"' in text
        assert method.summary in unescape(text)


@EVERY
def test_a_page_shows_all_that_its_method_declares(page: Page, name: str) -> None:
    method, text = METHODS[name], page(f"/methods/{name}")
    assert text.count('display="block"') == len(method.explanation.formulas)
    assert text.count('<figure class="figure"') == len(method.explanation.figures)
    assert all(figure.title in unescape(text) for figure in method.explanation.figures)
    assert all(f"<code>{entry.name}</code>" in text for entry in fields(method.params))
    assert all(f'href="{reference.url}"' in text for reference in method.references)
    assert all(unescape(reference.bibtex) in unescape(text) for reference in method.references)
    assert "$" not in re.sub(r"<pre.*?</pre>", "", text, flags=re.DOTALL)


@EVERY
def test_a_page_needs_no_script_no_inline_style_and_nothing_from_elsewhere(page: Page, name: str) -> None:
    text = page(f"/methods/{name}")
    assert 'style="' not in text
    assert all("src=" in tag for tag in re.findall(r"<script[^>]*>", text))
    assert not re.findall(r'(?:src|<link[^>]*href)="(?:https?:)?//', text)


@EVERY
def test_a_page_leads_to_the_form_with_its_method_chosen(page: Page, of_gallery: frozenset[str], name: str) -> None:
    """Where the sample of its first figure has not come in yet, to the front page."""
    text = page(f"/methods/{name}")
    address = unescape(re.search(r'<a class="button main" href="([^"]+)">Run it</a>', text)[1])
    first = METHODS[name].explanation.figures[0].exhibits[0]
    if set(dict(first.inputs)) <= of_gallery:
        assert re.search(rf'value="{name}"[^>]* checked', page(address))
    else:
        assert address == "/"


@EVERY
def test_every_formula_converts(name: str) -> None:
    """To one well-formed element, with nothing of the LaTeX left over."""
    for formula in METHODS[name].explanation.formulas:
        text = mathml(formula.latex)
        assert text.startswith('<math display="block"')
        assert text.endswith("</math>")
        assert not re.search(r"\\|\{|\}(?!</mo>)|merror", text.replace('<mo stretchy="false">{</mo>', ""))


@EVERY
def test_its_references_are_a_bibtex_file(gallery: httpx.Client, name: str) -> None:
    """Entries with a unique key, whose braces match and whose fields are all there."""
    answer = gallery.get(f"/methods/{name}.bib")
    assert answer.headers["content-type"].startswith("application/x-bibtex")
    entries = re.findall(r"@(\w+)\{(\w+),\n((?:  \w+ = \{.*\},?\n)+)\}", answer.text)
    assert len({key for _, key, _ in entries}) == len(METHODS[name].references) == answer.text.count("@")
    for kind, _, body in entries:
        assert body.count("{") == body.count("}")
        found = dict(re.findall(r"  (\w+) = \{(.*)\}", body))
        assert {"author", "title", "year", "url", "journal" if kind == "article" else "booktitle"} <= found.keys()


@pytest.mark.parametrize("path", ["/methods/nothing", "/methods/nothing.bib", "/methods/RPN"])
def test_an_unknown_method_is_answered_with_a_page(gallery: httpx.Client, path: str) -> None:
    answer = gallery.get(path)
    assert answer.status_code == 404
    assert "heeger-bergen" in answer.text


def test_the_navigation_marks_where_one_is(page: Page) -> None:
    for path, link in (("/methods/rpn", "/methods"), ("/figures", "/catalogue"), ("/catalogue", "/catalogue")):
        assert re.findall(r'<a href="([^"]+)" aria-current="page"', page(path)) == [link]


@EVERY
def test_the_table_of_parameters_says_what_each_may_be(page: Page, name: str) -> None:
    """A switch is on or off, a choice one of its names, a number within its bounds."""
    table = page(f"/methods/{name}").split('aria-label="Table of parameters"')[1].split("</table>")[0]
    rows = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.DOTALL) for row in table.split("<tr>")[2:]]
    found = {re.sub("<[^>]+>", "", row[1]): (row[2].strip(), unescape(row[3])) for row in rows}
    for entry in fields(METHODS[name].params):
        default, span = found[entry.name]
        if entry.kind == "switch":
            assert (default, span) == ("on" if entry.default else "off", "on, off")
        elif entry.kind == "choice":
            assert span.split(", ") == list(entry.choices)
        elif entry.minimum:
            assert span == f"{entry.minimum} – {entry.maximum}"
