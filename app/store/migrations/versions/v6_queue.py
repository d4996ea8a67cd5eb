"""Schema 6: the job queue, and attempts with their causes.

The list has another name than the count of earlier versions, which would write numbers into it.
"""

import sqlalchemy as sa
from alembic import op

revision, down_revision = "6", "5"


def upgrade() -> None:
    op.create_table(
        "jobs",
        sa.Column("id", sa.Text, primary_key=True),
        sa.Column("client", sa.Text, nullable=False),
        sa.Column("queued_at", sa.BigInteger, nullable=False),
        sa.Column("fence", sa.BigInteger, nullable=False, server_default="0"),
        sa.Column("holder", sa.Text),
        sa.Column("beat", sa.BigInteger, nullable=False, server_default="0"),
        sa.Column("stage", sa.Text),
        sa.Column("fraction", sa.Float, nullable=False, server_default="0"),
        sa.Column("started_at", sa.BigInteger),
        sa.Column("attempts", sa.JSON, nullable=False, server_default=sa.text("'[]'")),
        sa.Column("error", sa.Text),
        sa.Column("failed_at", sa.BigInteger),
    )
    op.add_column("experiments", sa.Column("charges", sa.JSON, nullable=False, server_default=sa.text("'[]'")))
    op.drop_column("experiments", "attempts")
    # Nobody waits any more for what was made for one answer.
    op.execute(
        "UPDATE experiments SET status = 'cancelled', finished_at = created_at"
        " WHERE status IN ('queued', 'running') AND transient"
    )
    op.execute("UPDATE experiments SET status = 'queued', started_at = NULL WHERE status = 'running'")
    op.execute(
        "INSERT INTO jobs (id, client, queued_at) SELECT id, owner, created_at FROM experiments WHERE status = 'queued'"
    )


def downgrade() -> None:
    op.add_column("experiments", sa.Column("attempts", sa.Integer, nullable=False, server_default="0"))
    op.execute("UPDATE experiments SET attempts = json_array_length(charges)")
    op.drop_column("experiments", "charges")
    op.drop_table("jobs")
