"""Decisions written in files by people: ``accepted.csv``, and the points in ``to_mark.csv``.

A difference between a file and its content when it was last read or written is a new decision, under the
file's name. So an old file states nothing new, and one that somebody has edited states the changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from sqlalchemy import Connection, delete, insert, select

from coursework.database.decisions import ACCEPTED, GIVEN, WITHDRAWN, DecidedAnswer, Decisions, decide
from coursework.database.tables import worksheet
from coursework.errors import UnknownName
from coursework.gradebook.accepted import Accepted
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.to_mark import GivenPoints, ToMark
from coursework.issuing.students import folded
from coursework.marking.mark import Mark


class _StatedDecision(NamedTuple):
    """Decision as a file states it."""

    student: str
    exercise: str
    seed: str
    part: str
    kind: str
    points: float | None
    reason: str
    answer: str | None
    by: str

    @property
    def on(self) -> tuple[str, str, str]:
        return folded(self.student), self.exercise, self.part


def store_new_decisions(
    connection: Connection, assignment_id: int, by_person: ToMark | None, by_hand: Accepted | None
) -> int:
    """Store the new decisions in the files; return the number of answers concerned.

    Raises
    ------
    BadInput
        An answer is given more points than its part has.
    """
    files = (
        [(by_person.path, _given_decisions(by_person))]
        if by_person is not None and by_person.path.exists()
        else []
    )
    files += [] if by_hand is None or by_hand.path is None else [(by_hand.path, _accepted_decisions(by_hand))]
    was = _by_answer(line for path, _ in files for line in _remembered(connection, assignment_id, path))
    now = _by_answer(line for _, lines in files for line in lines)
    decisions = Decisions.read(connection, assignment_id)
    names = {path.name for path, _ in files}
    changed = [on for on in dict.fromkeys((*was, *now)) if was.get(on) != now.get(on)]
    for on in changed:
        standing = decisions.on(*on)
        if on in was and standing and standing[-1].by in names and standing[-1].kind != WITHDRAWN:
            _store_decision(
                connection,
                assignment_id,
                was[on][-1]._replace(kind=WITHDRAWN, seed="", points=None, reason=""),
            )
        for line in now.get(on, ()):
            _store_decision(connection, assignment_id, line)
    for path, lines in files:
        _remember(connection, assignment_id, path, lines)
    return len(changed)


def remember_written(connection: Connection, assignment_id: int, path: Path) -> None:
    """Record the content of ``to_mark.csv``, just written, so that it counts as known."""
    if path.exists():
        _remember(connection, assignment_id, path, _given_decisions(ToMark(path)))


def _store_decision(connection: Connection, assignment_id: int, line: _StatedDecision) -> None:
    """Store a decision; ignore a line that names nothing issued, since the reader of the file reports it."""
    answer = DecidedAnswer(line.student, line.exercise, line.seed, line.part, line.answer)
    with suppress(UnknownName):
        decide(connection, assignment_id, [answer], line.kind, line.points, line.reason, line.by)


def _by_answer(lines: Iterable[_StatedDecision]) -> dict[tuple[str, str, str], list[_StatedDecision]]:
    by_answer: dict[tuple[str, str, str], list[_StatedDecision]] = {}
    for line in lines:
        by_answer.setdefault(line.on, []).append(line)
    return by_answer


def _given_decisions(by_person: ToMark) -> list[_StatedDecision]:
    lines = by_person.given.values()
    return [
        _StatedDecision(*_named(row.named), GIVEN, row.points, row.reason, row.answer, by_person.path.name)
        for row in lines
    ]


def _named(named: Sequence[str]) -> tuple[str, str, str, str]:
    student, exercise, seed, part = named
    return student, exercise, seed, part


def _accepted_decisions(by_hand: Accepted) -> list[_StatedDecision]:
    assert by_hand.path is not None
    name = by_hand.path.name
    return [
        _StatedDecision(*line.answer_id, ACCEPTED, line.points, line.reason, None, name)
        for line in by_hand.lines
    ]


# --------------------------------------------------------------------- remembered


def _file(path: Path) -> str:
    return sha256(str(path.resolve()).encode("utf-8", "backslashreplace")).hexdigest()


def _remembered(connection: Connection, assignment_id: int, path: Path) -> list[_StatedDecision]:
    query = select(worksheet.c.lines).where(
        worksheet.c.assignment_id == assignment_id, worksheet.c.file == _file(path)
    )
    return [_StatedDecision(*line) for line in connection.execute(query).scalar() or ()]


def _remember(
    connection: Connection, assignment_id: int, path: Path, lines: Sequence[_StatedDecision]
) -> None:
    key = {"assignment_id": assignment_id, "file": _file(path)}
    if lines == _remembered(connection, assignment_id, path):
        return
    connection.execute(delete(worksheet).filter_by(**key))
    connection.execute(insert(worksheet).values(lines=[list(line) for line in lines], **key))


# ---------------------------------------------------------------------- applied


class DecidedToMark(ToMark):
    """``to_mark.csv`` with all points decided, in the file or on the site."""

    def __init__(self, path: Path, decisions: Decisions):
        super().__init__(path)
        self.decisions = decisions

    def given_for(self, graded: Graded, part: str, line: Mark) -> GivenPoints | None:
        """Return the points decided for an answer; the file itself is only checked, for its warnings."""
        super().given_for(graded, part, line)
        decided = self.decisions.given(graded, line)
        if decided is None:
            return None
        named = graded.student, graded.exercise, str(graded.seed), part
        return GivenPoints(decided.by, named, line.answer, decided.points or 0.0, decided.reason)


class DecidedAccepted(Accepted):
    """``accepted.csv`` with all decisions, in the file or on the site."""

    def __init__(self, path: Path | None, decisions: Decisions):
        super().__init__(path)
        self.decisions = decisions

    def apply(self, graded: Graded, lang: str) -> Graded:
        """Return the sheet with the decisions applied; the file itself is only checked, for its warnings."""
        super().apply(graded, lang)
        return self.decisions.apply(graded, lang)
