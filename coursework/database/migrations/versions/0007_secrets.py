"""Secrets of assignments, which key the draws of who comes later."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    with op.batch_alter_table("assignment") as changed:
        changed.add_column(sa.Column("secret", sa.String(length=32), nullable=True))


def downgrade() -> None:
    op.drop_column("assignment", "secret")  # a table made anew would take along what refers to it
