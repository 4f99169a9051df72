"""Sessions that live in the database."""

import sqlalchemy as sa
from alembic import op

from coursework.database.tables import SafeText, UTCDateTime

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    op.create_table(
        "session",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("digest", sa.String(length=64), nullable=False),
        sa.Column("browser", SafeText(), nullable=False),
        sa.Column("created", UTCDateTime(), nullable=False),
        sa.Column("seen", UTCDateTime(), nullable=False),
        sa.Column("until", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_session_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_session")),
        sa.UniqueConstraint("digest", name=op.f("uq_session_digest")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("session") as changed:
        changed.create_index(changed.f("ix_session_person_id"), ["person_id"])
        changed.create_index(changed.f("ix_session_until"), ["until"])


def downgrade() -> None:
    with op.batch_alter_table("session") as changed:
        changed.drop_index(changed.f("ix_session_until"))
        changed.drop_index(changed.f("ix_session_person_id"))
    op.drop_table("session")
