"""Housekeeping goes on by itself: it prunes every hour, and what fails is logged and tried again."""

import threading
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

import pytest

from app.experiments.files.cache import FileCache
from app.experiments.housekeeping import PRUNE_SECONDS, Housekeeping
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore


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


@pytest.mark.parametrize(("rounds", "times"), [(0, 0), (1, 1), (2, 2)])
def test_it_prunes_every_hour_without_an_age(
    keeper: Housekeeping, monkeypatch: pytest.MonkeyPatch, rounds: int, times: int
) -> None:
    pruned: list[timedelta | None] = []
    monkeypatch.setattr(keeper, "prune", pruned.append)
    closing = Rounds(rounds)
    keeper.keep(closing)
    assert pruned == [None] * times
    assert closing.waits == [PRUNE_SECONDS] * rounds


def test_pruning_that_fails_is_logged_and_tried_again_an_hour_later(
    keeper: Housekeeping, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    ages: list[timedelta | None] = []

    def failing(age: timedelta | None) -> None:
        ages.append(age)
        raise OSError("the disk is gone")

    monkeypatch.setattr(keeper, "prune", failing)
    keeper.keep(Rounds(2))
    assert ages == [None, None]
    assert [record.message for record in caplog.records] == ["housekeeping failed; it will be tried again"] * 2
    assert "the disk is gone" in caplog.text
