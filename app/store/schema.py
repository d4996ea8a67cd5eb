"""Schema of the database: its tables, as the newest of `migrations/versions` leaves them."""

from datetime import UTC, datetime, timedelta

import sqlalchemy as sa
from sqlalchemy.engine import Dialect

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
    sa.Column("charges", sa.JSON, nullable=False, server_default=sa.text("'[]'")),
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
