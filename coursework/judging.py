"""Parts that are judged together, where many answers are right: drawn points, lengths that meet demands.

An exercise's part names a judge, and its solution defines it: :func:`coursework.solution.judge`.
"""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from coursework.errors import BadCourse
from coursework.reading import Reading
from coursework.solution import Judged

if TYPE_CHECKING:
    from coursework.course import Variant

SHEETS = 64  #: ways at most to read one student's answers to the parts of one judge


def judges_of(variant: Variant) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The judges of a variant, each with the ids of its parts."""
    names = dict.fromkeys(part.judge for part in variant.parts if part.judge)
    for name in names:
        yield name, tuple(part.id for part in variant.parts if part.judge == name)


def judged(variant: Variant, name: str, answers: Mapping[str, Any]) -> dict[str, Judged]:
    """What a judge says of answers by part id, each a number or coordinates in the part's unit.

    Raises
    ------
    BadCourse
        The judge takes no ``answers``, says nothing of one of them, or names a mistake that is none.
    """
    solution, source = variant.exercise.solution, f"solutions/{variant.exercise.name}.py: judge {name!r}"
    function = solution.judge(name)
    first, *needs = inspect.signature(function).parameters
    if first != "answers":
        raise BadCourse(f"{source}: its first parameter must be 'answers'; found {first!r}")
    computed = [n for n in needs if n in variant.exercise.quantity_names]
    values = solution.graph.evaluate(computed, variant.used, variant.effects)
    found = dict(
        function(dict(answers), **{n: values[n] if n in values else variant.given[n] for n in needs})
    )
    if unsaid := sorted(answers.keys() - found.keys()):
        raise BadCourse(f"{source} says nothing of {unsaid[0]!r}")
    for verdict in found.values():
        if verdict.mistake and verdict.mistake not in solution.mistakes:
            raise BadCourse(f"{source} names a mistake {verdict.mistake!r}, which is not among its mistakes")
    return {part: found[part] for part in answers}


def best_judged(variant: Variant, readings: Mapping[str, Reading]) -> dict[str, tuple[int, Judged]]:
    """For each part of a judge that was read: which of its honest readings to take, and its verdict.

    Where answers may honestly be read in several ways, those are taken that together earn most.
    """
    points = {part.id: part.points for part in variant.parts}
    found: dict[str, tuple[int, Judged]] = {}
    for name, parts in judges_of(variant):
        read = [i for i in parts if i in readings and readings[i].status == "read"]
        best, most = {}, -1.0
        ways = itertools.product(*(range(len(readings[i].values)) for i in read))
        for way in itertools.islice(ways, SHEETS):
            chosen = dict(zip(read, way, strict=True))
            said = judged(variant, name, {i: readings[i].values[place] for i, place in chosen.items()})
            earned = sum(points[i] * float(verdict.share) for i, verdict in said.items())
            if earned > most:
                best, most = {i: (chosen[i], verdict) for i, verdict in said.items()}, earned
        found |= best
    return found
