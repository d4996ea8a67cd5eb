"""Connections: readers and writers apart, how long they wait, and what is said to be unavailable."""

import sqlite3
import time
from pathlib import Path
from typing import cast

import pytest
import sqlalchemy as sa

from app.store import database, schema
from app.store.database import Database
from app.store.sql import SqlStore


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
    database._set_up_writer(cast(sqlite3.Connection, connection), None)
    assert connection.executed == ["PRAGMA journal_mode=WAL", "PRAGMA synchronous=FULL", "PRAGMA foreign_keys=ON"]
    assert connection.isolation_level is None
    assert clock[0] == pytest.approx(100 + failures * 0.01)


def test_the_switch_to_wal_is_given_up_after_the_busy_time(clock: list[float]) -> None:
    with pytest.raises(sqlite3.OperationalError, match="locked"):
        database._set_up_writer(cast(sqlite3.Connection, Connection(float("inf"))), None)
    assert clock[0] - 100 == pytest.approx(database.WAIT_SECONDS, abs=0.02)


def test_a_writer_survives_a_power_cut_and_keeps_references(tmp_path: Path) -> None:
    store = Database(f"sqlite:///{tmp_path}/below/texture.sqlite3")
    with store.writing() as connection:
        found = [
            connection.exec_driver_sql(f"PRAGMA {name}").scalar()
            for name in ("journal_mode", "synchronous", "foreign_keys")
        ]
    store.close()
    assert found == ["wal", 2, 1]


def test_who_will_write_has_the_lock_from_the_beginning_and_who_reads_has_none(tmp_path: Path) -> None:
    """So a transaction cannot fail half-way, and what is read in one of them is of one moment."""
    path = tmp_path / "texture.sqlite3"
    store = SqlStore(f"sqlite:///{path}")
    other = sqlite3.connect(path, timeout=0, isolation_level=None)
    with store.database.writing(), pytest.raises(sqlite3.OperationalError, match="locked"):
        other.execute("BEGIN IMMEDIATE")
    count = sa.select(sa.func.count()).select_from(schema.deleted)
    with store.database.reading() as connection:
        assert connection.scalar(count) == 0
        other.execute("INSERT INTO deleted VALUES ('meanwhile')")
        assert connection.scalar(count) == 0
    with store.database.reading() as connection:
        assert connection.scalar(count) == 1
    other.close()
    store.close()
