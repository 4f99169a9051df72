"""The promises that every exercise keeps, tried on many variants.

Used by ``coursework check`` on any course folder, and by this project's own tests.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np

from coursework.authoring.check_alone import check_alone
from coursework.authoring.check_answers import (
    check_follow_through,
    check_mistakes,
    check_nonsense,
    check_right_answers,
    check_rounding_students,
    check_slips,
)
from coursework.authoring.check_formulas import check_formulas
from coursework.authoring.check_guesses import check_guesses
from coursework.authoring.check_knowledge import check_knowledge
from coursework.authoring.check_loops import check_loops
from coursework.authoring.check_mechanism import check_mechanism
from coursework.authoring.check_penalties import check_prices
from coursework.authoring.check_report import RESIDUAL, CheckReport
from coursework.authoring.check_units import check_units
from coursework.authoring.check_usual import check_usual_errors
from coursework.course.answer_key import Key, exists
from coursework.course.course import Course, opened
from coursework.course.exercise import ALL, CourseExercise, refuse_complex
from coursework.course.folder import MECHANISM
from coursework.course.variant import Variant
from coursework.errors import BadCourse, CourseworkError, MissingQuantity, Starved, nearest
from coursework.issuing.flaws import conditioning
from coursework.issuing.issuing import distinct_variants
from coursework.issuing.protection import valid_variants
from coursework.language.words import file_of, words
from coursework.linkages.closure import RelativeGaps
from coursework.model import Part
from coursework.quantities.graph import plain_scalar
from coursework.rendering.renderer import renderer_of
from coursework.scenes.animation import Animation
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.handout import handout as handout_of
from coursework.sheets.handout import prompt
from coursework.system.processes import Lost, Submit, processes, workers

RENDERED = 1  #: variants whose sheets are rendered in every format and language
_SOME = 3  #: variants that show whether a quantity is complex
NONSENSICAL = 20  #: variants that are answered by nonsense; it is read alike on all


def check(
    exercise: CourseExercise, variants: int, *, rendered: int = RENDERED, submit: Submit | None = None
) -> CheckReport:
    """Try every promise on the variants of seeds 0, 1, …; other processes answer some of the variants if
    ``submit`` sends calls to them.

    Whatever breaks is reported, and the rest is tried all the same, unless no variant has an answer.
    """
    report = CheckReport(exercise.name)
    if not (check_needs(exercise, report) and check_reals(exercise, report)):
        return report
    _try(report, check_texts, exercise)
    _try(report, check_translations, exercise)
    _try(report, check_symbols, exercise)
    _try(report, check_known, exercise)
    _try(report, _check_variants, exercise, variants, submit)
    _try(report, check_rendering, exercise, rendered)
    return report


def _try(report: CheckReport, step: Callable[..., None], *arguments: Any) -> bool:
    """Return whether a check came to its end; report what stopped it, perhaps an author's slip in a function
    of the course."""
    try:
        step(*arguments, report)
    except _NotAnswered:
        raise
    except Exception as fault:
        report.fail(_problem(fault))
        return False
    return True


class _NotAnswered(Exception):
    """Error of the processes that answer variants, and not of the exercise: nothing is known of it."""

    def __init__(self, fault: Exception) -> None:
        super().__init__(str(fault))
        self.fault = fault


def _problem(fault: Exception) -> str:
    return str(fault) if isinstance(fault, CourseworkError) else f"{type(fault).__name__}: {fault}"


def check_all(
    course: Course, names: Sequence[str], variants: int, progress: Callable[[], None] = lambda: None
) -> list[CheckReport]:
    """Return a report an exercise, in this order, made by as many processes as there are processors: they
    share the exercises, or the variants of each if there are few exercises."""
    count = workers(variants, _WORTH_PROCESSES)
    if count < 2:
        return [_with_progress(_check_one(course, name, variants), progress) for name in names]
    with processes(count) as submit:
        if len(names) < count:
            try:
                return [
                    _with_progress(_check_one(course, name, variants, submit), progress) for name in names
                ]
            except _NotAnswered as stopped:
                raise stopped.fault from None
        # The longest first, so that no process waits for another at the end.
        longest = sorted(names, key=lambda name: -_length(course, name))
        tasks = {name: submit(_check_elsewhere, str(course.folder.root), name, variants) for name in longest}
        for task in tasks.values():
            task.add_done_callback(lambda _: progress())
        try:
            return [tasks[name].result() for name in names]
        except Lost as fault:
            left = [name for name in names if not (tasks[name].done() and tasks[name].exception() is None)]
            raise Lost("{problem}: not checked: {names}", problem=fault, names=", ".join(left)) from None


_WORTH_PROCESSES = 50  #: variants an exercise; fewer are done before a process has started
_BLOCK = 8  #: variants that a process answers at a time


def _length(course: Course, name: str) -> int:
    """Roughly how long an exercise takes to check."""
    try:
        return len(course[name].spec.parts)
    except CourseworkError:
        return 0  # it says what is wrong when it is checked


def _with_progress(report: CheckReport, progress: Callable[[], None]) -> CheckReport:
    progress()
    return report


def _check_elsewhere(root: str, name: str, variants: int) -> CheckReport:
    try:
        course = opened(root, Variant)
    except CourseworkError as fault:
        report = CheckReport(name)
        report.fail(str(fault))
        return report
    return _check_one(course, name, variants)


def _check_one(course: Course[Any], name: str, variants: int, submit: Submit | None = None) -> CheckReport:
    try:
        return check(course[name], variants, submit=submit)
    except CourseworkError as fault:
        report = CheckReport(name)
        report.fail(str(fault))
        return report


def _check_variants(exercise: CourseExercise, count: int, submit: Submit | None, report: CheckReport) -> None:
    report.acceptance = exercise.draws.acceptance()
    lang = exercise.languages[0]
    try:
        drawn = distinct_variants(exercise, 0, count, lang, report.refused, (ALL,))
    except Starved as fault:
        if not any(failure in str(fault) for failure in report.failures):
            report.fail(str(fault))
        drawn = valid_variants(exercise, exercise.variants(range(count), lang, (ALL,)))
    report.variants = len(drawn)
    if not drawn:
        return
    _describe(drawn, report)
    pending = _answered(exercise, drawn, submit)
    check_arrays(exercise, drawn, report)
    check_rounding_students(exercise, drawn, report)
    later = CheckReport(exercise.name)
    _check_together(drawn, later)  # while others answer
    for result in pending:
        try:
            report.add(result())
        except Exception as fault:
            raise _NotAnswered(fault) from fault
    report.add(later)
    for name in exercise.solution.mistakes:
        tally = report.mistakes.setdefault(name, Counter())
        if count >= 50 and not tally["shown"]:
            report.fail(f"mistake {name} shows in none of {len(drawn)} variants")


def _answered(
    exercise: CourseExercise, drawn: Sequence[Variant], submit: Submit | None
) -> list[Callable[[], CheckReport]]:
    """Return functions that return the reports on the answers to some variants each."""
    if submit is None:
        return [partial(_answers_tried, exercise.name, drawn)]
    root, seeds = str(exercise.folder.root), [variant.seed for variant in drawn]
    blocks = [seeds[k : k + _BLOCK] for k in range(0, len(seeds), _BLOCK)]
    return [submit(_answered_elsewhere, root, exercise.name, block).result for block in blocks]


def _answered_elsewhere(root: str, name: str, seeds: Sequence[int]) -> CheckReport:
    exercise = opened(root, Variant)[name]
    lang = exercise.languages[0]
    return _answers_tried(name, [exercise.variant(seed, lang, (ALL,)) for seed in seeds])


def _answers_tried(name: str, drawn: Sequence[Variant]) -> CheckReport:
    """Return the report on the answers to some variants; a check that cannot go on leaves the others to do
    so."""
    report = CheckReport(name)
    left = [check_solves, check_right_answers, check_mistakes, check_slips, check_follow_through]
    for variant in drawn:
        left = [each for each in left if _try(report, each, variant, variant.key)]
    return report


def _check_together(drawn: Sequence[Variant], report: CheckReport) -> None:
    for variant in drawn[:NONSENSICAL]:
        if not _try(report, check_nonsense, variant):
            break
    _try(report, check_loops, drawn[0])
    for step in (
        check_usual_errors,
        check_knowledge,
        check_guesses,
        check_prices,
        check_mechanism,
        check_formulas,
        check_units,
        check_alone,
    ):
        _try(report, step, drawn)


def _describe(drawn: Sequence[Variant], report: CheckReport) -> None:
    """Record the spread of the variants' difficulty: conditioning, and the branches to choose."""
    shares = [conditioning(variant.key) for variant in drawn]
    report.conditioning = float(np.median(shares)), max(shares)
    for variant in drawn:
        given = variant.exercise.spec.given
        chosen = {n: v for n, v in variant.given.items() if given[n].is_choice}
        chosen |= {
            p.quantity: variant.key.reference[p.quantity] for p in variant.parts if p.sort.has_few_values
        }
        for name, case in chosen.items():
            report.cases.setdefault(name, Counter())[str(case)] += 1


# ------------------------------------------------------------------------ texts


def check_texts(exercise: CourseExercise, report: CheckReport) -> None:
    """Every language says every part, every case and every mistake, and nothing is written in vain."""
    for lang, path in exercise.texts.unspoken.items():
        report.fail(
            f"{path.relative_to(exercise.folder.root).as_posix()} is read by nothing: the engine "
            f"speaks no {lang!r}, "
            f"whose words would be {file_of(lang)}"
        )
    for lang in exercise.folder.languages:
        words(lang)  # a file of words that cannot be used says so here
        if lang not in exercise.languages:
            report.fail(
                f"no statement in {lang!r}: "
                f"{exercise.folder.relative(exercise.texts.file('exercises', lang))} is missing"
            )
            continue
        if exercise.folder.lacks_title(lang):
            report.fail(
                f"exercises/course.toml has no title in {lang!r}: sheets would be headed "
                f"{exercise.folder.title(lang)!r}; write it under [title]"
            )
        variant = exercise.variant(0, lang)
        text = variant.text
        for part in exercise.spec.parts:
            if not prompt(variant, part):
                report.fail(f"{text.source}: section '## {part.id}' is empty")
            for case in part.choices:
                text.label(part.id, case)
        for name, spec in exercise.spec.given.items():
            for case in spec.choices if spec.shown else ():
                text.label(name, case)
        if exercise.spec.figure and not text.section("figure").text:
            report.fail(f"{text.source}: the figure has no words")
        section_text = exercise.texts.text("solutions", lang, _every_name(exercise, variant))
        if exercise.film and not section_text.section("motion").text:
            report.fail(f"{section_text.source}: the film has no words")
        for name in exercise.solution.mistakes:
            if not section_text.section(f"mistake {name}").text:
                report.fail(f"{section_text.source}: mistake {name} has no text")
        report.counts["texts"] += 1


_FORMULA = re.compile(r"\$[^$]*\$")
_WORD = re.compile(r"[^\W\d_]{2,}")
_TELLING = 6  #: words outside formulas that are never the same in two languages


def check_translations(exercise: CourseExercise, report: CheckReport) -> None:
    """Check that no text is the same in two languages: one that was copied and not translated yet."""
    first: dict[tuple[str, str], str] = {}  # the file, by its kind and the text
    for lang in exercise.languages:
        variant = exercise.variant(0, lang)
        texts = {
            "exercises": variant.text,
            "solutions": exercise.texts.text("solutions", lang, _every_name(exercise, variant)),
        }
        for kind, text in texts.items():
            pieces = {"the statement": text.opening} | {
                f"section '## {name}'": section.text for name, section in text.sections.items()
            }
            for name, piece in pieces.items():
                if len(_WORD.findall(_FORMULA.sub(" ", piece))) < _TELLING:
                    continue
                source = first.setdefault((kind, piece), text.source)
                if source != text.source:
                    report.fail(
                        f"{text.source}: {name} says the same as in {source.rpartition('/')[2]}; translate it"
                    )


def _every_name(exercise: CourseExercise, variant: Variant) -> dict[str, object]:
    return {**dict.fromkeys(exercise.solution.graph.quantities, "0"), **variant.printed}


def check_needs(exercise: CourseExercise, report: CheckReport) -> bool:
    """Check that the asked quantities follow from the given ones; return False where a function needs what
    nothing gives."""
    try:
        exercise.plan([part.quantity for part in exercise.judged_parts], effects=exercise.spec.effects)
    except MissingQuantity as fault:
        near = nearest(fault.names[0], ({*exercise.spec.given} | exercise.quantity_names) - {*fault.names})
        report.fail(f"{exercise.solution.source}: {fault.needed}{near}")
        return False
    except CourseworkError:
        pass  # what needs it reports it
    return True


def check_reals(exercise: CourseExercise, report: CheckReport) -> bool:
    """Numbers that are asked are real; False where one is complex, which nothing can mark."""
    for seed in range(_SOME):
        try:
            variant = exercise.variant(seed, parts=(ALL,))
            values = variant.quantities(variant.asked_quantities)
        except Exception:
            continue  # what needs it reports it
        try:
            refuse_complex(exercise, variant.parts, values)
        except BadCourse as fault:
            report.fail(str(fault))
            return False
    return True


def check_symbols(exercise: CourseExercise, report: CheckReport) -> None:
    """Check that each given or asked quantity has its symbol on the sheet too, not in the solution alone."""
    on_the_sheet = {*exercise.spec.given, *(part.quantity for part in exercise.spec.parts)}
    for name, symbol in exercise.solution.symbols.items():
        # Where the exercise has its own, another form in formulas, a fraction say, is the author's choice.
        stated = name in exercise.spec.symbols
        if name in on_the_sheet and not stated and symbol != exercise.spec.symbol(name):
            report.fail(
                f"SYMBOLS of {exercise.solution.source} names {name!r}, which is given or asked: its "
                "symbol belongs "
                f"in Exercise(symbols=…), else the sheet shows it as {exercise.spec.symbol(name)}"
            )


# ------------------------------------------------------------------------ known


def check_known(exercise: CourseExercise, report: CheckReport) -> None:
    """Check that the solution gives the values known without it."""
    # The residual of a mechanism that is stated as a file tells the side of each assembly.
    if not exercise.solution.known and not exercise.solution.source.endswith(MECHANISM):
        report.fail("the solution states no KNOWN case; closure alone cannot tell the branch")
    for given, expected, *effect_names in exercise.solution.known:
        effects = effect_names[0] if effect_names else exercise.spec.effects
        values = exercise.solve(**given, only=tuple(expected), effects=effects)
        for name, value in expected.items():
            if not agrees(values[name], value, is_angle=_is_orientation(exercise, name)):
                report.fail(f"known case {dict(given)}: {name} is {values[name]!r}, not {value!r}")
            report.counts["known values"] += 1


def _is_orientation(exercise: CourseExercise, name: str) -> bool:
    return any(p.quantity == name and p.sort.turn for p in exercise.spec.parts)


def agrees(value: Any, expected: Any, *, is_angle: bool = False) -> bool:
    """Return whether a value agrees with a known one: with a printed text to its last digit, with a number or
    a vector to 1e-9 relative."""
    if isinstance(value, str):
        return value == expected
    if isinstance(expected, str):
        digits = len(expected.partition(".")[2])
        allowed = 0.5 * 10.0**-digits * (1 + 1e-9)
    else:
        allowed = 1e-9 * max(1.0, float(np.max(np.abs(expected))))
    gap = _numbers(value) - _numbers(expected)
    if np.shape(gap) != np.shape(value):
        return False
    if is_angle:
        gap = gap - 360.0 * np.rint(gap / 360.0)
    return bool(np.all(np.abs(gap) <= allowed))


def _numbers(value: Any) -> np.ndarray:
    array = np.asarray(value)
    return array if array.dtype.kind == "c" else np.asarray(value, dtype=float)


# --------------------------------------------------------------------- solution


def check_solves(variant: Variant, key: Key, report: CheckReport) -> None:
    """Every asked quantity is finite, and the governing equations hold."""
    for name, value in key.reference.items():
        if not exists(value):
            report.fail(f"seed {variant.seed}: {name} is {value}")
    for part in variant.parts:
        if part.sort.is_open:
            report.by_person.add(part.id)
            continue
        value = key.reference[part.quantity]
        if part.sort.is_number and part.has_margin and part.atol == 0 and value == 0:
            report.fail(
                f"seed {variant.seed}: {part.id} is 0 and has no absolute tolerance: state "
                f"Part({part.id!r}, atol=…), or a "
                "constraint that refuses such a draw"
            )
    for number, (value, size) in enumerate(_residuals(variant), start=1):
        report.counts["residuals"] += 1
        if not value <= RESIDUAL * size:
            report.fail(f"seed {variant.seed}: residual {number} is {value:.3g}, of terms of {size:.3g}")


def _residuals(variant: Variant) -> Iterator[tuple[float, float]]:
    """Yield the largest value of each governing equation, and the size of its terms: the sum of what each
    number in it contributes, by the change of the equation with that number; 1 where no number contributes,
    or the equation is divided by it."""
    graph = variant.exercise.solution.residual_graph
    found = graph.everything(("residual",), variant.used, variant.effects, variant.computed)
    if isinstance(found["residual"], RelativeGaps):
        yield from ((float(np.max(gap)), 1.0) for gap in found["residual"])
        return
    node = graph.node("residual")
    known = {**node.defaults, **variant.used, **found}
    arguments = [known[name] for name in node.arguments]
    values = _flat(found["residual"])
    sizes = [0.0 * value for value in values]
    for place, argument in enumerate(arguments):
        for near in _slightly_more(argument):
            changed = _flat(node.function(*arguments[:place], near, *arguments[place + 1 :]))
            sizes = [
                s + np.nan_to_num(abs(c - v)) / _STEP for s, c, v in zip(sizes, changed, values, strict=True)
            ]
    for value, size in zip(values, sizes, strict=True):
        worst = int(np.argmax(value - RESIDUAL * size))
        yield float(value.flat[worst]), float(size.flat[worst]) or 1.0


_STEP = 1e-6  #: relative change of a number by which its contribution to an equation is found


def _flat(residual: Any) -> list[np.ndarray]:
    """Return the absolute values of the equations."""
    equations = residual if isinstance(residual, tuple) else (residual,)
    return [np.abs(np.atleast_1d(np.asarray(equation, dtype=complex))) for equation in equations]


def _slightly_more(argument: Any) -> Iterator[Any]:
    """Yield the argument with one of its numbers changed, each in turn; nothing of a text or a count."""
    if isinstance(argument, (float, complex)):
        yield argument * (1 + _STEP)
    elif isinstance(argument, np.ndarray) and argument.dtype.kind in "fc":
        for place in np.ndindex(argument.shape):
            near = argument.copy()
            near[place] *= 1 + _STEP
            yield near


def check_arrays(exercise: CourseExercise, drawn: Sequence[Variant], report: CheckReport) -> None:
    """One request on arrays gives what each variant gives alone."""
    given = {n: np.array([v.given[n] for v in drawn]) for n in exercise.spec.given}
    wanted = tuple(dict.fromkeys(p.quantity for p in exercise.judged_parts))
    together = exercise.solve(**given, only=wanted, effects=exercise.spec.effects)
    for index, variant in enumerate(drawn):
        alone = {
            name: plain_scalar(value) for name, value in variant.quantities(variant.asked_quantities).items()
        }
        for part in (part for part in variant.parts if not part.sort.is_open):
            value = together[part.quantity]
            varies = isinstance(value, np.ndarray) and value.ndim > part.sort.rank
            element = value[index] if varies and len(value) == len(drawn) else value
            if not _same(element, alone[part.quantity], part):
                report.fail(
                    f"seed {variant.seed}: {part.id} is {alone[part.quantity]} alone, {element} in an array"
                )
            report.counts["arrays"] += 1


def _same(first: Any, other: Any, part: Part) -> bool:
    if isinstance(other, str):
        return str(first) == other
    if isinstance(other, (int, float)):
        gap = first - other
        gap = math.remainder(gap, part.sort.turn) if part.sort.turn else gap
        return abs(gap) <= 1e-9 * max(1.0, abs(other))
    if np.shape(first) != np.shape(other):
        return False
    gap = _numbers(first) - _numbers(other)
    return bool(np.all(np.abs(gap) <= 1e-9 * np.maximum(1.0, np.abs(other))))


# -------------------------------------------------------------------- rendering


def check_rendering(exercise: CourseExercise, count: int, report: CheckReport) -> None:
    """Sheets, worked solutions and notebooks render in every language."""
    renderer = renderer_of(exercise.folder)
    for lang in exercise.languages:
        for variant in exercise.variants(range(count), lang, (ALL,)):
            handout, sheet = handout_of(variant), answer_sheet(variant)
            for document in (
                renderer.pdf(handout),
                renderer.html(handout),
                renderer.notebook(handout),
                renderer.pdf(sheet),
                renderer.html(sheet),
            ):
                report.counts["sheets rendered"] += bool(document)
    if exercise.film and count:
        Animation(exercise.variant(0), count=8).frames  # noqa: B018  a film that cannot be shown says so here
