"""Marking: a student's texts against the reference, part by part.

Answers are data: they are read, never run. What is not right is looked up, in this order, among what
follows rightly from the student's own earlier answers, the named mistakes of the solution, and the slips that
need no naming; nothing of that is computed for an answer that is right.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.answer_key import Key
from coursework.errors import CourseworkError, WrongValue, unknown
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.marking.attempts import sheet_of
from coursework.marking.calculator import is_in_radians
from coursework.marking.deduplicate_penalties import signs_counted_once
from coursework.marking.diagnosis import EarlierAnswers, fits_followed, nearest_reading
from coursework.marking.doubtful import settled
from coursework.marking.error_messages import mark_wrong, shown_as
from coursework.marking.exchanged import Exchange, exchanged
from coursework.marking.feedback import Sentence, echo, part_name, questions, say, say_not_read
from coursework.marking.joint_marking import mark_judged, shares_remark, waits_for
from coursework.marking.judges import Verdict, best_judged, is_scale, judged, judged_again, judges_of
from coursework.marking.loop_judge import loop_verdicts
from coursework.marking.mark import Mark, SheetMarks, made_mark
from coursework.model import Part
from coursework.parsing.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant

#: Of the largest number of an answer, within which one that a judge takes is the reference's own.
_NEAR = 0.02


def mark(variant: Variant, answers: Mapping[str, Any], known: Mapping[str, str] | None = None) -> SheetMarks:
    """Mark the answers to a variant; a part left out is missing.

    Parts that are ``known`` to be right, with their numbers as read, are not marked again, and are not in
    the marking.

    Raises
    ------
    UnknownName
        An answer to a part that the variant does not ask.
    WrongValue
        The answers are not a mapping of parts, named by texts.
    NoSolution
        The course folder has no solutions.
    """
    parts = {p.id: p for p in variant.parts}
    if not isinstance(answers, Mapping):
        raise WrongValue(
            "answers are given by part: {{'{part}': '12 mm'}}; found {found}",
            part=next(iter(parts)),
            found=type(answers).__name__,
        )
    for part_id in answers:
        if not isinstance(part_id, str):
            raise WrongValue("a part is named by a text; found {found}", found=type(part_id).__name__)
        if part_id not in parts:
            raise unknown("part", part_id, parts, f"{variant.exercise.name} {variant.seed}")
    key, known = variant.key, known or {}
    readings = {i: read(variant, p, answers.get(i)) for i, p in parts.items() if i not in known}
    readings = settled(variant, readings, answers)
    target = _targets(variant, readings, key)
    together = loop_verdicts(variant, readings)
    by_judge = {
        name: best_judged(variant, name, readings)
        for name, ids in judges_of(variant)
        if any(i in readings for i in ids)
    }
    before = EarlierAnswers(sheet=sheet_of(parts, readings, known, key))
    alone = [i for i, p in parts.items() if i not in known and not p.judge and i not in together]
    nearest_of = {i: nearest_reading(parts[i], readings[i], key, parts[target[i]]) for i in alone}
    wrong = {i: readings[i] for i, (_, gap) in nearest_of.items() if gap > 1 and target[i] == i}
    elsewhere: dict[str, Exchange] = {}
    if len(wrong) > 1:
        before.in_radians = is_in_radians(key, ((parts[i], reading) for i, reading in wrong.items()))
    drawn = {i: verdict for verdicts in by_judge.values() for i, verdict in verdicts.items()}
    wrong |= {i: readings[i] for i, verdict in drawn.items() if verdict.is_wrong}
    if len(wrong) > 1 and before.sheet.has_work and (not before.in_radians or len(wrong) == 2):
        elsewhere = exchanged(variant, readings, wrong, drawn, is_guessed=before.sheet.is_guessed)
        before.in_radians = before.in_radians and not elsewhere
        placed = {way.part.id: way.reading for way in elsewhere.values() if way.part.judge}
        for name in {parts[i].judge for i in placed}:
            by_judge[name] = best_judged(variant, name, {**readings, **placed})
    marks: dict[str, Mark] = {}
    no_scale: set[str] = set()
    waiting: dict[str, dict[str, frozenset[str]]] = {}
    for i, part in parts.items():
        if i in known:
            before.own[part.quantity] = part.sort.kept(known[i])
            before.right.add(part.quantity)
            continue
        judged_by, reading = parts[target[i]], readings[i]
        if part.judge and i not in together:
            name = part.judge
            together |= judged_again(variant, name, readings, by_judge[name], before.own, before.wrong)
        if i in elsewhere and elsewhere[i].part.id not in marks and _follows(key, part, reading, before):
            del elsewhere[elsewhere[i].part.id], elsewhere[i]
        if i in elsewhere:
            named = _named_exchange(key, drawn.get(i))
            marks[i] = _mark_exchanged(variant, key, part, elsewhere[i], named, marks)
            before.take_right(elsewhere[i].part, elsewhere[i].reading, elsewhere[i].place)
            continue
        if i in together:
            nearest = together[i].reading, math.inf
            tellers = (p for j, p in parts.items() if j in marks and j not in no_scale)
            teller = next((p for p in tellers if shares_remark(p, part, together)), None)
            missed = partial(waits_for, variant, part, readings, waiting)
            marks[i] = mark_judged(variant, key, part, reading, together[i], teller, missed, before)
            if is_scale(part) and reading.values[nearest[0]] <= 0:
                no_scale.add(i)
                read_as = echo(marks[i].read_as, variant.lang)
                says, feedback = say(variant, part, "scale", read=read_as).texts(variant.lang)
                marks[i] = marks[i]._replace(says=says, feedback=feedback)
        else:
            nearest = nearest_of.get(i) or nearest_reading(part, reading, key, judged_by)
            marks[i] = _mark_part(variant, key, part, reading, judged_by, nearest, before)
        before.take(key, judged_by, reading, nearest[0], marks[i].verdict, marks[i].matches)
    marks = signs_counted_once(variant, marks, key.rules.follow_through)
    for i in marks:
        if target[i] != i and marks[i].verdict == "correct":
            note = Sentence(words(variant.lang)["marking"]["either_order"], {})
            marks[i] = marks[i]._replace(in_other_order=True).saying(*note.texts(variant.lang))
    return SheetMarks(marks)


def mark_alone(variant: Variant, part: Part, answer: Any) -> Mark:
    """Return the mark of an answer on an otherwise empty sheet, to a part that neither a judge nor the order
    of others decides; the other parts are not read."""
    reading = settled(variant, {part.id: read(variant, part, answer)}, {part.id: answer})[part.id]
    nearest = nearest_reading(part, reading, variant.key, part)
    return _mark_part(variant, variant.key, part, reading, part, nearest, EarlierAnswers())


def is_right_alone(variant: Variant, part: Part, answer: Any) -> bool:
    """Return whether an answer is the right one where those are right that are judged with it, in any order
    in which whole groups may be exchanged. Of many answers that a judge takes, only what is near the
    reference is."""
    groups = [group for group in variant.exercise.spec.either_order if part.id in group]
    if not part.judge and not groups:
        return mark_alone(variant, part, answer).verdict == "correct"
    reading = settled(variant, {part.id: read(variant, part, answer)}, {part.id: answer})[part.id]
    if reading.status != "read":
        return False
    reference, parts = variant.key.reference, {p.id: p for p in variant.parts}
    if part.judge:
        right = {p.id: reference[p.quantity] for p in variant.parts if p.judge == part.judge}
        near = [value for value in reading.values if _is_near(value, right[part.id])]
        with suppress(CourseworkError):  # a judge may find no mechanism of such numbers
            return any(
                judged(variant, part.judge, {**right, part.id: value})[part.id].share >= 1 for value in near
            )
        return False
    place = groups[0].index(part.id)
    others = [parts[group[place]] for group in variant.exercise.spec.either_order]
    return any(nearest_reading(part, reading, variant.key, other)[1] <= 1 for other in others)


def _is_near(value: Any, reference: Any) -> bool:
    """Return whether each of some numbers is near the reference, on the scale of the largest of them."""
    found, wanted = np.asarray(value), np.asarray(reference)
    if found.shape != wanted.shape or found.dtype.kind not in "ifc" or wanted.dtype.kind not in "ifc":
        return False
    return bool(np.abs(found - wanted).max(initial=0) <= _NEAR * np.abs(wanted).max(initial=0))


def _targets(variant: Variant, readings: Mapping[str, Reading], key: Key) -> dict[str, str]:
    """For each part id, the part whose reference it is judged by.

    Itself, save where the exercise lets whole groups be exchanged and the exchange fits better.
    """
    targets = {p.id: p.id for p in variant.parts}
    parts = {p.id: p for p in variant.parts}
    groups = [g for g in variant.exercise.spec.either_order if all(i in readings for i in g)]
    if not groups:
        return targets

    def fitting(target: Mapping[str, str]) -> int:
        members = itertools.chain(*groups)
        return sum(nearest_reading(parts[i], readings[i], key, parts[target[i]])[1] <= 1 for i in members)

    answered = sum(readings[i].status == "read" for i in itertools.chain(*groups))
    # An exchange is meant where most of what is answered fits it: one answer may fit by chance.
    best, best_score = targets, max(fitting(targets), answered / 2)
    for order in itertools.permutations(groups):
        target = {
            **targets,
            **{i: j for g, h in zip(groups, order, strict=True) for i, j in zip(g, h, strict=True)},
        }
        score = fitting(target)
        if score > best_score:
            best, best_score = target, score
    return best


def _follows(key: Key, part: Part, reading: Reading, before: EarlierAnswers) -> bool:
    """Return whether an answer follows from earlier ones in its own box."""
    return (
        reading.status == "read"
        and not part.judge
        and bool(before.wrong)
        and fits_followed(key, part, reading, part, before.own, before.wrong) is not None
    )


def _named_exchange(key: Key, verdict: Verdict | None) -> str:
    """Return the mistake that a judge names of an answer, where that is an exchange itself; else ""."""
    name = verdict.said.mistake if verdict and verdict.said else ""
    return name if name and key.solution.mistakes[name].kind == "exchanged" else ""


def _mark_exchanged(
    variant: Variant, key: Key, part: Part, exchange: Exchange, named: str, marks: Mapping[str, Mark]
) -> Mark:
    """Return the mark of an answer that stands in the box of another: the exchange is paid for where it is
    first met, and there described in the words of the mistake that is ``named``, if any."""
    other, reading = exchange.part, exchange.reading
    read_as, read = shown_as(variant, other, reading, exchange.place)
    mark_of = partial(made_mark, variant, part, reading)
    pieces = {
        "read": read,
        "other": part_name(variant, other),
        "where": questions(variant, [other.id], "and"),
    }
    matches = ("slip:exchanged", f"mistake:{named}") if named else ("slip:exchanged",)
    if other.id in marks:
        message = say(variant, part, "exchanged_again", **pieces)
        return mark_of("follow_through", key.rules.follow_through, read_as, message, matches)
    share = key.rules.share("exchanged")
    mark = mark_of("slip:exchanged", share, read_as, say(variant, part, "slip_exchanged", **pieces), matches)
    return (
        mark.saying(*Sentence("{says}", {"says": variant.mistake_text(named)}).texts(variant.lang))
        if named
        else mark
    )


def _mark_part(
    variant: Variant,
    key: Key,
    part: Part,
    reading: Reading,
    judged_by: Part,
    nearest: tuple[int, float],
    before: EarlierAnswers,
) -> Mark:
    mark_of = partial(made_mark, variant, part, reading)
    if reading.status == "to_mark" or (reading.status == "read" and part.sort.is_open):
        return mark_of("to_mark", 0.0, "", say(variant, part, "to_mark"))
    if reading.status != "read":
        return mark_of(reading.status, 0.0, "", say_not_read(variant, part, reading))
    index, gap = nearest
    if gap > 1:
        return mark_wrong(variant, key, part, reading, judged_by, before)
    read_as, read = shown_as(variant, part, reading, index)
    if part.asks_unit and not reading.unit_given:
        return mark_of("missing_unit", 0.0, read_as, say(variant, part, "missing_unit", read=read))
    return mark_of("correct", 1.0, read_as, say(variant, part, "correct", read=read))
