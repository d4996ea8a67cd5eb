"""The Dask executor's dispatcher, over an engine that fails on purpose: faults are logged, and no job is lost."""

import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from distributed.scheduler import KilledWorker

from app.errors import STORAGE, UnavailableError
from app.experiments.model import Snapshot, Status
from tests.executor.fake_engine import SUFFIX, WORKER, Bench, dispatching, messages

KILLED = KilledWorker("task", None, 0)  # type: ignore[arg-type] # which worker it was is not looked at
AWAY = UnavailableError(STORAGE, "The files are away.")


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Bench]:
    with dispatching(monkeypatch, tmp_path) as bench:
        yield bench


# The engine


def test_an_engine_that_cannot_be_opened_is_tried_again_with_growing_pauses(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """Each attempt is logged with its reason; the jobs that wait run afterwards."""
    bench.cannot_open = 5
    bench.submit("a")
    assert not bench.executor.ready
    bench.start()
    bench.until(lambda: bench.opened and "a" in bench.opened[0].tasks)
    words = "the engine cannot be opened, next attempt in {:g} seconds: no scheduler answers"
    assert messages(caplog) == [(logging.ERROR, words.format(each)) for each in (0.001, 0.002, 0.004, 0.004, 0.004)]
    assert bench.executor.ready


def test_an_engine_without_workers_is_not_ready_and_leases_nothing(bench: Bench) -> None:
    bench.engines[0].threads = {}
    bench.submit("a")
    bench.executor._open = True
    bench.executor._keep_engine()
    bench.executor._keep_engine()
    bench.executor._fill()
    assert not bench.executor.ready
    assert bench.state("a") == Snapshot(Status.QUEUED, position=1)
    bench.engines[0].threads = {WORKER: 1}
    bench.executor._keep_engine()
    bench.executor._fill()
    assert bench.executor.ready
    assert bench.queue.waiting() == 0


def test_jobs_of_a_lost_engine_run_on_the_next_one_in_their_order(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """Before those that waited, and nothing is charged; one that was cancelled is over."""
    first, second, _ = bench.engines
    first.threads, second.threads = {WORKER: 3}, {WORKER: 1}
    bench.submit("a", "b", "c", "d")
    bench.start()
    bench.until(lambda: set(first.tasks) == {"a", "b", "c"})
    bench.cancel("b")
    first.alive = False
    bench.until(lambda: "a" in second.tasks)
    assert (logging.ERROR, "the engine was lost; another one is opened") in messages(caplog)
    assert first.times("close") == [None]
    for name, after in (("a", "c"), ("c", "d")):
        bench.record(second.tasks[name])
        bench.until(lambda after=after: after in second.tasks)
    first.tasks["a"].end("error", RuntimeError("late"))  # of the engine that was given up: nobody listens
    assert second.tasks["d"].lease.attempts == ()
    bench.record(second.tasks["d"])
    bench.until(lambda: not bench.executor._runs)
    assert bench.failed == []


def test_a_process_whose_engines_have_no_workers_gives_up(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It ends, so that its supervisor starts it again; each step is logged."""
    monkeypatch.setattr("app.executor.supervision.DESERTED_SECONDS", 0.02)
    monkeypatch.setattr("app.executor.supervision.HOPELESS_SECONDS", 0.02)
    for engine in bench.engines[:2]:
        engine.threads = {}
    bench.start_in_background()
    bench.until(bench.hopeless.is_set)
    assert [message for _, message in messages(caplog)] == [
        "the engine has no workers; another one is opened",
        "the engine has no workers; another one is opened",
        "no worker can be started: the service ends, so that its supervisor starts it again",
    ]


# The dispatcher


def test_a_job_that_cannot_be_sent_keeps_its_place_and_is_sent_later(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    engine = bench.engines[0]
    engine.failing = {"submit"}
    bench.submit("a", "b")
    bench.start()
    bench.until(lambda: len(engine.times("submit")) >= 3)
    assert set(engine.times("submit")) == {"a"}
    engine.failing = set()
    bench.until(lambda: "a" in engine.tasks)
    assert set(messages(caplog)) == {(logging.ERROR, "the dispatcher stumbled; it goes on")}
    assert "submit fails" in caplog.text
    assert bench.state("b") == Snapshot(Status.QUEUED, position=1)
    bench.record(engine.tasks["a"])
    bench.until(lambda: "b" in engine.tasks)


def test_a_list_of_workers_that_cannot_be_read_is_read_again(bench: Bench, caplog: pytest.LogCaptureFixture) -> None:
    engine = bench.engines[0]
    engine.failing = {"workers"}
    bench.submit("a")
    bench.start_in_background()
    bench.until(lambda: len(engine.times("workers")) >= 2)
    engine.failing = set()
    bench.until(lambda: "a" in engine.tasks)
    assert set(messages(caplog)) == {(logging.ERROR, "the dispatcher stumbled; it goes on")}


def test_a_task_that_the_scheduler_does_not_forget_ends_all_the_same(bench: Bench) -> None:
    engine = bench.engines[0]
    engine.failing = {"forget"}
    bench.submit("a", "b")
    bench.start()
    bench.until(lambda: "a" in engine.tasks)
    task = engine.tasks["a"]
    bench.queue.finish(task.lease)
    task.end("error", RuntimeError("not for people"))
    bench.until(lambda: "b" in engine.tasks)
    assert task.released


def test_an_end_that_cannot_be_recorded_keeps_no_other_from_it(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Of a round; it is put back and tried again."""
    engine, stumbles = bench.engines[0], iter(range(3))
    engine.threads = {WORKER: 2}
    bench.submit("a", "b")
    bench.start()
    bench.until(lambda: {"a", "b"} <= engine.tasks.keys())
    holds = bench.queue.holds

    def stumbling(lease: Any) -> bool:
        if lease.job == "a" + SUFFIX and next(stumbles, None) is not None:
            raise ZeroDivisionError("it stumbles")
        return holds(lease)

    monkeypatch.setattr(bench.queue, "holds", stumbling)
    for task in list(engine.tasks.values()):
        bench.record(task)
    bench.until(lambda: not bench.executor._runs)
    assert messages(caplog) == [(logging.ERROR, "the dispatcher stumbled; it goes on")] * 3


def test_a_listener_that_fails_is_logged_and_the_dispatcher_goes_on(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    failures = iter([None])

    def listener(job: str) -> None:
        for _ in failures:
            raise ZeroDivisionError("a listener fails")

    bench.executor.subscribe(listener)
    bench.submit("a")
    bench.start()
    bench.until(lambda: "a" in bench.engines[0].tasks)
    bench.record(bench.engines[0].tasks["a"])
    bench.until(lambda: not bench.executor._runs)
    assert messages(caplog) == [(logging.ERROR, "the dispatcher stumbled; it goes on")]
    assert "a listener fails" in caplog.text
