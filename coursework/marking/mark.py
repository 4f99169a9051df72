"""Marks of one answer, and of all answers of a student."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from coursework.errors import unknown
from coursework.marking.feedback import Sentence
from coursework.model import Part
from coursework.parsing.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant

#: Verdicts of answers that wait for a person: they are not the last word.
WAITING = ("to_mark", "unreadable")


class Mark(NamedTuple):
    """Judgement of one answer: plain data, from the marking to the tables and the feedback."""

    part: str
    answer: str  #: the text as it came
    read_as: str  #: what was read in it; empty when nothing was
    #: Correct, follow_through, mistake:NAME, slip:KIND, partial, wrong, wrong_unit, missing_unit, unreadable,
    #: to_mark or missing.
    verdict: str
    points: float
    out_of: float
    lang: str
    matches: tuple[str, ...] = ()  #: every verdict that explains this answer, the one given first
    in_other_order: bool = False  #: right because the student exchanged two assemblies
    says: str = ""  #: feedback, Markdown in the sheet's language; it never states the reference value
    feedback: str = ""  #: the same as one line of plain text

    def saying(self, says: str, feedback: str) -> Mark:
        """Return the mark with one more sentence, Markdown and plain text."""
        more = (" ".join(filter(None, texts)) for texts in ((self.says, says), (self.feedback, feedback)))
        return self._replace(says=next(more), feedback=next(more))

    @property
    def mistakes(self) -> tuple[str, ...]:
        """The named mistakes that give this answer."""
        return tuple(m.partition(":")[2] for m in self.matches if m.startswith("mistake:"))


class SheetMarks(Mapping[str, Mark]):
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
    variant: Variant,
    part: Part,
    reading: Reading,
    verdict: str,
    share: float,
    read_as: str,
    message: Sentence,
    matches: tuple[str, ...] = (),
) -> Mark:
    """Return the mark of an answer that earns a share of its part's points."""
    points = float(part.points)
    return Mark(
        part.id,
        reading.text,
        read_as,
        verdict,
        share * points,
        points,
        variant.lang,
        matches,
        False,
        *message.texts(variant.lang),
    )
