"""The promise that the formula on paper gives the number on paper.

Each step of a worked solution that prints a formula with its numbers is read back from the print and
evaluated. It must give the printed value, up to what the rounding of the printed numbers can do: each number
that may be rounded is moved by half of its last digit, alone, and the moves of the result add up. Angles are
the same after a full turn.

What cannot be decided is never taken for proved: a step that words alone explain, a formula that holds what
has no value, and numbers whose rounding moves the result by more than a tenth of it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from coursework.authoring.check_report import CheckReport
from coursework.course.variant import Variant
from coursework.messages import Message, as_message
from coursework.parsing.printed_formulas import DEGREE, FormulaValue, NotEvaluable, read
from coursework.quantities.formula_latex import why_unprinted
from coursework.sheets.answer_sheet import PRINTED_DIGITS, answer_sheet
from coursework.sheets.sheet import AnswerSheet, Step

TRIED = 20  #: variants whose worked solutions are read back
TELLS_SHARE = 0.1  #: of a value: a wider bound proves nothing
TELLS_DEGREES = 2.0  #: the same of an angle
_BEYOND_FIRST_ORDER = 1.1  #: rounding errors compound a little
_LAST_BITS = 1e-9  #: of a value: what computing it two ways may differ by


@dataclass(frozen=True)
class Proof:
    """Result of evaluating a step's formula: it gives the printed value, another one, or nothing for a
    reason."""

    holds: bool = False
    gives: str = ""
    why_not: str = ""


def check_formulas(drawn: Sequence[Variant], report: CheckReport) -> None:
    """Check that the printed formula of each step gives its printed value; report a step that fails once."""
    failed = set()
    for variant in drawn[:TRIED]:
        sheet = answer_sheet(variant, polygons=False)
        printed = _shown_by_symbol(sheet)
        for step in sheet.steps:
            proof = prove(step, printed)
            if proof is None:
                continue
            report.counts["formulas proved"] += proof.holds
            if proof.why_not:
                report.counts["formulas not proved"] += 1
                report.unproved.setdefault(step.name, _why_not(variant, step, proof))
            elif not proof.holds and step.name not in failed:
                failed.add(step.name)
                report.fail(
                    f"seed {variant.seed}: the printed formula of {step.name}, {step.formula}, with "
                    "its numbers "
                    f"{step.substitution or step.formula}, gives {proof.gives}; printed is {step.value}"
                )


def _why_not(variant: Variant, step: Step, proof: Proof) -> str:
    """Why a step proves nothing; with what its code holds that no formula says, where that is why it prints
    none."""
    function = variant.exercise.solution.graph.node(step.name).function
    unprinted = "" if step.formula or hasattr(function, "__formula__") else why_unprinted(function)
    return f"{proof.why_not}, since {unprinted}; @formula may say it" if unprinted else proof.why_not


def _shown_by_symbol(sheet: AnswerSheet) -> dict[str, str]:
    """Return the printed number of each quantity of a sheet, by its symbol."""
    given = {g.symbol: rf"\num{{{g.value}}}" for g in sheet.handout.given if g.is_number}
    return given | {step.symbol: _number_of(step.value) for step in sheet.steps}


def prove(step: Step, by_symbol: Mapping[str, str]) -> Proof | None:
    """Return the proof that a step's formula gives its value; None where it prints no number. ``printed``:
    printed numbers by symbol."""
    printed = _number_of(step.value)
    is_angle = printed.endswith(r"^{\circ}")
    try:
        value = read(printed, PRINTED_DIGITS)
    except NotEvaluable:
        return None  # an equation, a case
    if not step.formula:
        return Proof(why_not=Message("explained in words"))
    if not step.substitution and step.formula in by_symbol:
        return _compared(value, read(by_symbol[step.formula], PRINTED_DIGITS), is_angle)
    try:
        evaluated = read(step.substitution or step.formula, PRINTED_DIGITS, is_angle=is_angle)
    except NotEvaluable as fault:
        return Proof(why_not=as_message(fault))
    return _compared(value, evaluated, is_angle)


def _number_of(value: str) -> str:
    """Return the LaTeX of a printed value without its unit."""
    return value.partition(r"\ \mathrm")[0]


def _compared(value: FormulaValue, formula_value: FormulaValue, is_angle: bool) -> Proof:
    gives = _values_text(formula_value, is_angle)
    if len(value.values) != len(formula_value.values):
        return Proof(gives=gives)
    is_told = True
    for printed, width, evaluated, moved in zip(
        value.values, value.widths, formula_value.values, formula_value.widths, strict=True
    ):
        allowed = _BEYOND_FIRST_ORDER * moved + width + _LAST_BITS * abs(printed)
        gap = evaluated - printed
        if is_angle:
            gap = _turn_less(gap.real)
        if not abs(gap) <= allowed and math.isfinite(allowed):
            return Proof(gives=gives)
        enough = TELLS_DEGREES * DEGREE if is_angle else TELLS_SHARE * abs(printed)
        is_told = is_told and (allowed <= enough or evaluated == printed)
    return Proof(holds=True) if is_told else Proof(why_not="its rounded numbers do not tell")


def _turn_less(angle: float) -> float:
    return math.remainder(angle, 2 * math.pi) if math.isfinite(angle) else angle


def _values_text(value: FormulaValue, is_angle: bool) -> str:
    scale, unit = (1 / DEGREE, " deg") if is_angle else (1.0, "")
    return "; ".join(f"{complex(v * scale):.7g}".replace("+0j", "") for v in value.values) + unit
