"""The mutation test breaks what it says it breaks, and leaves the rest of the file as it was."""

import ast
from pathlib import Path

import pytest

from scripts.mutants.breaks import Mutant, mutants_of

MODULE = '''"""A module."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


def smaller(first: int, second: int = 0) -> bool:
    """Docstrings stay, with their 2 numbers and their < signs."""
    if not first:
        raise ValueError("é < 1")
    report(first, loud=True)
    return first < second + 1
'''


def found(directory: Path, name: str, text: str) -> list[Mutant]:
    (directory / name).write_text(text, encoding="utf-8")
    return mutants_of(directory, name)


def test_a_module_is_broken_in_one_place_at_a_time(tmp_path: Path) -> None:
    mutants = found(tmp_path, "module.py", MODULE)
    assert {(mutant.line, mutant.after) for mutant in mutants} == {
        (9, "(0 + 1)"),
        (11, "False"),
        (11, "(first)"),
        (12, "pass"),
        (13, "pass"),
        (13, "(report(first))"),
        (13, "False"),
        (14, "return None"),
        (14, "(first <= second + 1)"),
        (14, "(second - 1)"),
        (14, "(1 + 1)"),
    }
    for mutant in mutants:
        ast.parse(mutant.text)
        changed = [(a, b) for a, b in zip(MODULE.splitlines(), mutant.text.splitlines(), strict=True) if a != b]
        assert len(changed) == 1
        assert changed[0][0] == MODULE.splitlines()[mutant.line - 1]


@pytest.mark.parametrize("code", ["if (a < b) { grow(); }", "const size = Math.min(a, b);", "return a && b;"])
def test_a_script_is_broken_and_its_comments_are_not(tmp_path: Path, code: str) -> None:
    mutants = found(tmp_path, "script.js", f"// where a < b + 1\n{code}\n")
    assert mutants
    assert {mutant.line for mutant in mutants} == {2}
    assert all(mutant.text.startswith("// where a < b + 1\n") for mutant in mutants)
