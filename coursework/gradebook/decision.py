"""One decision of a person: on an answer of a student, or a step that is on no single student."""

from __future__ import annotations

from datetime import datetime
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.issuing.students import folded
from coursework.language.words import words
from coursework.marking.mark import Mark
from coursework.messages import Message

ACCEPTED, GIVEN, KEPT, WITHDRAWN = KINDS = ("accepted", "given", "kept", "withdrawn")
EDITED = "edited"  #: noted of a mark that was changed in ``marks.csv``; the next marking does not follow it
TO_MARK = "to_mark"  #: the verdict of an answer that waits for a person


class Decision(NamedTuple):
    """Decision of a person on an answer."""

    student: str  #: as it is written
    exercise: str
    seed: str  #: empty for whatever variant they have
    part: str
    kind: str
    points: float | None = None  #: None for all of them
    reason: str = ""
    answer: str | None = None  #: what was seen: another one is not decided on; None for whatever it is
    by: str = ""  #: person, or name of a file
    made: datetime | None = None
    line: int = 0  #: of the file
    location: str = ""  #: the same, for messages

    @property
    def key(self) -> tuple[str, str, str]:
        return folded(self.student), self.exercise, self.part

    @property
    def answer_id(self) -> tuple[str, str, str, str]:
        return self.student, self.exercise, self.seed, self.part

    @property
    def place(self) -> tuple[str, str, str, str]:
        """Place of a step, whose last one a withdrawal takes back."""
        return self.exercise, self.part, self.seed, " ".join((self.answer or "").split())

    def withdrawn(self, **changes: Any) -> Decision:
        """Return the step that takes this decision back."""
        return self._replace(kind=WITHDRAWN, points=None, reason="", **changes)

    @property
    def answer_text(self) -> str:
        return ", ".join(filter(None, self.answer_id))

    @property
    def gives(self) -> Message:
        return (
            Message("full points")
            if self.points is None
            else Message("points {points:g}", points=self.points)
        )

    def mark(self, line: Mark, lang: str) -> Mark:
        """Return the mark of an answer with this decision.

        Raises
        ------
        BadInput
            The part has fewer points.
        """
        if self.kind == KEPT:
            return line.saying(self.reason, self.reason)
        points = line.out_of if self.points is None else self.points
        check_points(points, line.part, line.out_of, self.location or self.by)
        verdict, word = ACCEPTED, "accepted"
        if self.kind == GIVEN:
            verdict = ACCEPTED if points >= line.out_of else "partial" if points > 0 else "wrong"
            word = "by_hand"
        message = f"{words(lang)['marking'][word]} {self.reason}".strip()
        return line._replace(verdict=verdict, points=points, says=message, feedback=message)


def same_text(text: str, other: str) -> bool:
    """Return True if two texts are the same answer apart from spaces and case."""
    return bool(text.strip()) and same_answer(text.casefold(), other.casefold())


def same_answer(text: str, other: str) -> bool:
    """Return True if two texts are the same answer, apart from spaces."""
    return " ".join(text.split()) == " ".join(other.split())


def check_points(points: float, part: str, out_of: float, location: str) -> None:
    """Refuse more points than a part has."""
    if points > out_of:
        raise BadInput(
            "{place}: {points:g} points for {part}, which has {out_of:g}; give at most these",
            place=location,
            points=points,
            part=part,
            out_of=out_of,
        )
