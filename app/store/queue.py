"""Job queue over SQL: leases with fencing numbers, fair turns of the clients, progress."""

from collections.abc import Collection
from datetime import timedelta

import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from app.experiments.model import DEEP, Attempt, Beat, Lease, Snapshot, Status
from app.experiments.queue_port import PLACE
from app.store.database import Database
from app.store.jobs import WAITING, held, now, of, put, put_back, remove, unfinished
from app.store.rows import attempts_of, lease_of
from app.store.schema import jobs

KEEP_FAILURE = timedelta(hours=1)
BATCH = 500  # values of one IN (…): below every database's limit


class SqlQueue:
    """The job queue of the same database as `app.store.sql.SqlStore`.

    Parameters
    ----------
    database : Database
        That of the store: ``SqlQueue(store.database)``.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    def enqueue(self, job: str, client: str) -> None:
        try:
            with self._database.writing() as connection:
                connection.execute(jobs.delete().where(jobs.c.id == job, jobs.c.error.is_not(None)))
                if connection.scalar(sa.select(jobs.c.id).where(jobs.c.id == job)) is None:
                    put(connection, job, client)
        except IntegrityError:
            pass  # another process queued it at the same moment

    def lease(self, holder: str, *, alone: bool) -> Lease | None:
        turns = _turns()
        query = (
            sa.select(jobs)
            .join(turns, turns.c.id == jobs.c.id)
            .where(*WAITING)
            .order_by(turns.c.turn, turns.c.queued_at, turns.c.id)
            .limit(1)
            .with_for_update(of=jobs, skip_locked=True)
        )
        with self._database.writing() as connection:
            row = connection.execute(query).first()
            if row is None:
                return None
            lease = Lease(row.id, row.fence + 1, attempts_of(row.attempts))
            if lease.last and not alone:
                return None  # nothing overtakes it: else an engine that is never idle would never run it
            taken = jobs.update().where(jobs.c.id == row.id).values(holder=holder, fence=lease.fence, beat=0)
            connection.execute(taken)
        return lease

    def renew(self, lease: Lease, stage: str | None, fraction: float) -> bool:
        values = {
            "beat": jobs.c.beat + 1,
            "stage": stage,
            "fraction": fraction,
            "started_at": sa.func.coalesce(jobs.c.started_at, sa.bindparam("moment", now(), jobs.c.started_at.type)),
        }
        with self._database.writing() as connection:
            return bool(connection.execute(jobs.update().where(*of(lease)).values(values)).rowcount)

    def holds(self, lease: Lease) -> bool:
        with self._database.reading() as connection:
            return connection.scalar(sa.select(jobs.c.id).where(*of(lease))) is not None

    def release(self, lease: Lease, cause: str | None = None) -> bool:
        with self._database.writing() as connection:
            row = held(connection, lease)
            if row is None:
                return False
            charged = () if cause is None else (Attempt(now(), cause),)
            put_back(connection, lease.job, (*attempts_of(row.attempts), *charged))
        return True

    def finish(self, lease: Lease, error: str | None = None) -> bool:
        if DEEP not in lease.job:
            raise ValueError(f"{lease.job} is an experiment: its store records its end")
        with self._database.writing() as connection:
            if error is None:
                return bool(connection.execute(jobs.delete().where(*of(lease))).rowcount)
            connection.execute(jobs.delete().where(jobs.c.failed_at < now() - KEEP_FAILURE))
            failed = jobs.update().where(*of(lease)).values(holder=None, error=error, failed_at=now())
            return bool(connection.execute(failed).rowcount)

    def cancel(self, job: str) -> bool:
        with self._database.writing() as connection:
            there = remove(connection, job)
            if there:
                connection.execute(unfinished(job).values(status=Status.CANCELLED, finished_at=now()))
        return there

    def beats(self) -> list[Beat]:
        query = sa.select(jobs.c.id, jobs.c.fence, jobs.c.beat).where(jobs.c.holder.is_not(None)).order_by(jobs.c.id)
        with self._database.reading() as connection:
            return [Beat(*row) for row in connection.execute(query)]

    def lapse(self, job: str, fence: int, beat: int) -> bool:
        unchanged = (*of(Lease(job, fence)), jobs.c.beat == beat)
        with self._database.writing() as connection:
            row = connection.execute(jobs.select().where(*unchanged).with_for_update()).first()
            if row is None:
                return False
            put_back(connection, job, attempts_of(row.attempts))
        return True

    def states(self, jobs_: Collection[str]) -> dict[str, Snapshot]:
        turns = _turns()
        place = sa.func.row_number().over(order_by=(turns.c.turn, turns.c.queued_at, turns.c.id))
        places = sa.select(turns.c.id, place.label("position")).subquery()
        query = (
            sa.select(jobs.c.id, jobs.c.holder, jobs.c.stage, jobs.c.fraction, jobs.c.started_at, places.c.position)
            .outerjoin(places, places.c.id == jobs.c.id)
            .where(jobs.c.error.is_(None))
        )
        names, found, moment = list(jobs_), dict[str, Snapshot](), now()
        with self._database.reading() as connection:
            for start in range(0, len(names), BATCH):
                for row in connection.execute(query.where(jobs.c.id.in_(names[start : start + BATCH]))):
                    if row.holder is None:
                        found[row.id] = Snapshot(Status.QUEUED, row.position)
                        continue
                    seconds = 0.0 if row.started_at is None else (moment - row.started_at).total_seconds()
                    found[row.id] = Snapshot(Status.RUNNING, None, row.fraction, row.stage, max(0.0, seconds))
        return found

    def failure(self, job: str) -> str | None:
        recent = jobs.c.failed_at >= now() - KEEP_FAILURE
        with self._database.reading() as connection:
            return connection.scalar(sa.select(jobs.c.error).where(jobs.c.id == job, recent))

    def waiting(self) -> int:
        return self._count(*WAITING)

    def waiting_of(self, client: str) -> int:
        return self._count(*WAITING, jobs.c.client.startswith(client, autoescape=True))

    def leased_by(self, holder: str) -> list[Lease]:
        with self._database.reading() as connection:
            return [
                lease_of(row)
                for row in connection.execute(jobs.select().where(jobs.c.holder == holder).order_by(jobs.c.id))
            ]

    def _count(self, *conditions: sa.ColumnElement[bool]) -> int:
        with self._database.reading() as connection:
            return connection.scalar(sa.select(sa.func.count()).select_from(jobs).where(*conditions)) or 0


def _turns() -> sa.Subquery:
    """Which turn of its client's place every waiting job is, where the clients of one place take turns themselves.

    What a client or a place has running comes before.
    """
    place = sa.func.substr(jobs.c.client, 1, PLACE)
    own = _ranked(
        sa.select(jobs.c.id, jobs.c.queued_at, jobs.c.client, place.label("place")).where(*WAITING).subquery()
    )
    of_place = _running(place)
    rank = sa.func.row_number().over(partition_by=own.c.place, order_by=(own.c.turn, own.c.queued_at, own.c.id))
    return (
        sa.select(own.c.id, own.c.queued_at, (rank + sa.func.coalesce(of_place.c.jobs, 0)).label("turn"))
        .outerjoin(of_place, of_place.c.name == own.c.place)
        .subquery()
    )


def _ranked(waiting: sa.Subquery) -> sa.Subquery:
    """Number the waiting jobs of every client."""
    running = _running(jobs.c.client)
    rank = sa.func.row_number().over(partition_by=waiting.c.client, order_by=(waiting.c.queued_at, waiting.c.id))
    return (
        sa.select(waiting, (rank + sa.func.coalesce(running.c.jobs, 0)).label("turn"))
        .outerjoin(running, running.c.name == waiting.c.client)
        .subquery()
    )


def _running(name: sa.ColumnElement[str]) -> sa.Subquery:
    """Count what runs, by a name."""
    counted = sa.select(name.label("name"), sa.func.count().label("jobs"))
    return counted.where(jobs.c.holder.is_not(None)).group_by(name).subquery()
