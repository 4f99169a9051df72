"""What was given for one sheet."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from coursework.language.words import words
from coursework.marking.mark import Mark
from coursework.markup.markdown import plain_line


class Line(NamedTuple):
    """A mark as plain data: what a line of ``marks.csv`` and a feedback sheet say."""

    part: str
    answer: str
    read_as: str
    verdict: str
    points: float
    out_of: float
    says: str  #: Markdown
    feedback: str  #: one line of plain text
    matches: tuple[str, ...]

    @staticmethod
    def of(mark: Mark, *, printed: bool) -> Line:
        """``printed``: with the Markdown that a feedback sheet needs. What could not be read is said to wait."""
        says, feedback = mark.says if printed else "", mark.feedback
        if mark.verdict == "unreadable":
            waits = words(mark.lang)["marking"]["waits"]
            says, feedback = f"{says} {waits}", f"{feedback} {plain_line(waits, mark.lang)}"
        return Line(
            mark.part, mark.answer, mark.read_as, mark.verdict, mark.points, mark.out_of,
            says, feedback, mark.matches,
        )  # fmt: skip


class Graded(NamedTuple):
    """One student's marked sheet: a line for each part asked; ``answered`` names those that came."""

    student: str
    exercise: str
    seed: int
    lines: Mapping[str, Line]
    answered: tuple[str, ...]
    record: Mapping[str, Any]  #: what was issued, in the language of the sheet that came back
    unanswered: tuple[str, ...] = ()  #: parts accepted by hand that no row answers

    @property
    def points(self) -> float:
        return sum(line.points for line in self.lines.values())

    @property
    def out_of(self) -> float:
        return sum(line.out_of for line in self.lines.values())
