"""Whoever waits for an experiment is woken or gives up, and outlasts an outage: `app/experiments/watching.py`."""

import asyncio
from dataclasses import replace

import pytest

from app.errors import DATABASE, UnavailableError
from app.experiments import watching
from app.experiments.model import Experiment, Snapshot, Status, deep_job
from tests.experiments.watched import END, JOB, PATIENCE, RUNNING, SUCCEEDED, Backend, Follow, ended, run

# Outages


@pytest.mark.parametrize("error", [UnavailableError(DATABASE, "The database is away."), RuntimeError("torn")])
def test_an_outage_ends_nothing(
    follow: Follow,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    error: Exception,
) -> None:
    """What watches is told that there is silence, what waits goes on; both hear of the end. The log says it once."""
    monkeypatch.setattr(watching, "SILENCE_SECONDS", 0.005)
    backend = Backend(RUNNING)

    async def outlasted() -> tuple[list[Snapshot | None], Experiment]:
        watch = follow(backend)
        waiting = asyncio.ensure_future(watch.wait(JOB, float("inf")))
        snapshots = watch.watch(JOB)
        while (first := await anext(snapshots)) is None:
            pass
        backend.away = error
        while await anext(snapshots) is not None:
            pass
        await backend.looked(5)
        backend.finish()
        backend.away = None
        return [first, *[found async for found in snapshots if found is not None]], await waiting

    assert run(outlasted()) == ([RUNNING, END], SUCCEEDED)
    assert [record.getMessage() for record in caplog.records] == [f"experiments cannot be watched for now: {error}"]


def test_one_that_cannot_be_read_when_the_time_is_over_says_so(follow: Follow) -> None:
    backend = Backend(RUNNING)
    backend.away = UnavailableError(DATABASE, "The database is away.")
    with pytest.raises(UnavailableError, match="The database is away"):
        run(follow(backend).wait(JOB, 0.01))


# Waiting


def test_waiting_returns_what_has_finished_at_once(follow: Follow) -> None:
    assert run(follow(Backend(None, SUCCEEDED)).wait(JOB, 0)) is SUCCEEDED


def test_waiting_returns_what_is_not_finished_when_its_time_is_over(follow: Follow) -> None:
    running = ended(Status.RUNNING)
    assert run(follow(Backend(RUNNING, running)).wait(JOB, 0.01)) is running


def test_waiting_returns_an_end_of_which_nobody_gives_notice(follow: Follow) -> None:
    """Another process brings it about."""
    backend = Backend(RUNNING)

    async def waited() -> Experiment:
        waiting = asyncio.ensure_future(follow(backend).wait(JOB, float("inf")))
        await backend.looked()
        backend.finish()
        return await waiting

    assert run(waited()) is SUCCEEDED


def test_who_waits_is_woken_from_another_thread(follow: Follow, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not when its turn comes, which never does here."""
    monkeypatch.setattr(watching, "POLL_SECONDS", PATIENCE)
    backend = Backend(RUNNING)

    async def woken() -> Experiment:
        watch = follow(backend)
        waiting = asyncio.ensure_future(watch.wait(JOB, float("inf")))
        while not backend.looks:
            await asyncio.sleep(0.001)
        backend.finish()
        await asyncio.to_thread(watch.notify, JOB)
        return await asyncio.wait_for(waiting, PATIENCE / 2)

    assert run(woken()) is SUCCEEDED


@pytest.mark.parametrize("leaves", [True, False])
def test_waiting_for_an_output_at_16_bits_says_whether_it_came(follow: Follow, leaves: bool) -> None:
    """It has no record: what is in the queue no more has left."""
    job = deep_job(JOB, "texture")
    backend = Backend()
    backend.queue[job] = RUNNING

    async def left() -> bool:
        waiting = asyncio.ensure_future(follow(backend).wait_until_left(job, PATIENCE if leaves else 0.02))
        if leaves:
            await backend.looked()
            del backend.queue[job]
        return await waiting

    assert run(left()) is leaves
    assert backend.reads == []


def test_one_whose_event_loop_is_closed_keeps_nobody_from_being_woken(follow: Follow) -> None:
    backend = Backend(RUNNING)
    watch = follow(backend)
    dead = asyncio.new_event_loop()
    abandoned = watch.watch(JOB)
    dead.run_until_complete(anext(abandoned))
    dead.close()

    async def woken() -> Experiment:
        waiting = asyncio.ensure_future(watch.wait(JOB, float("inf")))
        await backend.looked()
        backend.finish()
        return await waiting

    assert run(woken()) is SUCCEEDED
    run(abandoned.aclose())


def test_notifying_of_a_job_that_nobody_waits_for_does_nothing(follow: Follow) -> None:
    backend = Backend(RUNNING)
    follow(backend).notify("another")
    assert backend.looks == []


@pytest.mark.parametrize("turns", range(8))
def test_who_gives_up_while_the_job_moves_stops_waiting(follow: Follow, turns: int) -> None:
    """Whatever the event loop does between the two, the cancellation is not lost."""
    backend = Backend(RUNNING)

    async def given_up() -> bool:
        watch = follow(backend)
        waiting = asyncio.ensure_future(watch.wait(JOB, float("inf")))
        await backend.looked()
        backend.queue[JOB] = replace(RUNNING, fraction=0.9)
        for _ in range(turns):
            await asyncio.sleep(0)
        waiting.cancel()
        await asyncio.wait({waiting}, timeout=PATIENCE)
        return waiting.cancelled()

    assert run(given_up())
