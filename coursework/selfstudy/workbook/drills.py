"""Drills of a lesson: questions of two minutes, drawn from variants of its exercises.

A drill asks one quantity and gives what its formula takes: one step back, two steps, or the data alone; or
it tells the quantity, and asks a datum. The answer is computed from the numbers as printed, so that who puts
them in finds the digits of the book.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, product, zip_longest
from string import ascii_uppercase
from typing import Any

from coursework.course.course import Course
from coursework.course.folder import Folder
from coursework.course.variant import Variant
from coursework.errors import BadCourse, CourseworkError
from coursework.issuing.issuing import distinct_variants
from coursework.language.numbers import unit_latex
from coursework.language.words import words
from coursework.model import Part
from coursework.quantities.formula_latex import number_latex
from coursework.rendering.views import given_formula, given_words
from coursework.selfstudy.worked import named_question
from coursework.sheets.book import Drill, Judgement, LessonText
from coursework.sheets.following import needs
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Question

GRADES = (4, 3, 3)  #: drills of each grade
_FAR, _APART = 700_000, 1_000  #: seeds away from all others, and between two books
_VARIANTS = 6  #: of each exercise from which they are drawn
_SHORT = (
    "number",
    "integer",
    "angle",
    "choice",
    "choices",
    "direction",
    "equation",
    "vector",
    "twist",
    "wrench",
    "matrix",
    "complex",
)
_MOST = 2  #: drills of a lesson that ask the same with other numbers
_GIVEN = 6  #: numbers that a drill gives at most
_STEPS = (0, 1, 2, 4)  #: formulas that a drill of each grade takes at most
_DIGITS = 4  #: of a number that is given though it is computed
_LOST = 0.01  #: how far its rounding may move the answer
_BACK = 0.002  #: how far a datum may be from what is found back
_MEASURED = ("number", "integer", "angle")
_SPREAD = (-1, 0.3, 0.6, 1, 2, 3)  #: times a datum: who is asked for it has a line to solve, so one answer


def drills_of(
    course: Course[Any],
    exercises: Sequence[str],
    lesson: int,
    lang: str,
    seed: int,
    grades: Sequence[int] = GRADES,
) -> tuple[Drill, ...]:
    """Return the drills of a lesson, the easiest first.

    Parameters
    ----------
    course
        An open course.
    exercises
        The names of those from which they are drawn.
    lesson
        The number of the lesson, with which theirs begin.
    lang
        Language of the drills.
    seed
        Which book.
    grades
        How many of each grade.
    """
    drawn = {name: _variants(course, name, lang, seed) for name in exercises}
    posed: Counter[str] = Counter()
    found: list[list[Drill]] = [[] for _ in grades]
    for grade, count in enumerate(grades, 1):
        here = found[grade - 1]
        for most, back in ((count - 1, False), (count, True), (count, False)):
            _fill(here, drawn, grade, most, posed, back=back)
    for grade, back in product((2, 1, 3), (False, True)):  # a lesson of short formulas has more of the others
        here = found[grade - 1]
        _fill(here, drawn, grade, len(here) + sum(grades) - sum(map(len, found)), posed, back=back)
    in_order = enumerate(chain.from_iterable(found), 1)
    return tuple(replace(drill, number=f"{lesson}.{k}") for k, drill in in_order)


def judgements_of(folder: Folder, lesson: LessonText) -> tuple[Judgement, ...]:
    """Return the sentences of a lesson to be judged true or false, as ``exercises/book/true_or_false.toml``
    states them.

    Raises
    ------
    BadCourse
        One has no text, no truth or no reason in the language.
    """
    stated = folder.book_table("true_or_false").get(lesson.name, {})
    try:
        return tuple(
            Judgement(
                f"{lesson.number}.{ascii_uppercase[k]}",
                row[lesson.lang],
                bool(row["is_true"]),
                row["why"][lesson.lang],
                k % 2 == 0,
            )
            for k, row in enumerate(stated.get("sentences", ()))
        )
    except (KeyError, TypeError) as fault:
        raise BadCourse(
            f"exercises/book/true_or_false.toml: {lesson.name}: a sentence has no {fault}"
        ) from fault


def _variants(course: Course[Any], name: str, lang: str, seed: int) -> Sequence[Variant]:
    first = _FAR + _APART * seed
    sheet = handout(distinct_variants(course[name], first, 1, lang)[0])
    # What is measured on a drawing takes longer than two minutes.
    drawn = any(q.is_open or q.kind not in _SHORT or q.box == "millimetre" for q in sheet.questions)
    return () if drawn else distinct_variants(course[name], first, _VARIANTS, lang)


def _fill(
    found: list[Drill],
    drawn: Mapping[str, Sequence[Variant]],
    grade: int,
    count: int,
    posed: Counter[str],
    *,
    back: bool,
) -> None:
    """Add drills of a grade until there are so many, or no question is left; ``back`` from the quantity to a
    datum."""
    for variant, part in _in_turn(drawn, grade):
        if len(found) >= count:
            return
        drill = _drill(variant, part, grade, back=back)
        kinds = drill.kinds if drill else ()
        if drill and all(posed[kind] < (1 if back else _MOST) for kind in kinds):
            variant_name = f"{drill.exercise} {drill.seed} "
            asked = variant_name + part.quantity
            given = {variant_name + name for name in drill.values if name not in variant.used} - {asked}
            same = (drill.text, f"{drill.exercise} {drill.answer}", asked, *(f"{one}?" for one in given))
            if not any(posed[one] for one in same):  # nor does the answer of one stand in another
                posed.update((*same[:3], *given, f"{asked}?", *kinds))
                found.append(drill)


def _in_turn(drawn: Mapping[str, Sequence[Variant]], grade: int) -> Iterator[tuple[Variant, Part]]:
    """Yield questions of each exercise in turn, of another variant each time; a grade begins with others than
    the one before."""
    rows = []
    for variants in drawn.values():
        asked = [
            [p for p in variant.parts if p.kind in (*_MEASURED, "choice") and not p.judge]
            for variant in variants
        ]
        most = max(map(len, asked), default=0)
        first = 2 * (grade - 1)
        pairs = (
            (
                variants[k % len(variants)],
                asked[k % len(variants)][(k + shift) % len(asked[k % len(variants)])],
            )
            for shift in range(most)
            for k in range(first, first + len(variants))
            if asked[k % len(variants)]
        )
        rows.append(list(pairs))
    yield from (pair for pair in chain.from_iterable(zip_longest(*rows)) if pair is not None)


def _drill(variant: Variant, part: Part, grade: int, *, back: bool) -> Drill | None:
    """Return a drill, or None where a question makes none of this grade."""
    try:
        names = _data(variant, part.quantity, grade)
        if not names or len(names) > _GIVEN:
            return None
        values = {name: _as_printed(variant, name) for name in names}
        graph = variant.exercise.solution.graph.textbook
        found = graph.evaluate([part.quantity], values), variant.quantities([part.quantity])
        answer, exact = (one[part.quantity] for one in found)
        if part.kind == "choice":
            answer, exact = str(answer), str(exact)
        if not _is_fit(answer, exact, values):
            return None
        question = next(q for q in handout(variant).questions if q.id == part.id)
        drill = Drill(
            "",  # numbered in their order
            grade,
            variant.exercise.name,
            variant.seed,
            named_question(question),
            "",
            part.quantity,
            values,
            answer,
            f"{question.prompt} {back}",
        )
        if back:
            drill = _turned(variant, replace(question, unit=""), drill)
        elif question.choices:
            cases = dict(question.choices)
            between = f"{words(variant.lang)['sheet']['separator']} "
            listed = between.join(cases.values())
            drill = replace(drill, text=f"{drill.text} ({listed})", answer=cases[answer])
        else:
            drill = replace(drill, answer=_told(variant, part.quantity, answer), result=float(answer))
        given = ", ".join(
            _given(variant, name, drill.values[name]) for name in names if name != drill.quantity
        )
    except (CourseworkError, ArithmeticError, LookupError, TypeError, ValueError):
        return None
    text = drill.text.replace(r"\dfrac", r"\frac")  # in a line of small type
    return replace(drill, text=f"{given}. {text}" if given else text)


def _turned(variant: Variant, question: Question, drill: Drill) -> Drill:
    """Return a drill that tells the quantity, and asks a datum in its place."""
    printed = float(f"{drill.result:.{_DIGITS}g}")
    sought, found = _line_back(variant, drill.quantity, drill.values, printed)
    given = next(g for g in handout(variant).given if g.name == sought)
    unit = f" ({given.unit})" if given.unit else ""
    said = words(variant.lang)["book"]["drill_back"]
    told = said.format(_told(variant, drill.quantity, printed), f"${given.symbol}${unit}")
    return replace(
        drill,
        text=f"{named_question(question)} {told}",
        answer=_told(variant, sought, found),
        quantity=sought,
        values={**{k: v for k, v in drill.values.items() if k != sought}, drill.quantity: printed},
        result=found,
    )


def _line_back(
    variant: Variant, quantity: str, values: Mapping[str, Any], printed: float
) -> tuple[str, float]:
    """Return a datum on which the quantity depends by a straight line, and what it is where the quantity is
    as printed; the datum is another one for each variant.

    Raises
    ------
    ValueError
        There is none whose digits the quantity gives back.
    """
    graph = variant.exercise.solution.graph.textbook
    measured = [given.name for given in handout(variant).given if given.is_number and given.name in values]
    turn = variant.seed % len(measured) if measured else 0
    for name in (*measured[turn:], *measured[:turn]):
        here = [float(values[name]) * times for times in _SPREAD]
        there = [graph.evaluate([quantity], {**values, name: at})[quantity] for at in here]
        rise, run = there[-1] - there[0], here[-1] - here[0]
        size = max(map(abs, there))
        if abs(rise) <= 1e-3 * size or not all(
            abs((y - there[0]) * run - (x - here[0]) * rise) <= 1e-9 * size * abs(run)
            for x, y in zip(here, there, strict=True)
        ):
            continue
        found = here[0] + (printed - there[0]) * run / rise
        if abs(found - values[name]) <= _BACK * abs(values[name]):
            return name, found
    raise ValueError(quantity)


def _told(variant: Variant, name: str, value: float) -> str:
    """Return a number with its unit."""
    unit = variant.exercise.units.get(name, "1")
    return f"${number_latex(value, '1', _DIGITS)}{unit_latex(unit)}$"


def _data(variant: Variant, quantity: str, grade: int) -> list[str]:
    """Return the names of what a drill of a grade gives; nothing where none leads to the quantity in so many
    formulas.

    A sheet names what is given and what is asked: nothing else can be given in a drill.
    """
    if quantity in variant.used:
        return []
    steps: set[str] = {quantity}
    names = _known(variant, [quantity], steps)
    while len(steps) <= _STEPS[-1]:
        if _STEPS[grade - 1] < len(steps) <= _STEPS[grade]:
            return list(names)
        computed = [name for name in names if name not in variant.used]
        if not computed:
            break
        steps |= {*computed}
        data = [name for name in names if name in variant.used]
        names = tuple(dict.fromkeys((*data, *_known(variant, computed, steps))))
    return []


def _known(variant: Variant, quantities: Sequence[str], steps: set[str]) -> tuple[str, ...]:
    """Return what the sheet names of the needs of some quantities; what it does not name is seen through, as
    further steps."""
    asked = {part.quantity for part in variant.parts}
    names: dict[str, None] = {}
    for quantity in quantities:
        for name in needs(variant, quantity):
            if name in variant.used or name in asked:
                names.setdefault(name)
            else:
                steps.add(name)
                names |= dict.fromkeys(_known(variant, [name], steps))
    return tuple(names)


def _as_printed(variant: Variant, name: str) -> Any:
    """Return a value as the drill prints it."""
    if name in variant.used:
        return variant.used[name]
    value = variant.quantities([name])[name]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise TypeError(name)
    return float(f"{value:.{_DIGITS}g}")


def _is_fit(answer: Any, exact: Any, values: Mapping[str, Any]) -> bool:
    """Return whether rounding of what is given leaves the answer, and none of it is the answer already."""
    if isinstance(answer, str):
        return bool(answer == exact)
    if isinstance(answer, (bool, complex)) or not math.isfinite(answer):
        return False
    if any(
        isinstance(v, (int, float)) and abs(abs(v) - abs(answer)) <= 1e-3 * abs(answer)
        for v in values.values()
    ):
        return False
    return abs(answer - exact) <= _LOST * abs(exact) and abs(exact) > 1e-9


def _given(variant: Variant, name: str, value: Any) -> str:
    if name in variant.used:
        given = next((g for g in handout(variant).given if g.name == name), None)
        if given is None:  # it is drawn, and stands on no sheet
            raise ValueError(name)
        return f"${given_formula(given)}$" if given.is_number else given_words(given, variant.lang)
    return f"${variant.solution_symbol(name)} = {_told(variant, name, value)[1:]}"
