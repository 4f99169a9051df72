"""The promises that every exercise keeps, tried on many variants.

Used by ``coursework check`` on any course folder, and by this project's own tests.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from coursework import draws
from coursework.check_report import KEPT_DIGITS, RESIDUAL, Report
from coursework.comparing import distance
from coursework.course import Course, open_course
from coursework.errors import CourseworkError, MissingQuantity, Starved, nearest
from coursework.exercise import ALL, CourseExercise
from coursework.graph import plain_scalar
from coursework.issuing import distinct_variants
from coursework.judging import judged, judges_of
from coursework.key import FOLLOWED, Key, envelopes, exists
from coursework.language import file_of, languages, plain, significant, words
from coursework.loop_checks import check_loops
from coursework.model import Part
from coursework.processes import processes, workers
from coursework.rounding import student_who_rounds
from coursework.sheets import prompt
from coursework.variant import Variant
from coursework.worth import SHOWN, conditioning, judged_wrong, visibility, worthy

RENDERED = 1  #: variants whose sheets are rendered in every format and language
NONSENSICAL = 20  #: variants that are answered by nonsense; it is read alike on all
NONSENSE = ("?", "je ne sais pas", "12 +", "nan", "9**9**9", "1 = 1 = 1", "__import__('os')", "((((")
EXTREMES = ("0", "1e308", "-1e308", "1e-320")  #: coordinates too


def check(exercise: CourseExercise, variants: int, *, rendered: int = RENDERED) -> Report:
    """Try every promise on the variants of seeds 0, 1, …

    Whatever breaks is reported, and the rest is tried all the same, unless no variant has an answer.
    """
    report = Report(exercise.name)
    if not check_needs(exercise, report):
        return report
    steps: Sequence[Callable[[], None]] = (
        lambda: check_texts(exercise, report),
        lambda: check_symbols(exercise, report),
        lambda: check_known(exercise, report),
        lambda: _check_variants(exercise, variants, report),
        lambda: check_rendering(exercise, rendered, report),
    )
    for step in steps:
        try:
            step()
        except CourseworkError as fault:
            report.fail(str(fault))
        except Exception as fault:  # an author's slip in a function of the course; the check goes on
            report.fail(f"{type(fault).__name__}: {fault}")
    return report


def check_all(
    course: Course, names: Sequence[str], variants: int, progress: Callable[[], None] = lambda: None
) -> list[Report]:
    """A report an exercise, in this order, made by as many processes as there are processors."""
    count = workers(len(names))
    if count < 2 or variants < _WORTH_PROCESSES:
        return [_told(_check_one(str(course.root), name, variants), progress) for name in names]
    with processes(count) as submit:
        # The longest first, so that no process waits for another at the end.
        longest = sorted(names, key=lambda name: -_length(course, name))
        tasks = {name: submit(_check_one, str(course.root), name, variants) for name in longest}
        for task in tasks.values():
            task.add_done_callback(lambda _: progress())
        return [tasks[name].result() for name in names]


_WORTH_PROCESSES = 50  #: variants an exercise; fewer are done before a process has started


def _length(course: Course, name: str) -> int:
    """Roughly how long an exercise takes to check."""
    try:
        return len(course[name].spec.parts)
    except CourseworkError:
        return 0  # it says what is wrong when it is checked


def _told(report: Report, progress: Callable[[], None]) -> Report:
    progress()
    return report


def _check_one(root: str, name: str, variants: int) -> Report:
    try:
        return check(open_course(root)[name], variants)
    except CourseworkError as fault:
        report = Report(name)
        report.fail(str(fault))
        return report


def _check_variants(exercise: CourseExercise, count: int, report: Report) -> None:
    report.acceptance = draws.acceptance(exercise.name, exercise.spec)[0]
    lang = exercise.languages[0]
    try:
        drawn = distinct_variants(exercise, 0, count, lang, report.refused, (ALL,))
    except Starved as fault:
        if not any(told in str(fault) for told in report.failures):
            report.fail(str(fault))
        drawn = worthy(exercise, exercise.variants(range(count), lang, (ALL,)))
    report.variants = len(drawn)
    if not drawn:
        return
    _describe(drawn, report)
    check_arrays(exercise, drawn, report)
    check_rounding_students(exercise, drawn, report)
    for variant in drawn:
        key = variant.key
        check_solves(variant, key, report)
        check_right_answers(variant, key, report)
        check_mistakes(variant, key, report)
        check_slips(variant, key, report)
        check_follow_through(variant, key, report)
    for variant in drawn[:NONSENSICAL]:
        check_nonsense(variant, report)
    check_loops(drawn[0], report)
    for name in exercise.solution.mistakes:
        tally = report.mistakes.setdefault(name, Counter())
        if count >= 50 and not tally["shown"]:
            report.fail(f"mistake {name} shows in none of {len(drawn)} variants")


def _describe(drawn: Sequence[Variant], report: Report) -> None:
    """How alike the variants are in difficulty: conditioning, and the branches that are to be chosen."""
    shares = [conditioning(variant.key) for variant in drawn]
    report.conditioning = float(np.median(shares)), max(shares)
    for variant in drawn:
        given = variant.exercise.spec.given
        chosen = {n: v for n, v in variant.given.items() if given[n].is_choice}
        chosen |= {p.quantity: variant.key.reference[p.quantity] for p in variant.parts if p.kind == "choice"}
        for name, case in chosen.items():
            report.cases.setdefault(name, Counter())[str(case)] += 1


# ------------------------------------------------------------------------ texts


def check_texts(exercise: CourseExercise, report: Report) -> None:
    """Every language says every part, every case and every mistake, and nothing is written in vain."""
    for lang, path in exercise.unspoken.items():
        report.fail(
            f"{path.relative_to(exercise.course.root).as_posix()} is read by nothing: the engine speaks no {lang!r}, "
            f"whose words would be {file_of(lang)}"
        )
    for lang in languages():
        words(lang)  # a file of words that cannot be used says so here
        if lang not in exercise.languages:
            report.fail(f"no statement in {lang!r}: exercises/{exercise.name}.{lang}.md.j2 is missing")
            continue
        if exercise.course.lacks_title(lang):
            report.fail(
                f"exercises/course.toml has no title in {lang!r}: sheets would be headed "
                f"{exercise.course.title(lang)!r}; write it under [title]"
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
        told = exercise.text("solutions", lang, _every_name(exercise, variant))
        if exercise.film and not told.section("motion").text:
            report.fail(f"{told.source}: the film has no words")
        for name in exercise.solution.mistakes:
            if not told.section(f"mistake {name}").text:
                report.fail(f"{told.source}: mistake {name} is told in no words")
        report.counts["texts"] += 1


def _every_name(exercise: CourseExercise, variant: Variant) -> dict[str, object]:
    return {**dict.fromkeys(exercise.solution.graph.quantities, "0"), **variant.printed}


def check_needs(exercise: CourseExercise, report: Report) -> bool:
    """What is asked follows from what is given; False where a function needs what nothing gives."""
    try:
        exercise.plan([part.quantity for part in exercise.spec.parts], effects=exercise.spec.effects)
    except MissingQuantity as fault:
        near = nearest(fault.names[0], ({*exercise.spec.given} | exercise.quantity_names) - {*fault.names})
        report.fail(f"solutions/{exercise.name}.py: {fault.needed}{near}")
        return False
    except CourseworkError:
        pass  # it is told by what needs it
    return True


def check_symbols(exercise: CourseExercise, report: Report) -> None:
    """What is given or asked bears its symbol on the sheet too, not in the solution alone."""
    on_the_sheet = {*exercise.spec.given, *(part.quantity for part in exercise.spec.parts)}
    for name, symbol in exercise.solution.symbols.items():
        # Where the exercise has its own, another form in formulas, a fraction say, is the author's choice.
        stated = name in exercise.spec.symbols
        if name in on_the_sheet and not stated and symbol != exercise.symbol(name):
            report.fail(
                f"SYMBOLS of solutions/{exercise.name}.py names {name!r}, which is given or asked: its symbol belongs "
                f"in Exercise(symbols=…), else the sheet shows it as {exercise.symbol(name)}"
            )


# ------------------------------------------------------------------------ known


def check_known(exercise: CourseExercise, report: Report) -> None:
    """The solution gives the values known without it."""
    if not exercise.solution.known:
        report.fail("the solution states no KNOWN case; closure alone cannot tell the branch")
    for given, expected, *called in exercise.solution.known:
        effects = called[0] if called else exercise.spec.effects
        found = exercise.solve(**given, only=tuple(expected), effects=effects)
        for name, value in expected.items():
            if not agrees(found[name], value, is_angle=_is_orientation(exercise, name)):
                report.fail(f"known case {dict(given)}: {name} is {found[name]!r}, not {value!r}")
            report.counts["known values"] += 1


def _is_orientation(exercise: CourseExercise, name: str) -> bool:
    return any(p.quantity == name and p.kind == "angle" for p in exercise.spec.parts)


def agrees(found: Any, expected: Any, *, is_angle: bool = False) -> bool:
    """A printed text agrees to its last digit, a number to 1e-9 relative, a vector likewise."""
    if isinstance(found, str):
        return found == expected
    if isinstance(expected, str):
        digits = len(expected.partition(".")[2])
        allowed = 0.5 * 10.0**-digits * (1 + 1e-9)
    else:
        allowed = 1e-9 * max(1.0, float(np.max(np.abs(expected))))
    gap = np.asarray(found, dtype=float) - np.asarray(expected, dtype=float)
    if is_angle:
        gap = gap - 360.0 * np.rint(gap / 360.0)
    return bool(np.all(np.abs(gap) <= allowed))


# --------------------------------------------------------------------- solution


def check_solves(variant: Variant, key: Key, report: Report) -> None:
    """Every asked quantity is finite, and the governing equations hold."""
    for name, value in key.reference.items():
        if not exists(value):
            report.fail(f"seed {variant.seed}: {name} is {value}")
    for part in variant.parts:
        value = key.reference[part.quantity]
        if part.kind == "number" and part.has_margin and part.atol == 0 and value == 0:
            report.fail(f"seed {variant.seed}: {part.id} is 0 and has no absolute tolerance")
    graph = variant.exercise.solution.residual_graph
    values = graph.evaluate(("residual",), variant.used, variant.effects, variant.found)
    residual = values["residual"]
    for number, value in enumerate(residual if isinstance(residual, tuple) else (residual,), start=1):
        worst = abs(value) if isinstance(value, float) else float(np.max(np.abs(value)))
        report.counts["residuals"] += 1
        if not worst < RESIDUAL:
            report.fail(f"seed {variant.seed}: residual {number} is {worst:.3g}")


def check_arrays(exercise: CourseExercise, drawn: Sequence[Variant], report: Report) -> None:
    """One request on arrays gives what each variant gives alone."""
    given = {n: np.array([v.given[n] for v in drawn]) for n in exercise.spec.given}
    wanted = tuple(dict.fromkeys(p.quantity for p in exercise.spec.parts))
    together = exercise.solve(**given, only=wanted, effects=exercise.spec.effects)
    for index, variant in enumerate(drawn):
        alone = {name: plain_scalar(value) for name, value in variant.found.items()}
        for part in variant.parts:
            value = together[part.quantity]
            one = value[index] if isinstance(value, np.ndarray) and len(value) == len(drawn) else value
            if not _same(one, alone[part.quantity], part):
                report.fail(
                    f"seed {variant.seed}: {part.id} is {alone[part.quantity]} alone, {one} in an array"
                )
            report.counts["arrays"] += 1


def _same(one: Any, other: Any, part: Part) -> bool:
    if isinstance(other, str):
        return str(one) == other
    if isinstance(other, (int, float)):
        gap = one - other
        gap = math.remainder(gap, 360.0) if part.kind == "angle" else gap
        return abs(gap) <= 1e-9 * max(1.0, abs(other))
    gap = np.asarray(one, dtype=float) - np.asarray(other, dtype=float)
    return bool(np.all(np.abs(gap) <= 1e-9 * np.maximum(1.0, np.abs(other))))


# ---------------------------------------------------------------------- marking


def check_right_answers(variant: Variant, key: Key, report: Report) -> None:
    """Right answers mark right however they are written, and on the tolerance's edge."""
    for spelling in spellings(variant, key):
        marking = variant.grade(spelling)
        for part_id in spelling:
            mark = marking[part_id]
            report.counts["right answers"] += 1
            if mark.verdict != "correct":
                report.fail(
                    f"seed {variant.seed}: {part_id} = {spelling[part_id]!r} is right "
                    f"but marks {mark.verdict} (read as {mark.read_as!r})"
                )


def spellings(variant: Variant, key: Key) -> Iterator[dict[str, Any]]:
    """The right answers of a variant in the ways people write them."""
    full, printed, comma, edge = {}, {}, {}, {}
    for part in variant.parts:
        value = key.reference[part.quantity]
        if part.kind == "choice":
            full[part.id] = str(value)
            printed[part.id] = variant.label(part.id, str(value))
        elif part.kind == "equation":
            full[part.id] = str(value)
            left, _, right = str(value).partition("=")
            printed[part.id] = f"2*({right}) - 2*({left}) = 0"
        elif isinstance(value, np.ndarray):
            full[part.id] = "; ".join(repr(v) for v in value.tolist())
            printed[part.id] = "(" + " ; ".join(significant(v, 6) for v in value.tolist()) + ")"
            comma[part.id] = printed[part.id].replace(".", ",")
        else:
            unit = "" if part.unit == "1" else f" {part.unit}"
            full[part.id] = value
            printed[part.id] = significant(value, 4 if part.kind != "integer" else 9) + unit
            comma[part.id] = printed[part.id].replace(".", ",")
            if not part.has_margin:
                continue
            if part.kind == "number":
                edge[part.id] = plain(value + part.half_width(value))
            elif part.kind == "angle":
                edge[part.id] = plain(value + 360.0 - part.half_width(value))
    comma = {i: text for i, text in comma.items() if text != printed[i]}
    # Parts that are judged together stand on a sheet together.
    beside = {part.id: printed[part.id] for part in variant.parts if part.judge}
    if not beside.keys().isdisjoint(comma):
        comma = beside | comma
    yield from filter(None, (full, printed, comma, edge))


def check_rounding_students(
    exercise: CourseExercise, drawn: Sequence[Variant], report: Report, digits: Sequence[int] = KEPT_DIGITS
) -> None:
    """Who does everything right and rounds at every step is right, by rules that expect so many digits."""
    given = {
        n: np.array([v.given[n] for v in drawn]) for n in exercise.spec.given if n in exercise.quantity_names
    }
    effects, graph = exercise.spec.effects, exercise.solution.graph
    wanted = tuple(dict.fromkeys(p.quantity for p in exercise.spec.parts if not p.is_exact))
    for kept in digits if wanted else ():
        found = student_who_rounds(graph, wanted, given, effects, kept)
        widths = envelopes(exercise, wanted, given, effects, min(kept, exercise.course.rules.digits))
        for index, variant in enumerate(drawn):
            if kept >= exercise.course.rules.digits:
                own_answers = {q: _at(v, index, len(drawn)) for q, v in found.items()}
                _check_rounded_together(variant, own_answers, report)
            for part in variant.parts:
                if not part.has_margin:
                    continue
                own, width = (_at(c[part.quantity], index, len(drawn)) for c in (found, widths))
                along = variant.key.reference.get(part.along)
                gap = distance(part, own, variant.key.reference[part.quantity], along, float(width))
                report.counts[f"rounding to {kept}"] += 1
                report.counts[f"outside the usual margin at {kept}"] += bool(
                    distance(part, own, variant.key.reference[part.quantity], along) > 1
                )
                if not gap <= 1:
                    report.fail(
                        f"seed {variant.seed}: who rounds each step to {kept} digits lands {gap:.3g} half-widths "
                        f"from {part.id}"
                    )


def _check_rounded_together(variant: Variant, own: Mapping[str, Any], report: Report) -> None:
    """The same for parts that are judged together, whose margin does not follow the rounding."""
    parts = {part.id: part for part in variant.parts}
    for name, ids in judges_of(variant):
        answers = {i: own.get(parts[i].quantity, variant.key.reference[parts[i].quantity]) for i in ids}
        for i, verdict in judged(variant, name, answers).items():
            report.counts["rounded, judged together"] += 1
            if verdict.share != 1:
                report.fail(f"seed {variant.seed}: {name} refuses {i} of who rounds each step")


def _at(column: Any, index: int, count: int) -> Any:
    varies = isinstance(column, np.ndarray) and column.ndim and column.shape[0] == count
    return column[index] if varies else column


def check_mistakes(variant: Variant, key: Key, report: Report) -> None:
    """Each named mistake that shows is marked as that mistake, and never as right.

    Mistakes that show on different parts stand on one sheet, unless parts may be exchanged.
    """
    sheets: list[dict[str, tuple[str, Any]]] = []
    apart = bool(variant.exercise.spec.either_order)
    for name in key.solution.mistakes:
        tally = report.mistakes.setdefault(name, Counter())
        shown = {}
        for part, seen in visibility(key, name):
            tally[seen] += 1
            if seen == "shown":
                shown[part.id] = (name, _written(key.wrong[name][part.quantity]))
        # What stands beside the shown answers where they are judged as a group.
        beside = {i: ("", _written(v)) for _, answers in judged_wrong(key, name) for i, v in answers.items()}
        sheet = next((s for s in sheets if not (apart or beside) and s.keys().isdisjoint(shown)), None)
        if sheet is None:
            sheets.append({**beside, **shown})
        else:
            sheet |= shown
    for sheet in sheets:
        _check_recognised(variant, sheet, report)


def check_slips(variant: Variant, key: Key, report: Report) -> None:
    """A slip that shows is recognised, and earns nothing that a right answer does.

    The first slip of every part on one sheet, then the second of every part, and so on.
    """
    shown: list[dict[str, tuple[str, Any]]] = []
    for part in variant.parts:
        reference, width = key.reference[part.quantity], key.envelope.get(part.quantity, 0.0)
        slips = [s for s in key.slips(part) if distance(part, s[1], reference, None, width) > SHOWN]
        for place, slip in enumerate(slips):
            shown += [{}] * (place + 1 - len(shown))
            shown[place] = {**shown[place], part.id: slip}
    for sheet in shown:
        marking = variant.grade({part_id: value for part_id, (_, value) in sheet.items()})
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


def check_follow_through(variant: Variant, key: Key, report: Report) -> None:
    """Who errs once, much or little, and goes on rightly is marked wrong once."""
    parts = [p for p in variant.parts if p.kind in FOLLOWED and not p.judge]
    half = parts[variant.seed % 2 :: 2] or parts  # the other half on the next variant
    for first, wrong in ((part, value) for part in half for value in _little_and_much(part, key)):
        answers, expected, own = {first.id: wrong}, {}, {first.quantity: wrong}
        for part in parts[parts.index(first) + 1 :]:
            follows = key.followed(part, own, (first.quantity,))
            if follows is not None:
                answers[part.id] = expected[part.id] = own[part.quantity] = follows
        marking = variant.grade(answers)
        for part_id in expected:
            report.counts["follow-through"] += 1
            if (mark := marking[part_id]).verdict not in ("correct", "follow_through"):
                report.fail(
                    f"seed {variant.seed}: {part_id} follows from a wrong {first.id} but marks {mark.verdict}"
                )
        _check_follows_together(variant, key, first, wrong, report)


def _little_and_much(part: Part, key: Key) -> tuple[Any, ...]:
    """Wrong answers just beyond what is accepted, and far from it; of cases and counts, another one."""
    value = key.reference[part.quantity]
    if part.kind == "choice":
        return tuple(c for c in part.choices if c != value)[:1]
    if part.kind == "integer":
        return (value + 1,)
    much = value + 11.0 if part.unit == "deg" else 1.13 * value
    return value + 1.3 * key.half_width(part), much


def _check_follows_together(variant: Variant, key: Key, first: Part, wrong: Any, report: Report) -> None:
    """The same for parts that are judged together."""
    parts = {part.id: part for part in variant.parts}
    own = {first.quantity: wrong}
    for name, ids in judges_of(variant):
        follows = {i: key.followed(parts[i], own, own) for i in ids}
        if None in follows.values() or any(
            v.share != 1 for v in judged(variant, name, follows, own).values()
        ):
            continue  # what is asked cannot be had from there
        marking = variant.grade({first.id: wrong, **follows})
        report.counts["follow-through"] += len(ids)
        for i in ids:
            if marking[i].verdict not in ("correct", "follow_through"):
                report.fail(
                    f"seed {variant.seed}: {i} follows from a wrong {first.id} but marks {marking[i].verdict}"
                )


def _written(value: Any) -> Any:
    """A value as a student may write it: a vector by its coordinates."""
    return "; ".join(map(repr, value.tolist())) if isinstance(value, np.ndarray) else value


def _check_recognised(variant: Variant, sheet: Mapping[str, tuple[str, Any]], report: Report) -> None:
    """A sheet of mistakes by part: the name of each, if any, and the answer that it gives."""
    marking = variant.grade({part_id: answer for part_id, (_, answer) in sheet.items()})
    for part_id, (name, answer) in sheet.items():
        if not name:
            continue
        mark = marking[part_id]
        report.counts["mistakes recognised"] += 1
        if name not in mark.mistakes:
            report.fail(
                f"seed {variant.seed}: mistake {name} on {part_id} ({answer!r}) marks {mark.verdict}, "
                f"not mistake:{name}"
            )


def check_nonsense(variant: Variant, report: Report) -> None:
    """Nonsense is unreadable or wrong, never right, and never stops the marking."""
    for nonsense in NONSENSE:
        marking = variant.grade(dict.fromkeys((p.id for p in variant.parts), nonsense))
        for part_id, mark in marking.items():
            report.counts["nonsense"] += 1
            if mark.points and mark.verdict == "correct":
                report.fail(f"seed {variant.seed}: {nonsense!r} marks correct on {part_id}")
    for number in EXTREMES:
        _check_extreme(variant, number, report)


def _check_extreme(variant: Variant, number: str, report: Report) -> None:
    """The same for a sheet of one absurd number, and for one such answer beside right ones to the same judge.

    Where each answer stands for itself, nought may be right.
    """
    reference = {part.id: variant.key.reference[part.quantity] for part in variant.parts}
    answers = {i: "; ".join([number] * np.size(value)) for i, value in reference.items()}
    marking = variant.grade(answers)
    report.counts["nonsense"] += len(answers)
    for _, ids in judges_of(variant):
        right = {i: _written(reference[i]) for i in ids}
        for i in ids:
            if marking[i].verdict == "correct":
                report.fail(f"seed {variant.seed}: {i} marks correct where each answer is {number}")
            variant.grade({**right, i: answers[i]})
            report.counts["nonsense"] += 1


# -------------------------------------------------------------------- rendering


def check_rendering(exercise: CourseExercise, count: int, report: Report) -> None:
    """Sheets, worked solutions and notebooks render in every language."""
    renderer = exercise.course.renderer
    for lang in exercise.languages:
        for variant in exercise.variants(range(count), lang, (ALL,)):
            handout, sheet = variant.handout(), variant.answer_sheet()
            for made in (
                renderer.pdf(handout),
                renderer.html(handout),
                renderer.notebook(handout),
                renderer.pdf(sheet),
                renderer.html(sheet),
            ):
                report.counts["sheets rendered"] += bool(made)
    if exercise.film and count:
        exercise.variant(0).animation(count=8).frames  # noqa: B018  a film that cannot be shown says so here
