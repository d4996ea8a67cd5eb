"""Housekeeping goes on by itself: it prunes every hour, and what fails is logged and tried again."""

import logging
import threading
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

import pytest
from sqlalchemy.exc import OperationalError

from app.experiments.files.cache import FileCache
from app.experiments.housekeeping import PRUNE_SECONDS, RECORD_SECONDS, Housekeeping
from app.experiments.model import Status
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore
from tests.experiments.jobs import submit

ROUNDS = int(PRUNE_SECONDS / RECORD_SECONDS)  # of the loop from one pruning to the next


@pytest.fixture
def keeper(tmp_path: Path, store: SqlStore, blobs: FileBlobs) -> Housekeeping:
    cache = FileCache(tmp_path / "cache", 1 << 20)
    return Housekeeping(store, blobs, cache, sample_keep=timedelta(hours=24), longest_run=timedelta(hours=1))


class Rounds(threading.Event):
    """Closes after so many waits, and notes how long each was to be."""

    def __init__(self, count: int, between: Callable[[int], None] = lambda number: None) -> None:
        super().__init__()
        self.count = count
        self.between = between
        self.waits: list[float | None] = []

    def wait(self, timeout: float | None = None) -> bool:
        if len(self.waits) == self.count:
            return True
        self.waits.append(timeout)
        self.between(len(self.waits))
        return False


@pytest.mark.parametrize(("rounds", "times"), [(ROUNDS - 1, 0), (ROUNDS, 1), (2 * ROUNDS - 1, 1), (2 * ROUNDS, 2)])
def test_it_prunes_every_hour_without_an_age(
    keeper: Housekeeping, monkeypatch: pytest.MonkeyPatch, rounds: int, times: int
) -> None:
    pruned: list[timedelta | None] = []
    monkeypatch.setattr(keeper, "prune", pruned.append)
    closing = Rounds(rounds)
    keeper.keep(closing)
    assert pruned == [None] * times
    assert set(closing.waits) == {RECORD_SECONDS}


def test_pruning_that_fails_is_logged_and_tried_again_an_hour_later(
    keeper: Housekeeping, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    ages: list[timedelta | None] = []

    def failing(age: timedelta | None) -> None:
        ages.append(age)
        raise OSError("the disk is gone")

    monkeypatch.setattr(keeper, "prune", failing)
    keeper.keep(Rounds(2 * ROUNDS))
    assert ages == [None, None]
    assert [record.message for record in caplog.records] == ["housekeeping failed; it will be tried again"] * 2
    assert "the disk is gone" in caplog.text


def outage() -> OperationalError:
    return OperationalError("UPDATE experiments …", {}, Exception("database is locked"))


def test_a_failure_that_the_database_does_not_take_is_logged_and_recorded_once_it_does(
    keeper: Housekeeping,
    store: SqlStore,
    blobs: FileBlobs,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The first attempt is the engine's; two more of the loop fail, the third is taken, and that is the last one."""
    lost, other = (submit(store, blobs) for _ in range(2))
    for experiment in (lost, other):
        store.start(experiment.id)
    offered: list[str] = []
    fail = store.fail

    def taking(experiment_id: str, error: str) -> bool:
        offered.append(experiment_id)
        if len(offered) <= 4:
            raise outage()
        return fail(experiment_id, error)

    monkeypatch.setattr(store, "fail", taking)
    with caplog.at_level(logging.ERROR):
        keeper.record_failure(lost.id, "Its worker was lost.")
        keeper.record_failure(other.id, "It took too long.")
    words = "the failure of experiment {} could not be recorded; it will be tried again"
    assert [record.message for record in caplog.records] == [words.format(each.id) for each in (lost, other)]
    assert all(record.exc_info for record in caplog.records)
    assert store.get(lost.id).status is Status.RUNNING

    keeper.keep(Rounds(4))
    assert [record.message for record in caplog.records[2:]] == ["housekeeping failed; it will be tried again"] * 2
    assert (store.get(lost.id).status, store.get(lost.id).error) == (Status.FAILED, "Its worker was lost.")
    assert (store.get(other.id).status, store.get(other.id).error) == (Status.FAILED, "It took too long.")
    assert offered == [lost.id, other.id, lost.id, lost.id, lost.id, other.id]


def test_a_failure_that_the_database_takes_is_recorded_at_once_and_not_again(
    keeper: Housekeeping, store: SqlStore, blobs: FileBlobs, caplog: pytest.LogCaptureFixture
) -> None:
    experiment = submit(store, blobs)
    keeper.record_failure(experiment.id, "Its worker was lost.")
    recorded = store.get(experiment.id)
    assert (recorded.status, recorded.error) == (Status.FAILED, "Its worker was lost.")
    keeper.keep(Rounds(2))
    assert store.get(experiment.id) == recorded
    assert caplog.records == []
