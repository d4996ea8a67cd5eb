"""Snapshots say how far an experiment is; changes are told once, by one poll for all who watch."""

import asyncio
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest

from app.errors import DeletedError, NotFoundError
from app.experiments import watching
from app.experiments.model import Experiment, Snapshot, Status
from app.experiments.watching import Watching
from tests.experiments.watched import (
    END,
    JOB,
    NOW,
    PATIENCE,
    QUEUED,
    RUNNING,
    SUCCEEDED,
    WAITING,
    Backend,
    Follow,
    ended,
    run,
)

# Snapshots


@pytest.mark.parametrize(
    ("experiment", "expected"),
    [
        (QUEUED, Snapshot(Status.QUEUED)),
        (
            ended(Status.RUNNING, started_at=NOW - timedelta(seconds=90)),
            Snapshot(Status.RUNNING, fraction=0.0, elapsed=90.0),
        ),
        (
            ended(Status.SUCCEEDED, started_at=NOW - timedelta(seconds=90), finished_at=NOW - timedelta(seconds=60)),
            Snapshot(Status.SUCCEEDED, fraction=1.0, elapsed=30.0),
        ),
        (
            ended(Status.FAILED, started_at=NOW - timedelta(seconds=9), finished_at=NOW - timedelta(seconds=8.5)),
            Snapshot(Status.FAILED, fraction=0.0, elapsed=0.5),
        ),
        (ended(Status.CANCELLED, finished_at=NOW), Snapshot(Status.CANCELLED)),
    ],
    ids=lambda value: value.status if isinstance(value, Experiment) else None,
)
def test_a_snapshot_of_the_store_says_how_far_it_is_and_for_how_long_it_ran(
    follow: Follow, experiment: Experiment, expected: Snapshot
) -> None:
    assert follow(Backend(None, experiment)).snapshot(JOB) == expected


def test_a_snapshot_of_the_queue_goes_before_the_stores(follow: Follow) -> None:
    backend = Backend(RUNNING)
    assert follow(backend).snapshot(JOB) is RUNNING
    assert backend.reads == []


# Watching


async def collected(watch: Watching, steps: Sequence[Callable[[], object]]) -> list[Snapshot | None]:
    """What is yielded, where after each of them the next thing happens."""
    seen = []
    todo = iter(steps)
    async for snapshot in watch.watch(JOB):
        seen.append(snapshot)
        next(todo, lambda: None)()
    return seen


@pytest.mark.parametrize("change", [{"position": 1}, {"fraction": 0.1}, {"stage": "spot"}, {"status": Status.RUNNING}])
def test_every_change_is_told(follow: Follow, change: dict[str, Any]) -> None:
    backend, other = Backend(WAITING), replace(WAITING, **change)
    steps = [lambda: backend.queue.update({JOB: other}), backend.finish]
    assert run(collected(follow(backend), steps)) == [WAITING, other, END]


def test_a_state_that_did_not_change_is_not_told_again(follow: Follow) -> None:
    """The seconds go on all the time, and are no change."""
    backend = Backend(RUNNING)

    async def seen() -> list[Snapshot | None]:
        snapshots = follow(backend).watch(JOB)
        told = [await anext(snapshots)]
        backend.queue[JOB] = replace(RUNNING, elapsed=2.5)
        await backend.looked(4)
        backend.queue[JOB] = half = replace(RUNNING, fraction=0.5)
        told.append(await anext(snapshots))
        assert told[-1] is half
        backend.finish()
        return told + [snapshot async for snapshot in snapshots]

    assert run(seen()) == [RUNNING, replace(RUNNING, fraction=0.5), END]


def test_a_state_that_stays_is_told_again_after_a_while(follow: Follow, monkeypatch: pytest.MonkeyPatch) -> None:
    """A page knows by it that events come through."""
    monkeypatch.setattr(watching, "REPEAT_SECONDS", 0.01)
    backend, later = Backend(RUNNING), replace(RUNNING, elapsed=9.0)
    steps = [lambda: backend.queue.update({JOB: later}), backend.finish]
    assert run(collected(follow(backend), steps)) == [RUNNING, later, END]


def test_watching_ends_with_the_finished_state_and_tells_it_once(follow: Follow) -> None:
    assert run(collected(follow(Backend(None, SUCCEEDED)), [])) == [END]


@pytest.mark.parametrize("error", [NotFoundError("There is none."), DeletedError("It was deleted.")])
def test_the_end_of_a_deleted_experiment_is_an_error(follow: Follow, error: NotFoundError | DeletedError) -> None:
    backend = Backend(RUNNING)
    with pytest.raises(type(error), match=error.message):
        run(collected(follow(backend), [lambda: backend.finish(error)]))


def test_all_who_wait_are_served_by_one_look(follow: Follow) -> None:
    """400 watchers of a job, and one of each of 20 others: a look asks for 21 jobs at once, and reads an end once."""
    others = [f"other-{number}" for number in range(20)]
    backend = Backend(RUNNING)
    backend.queue |= dict.fromkeys(others, WAITING)

    async def told() -> tuple[int, list[Snapshot | None]]:
        watch = follow(backend)
        streams = [watch.watch(job) for job in [JOB] * 400 + others]
        await asyncio.gather(*map(anext, streams))
        while backend.looks[-1] != {JOB, *others}:
            await asyncio.sleep(0.001)
        assert len([thread for thread in threading.enumerate() if thread.name == "watching"]) == 1
        backend.finish()
        ends = await asyncio.gather(*map(anext, streams[:400]))
        reads = len(backend.reads)
        for stream in streams:
            await stream.aclose()
        return reads, ends

    reads, ends = run(told())
    assert reads == 1
    assert ends == [END] * 400
    assert len({id(end) for end in ends}) == 1


def test_who_is_slow_gets_the_newest_state_and_not_all(follow: Follow) -> None:
    backend = Backend(RUNNING)

    async def seen() -> list[Snapshot | None]:
        snapshots = follow(backend).watch(JOB)
        told = [await anext(snapshots)]
        for fraction in (0.3, 0.4, 0.5, 0.6):
            backend.queue[JOB] = replace(RUNNING, fraction=fraction)
            await backend.looked()
        told.append(await anext(snapshots))
        backend.finish()
        return told + [snapshot async for snapshot in snapshots]

    assert run(seen()) == [RUNNING, replace(RUNNING, fraction=0.6), END]


def test_a_notice_tells_another_status_at_once_and_progress_in_turn(
    follow: Follow, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Here its turn never comes: notices alone would send an event for each of hundreds of them."""
    monkeypatch.setattr(watching, "POLL_SECONDS", PATIENCE)
    backend, done = Backend(WAITING), replace(RUNNING, fraction=0.9)

    async def seen() -> list[Snapshot | None]:
        watch = follow(backend)
        snapshots = watch.watch(JOB)
        told = [await anext(snapshots)]
        for state in (replace(WAITING, position=1), RUNNING, done):
            backend.queue[JOB] = state
            looks = len(backend.looks)
            watch.notify(JOB)
            while len(backend.looks) == looks:
                await asyncio.sleep(0.001)
            if state.status is not WAITING.status and len(told) == 1:
                told.append(await anext(snapshots))
        backend.finish()
        watch.notify(JOB)
        told += [snapshot async for snapshot in snapshots]
        monkeypatch.undo()
        return told

    assert run(seen()) == [WAITING, RUNNING, END]


def test_who_comes_while_others_watch_is_told_at_once(follow: Follow, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watching, "POLL_SECONDS", PATIENCE)
    backend = Backend(RUNNING)

    async def told() -> Snapshot | None:
        watch = follow(backend)
        first, second = watch.watch(JOB), watch.watch(JOB)
        await anext(first)
        found = await anext(second)
        for stream in (first, second):
            await stream.aclose()
        return found

    assert run(told()) is RUNNING
    assert backend.looks == [{JOB}]


def test_a_job_that_ended_and_is_made_again_is_looked_at_again(follow: Follow) -> None:
    """Somebody who has not yet heard of its end keeps nobody from seeing what became of it since."""
    backend = Backend(RUNNING)

    async def told() -> Snapshot | None:
        watch = follow(backend)
        slow, quick = watch.watch(JOB), watch.watch(JOB)
        await anext(slow)
        backend.finish()
        assert [snapshot async for snapshot in quick][-1] == END
        backend.queue[JOB] = WAITING
        late = watch.watch(JOB)
        found = await anext(late)
        for stream in (slow, late):
            await stream.aclose()
        return found

    assert run(told()) == WAITING
