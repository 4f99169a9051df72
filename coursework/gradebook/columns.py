"""Names of the columns of the tables: the usual ones, and those of an assignment and of the roster."""

from __future__ import annotations

from coursework.issuing.exam_columns import is_private
from coursework.issuing.identity import column_called, is_same_column
from coursework.issuing.issued import Issued
from coursework.issuing.students import folded

MARKS_COLUMNS = (
    "student",
    "exercise",
    "seed",
    "part",
    "answer",
    "read_as",
    "verdict",
    "points",
    "out_of",
    "feedback",
)
#: Kinds of verdict, in the order of the summary's columns.
VERDICTS = (
    "correct",
    "follow_through",
    "mistake",
    "slip",
    "accepted",
    "partial",
    "wrong",
    "wrong_unit",
    "missing_unit",
    "unreadable",
    "to_mark",
    "missing",
)
SUMMARY_COLUMNS = ("student", "points", "out_of", "percent", *VERDICTS)
SITTING = "sitting"  #: a column of the marks and of the summary where somebody has several
SUBMITTED = "submitted"  #: a column of the marks where a platform tells it
REJECTED_COLUMNS = ("student", "exercise", "seed", "part", "answer", "source", "reason")
MARK = "mark"
PROVISIONAL = "provisional"  #: column of the summary where answers wait: their number, of whoever has some
PRESENCE = "presence"  #: column of the summary where somebody stated who was present, absent or excused
LATE = "late"  #: column of the summary if late submissions have a penalty


def marks_columns(issued: Issued, *, submitted: bool = False) -> tuple[str, ...]:
    """Return the columns of ``marks.csv``, with the sitting if there are several, and with the time of
    submission if it is known."""
    more = (SITTING, issued.has_sittings), (SUBMITTED, submitted)
    return (*MARKS_COLUMNS, *(column for column, there in more if there))


def summary_columns(
    issued: Issued, *, late: bool = False, provisional: bool = False, presence: bool = False
) -> tuple[str, ...]:
    """Return the columns of ``summary.csv``: the usual ones with the identity, the exercises and the mark of
    an assignment among them, then those of the roster. With ``late``, a column for the penalty of late
    submissions; percent and mark are then those of the remaining points. With ``provisional``, one for the
    answers that wait for a person; with ``presence``, one for the presence."""
    sitting = (SITTING,) if issued.has_sittings else ()
    student, points, out_of, *others = SUMMARY_COLUMNS
    others = [LATE, *others] if late else others
    others = [PROVISIONAL, *others] if provisional else others
    others = [PRESENCE, *others] if presence else others
    if issued.assignment is None:
        return (student, points, out_of, *others, *sitting, *carried_columns(issued).values())
    mark = (MARK,) if issued.assignment.get("mark") else ()
    identity_columns = identity(issued)
    rest = (c for title, c in carried_columns(issued).items() if title not in identity_columns.values())
    exercises = exercise_columns(issued).values()
    return (student, *identity_columns, *sitting, *exercises, points, out_of, *mark, *others, *rest)


def identity(issued: Issued) -> dict[str, str]:
    """Return the columns that identify a student of the assignment: name in the summary -> folded title in
    the roster, "" if it has none."""
    stated = map(str, (issued.assignment or {}).get("identity") or ())
    titles = {folded(title) for cells in issued.columns.values() for title in cells}
    return {_distinct_title(title, _reserved_names(issued)): column_called(titles, title) for title in stated}


def exercise_columns(issued: Issued) -> dict[str, str]:
    """Return the column of each exercise of an assignment."""
    exercises = map(str, (issued.assignment or {}).get("exercises", ()))
    return {
        e: f"{e} points" if e in (*SUMMARY_COLUMNS, MARK, LATE, PROVISIONAL, SITTING) else e
        for e in exercises
    }


def carried_columns(issued: Issued) -> dict[str, str]:
    """Return the columns of the roster that the summary repeats: folded title -> name in the summary. Columns
    of birth, health and extra time are among them only where the assignment or the command names them."""
    titles = {folded(title): title for cells in issued.columns.values() for title in cells}
    return {
        f: _distinct_title(title, _reserved_names(issued))
        for f, title in titles.items()
        if f and _is_carried(issued, title)
    }


def _is_carried(issued: Issued, title: str) -> bool:
    if issued.carry is None:
        return not is_private(title)
    return any(is_same_column(title, wanted) for wanted in issued.carry)


def _reserved_names(issued: Issued) -> frozenset[str]:
    return frozenset(
        map(folded, (*SUMMARY_COLUMNS, MARK, LATE, PROVISIONAL, SITTING, *exercise_columns(issued).values()))
    )


def _distinct_title(title: str, reserved: frozenset[str]) -> str:
    """Return a title of the roster that differs from the names of other columns."""
    return f"{title} (roster)" if folded(title) in reserved else title


def own_columns(issued: Issued, student: str) -> dict[str, str]:
    """Return the cells of the roster about a student, by folded title."""
    return {folded(title): value for title, value in issued.columns.get(student, {}).items()}
