"""The store over SQL: what is removed by its age, to the microsecond, and what a conflict in the middle leaves."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta
from typing import Any

import pytest
import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from app.errors import ConflictError
from app.experiments.model import Sample, Status, deep_job
from app.store import jobs, sql
from app.store.sql import SqlStore
from tests.store.records import START, a_sample, an_experiment, an_output, lease_of, started, succeeded

TICK = timedelta(microseconds=1)
CUT_OFF = pytest.mark.parametrize(
    ("age", "found"), [(-TICK, False), (timedelta(0), False), (TICK, True)], ids=["younger", "as old", "older"]
)


@CUT_OFF
def test_an_unused_upload_is_removed_if_it_is_older(store: SqlStore, age: timedelta, found: bool) -> None:
    sample = a_sample(created_at=START - age)
    store.add_sample(sample)
    assert store.remove_unused_samples(START) == [sample] * found


@CUT_OFF
def test_a_transient_experiment_is_named_if_it_is_older(
    store: SqlStore, sample: Sample, age: timedelta, found: bool
) -> None:
    transient, kept = (an_experiment(sample, transient=each, created_at=START - age) for each in (True, False))
    for experiment in (transient, kept):
        store.add(experiment)
    assert store.transient_before(START) == [transient.id] * found


@CUT_OFF
@pytest.mark.parametrize("end", [Status.SUCCEEDED, Status.FAILED, Status.CANCELLED])
def test_a_finished_experiment_is_named_if_it_is_older(
    store: SqlStore, sample: Sample, monkeypatch: pytest.MonkeyPatch, age: timedelta, found: bool, end: Status
) -> None:
    """Whatever it ended as; one that is not finished is never named."""
    experiment = an_experiment(sample)
    store.add(experiment)
    store.add(an_experiment(sample))
    lease = started(store, experiment)
    monkeypatch.setattr(sql, "now", lambda: START - age)
    ends: dict[Status, Callable[[], bool]] = {
        Status.SUCCEEDED: lambda: store.succeed(lease, [], {}, {}, {}),
        Status.FAILED: lambda: store.fail(lease, "a reason"),
        Status.CANCELLED: lambda: store.cancel(experiment.id),
    }
    assert ends[end]()
    assert store.finished_before(START) == [experiment.id] * found


def test_a_sample_that_becomes_used_meanwhile_stays_and_the_others_go(
    store: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The database refuses to remove it; that keeps no other from being removed."""
    samples = [a_sample() for _ in range(3)]
    for sample in samples:
        store.add_sample(sample)
    order: list[str] = []
    writing = store.database.writing

    @contextmanager
    def conflicting() -> Iterator[sa.Connection]:
        with writing() as connection:
            execute = connection.execute

            def refusing(statement: Any, *arguments: Any) -> Any:
                removed = statement.compile().params["id_1"]
                order.append(removed)
                if len(order) == 1:
                    raise IntegrityError("DELETE FROM samples", {}, Exception("FOREIGN KEY constraint failed"))
                return execute(statement, *arguments)

            monkeypatch.setattr(connection, "execute", refusing)
            yield connection

    monkeypatch.setattr(store.database, "writing", conflicting)
    removed = store.remove_unused_samples(START + TICK)
    monkeypatch.undo()
    assert sorted(order) == sorted(sample.id for sample in samples)
    assert [sample.id for sample in removed] == order[1:]
    assert store.sample(order[0]).id == order[0]


def test_digests_are_looked_up_in_batches_of_which_none_is_lost(store: SqlStore, sample: Sample) -> None:
    experiment = succeeded(store, sample)
    ours = [sample.digest, *(output.digest for output in experiment.outputs)]
    padding = [f"{number:x}" for number in range(sql.BATCH - 2)]
    assert store.used([*ours[:2], *padding, *ours[2:]]) == set(ours)
    assert store.used(padding) == set()


def test_an_output_is_added_after_those_that_are_there(store: SqlStore, sample: Sample) -> None:
    experiment = succeeded(store, sample)
    added = an_output("aaa")
    store.add_output(lease_of(store, deep_job(experiment.id, "aaa")), added)
    assert store.get(experiment.id).outputs == (*experiment.outputs, added)


@pytest.mark.parametrize("end", [SqlStore.cancel, lambda store, name: store.fail(lease_of(store, name), "a reason")])
def test_only_what_succeeded_takes_an_output(store: SqlStore, sample: Sample, end: Callable[..., bool]) -> None:
    experiment = an_experiment(sample)
    store.add(experiment)
    assert end(store, experiment.id)
    with pytest.raises(ConflictError, match="succeeded"):
        store.add_output(lease_of(store, deep_job(experiment.id, "texture")), an_output())
    assert store.get(experiment.id).outputs == ()


def test_moments_are_those_of_the_change(store: SqlStore, sample: Sample, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [START]
    monkeypatch.setattr(sql, "now", lambda: now[0])
    experiment = an_experiment(sample)
    store.add(experiment)
    found = store.get(experiment.id)
    assert (found.started_at, found.finished_at) == (None, None)
    lease = started(store, experiment)
    now[0] = later = START + timedelta(seconds=3)
    store.succeed(lease, [], {}, {}, {})
    found = store.get(experiment.id)
    assert (found.started_at, found.finished_at) == (START, later)


def test_now_is_in_universal_time() -> None:
    assert jobs.now().utcoffset() == timedelta(0)
    assert isinstance(jobs.now(), datetime)
