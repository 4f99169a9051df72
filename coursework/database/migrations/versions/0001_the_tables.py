"""The tables."""

import sqlalchemy as sa
from alembic import op

from coursework.database.tables import Json, SafeText, UTCDateTime

revision = "0001"
down_revision = None


def upgrade() -> None:
    op.create_table(
        "assignment",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("name", SafeText(), nullable=False),
        sa.Column("course", SafeText(), nullable=False),
        sa.Column("stated", Json, nullable=True),
        sa.Column("has_roster", sa.Boolean(), nullable=False),
        sa.Column("is_pool", sa.Boolean(), nullable=False),
        sa.Column("columns", Json, nullable=False),
        sa.Column("asked", Json, nullable=True),
        sa.Column("published", Json, nullable=True),
        sa.Column("created", UTCDateTime(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_assignment")),
        sa.UniqueConstraint("name", name=op.f("uq_assignment_name")),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "audit",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("at", UTCDateTime(), nullable=False),
        sa.Column("by", SafeText(), nullable=False),
        sa.Column("what", SafeText(), nullable=False),
        sa.Column("about", Json, nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_audit")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("audit") as table:
        table.create_index(table.f("ix_audit_at"), ["at"])

    op.create_table(
        "person",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("who", SafeText(), nullable=False),
        sa.Column("name", SafeText(), nullable=False),
        sa.Column("lang", SafeText(), nullable=False),
        sa.Column("columns", Json, nullable=False),
        sa.Column("created", UTCDateTime(), nullable=False),
        sa.Column("sessions_from", UTCDateTime(), nullable=True),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_person")),
        sa.UniqueConstraint("who", name=op.f("uq_person_who")),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "setting",
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("value", SafeText(), nullable=False),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_setting")),
    )
    op.create_table(
        "account",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("login", SafeText(), nullable=False),
        sa.Column("secret", SafeText(), nullable=False),
        sa.Column("invitation", sa.String(length=64), nullable=True),
        sa.Column("invited_until", UTCDateTime(), nullable=True),
        sa.Column("joined", UTCDateTime(), nullable=True),
        sa.Column("role", sa.String(length=16), nullable=False),
        sa.Column("created", UTCDateTime(), nullable=False),
        sa.Column("closed", UTCDateTime(), nullable=True),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_account_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_account")),
        sa.UniqueConstraint("login", name=op.f("uq_account_login")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("account") as table:
        table.create_index(table.f("ix_account_invitation"), ["invitation"])
        table.create_index(table.f("ix_account_person_id"), ["person_id"])

    op.create_table(
        "decision",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("student", SafeText(), nullable=False),
        sa.Column("exercise", SafeText(), nullable=False),
        sa.Column("seed", SafeText(), nullable=False),
        sa.Column("part", SafeText(), nullable=False),
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("points", sa.Double(), nullable=True),
        sa.Column("reason", SafeText(), nullable=False),
        sa.Column("answer", SafeText(), nullable=True),
        sa.Column("by", SafeText(), nullable=False),
        sa.Column("made", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_decision_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_decision")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("decision") as table:
        table.create_index(table.f("ix_decision_assignment_id"), ["assignment_id"])

    op.create_table(
        "delivery",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=True),
        sa.Column("source", SafeText(), nullable=False),
        sa.Column("digest", sa.String(length=64), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("receipt", sa.String(length=40), nullable=False),
        sa.Column("late", sa.Integer(), nullable=False),
        sa.Column("came", UTCDateTime(), nullable=False),
        sa.Column("replaced", UTCDateTime(), nullable=True),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_delivery_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_delivery_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_delivery")),
        sa.UniqueConstraint("assignment_id", "digest", name=op.f("uq_delivery_assignment_id_digest")),
        sa.UniqueConstraint(
            "assignment_id", "person_id", "number", name=op.f("uq_delivery_assignment_id_person_id_number")
        ),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("delivery") as table:
        table.create_index(table.f("ix_delivery_assignment_id"), ["assignment_id"])
        table.create_index(table.f("ix_delivery_person_id"), ["person_id"])

    op.create_table(
        "draft",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("sheet", SafeText(), nullable=False),
        sa.Column("box", SafeText(), nullable=False),
        sa.Column("text", SafeText(), nullable=False),
        sa.Column("version", sa.Integer(), nullable=False),
        sa.Column("changed", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_draft_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_draft")),
        sa.UniqueConstraint("person_id", "sheet", "box", name=op.f("uq_draft_person_id_sheet_box")),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "extension",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("closes", UTCDateTime(), nullable=True),
        sa.Column("tries", sa.Integer(), nullable=True),
        sa.Column("reason", SafeText(), nullable=False),
        sa.Column("by", SafeText(), nullable=False),
        sa.Column("made", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_extension_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_extension_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_extension")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("extension") as table:
        table.create_index(table.f("ix_extension_assignment_id"), ["assignment_id"])
        table.create_index(table.f("ix_extension_person_id"), ["person_id"])

    op.create_table(
        "identity",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("issuer", SafeText(), nullable=False),
        sa.Column("subject", SafeText(), nullable=False),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_identity_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_identity")),
        sa.UniqueConstraint("issuer", "subject", name=op.f("uq_identity_issuer_subject")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("identity") as table:
        table.create_index(table.f("ix_identity_person_id"), ["person_id"])

    op.create_table(
        "marking",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("student", SafeText(), nullable=False),
        sa.Column("exercise", SafeText(), nullable=False),
        sa.Column("seed", SafeText(), nullable=False),
        sa.Column("attempt", sa.Integer(), nullable=False),
        sa.Column("sitting", sa.Integer(), nullable=False),
        sa.Column("state", sa.String(length=64), nullable=False),
        sa.Column("lang", SafeText(), nullable=False),
        sa.Column("apart", sa.Boolean(), nullable=False),
        sa.Column("submitted", SafeText(), nullable=False),
        sa.Column("fault", SafeText(), nullable=False),
        sa.Column("made", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_marking_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_marking")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("marking") as table:
        table.create_index(table.f("ix_marking_assignment_id"), ["assignment_id"])
        table.create_index("ix_marking_sheet", ["assignment_id", "student", "exercise", "seed"])

    op.create_table(
        "progress",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=False),
        sa.Column("entry", Json, nullable=False),
        sa.Column("digest", sa.String(length=64), nullable=False),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_progress_person_id_person"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_progress")),
        sa.UniqueConstraint("person_id", "digest", name=op.f("uq_progress_person_id_digest")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("progress") as table:
        table.create_index(table.f("ix_progress_person_id"), ["person_id"])

    op.create_table(
        "variant",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("exercise", SafeText(), nullable=False),
        sa.Column("seed", SafeText(), nullable=False),
        sa.Column("letter", sa.String(length=2), nullable=False),
        sa.Column("record", Json, nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_variant_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_variant")),
        sa.UniqueConstraint(
            "assignment_id", "exercise", "seed", name=op.f("uq_variant_assignment_id_exercise_seed")
        ),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("variant") as table:
        table.create_index(table.f("ix_variant_assignment_id"), ["assignment_id"])

    op.create_table(
        "worksheet",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("file", sa.String(length=64), nullable=False),
        sa.Column("lines", Json, nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_worksheet_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_worksheet")),
        sa.UniqueConstraint("assignment_id", "file", name=op.f("uq_worksheet_assignment_id_file")),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "answer",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("delivery_id", sa.Integer(), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("student", SafeText(), nullable=False),
        sa.Column("exercise", SafeText(), nullable=False),
        sa.Column("seed", SafeText(), nullable=False),
        sa.Column("part", SafeText(), nullable=False),
        sa.Column("answer", Json, nullable=True),
        sa.Column("source", SafeText(), nullable=False),
        sa.Column("warning", SafeText(), nullable=False),
        sa.Column("lang", SafeText(), nullable=False),
        sa.Column("origin", Json, nullable=True),
        sa.ForeignKeyConstraint(
            ["delivery_id"], ["delivery.id"], name=op.f("fk_answer_delivery_id_delivery"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_answer")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("answer") as table:
        table.create_index(table.f("ix_answer_delivery_id"), ["delivery_id"])

    op.create_table(
        "dealt",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("variant_id", sa.Integer(), nullable=False),
        sa.Column("person_id", sa.Integer(), nullable=True),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("student", SafeText(), nullable=False),
        sa.Column("sitting", sa.Integer(), nullable=False),
        sa.Column("lang", SafeText(), nullable=False),
        sa.ForeignKeyConstraint(
            ["person_id"], ["person.id"], name=op.f("fk_dealt_person_id_person"), ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(
            ["variant_id"], ["variant.id"], name=op.f("fk_dealt_variant_id_variant"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_dealt")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("dealt") as table:
        table.create_index(table.f("ix_dealt_person_id"), ["person_id"])
        table.create_index(table.f("ix_dealt_variant_id"), ["variant_id"])

    op.create_table(
        "mark",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("marking_id", sa.Integer(), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("part", SafeText(), nullable=False),
        sa.Column("came", sa.Integer(), nullable=True),
        sa.Column("answer", SafeText(), nullable=False),
        sa.Column("read_as", SafeText(), nullable=False),
        sa.Column("verdict", SafeText(), nullable=False),
        sa.Column("points", sa.Double(), nullable=False),
        sa.Column("out_of", sa.Double(), nullable=False),
        sa.Column("lang", SafeText(), nullable=False),
        sa.Column("matches", Json, nullable=False),
        sa.Column("in_other_order", sa.Boolean(), nullable=False),
        sa.Column("says", SafeText(), nullable=False),
        sa.Column("feedback", SafeText(), nullable=False),
        sa.ForeignKeyConstraint(
            ["marking_id"], ["marking.id"], name=op.f("fk_mark_marking_id_marking"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_mark")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("mark") as table:
        table.create_index(table.f("ix_mark_marking_id"), ["marking_id"])

    op.create_table(
        "placing",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("assignment_id", sa.Integer(), nullable=False),
        sa.Column("row", sa.String(length=64), nullable=False),
        sa.Column("delivery_id", sa.Integer(), nullable=True),
        sa.Column("reason", SafeText(), nullable=False),
        sa.Column("by", SafeText(), nullable=False),
        sa.Column("made", UTCDateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["assignment_id"],
            ["assignment.id"],
            name=op.f("fk_placing_assignment_id_assignment"),
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["delivery_id"], ["delivery.id"], name=op.f("fk_placing_delivery_id_delivery"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_placing")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("placing") as table:
        table.create_index(table.f("ix_placing_assignment_id"), ["assignment_id"])

    op.create_table(
        "rejected",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("delivery_id", sa.Integer(), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("source", SafeText(), nullable=False),
        sa.Column("reason", SafeText(), nullable=False),
        sa.Column("row", Json, nullable=False),
        sa.ForeignKeyConstraint(
            ["delivery_id"],
            ["delivery.id"],
            name=op.f("fk_rejected_delivery_id_delivery"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_rejected")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("rejected") as table:
        table.create_index(table.f("ix_rejected_delivery_id"), ["delivery_id"])

    op.create_table(
        "seen",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("delivery_id", sa.Integer(), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("source", SafeText(), nullable=False),
        sa.Column("what", SafeText(), nullable=False),
        sa.Column("is_tree", sa.Boolean(), nullable=False),
        sa.ForeignKeyConstraint(
            ["delivery_id"], ["delivery.id"], name=op.f("fk_seen_delivery_id_delivery"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_seen")),
        sqlite_autoincrement=True,
    )
    with op.batch_alter_table("seen") as table:
        table.create_index(table.f("ix_seen_delivery_id"), ["delivery_id"])


def downgrade() -> None:
    with op.batch_alter_table("seen") as table:
        table.drop_index(table.f("ix_seen_delivery_id"))

    op.drop_table("seen")
    with op.batch_alter_table("rejected") as table:
        table.drop_index(table.f("ix_rejected_delivery_id"))

    op.drop_table("rejected")
    with op.batch_alter_table("placing") as table:
        table.drop_index(table.f("ix_placing_assignment_id"))

    op.drop_table("placing")
    with op.batch_alter_table("mark") as table:
        table.drop_index(table.f("ix_mark_marking_id"))

    op.drop_table("mark")
    with op.batch_alter_table("dealt") as table:
        table.drop_index(table.f("ix_dealt_variant_id"))
        table.drop_index(table.f("ix_dealt_person_id"))

    op.drop_table("dealt")
    with op.batch_alter_table("answer") as table:
        table.drop_index(table.f("ix_answer_delivery_id"))

    op.drop_table("answer")
    op.drop_table("worksheet")
    with op.batch_alter_table("variant") as table:
        table.drop_index(table.f("ix_variant_assignment_id"))

    op.drop_table("variant")
    with op.batch_alter_table("progress") as table:
        table.drop_index(table.f("ix_progress_person_id"))

    op.drop_table("progress")
    with op.batch_alter_table("marking") as table:
        table.drop_index("ix_marking_sheet")
        table.drop_index(table.f("ix_marking_assignment_id"))

    op.drop_table("marking")
    with op.batch_alter_table("identity") as table:
        table.drop_index(table.f("ix_identity_person_id"))

    op.drop_table("identity")
    with op.batch_alter_table("extension") as table:
        table.drop_index(table.f("ix_extension_person_id"))
        table.drop_index(table.f("ix_extension_assignment_id"))

    op.drop_table("extension")
    op.drop_table("draft")
    with op.batch_alter_table("delivery") as table:
        table.drop_index(table.f("ix_delivery_person_id"))
        table.drop_index(table.f("ix_delivery_assignment_id"))

    op.drop_table("delivery")
    with op.batch_alter_table("decision") as table:
        table.drop_index(table.f("ix_decision_assignment_id"))

    op.drop_table("decision")
    with op.batch_alter_table("account") as table:
        table.drop_index(table.f("ix_account_person_id"))
        table.drop_index(table.f("ix_account_invitation"))

    op.drop_table("account")
    op.drop_table("setting")
    op.drop_table("person")
    with op.batch_alter_table("audit") as table:
        table.drop_index(table.f("ix_audit_at"))

    op.drop_table("audit")
    op.drop_table("assignment")
