"""Connections to the database: readers and writers apart, and what makes it unavailable."""

import logging
import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import sqlalchemy as sa
from sqlalchemy.engine import URL, Connection, Engine
from sqlalchemy.exc import DBAPIError, InterfaceError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from app.errors import DATABASE, InvalidInputError, UnavailableError

log = logging.getLogger(__name__)

WAIT_SECONDS = 5.0  # how long anybody waits for a connection, for the writer's turn, or for a lock
READERS = 40  # connections of one process that read: as many as its web has threads
WRITERS = 10  # of PostgreSQL; SQLite has one writer
READ_ONLY = "25006"  # PostgreSQL's code for a server that has become a stand-by
DRIVERS = {"sqlite": "sqlite", "postgresql": "postgresql+psycopg"}


class Database:
    """A database whose readers never wait for its writers.

    Reading transactions see one moment: a snapshot. Writing ones wait for one another for a few seconds at most.
    Whatever keeps a transaction from the database for now is raised as `UnavailableError`; mistakes and conflicts are
    not.

    Parameters
    ----------
    url : str
        ``sqlite:///path`` or ``postgresql+psycopg://…``.

    Raises
    ------
    InvalidInputError
        If it is no such address.
    """

    def __init__(self, url: str) -> None:
        parsed = parse_url(url)
        self.sqlite = parsed.get_backend_name() == "sqlite"
        self._path: Path | None = None
        if self.sqlite:
            self._path = path = Path(parsed.database or "").resolve()
            path.parent.mkdir(parents=True, exist_ok=True)
            self._turn: threading.Lock | None = _turn_of(str(path))
            there = (
                f"{path.as_uri()}?mode=rw"  # a reader makes no file: one that was taken away is unavailable, not empty
            )
            self._writers = sa.create_engine(
                parsed,
                connect_args={"timeout": WAIT_SECONDS},
                pool_size=1,
                max_overflow=0,
                pool_timeout=WAIT_SECONDS,
            )
            self._readers = sa.create_engine(
                parsed,
                creator=lambda: sqlite3.connect(there, timeout=WAIT_SECONDS, uri=True, check_same_thread=False),
                pool_size=READERS,
                max_overflow=0,
                pool_timeout=WAIT_SECONDS,
            )
            sa.event.listen(self._writers, "connect", _set_up_writer)
            sa.event.listen(self._readers, "connect", _set_up_reader)
            sa.event.listen(self._readers, "begin", _begin_reading)
        else:
            self._turn = None
            self._writers = _postgresql(parsed, WRITERS)
            self._readers = _postgresql(parsed, READERS, isolation_level="REPEATABLE READ").execution_options(
                postgresql_readonly=True
            )

    @property
    def exists(self) -> bool:
        """Whether there is a database to read; of SQLite, its file."""
        return self._path is None or self._path.is_file()

    def close(self) -> None:
        self._writers.dispose()
        self._readers.dispose()

    def ping(self) -> None:
        """Try whether one could write now.

        Raises
        ------
        UnavailableError
            If not, or not within a few seconds.
        """
        with self.writing() as connection:
            connection.exec_driver_sql("SELECT 1")

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """Begin a transaction that reads, from one moment."""
        with _available(), self._readers.begin() as connection:
            yield connection

    @contextmanager
    def writing(self, seconds: float | None = None) -> Iterator[Connection]:
        """Begin a transaction that writes: on SQLite with the write lock, so that it cannot fail half-way.

        Parameters
        ----------
        seconds : float, optional
            How long to wait for other writers instead of `WAIT_SECONDS`.
        """
        wait = seconds or WAIT_SECONDS
        deadline = time.monotonic() + wait
        with self._my_turn(wait), _available(), self._writers.begin() as connection:
            left = max(0, int((deadline - time.monotonic()) * 1000))
            if self.sqlite:
                connection.exec_driver_sql(f"PRAGMA busy_timeout={left}")
                connection.exec_driver_sql("BEGIN IMMEDIATE")
            else:
                connection.exec_driver_sql(f"SET LOCAL lock_timeout={left or 1}")  # 0 would be for ever
            yield connection

    @contextmanager
    def _my_turn(self, wait: float) -> Iterator[None]:
        """Wait for the other writers of this process, before taking a connection that others might need."""
        if self._turn is None:
            yield
            return
        if not self._turn.acquire(timeout=wait):
            raise _unavailable("other writers did not end in time")
        try:
            yield
        finally:
            self._turn.release()


def parse_url(url: str) -> URL:
    """Read the address of a database.

    Raises
    ------
    InvalidInputError
        If it is none of SQLite or PostgreSQL; the message does not repeat it, for it may hold a password.
    """
    advice = "Write the database's address as sqlite:///path or postgresql+psycopg://user:password@host/name"
    try:
        parsed = sa.make_url(url)
        parsed.get_dialect()
    except (sa.exc.ArgumentError, ValueError, ImportError):
        raise InvalidInputError(f"{advice}.") from None
    if parsed.get_backend_name() not in DRIVERS:
        raise InvalidInputError(f"{advice}; this one is of {parsed.get_backend_name()}.")
    if parsed.get_backend_name() == "sqlite" and parsed.database in (None, "", ":memory:"):
        raise InvalidInputError(f"{advice}. One in memory is lost with the process.")
    return parsed.set(drivername=DRIVERS[parsed.get_backend_name()])


def is_unavailable(error: sa.exc.SQLAlchemyError) -> bool:
    """Whether an error says that the database cannot be reached for now: not a mistake of ours, not a conflict."""
    if isinstance(error, PoolTimeoutError):
        return True
    if not isinstance(error, DBAPIError):
        return False
    # To sqlite3 a table that is not there is "operational", too; the code of such mistakes tells them apart.
    mistake = getattr(error.orig, "sqlite_errorcode", None) == sqlite3.SQLITE_ERROR
    operational = isinstance(error, OperationalError | InterfaceError) and not mistake
    return operational or error.connection_invalidated or getattr(error.orig, "sqlstate", None) == READ_ONLY


@contextmanager
def _available() -> Iterator[None]:
    try:
        yield
    except sa.exc.SQLAlchemyError as error:
        if not is_unavailable(error):
            raise
        reason = getattr(error, "orig", None) or error
        raise _unavailable(str(reason)) from reason


def _unavailable(reason: str) -> UnavailableError:
    log.warning("the database is unavailable: %s", reason.strip().partition("\n")[0])
    return UnavailableError(DATABASE, "Try again in a minute: the database cannot be used at the moment.")


@cache
def _turn_of(path: str) -> threading.Lock:
    """The turn of the writers of one file, however often this process opened it."""
    return threading.Lock()


def _postgresql(url: URL, connections: int, **options: str) -> Engine:
    arguments = {"connect_timeout": "5", "keepalives_idle": "10", "tcp_user_timeout": "10000"}
    return sa.create_engine(
        url,
        connect_args={name: value for name, value in arguments.items() if name not in url.query},
        pool_pre_ping=True,
        pool_size=5,
        max_overflow=connections - 5,
        pool_timeout=WAIT_SECONDS,
        **options,
    )


def _set_up_writer(connection: sqlite3.Connection, record: object) -> None:
    connection.isolation_level = None  # the driver must not open transactions of its own: `writing` does
    deadline = time.monotonic() + WAIT_SECONDS
    while True:  # the switch to WAL ignores the busy timeout when several processes attempt it at once
        try:
            connection.execute("PRAGMA journal_mode=WAL")
            break
        except sqlite3.OperationalError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.01)
    connection.execute("PRAGMA synchronous=FULL")  # what was accepted survives a power cut too
    connection.execute("PRAGMA foreign_keys=ON")


def _set_up_reader(connection: sqlite3.Connection, record: object) -> None:
    connection.isolation_level = None
    connection.execute("PRAGMA query_only=ON")


def _begin_reading(connection: Connection) -> None:
    connection.exec_driver_sql("BEGIN")
