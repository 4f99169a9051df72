"""From a variant to what its sheets show: a handout without answers, an answer sheet with them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.constructions import Construction
from coursework.equation_latex import latex_of_equation
from coursework.errors import BadCourse, BadStatement, BrokenFunction, CourseworkError
from coursework.graph import Graph, plain_scalar
from coursework.handout import Answer, AnswerSheet, Given, Handout, Question, Remark, Step
from coursework.language import is_whole, localise, plain, significant, unit_text
from coursework.language import words as engine_words
from coursework.model import Part
from coursework.polygons import Polygon
from coursework.telling import quoted
from coursework.worked import Shown, formula_in_symbols, formula_latex, number_latex

if TYPE_CHECKING:
    from coursework.figures import Figure
    from coursework.variant import Variant

PRINTED_DIGITS = 5  #: significant digits of a value in a worked solution
_WITHOUT_SYMBOL = ("choice", "equation")
_SAME = 1e-9  #: of a value, by which two ways to compute it may differ


def handout(variant: Variant) -> Handout:
    """What a student's sheet shows, before it is given to one.

    Raises
    ------
    BadStatement
        A part has no section in the statement.
    """
    exercise, text, lang = variant.exercise, variant.text, variant.lang
    return Handout(
        lang=lang,
        course=exercise.course.title(lang),
        exercise=exercise.name,
        version=exercise.version,
        seed=variant.seed,
        student="",
        title=text.title,
        statement=text.opening,
        given=tuple(_given(variant, name) for name, spec in exercise.spec.given.items() if spec.shown),
        figure=variant.figure,
        figure_alt=" ".join(text.section("figure").text.split()) if exercise.spec.figure else "",
        questions=tuple(
            _question(variant, n, p, ways)
            for n, (p, ways) in enumerate(zip(variant.parts, _ways_to_write(variant), strict=True), start=1)
        ),
        record=variant.record,
        drawing_mm=exercise.spec.drawing_mm,
    )


def _given(variant: Variant, name: str) -> Given:
    spec, value = variant.exercise.spec.given[name], variant.given[name]
    symbol = variant.exercise.symbol(name)
    if spec.is_choice:
        return Given(name, symbol, variant.text.label(name, value), "", is_number=False)
    return Given(name, symbol, plain(value), unit_text(spec.unit, variant.lang))


def _ways_to_write(variant: Variant) -> list[tuple[str, ...]]:
    """For each part, what its sheet has not said yet of how equations of loops are written."""
    met: list[tuple[str, ...]] = []
    found = []
    for part in variant.parts:
        new: tuple[str, ...] = ()
        if part.loop and part.id not in variant.text.sections and part.variables not in met:
            new = ("symbols",) if met else ("symbols", "how")
            met.append(part.variables)
        found.append(new)
    return found


def prompt(variant: Variant, part: Part, ways: Iterable[str] = ()) -> str:
    """What a part asks: its section of the statement; for an equation of a loop that has none, the engine's
    words after the section of its loop, and the ``ways`` to write it: ``symbols``, ``how``.

    Raises
    ------
    BadStatement
        The statement has no such section.
    """
    if not part.loop or part.id in variant.text.sections:
        return variant.text.section(part.id).text
    table = engine_words(variant.lang)["loop"]
    loop = variant.text.section(part.loop).text
    asked = part.quantity.removeprefix(f"{part.loop}_")
    symbols = ", ".join(f"`{name}`" for name in part.variables)
    return " ".join([loop, *(table[key].format(symbols=symbols) for key in (asked, *ways))])


def _question(variant: Variant, number: int, part: Part, ways: Sequence[str]) -> Question:
    choices = tuple((case, variant.text.label(part.id, case)) for case in part.choices)
    return Question(
        number=number,
        id=part.id,
        symbol="" if part.kind in _WITHOUT_SYMBOL else variant.exercise.symbol(part.quantity),
        prompt=prompt(variant, part, ways),
        unit="" if part.asks_unit else unit_text(part.unit, variant.lang),
        kind=part.kind,
        choices=choices,
        points=part.points,
        tolerance=tolerance_words(part, variant.lang),
        asks_unit=part.asks_unit,
        judge=part.judge,
    )


def tolerance_words(part: Part, lang: str) -> str:
    """The accepted margin as a student reads it; empty for what is judged exactly."""
    if part.is_exact or not (part.atol or part.rtol):
        return ""
    table = engine_words(lang)["accepted"]
    percent = localise(plain(round(100 * part.rtol, 6)), lang)
    absolute = localise(plain(part.atol), lang)
    if part.atol and part.unit == "deg":
        fixed = table["degrees"].format(absolute)
    else:
        fixed = table["absolute"].format(f"{absolute} {unit_text(part.unit, lang)}".strip())
    if not part.rtol:
        return fixed
    if not part.atol:
        return table["percent"].format(percent)
    return table["either"].format(
        table["share"].format(percent), f"{absolute} {unit_text(part.unit, lang)}".strip()
    )


def _call(function: Any, values: Mapping[str, Any], helpers: tuple = ()) -> Any:
    """Call a function that draws, or states what is drawn, with the quantities its parameters name."""
    name, graph = function.__name__, _graph(function, helpers)
    return graph.evaluate((name,), {n: v for n, v in values.items() if n in graph.leaves})[name]


@lru_cache(maxsize=256)
def _graph(function: Any, helpers: tuple = ()) -> Graph:
    """The same graph for all variants, so that its plans are made once."""
    return Graph({**{f.__name__: f for f in helpers}, function.__name__: function})


def figure(variant: Variant) -> Figure | None:
    """The exercise's figure for this variant, to scale."""
    spec = variant.exercise.spec
    return None if spec.figure is None else _call(spec.figure, variant.given, tuple(spec.helpers))


def answer_sheet(variant: Variant, student: str = "", *, polygons: bool = True) -> AnswerSheet:
    """The handout with its answers and worked solution.

    Raises
    ------
    NoSolution
        The course folder has no solutions.
    """
    sheet = variant.handout(student)
    values, text = variant.walk, variant.solution_text
    steps = _steps(variant, values, text)
    answers = tuple(
        Answer(question, answer_text(variant, part, values), _margin(variant, part))
        for question, part in zip(sheet.questions, variant.parts, strict=True)
    )
    figure = solution_figure(variant)
    says = text.sections.get("figure") if figure is not None else None
    alt = " ".join(says.text.split()) if says else ""
    drawn = variant.polygons() if polygons else ()
    return AnswerSheet(sheet, answers, steps, text.opening, figure, alt, drawn)


def solution_figure(variant: Variant) -> Figure | None:
    solution = variant.exercise.solution
    if solution.figure is None:
        return None
    return _call(solution.figure, _quantities(variant, solution.figure))


def _quantities(variant: Variant, function: Any) -> dict[str, Any]:
    """The quantities of a variant's solution, and those besides that a function of the solution needs."""
    values = dict(variant.walk)
    more = tuple(n for n in _graph(function).node(function.__name__).arguments if n not in values)
    return {**values, **variant.exercise.solution.graph.evaluate(more, variant.used, variant.effects)}


def polygons(variant: Variant) -> tuple[Construction, ...]:
    """The polygons that the solution states, less those in which nothing moves.

    Raises
    ------
    BadCourse
        It states something else, or a polygon that cannot be drawn.
    """
    solution = variant.exercise.solution
    if solution.polygons is None:
        return ()
    values = _quantities(variant, solution.polygons)
    try:
        stated = _call(solution.polygons, values)
    except BrokenFunction:  # it names its file itself
        raise
    except BadCourse as fault:
        raise BadCourse(f"solutions/{solution.name}.py: {fault}") from fault
    if not isinstance(stated, (tuple, list)) or not all(isinstance(p, Polygon) for p in stated):
        raise BadCourse(
            f"solutions/{solution.name}.py: polygons(…) returns a tuple of Polygon; found {str(stated)[:60]}"
        )
    return tuple(Construction(p, variant.lang) for p in stated if p.size > 0)


def _symbol(variant: Variant, name: str) -> str:
    return variant.exercise.solution.symbols.get(name) or variant.exercise.symbol(name)


def _steps(variant: Variant, values: Mapping[str, Any], text: Any) -> tuple[Step, ...]:
    """The quantities that are not given, in order."""
    units = variant.exercise.units
    symbols = tuple((n, _symbol(variant, n)) for n in values)
    numbers = {
        n: (number_latex(v, units.get(n, "1"), PRINTED_DIGITS), True)
        for n, v in values.items()
        if isinstance(v, (int, float, complex))
    }
    remarks = _remarks(variant, values, text)
    return tuple(
        _step(variant, name, value, text, symbols, numbers, remarks.get(name, ()))
        for name, value in values.items()
        if name not in variant.given
    )


def _step(
    variant: Variant,
    name: str,
    found: Any,
    text: Any,
    symbols: tuple[tuple[str, str], ...],
    numbers: Shown,
    remarks: Sequence[Remark],
) -> Step:
    exercise = variant.exercise
    function = exercise.solution.graph.node(name).function
    section = text.sections.get(name)
    value = _value_latex(variant, name, found)
    try:
        formula = formula_in_symbols(function, symbols)
        substitution = formula_latex(function, numbers) if formula and value else ""
    except KeyError as fault:
        raise BadCourse(
            f"solutions/{exercise.name}.py: the formula of {name} names {fault}, which is not among its quantities"
        ) from fault
    symbol = _symbol(variant, name)
    return Step(
        name=name,
        symbol=symbol,
        formula=formula if formula not in (value, symbol) else "",
        substitution=substitution if substitution not in (formula, value) else "",
        value=value,
        words=_words_of(variant, name, found, section.text if section else ""),
        remarks=tuple(remarks),
        asked=any(p.quantity == name for p in variant.parts),
    )


def _remarks(variant: Variant, values: Mapping[str, Any], text: Any) -> dict[str, list[Remark]]:
    """The known mistakes by the step that they stand at: the first of their targets that they change.

    One that is about what is given stands at the first step that it changes. One that changes nothing in this
    variant is none, and is left out.
    """
    solution, units = variant.exercise.solution, variant.exercise.units
    steps = [q for q in values if q not in variant.given]
    found: dict[str, list[Remark]] = {}
    for name, mistake in solution.mistakes.items():
        graph, about = solution.mistaken(name), [q for q in steps if q in mistake.targets]
        for quantity in about or [q for q in steps if q in solution.reached(name)]:
            try:
                wrong = graph.evaluate((quantity,), variant.used, variant.effects)[quantity]
            except CourseworkError:
                continue
            if not _agrees(wrong, values[quantity], units.get(quantity, "1")):
                told = Remark(text.section(f"mistake {name}").text, _wrong_text(variant, quantity, wrong))
                found.setdefault(quantity, []).append(told)
                break
    return found


def _agrees(wrong: Any, right: Any, unit: str) -> bool:
    """Whether a mistake gives the right value; directions are the same after a full turn."""
    if isinstance(right, (str, tuple)) or isinstance(wrong, (str, tuple)):
        return bool(wrong == right)
    gap = np.abs(np.subtract(wrong, right))
    if unit == "deg":
        gap = np.minimum(gap % 360.0, -gap % 360.0)
    return bool(np.all(gap <= _SAME * np.max(np.abs(right))))


def _wrong_text(variant: Variant, name: str, wrong: Any) -> str:
    part = next((p for p in variant.parts if p.quantity == name), None)
    if part is not None and part.kind == "choice":
        return quoted(variant.text.label(part.id, str(wrong)), variant.lang)
    if isinstance(wrong, (str, tuple)) or np.ndim(wrong) or not np.isfinite(wrong):
        return ""
    return f"${_value_latex(variant, name, plain_scalar(wrong))}$"


def _words_of(variant: Variant, name: str, found: Any, reason: str) -> str:
    """The words of a step: which question it answers; of a choice, the case after its reason."""
    number = next((n for n, p in enumerate(variant.parts, start=1) if p.quantity == name), 0)
    if not number:
        return reason
    said, part = engine_words(variant.lang), variant.parts[number - 1]
    asks = f"{said['sheet']['question']['one']} {number}."
    words = [f"*{asks[:1].upper()}{asks[1:]}*", reason]
    if part.kind == "choice":
        # At the end of the reason's last sentence, or after it.
        words += [f"{said['solution']['case']}{said['sheet']['colon']}"] if is_whole(reason) else []
        words += [f"**{variant.text.label(part.id, str(found))}**."]
    return " ".join(filter(None, words))


def _value_latex(variant: Variant, name: str, value: Any) -> str:
    r"""``\num{319.8}\ \mathrm{mm}``; an equation; a vector by coordinates; nothing for a case or a bundle."""
    exercise = variant.exercise
    part = next((p for p in variant.parts if p.quantity == name), None)
    unit = exercise.units.get(name, "1")
    if isinstance(value, str):
        return equation_latex(variant, value) if part is not None and part.kind == "equation" else ""
    if isinstance(value, tuple):
        return ""
    if isinstance(value, np.ndarray):
        inner = r";\ ".join(number_latex(v, "1", PRINTED_DIGITS) for v in value.tolist())
        return rf"\left({inner}\right)" + _unit_latex(unit)
    return number_latex(value, "1", PRINTED_DIGITS) + _unit_latex(unit)


def _unit_latex(unit: str) -> str:
    if unit in ("1", "deg"):
        return r"^{\circ}" if unit == "deg" else ""
    text = unit.replace("*", r"{\cdot}").replace("^2", "^{2}")
    return rf"\ \mathrm{{{text}}}"


def equation_latex(variant: Variant, equation: str) -> str:
    """A reference equation as it is printed."""
    names = {n for p in variant.parts for n in p.variables}
    return latex_of_equation(equation, {n: _symbol(variant, n) for n in names})


def answer_text(variant: Variant, part: Part, values: Mapping[str, Any]) -> str:
    """The reference answer of a part, rounded for print, as Markdown."""
    value = values[part.quantity]
    if part.kind == "choice":
        return variant.text.label(part.id, str(value))
    latex = _value_latex(variant, part.quantity, value)
    if not latex:
        raise BadStatement(f"{variant.exercise.name}: the answer to {part.id} cannot be printed")
    return f"${latex}$"


def _margin(variant: Variant, part: Part) -> str:
    if not part.has_margin or part.kind == "direction":
        return ""
    width = localise(significant(variant.key.half_width(part), 2), variant.lang)
    unit = unit_text(part.unit, variant.lang)
    return width + (unit if unit == "°" else f" {unit}" if unit else "")
