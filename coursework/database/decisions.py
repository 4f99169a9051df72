"""Decisions on answers: accepted, given points, mark confirmed, or withdrawn. All are stored; the last on an
answer counts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime
from typing import Any, NamedTuple

from sqlalchemy import Connection, Select, insert, select

from coursework.database.tables import decision, mark, marking, variant
from coursework.errors import BadInput, UnknownName, nearest
from coursework.gradebook.accepted import accepted_mark, check_points
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.to_mark import given_mark, same_answer
from coursework.issuing.students import folded
from coursework.marking.feedback import RecordedSentence
from coursework.marking.mark import Mark

ACCEPTED, GIVEN, KEPT, WITHDRAWN = KINDS = ("accepted", "given", "kept", "withdrawn")


class DecidedAnswer(NamedTuple):
    """Answer to which a decision applies."""

    student: str
    exercise: str
    seed: str  #: empty for whatever variant they have
    part: str
    answer: str | None = None  #: what was seen: another one is not decided on; None for whatever it is


class Decision(NamedTuple):
    """Decision of a person on an answer."""

    seed: str
    kind: str
    points: float | None  #: None for all of them
    reason: str
    answer: str | None
    by: str
    made: datetime


# ---------------------------------------------------------------------- writing


def decide(
    connection: Connection,
    assignment_id: int,
    places: Iterable[DecidedAnswer],
    kind: str,
    points: float | None,
    reason: str,
    by: str,
) -> None:
    """Store a decision on some answers. A decision of the kind ``given`` applies only to the answer that was
    seen.

    Raises
    ------
    UnknownName
        There is no such kind, exercise or part.
    BadInput
        Points that are more than the part has, or none where some are given.
    """
    if kind not in KINDS:
        raise UnknownName("no kind of decision {kind!r}{nearest}", kind=kind, nearest=nearest(kind, KINDS))
    if kind == GIVEN and points is None:
        raise BadInput("points are given, or the answer is accepted: say how many")
    places = list(places)
    if kind != WITHDRAWN:
        _check(connection, assignment_id, places, points)
    decided_at = datetime.now(UTC)
    values = {
        "assignment_id": assignment_id,
        "kind": kind,
        "points": points,
        "reason": reason,
        "by": by,
        "made": decided_at,
    }
    if places:
        connection.execute(
            insert(decision),
            [{**decided._asdict(), "seed": str(decided.seed), **values} for decided in places],
        )


def _check(
    connection: Connection, assignment_id: int, places: Sequence[DecidedAnswer], points: float | None
) -> None:
    """Raise an error for an exercise or a part that does not exist, or for more points than the part has."""
    exercises = {answer.exercise for answer in places}
    query = select(variant.c.exercise, variant.c.record["parts"].label("parts")).where(
        variant.c.assignment_id == assignment_id, variant.c.exercise.in_(exercises)
    )
    worth: dict[str, dict[str, float]] = {}
    for row in connection.execute(query):
        worth.setdefault(row.exercise, {}).update({str(p["id"]): float(p["points"]) for p in row.parts})
    for answer in places:
        parts = worth.get(answer.exercise)
        if parts is None:
            raise UnknownName("no exercise {exercise!r} was issued", exercise=answer.exercise)
        if answer.part not in parts:
            raise UnknownName(
                "{exercise} has no part {part!r}{nearest}",
                exercise=answer.exercise,
                part=answer.part,
                nearest=nearest(answer.part, parts),
            )
        if points is not None:
            check_points(points, answer.part, parts[answer.part], f"{answer.student}, {answer.exercise}")


# --------------------------------------------------------------------- standing


class Decisions:
    """Decisions on the answers of an assignment, or of one student."""

    def __init__(self, rows: Iterable[tuple[str, str, str, Decision]] = ()):
        self._of: dict[tuple[str, str, str], list[Decision]] = {}
        for student, exercise, part, decided in rows:
            self._of.setdefault((folded(student), exercise, part), []).append(decided)

    @staticmethod
    def read(connection: Connection, assignment_id: int, student: str | None = None) -> Decisions:
        """Return the decisions on an assignment in their order; of one student, if given."""
        query = select(decision).where(decision.c.assignment_id == assignment_id).order_by(decision.c.id)
        # A file may spell a name differently, so the names are compared here, after folding.
        return Decisions(
            (row.student, row.exercise, row.part, _decision(row))
            for row in connection.execute(query)
            if student is None or folded(row.student) == folded(student)
        )

    def on(self, student: str, exercise: str, part: str) -> Sequence[Decision]:
        """Return all decisions on a student's answer, of any variant."""
        return self._of.get((folded(student), exercise, part), ())

    def standing(self, graded: Graded, line: Mark) -> Decision | None:
        """Return the decision that counts for an answer."""
        return next(self.counting(graded[:3], line), None)

    def given(self, graded: Graded, line: Mark) -> Decision | None:
        """Return the decision that gives points for an answer, even if the answer was also accepted."""
        return next((decided for decided in self.counting(graded[:3], line) if decided.kind == GIVEN), None)

    def counting(self, sheet: tuple[str, str, int], line: Mark) -> Iterator[Decision]:
        """Yield the decisions on exactly this answer of a sheet, the last first, as far as the last
        withdrawal."""
        student, exercise, seed = sheet
        for decided in reversed(self.on(student, exercise, line.part)):
            if decided.seed not in ("", str(seed)):
                continue
            if decided.kind == WITHDRAWN:
                return
            if decided.answer is None or same_answer(decided.answer, line.answer):
                yield decided

    def apply(self, graded: Graded, lang: str = "") -> Graded:
        """Return the sheet with the decisions of people applied to its marks."""
        if not self._of:
            return graded
        lines, unanswered = dict(graded.lines), list(graded.unanswered)
        for part, line in graded.lines.items():
            if (decided := self.standing(graded, line)) is not None:
                lines[part] = _decided(line, decided, lang or str(graded.record.get("lang", "fr")))
                if part not in (*graded.answered, *unanswered):
                    unanswered.append(part)
        return graded._replace(lines=lines, unanswered=tuple(unanswered))


def _decided(line: Mark, decided: Decision, lang: str) -> Mark:
    if decided.kind == GIVEN:
        return given_mark(line, decided.points or 0.0, decided.reason, lang, decided.by)
    if decided.kind == KEPT:
        return (
            line._replace(told=(*line.told, RecordedSentence(decided.reason, decided.reason)))
            if decided.reason
            else line
        )
    return accepted_mark(line, decided.points, decided.reason, lang, decided.by)


def _decision(row: Any) -> Decision:
    return Decision(*(getattr(row, name) for name in Decision._fields))


# ---------------------------------------------------------------------- history


class HistoryEvent(NamedTuple):
    """Event in the history of an answer."""

    at: datetime
    by: str  #: empty for the marking
    kind: str  #: marked, accepted, given, withdrawn
    seed: str
    sitting: int  #: 0 if unknown
    answer: str | None
    verdict: str
    points: float | None
    reason: str


MARKED = "marked"


def history(
    connection: Connection, assignment_id: int, student: str | None = None, exercise: str = "", part: str = ""
) -> list[tuple[str, str, str, HistoryEvent]]:
    """Return the events in the history of answers, in chronological order, each with its student, exercise
    and part; of the given student, exercise or part alone."""

    def asked(all_events: Select[Any], folded_name: Any) -> Select[Any]:
        for name, value in (("exercise", exercise), ("part", part)):
            all_events = all_events.where(folded_name[name] == value) if value else all_events
        return all_events

    marks = select(marking, mark).join(mark).where(marking.c.assignment_id == assignment_id)
    marks = asked(marks, {"exercise": marking.c.exercise, "part": mark.c.part}).order_by(
        marking.c.id, mark.c.place
    )
    decided = select(decision).where(decision.c.assignment_id == assignment_id).order_by(decision.c.id)
    all_events = [
        (row.student, row.exercise, row.part, _marking_event(row))
        for row in connection.execute(marks)
        if row.verdict
    ]
    all_events += [
        (row.student, row.exercise, row.part, _decision_event(row))
        for row in connection.execute(asked(decided, decision.c))
    ]
    folded_name = None if student is None else folded(student)
    return sorted(
        (event for event in all_events if folded_name in (None, folded(event[0]))),
        key=lambda event: event[3].at,
    )


def _marking_event(row: Any) -> HistoryEvent:
    answer_columns = row.seed, row.sitting, row.answer, row.verdict, row.points
    return HistoryEvent(row.made, "", MARKED, *answer_columns, row.feedback)


def _decision_event(row: Any) -> HistoryEvent:
    return HistoryEvent(row.made, row.by, row.kind, row.seed, 0, row.answer, "", row.points, row.reason)
