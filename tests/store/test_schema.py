"""The schema: what the tables demand, what they are looked up by, and how a connection to SQLite is set up."""

import sqlite3
import time
from pathlib import Path
from typing import Any, cast

import pytest
import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from app.store import schema
from app.store.rows import input_rows, output_row, row_of_experiment, row_of_sample
from app.store.sql import SqlStore
from tests.store.records import a_sample, an_experiment, an_output

OPTIONAL = {
    ("samples", "title"),
    ("samples", "owner"),
    ("experiments", "error"),
    ("experiments", "started_at"),
    ("experiments", "finished_at"),
}
INDEXES = {
    "samples": {("digest",), ("created_at",)},
    "experiments": {("finished_at",), ("status", "listed", "created_at", "id")},
    "inputs": {("sample",)},
    "outputs": {("digest",)},
    "deleted": set(),
}
SAMPLE, EXPERIMENT = a_sample(), an_experiment(a_sample())
ROWS = {
    "samples": row_of_sample(SAMPLE, None),
    "experiments": row_of_experiment(EXPERIMENT),
    "inputs": input_rows(EXPERIMENT)[0] | {"sample": SAMPLE.id},
    "outputs": output_row(EXPERIMENT.id, 0, an_output()),
}
REQUIRED = [
    (table.name, column.name)
    for table in schema.metadata.sorted_tables
    for column in table.columns
    if table.name in ROWS and (table.name, column.name) not in OPTIONAL
]


@pytest.fixture
def engine(store: SqlStore) -> sa.Engine:
    return store._engine


@pytest.mark.parametrize(("table", "column"), REQUIRED)
def test_a_row_without_a_required_value_is_refused(engine: sa.Engine, table: str, column: str) -> None:
    """By the database itself: no part of an experiment can be lost on the way to it."""
    with schema.writing(engine) as connection:
        connection.execute(schema.samples.insert().values(ROWS["samples"] | {"id": SAMPLE.id}))
        connection.execute(schema.experiments.insert().values(ROWS["experiments"]))
    row: dict[str, Any] = {**ROWS[table], "id": "another"} if table in ("samples", "experiments") else dict(ROWS[table])
    with pytest.raises(IntegrityError, match=r"(?i)not.null"), schema.writing(engine) as connection:
        connection.execute(schema.metadata.tables[table].insert().values({**row, column: sa.null()}))


@pytest.mark.parametrize("table", INDEXES)
def test_what_is_looked_up_has_an_index(engine: sa.Engine, table: str) -> None:
    found = sa.inspect(engine).get_indexes(table)
    assert {tuple(index["column_names"]) for index in found} == INDEXES[table]


class Connection:
    """A connection of sqlite3 whose switch to WAL fails so often."""

    def __init__(self, failures: float) -> None:
        self.failures = failures
        self.isolation_level: str | None = ""
        self.executed: list[str] = []

    def execute(self, statement: str) -> None:
        if statement.endswith("WAL") and self.failures > 0:
            self.failures -= 1
            raise sqlite3.OperationalError("database is locked")
        self.executed.append(statement)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock that only sleeping moves; the list holds its time."""
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    monkeypatch.setattr(time, "sleep", lambda seconds: now.__setitem__(0, now[0] + seconds))
    return now


@pytest.mark.parametrize("failures", [0, 1, 200])
def test_the_switch_to_wal_is_tried_until_no_other_process_attempts_it(clock: list[float], failures: int) -> None:
    connection = Connection(failures)
    schema._set_up_sqlite(cast(sqlite3.Connection, connection), None)
    assert connection.executed == ["PRAGMA journal_mode=WAL", "PRAGMA synchronous=FULL", "PRAGMA foreign_keys=ON"]
    assert connection.isolation_level is None
    assert clock[0] == pytest.approx(100 + failures * 0.01)


def test_the_switch_to_wal_is_given_up_after_the_busy_time(clock: list[float]) -> None:
    with pytest.raises(sqlite3.OperationalError, match="locked"):
        schema._set_up_sqlite(cast(sqlite3.Connection, Connection(float("inf"))), None)
    assert clock[0] - 100 == pytest.approx(schema.BUSY_SECONDS, abs=0.02)


def test_a_connection_survives_a_power_cut_and_keeps_references(tmp_path: Path) -> None:
    engine = schema.connect(f"sqlite:///{tmp_path}/below/texture.sqlite3")
    with engine.begin() as connection:
        found = [
            connection.exec_driver_sql(f"PRAGMA {name}").scalar()
            for name in ("journal_mode", "synchronous", "foreign_keys")
        ]
    engine.dispose()
    assert found == ["wal", 2, 1]


def test_who_will_write_has_the_lock_from_the_beginning_and_who_reads_has_none(tmp_path: Path) -> None:
    """So a transaction cannot fail half-way, and what is read in one of them is of one moment."""
    path = tmp_path / "texture.sqlite3"
    engine = schema.connect(f"sqlite:///{path}")
    other = sqlite3.connect(path, timeout=0, isolation_level=None)
    with schema.writing(engine), pytest.raises(sqlite3.OperationalError, match="locked"):
        other.execute("BEGIN IMMEDIATE")
    with engine.begin() as connection:
        count = sa.select(sa.func.count()).select_from(schema.deleted)
        assert connection.scalar(count) == 0
        other.execute("INSERT INTO deleted VALUES ('meanwhile')")
        assert connection.scalar(count) == 0
    with engine.begin() as connection:
        assert connection.scalar(count) == 1
    other.close()
    engine.dispose()
