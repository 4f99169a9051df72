"""Pages of scans, and what was typed where they could not be read."""

import sqlalchemy as sa
from alembic import op

from coursework.database.tables import Json, SafeText, UTCDateTime

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    op.create_table(
        "scanned",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("page", sa.String(length=40), nullable=False),
        sa.Column("file", SafeText(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("student", SafeText(), nullable=False),
        sa.Column("kept", Json, nullable=False),
        sa.Column("picture", SafeText(), nullable=False),
        sa.Column("came", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_scanned_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_scanned")),
        sa.UniqueConstraint("assignment_id", "page", name=op.f("uq_scanned_assignment_id_page")),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "typed",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("student", SafeText(), nullable=False),
        sa.Column("exercise", SafeText(), nullable=False),
        sa.Column("seed", SafeText(), nullable=False),
        sa.Column("part", SafeText(), nullable=False),
        sa.Column("coordinate", SafeText(), nullable=False),
        sa.Column("answer", SafeText(), nullable=True),
        sa.Column("seen", SafeText(), nullable=False),
        sa.Column("by", SafeText(), nullable=False),
        sa.Column("made", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_typed_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_typed")),
        sqlite_autoincrement=True,
    )
    for table in ("scanned", "typed"):
        with op.batch_alter_table(table) as changed:
            changed.create_index(changed.f(f"ix_{table}_assignment_id"), ["assignment_id"])


def downgrade() -> None:
    for table in ("typed", "scanned"):
        with op.batch_alter_table(table) as changed:
            changed.drop_index(changed.f(f"ix_{table}_assignment_id"))
        op.drop_table(table)
