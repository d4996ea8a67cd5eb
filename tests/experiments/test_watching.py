"""Waiting for an experiment to move, and giving up."""

import asyncio
from types import SimpleNamespace

import pytest

from app.experiments.model import Snapshot, Status
from app.experiments.watching import Watching

RUNNING = SimpleNamespace(snapshot=lambda job: Snapshot(Status.RUNNING))  # an executor whose job never ends


@pytest.mark.parametrize("turns", range(8))
def test_who_gives_up_while_the_job_moves_stops_waiting(turns):
    """Whatever the event loop does between the two, the cancellation is not lost."""

    async def given_up() -> bool:
        watching = Watching(SimpleNamespace(), RUNNING)
        waiting = asyncio.ensure_future(watching.wait("job", float("inf")))
        for _ in range(8):
            await asyncio.sleep(0)
        watching.notify("job")
        for _ in range(turns):
            await asyncio.sleep(0)
        waiting.cancel()
        await asyncio.wait({waiting}, timeout=0.5)
        gone = waiting.cancelled()
        waiting.cancel()
        return gone

    assert asyncio.run(given_up())
