"""Marked sheet of a student."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from coursework.marking.mark import WAITING, Mark


class Graded(NamedTuple):
    """Marked sheet of a student: a mark for each part; ``answered`` names the parts with an answer."""

    student: str
    exercise: str
    seed: int
    lines: Mapping[str, Mark]
    answered: tuple[str, ...]
    record: Mapping[str, Any]  #: issued record, in the language of the returned sheet
    unanswered: tuple[str, ...] = ()  #: parts accepted by hand that no row answers
    sitting: int = 1
    submitted: str = ""  #: when, where a platform tells it
    apart: bool = False  #: a platform asked these parts alone of this variant
    settled: tuple[str, ...] = ()  #: parts on whose answer a person has decided

    @property
    def points(self) -> float:
        return sum(line.points for line in self.lines.values())

    @property
    def has_answer(self) -> bool:
        return any(line.verdict != "missing" for line in self.lines.values())

    @property
    def open(self) -> int:
        """Number of answers that wait for a person."""
        return sum(line.verdict in WAITING and part not in self.settled for part, line in self.lines.items())

    @property
    def out_of(self) -> float:
        return sum(line.out_of for line in self.lines.values())
