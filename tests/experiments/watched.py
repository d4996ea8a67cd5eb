"""A store and a queue whose states the tests of watching set."""

import asyncio
from collections.abc import Awaitable, Callable, Collection, Mapping
from dataclasses import replace
from datetime import UTC, datetime, timedelta, tzinfo
from typing import Any, Self, TypeVar

from app.experiments.model import Experiment, Snapshot, Status
from app.experiments.watching import Watching
from tests.store.records import a_sample, an_experiment

NOW = datetime(2026, 3, 1, 12, tzinfo=UTC)
PATIENCE = 20.0
JOB = "job"
WAITING = Snapshot(Status.QUEUED, position=2)
RUNNING = Snapshot(Status.RUNNING, fraction=0.25, stage="spot", elapsed=1.5)
QUEUED = an_experiment(a_sample(), id=JOB, created_at=NOW - timedelta(hours=1))

Result = TypeVar("Result")


def ended(status: Status, **values: Any) -> Experiment:
    return replace(QUEUED, status=status, **values)


SUCCEEDED = ended(Status.SUCCEEDED, started_at=NOW - timedelta(seconds=3), finished_at=NOW)
END = Snapshot(Status.SUCCEEDED, fraction=1.0, elapsed=3.0)


class Clock(datetime):
    @classmethod
    def now(cls, tz: tzinfo | None = None) -> Self:
        return cls.fromtimestamp(NOW.timestamp(), tz)


class Backend:
    """A store with a queue before it: of every job what it is, and what was asked for."""

    def __init__(self, snapshot: Snapshot | None = None, record: Experiment | Exception = QUEUED) -> None:
        self.queue: dict[str, Snapshot] = {} if snapshot is None else {JOB: snapshot}
        self.records: dict[str, Experiment | Exception] = {JOB: record}
        self.away: Exception | None = None
        self.looks: list[set[str]] = []
        self.reads: list[str] = []

    def states(self, jobs: Collection[str]) -> Mapping[str, Snapshot]:
        self.looks.append(set(jobs))
        if self.away is not None:
            raise self.away
        return {job: self.queue[job] for job in jobs if job in self.queue}

    def get(self, experiment_id: str) -> Experiment:
        self.reads.append(experiment_id)
        if self.away is not None:
            raise self.away
        found = self.records[experiment_id]
        if isinstance(found, Exception):
            raise found
        return found

    def finish(self, record: Experiment | Exception = SUCCEEDED, job: str = JOB) -> None:
        self.records[job] = record
        self.queue.pop(job, None)

    async def looked(self, times: int = 2) -> None:
        """Return after so many further looks; the last but one of them began and ended after the call."""
        aim = len(self.looks) + times
        while len(self.looks) < aim:
            await asyncio.sleep(0.001)


def run(work: Awaitable[Result]) -> Result:
    async def patient() -> Result:
        return await asyncio.wait_for(work, PATIENCE)

    return asyncio.run(patient())


Follow = Callable[[Backend], Watching]
