"""A job ends in a record whatever goes wrong: people get a sentence, the operator a log line, the disk is clean."""

import errno
import logging
from pathlib import Path
from typing import Any

import pytest

from app.errors import AppError, CancelledError, TimeLimitError
from app.experiments.model import Experiment, Status
from app.experiments.run import MAX_ATTEMPTS, run_job
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore
from tests.experiments.jobs import Breaking, left_over, silent

FULL = OSError(errno.ENOSPC, "No space left on device")


def test_a_job_is_recorded_with_what_it_made(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, caplog: pytest.LogCaptureFixture
) -> None:
    run_job(store, blobs, queued.id, silent, threads=1)
    made = store.get(queued.id)
    assert (made.status, made.error, len(made.attempts)) == (Status.SUCCEEDED, None, 1)
    assert made.outputs[0].name == "texture"
    for output in made.outputs:
        assert blobs.path(output.digest).stat().st_size == output.bytes
    assert left_over(blobs) == []
    assert caplog.records == []


# What goes wrong


@pytest.mark.parametrize(
    ("error", "words", "logged"),
    [
        (FULL, "could not read or write its files. Its operator finds the reason in the log", True),
        (ZeroDivisionError("not for people"), "Something went wrong inside the method", True),
        (RuntimeError("not for people"), "This is a fault of the service, not yours", True),
        (MemoryError(), "Try a smaller width and height: there was not enough memory", False),
        (AppError("The stars are against it."), "The stars are against it.", False),
        (TimeLimitError("This run took longer than 3 seconds."), "took longer than 3 seconds", False),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, Exception) else None,
)
def test_a_fault_is_recorded_in_words_and_logged_where_people_cannot_mend_it(
    store: SqlStore,
    blobs: FileBlobs,
    queued: Experiment,
    broken: Breaking,
    caplog: pytest.LogCaptureFixture,
    error: Exception,
    words: str,
    logged: bool,
) -> None:
    broken(error)
    run_job(store, blobs, queued.id, silent, threads=1)
    failed = store.get(queued.id)
    assert failed.status is Status.FAILED
    assert failed.finished_at is not None
    assert failed.error is not None
    assert words in failed.error
    assert "not for people" not in failed.error
    assert failed.outputs == ()
    assert left_over(blobs) == []
    assert [(record.levelno, record.message) for record in caplog.records] == (
        [(logging.ERROR, f"job {queued.id} failed")] if logged else []
    )
    if logged:
        assert caplog.records[0].exc_info is not None
        assert caplog.records[0].exc_info[1] is error


@pytest.mark.parametrize("where", ["temporary", "put_file", "path", "lease"])
def test_a_disk_that_fails_anywhere_fails_the_experiment_and_is_logged(
    store: SqlStore,
    blobs: FileBlobs,
    queued: Experiment,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    where: str,
) -> None:
    """Else it would stay "running" for ever."""

    def full(*_: Any) -> Any:
        raise FULL

    monkeypatch.setattr(blobs, where, full)
    run_job(store, blobs, queued.id, silent, threads=1)
    failed = store.get(queued.id)
    assert failed.status is Status.FAILED
    assert "operator finds the reason in the log" in (failed.error or "")
    assert "No space left on device" in caplog.text
    monkeypatch.undo()
    assert left_over(blobs) == []


def test_the_second_of_two_pictures_that_finds_the_disk_full_leaves_nothing(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, monkeypatch: pytest.MonkeyPatch
) -> None:
    temporary, count = blobs.temporary, iter(range(9))

    def full(data: bytes) -> Path:
        if next(count):
            raise FULL
        return temporary(data)

    monkeypatch.setattr(blobs, "temporary", full)
    run_job(store, blobs, queued.id, silent, threads=1)
    assert store.get(queued.id).status is Status.FAILED
    assert left_over(blobs) == []


def test_a_cancelled_job_records_nothing_and_leaves_nothing(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, broken: Breaking, caplog: pytest.LogCaptureFixture
) -> None:
    """Whoever cancelled it has recorded that before."""
    broken(CancelledError("The experiment was cancelled."))
    run_job(store, blobs, queued.id, silent, threads=1)
    found = store.get(queued.id)
    assert (found.status, found.error, found.outputs) == (Status.RUNNING, None, ())
    assert left_over(blobs) == []
    assert caplog.records == []


@pytest.mark.parametrize("end", ["cancel", "delete"])
def test_what_was_ended_before_is_not_run(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, broken: Breaking, end: str
) -> None:
    broken(AssertionError("it ran"))
    getattr(store, end)(queued.id)
    run_job(store, blobs, queued.id, silent, threads=1)
    if end == "cancel":
        assert store.get(queued.id).status is Status.CANCELLED


@pytest.mark.parametrize("earlier", [MAX_ATTEMPTS - 1, MAX_ATTEMPTS])
def test_an_experiment_that_ends_its_worker_again_and_again_fails(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, earlier: int
) -> None:
    """It is begun as often as is allowed, and once more to be told why it is not."""
    for _ in range(earlier):
        store.start(queued.id)
    run_job(store, blobs, queued.id, silent, threads=1)
    ended = store.get(queued.id)
    assert len(ended.attempts) == earlier + 1
    if earlier < MAX_ATTEMPTS:
        assert ended.status is Status.SUCCEEDED
    else:
        assert ended.status is Status.FAILED
        assert "ended its worker again and again" in (ended.error or "")
