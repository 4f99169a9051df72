"""Aggregates of the desk; those of an old database are noted as outdated, and computed when the site starts or a page asks."""

import sqlalchemy as sa
from alembic import op

from coursework.database.tables import Json, SafeText

revision = "0003"
down_revision = "0002"


def _key() -> sa.Column[int]:
    return sa.Column("id", sa.Integer(), nullable=False)


def _text(name: str) -> sa.Column[str]:
    return sa.Column(name, SafeText(), nullable=False)


def _number(name: str) -> sa.Column[int]:
    return sa.Column(name, sa.Integer(), nullable=False)


def _double(name: str) -> sa.Column[float]:
    return sa.Column(name, sa.Double(), nullable=False)


def _flag(name: str) -> sa.Column[bool]:
    return sa.Column(name, sa.Boolean(), nullable=False)


def _ends(table: str, *more: sa.UniqueConstraint) -> list[sa.Constraint]:
    to = sa.ForeignKeyConstraint(
        ["assignment_id"],
        ["assignment.id"],
        name=op.f(f"fk_{table}_assignment_id_assignment"),
        ondelete="CASCADE",
    )
    return [to, sa.PrimaryKeyConstraint("id", name=op.f(f"pk_{table}")), *more]


def upgrade() -> None:
    op.create_table(
        "outdated",
        _key(),
        _number("assignment_id"),
        sa.Column("kind", sa.String(length=16), nullable=False),
        _text("student"),
        *_ends("outdated"),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "student_total",
        _key(),
        _number("assignment_id"),
        *map(_text, ("student", "search", "identity")),
        sa.Column("place", sa.BigInteger(), nullable=False),
        _number("sitting"),
        *map(_double, ("points", "out_of", "charged")),
        _text("mark"),
        *map(_number, ("tries", "late", "waits")),
        *map(_flag, ("handed_in", "answered")),
        sa.Column("verdicts", Json, nullable=False),
        sa.Column("by_exercise", Json, nullable=False),
        *_ends(
            "student_total",
            sa.UniqueConstraint(
                "assignment_id", "student", name=op.f("uq_student_total_assignment_id_student")
            ),
        ),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "answer_now",
        _key(),
        *map(_number, ("assignment_id", "marking", "first", "place")),
        *map(_text, ("student", "exercise", "seed")),
        _number("sitting"),
        *map(_text, ("part", "verdict")),
        *map(_double, ("points", "out_of")),
        *map(_flag, ("by_hand", "counts", "is_cell", "is_listed", "is_shown")),
        sa.Column("wrote", sa.String(length=16), nullable=False),
        sa.Column("why", sa.String(length=16), nullable=True),
        sa.Column("card", sa.String(length=16), nullable=True),
        _flag("decided"),
        *_ends("answer_now"),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "unplaced",
        _key(),
        _number("assignment_id"),
        sa.Column("row", sa.String(length=64), nullable=False),
        *map(_text, ("student", "near", "source", "reason")),
        sa.Column("said", Json, nullable=False),
        *_ends("unplaced"),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "assignment_total",
        _key(),
        *map(_number, ("assignment_id", "students", "handed_in", "answered", "waiting")),
        sa.Column("facts", Json, nullable=False),
        _number("version"),
        *_ends(
            "assignment_total",
            sa.UniqueConstraint("assignment_id", name=op.f("uq_assignment_total_assignment_id")),
        ),
        sqlite_autoincrement=True,
    )
    for table in ("outdated", "unplaced"):
        op.create_index(op.f(f"ix_{table}_assignment_id"), table, ["assignment_id"])
    op.create_index("ix_student_total_place", "student_total", ["assignment_id", "place"])
    op.create_index("ix_answer_now_student", "answer_now", ["assignment_id", "student"])
    op.create_index("ix_answer_now_question", "answer_now", ["assignment_id", "exercise", "part"])
    op.create_index("ix_answer_now_card", "answer_now", ["assignment_id", "card"])
    for kind in ("everybody", "rows"):
        op.execute(
            f"INSERT INTO outdated (assignment_id, kind, student) SELECT id, '{kind}', '' FROM assignment"
        )


def downgrade() -> None:
    for table in ("assignment_total", "unplaced", "answer_now", "student_total", "outdated"):
        op.drop_table(table)
