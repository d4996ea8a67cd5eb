"""What the job queue promises of outputs at 16 bits: computed once, kept by their lease, their failure told."""

from datetime import timedelta

import pytest

from app.experiments.model import Experiment, Sample, deep_job
from app.store import queue as queue_module
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.leases import ENGINE, leased, order, queued
from tests.store.records import START, an_output, succeeded


@pytest.fixture
def made(store: SqlStore, sample: Sample) -> Experiment:
    return succeeded(store, sample)


def test_an_output_at_16_bits_is_a_job_that_is_queued_once(queue: SqlQueue, made: Experiment) -> None:
    job = deep_job(made.id, "texture")
    for client in ("ann", "bob"):
        queue.enqueue(job, client)
        assert (queue.waiting(), queue.waiting_of("ann")) == (1, 1)
    lease = leased(queue)
    queue.enqueue(job, "bob")
    assert queue.holds(lease)
    assert queue.waiting() == 0


def test_an_output_is_recorded_by_its_lease(store: SqlStore, queue: SqlQueue, made: Experiment) -> None:
    queue.enqueue(deep_job(made.id, "texture"), "ann")
    lease, output = leased(queue), an_output(".texture-16")
    assert store.add_output(lease, output)
    assert queue.finish(lease)
    assert store.get(made.id).outputs == (*made.outputs, output)
    assert not store.add_output(lease, an_output(".texture-16"))
    assert not queue.finish(lease)
    assert store.get(made.id).outputs == (*made.outputs, output)


def test_a_failure_is_told_until_the_job_is_asked_for_again(queue: SqlQueue, made: Experiment) -> None:
    job = deep_job(made.id, "texture")
    queue.enqueue(job, "ann")
    assert queue.failure(job) is None
    lease = leased(queue)
    queue.renew(lease, "texture", 0.5)
    assert queue.finish(lease, "Try later.")
    assert not queue.finish(lease, "Try later.")
    assert queue.failure(job) == "Try later."
    assert (queue.waiting(), queue.states([job]), queue.beats(), queue.lease(ENGINE, alone=True)) == (0, {}, [], None)
    assert not queue.cancel(job)
    queue.enqueue(job, "ann")
    assert queue.failure(job) is None
    assert leased(queue).job == job
    assert not queue.holds(lease)


def test_a_failure_is_forgotten_after_an_hour(
    store: SqlStore, queue: SqlQueue, made: Experiment, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = (deep_job(made.id, name) for name in ("texture", "crop"))
    clock = [START]
    monkeypatch.setattr(queue_module, "now", lambda: clock[0])
    queue.enqueue(one, "ann")
    queue.finish(leased(queue), "Try later.")
    clock[0] += timedelta(minutes=59)
    assert queue.failure(one) == "Try later."
    clock[0] += timedelta(minutes=2)
    assert queue.failure(one) is None
    queue.enqueue(other, "ann")
    queue.finish(leased(queue), "Try later.")
    with store.database.reading() as connection:
        assert connection.exec_driver_sql("SELECT id FROM jobs").scalars().all() == [other]


def test_an_experiment_does_not_end_without_a_record(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    queued(store, sample)
    with pytest.raises(ValueError, match="its store records its end"):
        queue.finish(leased(queue))


def test_jobs_of_a_deleted_experiment_are_gone_and_those_of_others_stay(
    store: SqlStore, sample: Sample, queue: SqlQueue
) -> None:
    """Whatever characters its name has: those of a pattern stand for themselves."""
    one, other = (succeeded(store, sample, id=name) for name in ("a_c", "abc"))
    for experiment in (one, other):
        queue.enqueue(deep_job(experiment.id, "texture"), "ann")
    store.delete(one.id)
    assert order(queue) == [deep_job(other.id, "texture")]
