"""Work that waits for a worker."""

import sqlalchemy as sa
from alembic import op

from coursework.database.tables import SafeText, UTCDateTime

revision = "0005"
down_revision = "0004"

_OWNERS = ("assignment", "delivery", "person")


def upgrade() -> None:
    op.create_table(
        "job",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("delivery_id", sa.Integer(), nullable=True),
        sa.Column("person_id", sa.Integer(), nullable=True),
        sa.Column("tries", sa.Integer(), nullable=False),
        sa.Column("worker", sa.String(length=64), nullable=False),
        sa.Column("until", UTCDateTime(), nullable=True),
        sa.Column("fault", SafeText(), nullable=False),
        sa.Column("made", UTCDateTime(), nullable=False),
        *(
            sa.ForeignKeyConstraint(
                [f"{owner}_id"], [f"{owner}.id"], name=op.f(f"fk_job_{owner}_id_{owner}"), ondelete="CASCADE"
            )
            for owner in _OWNERS
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_job")),
        sqlite_autoincrement=True,
    )
    for owner in _OWNERS:
        op.create_index(op.f(f"ix_job_{owner}_id"), "job", [f"{owner}_id"])


def downgrade() -> None:
    op.drop_table("job")
