"""Housekeeping removes what is old and unused, to the second, and no more."""

import os
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path
from typing import Any, Self

import pytest

from app.errors import DeletedError, NotFoundError
from app.experiments import housekeeping
from app.experiments.files.cache import FileCache
from app.experiments.housekeeping import Housekeeping, Pruned
from app.experiments.model import Experiment, Output, Sample, Status
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore
from tests.experiments.jobs import lease_of
from tests.store.records import a_sample, an_experiment, an_output

NOW = datetime(2026, 3, 1, 12, tzinfo=UTC)
SAMPLE_KEEP, LONGEST_RUN, OLDER_THAN = timedelta(hours=24), timedelta(hours=1), timedelta(days=30)
SECOND = timedelta(seconds=1)
CUT_OFF = pytest.mark.parametrize(
    ("age", "goes"),
    [(-SECOND, False), (timedelta(0), False), (SECOND, True)],
    ids=["a second younger", "as old", "a second older"],
)


class Clock(datetime):
    @classmethod
    def now(cls, tz: tzinfo | None = None) -> Self:
        return cls.fromtimestamp(NOW.timestamp(), tz)


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(housekeeping, "datetime", Clock)


@pytest.fixture
def keeper(tmp_path: Path, store: SqlStore, blobs: FileBlobs) -> Housekeeping:
    cache = FileCache(tmp_path / "cache", 1 << 20)
    return Housekeeping(store, blobs, cache, sample_keep=SAMPLE_KEEP, longest_run=LONGEST_RUN)


@pytest.fixture
def a_kept_sample(store: SqlStore, blobs: FileBlobs) -> Callable[..., Sample]:
    """Store a sample with its file."""

    def keep(**values: Any) -> Sample:
        sample = a_sample(created_at=NOW, **values)
        sample = replace(sample, digest=blobs.put(sample.id.encode()))
        store.add_sample(sample)
        return sample

    return keep


@pytest.fixture
def finished(store: SqlStore, blobs: FileBlobs, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Experiment]:
    """Store an experiment that succeeded at a moment, with the file of its texture."""

    def finish(sample: Sample, at: datetime, **values: Any) -> Experiment:
        experiment = an_experiment(sample, **values)
        store.add(experiment)
        lease = lease_of(store, experiment.id)
        store.start(lease)
        texture = an_output(digest=blobs.put(experiment.id.encode()))
        monkeypatch.setattr("app.store.sql.now", lambda: at)
        assert store.succeed(lease, [texture], {}, {}, {})
        return store.get(experiment.id)

    return finish


def has_file(blobs: FileBlobs, record: Sample | Output) -> bool:
    return record.digest in blobs.digests()


def is_there(store: SqlStore, experiment: Experiment) -> bool:
    try:
        store.get(experiment.id)
    except (DeletedError, NotFoundError):
        return False
    return True


# What goes by its age


@CUT_OFF
def test_an_upload_without_an_experiment_goes_once_it_is_older_than_it_is_kept(
    keeper: Housekeeping, store: SqlStore, blobs: FileBlobs, age: timedelta, goes: bool
) -> None:
    sample = a_sample(created_at=NOW - SAMPLE_KEEP - age, digest=blobs.put(b"upload"))
    store.add_sample(sample)
    assert keeper.prune(None) == Pruned(0, int(goes), int(goes))
    assert has_file(blobs, sample) is not goes
    assert len(store.remove_unused_samples(NOW + SECOND)) == (not goes)


@CUT_OFF
def test_a_transient_experiment_goes_once_no_run_takes_as_long(
    keeper: Housekeeping, store: SqlStore, a_kept_sample: Callable[..., Sample], age: timedelta, goes: bool
) -> None:
    """What `/synthesize` still runs is left alone; what a killed process left behind is not."""
    experiment = an_experiment(a_kept_sample(), transient=True, created_at=NOW - LONGEST_RUN - age)
    store.add(experiment)
    assert keeper.prune(None).experiments == goes
    assert is_there(store, experiment) is not goes


@CUT_OFF
def test_a_temporary_file_goes_once_no_run_takes_as_long(
    keeper: Housekeeping, blobs: FileBlobs, age: timedelta, goes: bool
) -> None:
    path = blobs.temporary(b"half")
    modified = (NOW - LONGEST_RUN - age).timestamp()
    os.utime(path, (modified, modified))
    assert keeper.prune(None).files == goes
    assert path.exists() is not goes


@CUT_OFF
def test_a_finished_experiment_goes_once_it_is_older_than_asked(
    keeper: Housekeeping,
    store: SqlStore,
    blobs: FileBlobs,
    a_kept_sample: Callable[..., Sample],
    finished: Callable[..., Experiment],
    age: timedelta,
    goes: bool,
) -> None:
    experiment = finished(a_kept_sample(), NOW - OLDER_THAN - age)
    assert keeper.prune(OLDER_THAN).experiments == goes
    assert is_there(store, experiment) is not goes
    assert has_file(blobs, experiment.outputs[0]) is not goes


def test_finished_experiments_stay_unless_an_age_is_asked_for(
    keeper: Housekeeping, store: SqlStore, a_kept_sample: Callable[..., Sample], finished: Callable[..., Experiment]
) -> None:
    experiment = finished(a_kept_sample(), NOW - 1000 * OLDER_THAN)
    assert keeper.prune(None) == Pruned(0, 0, 0)
    assert is_there(store, experiment)


@pytest.mark.parametrize("status", [Status.QUEUED, Status.RUNNING])
def test_an_unfinished_experiment_stays_however_old_it_is(
    keeper: Housekeeping, store: SqlStore, a_kept_sample: Callable[..., Sample], status: Status
) -> None:
    experiment = an_experiment(a_kept_sample(), created_at=NOW - 1000 * OLDER_THAN)
    store.add(experiment)
    if status is Status.RUNNING:
        store.start(lease_of(store, experiment.id))
    assert keeper.prune(timedelta(0)) == Pruned(0, 0, 0)
    assert store.get(experiment.id).status is status


def test_bundled_samples_and_those_of_experiments_stay_however_old_they_are(
    keeper: Housekeeping, store: SqlStore, blobs: FileBlobs
) -> None:
    ancient = {"created_at": NOW - 1000 * SAMPLE_KEEP}
    bundled = a_sample(title="Sand", bundled=True, digest=blobs.put(b"bundled"), **ancient)
    used = a_sample(digest=blobs.put(b"used"), **ancient)
    for sample in (bundled, used):
        store.add_sample(sample)
    store.add(an_experiment(used))
    assert keeper.prune(None) == Pruned(0, 0, 0)
    assert has_file(blobs, bundled)
    assert has_file(blobs, used)


# What else refers to a file


@pytest.mark.parametrize("count", [1, housekeeping.BATCH, housekeeping.BATCH + 1])
def test_a_file_that_nothing_refers_to_goes_whatever_its_place_among_the_others(
    keeper: Housekeeping, store: SqlStore, blobs: FileBlobs, monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    """Files are looked at in batches: neither one that is used nor one that is not is forgotten at their borders."""
    strays = {blobs.put(f"stray {number}".encode()) for number in range(3)}
    used = a_sample(created_at=NOW, digest=blobs.put(b"used"))
    store.add_sample(used)
    padding = [f"{number:064x}" for number in range(count - 2)]
    every = [*sorted(strays)[:1], *padding, used.digest, *sorted(strays)[1:]]
    monkeypatch.setattr(blobs, "digests", lambda: every)
    assert keeper.prune(None).files == 3
    monkeypatch.undo()
    assert blobs.digests() == [used.digest]


def test_a_file_that_goes_takes_its_renditions_along(
    keeper: Housekeeping, store: SqlStore, blobs: FileBlobs, tmp_path: Path
) -> None:
    digest = blobs.put(b"stray")
    keeper._cache.get(f"{digest}-256.jpeg", lambda: b"small")
    other = keeper._cache.get("other-256.jpeg", lambda: b"small")
    keeper.prune(None)
    assert list((tmp_path / "cache").iterdir()) == [other]


def test_one_that_its_owner_deletes_meanwhile_keeps_no_other_from_going(
    keeper: Housekeeping,
    store: SqlStore,
    a_kept_sample: Callable[..., Sample],
    finished: Callable[..., Experiment],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sample = a_kept_sample()
    made = [finished(sample, NOW - OLDER_THAN - SECOND) for _ in range(3)]
    unknown = "never heard of"
    store.delete(made[0].id)
    monkeypatch.setattr(store, "finished_before", lambda moment: [made[0].id, unknown, made[1].id, made[2].id])
    assert keeper.prune(OLDER_THAN).experiments == 2
    assert not any(is_there(store, each) for each in made)
