"""Drills of a lesson: questions of two minutes, drawn from variants of its exercises.

A drill asks one quantity and gives what its formula takes: one step back, two steps, or the data alone; or
it tells the quantity, and asks a datum. The answer is computed from the numbers as printed, so that who puts
them in finds the digits of the book.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, product, zip_longest
from string import ascii_uppercase
from typing import Any

from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.folder import Folder
from coursework.course.lessons import check_parts, practised, taught_by
from coursework.course.variant import Variant
from coursework.errors import BadCourse, CourseworkError, nearest
from coursework.issuing.issuing import distinct_variants
from coursework.language.numbers import unit_latex, unit_text
from coursework.language.words import words
from coursework.model import Part
from coursework.quantities.formula_latex import number_latex
from coursework.rendering.views import given_formula, given_words
from coursework.selfstudy.worked import named_question
from coursework.sheets.book import Drill, DrillGroup, Judgement, LessonText
from coursework.sheets.following import needs
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Question

GRADES = (4, 3, 3)  #: drills of each grade in a section that has enough
MOST = 40  #: drills of a lesson
_FEWEST = 4  #: of a section, where a lesson has many
_FAR, _APART, _BETWEEN = 700_000, 1_000, 20  #: seeds away from all others, between two books, and two lessons
_VARIANTS = 6  #: of each exercise from which they are drawn
_ALIKE = 2  #: drills of a lesson that ask the same with other numbers
_GIVEN = 6  #: numbers that a drill gives at most
_STEPS = 4  #: formulas that a drill takes at most
_DIGITS = 4  #: of a number that is given though it is computed
_LOST = 0.01  #: how far its rounding may move the answer
_BACK = 0.002  #: how far a datum may be from what is found back
_MEASURED = ("number", "integer", "angle")
_CHOSEN = ("angle", "choice")  #: kinds of which a quadrant or a case is to be chosen
_SPREAD = (-1, 0.3, 0.6, 1, 2, 3)  #: times a datum: who is asked for it has a line to solve, so one answer
_NUDGE = 1e-3  #: times a datum: a sum answers with just so much
_TABLE = "exercises/book/drills.toml"


@dataclass(frozen=True)
class _Possible:
    """Question that a drill may be: a quantity from what it gives, or ``back`` to one of these."""

    variant: Variant
    part: Part
    names: tuple[str, ...]
    grade: int
    back: bool


def drills_of(
    course: Course[Any], lesson: LessonText, seed: int, grades: Sequence[int] = GRADES
) -> tuple[DrillGroup, ...]:
    """Return the drills of a lesson by its sections, and in each by exercise, the easiest first.

    Parameters
    ----------
    course
        An open course.
    lesson
        The lesson: each question of the exercises that it teaches stands under the section that teaches it.
    seed
        Which book.
    grades
        How many of each grade a section has.

    Raises
    ------
    BadCourse
        ``exercises/book/drills.toml`` names an exercise, a question or a section that is not there.
    """
    first = _FAR + _APART * seed + _BETWEEN * lesson.number
    stated = _stated(course.folder)
    titles = {}
    pools: dict[str, dict[str, list[_Possible]]] = {}
    for name in practised(course.folder, lesson.name, lesson.lang):
        placed = _placed(course[name], lesson, stated.get(name, {}).get("sections", {}))
        if not placed:
            continue
        variants = distinct_variants(course[name], first, _VARIANTS, lesson.lang)
        titles[name] = variants[0].text.title
        for section, ids in placed.items():
            if possible := [one for one in _possible(variants) if one.part.id in ids]:
                pools.setdefault(section, {})[name] = possible
    count = min(sum(grades), max(_FEWEST, MOST // max(1, len(pools))))
    posed: Counter[str] = Counter()
    groups: list[DrillGroup] = []
    told: set[str] = set()
    number = 0
    for section in sorted(pools, key=lambda heading: int(heading.partition(".")[0] or 0)):
        found = _chosen(pools[section], grades, count, posed)
        for name in pools[section]:
            own = [drill for drill in found if drill.exercise == name]
            drills = tuple(
                replace(drill, number=f"{lesson.number}.{k}")
                for k, drill in enumerate(sorted(own, key=lambda drill: drill.grade), number + 1)
            )
            number += len(drills)
            setting = "" if name in told else stated.get(name, {}).get(lesson.lang, "")
            if drills:
                told.add(name)
                groups.append(DrillGroup(section, name, titles[name], setting, drills))
    return tuple(groups)


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


def _stated(folder: Folder) -> Mapping[str, Mapping[str, Any]]:
    """Return what ``exercises/book/drills.toml`` states of each exercise: what a reader must know who has not
    its sheet, by language, and the section that teaches a question, by ``sections``."""
    stated = folder.book_table("drills")
    for name in stated:
        if name not in folder.names:
            raise BadCourse(f"{_TABLE} names no exercise {name!r}{nearest(name, folder.names)}")
    return stated


def _placed(
    exercise: CourseExercise[Variant], lesson: LessonText, stated: Mapping[str, Any]
) -> dict[str, set[str]]:
    """Return the questions of an exercise that a lesson teaches, by the headings of its sections.

    A question stands in the lesson that names it among its ``parts``, or else in the first one; there in the
    section that ``drills.toml`` says, which leaves it out by 0, or else in the first one that teaches the
    exercise.
    """
    taught = taught_by(exercise.folder, exercise.name, lesson.lang)
    ids = [part.id for part in exercise.spec.parts]
    check_parts(exercise, taught)
    if wrong := [one for one in stated if one not in ids]:
        raise BadCourse(f"{_TABLE}: {exercise.name} has no question {wrong[0]!r}{nearest(wrong[0], ids)}")
    placed: dict[str, set[str]] = {}
    for one in ids:
        place = next((item for item in taught if one in item.parts), taught[0])
        if place.name != lesson.name or stated.get(one) == 0:
            continue
        headings = {number: f"{number}. {title}" for number, title in place.places}
        wanted = str(stated.get(one, next(iter(headings), "")))
        if wanted and wanted not in headings:
            raise BadCourse(
                f"{_TABLE}: {exercise.name}: {one}: no section {wanted} of the lesson {place.name} teaches "
                f"it; exercises/course.toml names {', '.join(headings) or 'none'}"
            )
        placed.setdefault(headings.get(wanted, ""), set()).add(one)
    return placed


def _possible(variants: Sequence[Variant]) -> Iterator[_Possible]:
    """Yield what drills may ask, of another variant and of another question each time."""
    asked = [_short(variant) for variant in variants]
    for shift in range(max(map(len, asked), default=0)):
        for k, (variant, parts) in enumerate(zip(variants, asked, strict=True)):
            part = parts[(shift + k) % len(parts)]
            for names, steps in _levels(variant, part.quantity):
                if len(names) > _GIVEN or not (names or part.kind == "choice"):
                    continue
                is_sum = part.kind in _MEASURED and _is_sum(variant, part.quantity, names)
                grade = 1 if is_sum else min(len(GRADES), max(steps, 2 if part.kind in _CHOSEN else 1))
                yield _Possible(variant, part, names, grade, back=False)
                if part.kind in _MEASURED:
                    harder = grade if is_sum else min(len(GRADES), grade + 1)
                    yield _Possible(variant, part, names, harder, back=True)


def _short(variant: Variant) -> list[Part]:
    """Return the questions of two minutes: what is drawn, or measured on a drawing, takes longer."""
    questions = {q.id: q for q in handout(variant).questions}
    return [
        part
        for part in variant.parts
        if part.kind in (*_MEASURED, "choice")
        and not part.judge
        and not questions[part.id].is_open
        and questions[part.id].box != "millimetre"
    ]


def _is_sum(variant: Variant, quantity: str, names: Sequence[str]) -> bool:
    """Return whether a quantity is the sum or the difference of what is given, and of constants."""
    graph = variant.exercise.solution.graph.textbook
    try:
        values = {name: _as_printed(variant, name) for name in names}
        here = graph.evaluate([quantity], values)[quantity]
        for name, value in values.items():
            if _is_number(value):
                nudge = _NUDGE * (abs(value) or 1)
                there = graph.evaluate([quantity], {**values, name: value + nudge})[quantity]
                if min(abs(abs(there - here) - share * nudge) for share in (0, 1)) > 1e-6 * nudge:
                    return False
    except (CourseworkError, ArithmeticError, LookupError, TypeError, ValueError):
        return False
    return True


def _chosen(
    pool: Mapping[str, Sequence[_Possible]], grades: Sequence[int], most: int, posed: Counter[str]
) -> list[Drill]:
    """Return the drills of a section: of each grade as many as it should have, one of them back to a datum
    where there is one; then others, and at last those that repeat one with other numbers."""
    found: list[list[Drill]] = [[] for _ in grades]
    rows = list(pool.values())
    in_turn = [one for one in chain.from_iterable(zip_longest(*rows)) if one is not None]
    for alike, open_to in product(range(1, _ALIKE + 1), (False, True)):
        for grade, count in enumerate(grades, 1):
            here = found[grade - 1]
            for share, back in ((count - 1, False), (count, True), (count, False)):
                left = most - sum(map(len, found))
                ours = [one for one in in_turn if one.grade == grade and one.back == back]
                _fill(here, ours, min(len(here) + left, most if open_to else share), posed, alike)
    return list(chain.from_iterable(found))


def _fill(
    found: list[Drill], possible: Sequence[_Possible], count: int, posed: Counter[str], alike: int
) -> None:
    """Add drills until there are so many, or none is left that ask other than those before; ``alike`` may
    differ by their numbers alone."""
    for one in possible:
        if len(found) >= count:
            return
        drill = _drill(one)
        most = alike if one.names and not one.back else 1
        if drill and all(posed[kind] < most for kind in drill.kinds):
            variant_name = f"{drill.exercise} {drill.seed} "
            asked = variant_name + drill.quantity
            given = {variant_name + name for name in drill.values if name not in one.variant.used}
            same = (
                drill.text,
                f"{drill.exercise} {drill.quantity} {drill.result}",
                asked,
                *(f"{name}?" for name in given),
            )
            if not any(posed[told] for told in same):  # nor does the answer of one stand in another
                posed.update((*same[:3], *given, f"{asked}?", *drill.kinds))
                found.append(drill)


def _drill(possible: _Possible) -> Drill | None:
    """Return a drill, or None where its numbers make none."""
    variant, part, names = possible.variant, possible.part, possible.names
    try:
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
            possible.grade,
            variant.exercise.name,
            variant.seed,
            named_question(question),
            "",
            part.quantity,
            values,
            answer,
            f"{variant.exercise.name} {part.id} {possible.back}",
        )
        if possible.back:
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
    """Return a drill that tells the quantity, and asks for one of what is given in its place."""
    printed = float(f"{drill.result:.{_DIGITS}g}")
    sought, found = _line_back(variant, drill.quantity, drill.values, printed)
    unit = unit_text(variant.exercise.units.get(sought, "1"), variant.lang)
    symbol = f"${variant.exercise.symbol(sought, variant.lang)}$" + (f" ({unit})" if unit else "")
    told = words(variant.lang)["book"]["drill_back"].format(_told(variant, drill.quantity, printed), symbol)
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
    """Return one of what is given, on which or on whose inverse the quantity depends by a straight line, and
    what it is where the quantity is as printed; it is another one for each variant.

    Raises
    ------
    ValueError
        There is none whose digits the quantity gives back.
    """
    graph = variant.exercise.solution.graph.textbook
    measured = [name for name, value in values.items() if _is_number(value) and value]
    turn = variant.seed % len(measured) if measured else 0
    for name, power in product((*measured[turn:], *measured[:turn]), (1, -1)):
        value = float(values[name])
        here = [times if power == 1 else 1 / times for times in _SPREAD]
        there = [graph.evaluate([quantity], {**values, name: value * one**power})[quantity] for one in here]
        rise, run = there[-1] - there[0], here[-1] - here[0]
        size = max(map(abs, there))
        if abs(rise) <= 1e-3 * size or not all(
            abs((y - there[0]) * run - (x - here[0]) * rise) <= 1e-9 * size * abs(run)
            for x, y in zip(here, there, strict=True)
        ):
            continue
        found = value * (here[0] + (printed - there[0]) * run / rise) ** power
        others = [other for name_of, other in values.items() if name_of != name]
        if abs(found - value) <= _BACK * abs(value) and not _stands_in(found, others):
            return name, float(round(found)) if isinstance(values[name], int) else found
    raise ValueError(quantity)


def _stands_in(answer: float, values: Iterable[Any]) -> bool:
    """Return whether what is given is the answer already, but for its sign."""
    return any(_is_number(v) and abs(abs(v) - abs(answer)) <= 1e-3 * abs(answer) for v in values)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _told(variant: Variant, name: str, value: float) -> str:
    """Return a number with its unit."""
    unit = variant.exercise.units.get(name, "1")
    return f"${number_latex(value, '1', _DIGITS)}{unit_latex(unit)}$"


def _levels(variant: Variant, quantity: str) -> Iterator[tuple[tuple[str, ...], int]]:
    """Yield the names of what a drill may give, from the needs of the quantity's formula back to the data,
    each with the count of formulas that lead from them to the quantity.

    A sheet names what is given and what is asked: nothing else can be given in a drill.
    """
    if quantity in variant.used:
        return
    steps: set[str] = {quantity}
    names = _known(variant, [quantity], steps)
    while len(steps) <= _STEPS:
        yield names, len(steps)
        computed = [name for name in names if name not in variant.used]
        if not computed:
            return
        steps |= {*computed}
        data = [name for name in names if name in variant.used]
        names = tuple(dict.fromkeys((*data, *_known(variant, computed, steps))))


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
    if not _is_number(value):
        raise TypeError(name)
    return float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value


def _is_fit(answer: Any, exact: Any, values: Mapping[str, Any]) -> bool:
    """Return whether rounding of what is given leaves the answer, and none of it is the answer already."""
    if isinstance(answer, str):
        return bool(answer == exact)
    if isinstance(answer, (bool, complex)) or not math.isfinite(answer):
        return False
    if _stands_in(answer, values.values()):
        return False
    return abs(answer - exact) <= _LOST * abs(exact) and abs(exact) > 1e-9


def _given(variant: Variant, name: str, value: Any) -> str:
    if name in variant.used:
        given = next((g for g in handout(variant).given if g.name == name), None)
        if given is None:  # it is drawn, and stands on no sheet
            raise ValueError(name)
        return f"${given_formula(given)}$" if given.is_number else given_words(given, variant.lang)
    return f"${variant.solution_symbol(name)} = {_told(variant, name, value)[1:]}"
