"""Schema 3: frames and rates of videos."""

import sqlalchemy as sa
from alembic import op

revision, down_revision = "3", "2"


def upgrade() -> None:
    op.add_column("samples", sa.Column("rate", sa.Float, nullable=False, server_default="0"))
    op.add_column("inputs", sa.Column("first", sa.Integer, nullable=False, server_default="0"))
    op.add_column("inputs", sa.Column("count", sa.Integer, nullable=False, server_default="1"))
    op.add_column("outputs", sa.Column("frames", sa.Integer, nullable=False, server_default="1"))
    op.add_column("outputs", sa.Column("rate", sa.Float, nullable=False, server_default="0"))


def downgrade() -> None:
    op.drop_column("outputs", "rate")
    op.drop_column("outputs", "frames")
    op.drop_column("inputs", "count")
    op.drop_column("inputs", "first")
    op.drop_column("samples", "rate")
