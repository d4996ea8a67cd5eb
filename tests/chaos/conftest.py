"""Figures of the faults, told after the tests."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.chaos import faults
from tests.chaos.audit import Findings
from tests.chaos.host import Kind
from tests.chaos.ledger import Ledger

ZERO = ("failed", "experiments lost", "stuck", "uploads lost", "bad digests", "other bytes", "ran twice")
DISK_MEGABYTES = 256
FIGURES: list[str] = []


@pytest.fixture
def record_figures(request: pytest.FixtureRequest) -> Callable[[Kind, Ledger, Findings], None]:
    """Keep a row of the table in docs/reliability.md."""

    def record(kind: Kind, ledger: Ledger, found: Findings) -> None:
        suffered = ", ".join(f"{count} × {name}" for name, count in ledger.faults.items())
        counts = found.counts
        row = [
            f"{kind}: {suffered}",
            f"{counts['experiments']}, {counts['uploads']}, {counts['refused']}",
            f"{counts['runs again']} of {counts['runs']}",
            f"{counts['slowest ready again, s']} s",
            *(f"{len(found.faults.get(kind, ()))}" for kind in ZERO),
            ", ".join(f"{words}: {len(those)}" for words, those in found.faults.items() if words not in ZERO and those)
            or "0",
        ]
        FIGURES.append("| " + " | ".join(row) + " |")

    return record


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[None]:
    """A file system of its own for the service's data."""
    data = tmp_path / "data"
    data.mkdir()
    with faults.small_disk(data, DISK_MEGABYTES):
        yield


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if FIGURES:
        heading = ["host and faults", "experiments, uploads, 503s", "run again", "slowest ready again", *ZERO, "other"]
        terminalreporter.section("what was accepted, and what became of it")
        for row in ("| " + " | ".join(heading) + " |", "|" + "---|" * len(heading), *FIGURES):
            terminalreporter.write_line(row)
