"""A database of an earlier version opens, with its experiments as they were."""

from collections.abc import Callable
from datetime import UTC, datetime

import pytest
import sqlalchemy as sa

from app.experiments.model import Experiment, ExperimentInput, Output, Sample
from app.images.crop import Rectangle
from app.store import schema
from app.store.sql import SqlStore

START = datetime(2026, 3, 1, 12, tzinfo=UTC)


def test_a_database_without_the_newer_columns_gets_them(store_url: str, open_store: Callable[[], SqlStore]) -> None:
    """Diagnostics are empty, and of the outputs the texture alone is known to be one."""
    store = open_store()
    store.add_sample(Sample(640, 427, 3, 8, False, id="sample", digest="0" * 64, created_at=START))
    inputs = (ExperimentInput("sample", Rectangle(1, 2, 30, 40)),)
    store.add(Experiment("old", "rpn", inputs, {"seed": 1}, True, "owner", START))
    store.start("old")
    outputs = [Output(name, name, 64, 32, bytes=9, digest=name * 8) for name in ("texture", "crop")]
    store.succeed("old", outputs, {}, {}, {})
    engine = sa.create_engine(store_url)
    with engine.begin() as connection:
        connection.execute(sa.text("ALTER TABLE experiments DROP COLUMN diagnostics"))
        connection.execute(sa.text("ALTER TABLE experiments DROP COLUMN environment"))
        connection.execute(sa.text("ALTER TABLE outputs DROP COLUMN kind"))
    engine.dispose()

    upgraded = open_store().get("old")

    assert upgraded.diagnostics == upgraded.environment == {}
    assert [(output.name, output.kind) for output in upgraded.outputs] == [("texture", "texture"), ("crop", "view")]
    assert open_store().get("old") == upgraded


LATER = [
    (table, column)
    for table in (schema.samples, schema.experiments, schema.inputs, schema.outputs)
    for column in table.columns
    if column.server_default is not None and column.name != "attempts"
]
SAMPLE = Sample(640, 427, 3, 8, False, id="sample", digest="0" * 64, created_at=START)
INPUT = ExperimentInput("sample", Rectangle(1, 2, 30, 40))
OUTPUT = Output("texture", "Texture", 64, 32, bytes=9, digest="1" * 64, kind="texture")


@pytest.mark.parametrize(("table", "column"), LATER, ids=lambda each: each.name)
def test_every_column_that_was_added_later_has_the_value_that_it_stands_for(
    store_url: str, open_store: Callable[[], SqlStore], table: sa.Table, column: sa.Column[object]
) -> None:
    """Of a record in which it is what earlier versions meant: a still picture of 8 bits, nothing measured."""
    store = open_store()
    store.add_sample(SAMPLE)
    store.add(Experiment("old", "rpn", (INPUT,), {"seed": 1}, True, "owner", START))
    store.start("old")
    store.succeed("old", [OUTPUT], {}, {}, {})
    before = (store.sample("sample"), store.get("old"))
    engine = sa.create_engine(store_url)
    with engine.begin() as connection:
        connection.execute(sa.text(f"ALTER TABLE {table.name} DROP COLUMN {column.name}"))
    engine.dispose()
    upgraded = open_store()
    assert (upgraded.sample("sample"), upgraded.get("old")) == before
