"""Every module is tested by a file of its name, or docs/tests.md says by which."""

import re
from functools import cache

import pytest

from app.settings import ROOT

MODULES = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "app").rglob("*.py") if path.stem != "__init__")
ROW = re.compile(r"^\| (`.+`) \| (`.+`) \| .+ \|$", re.MULTILINE)
ROWS = [
    [re.findall(r"`([^`]+)`", cell) for cell in row]
    for row in ROW.findall((ROOT / "docs" / "tests.md").read_text(encoding="utf-8"))
]


def own_test(module: str) -> str:
    directory, _, name = module.removeprefix("app/").rpartition("/")
    return "/".join(part for part in ("tests", directory, f"test_{name}") if part)


@cache
def elsewhere() -> frozenset[str]:
    """Modules that the table names, directly or by their folder."""
    globs = [glob for modules, _ in ROWS for glob in modules]
    return frozenset(path.relative_to(ROOT).as_posix() for glob in globs for path in ROOT.glob(glob))


@pytest.mark.parametrize("module", MODULES)
def test_every_module_has_a_test_of_its_name_or_stands_in_the_table(module: str) -> None:
    assert (ROOT / own_test(module)).exists() or module in elsewhere()


def test_the_table_names_modules_and_tests_that_are_there() -> None:
    for modules, tests in ROWS:
        for glob in modules:
            assert list(ROOT.glob(glob)), glob
        for test in tests:
            assert (ROOT / test).exists(), test
