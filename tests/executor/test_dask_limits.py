"""Limits of the Dask executor, on the test's clock: what takes too long or was cancelled is stopped, and only that."""

from collections.abc import Iterator

import pytest

from app.executor import dask
from app.executor.dask import GRACE_SECONDS, SILENCE_SECONDS
from app.executor.dispatched import Dispatched
from app.experiments.model import Snapshot, Status
from tests.executor.fake_engine import LIMIT, WORKER, Bench, dispatching


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    with dispatching(monkeypatch) as bench:
        yield bench


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(dask, "time", clock)
    return clock


@pytest.fixture
def sent(bench: Bench, clock: Clock) -> Dispatched:
    """A job on the worker; the dispatcher's thread is not running."""
    executor = bench.executor
    executor._open = True
    executor.submit("a")
    executor._keep_engine()
    executor._fill()
    return executor._runs["a"]


@pytest.mark.parametrize(("more", "killed"), [(-0.01, False), (0.0, False), (0.01, True)])
@pytest.mark.parametrize("began", [True, False])
def test_a_job_that_takes_too_long_is_killed_with_its_worker(
    bench: Bench, clock: Clock, sent: Dispatched, began: bool, more: float, killed: bool
) -> None:
    """Its time begins when the worker says so; one that says nothing is given as long as a start may take."""
    engine = bench.engines[0]
    clock.now += 7
    if began:
        bench.executor._on_progress({"job": "a", "worker": WORKER})
    clock.now += LIMIT + GRACE_SECONDS + more + (0 if began else SILENCE_SECONDS - 7)
    bench.executor._keep_limits()
    assert sent.out_of_time is killed
    assert engine.times("kill") == [WORKER] * killed
    assert engine.times("forget") == ["a"] * killed
    bench.executor._keep_limits()
    assert engine.times("kill") == [WORKER] * killed  # once only


@pytest.mark.parametrize(("after", "killed"), [(GRACE_SECONDS - 0.01, False), (GRACE_SECONDS + 0.01, True)])
def test_a_cancelled_job_is_asked_politely_once_and_then_killed(
    bench: Bench, clock: Clock, sent: Dispatched, after: float, killed: bool
) -> None:
    engine = bench.engines[0]
    bench.executor.cancel("a")
    bench.executor._keep_limits()
    clock.now += after
    bench.executor._keep_limits()
    assert engine.times("stop") == ["a"]
    assert engine.times("kill") == [WORKER] * killed
    assert not sent.out_of_time


def test_a_worker_that_was_killed_is_given_nothing_until_it_is_gone(
    bench: Bench, clock: Clock, sent: Dispatched
) -> None:
    engine, executor = bench.engines[0], bench.executor
    executor.cancel("a")
    clock.now += GRACE_SECONDS + 1
    executor._keep_limits()
    executor._leave(sent)
    executor.submit("b")
    executor._fill()
    assert "b" not in engine.tasks
    engine.threads = {"tcp://another": 1}
    clock.now += 1
    executor._fill()
    assert "b" in engine.tasks


def test_the_workers_of_an_engine_are_asked_for_at_once_when_they_may_have_changed(
    bench: Bench, clock: Clock, sent: Dispatched, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When Dask says that one came or went, and when the engine is another one; else once in a while."""
    monkeypatch.setattr(dask, "WORKERS_SECONDS", 5.0)
    executor, (first, second) = bench.executor, bench.engines
    for wait, times in ((4.9, 1), (0.1, 1), (0.1, 2)):
        clock.now += wait
        executor._fill()
        assert len(first.times("workers")) == times
    executor._on_workers()
    executor._fill()
    assert len(first.times("workers")) == 3
    first.alive = False
    executor._keep_engine()
    executor._fill()
    assert len(second.times("workers")) == 1
    assert executor.ready


def test_a_snapshot_has_what_the_worker_reported_and_the_seconds_since_it_began(
    bench: Bench, clock: Clock, sent: Dispatched
) -> None:
    executor = bench.executor
    clock.now += 3
    assert executor.snapshot("a") == Snapshot(Status.RUNNING, elapsed=3.0)
    executor._on_progress({"job": "a", "worker": WORKER})
    clock.now += 2
    executor._on_progress({"job": "a", "worker": WORKER, "stage": "spot", "fraction": 0.25})
    clock.now += 2.5
    assert executor.snapshot("a") == Snapshot(Status.RUNNING, fraction=0.25, stage="spot", elapsed=4.5)
    executor._on_progress({"job": "of another service", "worker": WORKER})
    assert executor.snapshot("of another service") is None
