"""One decision of a person: on an answer of a student, or a step that is on no single student."""

from __future__ import annotations

import secrets
from collections import Counter
from collections.abc import Iterable
from datetime import datetime
from hashlib import sha256
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.issuing.students import folded
from coursework.language.words import words
from coursework.marking.mark import Mark
from coursework.messages import Message

ACCEPTED, GIVEN, KEPT, WITHDRAWN = KINDS = ("accepted", "given", "kept", "withdrawn")
EDITED = "edited"  #: noted of a mark that was changed in ``marks.csv``; the next marking does not follow it
TO_MARK = "to_mark"  #: the verdict of an answer that waits for a person
_LETTERS = "bcdfghjkmnpqrstvwxz"  #: of an id: a spreadsheet takes it for no number, and a reader for no word
_LENGTH = 6


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
    id: str = ""  #: lasting name, which decisions of one batch share
    withdraws: str = ""  #: id of what a withdrawal takes back; empty for the last on its place

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

    def is_on(self, line: Mark) -> bool:
        """Return True if a step on an answer, whoever gave it, is on this one."""
        return any(same_text(self.answer or "", text) for text in (line.answer, line.read_as))

    def withdrawn(self, **changes: Any) -> Decision:
        """Return the decision that takes this one back."""
        own = {"kind": WITHDRAWN, "points": None, "reason": "", "id": new_id(), "withdraws": self.id}
        return self._replace(**(own | changes))

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


def new_id() -> str:
    """Return an id for a decision that is made now."""
    return "".join(secrets.choice(_LETTERS) for _ in range(_LENGTH))


def with_ids(decisions: Iterable[Decision]) -> list[Decision]:
    """Return decisions of which every step has an id: one that was written without has one of its content,
    the same wherever it is read."""
    met: Counter[tuple[str, ...]] = Counter()
    named = []
    for one in decisions:
        if not one.student and not one.id:
            said = *one.place, one.kind, f"{one.points}", one.by
            met[said] += 1
            digest = sha256("\0".join((*said, f"{met[said]}")).encode("utf-8", "backslashreplace")).digest()
            one = one._replace(id="".join(_LETTERS[byte % len(_LETTERS)] for byte in digest[:_LENGTH]))
        named.append(one)
    return named


def in_force(decisions: Iterable[Decision]) -> list[Decision]:
    """Return the decisions on one answer that are not taken back, in their order: a withdrawal is of what it
    names, and else of all before it."""
    standing: list[Decision] = []
    for one in decisions:
        if one.kind != WITHDRAWN:
            standing.append(one)
        else:
            standing = [other for other in standing if one.withdraws and other.id != one.withdraws]
    return standing


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
