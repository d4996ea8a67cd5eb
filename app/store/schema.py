"""Schema of the database: its tables and their upgrade."""

from datetime import UTC, datetime, timedelta

import sqlalchemy as sa
from sqlalchemy.engine import Connection, Dialect

from app.store.database import Database

SCHEMA_LOCK = 0x6D6963726F  # any constant: names the advisory lock that PostgreSQL's schema is made under
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


class Moment(sa.TypeDecorator[datetime]):
    """A UTC moment as whole microseconds since 1970: exact and ordered alike in every database."""

    impl = sa.BigInteger
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> int | None:
        return None if value is None else (value - EPOCH) // timedelta(microseconds=1)

    def process_result_value(self, value: int | None, dialect: Dialect) -> datetime | None:
        return None if value is None else EPOCH + timedelta(microseconds=value)


metadata = sa.MetaData()

samples = sa.Table(
    "samples",
    metadata,
    sa.Column("id", sa.Text, primary_key=True),
    sa.Column("digest", sa.Text, nullable=False, index=True),
    sa.Column("width", sa.Integer, nullable=False),
    sa.Column("height", sa.Integer, nullable=False),
    sa.Column("channels", sa.Integer, nullable=False),
    sa.Column("depth", sa.Integer, nullable=False),
    sa.Column("transparent", sa.Boolean, nullable=False),
    sa.Column("created_at", Moment, nullable=False, index=True),
    sa.Column("frames", sa.Integer, nullable=False),
    sa.Column("media_type", sa.Text, nullable=False),
    sa.Column("title", sa.Text),
    sa.Column("bundled", sa.Boolean, nullable=False),
    sa.Column("rate", sa.Float, nullable=False, server_default="0"),
    sa.Column("owner", sa.Text),
)

experiments = sa.Table(
    "experiments",
    metadata,
    sa.Column("id", sa.Text, primary_key=True),
    sa.Column("method", sa.Text, nullable=False),
    sa.Column("parameters", sa.JSON, nullable=False),
    sa.Column("listed", sa.Boolean, nullable=False),
    sa.Column("transient", sa.Boolean, nullable=False),
    sa.Column("owner", sa.Text, nullable=False),
    sa.Column("created_at", Moment, nullable=False),
    sa.Column("status", sa.Text, nullable=False),
    sa.Column("attempts", sa.JSON, nullable=False, server_default=sa.text("'[]'")),
    sa.Column("timings", sa.JSON, nullable=False),
    sa.Column("diagnostics", sa.JSON, nullable=False, server_default=sa.text("'{}'")),
    sa.Column("environment", sa.JSON, nullable=False, server_default=sa.text("'{}'")),
    sa.Column("error", sa.Text),
    sa.Column("started_at", Moment),
    sa.Column("finished_at", Moment, index=True),
    sa.Column("depth", sa.Integer, nullable=False, server_default="8"),
    sa.Column("wanted", sa.Text, nullable=False, server_default="texture"),
    sa.Index("experiments_by_age", "status", "listed", "created_at", "id"),
)

inputs = sa.Table(
    "inputs",
    metadata,
    sa.Column("experiment", sa.ForeignKey("experiments.id", ondelete="CASCADE"), primary_key=True),
    sa.Column("place", sa.Integer, primary_key=True, autoincrement=False),
    sa.Column("sample", sa.ForeignKey("samples.id"), nullable=False, index=True),
    sa.Column("x", sa.Integer, nullable=False),
    sa.Column("y", sa.Integer, nullable=False),
    sa.Column("width", sa.Integer, nullable=False),
    sa.Column("height", sa.Integer, nullable=False),
    sa.Column("first", sa.Integer, nullable=False, server_default="0"),
    sa.Column("count", sa.Integer, nullable=False, server_default="1"),
)

outputs = sa.Table(
    "outputs",
    metadata,
    sa.Column("experiment", sa.ForeignKey("experiments.id", ondelete="CASCADE"), primary_key=True),
    sa.Column("name", sa.Text, primary_key=True),
    sa.Column("place", sa.Integer, nullable=False),
    sa.Column("title", sa.Text, nullable=False),
    sa.Column("media_type", sa.Text, nullable=False),
    sa.Column("width", sa.Integer, nullable=False),
    sa.Column("height", sa.Integer, nullable=False),
    sa.Column("bytes", sa.BigInteger, nullable=False),
    sa.Column("digest", sa.Text, nullable=False, index=True),
    sa.Column("kind", sa.Text, nullable=False, server_default="view"),
    sa.Column("frames", sa.Integer, nullable=False, server_default="1"),
    sa.Column("rate", sa.Float, nullable=False, server_default="0"),
)

deleted = sa.Table("deleted", metadata, sa.Column("id", sa.Text, primary_key=True))


jobs = sa.Table(
    "jobs",
    metadata,
    sa.Column("id", sa.Text, primary_key=True),
    sa.Column("client", sa.Text, nullable=False),
    sa.Column("queued_at", Moment, nullable=False),
    sa.Column("fence", sa.BigInteger, nullable=False, server_default="0"),
    sa.Column("holder", sa.Text),
    sa.Column("beat", sa.BigInteger, nullable=False, server_default="0"),
    sa.Column("stage", sa.Text),
    sa.Column("fraction", sa.Float, nullable=False, server_default="0"),
    sa.Column("started_at", Moment),
    sa.Column("attempts", sa.JSON, nullable=False, server_default=sa.text("'[]'")),
    sa.Column("error", sa.Text),
    sa.Column("failed_at", Moment),
)


def make_schema(database: Database) -> None:
    """Make the schema, or bring that of an earlier version up to date; safe when several processes start at once."""
    with database.writing() as connection:
        if connection.dialect.name == "postgresql":
            connection.execute(sa.select(sa.func.pg_advisory_xact_lock(SCHEMA_LOCK)))
        without_jobs = not sa.inspect(connection).has_table("jobs")
        metadata.create_all(connection)
        _add_new_columns(connection)
        if without_jobs:
            columns = (experiments.c.id, experiments.c.owner, experiments.c.created_at)
            unfinished = sa.select(*columns).where(experiments.c.status.in_(("queued", "running")))
            connection.execute(jobs.insert().from_select(["id", "client", "queued_at"], unfinished))


def _add_new_columns(connection: Connection) -> None:
    """Bring the tables of an earlier version up to date: what was added since has a default for their rows."""
    counts = {column["name"]: column["type"] for column in sa.inspect(connection).get_columns("experiments")}
    if isinstance(counts.get("attempts"), sa.Integer):
        connection.execute(sa.text("ALTER TABLE experiments DROP COLUMN attempts"))
    known = sa.inspect(connection)
    for table in metadata.sorted_tables:
        present = {column["name"] for column in known.get_columns(table.name)}
        for column in table.columns:
            if column.name not in present:
                declared = sa.schema.CreateColumn(column).compile(dialect=connection.dialect)
                connection.execute(sa.text(f"ALTER TABLE {table.name} ADD COLUMN {declared}"))
                if column is outputs.c.kind:
                    main = outputs.c.name == "texture"
                    connection.execute(outputs.update().where(main).values(kind="texture"))
