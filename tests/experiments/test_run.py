"""A job ends in a record or goes back to the queue; people get a sentence, the operator a log line."""

import errno
import logging
from pathlib import Path
from typing import Any

import pytest

from app.errors import DATABASE, DISK_SPACE, STORAGE, AppError, CancelledError, TimeLimitError, UnavailableError
from app.experiments.model import Experiment, Status
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.experiments.jobs import Breaking, lease_of, left_over, run, run_leased, waits

FULL = OSError(errno.ENOSPC, "No space left on device")
GONE = OSError(errno.EIO, "Input/output error")


def test_a_job_is_recorded_with_what_it_made(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, caplog: pytest.LogCaptureFixture
) -> None:
    run(store, blobs, queued.id)
    made = store.get(queued.id)
    assert (made.status, made.error, made.attempts) == (Status.SUCCEEDED, None, ())
    assert made.outputs[0].name == "texture"
    for output in made.outputs:
        assert blobs.path(output.digest).stat().st_size == output.bytes
    assert left_over(blobs) == []
    assert not waits(store, queued.id)
    assert caplog.records == []


# The method's own failures end it


@pytest.mark.parametrize(
    ("error", "words", "logged"),
    [
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
    run(store, blobs, queued.id)
    failed = store.get(queued.id)
    assert failed.status is Status.FAILED
    assert failed.finished_at is not None
    assert failed.error is not None
    assert words in failed.error
    assert "not for people" not in failed.error
    assert failed.outputs == failed.attempts == ()
    assert left_over(blobs) == []
    assert not waits(store, queued.id)
    assert [(record.levelno, record.message) for record in caplog.records] == (
        [(logging.ERROR, f"job {queued.id} failed")] if logged else []
    )
    if logged:
        assert caplog.records[0].exc_info is not None
        assert caplog.records[0].exc_info[1] is error


# What is away for now ends nothing


@pytest.mark.parametrize("error", [FULL, GONE], ids=["full", "gone"])
@pytest.mark.parametrize("where", ["temporary", "put_file", "path", "lease"])
def test_a_disk_that_fails_anywhere_is_no_failure_of_the_experiment(
    store: SqlStore,
    blobs: FileBlobs,
    queued: Experiment,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    where: str,
    error: OSError,
) -> None:
    """It is raised as what it is, and logged; the same job then runs as if nothing had been."""

    def failing(*_: Any) -> Any:
        raise error

    monkeypatch.setattr(blobs, where, failing)
    lease = lease_of(store, queued.id)
    with pytest.raises(UnavailableError, match=r"room left|for now") as raised:
        run_leased(store, blobs, lease)
    assert raised.value.part == (DISK_SPACE if error is FULL else STORAGE)
    assert str(error.strerror) in caplog.text
    monkeypatch.undo()
    assert left_over(blobs) == []
    assert store.get(queued.id).status is Status.RUNNING
    run_leased(store, blobs, lease)
    assert store.get(queued.id).status is Status.SUCCEEDED


def test_the_second_of_two_pictures_that_finds_the_disk_full_leaves_nothing(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, monkeypatch: pytest.MonkeyPatch
) -> None:
    temporary, count = blobs.temporary, iter(range(9))

    def full(data: bytes) -> Path:
        if next(count):
            raise FULL
        return temporary(data)

    monkeypatch.setattr(blobs, "temporary", full)
    with pytest.raises(UnavailableError, match="no room left"):
        run(store, blobs, queued.id)
    assert left_over(blobs) == []


def test_a_worker_that_does_not_find_the_photograph_sees_other_files(
    store: SqlStore, blobs: FileBlobs, queued: Experiment
) -> None:
    """The database has it: so it is the worker's view that lacks it, not the experiment that is wrong."""
    blobs.path(store.sample(queued.inputs[0].sample).digest).unlink()
    with pytest.raises(UnavailableError, match="does not find the photograph") as raised:
        run(store, blobs, queued.id)
    assert raised.value.part == STORAGE


def test_what_was_computed_waits_for_a_database_that_is_away(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, monkeypatch: pytest.MonkeyPatch
) -> None:
    succeed, refusals = store.succeed, iter(range(3))

    def away(*arguments: Any) -> bool:
        if next(refusals, None) is not None:
            raise UnavailableError(DATABASE, "It is away.")
        return succeed(*arguments)

    monkeypatch.setattr(store, "succeed", away)
    run(store, blobs, queued.id)
    assert store.get(queued.id).status is Status.SUCCEEDED


# What was stopped from outside records nothing


def test_a_cancelled_job_records_nothing_and_leaves_nothing(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, broken: Breaking, caplog: pytest.LogCaptureFixture
) -> None:
    """Whoever cancelled it has recorded that before."""
    broken(CancelledError("The experiment was cancelled."))
    run(store, blobs, queued.id)
    found = store.get(queued.id)
    assert (found.status, found.error, found.outputs) == (Status.RUNNING, None, ())
    assert left_over(blobs) == []
    assert caplog.records == []


@pytest.mark.parametrize("end", ["cancel", "delete", "taken"])
def test_who_has_lost_the_lease_does_not_run(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, broken: Breaking, end: str
) -> None:
    broken(AssertionError("it ran"))
    lease = lease_of(store, queued.id)
    if end == "taken":
        SqlQueue(store.database).release(lease)
        lease_of(store, queued.id)
    else:
        getattr(store, end)(queued.id)
    run_leased(store, blobs, lease)
    if end != "delete":
        assert store.get(queued.id).status is (Status.CANCELLED if end == "cancel" else Status.QUEUED)


@pytest.mark.parametrize("error", [None, ZeroDivisionError()], ids=["success", "failure"])
def test_who_loses_the_lease_while_it_computes_records_nothing(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, monkeypatch: pytest.MonkeyPatch, error: Exception | None
) -> None:
    """Neither success nor failure: another engine has the job."""
    lease, put_file = lease_of(store, queued.id), blobs.put_file

    def taken(path: Path) -> str:
        SqlQueue(store.database).release(lease)
        if error is not None:
            raise error
        return put_file(path)

    monkeypatch.setattr(blobs, "put_file", taken)
    run_leased(store, blobs, lease)
    found = store.get(queued.id)
    assert (found.status, found.outputs, found.error) == (Status.QUEUED, (), None)
    assert waits(store, queued.id)
