"""CITATION.cff is valid and says what the code says of itself and of its literature."""

import subprocess
import sys
import tomllib
from typing import Any

import pytest
import yaml

from app.methods.explanations.model import Reference
from app.methods.explanations.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.settings import ROOT
from app.synthesis import __version__

FILE = ROOT / "CITATION.cff"


@pytest.fixture(scope="module")
def citation() -> dict[str, Any]:
    return dict(yaml.safe_load(FILE.read_text(encoding="utf-8")))


def test_the_citation_has_the_form_of_its_standard() -> None:
    """By the schema of the Citation File Format, version 1.2.0, which the validator brings along."""
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.citation-file-format", str(FILE)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_citation_agrees_with_the_project(citation: dict[str, Any]) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert citation["version"] == __version__
    assert citation["license"] == project["license"]
    assert citation["keywords"] == project["keywords"]


@pytest.mark.parametrize("reference", [RANDOM_PHASE_TEXTURES, IPOL_RPN, PERIODIC_PLUS_SMOOTH], ids=lambda r: r.title)
def test_the_citation_cites_the_articles_as_the_pages_do(citation: dict[str, Any], reference: Reference) -> None:
    doi = reference.url.removeprefix("https://doi.org/")
    (article,) = (article for article in citation["references"] if article["doi"] == doi)
    authors = [
        "-".join(f"{part[0]}." for part in author["given-names"].split("-")) + f" {author['family-names']}"
        for author in article["authors"]
    ]
    assert ", ".join(authors) == reference.authors
    assert article["title"].casefold() == reference.title.casefold()
    assert article["year"] == reference.year
    assert f"{article['start']}--{article['end']}" == reference.pages
    assert reference.venue.startswith(f"{article['journal']} {article['volume']}")


def test_both_wheels_have_the_same_keywords() -> None:
    service, library = (
        tomllib.loads((ROOT / path).read_text(encoding="utf-8"))["project"]
        for path in ("pyproject.toml", "app/synthesis/pyproject.toml")
    )
    assert service["keywords"] == library["keywords"]
