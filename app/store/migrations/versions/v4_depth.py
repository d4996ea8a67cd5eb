"""Schema 4: bits per channel, and the output of a transient experiment."""

import sqlalchemy as sa
from alembic import op

revision, down_revision = "4", "3"


def upgrade() -> None:
    op.add_column("experiments", sa.Column("depth", sa.Integer, nullable=False, server_default="8"))
    op.add_column("experiments", sa.Column("wanted", sa.Text, nullable=False, server_default="texture"))


def downgrade() -> None:
    op.drop_column("experiments", "wanted")
    op.drop_column("experiments", "depth")
