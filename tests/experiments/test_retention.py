"""Experiments go by themselves when the settings say so, and not before."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from app.errors import DeletedError
from app.experiments import housekeeping
from app.experiments.files.cache import FileCache
from app.experiments.housekeeping import Housekeeping
from app.experiments.model import Experiment, Sample
from app.experiments.retention import Retention
from app.experiments.steady_clock import SteadyClock
from app.gallery.exhibits import exhibits
from app.settings import Settings
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore
from tests.store.records import a_sample, an_experiment, started

DAY, SECOND = timedelta(days=1), timedelta(seconds=1)
LONG = timedelta(days=90)


@pytest.fixture
def finished(store: SqlStore, blobs: FileBlobs, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Experiment]:
    """Store an experiment that finished some time ago."""
    sample: Sample = a_sample(digest=blobs.put(b"sample"))
    store.add_sample(sample)

    def finish(age: timedelta, **values: Any) -> Experiment:
        experiment = an_experiment(sample, **values)
        store.add(experiment)
        lease = started(store, experiment)
        with monkeypatch.context() as patch:
            patch.setattr("app.store.sql.now", lambda: datetime.now(UTC) - age)
            store.succeed(lease, [], {}, {}, {})
        return store.get(experiment.id)

    return finish


def keeper(tmp_path: Path, store: SqlStore, blobs: FileBlobs, retention: Retention | None) -> Housekeeping:
    cache = FileCache(tmp_path / "cache", 1 << 20)
    return Housekeeping(store, blobs, cache, sample_keep=LONG, longest_run=LONG, retention=retention)


def left(store: SqlStore, made: dict[str, Experiment]) -> set[str]:
    there = set()
    for name, experiment in made.items():
        try:
            store.get(experiment.id)
        except DeletedError:
            continue
        there.add(name)
    return there


@pytest.mark.parametrize(
    ("retention", "stay"),
    [
        (None, {"old", "young", "old unlisted", "young unlisted", "shown"}),
        (Retention(unlisted=30 * DAY), {"old", "young", "young unlisted", "shown"}),
        (Retention(every=30 * DAY), {"young", "young unlisted", "shown"}),
        (Retention(unlisted=10 * DAY, every=30 * DAY), {"young", "shown"}),
    ],
)
def test_what_is_older_than_the_settings_say_goes(
    tmp_path: Path,
    store: SqlStore,
    blobs: FileBlobs,
    finished: Callable[..., Experiment],
    retention: Retention | None,
    stay: set[str],
) -> None:
    """And what a page of the service shows stays, and every page says the day."""
    made = {
        "old": finished(31 * DAY),
        "young": finished(29 * DAY),
        "old unlisted": finished(31 * DAY, listed=False),
        "young unlisted": finished(29 * DAY, listed=False),
        "shown": finished(31 * DAY, id=next(iter(exhibits())), listed=False),
    }
    said = retention or Retention()
    ends = {name: said.end(experiment) for name, experiment in made.items()}
    removed = keeper(tmp_path, store, blobs, retention).prune(None).experiments
    assert left(store, made) == stay
    assert removed == len(made) - len(stay)
    assert {name for name, end in ends.items() if end is None or end > datetime.now(UTC)} == stay


def test_who_prunes_by_hand_names_an_age_of_its_own(
    tmp_path: Path, store: SqlStore, blobs: FileBlobs, finished: Callable[..., Experiment]
) -> None:
    made = {"old": finished(5 * DAY), "young": finished(3 * DAY)}
    keeper(tmp_path, store, blobs, Retention(every=30 * DAY)).prune(4 * DAY)
    assert left(store, made) == {"young"}


def test_one_that_has_not_finished_has_no_end(store: SqlStore) -> None:
    assert Retention(every=DAY).end(an_experiment(a_sample())) is None


def test_the_settings_are_days() -> None:
    assert Retention.by(Settings(keep_unlisted_days=1.5, keep_days=30)) == Retention(1.5 * DAY, 30 * DAY)
    assert Retention.by(Settings()) == Retention(None, None)


@pytest.mark.parametrize("steady", [True, False])
def test_nothing_goes_by_itself_after_the_clock_was_set(
    tmp_path: Path,
    store: SqlStore,
    blobs: FileBlobs,
    finished: Callable[..., Experiment],
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    steady: bool,
) -> None:
    """The hourly round asks whether the clock ran steadily; whoever prunes by hand is believed."""
    made = {"old": finished(31 * DAY)}
    monkeypatch.setattr(housekeeping, "PRUNE_SECONDS", 0.0)
    closing = Event()

    def look(_clock: SteadyClock) -> bool:
        closing.set()
        return steady

    monkeypatch.setattr(SteadyClock, "steady", look)
    keeper(tmp_path, store, blobs, Retention(every=30 * DAY)).keep(closing)
    assert left(store, made) == (set() if steady else {"old"})
    assert ("the clock was set" in caplog.text) is not steady
