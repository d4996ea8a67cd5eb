"""Copy of a database into another one: from SQLite to PostgreSQL, or back."""

import sqlalchemy as sa

from app.errors import ConflictError
from app.store.schema import metadata
from app.store.sql import SqlStore

ROWS = 500  # at a time


def copy_database(source: SqlStore, target: SqlStore) -> dict[str, int]:
    """Copy all rows in one transaction, of one moment; the number of rows of each table.

    Raises
    ------
    ConflictError
        If the target is not empty, or does not hold as many rows as were read; then nothing is copied.
    """
    copied = {}
    with source.database.reading() as old, target.database.writing() as new:
        for table in metadata.sorted_tables:
            if new.scalar(sa.select(sa.func.count()).select_from(table)):
                raise ConflictError("Choose a database that is empty: this one holds records already.")
        for table in metadata.sorted_tables:
            for rows in old.execute(table.select()).mappings().partitions(ROWS):
                new.execute(table.insert(), [dict(row) for row in rows])
            counts = [each.scalar(sa.select(sa.func.count()).select_from(table)) or 0 for each in (old, new)]
            if counts[0] != counts[1]:
                raise ConflictError(f"Try again: of {counts[0]} rows of {table.name} {counts[1]} arrived.")
            copied[table.name] = counts[1]
    return copied
