"""Several cases among a few: right where exactly the right ones are named."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated, Tick
from coursework.kinds.ticks import by_letters, lettered_ticks, share_of_named
from coursework.parsing.reading import Reading
from coursework.parsing.several import read_choices

_NONE = "none"  #: what is ticked, and read, where no case is right


def cases_of(value: Any) -> frozenset[str]:
    """Return the names of cases that a reference holds: ``"stable fast"``, ``"stable, fast"``, or a set;
    ``""`` is none."""
    if isinstance(value, (set, frozenset, tuple, list)):
        return frozenset(map(str, value))
    return frozenset(str(value).replace(",", " ").replace(";", " ").split())


class Choices(Kind):
    name = "choices"
    goes_with = ("choices",)
    is_exact = is_text = has_rule = True
    has_symbol = is_called_by_symbol = False
    box = "several"
    family = "choices"
    field = "ticks"
    has_several_ticks = True
    wrong = "wrong_case"
    faults = {"unknown_symbol": "not_a_number", "not_a_choice": "not_choices"}  # noqa: RUF012

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        letters = asking.letters(part)
        labels = {
            case: (*label, *filter(None, [letters.get(case)])) for case, label in asking.labels(part).items()
        }
        return read_choices(answer, labels)

    def ticks(self, part: Stated, asking: Asking) -> tuple[Tick, ...]:
        return (*lettered_ticks(part, asking), Tick(_NONE, ""))

    def from_paper(self, boxes: Sequence[str], part: Stated, asking: Asking, *, unit: bool = False) -> str:
        return by_letters(boxes, part, asking)

    def kept(self, read_as: str) -> Any:
        return cases_of(read_as)

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return 0.0 if cases_of(value) == cases_of(reference) else math.inf

    def share(self, part: Stated, value: Any, reference: Any) -> float:
        return share_of_named(cases_of(value), cases_of(reference), len(part.choices))

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        return (" ".join(sorted(cases_of(value) ^ {part.choices[0]})) or "none",)

    def words(self, value: Any, label: Callable[[str], str]) -> str:
        return "; ".join(label(case) for case in sorted(cases_of(value))) or "∅"

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return ", ".join(sorted(cases_of(value))) or "none"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        cases = [case for case in part.choices if case in cases_of(value)]
        yield AnswerSpelling("exact", ", ".join(cases) or "none")
        yield AnswerSpelling("printed", " ; ".join(label(case) for case in reversed(cases)) or "none")
        yield AnswerSpelling(
            "ticked", "\n".join(f"[{'x' if case in cases else ' '}] {case}" for case in part.choices)
        )
