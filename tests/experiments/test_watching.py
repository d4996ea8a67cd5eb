"""Snapshots say how far an experiment is, changes are sent once, and whoever waits is woken or gives up."""

import asyncio
import threading
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime, timedelta, tzinfo
from typing import Any, Self

import pytest

from app.errors import NotFoundError
from app.experiments import watching
from app.experiments.model import Experiment, Snapshot, Status
from app.experiments.watching import Watching
from tests.store.records import a_sample, an_experiment

NOW = datetime(2026, 3, 1, 12, tzinfo=UTC)
PATIENCE = 20.0
JOB = "job"
RUNNING = Snapshot(Status.RUNNING, fraction=0.25, stage="spot", elapsed=1.5)
QUEUED = an_experiment(a_sample(), id=JOB, created_at=NOW - timedelta(hours=1))


class Clock(datetime):
    @classmethod
    def now(cls, tz: tzinfo | None = None) -> Self:
        return cls.fromtimestamp(NOW.timestamp(), tz)


class Engine:
    """An executor that knows what it is told, and notes how often it is asked."""

    def __init__(self, *snapshots: Snapshot | None) -> None:
        self.snapshots = list(snapshots)
        self.asked = 0

    def snapshot(self, job: str) -> Snapshot | None:
        assert job == JOB
        self.asked += 1
        return self.snapshots.pop(0) if len(self.snapshots) > 1 else self.snapshots[0]


class Records:
    """A store with one experiment, in the states that follow one another."""

    def __init__(self, *states: Experiment) -> None:
        self.states = list(states)
        self.asked = 0

    def get(self, experiment_id: str) -> Experiment:
        assert experiment_id == JOB
        self.asked += 1
        return self.states.pop(0) if len(self.states) > 1 else self.states[0]


@pytest.fixture
def following(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Watching]:
    """Watch a store and an engine, with pauses of milliseconds."""
    monkeypatch.setattr(watching, "datetime", Clock)
    monkeypatch.setattr(watching, "POLL_SECONDS", 0.002)
    monkeypatch.setattr(watching, "UPDATE_SECONDS", 0.001)

    def follow(records: Any, engine: Any) -> Watching:
        return Watching(records, engine)

    return follow


def ended(status: Status, **values: Any) -> Experiment:
    return replace(QUEUED, status=status, **values)


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
    following: Callable[..., Watching], experiment: Experiment, expected: Snapshot
) -> None:
    assert following(Records(experiment), Engine(None)).snapshot(JOB) == expected


def test_a_snapshot_of_the_engine_goes_before_the_stores(following: Callable[..., Watching]) -> None:
    records = Records(QUEUED)
    assert following(records, Engine(RUNNING)).snapshot(JOB) is RUNNING
    assert records.asked == 0


# Watching


def watched(watch: Watching) -> list[Snapshot]:
    async def collect() -> list[Snapshot]:
        return [snapshot async for snapshot in watch.watch(JOB)]

    return asyncio.run(asyncio.wait_for(collect(), PATIENCE))


SUCCEEDED = ended(Status.SUCCEEDED, started_at=NOW - timedelta(seconds=3), finished_at=NOW)
END = Snapshot(Status.SUCCEEDED, fraction=1.0, elapsed=3.0)


def test_a_state_that_did_not_change_is_not_sent_again(following: Callable[..., Watching]) -> None:
    """The seconds go on all the time, and are no change."""
    waiting = Snapshot(Status.QUEUED, position=2, elapsed=0.0)
    half = replace(RUNNING, fraction=0.5)
    states = [waiting, replace(waiting, elapsed=1.0), RUNNING, replace(RUNNING, elapsed=2.5), half, half, RUNNING, None]
    records = Records(*[ended(Status.RUNNING)] * (len(states) - 2), SUCCEEDED)
    assert watched(following(records, Engine(*states))) == [waiting, RUNNING, half, RUNNING, END]


@pytest.mark.parametrize("change", [{"position": 1}, {"fraction": 0.1}, {"stage": "spot"}, {"status": Status.RUNNING}])
def test_every_change_is_sent(following: Callable[..., Watching], change: dict[str, Any]) -> None:
    first = Snapshot(Status.QUEUED, position=2)
    seen = watched(following(Records(QUEUED, SUCCEEDED), Engine(first, replace(first, **change), None)))
    assert seen == [first, replace(first, **change), END]


def test_watching_ends_with_the_finished_state_and_sends_it_once(following: Callable[..., Watching]) -> None:
    assert watched(following(Records(SUCCEEDED), Engine(None))) == [END]


def test_an_end_that_another_process_brings_about_is_noticed(following: Callable[..., Watching]) -> None:
    """The engine here still has the job; nobody notifies."""
    records = Records(ended(Status.RUNNING), ended(Status.RUNNING), SUCCEEDED)
    assert watched(following(records, Engine(RUNNING))) == [RUNNING, END]


def test_the_end_of_a_deleted_experiment_is_an_error(following: Callable[..., Watching]) -> None:
    class Gone:
        def get(self, experiment_id: str) -> Experiment:
            raise NotFoundError("There is no such experiment.")

    watch = following(Gone(), Engine(RUNNING, None))
    with pytest.raises(NotFoundError, match="There is no such experiment"):
        watched(watch)
    assert watch._listeners == {}


# Waiting


def waited(watch: Watching, seconds: float) -> Experiment:
    return asyncio.run(asyncio.wait_for(watch.wait(JOB, seconds), PATIENCE))


def test_waiting_returns_what_has_finished_at_once(following: Callable[..., Watching]) -> None:
    assert waited(following(Records(SUCCEEDED), Engine(None)), 0) is SUCCEEDED


def test_waiting_returns_what_is_not_finished_when_its_time_is_over(following: Callable[..., Watching]) -> None:
    running = ended(Status.RUNNING)
    assert waited(following(Records(running), Engine(RUNNING)), 0.01) is running


def test_waiting_returns_an_end_that_another_process_brings_about(following: Callable[..., Watching]) -> None:
    records = Records(ended(Status.RUNNING), SUCCEEDED)
    assert waited(following(records, Engine(RUNNING)), float("inf")) is SUCCEEDED


def test_who_waits_is_woken_from_another_thread(
    following: Callable[..., Watching], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not at the next look at the store, which never comes here."""
    monkeypatch.setattr(watching, "POLL_SECONDS", PATIENCE)
    engine = Engine(RUNNING)
    watch = following(Records(SUCCEEDED), engine)

    async def woken() -> Experiment:
        waiting = asyncio.ensure_future(watch.wait(JOB, float("inf")))
        while not engine.asked:
            await asyncio.sleep(0)
        engine.snapshots = [None]
        thread = threading.Thread(target=watch.notify, args=(JOB,))
        thread.start()
        found = await asyncio.wait_for(waiting, PATIENCE / 2)
        thread.join()
        return found

    assert asyncio.run(woken()) is SUCCEEDED
    assert watch._listeners == {}


@pytest.mark.parametrize(
    ("snapshots", "left"), [((RUNNING, RUNNING, None), True), ((None,), True), ((RUNNING,), False)]
)
def test_waiting_for_a_job_to_leave_says_whether_it_did(
    following: Callable[..., Watching], snapshots: tuple[Snapshot | None, ...], left: bool
) -> None:
    watch = following(Records(QUEUED), Engine(*snapshots))
    assert asyncio.run(asyncio.wait_for(watch.wait_until_left(JOB, 0.05), PATIENCE)) is left
    assert watch._listeners == {}


def test_one_whose_event_loop_is_closed_keeps_nobody_from_being_woken(following: Callable[..., Watching]) -> None:
    watch = following(Records(QUEUED), Engine(RUNNING))
    dead, alive = asyncio.new_event_loop(), asyncio.new_event_loop()
    dead.close()
    events = {loop: asyncio.Event() for loop in (dead, alive)}
    watch._listeners[JOB] = set(events.items())
    watch.notify(JOB)
    alive.run_until_complete(asyncio.wait_for(events[alive].wait(), PATIENCE))
    alive.close()


def test_notifying_of_a_job_that_nobody_waits_for_does_nothing(following: Callable[..., Watching]) -> None:
    following(Records(QUEUED), Engine(RUNNING)).notify("another")


@pytest.mark.parametrize("turns", range(8))
def test_who_gives_up_while_the_job_moves_stops_waiting(turns: int) -> None:
    """Whatever the event loop does between the two, the cancellation is not lost."""

    async def given_up() -> bool:
        watch = Watching(Records(QUEUED), Engine(RUNNING))  # type: ignore[arg-type] # as much of them as is asked
        waiting = asyncio.ensure_future(watch.wait(JOB, float("inf")))
        for _ in range(8):
            await asyncio.sleep(0)
        watch.notify(JOB)
        for _ in range(turns):
            await asyncio.sleep(0)
        waiting.cancel()
        await asyncio.wait({waiting}, timeout=20)
        gone = waiting.cancelled()
        waiting.cancel()
        return gone

    assert asyncio.run(given_up())
