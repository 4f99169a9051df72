"""Pages of papers, made before they open."""

import sqlalchemy as sa
from alembic import op

from coursework.database.tables import CompressedText, SafeText

revision = "0009"
down_revision = "0008"

_OWNERS = ("assignment", "person")


def upgrade() -> None:
    op.create_table(
        "prepared",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("lang", SafeText(), nullable=False),
        sa.Column("state", sa.String(length=64), nullable=False),
        sa.Column("head", CompressedText(), nullable=False),
        sa.Column("body", CompressedText(), nullable=False),
        *(
            sa.ForeignKeyConstraint(
                [f"{owner}_id"],
                [f"{owner}.id"],
                name=op.f(f"fk_prepared_{owner}_id_{owner}"),
                ondelete="CASCADE",
            )
            for owner in _OWNERS
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_prepared")),
        sa.UniqueConstraint(
            "assignment_id", "person_id", "lang", name=op.f("uq_prepared_assignment_id_person_id_lang")
        ),
        sqlite_autoincrement=True,
    )
    op.create_index(op.f("ix_prepared_person_id"), "prepared", ["person_id"])


def downgrade() -> None:
    op.drop_table("prepared")
