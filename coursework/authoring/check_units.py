"""The promise that formulas give the units that the exercise and its solution declare."""

from __future__ import annotations

from collections.abc import Sequence

from coursework.authoring.check_report import CheckReport
from coursework.course.exercise import CourseExercise
from coursework.course.variant import Variant
from coursework.quantities.unit_proof import Findings, prove

TRIED = 5  #: variants whose quantities are followed: enough to meet the branches


def check_units(drawn: Sequence[Variant], report: CheckReport) -> None:
    """Each quantity's formula gives its declared unit; what cannot be decided is listed with its reason."""
    findings = Findings()
    for variant in drawn[:TRIED]:
        findings.merge(proof_of(variant))
    for fault in findings.wrong.values():
        report.fail(fault)
    report.counts["units proved"] += len(findings.proved)
    report.counts["units not proved"] += len(findings.unproved)
    report.unproved_units |= findings.unproved


def proof_of(variant: Variant) -> Findings:
    exercise = variant.exercise
    graph = exercise.solution.graph
    mixed = {p.quantity for p in exercise.spec.parts if len(p.sort.units(p.unit)) > 1}
    wanted = tuple(name for name in graph.quantities if name not in mixed)
    proof = prove(graph, variant.used, _declared(exercise), variant.effects, wanted)
    proof.unproved |= dict.fromkeys(mixed, "its columns are in two units")
    return proof


def _declared(exercise: CourseExercise) -> dict[str, str]:
    """Units by quantity; not of directions, whose length says nothing, of columns in two units, nor of what
    is not a number."""
    free = {p.quantity for p in exercise.spec.parts if p.kind in _NO_UNIT}
    chosen = {n for n, s in exercise.spec.given.items() if s.is_choice}
    return {n: u for n, u in exercise.units.items() if n not in free and n not in chosen}


_NO_UNIT = ("direction", "choice", "equation", "integer", "text", "twist", "wrench")
