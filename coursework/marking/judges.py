"""Parts that are judged together, where many answers are right: drawn points, lengths that meet demands.

An exercise's part names a judge, and its solution defines it: :func:`coursework.solution.judge`.
"""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coursework.errors import BadCourse, CannotAssemble, CourseworkError, Undefined
from coursework.parsing.reading import Reading
from coursework.solution import Judged

if TYPE_CHECKING:
    from coursework.course.answer_key import Slip
    from coursework.course.asked import KeySource
    from coursework.course.variant import Variant
    from coursework.model import Part


_ALMOST = 0.99  #: of the points, more than which an answer earns that is right and read off a drawing
SHEETS = 64  #: ways at most to read one student's answers to the parts of one judge


def judges_of(variant: KeySource) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the judges of a variant, each with the ids of its parts."""
    names = dict.fromkeys(part.judge for part in variant.parts if part.judge)
    for name in names:
        yield name, tuple(part.id for part in variant.parts if part.judge == name)


def judged(
    variant: KeySource, name: str, answers: Mapping[str, Any], own_answers: Mapping[str, float] | None = None
) -> dict[str, Judged]:
    """Return the judgement of a judge on answers by part id, each a number or coordinates in the part's unit.

    Nothing of an answer that cannot be judged because others are missing. ``own_answers`` holds quantities
    that a student has answered before, to be judged from in place of the right ones.

    Raises
    ------
    BadCourse
        The judge takes no ``answers``, says nothing of one though none is missing, or names a mistake that
        is none.
    """
    solution, source = variant.exercise.solution, f"{variant.exercise.solution.source}: judge {name!r}"
    computed = [n for n in _needs(variant, name) if n in variant.exercise.quantity_names]
    values = {
        **variant.given,
        **solution.graph.evaluate(computed, {**variant.used, **(own_answers or {})}, variant.effects),
    }
    needed = {n: values[n] for n in _needs(variant, name)}
    with np.errstate(all="ignore"):  # what is computed from an absurd answer is not finite, and not right
        judgements = dict(solution.judge(name)(dict(answers), **needed))
    complete = all(part in answers for part in dict(judges_of(variant))[name])
    if complete and (unsaid := sorted(answers.keys() - judgements.keys())):
        raise BadCourse(f"{source} says nothing of {unsaid[0]!r}")
    for verdict in judgements.values():
        for mistake in (verdict.mistake, *verdict.also):
            if mistake and mistake not in solution.mistakes:
                raise BadCourse(f"{source} names a mistake {mistake!r}, which is not among its mistakes")
    return {part: judgements[part] for part in answers if part in judgements}


def _needs(variant: KeySource, name: str) -> list[str]:
    """Return the quantities that a judge takes."""
    first, *needs = _parameters(variant.exercise.solution.judge(name))
    if first != "answers":
        raise BadCourse(
            f"{variant.exercise.solution.source}: judge {name!r}: its first parameter must be 'answers'; "
            f"found {first!r}"
        )
    return needs


@lru_cache(maxsize=256)
def _parameters(function: Callable[..., Any]) -> tuple[str, ...]:
    """Their names; Python takes longer to tell them than most judges to judge."""
    return tuple(inspect.signature(function).parameters)


def is_scale(part: Part) -> bool:
    """Return whether a part asks for the scale of a drawing: so much for a millimetre of paper."""
    return bool(part.judge) and part.sort.is_number and part.unit.endswith("/mm")


class Verdict(NamedTuple):
    """Judgement on one answer of a group: parts of a judge of the solution, or equations of a loop."""

    reading: int  #: which of its honest readings was taken
    said: Judged | None  #: None where it cannot be judged because others are missing
    followed: bool = False  #: judged from the student's own earlier answers
    slip: str = ""  #: what is missed, where that needs no naming by the solution
    about: tuple[str, ...] = ()  #: the quantities that the slip may be about
    trace: str = ""  #: what other answers that show the same slip have in common with it
    left: float = 1.0  #: the share of the points that the answer would earn without the slip

    @property
    def is_wrong(self) -> bool:
        return self.said is not None and self.said.share < 1 and not (self.said.slip or self.slip)


def best_judged(variant: KeySource, name: str, readings: Mapping[str, Reading]) -> dict[str, Verdict]:
    """Return the verdicts of a judge on what was read.

    Where answers may honestly be read in several ways, those are taken that together earn most.
    """
    return _best(variant, name, readings, {}, None)


def judged_again(
    variant: Variant,
    name: str,
    readings: Mapping[str, Reading],
    verdicts: Mapping[str, Verdict],
    own_answers: Mapping[str, float],
    wrong: Collection[str],
) -> dict[str, Verdict]:
    """Return the verdicts of a judge where answers may follow from others, and show slips that nobody need
    name.

    They follow from a student's ``own_answers``, where some quantity that was answered before is ``wrong``.
    """
    if _bears_on(variant, name, wrong):
        verdicts = _best(variant, name, readings, verdicts, own_answers)
    return _without_slips(variant, name, readings, verdicts, own_answers)


def _best(
    variant: KeySource,
    name: str,
    readings: Mapping[str, Reading],
    best: Mapping[str, Verdict],
    own_answers: Mapping[str, float] | None,
) -> dict[str, Verdict]:
    """Return the ``best`` verdicts so far, or those that earn more."""
    points = {part.id: part.points for part in variant.parts}
    read = [i for i in dict(judges_of(variant))[name] if i in readings and readings[i].status == "read"]
    most = sum(points[i] * float(v.said.share) for i, v in best.items() if v.said) if best else -1.0
    ways = itertools.product(*(range(len(readings[i].values)) for i in read))
    if most == sum(points[i] for i in read):
        return dict(best)
    for combination in itertools.islice(ways, SHEETS):
        chosen = dict(zip(read, combination, strict=True))
        answers = {i: readings[i].values[index] for i, index in chosen.items()}
        try:
            judgements = judged(variant, name, answers, own_answers)
        except (CannotAssemble, Undefined):
            if own_answers is None:
                raise
            continue  # nothing follows from the student's own answers
        earned = sum(points[i] * float(verdict.share) for i, verdict in judgements.items())
        if earned > most:
            followed = own_answers is not None
            best, most = {i: Verdict(chosen[i], judgements.get(i), followed) for i in read}, earned
    return dict(best)


def _without_slips(
    variant: Variant,
    name: str,
    readings: Mapping[str, Reading],
    verdicts: Mapping[str, Verdict],
    own_answers: Mapping[str, float],
) -> dict[str, Verdict]:
    """Return the verdicts, with its slip for each number that would be right without one: angles in radians,
    metres.

    A slip that several answers may show is taken from all of them at once, then from each alone: a judge may
    judge each by the others.
    """
    explained = dict(verdicts)
    unexplained = {i for i, v in verdicts.items() if v.is_wrong and v.said and not v.said.mistake}
    parts = {p.id: p for p in variant.parts if p.id in unexplained}
    answers = {i: readings[i].values[verdict.reading] for i, verdict in verdicts.items()}
    showing: dict[Slip, list[str]] = {}
    for i, part in parts.items():
        for slip in variant.key.slips(part):
            if slip.is_common and slip.factor != 1 and not slip.is_turned([answers[i]], part.sort.turn):
                showing.setdefault(slip, []).append(i)
    for slip, ids in showing.items():
        for some in dict.fromkeys((tuple(ids), *((i,) for i in ids))):
            left = [i for i in some if not explained[i].slip]
            if not left:
                continue
            own = own_answers if explained[left[0]].followed else None
            try:
                said = judged(variant, name, answers | {i: slip.mended(answers[i]) for i in left}, own)
            except CourseworkError:
                continue  # nothing comes of such numbers
            # A value that is read off nothing has a wide margin: a power of ten fits by chance.
            enough = 0.0 if slip.kind == "radians" else _ALMOST
            for i in left:
                if i in said and said[i].share > enough and not said[i].mistake:
                    trace, right = slip.trace(parts[i].unit), float(said[i].share)
                    explained[i] = explained[i]._replace(
                        said=Judged(0.0), slip=slip.kind, trace=trace, left=right
                    )
    return explained


def _bears_on(variant: KeySource, name: str, wrong: Collection[str]) -> bool:
    solution, needs = variant.exercise.solution, set(_needs(variant, name))
    return any(q in needs or needs & solution.depending_on(q) for q in wrong)
