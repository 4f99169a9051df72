"""Report of the measurements: charts, tables, and conclusions in words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any

from coursework.accuracy.hard_places import HardPlace
from coursework.accuracy.measuring import DATA, GENERIC, HARD, Measurement
from coursework.accuracy.motion import FREE, RUBBING
from coursework.accuracy.subject import ACCELERATION, MOTION, OTHER, POSITION, RATE, Subject
from coursework.accuracy.verdicts import Rows, Words, cheapest, enough, halves, listed, paid_after
from coursework.course.course import Course
from coursework.figures.charts import lacking, scatter
from coursework.language.numbers import significant, unit_text
from coursework.language.words import words
from coursework.sheets.report import Chart, Report, Section, Table

_LEAST = 1e-20  #: what a chart shows of an error below
_MANY_TIMES = 10
_MOTION_LIMITS = (1e-3, 1e-6)


def report(course: Course, rows: Sequence[Measurement], lang: str) -> Report:
    """Return the report, a section for each exercise and kind of quantity, in the order of the rows."""
    said = words(lang)["accuracy"]
    sections = []
    kinds = {POSITION: "positions", RATE: "rates", ACCELERATION: "accelerations", OTHER: "others"}
    for name, of_one in groupby(rows, key=lambda row: row.exercise):
        own = list(of_one)
        title, data = course[name].title(lang), _data(Subject(course[name]), said, lang)
        for what, key in kinds.items():
            if chosen := [row for row in own if row.what == what]:
                sections.append(_quantities(f"{title} – {said[key]}", chosen, data, said, what))
                data = ""
        if chosen := [row for row in own if row.what == MOTION]:
            sections.append(_motion(f"{title} – {said['motion']}", chosen, said))
    return Report(
        lang,
        course.folder.title(lang),
        said["title"],
        "coursework accuracy",
        said["opening"].format(50) + no_charts(said),
        tuple(sections),
    )


def no_charts(said: Words) -> str:
    """Return the note for a report without charts."""
    return f" {said['no_charts']}" if lacking() else ""


# ------------------------------------------------------------------------ sections


def _quantities(title: str, rows: Sequence[Measurement], data: str, said: Words, what: str) -> Section:
    own = Rows(rows)
    charts: list[Chart] = []
    for place in own.places if what in (POSITION, RATE) else ():
        charts += (_position_charts if what == POSITION else _rate_charts)(own, place, said)
    read = _read_rates(own, said) if what == RATE else _read_positions(own, said)
    return Section(title, _paragraphs([data, *read]), tuple(charts), (_table(own, said),))


def _position_charts(rows: Rows, place: str, said: Words) -> tuple[Chart, ...]:
    shown = [r for r in rows.rows if r.place == place and r.max_error is not None]
    shown = [r for r in shown if r.family not in ("mpmath", DATA)]
    heading = said["chart_positions"].format(said["places"][place])
    return (
        charts_of(_series(shown, said, lambda row: row.median), heading, said["time"], said) if shown else ()
    )


def _rate_charts(rows: Rows, place: str, said: Words) -> tuple[Chart, ...]:
    differences = rows.answered("differences", place)
    if not differences:
        return ()
    ends = [min(map(_set, differences)), max(map(_set, differences))]
    others = [r for r in rows.rows if r.place == place and r.max_error is not None]
    # What has no step is a level line.
    levels = {
        _method(r, said): (ends, [max(_measured(r), _LEAST)] * 2)
        for r in others
        if r.family not in ("differences", "mpmath", DATA)
    }
    heading = said["chart_rates"].format(said["places"][place])
    return charts_of({**_series(differences, said, _set), **levels}, heading, said["step"], said)


def _motion(title: str, rows: Sequence[Measurement], said: Words) -> Section:
    charts: list[Chart] = []
    text: list[str] = []
    tables = []
    for place in (FREE, RUBBING):
        own = [r for r in rows if r.place == place]
        if own:
            where = said["places"][place]
            points = _series(own, said, lambda row: row.median * 1e-9)
            charts += charts_of(points, said["chart_motion"].format(where), said["duration"], said)
            text += _read_motion(own, where, said)
            tables.append(_motion_table(own, where, said))
    return Section(title, _paragraphs(text), tuple(charts), tuple(tables))


def _motion_table(rows: Sequence[Measurement], where: str, said: Words) -> Table:
    lines = [
        (
            _method(r, said),
            number(r.median * 1e-9),
            _spread(r),
            number(_measured(r)),
        )
        for r in rows
    ]
    heads = said["method"], said["duration_head"], said["spread_head"], said["error_head"].format(where)
    return Table(heads, tuple(lines), (False, True, True, True), where)


def _read_motion(rows: Sequence[Measurement], where: str, said: Words) -> list[str]:
    reading, found = said["reading"], []
    tolerances = [r for r in rows if r.family == "integration"]
    if tolerances:
        first, last = tolerances[0], tolerances[-1]
        found.append(
            reading["motion"].format(
                loose=number(_set(first)), tight=number(_set(last)), first=number(_measured(first)),
                last=number(_measured(last)), place=where,
            )
        )  # fmt: skip
    for limit in _MOTION_LIMITS:
        good = [r for r in rows if _measured(r) <= limit]
        best = cheapest(good)
        key = "motion_none" if not good else "motion_alike" if best[1:] else "motion_best"
        if good and Rows(rows).is_busy:
            return [*found, reading["busy"]]
        methods = listed(best, said, lambda r: _method(r, said)) if best else ""
        found.append(reading[key].format(limit=number(limit), place=where, methods=methods))
    return found


def _data(subject: Subject, said: Words, lang: str) -> str:
    """Return the description of the generic and of the hard places."""
    lines = [said["generic_variants"]]
    if subject.driver:
        shown = {n: v for n, v in subject.base.items() if n != subject.driver}
        lines = [said["generic_data"].format(_values(subject, shown, lang))]
    driven = [p for p in subject.hard if p.moved == subject.driver] or list(subject.hard)
    if driven:
        lines.append(
            said["hard_data"].format("; ".join(told_place(subject, p, said, lang) for p in driven[:3]))
        )
    return " ".join(lines)


def _values(subject: Subject, values: Mapping[str, Any], lang: str) -> str:
    return ", ".join(_value(subject, name, value, lang) for name, value in values.items())


def _value(subject: Subject, name: str, value: Any, lang: str) -> str:
    if isinstance(value, str):
        return value
    unit = subject.exercise.units.get(name, "1")
    return f"${subject.exercise.symbol(name)} = $ {number(value, unit, lang, 6)}"


def told_place(subject: Subject, place: HardPlace, said: Words, lang: str) -> str:
    """Describe a hard place in words: which quantities come near each other, and what vanishes there."""
    unit = subject.exercise.units.get(place.moved, "1")
    tuned = ""
    if place.tuned:
        tuned = said["hard_tuned"].format(_value(subject, place.tuned, place.given[place.tuned], lang))
    symbol = subject.exercise.solution.symbols.get(place.quantity) or subject.exercise.symbol(place.quantity)
    return said["hard_place"].format(
        moved=f"${subject.exercise.symbol(place.moved)}$",
        value=number(place.given[place.moved], unit, lang, 6),
        tuned=tuned,
        why=said["kinds"][place.kind].format(f"${symbol}$"),
    )


def _paragraphs(sentences: Iterable[str]) -> str:
    return "\n\n".join(filter(None, sentences))


# ------------------------------------------------------------------------- reading


def _read_positions(rows: Rows, said: Words) -> list[str]:
    reading, stable = said["reading"], rows.one("stable")
    found = [" ".join(enough(rows, said, lambda row: _method(row, said), number))]
    found.append(" ".join(filter(None, (_read_hard(rows, said), _read_data(rows, said)))))
    newton, hard_newton = rows.of("newton"), rows.of("newton", HARD)
    if newton:
        errors = ", ".join(_error(r, said) for r in newton)
        # Where two solutions meet, Newton's method halves the error and no more.
        key = "newton" if halves(hard_newton) else "newton_generic"
        hard_error = _error(hard_newton[-1], said) if halves(hard_newton) else ""
        found.append(reading[key].format(errors=errors, hard=hard_error))
    solver, hard_solver = rows.of("fsolve"), rows.of("fsolve", HARD)
    costs_more = solver and stable and solver[0].low > _MANY_TIMES * stable.high
    if costs_more and hard_solver:
        found.append(
            reading["solver"].format(error=_error(solver[0], said), hard=_error(hard_solver[0], said))
        )
    tables = rows.of("table")
    if tables and stable and not rows.is_busy:
        pays = any(paid_after(row, stable) is not None for row in tables)
        found.append(reading["table_pays" if pays else "table_never"])
    if newton and rows.one("mpmath"):
        found.append(reading["digits"])
    return found


def _read_hard(rows: Rows, said: Words) -> str:
    reading = said["reading"]
    hard, hard_stable = rows.one("textbook", HARD), rows.one("stable", HARD)
    if hard is None or hard_stable is None:
        return ""
    failed = reading["hard_textbook_failed"].format(hard.failed, hard.n) if hard.failed else ""
    return reading["hard_textbook"].format(
        error=_error(hard, said), failed=failed, stable=_error(hard_stable, said)
    )


def _read_data(rows: Rows, said: Words) -> str:
    data = rows.one(DATA, HARD)
    if data is None or not data.max_error:
        return ""
    reading = said["reading"]
    return str(reading["data_all"] if data.max_error >= 1 else reading["data"].format(number(data.max_error)))


def _read_rates(rows: Rows, said: Words) -> list[str]:
    reading = said["reading"]
    stable, complex_step = rows.one("stable"), rows.one("complex_step")
    found = [" ".join(filter(None, (_read_hard(rows, said), _read_data(rows, said))))]
    best = min(rows.answered("differences"), key=_measured, default=None)
    if best is not None and stable is not None:
        key = "differences" if complex_step else "differences_plain"
        found.append(
            reading[key].format(
                step=number(_set(best)),
                error=_error(best, said),
                stable=_error(stable, said),
                complex=_error(complex_step, said) if complex_step else "",
            )
        )
    hard, hard_stable = rows.answered("differences", HARD), rows.one("stable", HARD)
    if hard and hard_stable:
        least = min(hard, key=_measured)
        found.append(
            reading["differences_hard"].format(error=_error(least, said), stable=_error(hard_stable, said))
        )
    return found


# -------------------------------------------------------------------------- pieces


def _series(
    rows: Sequence[Measurement], said: Words, across: Any
) -> dict[str, tuple[list[float], list[float]]]:
    """Return the points by family; points of one family are joined."""
    found: dict[str, tuple[list[float], list[float]]] = {}
    for row in rows:
        name = said["series"].get(row.family) or _method(row, said)
        x, y = found.setdefault(name, ([], []))
        x.append(across(row))
        y.append(max(_measured(row), _LEAST))
    return found


def charts_of(
    points: Mapping[str, Any], heading: str, horizontal: str, said: Words, *, digits: bool = False
) -> tuple[Chart, ...]:
    """Return the chart; none where charts cannot be drawn."""
    if lacking():
        return ()
    svg = scatter(points, heading, horizontal, said["error"], whole=digits).decode("utf-8")
    return (Chart(svg, said["alt"].format(heading)),)


def _table(rows: Rows, said: Words) -> Table:
    """Return the table of the methods, with both kinds of places side by side."""
    by_method: dict[str, dict[str, Measurement]] = {}
    for row in rows.rows:
        by_method.setdefault(row.method, {})[row.place] = row
    has_tables = bool(rows.of("table"))
    lines = []
    for own in by_method.values():
        first = own.get(GENERIC)
        shown = next(iter(own.values()))
        times = ("", "") if first is None else (number(first.median), _spread(first))
        paid = (_paid(first, rows, said),) if has_tables else ()
        errors = [_error_cell(own.get(p), said) for p in rows.places]
        lines.append((_method(shown, said), *times, *paid, *errors))
    heads = (
        said["method"],
        said["time_head"],
        said["spread_head"],
        *([said["paid_head"]] if has_tables else []),
        *(said["error_head"].format(said["places"][p]) for p in rows.places),
    )
    return Table(heads, tuple(lines), (False, *[True] * (len(heads) - 1)))


def _spread(row: Measurement) -> str:
    """Return the interquartile range in percent of the median."""
    return f"{number(100 * (row.high - row.low) / row.median)}\N{NO-BREAK SPACE}%"


def _paid(row: Measurement | None, rows: Rows, said: Words) -> str:
    if row is None or row.build_ns is None:
        return ""
    uses = paid_after(row, rows.one("stable"))
    return said["never_paid"] if uses is None else said["paid"].format(number(uses))


def _set(row: Measurement) -> float:
    """Return the setting of a method that has one."""
    assert row.setting is not None
    return row.setting


def _measured(row: Measurement) -> float:
    """Return the error of a method that has answers."""
    assert row.max_error is not None
    return row.max_error


def _error_cell(row: Measurement | None, said: Words) -> str:
    if row is None:
        return ""
    if row.family == DATA:
        return number(min(_measured(row), 1.0))  # more than the whole is the whole
    failed = said["failed"].format(row.failed, row.n) if row.failed and row.max_error is not None else ""
    return ", ".join(filter(None, (_error(row, said), failed)))


def _error(row: Measurement, said: Words) -> str:
    return said["none"] if row.max_error is None else number(row.max_error)


def _method(row: Measurement, said: Words) -> str:
    return said["methods"][row.family].format("" if row.setting is None else _setting(row.setting))


def _setting(value: float) -> str:
    """Format a setting as plain text, in charts too; powers of ten by their exponent."""
    if value >= 1:
        return f"{value:g}"
    exponent = round(-math.log10(value))
    return "10⁻" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(d)] for d in str(exponent))


def number(value: float, unit: str = "1", lang: str = "en", digits: int = 2) -> str:
    """Format a number of these pages as inline Markdown."""
    shown = unit_text(unit, lang)
    space = "" if shown in ("", "°") else "\N{NO-BREAK SPACE}"
    if 10 <= value < 1e4 and digits == 2:
        return rf"$\num{{{round(value):d}}}$"
    if value >= 1e4 and digits == 2:
        return rf"$\num{{{value:.1e}}}$".replace("e+0", "e").replace("e+", "e")
    return rf"$\num{{{significant(value, digits)}}}${space}{shown}"
