"""Rows of the job queue: what the experiment store and the queue do to them in their own transactions."""

import secrets
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Any

import sqlalchemy as sa
from sqlalchemy.engine import Connection

from app.experiments.model import DEEP, Attempt, Lease, Status
from app.store.rows import Row, attempt_values
from app.store.schema import experiments, jobs

WAITING = (jobs.c.holder.is_(None), jobs.c.error.is_(None))
FENCE_BITS = 40
UNFINISHED = (Status.QUEUED, Status.RUNNING)


def put(connection: Connection, job: str, client: str) -> None:
    """Insert a job that waits.

    Its fencing numbers begin anywhere: who still carries a lease of a job of the same name that was cancelled or
    replaced holds none of this one.
    """
    start = secrets.randbits(FENCE_BITS)
    connection.execute(jobs.insert().values(id=job, client=client, queued_at=now(), fence=start, attempts=[]))


def held(connection: Connection, lease: Lease) -> Row | None:
    """Find and lock the row of a lease that is still held.

    Who changes both locks this row first, then the experiment's: in another order two could wait for each other.
    """
    return connection.execute(jobs.select().where(*of(lease)).with_for_update()).first()


def of(lease: Lease) -> tuple[sa.ColumnElement[bool], ...]:
    """The conditions under which a row is that of this lease."""
    return jobs.c.id == lease.job, jobs.c.fence == lease.fence, jobs.c.holder.is_not(None)


def remove(connection: Connection, job: str) -> bool:
    """Take a job out, whether it waits or runs; whether it did."""
    row = connection.execute(jobs.delete().where(jobs.c.id == job).returning(jobs.c.error)).first()
    return row is not None and row.error is None


def remove_with_deep(connection: Connection, experiment_id: str) -> None:
    """Take out the job of an experiment and those of its outputs at 16 bits."""
    deep = jobs.c.id.startswith(f"{experiment_id}{DEEP}", autoescape=True)
    connection.execute(jobs.delete().where((jobs.c.id == experiment_id) | deep))


def put_back(connection: Connection, job: str, attempts: Sequence[Attempt]) -> None:
    """Let a leased job wait again, at its old place."""
    charged = attempt_values(attempts)
    values: dict[str, Any] = {"holder": None, "stage": None, "fraction": 0.0, "started_at": None}
    connection.execute(jobs.update().where(jobs.c.id == job).values(**values, attempts=charged))
    connection.execute(unfinished(job).values(status=Status.QUEUED, started_at=None, charges=charged))


def unfinished(experiment_id: str) -> sa.Update:
    """Change an experiment that is queued or runs."""
    return experiments.update().where(experiments.c.id == experiment_id, experiments.c.status.in_(UNFINISHED))


def now() -> datetime:
    return datetime.now(UTC)
