"""What an audit reads in the logs of workers, and that they write it."""

import logging
from collections import Counter
from pathlib import Path

import pytest

from app import worker
from app.experiments.model import Lease
from app.settings import Settings
from tests.chaos.processes import Line
from tests.chaos.runs import double_runs, read_runs


def log(*entries: tuple[float, str]) -> list[Line]:
    return [Line(at, f"2026-01-01T00:00:00Z INFO     job a, lease {words}") for at, words in entries]


def test_runs_one_after_the_other_are_no_double_run() -> None:
    lines = log((1, "3: begun by process 8"), (2, "3: left by process 8"), (3, "4: begun by process 9"))
    counts: Counter[str] = Counter()
    assert double_runs(lines, counts) == []
    assert counts == {"runs": 2, "runs again": 1}


def test_a_lease_that_is_begun_twice_is_a_double_run() -> None:
    lines = log((1, "3: begun by process 8"), (2, "3: begun by process 9"))
    assert len(double_runs(lines, Counter())) == 1


def test_a_run_that_goes_on_beside_the_next_is_a_double_run() -> None:
    begun = log((1, "3: begun by process 8"), (2, "4: begun by process 9"))
    assert len(double_runs([*begun, *log((20, "3: left by process 8"))], Counter())) == 1
    assert double_runs([*begun, *log((3, "3: left by process 8"))], Counter()) == []


def test_a_worker_says_what_an_audit_reads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(worker, "_log_as_the_service", lambda *_arguments: None)
    with caplog.at_level(logging.INFO, "app.worker"):
        worker.run_job(Settings(data_dir=tmp_path), Lease("job", 7))
    runs = read_runs(Line(at, text) for at, text in enumerate(caplog.messages))
    assert [(run.job, run.fence, run.ended) for run in runs] == [("job", 7, 1)]
    worker._store.cache_clear()
