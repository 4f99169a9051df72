"""The parts that papers ask: which of them a person marks, and how an answer of several pieces is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from coursework.marking.marking import is_right_alone
from coursework.scanning.gathering import PrintedPaper
from coursework.scanning.page_reading import Papers


class Joins:
    """Composition of answers from several coordinates, by the kinds of their questions."""

    def __init__(self, papers: Papers, papers_asked: Mapping[str, PrintedPaper]):
        self._papers = papers
        self._places: dict[tuple[str, int], tuple[str, int]] = {}
        for code in papers_asked:
            for index, record in enumerate(papers.papers[code].records):
                self._places[str(record["exercise"]), int(record["seed"])] = code, index

    def part_of(self, part: tuple[str, int, str]) -> tuple[Any, Any]:
        """Return the variant and the question."""
        variant = self._papers.variant(*self._places[part[:2]])
        return variant, next(p for p in variant.parts if p.id == part[2])

    def unit_of(self, part: tuple[str, int, str]) -> str:
        code, _ = self._places[part[:2]]
        fields = (f for page in self._papers[code] for f in page.fields)
        return next((f.unit_text for f in fields if (f.exercise, f.seed, f.part) == part and f.unit_text), "")

    def is_open(self, part: tuple[str, int, str]) -> bool:
        return bool(self.part_of(part)[1].sort.is_open)

    def is_right(self, part: tuple[str, int, str], answer: str) -> bool:
        """Return True if an answer is right, those being right that are judged with it."""
        variant, question = self.part_of(part)
        return is_right_alone(variant, question, answer)

    def is_drawn(self, part: tuple[str, int, str]) -> bool:
        variant, question = self.part_of(part)
        return question.unit == "mm" and len(question.sort.coordinates(question, variant)) == 2

    def joined(self, part: tuple[str, int, str], texts: Sequence[str]) -> str:
        """Return the texts of several coordinates as one answer; empty if none is written. A ticked unit
        applies to all of them."""
        if not any(text.strip() for text in texts):
            return ""
        return joined_answer(*self.part_of(part), texts, self.unit_of(part))


def joined_answer(variant: Any, question: Any, texts: Sequence[str], unit: str) -> str:
    """Return the texts of several coordinates as one answer, without the ``unit`` behind each."""
    bare = [text.removesuffix(f" {unit}") if unit.strip() else text for text in texts]
    return str(question.sort.from_paper(bare, question, variant, unit=bare != list(texts)))
