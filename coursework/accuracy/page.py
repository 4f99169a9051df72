"""Report of the measurements: charts, tables, and conclusions in words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any

from coursework.accuracy.hard_places import GROWING, HardPlace
from coursework.accuracy.measuring import DATA, GENERIC, HARD, Measurement
from coursework.accuracy.motion import FREE, RUBBING
from coursework.accuracy.subject import ACCELERATION, MOTION, OTHER, POSITION, RATE, Subject
from coursework.accuracy.verdicts import Rows, Words, cheapest, enough, halves, listed, paid_after
from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.figures.charts import scatter
from coursework.language.numbers import significant, unit_text
from coursework.language.words import words
from coursework.sheets.report import Chart, ReportContent, ReportSection, ReportTable

_LEAST = 1e-20  #: what a chart shows of an error below
_MANY_TIMES = 10
_MOTION_LIMITS = (1e-3, 1e-6)


def report(course: Course, rows: Sequence[Measurement], lang: str) -> ReportContent:
    """Return the report, a section for each exercise and kind of quantity, in the order of the rows."""
    texts = words(lang)["accuracy"]
    sections = []
    kinds = {POSITION: "positions", RATE: "rates", ACCELERATION: "accelerations", OTHER: "others"}
    for name, of_one in groupby(rows, key=lambda row: row.exercise):
        exercise_rows = list(of_one)
        title, data = course[name].title(lang), _data(Subject(course[name]), texts, lang)
        for label, key in kinds.items():
            if chosen := [row for row in exercise_rows if row.what == label]:
                sections.append(_quantities(f"{title} – {texts[key]}", chosen, data, texts, label))
                data = ""
        if chosen := [row for row in exercise_rows if row.what == MOTION]:
            sections.append(_motion(f"{title} – {texts['motion']}", chosen, texts))
    return ReportContent(
        lang,
        course.folder.title(lang),
        texts["title"],
        "coursework accuracy",
        texts["opening"].format(50),
        tuple(sections),
    )


# ------------------------------------------------------------------------ sections


def _quantities(title: str, rows: Sequence[Measurement], data: str, texts: Words, sort: str) -> ReportSection:
    table = Rows(rows)
    charts: list[Chart] = []
    for point in table.places if sort in (POSITION, RATE) else ():
        charts += (_position_charts if sort == POSITION else _rate_charts)(table, point, texts)
    read = _read_rates(table, texts) if sort == RATE else _read_positions(table, texts)
    return ReportSection(title, _paragraphs([data, *read]), tuple(charts), (_table(table, texts),))


def _position_charts(rows: Rows, point: str, texts: Words) -> tuple[Chart, ...]:
    displayed = [r for r in rows.rows if r.place == point and r.max_error is not None]
    displayed = [r for r in displayed if r.family not in ("mpmath", DATA)]
    heading = texts["chart_positions"].format(texts["places"][point])
    return (
        charts_of(_series(displayed, texts, lambda row: row.median), heading, texts["time"], texts)
        if displayed
        else ()
    )


def _rate_charts(rows: Rows, point: str, texts: Words) -> tuple[Chart, ...]:
    differences = rows.answered("differences", point)
    if not differences:
        return ()
    ends = [min(map(_set, differences)), max(map(_set, differences))]
    others = [r for r in rows.rows if r.place == point and r.max_error is not None]
    # What has no step is a level line.
    levels = {
        _method(r, texts): (ends, [max(_measured(r), _LEAST)] * 2)
        for r in others
        if r.family not in ("differences", "mpmath", DATA)
    }
    heading = texts["chart_rates"].format(texts["places"][point])
    return charts_of({**_series(differences, texts, _set), **levels}, heading, texts["step"], texts)


def _motion(title: str, rows: Sequence[Measurement], texts: Words) -> ReportSection:
    charts: list[Chart] = []
    text: list[str] = []
    tables = []
    for point in (FREE, RUBBING):
        selected = [r for r in rows if r.place == point]
        if selected:
            where = texts["places"][point]
            points = _series(selected, texts, lambda row: row.median * 1e-9)
            charts += charts_of(points, texts["chart_motion"].format(where), texts["duration"], texts)
            text += _read_motion(selected, where, texts)
            tables.append(_motion_table(selected, where, texts))
    return ReportSection(title, _paragraphs(text), tuple(charts), tuple(tables))


def _motion_table(rows: Sequence[Measurement], where: str, texts: Words) -> ReportTable:
    lines = [(_method(r, texts), number(r.median * 1e-9), _spread(r), number(_measured(r))) for r in rows]
    heads = texts["method"], texts["duration_head"], texts["spread_head"], texts["error_head"].format(where)
    return ReportTable(heads, tuple(lines), (False, True, True, True), where)


def _read_motion(rows: Sequence[Measurement], where: str, texts: Words) -> list[str]:
    reading, result = texts["reading"], []
    tolerances = [r for r in rows if r.family == "integration"]
    if tolerances:
        first, last = tolerances[0], tolerances[-1]
        result.append(
            reading["motion"].format(
                loose=number(_set(first)),
                tight=number(_set(last)),
                first=number(_measured(first)),
                last=number(_measured(last)),
                place=where,
            )
        )
    for limit in _MOTION_LIMITS:
        good = [r for r in rows if _measured(r) <= limit]
        best = cheapest(good)
        key = "motion_none" if not good else "motion_alike" if best[1:] else "motion_best"
        if good and Rows(rows).is_busy:
            return [*result, reading["busy"]]
        methods = listed(best, texts, lambda r: _method(r, texts)) if best else ""
        result.append(reading[key].format(limit=number(limit), place=where, methods=methods))
    return result


def _data(subject: Subject, texts: Words, lang: str) -> str:
    """Return the description of the generic and of the hard places."""
    lines = [texts["generic_variants"]]
    if subject.driver:
        displayed = {n: v for n, v in subject.base.items() if n != subject.driver}
        lines = [texts["generic_data"].format(_values(subject, displayed, lang))]
    driven = [p for p in subject.hard if p.moved == subject.driver] or list(subject.hard)
    if driven:
        lines.append(
            texts["hard_data"].format("; ".join(place_text(subject, p, texts, lang) for p in driven[:3]))
        )
    return " ".join(lines)


def _values(subject: Subject, values: Mapping[str, Any], lang: str) -> str:
    return ", ".join(_value(subject, name, value, lang) for name, value in values.items())


def _value(subject: Subject, name: str, value: Any, lang: str) -> str:
    if isinstance(value, str):
        return value
    unit = subject.exercise.units.get(name, "1")
    return f"${subject.exercise.symbol(name, lang)} = $ {number(value, unit, lang, 6)}"


def place_text(subject: Subject, point: HardPlace, texts: Words, lang: str) -> str:
    """Describe a hard place in words: which quantities come near each other, and what vanishes there."""
    unit = subject.exercise.units.get(point.moved, "1")
    tuned = ""
    if point.tuned:
        tuned = texts["hard_tuned"].format(_value(subject, point.tuned, point.given[point.tuned], lang))
    if point.kind == GROWING:
        return str(texts["hard_growing"].format(symbol_of(subject.exercise, point.moved, lang)))
    return texts["hard_place"].format(
        moved=f"${subject.exercise.symbol(point.moved, lang)}$",
        value=number(point.given[point.moved], unit, lang, 6),
        tuned=tuned,
        why=texts["kinds"][point.kind].format(symbol_of(subject.exercise, point.quantity, lang)),
    )


def symbol_of(exercise: CourseExercise, name: str, lang: str) -> str:
    """Return the symbol of a quantity of the statement or of the solution alone, as inline Markdown."""
    return f"${exercise.solution_symbol(name, lang)}$"


def _paragraphs(sentences: Iterable[str]) -> str:
    return "\n\n".join(filter(None, sentences))


# ------------------------------------------------------------------------- reading


def _read_positions(rows: Rows, texts: Words) -> list[str]:
    reading, stable = texts["reading"], rows.one("stable")
    results = [" ".join(enough(rows, texts, lambda row: _method(row, texts), number))]
    results.append(" ".join(filter(None, (_read_hard(rows, texts), _read_data(rows, texts)))))
    newton, hard_newton = rows.of("newton"), rows.of("newton", HARD)
    if newton:
        errors = ", ".join(_error(r, texts) for r in newton)
        # Where two solutions meet, Newton's method halves the error and no more.
        key = "newton" if halves(hard_newton) else "newton_generic"
        hard_error = _error(hard_newton[-1], texts) if halves(hard_newton) else ""
        results.append(reading[key].format(errors=errors, hard=hard_error))
    solver, hard_solver = rows.of("fsolve"), rows.of("fsolve", HARD)
    costs_more = solver and stable and solver[0].low > _MANY_TIMES * stable.high
    if costs_more and hard_solver:
        results.append(
            reading["solver"].format(error=_error(solver[0], texts), hard=_error(hard_solver[0], texts))
        )
    tables = rows.of("table")
    if tables and stable and not rows.is_busy:
        pays = any(paid_after(row, stable) is not None for row in tables)
        results.append(reading["table_pays" if pays else "table_never"])
    if newton and rows.one("mpmath"):
        results.append(reading["digits"])
    return results


def _read_hard(rows: Rows, texts: Words) -> str:
    reading = texts["reading"]
    hard, hard_stable = rows.one("textbook", HARD), rows.one("stable", HARD)
    if hard is None or hard_stable is None:
        return ""
    failed = reading["hard_textbook_failed"].format(hard.failed, hard.n) if hard.failed else ""
    return reading["hard_textbook"].format(
        error=_error(hard, texts), failed=failed, stable=_error(hard_stable, texts)
    )


def _read_data(rows: Rows, texts: Words) -> str:
    data = rows.one(DATA, HARD)
    if data is None or not data.max_error:
        return ""
    reading = texts["reading"]
    return str(reading["data_all"] if data.max_error >= 1 else reading["data"].format(number(data.max_error)))


def _read_rates(rows: Rows, texts: Words) -> list[str]:
    reading = texts["reading"]
    stable, complex_step = rows.one("stable"), rows.one("complex_step")
    results = [" ".join(filter(None, (_read_hard(rows, texts), _read_data(rows, texts))))]
    best = min(rows.answered("differences"), key=_measured, default=None)
    if best is not None and stable is not None:
        key = "differences" if complex_step else "differences_plain"
        results.append(
            reading[key].format(
                step=number(_set(best)),
                error=_error(best, texts),
                stable=_error(stable, texts),
                complex=_error(complex_step, texts) if complex_step else "",
            )
        )
    hard, hard_stable = rows.answered("differences", HARD), rows.one("stable", HARD)
    if hard and hard_stable:
        least = min(hard, key=_measured)
        results.append(
            reading["differences_hard"].format(error=_error(least, texts), stable=_error(hard_stable, texts))
        )
    return results


# -------------------------------------------------------------------------- pieces


def _series(
    rows: Sequence[Measurement], texts: Words, across: Any
) -> dict[str, tuple[list[float], list[float]]]:
    """Return the points by family; points of one family are joined."""
    results: dict[str, tuple[list[float], list[float]]] = {}
    for row in rows:
        name = texts["series"].get(row.family) or _method(row, texts)
        x, y = results.setdefault(name, ([], []))
        x.append(across(row))
        y.append(max(_measured(row), _LEAST))
    return results


def charts_of(
    points: Mapping[str, Any], heading: str, horizontal: str, texts: Words, *, digits: bool = False
) -> tuple[Chart, ...]:
    svg = scatter(points, heading, horizontal, texts["error"], integers=digits)
    return (Chart(svg, texts["alt"].format(heading)),)


def _table(rows: Rows, texts: Words) -> ReportTable:
    """Return the table of the methods, with both kinds of places side by side."""
    by_method: dict[str, dict[str, Measurement]] = {}
    for row in rows.rows:
        by_method.setdefault(row.method, {})[row.place] = row
    has_tables = bool(rows.of("table"))
    lines = []
    for method_rows in by_method.values():
        first = method_rows.get(GENERIC)
        displayed = next(iter(method_rows.values()))
        times = ("", "") if first is None else (number(first.median), _spread(first))
        paid = (_paid(first, rows, texts),) if has_tables else ()
        errors = [_error_cell(method_rows.get(p), texts) for p in rows.places]
        lines.append((_method(displayed, texts), *times, *paid, *errors))
    heads = (
        texts["method"],
        texts["time_head"],
        texts["spread_head"],
        *([texts["paid_head"]] if has_tables else []),
        *(texts["error_head"].format(texts["places"][p]) for p in rows.places),
    )
    return ReportTable(heads, tuple(lines), (False, *[True] * (len(heads) - 1)))


def _spread(row: Measurement) -> str:
    """Return the interquartile range in percent of the median."""
    return f"{number(100 * (row.high - row.low) / row.median)}\N{NO-BREAK SPACE}%"


def _paid(row: Measurement | None, rows: Rows, texts: Words) -> str:
    if row is None or row.build_ns is None:
        return ""
    uses = paid_after(row, rows.one("stable"))
    return texts["never_paid"] if uses is None else texts["paid"].format(number(uses))


def _set(row: Measurement) -> float:
    """Return the setting of a method that has one."""
    assert row.setting is not None
    return row.setting


def _measured(row: Measurement) -> float:
    """Return the error of a method that has answers."""
    assert row.max_error is not None
    return row.max_error


def _error_cell(row: Measurement | None, texts: Words) -> str:
    if row is None:
        return ""
    if row.family == DATA:
        return number(min(_measured(row), 1.0))  # more than the whole is the whole
    failed = texts["failed"].format(row.failed, row.n) if row.failed and row.max_error is not None else ""
    return ", ".join(filter(None, (_error(row, texts), failed)))


def _error(row: Measurement, texts: Words) -> str:
    return texts["none"] if row.max_error is None else number(row.max_error)


def _method(row: Measurement, texts: Words) -> str:
    return texts["methods"][row.family].format("" if row.setting is None else _setting(row.setting))


def _setting(value: float) -> str:
    """Format a setting as plain text, in charts too; powers of ten by their exponent."""
    if value >= 1:
        return f"{value:g}"
    exponent = round(-math.log10(value))
    return "10⁻" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(d)] for d in str(exponent))


def number(value: float, unit: str = "1", lang: str = "en", digits: int = 2) -> str:
    """Format a number of these pages as inline Markdown."""
    displayed = unit_text(unit, lang)
    space = "" if displayed in ("", "°") else "\N{NO-BREAK SPACE}"
    if 10 <= value < 1e4 and digits == 2:
        return rf"$\num{{{round(value):d}}}$"
    if value >= 1e4 and digits == 2:
        return rf"$\num{{{value:.1e}}}$".replace("e+0", "e").replace("e+", "e")
    return rf"$\num{{{significant(value, digits)}}}${space}{displayed}"
