"""Three kinds of failure, never mixed: a worker's death, what is away for now, what is stopped from outside."""

import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from distributed.scheduler import KilledWorker

from app.errors import DATABASE, STORAGE, UnavailableError
from app.executor import endings
from app.executor.dispatched import DIED
from app.executor.messages import LOST, UNRECORDED, UNUSABLE
from app.experiments.model import ATTEMPTS, Status
from tests.executor.fake_engine import SUFFIX, WORKER, Bench, dispatching, messages

KILLED = KilledWorker("task", None, 0)  # type: ignore[arg-type] # which worker it was is not looked at
AWAY = UnavailableError(STORAGE, "The files are away.")


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Bench]:
    with dispatching(monkeypatch, tmp_path) as bench:
        yield bench


def waits(bench: Bench, name: str) -> bool:
    state = bench.state(name)
    return state is not None and state.status is Status.QUEUED


def test_a_job_whose_worker_dies_runs_again_before_the_others_until_its_last_attempt(bench: Bench) -> None:
    engine = bench.engines[0]
    bench.submit("a", "b")
    bench.start()
    for times in range(1, ATTEMPTS + 1):
        bench.until(lambda times=times: engine.times("submit") == ["a"] * times)
        lease = engine.tasks["a"].lease
        assert [attempt.cause for attempt in lease.attempts] == [DIED] * (times - 1)
        assert lease.last is (times == ATTEMPTS)
        engine.tasks["a"].end("error", KILLED)
    bench.until(lambda: "b" in engine.tasks)
    assert bench.failed == [("a", LOST, DIED)]


def test_the_last_attempt_runs_alone(bench: Bench) -> None:
    engine = bench.engines[0]
    engine.threads = {WORKER: 2}
    for _ in range(ATTEMPTS - 1):
        bench.submit("suspect")
        lease = bench.queue.lease("another", alone=True)
        assert lease is not None
        bench.queue.release(lease, DIED)
    bench.submit("after")
    bench.start()
    bench.until(lambda: "suspect" in engine.tasks)
    bench.record(engine.tasks["suspect"])
    bench.until(lambda: "after" in engine.tasks)
    asked = [value for name, value in engine.asked if name == "submit"]
    assert asked == ["suspect", "after"]


def test_what_is_away_charges_nobody_and_is_waited_for(bench: Bench, caplog: pytest.LogCaptureFixture) -> None:
    """The job keeps its place, nothing else is begun meanwhile, and all goes on once it answers."""
    engine = bench.engines[0]
    engine.threads = {WORKER: 1}
    bench.submit("a", "b")
    bench.start()
    bench.until(lambda: "a" in engine.tasks)
    bench.away = AWAY
    first = engine.tasks["a"]
    first.end("error", AWAY)
    bench.until(lambda: waits(bench, "a"))
    assert waits(bench, "b")
    bench.away = None
    bench.until(lambda: engine.tasks["a"] is not first)
    assert engine.tasks["a"].lease.attempts == ()
    assert bench.failed == []
    assert (logging.WARNING, "no job is begun for now: The files are away.") in messages(caplog)
    assert (logging.WARNING, "database and storage answer: jobs go on") in messages(caplog)


def test_a_database_that_is_away_stops_the_dispatcher_and_not_for_good(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine, holds = bench.engines[0], bench.queue.holds
    bench.submit("a", "b")
    bench.start()
    bench.until(lambda: "a" in engine.tasks)

    def away(*_: Any) -> Any:
        raise UnavailableError(DATABASE, "It is away.")

    bench.away = UnavailableError(DATABASE, "It is away.")
    bench.queue.finish(engine.tasks["a"].lease)
    monkeypatch.setattr(bench.queue, "holds", away)
    engine.tasks["a"].end()
    bench.until(lambda: bench.executor._away.failing)
    assert bench.executor._runs
    monkeypatch.setattr(bench.queue, "holds", holds)
    bench.away = None
    bench.until(lambda: "b" in engine.tasks)


def test_a_job_whose_files_are_never_there_although_all_else_is_ends_in_words(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else it would run for ever, before all others."""
    monkeypatch.setattr(endings, "UNUSABLE_SECONDS", 0.0)
    bench.submit("a")
    bench.start()
    bench.until(lambda: "a" in bench.engines[0].tasks)
    bench.engines[0].tasks["a"].end("error", AWAY)
    bench.until(lambda: bench.failed)
    assert bench.failed == [("a", UNUSABLE, None)]


@pytest.mark.parametrize(("status", "error"), [("finished", None), ("error", RuntimeError("not for people"))])
def test_a_job_that_leaves_without_a_record_runs_once_more_and_then_fails_in_words(
    bench: Bench, status: str, error: Exception | None
) -> None:
    engine = bench.engines[0]
    bench.submit("a")
    bench.start()
    for times in (1, 2):
        bench.until(lambda times=times: engine.times("submit") == ["a"] * times)
        engine.tasks["a"].end(status, error)
    bench.until(lambda: bench.failed)
    assert bench.failed == [("a", UNRECORDED, None)]


def test_closing_gives_back_what_runs_and_charges_nothing(bench: Bench) -> None:
    bench.submit("a", "b")
    bench.start()
    bench.until(lambda: "a" in bench.engines[0].tasks)
    bench.executor.close()
    assert waits(bench, "a")
    lease = bench.queue.lease("another", alone=False)
    assert lease is not None
    assert (lease.job, lease.attempts) == ("a" + SUFFIX, ())


def test_a_lease_whose_worker_gives_no_sign_of_life_lapses(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Another process took it and died: its jobs are run here, and nothing is charged."""
    bench.submit("a")
    lost = bench.queue.lease("a process that died", alone=True)
    assert lost is not None
    bench.queue.renew(lost, "spot", 0.5)
    monkeypatch.setattr("app.executor.lapses.LEASE_SECONDS", 0.05)
    bench.start()
    bench.until(lambda: "a" in bench.engines[0].tasks)
    taken = bench.engines[0].tasks["a"].lease
    assert (taken.fence > lost.fence, taken.attempts) == (True, ())
    assert not bench.queue.renew(lost, "spot", 0.6)
    assert "its worker gave no sign of life" in caplog.text
