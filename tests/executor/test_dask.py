"""The Dask executor's dispatcher, over an engine that fails on purpose: faults are logged, and no job is lost."""

import logging
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from distributed.scheduler import KilledWorker

from app.executor import dask
from app.executor.dask import GRACE_SECONDS, SILENCE_SECONDS, DaskExecutor
from app.executor.dispatched import Dispatched
from app.executor.messages import LOST
from app.experiments.model import Snapshot, Status
from app.settings import Settings

PATIENCE = 20.0
WORKER = "tcp://worker"
LIMIT = 60.0
KILLED = KilledWorker("task", None, 0)  # type: ignore[arg-type] # which worker it was is not looked at


class Task:
    """A future that ends when the test says so."""

    def __init__(self, job: str) -> None:
        self.job = job
        self.status = "pending"
        self.error: Exception | None = None
        self.callback: Callable[[Any], None] = lambda task: None
        self.released = False

    def add_done_callback(self, callback: Callable[[Any], None]) -> None:
        self.callback = callback

    def exception(self) -> Exception | None:
        return self.error

    def release(self) -> None:
        self.released = True

    def end(self, status: str = "finished", error: Exception | None = None) -> None:
        self.status, self.error = status, error
        self.callback(self)


class Engine:
    """One worker with one thread; what it is asked is noted, and what is in ``failing`` raises."""

    def __init__(self) -> None:
        self.alive = True
        self.threads = {WORKER: 1}
        self.failing: set[str] = set()
        self.asked: list[tuple[str, Any]] = []
        self.tasks: dict[str, Task] = {}

    def _ask(self, what: str, value: Any) -> None:
        self.asked.append((what, value))
        if what in self.failing:
            raise OSError(f"{what} fails")

    def workers(self) -> dict[str, int]:
        self._ask("workers", None)
        return dict(self.threads)

    def submit(self, job: str, address: str) -> Task:
        self._ask("submit", job)
        self.tasks[job] = Task(job)
        return self.tasks[job]

    def forget(self, task: Task) -> None:
        self._ask("forget", task.job)

    def stop(self, job: str) -> None:
        self._ask("stop", job)

    def kill(self, address: str) -> None:
        self._ask("kill", address)

    def close(self) -> None:
        self._ask("close", None)

    def times(self, what: str) -> list[Any]:
        return [value for name, value in self.asked if name == what]


class Bench:
    """An executor whose engines are made by the test, and what it told the service."""

    def __init__(self, engines: list[Engine]) -> None:
        self.engines = engines
        self.opened: list[Engine] = []
        self.cannot_open = 0
        self.ended: list[tuple[str, str | None]] = []
        self.told: list[str] = []
        self.executor = DaskExecutor(Settings(data_dir=Path("unused"), time_limit=LIMIT), lambda *_: None)
        self.executor.subscribe(self.told.append)
        self._moments = threading.Event()

    def open(self, *_: Any, **__: Any) -> Engine:
        if self.cannot_open:
            self.cannot_open -= 1
            raise OSError("no scheduler answers")
        self.opened.append(self.engines[len(self.opened)])
        return self.opened[-1]

    def start(self) -> None:
        self.executor.start(lambda job, failure: self.ended.append((job, failure)))

    def until(self, condition: Callable[[], object]) -> None:
        for _ in range(int(PATIENCE / 0.005)):
            if condition():
                return
            self._moments.wait(0.005)
        pytest.fail("what was waited for did not come")


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    monkeypatch.setattr(dask, "TICK_SECONDS", 0.005)
    monkeypatch.setattr(dask, "WORKERS_SECONDS", 0.0)
    monkeypatch.setattr(dask, "FIRST_PAUSE_SECONDS", 0.001)
    monkeypatch.setattr(dask, "LONGEST_PAUSE_SECONDS", 0.004)
    bench = Bench([Engine(), Engine()])
    monkeypatch.setattr(dask, "Engine", bench.open)
    yield bench
    bench.executor.close()


def messages(caplog: pytest.LogCaptureFixture) -> list[tuple[int, str]]:
    return [(record.levelno, record.message) for record in caplog.records]


# The engine


def test_an_engine_that_cannot_be_opened_is_tried_again_with_growing_pauses(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """Each attempt is logged with its reason; the jobs that wait run afterwards."""
    bench.cannot_open = 5
    bench.executor.submit("a")
    assert not bench.executor.ready
    bench.start()
    bench.until(lambda: bench.opened and "a" in bench.opened[0].tasks)
    words = "the engine cannot be opened; next attempt in {:g} seconds"
    assert messages(caplog) == [(logging.ERROR, words.format(each)) for each in (0.001, 0.002, 0.004, 0.004, 0.004)]
    assert caplog.text.count("no scheduler answers") >= 5
    assert bench.executor.ready


def test_an_engine_without_workers_is_not_ready(bench: Bench) -> None:
    bench.engines[0].threads = {}
    bench.executor.submit("a")
    bench.executor._open = True
    bench.executor._keep_engine()
    bench.executor._fill()
    assert not bench.executor.ready
    assert bench.executor.snapshot("a") == Snapshot(Status.QUEUED, position=1)
    bench.engines[0].threads = {WORKER: 1}
    bench.executor._fill()
    assert bench.executor.ready
    assert bench.executor.waiting == 0


def test_jobs_of_a_lost_engine_run_on_the_next_one_in_their_order(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """Before those that waited; one that was cancelled is over."""
    first, second = bench.engines
    first.threads, second.threads = {WORKER: 3}, {WORKER: 1}
    bench.start()
    for job in ("a", "b", "c", "d"):
        bench.executor.submit(job)
    bench.until(lambda: set(first.tasks) == {"a", "b", "c"})
    bench.executor.cancel("b")
    bench.until(lambda: first.times("stop") == ["b"])
    first.alive = False
    bench.until(lambda: "a" in second.tasks)
    assert (logging.WARNING, "the engine was lost; opening another one") in messages(caplog)
    assert bench.ended == [("b", None)]
    assert first.times("close") == [None]
    second.tasks["a"].end()
    bench.until(lambda: "c" in second.tasks)
    second.tasks["c"].end()
    bench.until(lambda: "d" in second.tasks)
    first.tasks["a"].end("error", RuntimeError("late"))  # of the engine that was given up: nobody listens
    second.tasks["d"].end()
    bench.until(lambda: len(bench.ended) == 4)
    assert bench.ended[1:] == [("a", None), ("c", None), ("d", None)]


# The dispatcher


def test_a_job_that_cannot_be_sent_keeps_its_place_and_is_sent_later(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    engine = bench.engines[0]
    engine.failing = {"submit"}
    bench.executor.submit("a")
    bench.executor.submit("b")
    bench.start()
    bench.until(lambda: len(engine.times("submit")) >= 3)
    assert set(engine.times("submit")) == {"a"}
    assert bench.executor.waiting <= 2
    engine.failing = set()
    bench.until(lambda: "a" in engine.tasks)
    assert set(messages(caplog)) == {(logging.ERROR, "the dispatcher stumbled; it goes on")}
    assert "submit fails" in caplog.text
    assert bench.executor.snapshot("b") == Snapshot(Status.QUEUED, position=1)
    engine.tasks["a"].end()
    bench.until(lambda: "b" in engine.tasks)
    assert bench.ended == [("a", None)]


def test_a_list_of_workers_that_cannot_be_read_is_read_again(bench: Bench, caplog: pytest.LogCaptureFixture) -> None:
    engine = bench.engines[0]
    engine.failing = {"workers"}
    bench.executor.submit("a")
    bench.executor._open = True
    thread = threading.Thread(target=bench.executor._dispatch)
    thread.start()
    bench.until(lambda: len(engine.times("workers")) >= 2)
    engine.failing = set()
    bench.until(lambda: "a" in engine.tasks)
    bench.executor.close()
    thread.join(PATIENCE)
    assert set(messages(caplog)) == {(logging.ERROR, "the dispatcher stumbled; it goes on")}


def test_a_task_that_the_scheduler_does_not_forget_ends_all_the_same(bench: Bench) -> None:
    engine = bench.engines[0]
    engine.failing = {"forget"}
    bench.start()
    bench.executor.submit("a")
    bench.executor.submit("b")
    bench.until(lambda: "a" in engine.tasks)
    engine.tasks["a"].end("error", RuntimeError("not for people"))
    bench.until(lambda: "b" in engine.tasks)
    assert [job for job, _ in bench.ended] == ["a"]
    assert engine.tasks["a"].released


def test_a_job_whose_worker_is_killed_runs_once_more_before_the_others(bench: Bench) -> None:
    engine = bench.engines[0]
    bench.start()
    bench.executor.submit("a")
    bench.executor.submit("b")
    bench.until(lambda: "a" in engine.tasks)
    for times in (1, 2):
        bench.until(lambda times=times: engine.times("submit") == ["a"] * times)
        engine.tasks["a"].end("error", KILLED)
    bench.until(lambda: "b" in engine.tasks)
    assert bench.ended == [("a", LOST)]


# Limits, on a clock of the test's


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


def test_a_listener_that_fails_is_logged_and_the_dispatcher_goes_on(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    failures = iter([SimpleNamespace()])

    def listener(job: str) -> None:
        if next(failures, None) is not None:
            raise ZeroDivisionError("a listener fails")

    bench.executor.subscribe(listener)
    bench.executor.submit("a")
    bench.start()
    bench.until(lambda: "a" in bench.engines[0].tasks)
    bench.engines[0].tasks["a"].end()
    bench.until(lambda: bench.ended == [("a", None)])
    assert messages(caplog) == [(logging.ERROR, "the dispatcher stumbled; it goes on")]
    assert "a listener fails" in caplog.text
