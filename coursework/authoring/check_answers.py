"""Simulated students: exact ones, who round, who make each known mistake, who follow from an error, who write
nonsense."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from coursework.authoring.check_report import KEPT_DIGITS, CheckReport
from coursework.course.answer_key import Key, envelopes
from coursework.course.exercise import CourseExercise
from coursework.course.variant import Variant
from coursework.issuing.flaws import SHOWN, judged_wrong, visibility
from coursework.marking.judges import judged, judges_of
from coursework.marking.marking import mark as grade
from coursework.model import Part
from coursework.parsing.reading import MOST_TURNS
from coursework.quantities.rounding import student_who_rounds

NONSENSE = (
    "?",
    "je ne sais pas",
    "12 +",
    "nan",
    "9**9**9",
    "1 = 1 = 1",
    "__import__('os')",
    "((((",
    *(
        "same as above",
        "voir au dos",
        "I ran out of time",
        "pas le temps de finir",
        "see question: 3",
        "not a hinge, or is it",
    ),
)
EXTREMES = ("0", "1e308", "-1e308", "1e-320")  #: coordinates too


# ---------------------------------------------------------------------- marking


def check_right_answers(variant: Variant, key: Key, report: CheckReport) -> None:
    """Right answers mark right however they are written, and on the tolerance's edge."""
    for spelling in spellings(variant, key):
        marking = grade(variant, spelling)
        for part_id in spelling:
            mark = marking[part_id]
            report.counts["right answers"] += 1
            if mark.verdict != "correct":
                report.fail(
                    f"seed {variant.seed}: {part_id} = {spelling[part_id]!r} is right "
                    f"but marks {mark.verdict} (read as {mark.read_as!r})"
                )


def spellings(variant: Variant, key: Key) -> Iterator[dict[str, Any]]:
    """Yield the right answers of a variant in the ways people write them."""
    sheets: dict[str, dict[str, Any]] = {spelling: {} for spelling in ("exact", "printed", "comma", "edge")}
    for part in variant.parts:
        if part.sort.is_open:
            continue
        for spelling, answer in part.sort.spellings(
            part, key.reference[part.quantity], partial(variant.label, part.id)
        ):
            sheets.setdefault(spelling, {})[part.id] = answer
    # Parts that are judged together stand on a sheet together.
    context = {part.id: sheets["printed"][part.id] for part in variant.parts if part.judge}
    if not context.keys().isdisjoint(sheets["comma"]):
        sheets["comma"] = context | sheets["comma"]
    yield from filter(None, sheets.values())


def check_rounding_students(
    exercise: CourseExercise,
    drawn: Sequence[Variant],
    report: CheckReport,
    digits: Sequence[int] = KEPT_DIGITS,
) -> None:
    """Check that a student who does everything right, and rounds to the expected digits at every step, is
    marked right."""
    given = {
        n: np.array([v.given[n] for v in drawn]) for n in exercise.spec.given if n in exercise.quantity_names
    }
    effects, graph = exercise.spec.effects, exercise.solution.graph
    wanted = tuple(dict.fromkeys(p.quantity for p in exercise.spec.parts if not p.is_exact))
    ranks = {p.quantity: p.sort.rank for p in exercise.spec.parts}
    for digits_kept in digits if wanted else ():
        rounded = student_who_rounds(graph, wanted, given, effects, digits_kept)
        widths = envelopes(exercise, wanted, given, effects, min(digits_kept, exercise.folder.rules.digits))
        for index, variant in enumerate(drawn):
            if digits_kept >= exercise.folder.rules.digits:
                own_answers = {q: _at(v, index, len(drawn), ranks[q]) for q, v in rounded.items()}
                _check_rounded_together(variant, own_answers, report)
            for part in variant.parts:
                if not part.has_margin:
                    continue
                value = _at(rounded[part.quantity], index, len(drawn), part.sort.rank)
                width = _at(widths[part.quantity], index, len(drawn))
                along = variant.key.reference.get(part.along)
                gap = part.sort.distance(
                    part, value, variant.key.reference[part.quantity], along, float(width)
                )
                report.counts[f"rounding to {digits_kept}"] += 1
                report.counts[f"outside the usual margin at {digits_kept}"] += bool(
                    part.sort.distance(part, value, variant.key.reference[part.quantity], along) > 1
                )
                if not gap <= 1:
                    report.fail(
                        f"seed {variant.seed}: who rounds each step to {digits_kept} digits lands "
                        f"{gap:.3g} half-widths "
                        f"from {part.id}"
                    )


def _check_rounded_together(variant: Variant, own_answers: Mapping[str, Any], report: CheckReport) -> None:
    """Check the same of parts that are judged together, whose margin does not follow the rounding."""
    parts = {part.id: part for part in variant.parts}
    for name, ids in judges_of(variant):
        answers = {
            i: own_answers.get(parts[i].quantity, variant.key.reference[parts[i].quantity]) for i in ids
        }
        for i, verdict in judged(variant, name, answers).items():
            report.counts["rounded, judged together"] += 1
            if verdict.share != 1:
                report.fail(f"seed {variant.seed}: {name} refuses {i} of who rounds each step")


def _at(column: Any, index: int, count: int, rank: int = 0) -> Any:
    varies = isinstance(column, np.ndarray) and column.ndim > rank and column.shape[0] == count
    return column[index] if varies else column


def check_mistakes(variant: Variant, key: Key, report: CheckReport) -> None:
    """Each named mistake that shows is marked as that mistake, and never as right.

    Mistakes that show on different parts stand on one sheet, unless parts may be exchanged.
    """
    sheets: list[dict[str, tuple[str, Any]]] = []
    apart = bool(variant.exercise.spec.either_order)
    for name in key.solution.mistakes:
        tally = report.mistakes.setdefault(name, Counter())
        reported = {}
        for part, seen in visibility(key, name):
            tally[seen] += 1
            if seen == "shown":
                reported[part.id] = (name, _written(key.wrong[name][part.quantity]))
        # What stands beside the shown answers where they are judged as a group.
        context = {i: ("", _written(v)) for _, answers in judged_wrong(key, name) for i, v in answers.items()}
        sheet = next((s for s in sheets if not (apart or context) and s.keys().isdisjoint(reported)), None)
        if sheet is None:
            sheets.append({**context, **reported})
        else:
            sheet |= reported
    for sheet in sheets:
        _check_recognised(variant, sheet, report)


def check_slips(variant: Variant, key: Key, report: CheckReport) -> None:
    """Check that a slip that shows is recognised, and earns nothing that a right answer does.

    The first slip of every part on one sheet, then the second of every part, and so on.
    """
    reported: list[dict[str, tuple[str, Any]]] = []
    for part in (part for part in variant.parts if not part.sort.is_open):
        reference, width = key.reference[part.quantity], key.envelope.get(part.quantity, 0.0)
        slips = [
            s
            for s in key.slip_values(part)
            if not (
                part.sort.turn and abs(s[1]) > MOST_TURNS * part.sort.turn
            )  # no direction is read from it
            and part.sort.distance(part, s[1], reference, None, width) > SHOWN
            and not _answers_another(key, part, s[1])
        ]
        for index, slip in enumerate(slips):
            reported += [{}] * (index + 1 - len(reported))
            reported[index] = {**reported[index], part.id: slip}
    for sheet in reported:
        marking = grade(variant, {part_id: value for part_id, (_, value) in sheet.items()})
        for part_id, (kind, value) in sheet.items():
            mark = marking[part_id]
            if mark.in_other_order:
                continue  # it is the right answer of the other assembly
            report.counts["slips recognised"] += 1
            if f"slip:{kind}" not in mark.matches:
                report.fail(
                    f"seed {variant.seed}: slip {kind} on {part_id} ({value!r}) marks {mark.verdict}, "
                    f"not slip:{kind}"
                )


def _answers_another(key: Key, part: Part, value: Any) -> bool:
    """Return whether a wrong value is the right one of another question: two answers exchanged are no
    slip."""
    return any(
        other.quantity != part.quantity
        and other.kind == part.kind
        and other.sort.distance(
            other, value, key.reference[other.quantity], None, key.envelope.get(other.quantity, 0.0)
        )
        <= 1
        for other in key.variant.parts
    )


def check_follow_through(variant: Variant, key: Key, report: CheckReport) -> None:
    """Check that a student who errs once, much or little, and goes on rightly, is marked wrong once."""
    parts = [p for p in variant.parts if p.sort.is_followed and not p.judge]
    half = parts[variant.seed % 2 :: 2] or parts  # the other half on the next variant
    for first, wrong in ((part, value) for part in half for value in _little_and_much(part, key)):
        answers, expected, before = {first.id: wrong}, {}, {first.quantity: wrong}
        for part in parts[parts.index(first) + 1 :]:
            follows = key.followed(part, before, (first.quantity,))
            if follows is not None:
                answers[part.id] = expected[part.id] = before[part.quantity] = follows
        marking = grade(variant, answers)
        for part_id in expected:
            report.counts["follow-through"] += 1
            if (mark := marking[part_id]).verdict not in ("correct", "follow_through"):
                report.fail(
                    f"seed {variant.seed}: {part_id} follows from a wrong {first.id} but marks {mark.verdict}"
                )
        _check_follows_together(variant, key, first, wrong, report)


def _little_and_much(part: Part, key: Key) -> tuple[Any, ...]:
    """Wrong answers just beyond what is accepted, and far from it; of cases and counts, another one."""
    return part.sort.others(part, key.reference[part.quantity], key.half_width(part))


def _check_follows_together(variant: Variant, key: Key, first: Part, wrong: Any, report: CheckReport) -> None:
    """Check the same of parts that are judged together."""
    parts = {part.id: part for part in variant.parts}
    own_answers = {first.quantity: wrong}
    for name, ids in judges_of(variant):
        follows = {i: key.followed(parts[i], own_answers, own_answers) for i in ids}
        if None in follows.values() or any(
            v.share != 1 for v in judged(variant, name, follows, own_answers).values()
        ):
            continue  # what is asked cannot be had from there
        marking = grade(variant, {first.id: wrong, **follows})
        report.counts["follow-through"] += len(ids)
        for i in ids:
            if marking[i].verdict not in ("correct", "follow_through"):
                report.fail(
                    f"seed {variant.seed}: {i} follows from a wrong {first.id} but marks {marking[i].verdict}"
                )


def _written(value: Any) -> Any:
    """Return a value as a student may write it: a vector by its coordinates, a matrix as lists, several cases
    by their names."""
    if isinstance(value, np.ndarray) and value.ndim == 2:
        return str(value.tolist())
    return "; ".join(map(repr, value.tolist())) if isinstance(value, np.ndarray) else value


def _check_recognised(variant: Variant, sheet: Mapping[str, tuple[str, Any]], report: CheckReport) -> None:
    """Check that the mistakes on a sheet are recognised; by part the name of each, if any, and the answer
    that it gives."""
    marking = grade(variant, {part_id: answer for part_id, (_, answer) in sheet.items()})
    exchanges = {
        name for mark in marking.values() if "slip:exchanged" in mark.matches for name in mark.mistakes
    }
    for part_id, (name, answer) in sheet.items():
        if not name or (name in exchanges and marking[part_id].verdict == "correct"):
            continue  # two answers that are exchanged leave the others to the same judge right
        mark = marking[part_id]
        if mark.in_other_order:
            continue  # it is the right answer of the other assembly
        if mark.verdict == "slip:not_drawn":
            continue  # read off a wrong drawing, and reported as such
        report.counts["mistakes recognised"] += 1
        if name not in mark.mistakes:
            report.fail(
                f"seed {variant.seed}: mistake {name} on {part_id} ({answer!r}) marks {mark.verdict}, "
                f"not mistake:{name}"
            )


def check_nonsense(variant: Variant, report: CheckReport) -> None:
    """Nonsense is unreadable or wrong, never right, and never stops the marking."""
    for nonsense in NONSENSE:
        marking = grade(variant, dict.fromkeys((p.id for p in variant.parts), nonsense))
        for part_id, mark in marking.items():
            report.counts["nonsense"] += 1
            if mark.points and mark.verdict == "correct":
                report.fail(f"seed {variant.seed}: {nonsense!r} marks correct on {part_id}")
            elif mark.points:
                report.fail(f"seed {variant.seed}: {nonsense!r} earns {mark.points:g} on {part_id}")
    for number in EXTREMES:
        _check_extreme(variant, number, report)


def _check_extreme(variant: Variant, number: str, report: CheckReport) -> None:
    """Check the same of a sheet of one absurd number, and of one such answer beside right ones to the same
    judge.

    Where each answer stands for itself, nought may be right.
    """
    judged_parts = (part for part in variant.parts if not part.sort.is_open)
    reference = {part.id: variant.key.reference[part.quantity] for part in judged_parts}
    answers = {i: "; ".join([number] * np.size(value)) for i, value in reference.items()}
    marking = grade(variant, answers)
    report.counts["nonsense"] += len(answers)
    for _, ids in judges_of(variant):
        right = {i: _written(reference[i]) for i in ids}
        for i in ids:
            if marking[i].verdict == "correct":
                report.fail(f"seed {variant.seed}: {i} marks correct where each answer is {number}")
            grade(variant, {**right, i: answers[i]})
            report.counts["nonsense"] += 1
