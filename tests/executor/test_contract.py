"""What every executor promises."""

from pathlib import Path

import pytest
from engine_bench import Bench, a_bench, running

from app.experiments.model import Status


def occupy(bench: Bench, threads: int) -> list[str]:
    """Jobs that keep every thread busy until told to go."""
    names = [f"polite-{number}" for number in range(threads)]
    bench.submit(*names)
    bench.until(lambda: all(bench.started(name) for name in names))
    return names


def release(bench: Bench, names: list[str]) -> None:
    for name in names:
        bench.go(name)
    for name in names:
        bench.end_of(name)


def test_a_job_runs_once(bench: Bench) -> None:
    bench.submit("quick")
    assert bench.end_of("quick") is None
    assert len(bench.started("quick")) == len(bench.done("quick")) == 1


@pytest.mark.slow
def test_many_jobs_all_end(bench: Bench) -> None:
    names = [f"quick-{number}" for number in range(30)]
    bench.submit(*names)
    assert {bench.end_of(name) for name in names} == {None}
    assert bench.queue.waiting() == 0


def test_jobs_start_in_the_order_in_which_they_came(bench: Bench, threads_of: int) -> None:
    holders = occupy(bench, threads_of)
    names = [f"quick-{number}" for number in range(6)]
    bench.submit(*names)
    for holder in holders[1:]:
        assert bench.status(holder) is Status.RUNNING
    bench.go(holders[0])
    for name in names:
        bench.end_of(name)
    if threads_of > 1:  # one thread is still held, so the others ended one after the other
        ends = [(bench.directory / f"{name}.done").stat().st_mtime_ns for name in names]
        assert ends == sorted(ends)
    release(bench, holders)


def test_a_job_that_waits_knows_its_place(bench: Bench, threads_of: int) -> None:
    holders = occupy(bench, threads_of)
    bench.submit("quick-a", "quick-b", "quick-c")
    places = [bench.snapshot(name) for name in ("quick-a", "quick-b", "quick-c")]
    assert [(place.status, place.position) for place in places] == [(Status.QUEUED, each) for each in (1, 2, 3)]
    assert bench.queue.waiting() == 3
    bench.cancel("quick-a")
    assert [bench.snapshot(name).position for name in ("quick-b", "quick-c")] == [1, 2]
    release(bench, holders)
    bench.end_of("quick-c")


def test_submitting_twice_runs_once(bench: Bench, threads_of: int) -> None:
    holders = occupy(bench, threads_of)
    bench.submit(*holders, "quick", "quick")
    assert bench.queue.waiting() == 1
    release(bench, holders)
    bench.end_of("quick")
    assert len(bench.started("quick")) == 1
    assert all(len(bench.started(name)) == 1 for name in holders)


def test_a_job_can_run_again_after_its_end(bench: Bench) -> None:
    """At once, and often: whatever the engine still remembers of the run before does not stand for the next one."""
    for count in range(1, 41):
        bench.submit("refused")
        assert bench.end_of("refused") == "The crop is too small: make it larger."
        assert len(bench.started("refused")) == count


def test_words_for_people_come_through(bench: Bench) -> None:
    bench.submit("refused")
    assert bench.end_of("refused") == "The crop is too small: make it larger."


def test_a_fault_is_told_without_its_innards(bench: Bench) -> None:
    bench.submit("broken")
    failure = bench.end_of("broken")
    assert failure is not None
    assert "not for people" not in failure
    assert "fault of the service" in failure


def test_what_is_away_is_waited_for(bench: Bench) -> None:
    bench.submit("away-2")
    assert bench.end_of("away-2") is None
    assert len(bench.started("away-2")) == 3


def test_a_job_that_leaves_without_a_record_fails_in_words_after_a_second_run(bench: Bench) -> None:
    bench.submit("forgetful")
    assert "No worker recorded" in (bench.end_of("forgetful") or "")
    assert len(bench.started("forgetful")) == 2


def test_progress_is_seen_while_it_runs(bench: Bench) -> None:
    bench.submit("polite")
    bench.until(lambda: (found := bench.snapshot("polite")) is not None and found.stage == "waiting")
    snapshot = bench.snapshot("polite")
    assert (snapshot.status, snapshot.position, snapshot.fraction) == (Status.RUNNING, None, 0.25)
    assert snapshot.elapsed > 0
    assert bench.job("polite") in bench.told
    release(bench, ["polite"])


def test_a_cancelled_job_that_waits_never_runs(bench: Bench, threads_of: int) -> None:
    holders = occupy(bench, threads_of)
    bench.submit("quick-never", "quick-after")
    bench.cancel("quick-never")
    assert bench.snapshot("quick-never") is None
    release(bench, holders)
    bench.end_of("quick-after")
    assert bench.started("quick-never") == []


def test_a_running_job_stops_when_cancelled_and_others_go_on(bench: Bench, threads_of: int) -> None:
    holders = occupy(bench, threads_of)
    bench.cancel(holders[0])
    assert bench.snapshot(holders[0]) is None
    assert bench.done(holders[0]) == []
    assert all(bench.status(name) is Status.RUNNING for name in holders[1:])
    bench.submit("quick")
    assert bench.end_of("quick") is None
    release(bench, holders[1:])


def test_a_listener_that_left_is_not_called(bench: Bench) -> None:
    heard: list[str] = []
    leave = bench.executor.subscribe(heard.append)
    bench.submit("quick-1")
    bench.end_of("quick-1")
    assert bench.job("quick-1") in heard
    leave()
    bench.submit("quick-2")
    bench.end_of("quick-2")
    assert bench.job("quick-2") not in heard


@pytest.mark.slow
def test_a_job_that_takes_too_long_ends(tmp_path: Path, shared_bench: Bench) -> None:
    with running(a_bench(shared_bench.kind, tmp_path, workers=1, time_limit=1.0)) as bench:
        bench.submit("polite", "quick")
        failure = bench.end_of("polite")
        assert failure is not None
        assert "longer than 1 seconds" in failure
        assert bench.end_of("quick") is None


@pytest.mark.parametrize("kind", ["inline", "dask"])
def test_jobs_that_came_before_the_start_run_and_closing_ends_nothing_falsely(kind: str, tmp_path: Path) -> None:
    bench = a_bench(kind, tmp_path, workers=1)
    bench.submit("quick", *(f"polite-{number}" for number in range(2)))
    assert not bench.executor.ready
    with running(bench):
        assert bench.executor.ready
        assert bench.end_of("quick") is None
        bench.until(lambda: bool(bench.started("polite-0")))
    assert not bench.executor.ready
    assert bench.status("polite-1") is Status.QUEUED
    assert bench.queue.failure(bench.job("polite-0")) is None
