"""Versions of the schema: brings a database to this program's, or back by one."""

from pathlib import Path

import sqlalchemy as sa
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.runtime.environment import EnvironmentContext
from alembic.script import ScriptDirectory
from sqlalchemy.engine import Connection

from app.errors import ConflictError
from app.store.database import Database

VERSION = 6  # of the schema: the newest of `migrations/versions`
LOCK = 0x6D6963726F  # any constant: names the advisory lock that PostgreSQL's schema is changed under
UPGRADE_SECONDS = 60.0  # how long a process waits for another one that upgrades
TABLE = "alembic_version"
MARKS = {  # of databases made before they had a version: the newest of these that is there
    5: ("experiments", "environment"),
    4: ("experiments", "wanted"),
    3: ("outputs", "rate"),
    2: ("outputs", "kind"),
    1: ("experiments", "id"),
}


def upgrade(database: Database) -> None:
    """Make the schema, or bring that of an earlier version up to date; safe when several processes start at once.

    Raises
    ------
    ConflictError
        If a newer version of this program made it.
    """
    if database.exists:
        with database.reading() as connection:
            if _version(connection) == VERSION:
                return
    with database.writing(UPGRADE_SECONDS) as connection:
        _lock(connection)
        _refuse_newer(_version(connection))
        if (found := _unversioned(connection)) is not None:
            context = MigrationContext.configure(connection)
            context.stamp(_scripts(), str(found))
        _run(connection, down=False)


def downgrade(database: Database) -> int:
    """Take the schema back by one version; the version it has then.

    Raises
    ------
    ConflictError
        If a newer version of this program made it.
    """
    with database.writing(UPGRADE_SECONDS) as connection:
        _lock(connection)
        _refuse_newer(_version(connection))
        _run(connection, down=True)
        return _version(connection) or 0


def _lock(connection: Connection) -> None:
    if connection.dialect.name == "postgresql":
        connection.execute(sa.select(sa.func.pg_advisory_xact_lock(LOCK)))


def _version(connection: Connection) -> int | None:
    if not sa.inspect(connection).has_table(TABLE):
        return None
    found = connection.scalar(sa.text(f"SELECT version_num FROM {TABLE}"))  # noqa: S608 # a constant
    return None if found is None else int(found)


def _refuse_newer(version: int | None) -> None:
    if version is not None and version > VERSION:
        raise ConflictError(
            f"Start the newer Microtexture that made this database, or restore a backup from before it: "
            f"the database has version {version}, and this program knows up to {VERSION}."
        )


def _unversioned(connection: Connection) -> int | None:
    """Recognise a database that was made before there were versions; None if it is empty or has one."""
    tables = sa.inspect(connection)
    if tables.has_table(TABLE) or not tables.has_table("experiments"):
        return None
    there = {(table, column["name"]) for table in ("experiments", "outputs") for column in tables.get_columns(table)}
    return next(version for version, mark in MARKS.items() if mark in there)


def _scripts() -> ScriptDirectory:
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations").replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    return ScriptDirectory.from_config(config)


def _run(connection: Connection, *, down: bool) -> None:
    scripts = _scripts()

    def steps(revision: object, context: MigrationContext) -> object:
        if down:
            return scripts._downgrade_revs("-1", revision)  # type: ignore[arg-type]
        return scripts._upgrade_revs("head", revision)  # type: ignore[arg-type]

    with EnvironmentContext(Config(), scripts, fn=steps) as environment:
        environment.configure(connection=connection)
        environment.run_migrations()
