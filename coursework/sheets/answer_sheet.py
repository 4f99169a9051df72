"""From a variant to what its sheets show: a handout without answers, an answer sheet with them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.errors import BadCourse, BadStatement, CourseworkError
from coursework.language.numbers import localise, significant, unit_latex, unit_text
from coursework.language.words import is_whole, quoted
from coursework.language.words import words as engine_words
from coursework.model import Part
from coursework.quantities.formula_latex import (
    PrintedName,
    Shown,
    formula_in_symbols,
    formula_latex,
    kind_of,
    number_latex,
)
from coursework.quantities.graph import plain_scalar
from coursework.sheets.drawings import solution_figure, stated_polygons
from coursework.sheets.handout import handout
from coursework.sheets.placed import placed_points
from coursework.sheets.sheet import Answer, AnswerSheet, Remark, Step

if TYPE_CHECKING:
    from coursework.course.texts import RenderedText
    from coursework.course.variant import Variant
    from coursework.figures.polygons.construction import Construction


PRINTED_DIGITS = 5  #: significant digits of a value in a worked solution
_SAME = 1e-9  #: of a value, by which two ways to compute it may differ


def answer_sheet(variant: Variant, student: str = "", *, polygons: bool = True) -> AnswerSheet:
    """Return the handout with its answers and worked solution.

    Raises
    ------
    NoSolution
        The course folder has no solutions.
    """
    sheet = handout(variant, student)
    values, text = variant.walk, variant.solution_text
    steps = (*_steps(variant, values, text), *_models(variant, text))
    answers = tuple(
        Answer(question, answer_text(variant, part, values), _margin(variant, part))
        for question, part in zip(sheet.questions, variant.parts, strict=True)
    )
    figure = solution_figure(variant)
    caption = text.sections.get("figure") if figure is not None else None
    alt = " ".join(caption.text.split()) if caption else ""
    drawn = _needed_polygons(variant) if polygons else ()
    return AnswerSheet(sheet, answers, steps, text.opening, figure, alt, drawn)


def _needed_polygons(variant: Variant) -> tuple[Construction, ...]:
    """Return the polygons of velocities where the asked answers need some, and of accelerations where they
    need those."""
    units = (variant.exercise.units.get(name, "1") for name in variant.walk if name not in variant.given)
    needed = max(map(_derivations, units), default=0)
    return tuple(p for p in stated_polygons(variant) if _derivations(p.polygon.unit) <= needed)


def _derivations(unit: str) -> int:
    """Return how often a quantity of a unit is differentiated with respect to time: 0, 1, 2."""
    return 2 if "s^2" in unit else int("/s" in unit)


def _models(variant: Variant, text: RenderedText) -> Iterator[Step]:
    """Yield the model answers of the questions that a person marks: sections of the solution's text."""
    for part in variant.parts:
        if part.sort.is_open and (section := text.sections.get(part.id)) is not None:
            model = f"{question_called(variant, part)} {section.text}"
            yield Step(part.id, "", "", "", "", model, (), asked=True)


def question_called(variant: Variant, part: Part) -> str:
    """Return the name of a question at the head of a step: ``*Question 3.*``"""
    number = 1 + variant.parts.index(part)
    asks = f"{engine_words(variant.lang)['sheet']['question']['one']} {number}."
    return f"*{asks[:1].upper()}{asks[1:]}*"


def _steps(variant: Variant, values: Mapping[str, Any], text: Any) -> tuple[Step, ...]:
    """Return the quantities that are not given, in order."""
    units = variant.exercise.units
    named = {**values, **variant.existing(_named_besides(variant, values))}
    kinds = {n: kind_of(v, units.get(n, "1")) for n, v in named.items()}
    symbols = tuple((n, variant.solution_symbol(n), kinds[n]) for n in named)
    numbers = {
        n: PrintedName(number_latex(v, units.get(n, "1"), PRINTED_DIGITS), True, kinds[n])
        for n, v in named.items()
        if isinstance(v, (int, float, complex))
    }
    remarks = _remarks(variant, values, text)
    return tuple(
        _step(variant, name, value, text, symbols, numbers, remarks.get(name, ()))
        for name, value in values.items()
        if name not in variant.given
    )


def _named_besides(variant: Variant, values: Mapping[str, Any]) -> set[str]:
    """Return the names in formulas whose own values need the formula's result, so that they are not a step
    before it."""
    graph = variant.exercise.solution.graph
    nodes = (graph.node(name) for name in values if name in graph.names)
    named = {name for node in nodes for name in node.printed if name not in node.arguments}
    return named.intersection(graph.quantities) - values.keys()


def _step(
    variant: Variant,
    name: str,
    result: Any,
    text: Any,
    symbols: tuple[tuple[str, str, str], ...],
    numbers: Shown,
    remarks: Sequence[Remark],
) -> Step:
    exercise = variant.exercise
    function = exercise.solution.graph.node(name).function
    section = text.sections.get(name)
    value = _value_latex(variant, name, placed_points(variant).get(name, result))
    try:
        formula = formula_in_symbols(function, symbols)
        substitution = formula_latex(function, numbers) if formula and value else ""
    except KeyError as fault:
        raise BadCourse(
            f"{exercise.solution.source}: the formula of {name} names {fault}, which is not among its "
            "quantities"
        ) from fault
    symbol = variant.solution_symbol(name)
    return Step(
        name=name,
        symbol=symbol,
        formula=formula if formula not in (value, symbol) else "",
        substitution=substitution if substitution not in (formula, value) else "",
        value=value,
        words=_words_of(variant, name, result, section.text if section else ""),
        remarks=tuple(remarks),
        asked=any(p.quantity == name for p in variant.parts),
    )


def _remarks(variant: Variant, values: Mapping[str, Any], text: Any) -> dict[str, list[Remark]]:
    """Return the known mistakes by the step that they stand at: the first of their targets that they change.

    One that is about what is given stands at the first step that it changes. One that changes nothing in this
    variant is none, and is left out.
    """
    solution, units = variant.exercise.solution, variant.exercise.units
    steps = [q for q in values if q not in variant.given]
    remarks: dict[str, list[Remark]] = {}
    for name, mistake in solution.mistakes.items():
        graph, about = solution.mistaken(name), [q for q in steps if q in mistake.targets]
        for quantity in about or [q for q in steps if q in solution.reached(name)]:
            try:
                wrong = plain_scalar(graph.evaluate((quantity,), variant.used, variant.effects)[quantity])
            except CourseworkError:
                continue
            if not _agrees(wrong, values[quantity], units.get(quantity, "1")):
                remark = Remark(text.section(f"mistake {name}").text, _wrong_text(variant, quantity, wrong))
                remarks.setdefault(quantity, []).append(remark)
                break
    return remarks


def _agrees(wrong: Any, right: Any, unit: str) -> bool:
    """Return whether a mistake gives the right value; directions are the same after a full turn."""
    if isinstance(right, (str, tuple)) or isinstance(wrong, (str, tuple)):
        return bool(wrong == right)
    gap = np.abs(np.subtract(wrong, right))
    if unit == "deg":
        gap = np.minimum(gap % 360.0, -gap % 360.0)
    return bool(np.all(gap <= _SAME * np.max(np.abs(right))))


def _wrong_text(variant: Variant, name: str, wrong: Any) -> str:
    part = next((p for p in variant.parts if p.quantity == name), None)
    text = "" if part is None else part.sort.words(wrong, partial(variant.label, part.id))
    if text:
        return quoted(text, variant.lang)
    if isinstance(wrong, (str, tuple)) or np.ndim(wrong) or not np.isfinite(wrong):
        return ""
    return f"${_value_latex(variant, name, wrong)}$"


def _words_of(variant: Variant, name: str, value: Any, reason: str) -> str:
    """Return the words of a step: which question it answers; of a choice, the case after its reason."""
    number = next((n for n, p in enumerate(variant.parts, start=1) if p.quantity == name), 0)
    if not number:
        return reason
    texts, part = engine_words(variant.lang), variant.parts[number - 1]
    words = [question_called(variant, part), reason]
    case = part.sort.words(value, partial(variant.label, part.id))
    if case:
        # At the end of the reason's last sentence, or after it.
        words += [f"{texts['solution']['case']}{texts['sheet']['colon']}"] if is_whole(reason) else []
        words += [f"**{case}**."]
    return " ".join(filter(None, words))


def _value_latex(variant: Variant, name: str, value: Any) -> str:
    r"""``\num{319.8}\ \mathrm{mm}``; an equation; a vector by coordinates; nothing for a case or a bundle."""
    exercise = variant.exercise
    part = next((p for p in variant.parts if p.quantity == name), None)
    unit = exercise.units.get(name, "1")
    if isinstance(value, str):
        return "" if part is None else part.sort.latex(value, _symbols(variant))
    if isinstance(value, tuple):
        return ""
    if (
        isinstance(value, np.ndarray)
        and part is not None
        and (table := part.sort.formula(value, lambda v: number_latex(v, "1", PRINTED_DIGITS)))
    ):
        return table + r"\ \mid\ ".join(unit_latex(unit_name) for unit_name in part.sort.units(unit))
    if isinstance(value, np.ndarray) and value.ndim == 2:
        return _matrix_latex(value) + unit_latex(unit)
    if isinstance(value, np.ndarray):
        inner = r";\ ".join(number_latex(v, "1", PRINTED_DIGITS) for v in value.tolist())
        return rf"\left({inner}\right)" + unit_latex(unit)
    return number_latex(value, "1", PRINTED_DIGITS) + unit_latex(unit)


def _matrix_latex(value: np.ndarray) -> str:
    rows = (" & ".join(number_latex(v, "1", PRINTED_DIGITS) for v in row) for row in value.tolist())
    return r"\begin{pmatrix} " + r" \\ ".join(rows) + r" \end{pmatrix}"


def _symbols(variant: Variant) -> dict[str, str]:
    """LaTeX of what equations may be written in."""
    return {n: variant.solution_symbol(n) for p in variant.parts for n in p.variables}


def answer_text(variant: Variant, part: Part, values: Mapping[str, Any]) -> str:
    """Return the reference answer of a part, rounded for print, as Markdown; of one that a person marks, that
    it is so."""
    if part.sort.is_open:
        return engine_words(variant.lang)["solution"]["by_hand"]
    value = values[part.quantity]
    if formula := part.sort.words(value, partial(variant.called, part)):
        return formula
    placed = placed_points(variant)
    latex = _value_latex(variant, part.quantity, placed.get(part.quantity, value))
    if not latex:
        raise BadStatement(f"{variant.exercise.name}: the answer to {part.id} cannot be printed")
    formula = f"${latex}$"
    return (
        engine_words(variant.lang)["solution"]["instance"].format(formula)
        if part.quantity in placed
        else formula
    )


def _margin(variant: Variant, part: Part) -> str:
    if not part.has_margin or not part.sort.rounds:
        return ""
    width = localise(significant(variant.key.half_width(part), 2), variant.lang)
    unit = unit_text(part.unit, variant.lang)
    return width + (unit if unit == "°" else f" {unit}" if unit else "")
