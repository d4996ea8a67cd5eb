"""What the documents say is what the code does."""

import re
from pathlib import Path

import pytest

from app.gallery.groups import groups
from app.methods.registry import METHODS
from app.settings import ROOT, Settings

README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]
OF_THE_MACHINE = {"workers", "threads", "samples_dir"}  # defaults that differ from machine to machine
ROW = re.compile(r"^\| `MICROTEXTURE_(\w+)` \| (.+?) \| (.+) \|$", re.MULTILINE)


def shown(value: object) -> str:
    """Write a setting's default as the table does."""
    if value is None:
        return "none"
    return f"`{value:g}`" if isinstance(value, float) else f"`{value}`"


@pytest.fixture(scope="module")
def table() -> dict[str, tuple[str, str]]:
    return {name.lower(): (default, meaning) for name, default, meaning in ROW.findall(README)}


@pytest.mark.parametrize("name", Settings.model_fields)
def test_every_setting_stands_in_the_readme_with_its_meaning_and_default(
    table: dict[str, tuple[str, str]], name: str
) -> None:
    field = Settings.model_fields[name]
    default, meaning = table[name]
    assert meaning == field.description
    if name not in OF_THE_MACHINE:
        assert default == shown(field.default)


def test_the_readme_names_no_setting_that_is_not_there(table: dict[str, tuple[str, str]]) -> None:
    served = {"forwarded_allow_ips", "limit_concurrency"}
    assert table.keys() - served <= Settings.model_fields.keys()


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_between_documents_lead_somewhere(document: Path) -> None:
    text = document.read_text(encoding="utf-8")
    for target in re.findall(r"\]\((?!https?:|#)([^)#\s]+)", text):
        assert (document.parent / target).exists(), target


def test_every_make_target_that_the_documents_name_exists() -> None:
    targets = set(re.findall(r"^([a-z0-9-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    for document in DOCUMENTS:
        named = set(re.findall(r"(?:^ {4}|`)make ([a-z0-9-]+)", document.read_text(encoding="utf-8"), re.MULTILINE))
        assert named <= targets, document.name


DECISIONS = sorted((ROOT / "docs" / "decisions").glob("0*.md"))


def test_every_decision_stands_in_the_index_with_its_title_and_date() -> None:
    index = (ROOT / "docs" / "decisions" / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[(\d+)\]\((.+?)\) \| (.+) \| (\d{4}-\d\d-\d\d) \|$", index, re.MULTILINE)
    expected = []
    for number, path in enumerate(DECISIONS, 1):
        text = path.read_text(encoding="utf-8")
        title = re.match(rf"# {number}\. (.+)\n", text)
        date = re.search(r"^Date: (.+)$", text, re.MULTILINE)
        assert title, path.name
        assert date, path.name
        expected.append((str(number), path.name, title[1], date[1]))
    assert rows == expected


@pytest.mark.parametrize("decision", DECISIONS, ids=lambda path: path.stem)
def test_a_decision_tells_its_context_what_was_decided_and_what_follows(decision: Path) -> None:
    headings = re.findall(r"^## (.+)$", decision.read_text(encoding="utf-8"), re.MULTILINE)
    assert headings == ["Context", "Decision", "Consequences"]


def test_the_table_of_the_readme_has_every_method_once() -> None:
    table = re.search(r"^\| method \| what it makes \|\n\|---\|---\|\n((?:\|.*\n)+)", README, re.MULTILINE)
    assert table
    cells = [row.split("|")[1] for row in table[1].splitlines()]
    assert sorted(re.findall(r"`([\w-]+)`", "".join(cells))) == sorted(METHODS)


def test_every_method_stands_in_a_group_of_its_own_choice() -> None:
    """The group “More” takes what was forgotten."""
    assert "More" not in [group.title for group in groups()]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_path_of_the_repository_that_a_document_names_exists(document: Path) -> None:
    text = document.read_text(encoding="utf-8")
    tops = "|".join(("app", "tests", "templates", "static", "samples", "scripts", "benchmarks", "docs", "lint"))
    for path in re.findall(rf"`((?:{tops})/[\w./-]*)`", text):
        if path not in ("app/assets", "tests/acceptance/screenshots"):  # of an installed wheel; left by the tests
            assert (ROOT / path).exists(), path


def test_the_layout_that_the_architecture_draws_is_the_layout() -> None:
    """Every folder of the drawing is there, and every folder of the code is in the drawing."""
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    drawing = re.search(r"## Layout\n\n```\n(.*?)```", text, re.DOTALL)
    assert drawing
    drawn: set[str] = set()
    above: dict[int, str] = {}
    for line in drawing[1].splitlines():
        depth = (len(line) - len(line.lstrip())) // 2
        words = re.match(r"((?:[\w./]+ )*[\w./]+)(?:  |$)", line.lstrip())
        assert words, line
        for word in words[1].split():
            drawn.add("/".join([*(above[level] for level in range(depth)), word.rstrip("/")]))
        above[depth] = words[1].split()[-1].rstrip("/")
    assert [path for path in drawn if not (ROOT / path).exists()] == []
    folders = {path.parent.relative_to(ROOT).as_posix() for path in (ROOT / "app").rglob("*.py")}
    assert folders <= drawn
