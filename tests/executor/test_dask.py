"""The Dask executor's dispatcher, over an engine that fails on purpose: faults are logged, and no job is lost."""

import logging
import threading
from collections.abc import Iterator
from types import SimpleNamespace

import pytest
from distributed.scheduler import KilledWorker

from app.executor.messages import LOST
from app.experiments.model import Snapshot, Status
from tests.executor.fake_engine import PATIENCE, WORKER, Bench, dispatching

KILLED = KilledWorker("task", None, 0)  # type: ignore[arg-type] # which worker it was is not looked at


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    with dispatching(monkeypatch) as bench:
        yield bench


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
