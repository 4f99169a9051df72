"""What became of one answer, and of all of a student."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from coursework.errors import unknown
from coursework.language.words import words
from coursework.marking.feedback import Said
from coursework.model import Part
from coursework.reading.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant


@dataclass(eq=False)
class Mark:
    """What became of one answer. Not to be changed."""

    part: str
    answer: str  #: the text as it came
    read_as: str  #: what was read in it; empty when nothing was
    verdict: str  #: correct, follow_through, mistake:NAME, slip:KIND, wrong, wrong_unit, missing_unit, unreadable or missing
    points: float
    out_of: float
    lang: str
    matches: tuple[str, ...] = ()  #: every verdict that explains this answer, the one given first
    in_other_order: bool = False  #: right because the student exchanged two assemblies
    _tell: Callable[[], Said] = field(default=lambda: Said("", {}), repr=False)

    @cached_property
    def says(self) -> str:
        """What to tell the student, Markdown in the sheet's language; never the reference value."""
        return f"{self._tell().markdown()} {self._note}".rstrip()

    @cached_property
    def feedback(self) -> str:
        """What is said, as one line of plain text."""
        return f"{self._tell().plain(self.lang)} {self._note}".rstrip()

    @property
    def _note(self) -> str:
        return words(self.lang)["marking"]["either_order"] if self.in_other_order else ""

    @property
    def mistakes(self) -> tuple[str, ...]:
        """The named mistakes that give this answer."""
        return tuple(m.partition(":")[2] for m in self.matches if m.startswith("mistake:"))


class Marking(Mapping[str, Mark]):
    """The marks of one student on one variant, by part id."""

    def __init__(self, marks: Mapping[str, Mark]):
        self._marks = dict(marks)

    def __getitem__(self, part: str) -> Mark:
        if part not in self._marks:
            raise unknown("part", part, self._marks)
        return self._marks[part]

    def __iter__(self) -> Iterator[str]:
        return iter(self._marks)

    def __len__(self) -> int:
        return len(self._marks)

    @property
    def points(self) -> float:
        return sum(m.points for m in self._marks.values())

    @property
    def out_of(self) -> float:
        return sum(m.out_of for m in self._marks.values())

    def show(self) -> None:
        """Print the feedback, a line a part, for a notebook or a terminal."""
        for mark in self._marks.values():
            print(f"[{mark.points:g}/{mark.out_of:g}] {mark.feedback}")
        print(f"{self.points:g}/{self.out_of:g}")


def made_mark(
    variant: Variant, part: Part, reading: Reading, verdict: str, share: float, read_as: str,
    tell: Callable[[], Said], matches: tuple[str, ...] = (),
) -> Mark:  # fmt: skip
    points = float(part.points)
    return Mark(
        part.id, reading.text, read_as, verdict, share * points, points, variant.lang, matches, False, tell
    )


#: the sentence about a wrong answer, by kind of part
SENTENCE_OF_WRONG = {
    "choice": "wrong_case",
    "equation": "wrong_equation",
    "direction": "wrong_place",
    "point_on_line": "wrong_place",
}
