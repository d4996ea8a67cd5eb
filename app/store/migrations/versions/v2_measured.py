"""Schema 2: measurements of experiments, and which outputs are textures."""

import sqlalchemy as sa
from alembic import op

revision, down_revision = "2", "1"


def upgrade() -> None:
    op.add_column("experiments", sa.Column("diagnostics", sa.JSON, nullable=False, server_default=sa.text("'{}'")))
    op.add_column("outputs", sa.Column("kind", sa.Text, nullable=False, server_default="view"))
    op.execute("UPDATE outputs SET kind = 'texture' WHERE name = 'texture'")


def downgrade() -> None:
    op.drop_column("outputs", "kind")
    op.drop_column("experiments", "diagnostics")
