"""Decisions of people on answers, stored: all of them are kept, in their order. Decisions in the files of a
folder are taken in: a difference between a file and its content when it was last read or written is a new
decision, under the file's name. So an old file states nothing new, and an edited one states the changes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from sqlalchemy import Connection, insert, literal, select

from coursework.database.store import put_rows
from coursework.database.tables import decision, mark, marking, variant, worksheet
from coursework.errors import BadInput, UnknownName, nearest
from coursework.gradebook.adjustments import ADJUSTMENTS, check_adjustment
from coursework.gradebook.decision import new_id, with_ids
from coursework.gradebook.decisions import (
    ACCEPTED_FILE,
    DECISIONS_FILE,
    EDITED,
    GIVEN,
    KINDS,
    TO_MARK_FILE,
    WITHDRAWN,
    Decision,
    DecisionFiles,
    Decisions,
    check_points,
)
from coursework.issuing.students import folded

# ---------------------------------------------------------------------- writing


def decide(connection: Connection, assignment_id: int, decisions: Iterable[Decision]) -> None:
    """Store decisions, as of now. One of the kind ``given`` applies only to the answer that was seen.

    Raises
    ------
    UnknownName
        There is no such kind, exercise or part.
    BadInput
        Points that are more than the part has, or none where some are given.
    """
    decisions = list(decisions)
    for entry in decisions:
        kinds = KINDS if entry.student else (*KINDS, *ADJUSTMENTS)
        if entry.kind not in kinds:
            raise UnknownName(
                "no kind of decision {kind!r}{nearest}", kind=entry.kind, nearest=nearest(entry.kind, kinds)
            )
        if entry.kind == GIVEN and entry.points is None:
            raise BadInput("points are given, or the answer is accepted: say how many")
    _check(connection, assignment_id, [entry for entry in decisions if entry.kind != WITHDRAWN])
    if decisions:
        now = {"assignment_id": assignment_id, "made": datetime.now(UTC)}
        rows = [
            {
                **dict(zip(_STORED, entry, strict=False)),
                "lasting_id": entry.id or new_id(),
                "withdraws": entry.withdraws or None,
                **now,
            }
            for entry in decisions
        ]
        connection.execute(insert(decision), rows)


def _check(connection: Connection, assignment_id: int, decisions: Sequence[Decision]) -> None:
    """Raise an error for an exercise or a part that does not exist, or for more points than the part has."""
    exercises = {entry.exercise for entry in decisions}
    query = select(variant.c.exercise, variant.c.record["parts"].label("parts")).where(
        variant.c.assignment_id == assignment_id, variant.c.exercise.in_(exercises)
    )
    worth: dict[str, dict[str, float]] = {}
    for row in connection.execute(query) if decisions else ():
        worth.setdefault(row.exercise, {}).update({str(p["id"]): float(p["points"]) for p in row.parts})
    for entry in decisions:
        if entry.kind in ADJUSTMENTS:
            check_adjustment(entry, worth)
            continue
        parts = worth.get(entry.exercise)
        if parts is None:
            raise UnknownName("no exercise {exercise!r} was issued", exercise=entry.exercise)
        if entry.part not in parts:
            raise UnknownName(
                "{exercise} has no part {part!r}{nearest}",
                exercise=entry.exercise,
                part=entry.part,
                nearest=nearest(entry.part, parts),
            )
        if entry.points is not None:
            check_points(entry.points, entry.part, parts[entry.part], f"{entry.student}, {entry.exercise}")


# ---------------------------------------------------------------------- reading

_STORED = Decision._fields[: Decision._fields.index("line")]  #: fields of a decision that have a column


def stored_decision(row: Any) -> Decision:
    """Return the decision of a row."""
    stated = Decision(*(getattr(row, name) for name in _STORED))
    return stated._replace(id=row.lasting_id or "", withdraws=row.withdraws or "")


def read_decisions(connection: Connection, assignment_id: int, student: str | None = None) -> Decisions:
    """Return the decisions on an assignment in their order; of one student, if given."""
    query = select(decision).where(decision.c.assignment_id == assignment_id).order_by(decision.c.id)
    # A file may spell a name differently, so the names are compared here, after folding.
    return Decisions(
        stored_decision(row)
        for row in connection.execute(query)
        if student is None or not row.student or folded(row.student) == folded(student)
    )


class HistoryEvent(NamedTuple):
    """Event in the history of an answer: its marking, or a decision."""

    student: str
    exercise: str
    part: str
    made: datetime
    by: str  #: empty for the marking
    kind: str  #: marked, accepted, given, kept, withdrawn
    seed: str
    sitting: int  #: 0 if unknown
    answer: str | None
    verdict: str
    points: float | None
    reason: str


MARKED = "marked"


def history(
    connection: Connection, assignment_id: int, student: str | None = None, exercise: str = "", part: str = ""
) -> list[HistoryEvent]:
    """Return the events in the history of answers, in chronological order; of the given student, exercise or
    part alone."""
    marks = select(
        marking.c.student,
        marking.c.exercise,
        mark.c.part,
        marking.c.made,
        literal(""),
        literal(MARKED),
        marking.c.seed,
        marking.c.sitting,
        mark.c.answer,
        mark.c.verdict,
        mark.c.points,
        mark.c.feedback,
    ).join(mark)
    marks = marks.where(marking.c.assignment_id == assignment_id, mark.c.verdict != "")
    of = decision.c
    decided = select(
        of.student,
        of.exercise,
        of.part,
        of.made,
        of.by,
        of.kind,
        of.seed,
        literal(0),
        of.answer,
        literal(""),
        of.points,
        of.reason,
    ).where(of.assignment_id == assignment_id)
    rows = [
        *connection.execute(marks.order_by(marking.c.id, mark.c.place)),
        *connection.execute(decided.order_by(of.id)),
    ]
    events = (
        HistoryEvent(*row)
        for row in rows
        if exercise in ("", row.exercise)
        and part in ("", row.part)
        and (student is None or folded(row.student) == folded(student))
    )
    return sorted(events, key=lambda event: event.made)


# ------------------------------------------------------------------------ files


def store_new_decisions(connection: Connection, assignment_id: int, files: DecisionFiles) -> int:
    """Store the new decisions in the files; return the number of answers concerned.

    Raises
    ------
    BadInput
        An answer is given more points than its part has.
    """
    remembered = [entry for path in files.files for entry in _remembered(connection, assignment_id, path)]
    known = Counter(_line(entry) for entry in remembered if not entry.student)
    new_steps = []
    for entry in files.lines:
        if not entry.student:
            known[_line(entry)] -= 1
            new_steps += [entry] if known[_line(entry)] < 0 else []
    gone = [entry for entry in remembered if known[_line(entry)] > 0 and entry.kind != WITHDRAWN]
    taken_back = [step.withdrawn() for step in gone]
    decide(connection, assignment_id, [*taken_back, *new_steps])
    was = _by_answer(entry for entry in remembered if entry.student)
    now = _by_answer(entry._replace(line=0, location="") for entry in files.lines if entry.student)
    decisions = read_decisions(connection, assignment_id)
    names = {TO_MARK_FILE, ACCEPTED_FILE, DECISIONS_FILE, *(path.name for path in files.files)}
    changed = [on for on in dict.fromkeys((*was, *now)) if was.get(on) != now.get(on)]
    for on in changed:
        standing = decisions.on(*on)
        signed = names | {entry.by for entry in was.get(on, ())}
        if on in was and standing and standing[-1].by in signed and standing[-1].kind != WITHDRAWN:
            _store_decision(connection, assignment_id, was[on][-1].withdrawn(seed="", withdraws=""))
        for entry in now.get(on, ()):
            _store_decision(connection, assignment_id, entry)
    remember_written(connection, assignment_id, files)
    return len(changed) + len(new_steps) + len(gone)


def remember_written(connection: Connection, assignment_id: int, files: DecisionFiles) -> None:
    """Record the content of the files, so that it counts as known."""
    for path, decisions in files.files.items():
        row = {"assignment_id": assignment_id, "file": _file(path)}
        lines = [_line(entry) for entry in decisions if entry.kind != EDITED]
        if lines != [_line(entry) for entry in _remembered(connection, assignment_id, path)]:
            put_rows(connection, worksheet, [{**row, "lines": lines}], list(row))


_STATED = Decision._fields.index("made")  #: fields of a decision that a worksheet has, and its ids


def _line(entry: Decision) -> tuple[Any, ...]:
    return *entry[:_STATED], entry.id, entry.withdraws


def _store_decision(connection: Connection, assignment_id: int, entry: Decision) -> None:
    """Store a decision; ignore a line that names nothing issued, since the reader of the file reports it."""
    with suppress(UnknownName):
        decide(connection, assignment_id, [entry])


def _by_answer(decisions: Iterable[Decision]) -> dict[tuple[str, str, str], list[Decision]]:
    by_answer: dict[tuple[str, str, str], list[Decision]] = {}
    for entry in decisions:
        by_answer.setdefault(entry.key, []).append(entry)
    return by_answer


def _file(path: Path) -> str:
    return sha256(str(path.resolve()).encode("utf-8", "backslashreplace")).hexdigest()


def _remembered(connection: Connection, assignment_id: int, path: Path) -> list[Decision]:
    query = select(worksheet.c.lines).where(
        worksheet.c.assignment_id == assignment_id, worksheet.c.file == _file(path)
    )
    lines = connection.execute(query).scalar() or ()
    # A line of before has no ids.
    ids = (dict(zip(("id", "withdraws"), line[_STATED:], strict=False)) for line in lines)
    stated = (Decision(*line[:_STATED]) for line in lines)
    return with_ids(one._replace(**its) for one, its in zip(stated, ids, strict=True))
