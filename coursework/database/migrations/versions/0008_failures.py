"""Passwords that did not fit, counted for all processes."""

import sqlalchemy as sa
from alembic import op

from coursework.database.tables import UTCDateTime

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    op.create_table(
        "failure",
        sa.Column("key", sa.String(length=64), nullable=False),
        sa.Column("count", sa.Integer(), nullable=False),
        sa.Column("last", UTCDateTime(), nullable=False),
        sa.PrimaryKeyConstraint("key", name=op.f("pk_failure")),
    )
    with op.batch_alter_table("failure") as changed:
        changed.create_index(changed.f("ix_failure_last"), ["last"])


def downgrade() -> None:
    with op.batch_alter_table("failure") as changed:
        changed.drop_index(changed.f("ix_failure_last"))
    op.drop_table("failure")
