"""Administrators and assistants, the areas of assistants, and who did what from where."""

import sqlalchemy as sa
from alembic import op

from coursework.database.promoting import promote_first
from coursework.database.tables import SafeText

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
    op.create_table(
        "area",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=True),
        sa.Column("class_group", SafeText(), nullable=True),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_area_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_area_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_area")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("area") as changed:
        changed.create_index(changed.f("ix_area_person_id"), ["person_id"])
    for name, kind in (("actor", sa.Integer()), ("subject", sa.Integer()), ("address", sa.String(length=64))):
        op.add_column("audit", sa.Column(name, kind, nullable=True))
    op.create_index(op.f("ix_audit_subject"), "audit", ["subject"])
    promote_first(op.get_bind())


def downgrade() -> None:
    accounts = sa.table("account", sa.column("role", sa.String))
    lowered = {"administrator": "instructor", "assistant": "student"}
    for role, before in lowered.items():
        op.execute(accounts.update().where(accounts.c.role == role).values(role=before))
    op.drop_index(op.f("ix_audit_subject"), "audit")
    for name in ("address", "subject", "actor"):
        op.drop_column("audit", name)
    with op.batch_alter_table("area") as changed:
        changed.drop_index(changed.f("ix_area_person_id"))
    op.drop_table("area")
