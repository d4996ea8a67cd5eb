"""Databases of every earlier version open, with their records as they were; those of a later one are refused.

`schemas` holds databases as earlier commits made them, the first store (8cff3b2) among them, with the same records.
"""

import sqlite3
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import psycopg
import pytest
import sqlalchemy as sa

from app.errors import ConflictError, DeletedError
from app.experiments.model import Status
from app.store import migrate, schema
from app.store.database import Database
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.records import a_sample, an_experiment, started

COMMITS = ("8cff3b2", "a290528", "9abed58", "c274880")


def load(commit: str, url: str) -> None:
    """Make an empty database the one that this commit made."""
    kind = sa.make_url(url).get_backend_name()
    dump = (Path(__file__).parent / "schemas" / f"{commit}.{kind}.sql").read_text("utf-8")
    if kind == "sqlite":
        connection = sqlite3.connect(sa.make_url(url).database or "")
        connection.executescript(dump)
        connection.close()
        return
    with psycopg.connect(url.replace("+psycopg", "")) as server:
        server.execute(dump.encode())


def columns(url: str) -> dict[str, list[tuple[str, str, bool]]]:
    engine = sa.create_engine(url)
    found = sa.inspect(engine)
    tables = {
        table: sorted((each["name"], str(each["type"]), bool(each["nullable"])) for each in found.get_columns(table))
        for table in found.get_table_names()
    }
    engine.dispose()
    return tables


@pytest.mark.parametrize("commit", COMMITS)
def test_a_database_of_an_earlier_version_opens_with_its_records(
    store_url: str, open_store: Callable[[], SqlStore], commit: str
) -> None:
    """What was unfinished waits in its order, counts of attempts have no causes, and of outputs the texture is one."""
    load(commit, store_url)
    for _ in range(2):
        store = open_store()
        made = store.get("made")
        assert (made.status, made.attempts, made.depth, made.wanted) == (Status.SUCCEEDED, (), 8, "texture")
        assert made.parameters == {"width": 64, "height": 32, "seed": 2**53 - 1, "σ": None}
        assert made.diagnostics == made.environment == {}
        assert [(each.name, each.kind, each.frames) for each in made.outputs] == [
            ("texture", "texture", 1),
            ("crop", "view", 1),
        ]
        assert (made.inputs[0].frames.first, made.inputs[0].frames.count) == (0, 1)
        assert [sample.id for sample in store.bundled_samples()] == ["gravel"]
        assert store.get("broke").error == "too large"
        assert store.counts() == {"queued": 2, "running": 0, "succeeded": 1, "failed": 1, "cancelled": 2}
        with pytest.raises(DeletedError, match="deleted"):
            store.get("gone")
        states = SqlQueue(store.database).states(["waits", "runs", "passing", "made"])
        assert {name: state.position for name, state in states.items()} == {"runs": 1, "waits": 2}
    queue = SqlQueue(store.database)
    lease = queue.lease("engine", alone=False)
    assert lease is not None
    assert store.start(lease) is not None
    assert store.succeed(lease, [], {}, {}, {})


@pytest.mark.parametrize("commit", COMMITS)
def test_the_upgraded_schema_is_the_new_one_and_goes_back_by_one_version(
    store_url: str, open_store: Callable[[], SqlStore], commit: str
) -> None:
    """Down to the one before the queue, in which what waits is queued; and up again."""
    load(commit, store_url)
    open_store().close()
    newest = columns(store_url)
    declared = {
        table.name: sorted((each.name, bool(each.nullable)) for each in table.columns)
        for table in schema.metadata.sorted_tables
    }
    assert {
        table: [(name, nullable) for name, _, nullable in found]
        for table, found in newest.items()
        if table != migrate.TABLE
    } == declared
    database = Database(store_url)
    assert migrate.downgrade(database) == migrate.VERSION - 1
    database.close()
    before = columns(store_url)
    assert "jobs" not in before
    assert "attempts" in {name for name, *_ in before["experiments"]}
    store = open_store()
    assert columns(store_url) == newest
    assert store.get("waits").status is Status.QUEUED
    assert SqlQueue(store.database).waiting() == 2


def test_attempts_become_their_number_when_the_schema_goes_back(
    store_url: str, open_store: Callable[[], SqlStore]
) -> None:
    store = open_store()
    sample = a_sample()
    store.add_sample(sample)
    experiment = an_experiment(sample)
    store.add(experiment)
    SqlQueue(store.database).release(started(store, experiment), "Its worker process died.")
    made = store.get(experiment.id)
    migrate.downgrade(store.database)
    with store.database.reading() as connection:
        count = connection.scalar(sa.text("SELECT attempts FROM experiments"))
    assert count == len(made.attempts) == 1


def test_a_new_database_has_the_types_of_an_upgraded_one(store_url: str, open_store: Callable[[], SqlStore]) -> None:
    open_store().close()
    fresh = columns(store_url)
    engine = sa.create_engine(store_url)
    with engine.begin() as connection:
        connection.execute(sa.text(f"DROP TABLE {migrate.TABLE}"))
        schema.metadata.drop_all(connection)
    engine.dispose()
    load("8cff3b2", store_url)
    open_store().close()
    assert columns(store_url) == fresh


def test_a_database_of_a_newer_version_is_refused_and_left_as_it_is(
    store_url: str, open_store: Callable[[], SqlStore]
) -> None:
    store = open_store()
    newer = migrate.VERSION + 1
    with store.database.writing() as connection:
        connection.execute(sa.text(f"UPDATE {migrate.TABLE} SET version_num = '{newer}'"))
    before = columns(store_url)
    for refused in (open_store, lambda: migrate.downgrade(store.database)):
        with pytest.raises(ConflictError, match=rf"Start the newer Microtexture .* the database has version {newer}"):
            refused()
    assert columns(store_url) == before


def test_several_processes_may_upgrade_at_once(store_url: str) -> None:
    load("8cff3b2", store_url)
    with ThreadPoolExecutor(6) as pool:
        stores = list(pool.map(lambda _: SqlStore(store_url), range(6)))
    for each in stores:
        assert SqlQueue(each.database).waiting() == 2
        each.close()


def test_the_program_knows_its_newest_version() -> None:
    assert migrate._scripts().get_current_head() == str(migrate.VERSION)
