"""Experiment store over SQL: samples and experiments in SQLite or PostgreSQL."""

from collections.abc import Collection, Mapping, Sequence
from datetime import datetime
from typing import Any

import sqlalchemy as sa
from sqlalchemy.engine import Connection
from sqlalchemy.exc import IntegrityError

from app.errors import ConflictError, DeletedError, NotFoundError
from app.experiments.model import DEEP, Attempt, Experiment, Lease, Output, Page, Sample, Status
from app.store.database import Database
from app.store.jobs import held, now, put, remove, remove_with_deep, unfinished
from app.store.migrate import upgrade
from app.store.rows import (
    attempt_values,
    cursor_after,
    experiments_of,
    input_rows,
    output_row,
    parse_cursor,
    row_of_experiment,
    row_of_sample,
    sample_of,
)
from app.store.schema import deleted, experiments, inputs, outputs, samples

BATCH = 500  # values of one IN (…): below every database's limit


class SqlStore:
    """The experiment store over SQLAlchemy.

    Parameters
    ----------
    url : str
        ``sqlite:///path`` or ``postgresql+psycopg://…``; the schema is made if it is not there.
    """

    def __init__(self, url: str) -> None:
        self.database = Database(url)
        try:
            upgrade(self.database)
        except BaseException:
            self.database.close()
            raise

    def close(self) -> None:
        self.database.close()

    def ping(self) -> None:
        self.database.ping()

    # samples

    def add_sample(self, sample: Sample, owner: str | None = None) -> None:
        with self.database.writing() as connection:
            connection.execute(samples.insert().values(row_of_sample(sample, owner)))

    def sample(self, sample_id: str) -> Sample:
        query = samples.select().where(samples.c.id == _text(sample_id))
        with self.database.reading() as connection:
            row = connection.execute(query).first()
        if row is None:
            raise NotFoundError(
                "There is no such photograph. Uploads that no experiment uses are removed after a while."
            )
        return sample_of(row)

    def bundled_samples(self) -> list[Sample]:
        query = samples.select().where(samples.c.bundled).order_by(samples.c.created_at, samples.c.id)
        with self.database.reading() as connection:
            return [sample_of(row) for row in connection.execute(query)]

    def remove_unused_samples(self, created_before: datetime, among: Collection[str] | None = None) -> list[Sample]:
        unused = [
            ~samples.c.bundled,
            samples.c.created_at < created_before,
            ~sa.exists().where(inputs.c.sample == samples.c.id),
        ]
        if among is not None:
            unused.append(samples.c.id.in_(among))
        removed = []
        with self.database.reading() as connection:
            candidates = connection.scalars(sa.select(samples.c.id).where(*unused)).all()
        for sample_id in candidates:  # one transaction each: a new experiment of one must not keep the others
            try:
                with self.database.writing() as connection:
                    row = connection.execute(
                        samples.delete().where(samples.c.id == sample_id, *unused).returning(*samples.c)
                    ).first()
            except IntegrityError:
                continue  # an experiment of it was added at the same moment
            if row is not None:
                removed.append(sample_of(row))
        return removed

    # experiments

    def add(self, experiment: Experiment, client: str = "") -> None:
        try:
            with self.database.writing() as connection:
                self._insert(connection, experiment, client)
        except IntegrityError:
            for item in experiment.inputs:
                self.sample(item.sample)
            raise ConflictError("An experiment with this identifier exists already: send it again.") from None

    def replace(self, experiment: Experiment, client: str = "") -> None:
        with self.database.writing() as connection:
            remove_with_deep(connection, experiment.id)
            for table in (experiments, deleted):
                connection.execute(table.delete().where(table.c.id == experiment.id))
            self._insert(connection, experiment, client)

    def get(self, experiment_id: str) -> Experiment:
        experiment_id = _text(experiment_id)
        with self.database.reading() as connection:
            found = self._read(connection, experiments.select().where(experiments.c.id == experiment_id))
            if found:
                return found[0]
            if connection.scalar(sa.select(deleted.c.id).where(deleted.c.id == experiment_id)) is not None:
                raise DeletedError("This experiment was deleted by its owner or because of its age.")
        raise NotFoundError("There is no such experiment. Check the address.")

    def page(self, *, limit: int, cursor: str | None = None, method: str | None = None) -> Page:
        query = (
            experiments.select()
            .where(experiments.c.status == Status.SUCCEEDED, experiments.c.listed, ~experiments.c.transient)
            .order_by(experiments.c.created_at.desc(), experiments.c.id.desc())
            .limit(limit + 1)
        )
        if method is not None:
            query = query.where(experiments.c.method == _text(method))
        if cursor is not None:
            moment, last = parse_cursor(cursor)
            query = query.where(
                (experiments.c.created_at < moment) | ((experiments.c.created_at == moment) & (experiments.c.id < last))
            )
        with self.database.reading() as connection:
            found = self._read(connection, query)
        more = len(found) > limit
        return Page(tuple(found[:limit]), cursor_after(found[limit - 1]) if more else None)

    def start(self, lease: Lease) -> Experiment | None:
        with self.database.writing() as connection:
            if held(connection, lease) is None:
                return None
            connection.execute(unfinished(lease.job).values(status=Status.RUNNING, started_at=now()))
            return self._read(connection, experiments.select().where(experiments.c.id == lease.job))[0]

    def succeed(
        self,
        lease: Lease,
        outputs_: Sequence[Output],
        timings: Mapping[str, float],
        diagnostics: Mapping[str, Any],
        environment: Mapping[str, str],
    ) -> bool:
        job = lease.job
        with self.database.writing() as connection:
            if held(connection, lease) is None:
                return False
            changed = connection.execute(
                experiments.update()
                .where(experiments.c.id == job, experiments.c.status == Status.RUNNING)
                .values(
                    status=Status.SUCCEEDED,
                    timings=dict(timings),
                    diagnostics=dict(diagnostics),
                    environment=dict(environment),
                    finished_at=now(),
                )
            ).rowcount
            if changed:
                remove(connection, job)
            if changed and outputs_:
                connection.execute(
                    outputs.insert(), [output_row(job, place, output) for place, output in enumerate(outputs_)]
                )
        return bool(changed)

    def fail(self, lease: Lease, error: str, cause: str | None = None) -> bool:
        values: dict[str, Any] = {"status": Status.FAILED, "error": error, "finished_at": now()}
        with self.database.writing() as connection:
            row = held(connection, lease)
            if row is None:
                return False
            if cause is not None:
                values["charges"] = [*row.attempts, *attempt_values((Attempt(now(), cause),))]
            remove(connection, lease.job)
            return bool(connection.execute(unfinished(lease.job).values(values)).rowcount)

    def cancel(self, experiment_id: str) -> bool:
        with self.database.writing() as connection:
            remove(connection, experiment_id)
            change = unfinished(experiment_id).values(status=Status.CANCELLED, finished_at=now())
            return bool(connection.execute(change).rowcount)

    def add_output(self, lease: Lease, output: Output) -> bool:
        experiment_id = lease.job.partition(DEEP)[0]
        with self.database.writing() as connection:
            if held(connection, lease) is None:
                return False
            status = connection.scalar(
                sa.select(experiments.c.status).where(experiments.c.id == experiment_id).with_for_update()
            )
            if status != Status.SUCCEEDED:
                raise ConflictError("Only an experiment that succeeded has outputs.")
            mine = outputs.c.experiment == experiment_id
            connection.execute(outputs.delete().where(mine, outputs.c.name == output.name))
            place = connection.scalar(sa.select(sa.func.coalesce(sa.func.max(outputs.c.place) + 1, 0)).where(mine))
            connection.execute(outputs.insert().values(output_row(experiment_id, place or 0, output)))
        return True

    def set_listed(self, experiment_id: str, listed: bool) -> None:
        with self.database.writing() as connection:
            changed = connection.execute(
                experiments.update().where(experiments.c.id == experiment_id).values(listed=listed)
            ).rowcount
        if not changed:
            self.get(experiment_id)

    def delete(self, experiment_id: str) -> None:
        with self.database.writing() as connection:
            remove_with_deep(connection, experiment_id)
            transient = connection.scalar(
                experiments.delete().where(experiments.c.id == experiment_id).returning(experiments.c.transient)
            )
            if transient is False:
                connection.execute(deleted.insert().values(id=experiment_id))

    def finished_before(self, moment: datetime, *, unlisted: bool = False) -> list[str]:
        query = sa.select(experiments.c.id).where(experiments.c.finished_at < moment)
        return self._ids(query.where(~experiments.c.listed) if unlisted else query)

    def transient_before(self, moment: datetime) -> list[str]:
        return self._ids(sa.select(experiments.c.id).where(experiments.c.transient, experiments.c.created_at < moment))

    def used(self, digests: Collection[str]) -> set[str]:
        unread, found = list(digests), set[str]()
        with self.database.reading() as connection:
            for start in range(0, len(unread), BATCH):
                batch = unread[start : start + BATCH]
                for table in (samples, outputs):
                    found.update(connection.scalars(sa.select(table.c.digest).where(table.c.digest.in_(batch))))
        return found

    def counts(self) -> Mapping[str, int]:
        query = sa.select(experiments.c.status, sa.func.count()).group_by(experiments.c.status)
        with self.database.reading() as connection:
            found = {row[0]: row[1] for row in connection.execute(query)}
        return {status.value: found.get(status.value, 0) for status in Status}

    # shared parts

    def _insert(self, connection: Connection, experiment: Experiment, client: str) -> None:
        connection.execute(experiments.insert().values(row_of_experiment(experiment)))
        connection.execute(inputs.insert(), input_rows(experiment))
        if not experiment.status.finished:
            put(connection, experiment.id, client)

    def _ids(self, query: sa.Select[tuple[str]]) -> list[str]:
        with self.database.reading() as connection:
            return list(connection.scalars(query))

    def _read(self, connection: Connection, query: sa.Select[Any]) -> list[Experiment]:
        rows = connection.execute(query).all()
        ids = [row.id for row in rows]
        if not ids:
            return []
        parts = [
            connection.execute(table.select().where(table.c.experiment.in_(ids)).order_by(table.c.place)).all()
            for table in (inputs, outputs)
        ]
        return experiments_of(rows, *parts)


def _text(value: str) -> str:
    """Itself, or "" for what no database takes as text: control characters and halves of surrogate pairs."""
    return value if value.isprintable() else ""
