"""Every promise of SECURITY.md names tests that are there."""

import ast
import re

import pytest

from app.settings import ROOT

TEXT = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
NAMED = sorted(set(re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", TEXT)))
ROWS = re.findall(r"^\| (?!promise|---)(.+) \| (.+) \|$", TEXT, re.MULTILINE)


def functions_of(path: str) -> set[str]:
    """The names of the functions of a file, also within classes."""
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


@pytest.mark.parametrize(("path", "name"), NAMED)
def test_a_named_test_exists(path: str, name: str) -> None:
    assert name in functions_of(path)


def test_every_promise_names_a_test() -> None:
    assert len(ROWS) > 15
    for promise, tests in ROWS:
        assert re.findall(r"`tests/[\w/]+\.py::test_\w+`", tests), promise


def test_the_documents_lead_to_it() -> None:
    for name in ("README.md", "docs/operations.md"):
        assert "SECURITY.md" in (ROOT / name).read_text(encoding="utf-8")
