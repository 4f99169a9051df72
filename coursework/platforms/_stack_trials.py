"""Trials that a question of STACK carries: answers, and what each is to be worth, so that it proves itself there."""

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

    says: str
    answers: Mapping[int, Any]  #: by the number of the question
    expected: Mapping[int, tuple[float, int]]  #: by the same: share, and the node that gives it


def trials(variant: Variant, trees: Sequence[Tree]) -> Iterator[Trial]:
    """All right; each part wrong in its first, second and third way; one wrong answer and a right method after it."""
    if not trees:
        return
    yield _trial("all answers right", trees, {tree.place: _right(tree) for tree in trees})
    for way in range(_WRONG):
        answers = {tree.place: _wrong(tree, way) for tree in trees}
        yield _trial(f"a known error in each answer, number {way + 1}", trees, answers)
    if any(tree.following for tree in trees):
        yield _trial("one wrong answer, and a right method from it on", trees, _followed(variant, trees))


def _trial(says: str, trees: Sequence[Tree], answers: Mapping[int, Any]) -> Trial:
    own = {place: float(value) for place, value in answers.items() if isinstance(value, (float, int))}
    return Trial(says, answers, {tree.place: tree.share(answers[tree.place], own) for tree in trees})


def _right(tree: Tree) -> Any:
    if tree.posed.kind == NUMBER:
        return tree.posed.intervals[0].value
    names = list(right_cases(tree.posed))
    return names if tree.posed.kind == CHOICES else names[0]


def _wrong(tree: Tree, way: int) -> Any:
    posed = tree.posed
    if posed.kind == NUMBER:
        wrong = [one.value for one in posed.intervals if not one.is_right and not one.turns]
        return wrong[way] if way < len(wrong) else posed.intervals[0].value
    wrong_ones = [case_name(posed, at) for at, option in enumerate(posed.options) if option.share < 1]
    if posed.kind == CHOICE:
        return wrong_ones[way % len(wrong_ones)] if wrong_ones else _right(tree)
    return _right(tree)[way:] or _right(tree)


def _followed(variant: Variant, trees: Sequence[Tree]) -> dict[int, Any]:
    """The first answer that others follow from is wrong; those that follow do so."""
    first = min(place for tree in trees if tree.following for place in tree.following.earlier)
    answers: dict[int, Any] = {}
    for tree in trees:
        answers[tree.place] = _right(tree)
        if tree.place == first:
            answers[first] = answers[first] * _OFF
        elif tree.following:
            own = {place: answers[place] for place in tree.following.earlier if place in answers}
            value = follows(variant, variant.parts[tree.place - 1], own)
            answers[tree.place] = answers[tree.place] if value is None else value
    return answers
