"""What every job queue promises: turns, leases, progress, and one record of what became of a job."""

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta

import pytest

from app.experiments.model import ATTEMPTS, Beat, Lease, Sample, Snapshot, Status
from app.store import jobs
from app.store import queue as queue_module
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.leases import ENGINE, leased, order, queued
from tests.store.records import START, an_output

# turns


def test_jobs_of_one_client_go_in_the_order_in_which_they_came(
    store: SqlStore, sample: Sample, queue: SqlQueue
) -> None:
    names = [queued(store, sample) for _ in range(4)]
    assert order(queue) == names
    assert queue.lease(ENGINE, alone=True) is None


def test_clients_take_turns(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    """However many one of them asked for before the others came."""
    ann = [queued(store, sample, "ann") for _ in range(4)]
    bob = [queued(store, sample, "bob") for _ in range(2)]
    cat = queued(store, sample, "cat")
    expected = [ann[0], bob[0], cat, ann[1], bob[1], ann[2], ann[3]]
    states = queue.states([*ann, *bob, cat])
    assert [states[name].position for name in expected] == [1, 2, 3, 4, 5, 6, 7]
    assert order(queue) == expected


def test_what_a_client_has_running_counts_as_its_turns(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    ann = [queued(store, sample, "ann") for _ in range(4)]
    running = [leased(queue).job for _ in range(2)]
    bob = [queued(store, sample, "bob") for _ in range(3)]
    assert running == ann[:2]
    assert order(queue) == [bob[0], bob[1], ann[2], bob[2], ann[3]]


def test_the_position_is_the_turn_that_comes(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    """Whoever leases next gets the job that is said to be first, whatever was cancelled and released meanwhile."""
    names = [queued(store, sample, client) for client in ("ann", "ann", "bob", "ann", "cat", "bob")]
    queue.release(leased(queue))
    queue.cancel(names[2])
    while states := queue.states(names):
        waiting = {name: state.position for name, state in states.items() if state.status is Status.QUEUED}
        assert sorted(position or 0 for position in waiting.values()) == list(range(1, len(waiting) + 1))
        lease = leased(queue)
        assert waiting[lease.job] == 1
        queue.cancel(lease.job)


# leases


def test_a_lease_is_renewed_until_it_is_not_held_any_more(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    name = queued(store, sample)
    lease = leased(queue)
    assert lease.job == name
    assert queue.holds(lease)
    assert queue.leased_by(ENGINE) == [lease]
    assert queue.renew(lease, "texture", 0.5)
    assert queue.release(lease)
    assert not queue.holds(lease)
    assert not queue.renew(lease, "texture", 0.75)
    assert not queue.release(lease)
    assert queue.leased_by(ENGINE) == []


LOSSES: dict[str, Callable[[SqlStore, SqlQueue, Lease], object]] = {
    "cancelled": lambda store, queue, lease: store.cancel(lease.job),
    "cancelled in the queue": lambda store, queue, lease: queue.cancel(lease.job),
    "deleted": lambda store, queue, lease: store.delete(lease.job),
    "released": lambda store, queue, lease: queue.release(lease),
    "lapsed": lambda store, queue, lease: queue.lapse(lease.job, lease.fence, 0),
    "failed": lambda store, queue, lease: store.fail(lease, "too large"),
    "succeeded": lambda store, queue, lease: store.succeed(lease, [an_output()], {}, {}, {}),
    "replaced": lambda store, queue, lease: store.replace(replace(store.get(lease.job), status=Status.QUEUED)),
}


@pytest.mark.parametrize("leased_again", [False, True])
@pytest.mark.parametrize("loss", LOSSES)
def test_who_lost_a_lease_changes_nothing_any_more(
    store: SqlStore, sample: Sample, queue: SqlQueue, loss: str, leased_again: bool
) -> None:
    """Neither the experiment nor the run of whoever leased it after."""
    name = queued(store, sample)
    lease = leased(queue)
    assert store.start(lease) is not None
    LOSSES[loss](store, queue, lease)
    newer = queue.lease("another", alone=True) if leased_again else None

    def everything() -> object:
        record = None if loss == "deleted" else store.get(name)
        return record, queue.states([name]).keys(), queue.beats(), queue.leased_by("another")

    before = everything()
    assert not queue.holds(lease)
    assert not queue.renew(lease, "texture", 0.5)
    assert not queue.release(lease, "It was killed.")
    assert store.start(lease) is None
    assert not store.succeed(lease, [an_output()], {}, {}, {})
    assert not store.fail(lease, "a reason", "It was killed.")
    assert not store.add_output(lease, an_output())
    assert everything() == before
    if newer is not None:
        assert newer.fence != lease.fence
        assert queue.holds(newer)


def test_fencing_numbers_grow_with_every_lease(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    queued(store, sample)
    fences = []
    for _ in range(4):
        lease = leased(queue)
        fences.append(lease.fence)
        queue.release(lease)
    assert fences == [fences[0] + number for number in range(4)]


# the record and the queue agree


def test_what_is_queued_or_runs_has_a_job_and_what_is_finished_has_none(
    store: SqlStore, sample: Sample, queue: SqlQueue
) -> None:
    ends: list[Callable[[Lease], object]] = [
        lambda lease: store.succeed(lease, [an_output()], {}, {}, {}),
        lambda lease: store.fail(lease, "too large"),
        lambda lease: store.cancel(lease.job),
        lambda lease: queue.cancel(lease.job),
        lambda lease: store.delete(lease.job),
    ]
    for end in ends:
        name = queued(store, sample)
        assert queue.states([name])[name] == Snapshot(Status.QUEUED, 1)
        lease = leased(queue)
        assert queue.states([name])[name].status is Status.RUNNING
        started = store.start(lease)
        assert started is not None
        assert started.status is Status.RUNNING
        assert started.started_at is not None
        end(lease)
        assert queue.states([name]) == {}
        assert queue.beats() == []
    assert store.counts() == {"queued": 0, "running": 0, "succeeded": 1, "failed": 1, "cancelled": 2}


def test_an_experiment_that_waits_is_cancelled_with_its_job(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    one, other = queued(store, sample), queued(store, sample)
    assert store.cancel(one)
    assert queue.cancel(other)
    assert not store.cancel(one)
    assert not queue.cancel(other)
    assert {store.get(name).status for name in (one, other)} == {Status.CANCELLED}
    assert queue.waiting() == 0


def test_a_sample_of_a_queued_experiment_is_used(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    """Whether it waits, runs or was put back; once it is deleted, nothing of it is left to hold the sample."""
    name, later = queued(store, sample), START + timedelta(days=1)
    lease = leased(queue)
    assert store.remove_unused_samples(later) == []
    queue.release(lease, "It was killed.")
    assert store.remove_unused_samples(later) == []
    assert store.used([sample.digest]) == {sample.digest}
    store.delete(name)
    assert store.remove_unused_samples(later) == [sample]


def test_what_is_put_back_waits_at_its_old_place(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    names = [queued(store, sample) for _ in range(3)]
    put_back: list[Callable[[Lease], bool]] = [
        queue.release,
        lambda lease: queue.release(lease, "It was killed."),
        lambda lease: queue.lapse(lease.job, lease.fence, queue.beats()[0].beat),
    ]
    for put in put_back:
        lease = leased(queue)
        assert lease.job == names[0]
        assert store.start(lease) is not None
        assert queue.renew(lease, "texture", 0.5)
        assert put(lease)
        found = store.get(names[0])
        assert (found.status, found.started_at) == (Status.QUEUED, None)
        assert queue.states(names)[names[0]] == Snapshot(Status.QUEUED, 1)
    assert order(queue) == names


# attempts


def test_only_what_is_charged_counts(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    """With its moment and its cause, in the record and with the next lease."""
    name = queued(store, sample)
    for _ in range(3):
        lease = leased(queue)
        store.start(lease)
        queue.release(lease)
    assert leased(queue).attempts == store.get(name).attempts == ()
    queue.lapse(name, queue.beats()[0].fence, 0)
    before = jobs.now()
    for cause in ("Its worker was killed by signal 9.", "Sein Prozess „starb“: σ > 2 GiB"):
        queue.release(leased(queue), cause)
    attempts = store.get(name).attempts
    assert [attempt.cause for attempt in attempts] == [
        "Its worker was killed by signal 9.",
        "Sein Prozess „starb“: σ > 2 GiB",
    ]
    assert before <= attempts[0].at <= attempts[1].at <= jobs.now()
    assert leased(queue).attempts == attempts


def test_the_last_attempt_is_leased_to_an_engine_that_runs_nothing_else(
    store: SqlStore, sample: Sample, queue: SqlQueue
) -> None:
    """And nothing overtakes it meanwhile: an engine that is never idle would otherwise never run it."""
    name = queued(store, sample)
    for number in range(ATTEMPTS - 1):
        lease = leased(queue, alone=False)
        assert (len(lease.attempts), lease.last) == (number, False)
        queue.release(lease, "It was killed.")
    queued(store, sample)
    assert queue.lease(ENGINE, alone=False) is None
    lease = leased(queue)
    assert (lease.job, lease.last) == (name, True)
    store.start(lease)
    assert store.fail(lease, "Try a smaller width.", "It was killed.")
    ended = store.get(name)
    assert (ended.status, ended.error, len(ended.attempts)) == (Status.FAILED, "Try a smaller width.", ATTEMPTS)
    assert leased(queue, alone=False).job != name


# heartbeats and progress


def test_the_heartbeat_grows_with_each_renewal(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    queued(store, sample), queued(store, sample)
    lease = leased(queue)
    beats = []
    for _ in range(3):
        beats.append(queue.beats())
        queue.renew(lease, None, 0)
    assert beats == [[Beat(lease.job, lease.fence, number)] for number in range(3)]


def test_a_lease_lapses_only_if_its_heartbeat_stands_still(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    queued(store, sample)
    lease = leased(queue)
    [beat] = queue.beats()
    queue.renew(lease, None, 0)
    assert not queue.lapse(beat.job, beat.fence, beat.beat)
    assert not queue.lapse(beat.job, beat.fence - 1, beat.beat + 1)
    assert not queue.lapse("nothing", beat.fence, beat.beat + 1)
    assert queue.holds(lease)
    assert queue.lapse(beat.job, beat.fence, beat.beat + 1)
    assert not queue.holds(lease)
    assert not queue.lapse(beat.job, beat.fence, beat.beat + 1)


def test_progress_is_seen_by_whoever_asks(
    store: SqlStore, sample: Sample, queue: SqlQueue, monkeypatch: pytest.MonkeyPatch
) -> None:
    name, clock = queued(store, sample), [START]
    monkeypatch.setattr(queue_module, "now", lambda: clock[0])
    lease = leased(queue)
    assert queue.states([name]) == {name: Snapshot(Status.RUNNING)}
    queue.renew(lease, "spot", 0.25)
    clock[0] += timedelta(seconds=3)
    queue.renew(lease, "texture", 0.5)
    assert queue.states([name]) == {name: Snapshot(Status.RUNNING, None, 0.5, "texture", 3.0)}
    clock[0] -= timedelta(days=2)
    assert queue.states([name])[name].elapsed == 0
    assert queue.states([name, "nothing"]).keys() == {name}


def test_states_of_more_jobs_than_one_statement_takes(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    names = [queued(store, sample) for _ in range(3)]
    padding = [f"nothing{number}" for number in range(queue_module.BATCH)]
    assert queue.states([names[0], *padding, *names[1:]]).keys() == set(names)


def test_the_queue_is_counted_by_client(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    for client in ("ann", "ann", "ann", "bob"):
        queued(store, sample, client)
    leased(queue)
    assert (queue.waiting(), queue.waiting_of("ann"), queue.waiting_of("bob"), queue.waiting_of("cat")) == (3, 2, 1, 0)
