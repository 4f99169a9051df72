"""The promises about parts that ask for the equations of a loop."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from coursework.authoring.check_report import RESIDUAL, CheckReport
from coursework.course.variant import Variant
from coursework.marking.loop_judge import fault_answers, judge_of
from coursework.marking.marking import mark as grade
from coursework.model import Part
from coursework.parsing.equations import parse_equation
from coursework.parsing.vocabulary import MAX_LENGTH


def check_loops(variant: Variant, report: CheckReport) -> None:
    """Check that the equations of the loops hold for the answers, are right in other forms, and that wrong
    links are named.

    An equation does not depend on the variant: one is enough.
    """
    parts = [p for p in variant.exercise.spec.parts if p.loop]
    for part in parts:
        if not equation_holds(variant, part):
            report.fail(f"{part.id} does not hold for the answers of seed {variant.seed}")
    for sheet in _other_forms(variant, parts):
        marking = grade(variant, sheet)
        for part_id, answer in sheet.items():
            report.counts["right answers"] += 1
            if marking[part_id].verdict != "correct":
                report.fail(f"{part_id} = {answer!r} is right but marks {marking[part_id].verdict}")
    for part in parts:
        judge, reference = judge_of(variant.exercise, part), variant.key.reference[part.quantity]
        for fault, answer in fault_answers(variant.exercise, part):
            if judge.are_alike(answer, str(reference)):
                continue  # nothing is wrong in this form
            report.counts["loops explained"] += 1
            mark = grade(variant, {part.id: answer})[part.id]
            if not mark.matches:
                names = ", ".join(fault.names)
                report.fail(
                    f"{part.id} = {answer!r} ({fault.kind} of {names}) marks {mark.verdict}, unexplained"
                )


def equation_holds(variant: Variant, part: Part) -> bool:
    """Return whether a reference equation holds for the variant's own answers."""
    exercise, equation = variant.exercise, variant.key.reference[part.quantity]
    angles = {n for loop in exercise.solution.loops.values() for n in loop.angles}
    solved = exercise.solve(**variant.used, only=part.variables, effects=variant.effects)
    values = {n: math.radians(v) if n in angles else v for n, v in solved.items()}
    size = max(abs(v) for n, v in values.items() if n not in angles) ** 2
    return abs(parse_equation(str(equation), part.variables).difference(values)) <= RESIDUAL * size


def _other_forms(variant: Variant, parts: Sequence[Part]) -> Iterator[dict[str, str]]:
    """Right answers about loops in other forms: exchanged, projected on turned axes, conjugate."""
    exchanged, turned, complex_ones = {}, {}, {}
    for part in parts:
        form, _ = part.loop_form
        texts = {
            f: str(variant.exercise.solution.graph.evaluate((n,), {})[n])
            for f in ("x", "y", "complex")
            for n in (part.quantity.replace(f"{part.loop}_{form}", f"{part.loop}_{f}"),)
        }
        sides = {f: "({1}) - ({0})".format(*text.split(" = ")) for f, text in texts.items()}
        if form == "complex":
            complex_ones[part.id] = f"{sides['x']} + i*({sides['y']}) = 0"
        else:
            exchanged[part.id] = texts["y" if form == "x" else "x"]
            sign, other = ("+", "y") if form == "x" else ("-", "x")
            turned[part.id] = f"cos(20°)*({sides[form]}) {sign} sin(20°)*({sides[other]}) = 0"
    for sheet in (exchanged, turned, complex_ones):
        yield {part_id: text for part_id, text in sheet.items() if len(text) <= MAX_LENGTH}
