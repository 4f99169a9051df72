"""Self-tests of a STACK question: answers with the expected marks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from coursework.course.variant import Variant
from coursework.platforms._stack_following import follows
from coursework.platforms._stack_trees import Tree, case_name, right_cases
from coursework.platforms.posed import CHOICE, CHOICES, NUMBER

_WRONG = 3  #: trials of wrong answers
_OFF = 1.3  #: by how much the first answer is wrong that the others follow from


@dataclass(frozen=True)
class Trial:
    """Answers to a whole variant."""

    message: str
    answers: Mapping[int, Any]  #: by the number of the question
    expected: Mapping[int, tuple[float, int]]  #: by the same: share, and the node that gives it


def trials(variant: Variant, trees: Sequence[Tree]) -> Iterator[Trial]:
    """Return the self-tests: all right; each part wrong in three ways; one wrong answer followed by a right
    method."""
    if not trees:
        return
    yield _trial("all answers right", trees, {tree.part_number: _right(tree) for tree in trees})
    for variation in range(_WRONG):
        answers = {tree.part_number: _wrong(tree, variation) for tree in trees}
        yield _trial(f"a known error in each answer, number {variation + 1}", trees, answers)
    if any(tree.following for tree in trees):
        yield _trial("one wrong answer, and a right method from it on", trees, _followed(variant, trees))


def _trial(message: str, trees: Sequence[Tree], answers: Mapping[int, Any]) -> Trial:
    numbers = {number: float(value) for number, value in answers.items() if isinstance(value, (float, int))}
    return Trial(
        message, answers, {tree.part_number: tree.share(answers[tree.part_number], numbers) for tree in trees}
    )


def _right(tree: Tree) -> Any:
    if tree.posed.kind == NUMBER:
        return tree.posed.intervals[0].value
    names = list(right_cases(tree.posed))
    return names if tree.posed.kind == CHOICES else names[0]


def _wrong(tree: Tree, variation: int) -> Any:
    posed = tree.posed
    if posed.kind == NUMBER:
        wrong = [
            interval.value for interval in posed.intervals if not interval.is_right and not interval.turns
        ]
        return wrong[variation] if variation < len(wrong) else posed.intervals[0].value
    wrong_ones = [case_name(posed, at) for at, option in enumerate(posed.options) if option.share < 1]
    if posed.kind == CHOICE:
        return wrong_ones[variation % len(wrong_ones)] if wrong_ones else _right(tree)
    return _right(tree)[variation:] or _right(tree)


def _followed(variant: Variant, trees: Sequence[Tree]) -> dict[int, Any]:
    """Return the test with a wrong first answer and later answers that follow from it."""
    first = min(number for tree in trees if tree.following for number in tree.following.earlier)
    answers: dict[int, Any] = {}
    for tree in trees:
        answers[tree.part_number] = _right(tree)
        if tree.part_number == first:
            answers[first] = answers[first] * _OFF
        elif tree.following:
            numbers = {number: answers[number] for number in tree.following.earlier if number in answers}
            value = follows(variant, variant.parts[tree.part_number - 1], numbers)
            answers[tree.part_number] = answers[tree.part_number] if value is None else value
    return answers
