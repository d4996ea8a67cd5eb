"""The schema: what the tables demand, and what they are looked up by."""

from typing import Any

import pytest
import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from app.store import schema
from app.store.rows import input_rows, output_row, row_of_experiment, row_of_sample
from app.store.sql import SqlStore
from tests.store.records import START, a_sample, an_experiment, an_output

OPTIONAL = {
    ("samples", "title"),
    ("samples", "owner"),
    ("experiments", "error"),
    ("experiments", "started_at"),
    ("experiments", "finished_at"),
    *(("jobs", name) for name in ("holder", "stage", "started_at", "error", "failed_at")),
}
INDEXES = {
    "samples": {("digest",), ("created_at",)},
    "experiments": {("finished_at",), ("status", "listed", "created_at", "id")},
    "inputs": {("sample",)},
    "outputs": {("digest",)},
    "deleted": set(),
    "jobs": set(),
}
JOB = {"id": "job", "client": "someone", "queued_at": START, "fence": 7, "beat": 0, "fraction": 0.0, "attempts": []}
SAMPLE, EXPERIMENT = a_sample(), an_experiment(a_sample())
ROWS = {
    "samples": row_of_sample(SAMPLE, None),
    "experiments": row_of_experiment(EXPERIMENT),
    "inputs": input_rows(EXPERIMENT)[0] | {"sample": SAMPLE.id},
    "outputs": output_row(EXPERIMENT.id, 0, an_output()),
    "jobs": JOB,
}
REQUIRED = [
    (table.name, column.name)
    for table in schema.metadata.sorted_tables
    for column in table.columns
    if table.name in ROWS and (table.name, column.name) not in OPTIONAL
]


@pytest.mark.parametrize(("table", "column"), REQUIRED)
def test_a_row_without_a_required_value_is_refused(store: SqlStore, table: str, column: str) -> None:
    """By the database itself: no part of an experiment can be lost on the way to it."""
    with store.database.writing() as connection:
        connection.execute(schema.samples.insert().values(ROWS["samples"] | {"id": SAMPLE.id}))
        connection.execute(schema.experiments.insert().values(ROWS["experiments"]))
    row: dict[str, Any] = (
        {**ROWS[table], "id": "another"} if table in ("samples", "experiments", "jobs") else dict(ROWS[table])
    )
    with pytest.raises(IntegrityError, match=r"(?i)not.null"), store.database.writing() as connection:
        connection.execute(schema.metadata.tables[table].insert().values({**row, column: sa.null()}))


@pytest.mark.parametrize("table", INDEXES)
def test_what_is_looked_up_has_an_index(store: SqlStore, table: str) -> None:
    with store.database.reading() as connection:
        found = sa.inspect(connection).get_indexes(table)
    assert {tuple(index["column_names"]) for index in found} == INDEXES[table]
