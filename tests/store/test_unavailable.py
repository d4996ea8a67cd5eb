"""A database that is away, locked or full is unavailable, and is used again once it is back; mistakes are not that."""

import sqlite3
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from pathlib import Path

import psycopg
import pytest
import sqlalchemy as sa

from app.errors import DATABASE, InvalidInputError, NotFoundError, UnavailableError
from app.experiments.model import Lease, Sample, Status
from app.settings import Settings
from app.store import database
from app.store.database import Database
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.records import START, a_sample, an_experiment, an_output

LEASE = Lease("experiment", 1)
READS: dict[str, Callable[[SqlStore, SqlQueue], object]] = {
    "get": lambda store, queue: store.get("nothing"),
    "page": lambda store, queue: store.page(limit=3),
    "used": lambda store, queue: store.used(["0"]),
    "counts": lambda store, queue: store.counts(),
    "bundled": lambda store, queue: store.bundled_samples(),
    "old": lambda store, queue: store.finished_before(START),
    "holds": lambda store, queue: queue.holds(LEASE),
    "states": lambda store, queue: queue.states(["nothing"]),
    "beats": lambda store, queue: queue.beats(),
    "waiting": lambda store, queue: queue.waiting(),
    "leases": lambda store, queue: queue.leased_by("engine"),
}
WRITES: dict[str, Callable[[SqlStore, SqlQueue], object]] = {
    "ping": lambda store, queue: store.ping(),
    "sample": lambda store, queue: store.add_sample(a_sample()),
    "start": lambda store, queue: store.start(LEASE),
    "succeed": lambda store, queue: store.succeed(LEASE, [an_output()], {}, {}, {}),
    "fail": lambda store, queue: store.fail(LEASE, "a reason"),
    "output": lambda store, queue: store.add_output(LEASE, an_output()),
    "cancel": lambda store, queue: store.cancel("nothing"),
    "delete": lambda store, queue: store.delete("nothing"),
    "enqueue": lambda store, queue: queue.enqueue("a@16:texture", "ann"),
    "lease": lambda store, queue: queue.lease("engine", alone=True),
    "renew": lambda store, queue: queue.renew(LEASE, None, 0),
    "release": lambda store, queue: queue.release(LEASE),
    "lapse": lambda store, queue: queue.lapse("experiment", 1, 0),
}


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give up after half a second, not after five."""
    monkeypatch.setattr(database, "WAIT_SECONDS", 0.5)


@contextmanager
def locked(store_url: str) -> Iterator[None]:
    """Let another process write to an SQLite database, without an end."""
    other = sqlite3.connect(sa.make_url(store_url).database or "", isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    try:
        yield
    finally:
        other.close()


def test_a_server_that_is_away_is_unavailable_and_used_again_when_it_is_back(
    request: pytest.FixtureRequest, postgresql_server: str
) -> None:
    """Its connections are cut and new ones refused, as while it restarts."""
    server, name = postgresql_server.replace("+psycopg", ""), f"texture_{id(request)}"
    with psycopg.connect(f"{server}/postgres", autocommit=True) as operator:
        operator.execute(f'CREATE DATABASE "{name}"')
        store = SqlStore(f"{postgresql_server}/{name}")
        queue = SqlQueue(store.database)
        store.counts()
        operator.execute(f'ALTER DATABASE "{name}" ALLOW_CONNECTIONS false')
        operator.execute("SELECT pg_terminate_backend(pid, 5000) FROM pg_stat_activity WHERE datname = %s", [name])
        for call in (READS | WRITES).values():
            with pytest.raises(UnavailableError, match="database") as away:
                call(store, queue)
            assert away.value.part == DATABASE
            assert "texture" not in away.value.message
        operator.execute(f'ALTER DATABASE "{name}" ALLOW_CONNECTIONS true')
    store.ping()
    assert queue.waiting() == 0
    store.close()


def test_while_another_process_holds_the_write_lock_writers_give_up_and_readers_answer_at_once(tmp_path: Path) -> None:
    """However many writers wait: they wait for one another, not with the connections of the readers."""
    url = f"sqlite:///{tmp_path}/texture.sqlite3"
    store = SqlStore(url)
    queue, waiting = SqlQueue(store.database), threading.Semaphore(0)

    def write(number: int) -> bool:
        waiting.release()
        with pytest.raises(UnavailableError, match="database"):
            list(WRITES.values())[number % len(WRITES)](store, queue)
        return True

    with locked(url), ThreadPoolExecutor(60) as pool:
        writers = pool.map(write, range(60))
        for _ in range(60):
            waiting.acquire()
        for read in READS.values():
            begun = time.monotonic()
            with suppress(NotFoundError):
                read(store, queue)
            assert time.monotonic() - begun < 0.4  # sooner than the first writer gives up
        assert all(writers)
    store.ping()
    store.close()


def test_a_full_disk_is_unavailable_and_loses_nothing(tmp_path: Path) -> None:
    store = SqlStore(f"sqlite:///{tmp_path}/texture.sqlite3")
    sample = a_sample()
    store.add_sample(sample)
    with store.database.writing() as connection:
        connection.exec_driver_sql("PRAGMA max_page_count=1")  # it goes as low as what is there

    def fill() -> None:
        for _ in range(500):
            store.add(an_experiment(sample))

    with pytest.raises(UnavailableError, match="database"):
        fill()
    kept = store.counts()["queued"]
    assert kept == SqlQueue(store.database).waiting()
    with store.database.writing() as connection:
        connection.exec_driver_sql("PRAGMA max_page_count=100000")
    store.add(an_experiment(sample))
    assert store.counts()["queued"] == kept + 1
    store.close()


def test_a_database_that_was_taken_away_is_not_an_empty_one(tmp_path: Path) -> None:
    path = tmp_path / "texture.sqlite3"
    store = SqlStore(f"sqlite:///{path}")
    store.database._readers.dispose()
    path.rename(tmp_path / "elsewhere")
    with pytest.raises(UnavailableError, match="database"):
        store.counts()
    assert not path.exists()
    store.close()


def test_a_lock_on_a_row_is_waited_for_no_longer_than_on_a_file(
    store: SqlStore, sample: Sample, open_store: Callable[[], SqlStore]
) -> None:
    experiment, other = an_experiment(sample), open_store()
    store.add(experiment)
    with store.database.writing() as connection:
        connection.execute(sa.text("UPDATE experiments SET listed = NOT listed"))
        begun = time.monotonic()
        with pytest.raises(UnavailableError, match="database"):
            other.set_listed(experiment.id, False)
        assert time.monotonic() - begun < 4
    other.set_listed(experiment.id, False)


def test_a_mistake_in_a_statement_is_not_unavailable(store: SqlStore) -> None:
    with pytest.raises(sa.exc.DBAPIError) as mistake, store.database.reading() as connection:
        connection.execute(sa.text("SELECT nothing FROM nowhere"))
    assert not database.is_unavailable(mistake.value)


def test_records_are_of_one_moment_whatever_writers_do_beside(
    store: SqlStore, sample: Sample, open_store: Callable[[], SqlStore]
) -> None:
    """A success has its outputs, whatever is read has its inputs, and what is not finished has no outputs."""
    queue, ended, torn, seen = SqlQueue(store.database), threading.Event(), list[str](), list[str]()

    def read(reader: SqlStore) -> None:
        while not ended.is_set():
            for found in reader.page(limit=50).experiments:
                seen.append(found.id)
                if not found.inputs or len(found.outputs) != 2 or found.status is not Status.SUCCEEDED:
                    torn.append(f"{found.status}: {len(found.inputs)} inputs, {len(found.outputs)} outputs")

    with ThreadPoolExecutor(3) as pool:
        readers = [pool.submit(read, open_store()) for _ in range(3)]
        try:
            for _ in range(40):
                experiment = an_experiment(sample)
                store.add(experiment)
                lease = queue.lease("engine", alone=True)
                assert lease is not None
                assert store.start(lease) is not None
                assert store.succeed(lease, [an_output(), an_output("crop")], {}, {}, {})
                store.delete(experiment.id)
        finally:
            ended.set()
        for reader in readers:
            reader.result()
    assert seen
    assert torn == []


@pytest.mark.parametrize(
    "url",
    [
        "postgresql+psycopg://someone:swordfish:host/name",
        "postgres://someone:swordfish@host/name",
        "mysql://someone:swordfish@host/name",
        "nonsense swordfish",
        "sqlite://",
        "",
    ],
)
def test_a_mistyped_address_is_refused_without_its_password(url: str) -> None:
    with pytest.raises(InvalidInputError, match=r"^Write the database's address as sqlite:///path or ") as refused:
        Database(url)
    assert "swordfish" not in str(refused.value)


@pytest.mark.parametrize("name", ["what?x", "100%20", "a#b", "ä b"])
def test_a_data_directory_may_have_any_name(tmp_path: Path, name: str) -> None:
    settings = Settings(data_dir=tmp_path / name)
    SqlStore(settings.sql_url).close()
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name / "microtexture.sqlite3").is_file()


def test_settings_show_no_password() -> None:
    settings = Settings(database_url="postgresql+psycopg://someone:swordfish@host/name")
    assert "swordfish" not in repr(settings) + str(settings.model_dump())
    assert settings.sql_url.startswith("postgresql+psycopg://someone:swordfish@")
