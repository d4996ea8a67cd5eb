"""Limits of the Dask executor, on the test's clock: what takes too long or was cancelled is stopped, and only that."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.executor import dask, keeper
from app.executor.dask import GRACE_SECONDS, SILENCE_SECONDS
from app.executor.dispatched import Dispatched, Verdict, verdict
from tests.executor.fake_engine import LIMIT, WORKER, Bench, dispatching
from tests.still_clock import Clock


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Bench]:
    with dispatching(monkeypatch, tmp_path) as bench:
        yield bench


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(dask, "time", clock)
    monkeypatch.setattr(keeper, "time", clock)
    return clock


@pytest.fixture
def sent(bench: Bench, clock: Clock) -> Dispatched:
    """A job on the worker; the dispatcher's thread is not running."""
    executor = bench.executor
    executor._open = True
    bench.submit("a")
    executor._keep_engine()
    executor._keep_engine()
    executor._fill()
    return bench.run_of("a")


def look(bench: Bench, clock: Clock, after: float) -> None:
    clock.now += after
    bench.executor._look()


@pytest.mark.parametrize(("more", "killed"), [(-0.01, False), (0.01, True)])
def test_a_job_that_takes_too_long_is_killed_with_its_worker(
    bench: Bench, clock: Clock, sent: Dispatched, more: float, killed: bool
) -> None:
    """Its time begins with its first heartbeat; its own worker has told it to end before."""
    engine = bench.engines[0]
    bench.queue.renew(sent.lease, None, 0.0)
    look(bench, clock, 7)
    look(bench, clock, LIMIT + 2 * GRACE_SECONDS + more)
    assert sent.out_of_time is killed
    assert engine.times("kill") == [WORKER] * killed
    assert engine.times("forget") == ["a"] * killed
    look(bench, clock, 0.001)
    assert len(engine.times("kill")) == killed  # once only


@pytest.mark.parametrize(("more", "withdrawn"), [(-0.01, False), (0.01, True)])
def test_a_job_that_its_worker_does_not_begin_is_taken_back_without_a_charge(
    bench: Bench, clock: Clock, sent: Dispatched, more: float, withdrawn: bool
) -> None:
    """It never ran, so it did not take too long, and its worker may be busy with another service's job."""
    engine = bench.engines[0]
    look(bench, clock, SILENCE_SECONDS + more)
    assert sent.withdrawn is withdrawn
    assert engine.times("kill") == []
    assert engine.times("forget") == ["a"] * withdrawn
    if withdrawn:
        assert verdict(sent, "cancelled", None, embedded=True) is Verdict.RETURNED


@pytest.mark.parametrize(("after", "killed"), [(GRACE_SECONDS - 0.01, False), (GRACE_SECONDS + 0.01, True)])
def test_a_cancelled_job_that_does_not_stop_by_itself_is_killed(
    bench: Bench, clock: Clock, sent: Dispatched, after: float, killed: bool
) -> None:
    """Wherever it was cancelled: the row is gone."""
    bench.cancel("a")
    look(bench, clock, 1)
    look(bench, clock, after)
    assert bench.engines[0].times("kill") == [WORKER] * killed
    assert not sent.out_of_time


@pytest.mark.parametrize(("after", "killed"), [(SILENCE_SECONDS - 0.01, False), (SILENCE_SECONDS + 0.01, True)])
def test_a_worker_that_recorded_its_job_is_given_time_to_tidy_up(
    bench: Bench, clock: Clock, sent: Dispatched, after: float, killed: bool
) -> None:
    bench.queue.finish(sent.lease)
    look(bench, clock, 1)
    look(bench, clock, after)
    assert bench.engines[0].times("kill") == [WORKER] * killed


def test_a_worker_that_was_killed_is_given_nothing_until_it_is_gone(
    bench: Bench, clock: Clock, sent: Dispatched
) -> None:
    engine, executor = bench.engines[0], bench.executor
    bench.cancel("a")
    look(bench, clock, 1)
    look(bench, clock, GRACE_SECONDS + 1)
    executor._leave(sent)
    bench.submit("b")
    executor._fill()
    assert "b" not in engine.tasks
    engine.threads = {"tcp://another": 1}
    clock.now += 1
    executor._keep_engine()
    executor._fill()
    assert "b" in engine.tasks


@pytest.mark.parametrize(("begun", "expected"), [(True, Verdict.DIED), (False, Verdict.RETURNED)])
def test_a_job_whose_worker_left_the_engine_is_run_again(
    bench: Bench, clock: Clock, sent: Dispatched, begun: bool, expected: Verdict
) -> None:
    """An external scheduler would keep it for a worker that never comes back; charged only if it had begun."""
    if begun:
        bench.queue.renew(sent.lease, None, 0.0)
    bench.engines[0].threads = {"tcp://another": 1}
    clock.now += 1
    bench.executor._keep_engine()
    assert sent.orphaned
    bench.executor._leave(sent)
    assert verdict(sent, "cancelled", None, embedded=False) is expected
    again = bench.queue.lease("another", alone=True)
    assert again is not None
    assert len(again.attempts) == begun


def test_the_workers_of_an_engine_are_asked_for_at_once_when_they_may_have_changed(
    bench: Bench, clock: Clock, sent: Dispatched, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When Dask says that one came or went, and when the engine is another one; else once in a while."""
    monkeypatch.setattr(keeper, "WORKERS_SECONDS", 5.0)
    executor, (first, second, _) = bench.executor, bench.engines
    for wait, times in ((4.9, 1), (0.1, 1), (0.1, 2)):
        clock.now += wait
        executor._keep_engine()
        assert len(first.times("workers")) == times
    executor._keeper._note_change()
    executor._keep_engine()
    assert len(first.times("workers")) == 3
    first.alive = False
    executor._keep_engine()
    executor._keep_engine()
    executor._keep_engine()
    assert len(second.times("workers")) == 1
    assert executor.ready
