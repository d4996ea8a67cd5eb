"""The scaffold of a new method: what it makes passes the tests that all methods pass, in a copy of the checkout."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app.settings import ROOT

pytestmark = pytest.mark.slow

COPIED = ("app", "tests", "benchmarks", "scripts", "docs", "lint", "templates", "static", "samples")
NAME, MODULE, FAMILY = "half-tone", "half_tone", "sampling"
MADE = {
    f"app/synthesis/{FAMILY}/{MODULE}.py",
    f"app/methods/{FAMILY}/{MODULE}.py",
    f"app/methods/explanations/{MODULE}.py",
    f"tests/synthesis/{FAMILY}/test_{MODULE}.py",
    f"tests/methods/{FAMILY}/test_{MODULE}.py",
}
RUN_OVER_ALL = (
    "tests/methods/test_registry.py",
    "tests/methods/test_outputs.py",
    "tests/methods/test_depths.py",
    "tests/methods/test_stages.py",
    "tests/test_docs.py",
    "tests/test_architecture.py",
)
CHANGED = {"app/methods/registry.py", "app/gallery/groups.py", "README.md", "CHANGELOG.md"}


def a_copy(directory: Path) -> Path:
    for name in COPIED:
        shutil.copytree(ROOT / name, directory / name, ignore=shutil.ignore_patterns("__pycache__", "screenshots"))
    for path in ROOT.iterdir():
        if path.is_file():
            shutil.copy(path, directory)
    return directory


def in_copy(copy: Path, *command: str) -> subprocess.CompletedProcess[str]:
    """Run a program of this environment in a copy, whose modules come before those of the checkout."""
    return subprocess.run(
        [sys.executable, *command],
        cwd=copy,
        env=os.environ | {"PYTHONPATH": str(copy)},
        capture_output=True,
        text=True,
        check=False,
    )


def new_method(copy: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return in_copy(copy, "scripts/new_method.py", *arguments)


def contents(directory: Path) -> dict[str, bytes]:
    files = (path for path in directory.rglob("*") if path.is_file() and path.suffix != ".pyc")
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files if ".ruff" not in str(path)}


@pytest.fixture(scope="module")
def scaffolded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy with a new method."""
    copy = a_copy(tmp_path_factory.mktemp("checkout"))
    before = contents(copy)
    done = new_method(copy, NAME, "--family", FAMILY)
    assert done.returncode == 0, done.stderr
    after = contents(copy)
    assert after.keys() - before.keys() == MADE
    assert {name for name in before if before[name] != after[name]} == CHANGED
    assert all(name in done.stdout for name in MADE | CHANGED)
    return copy


def test_the_method_is_there_for_whoever_runs_the_command(scaffolded: Path) -> None:
    program = "from app.cli import main; main()"
    arguments = ("--method", NAME, "--crop", "0,0,64,64", "--size", "96x80", "--colours", "apart")
    photograph = str(ROOT / "samples" / "sand_desert009.png")
    done = in_copy(scaffolded, "-c", program, "synthesize", photograph, "texture.png", *arguments)
    assert done.returncode == 0, done.stderr
    (scaffolded / "texture.png").unlink()


def test_contributing_lists_what_is_made() -> None:
    rows = re.findall(r"^\| (`.+`) \| .+ \| made \|$", (ROOT / "CONTRIBUTING.md").read_text(), re.MULTILINE)
    named = {path for row in rows for path in re.findall("`([^`]+)`", row)}
    assert {path.replace("<family>", FAMILY).replace("<name>", MODULE) for path in named} == MADE | CHANGED


def test_its_files_pass_the_lint(scaffolded: Path) -> None:
    for command in (("check",), ("format", "--check")):
        done = in_copy(scaffolded, "-m", "ruff", *command, ".")
        assert done.returncode == 0, done.stdout


def test_its_types_are_right(scaffolded: Path) -> None:
    files = sorted(MADE)
    done = in_copy(scaffolded, "-m", "mypy", *files)
    assert done.returncode == 0, done.stdout


def test_it_passes_its_own_tests_and_those_that_every_method_passes(scaffolded: Path) -> None:
    """Those of the registry, of what is announced, of the stages, of the documents and of the architecture."""
    selected = in_copy(
        scaffolded,
        *("-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"),
        *(*sorted(MADE), *RUN_OVER_ALL),
        *("-k", f"{MODULE} or {NAME} or test_docs or one_way or each_other"),
    )
    assert selected.returncode == 0, selected.stdout[-5000:]
    assert f"{NAME}" in in_copy(scaffolded, "-c", "from app.gallery.groups import GROUPS; print(GROUPS)").stdout


@pytest.mark.parametrize(
    ("name", "family", "words"),
    [
        ("rpn", "gaussian", "app/synthesis/gaussian/rpn.py already"),
        ("dsn", "sampling", "explanations/dsn.py already"),
        (NAME, FAMILY, "already"),
        ("model", "sampling", "explanations/model.py already"),
        ("class", "sampling", "a word of Python's own"),
        ("match", "sampling", "a word of Python's own"),
        ("sum", "sampling", "a word of Python's own"),
        ("", "sampling", "like my-method"),
        ("Half-Tone", "sampling", "like my-method"),
        ("half_tone", "sampling", "like my-method"),
        ("2-half", "sampling", "like my-method"),
        ("half-", "sampling", "like my-method"),
        ("../half", "sampling", "like my-method"),
        ("half-tone-2", "wavelets", "one of gaussian, pyramid, sampling, patchwork"),
    ],
)
def test_what_cannot_be_a_method_is_refused_in_a_line_and_changes_nothing(
    scaffolded: Path, name: str, family: str, words: str
) -> None:
    before = contents(scaffolded)
    done = new_method(scaffolded, name, "--family", family)
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr.startswith("new-method: ")
    assert done.stderr.count("\n") == 1
    assert words in done.stderr
    assert contents(scaffolded) == before


def test_a_list_that_changed_its_form_is_named_before_anything_is_written(scaffolded: Path, tmp_path: Path) -> None:
    copy = a_copy(tmp_path)
    registry = copy / "app" / "methods" / "registry.py"
    registry.write_text(registry.read_text(encoding="utf-8").replace("METHODS: ", "BY_NAME: "), encoding="utf-8")
    before = contents(copy)
    done = new_method(copy, NAME, "--family", FAMILY)
    assert done.returncode == 1
    assert "app/methods/registry.py is not as expected" in done.stderr
    assert contents(copy) == before


@pytest.mark.parametrize("family", ["gaussian", "pyramid", "patchwork"])
def test_every_family_takes_a_new_method(scaffolded: Path, family: str) -> None:
    """Beside the first one, which has the same parameter."""
    name = f"other-{family}"
    done = new_method(scaffolded, name, "--family", family)
    assert done.returncode == 0, done.stderr
    files = (f"tests/{part}/{family}/test_other_{family}.py" for part in ("synthesis", "methods"))
    passed = in_copy(scaffolded, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *files)
    assert passed.returncode == 0, passed.stdout
    shown = in_copy(scaffolded, "-c", "from app.gallery.groups import groups; print(groups())").stdout
    assert f"'{name}'" in shown
    assert "'More'" not in shown
