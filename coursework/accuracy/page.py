"""The measurements as a page: charts, tables, and what they say in plain words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby, pairwise
from typing import Any

from coursework.accuracy.measuring import GENERIC, HARD, Row, study_of
from coursework.accuracy.ways import MOTION, POSITION, RATE
from coursework.course.course import Course
from coursework.figures.charts import lacking, scatter
from coursework.language.numbers import significant, unit_text
from coursework.language.words import words
from coursework.sheets.report import Chart, Report, Section, Table

_LIMITS = (1e-3, 1e-6, 1e-12)
_LEAST = 1e-20  #: what a chart shows of an error below

Words = Mapping[str, Any]


def report(course: Course, rows: Sequence[Row], lang: str) -> Report:
    """A section an exercise and kind of quantity, in the order of the rows."""
    said = words(lang)["accuracy"]
    sections = []
    for name, of_one in groupby(rows, key=lambda row: row.exercise):
        own = list(of_one)
        title = course[name].title(lang)
        for what, section in ((POSITION, _positions), (RATE, _rates), (MOTION, _motion)):
            chosen = [row for row in own if row.what == what]
            if chosen:
                sections.append(section(course[name], title, chosen, said, lang))
    return Report(
        lang,
        course.folder.title(lang),
        said["title"],
        "coursework accuracy",
        said["opening"].format(50) + (f" {said['no_charts']}" if lacking() else ""),
        tuple(sections),
    )


# ------------------------------------------------------------------------ sections


def _positions(exercise: Any, title: str, rows: Sequence[Row], said: Words, lang: str) -> Section:
    charts: list[Chart] = []
    for place in (GENERIC, HARD):
        shown = [r for r in rows if r.place == place and r.max_error is not None and r.family != "mpmath"]
        if shown:
            points = _series(shown, said, lambda row: row.ns_per_configuration)
            heading = said["chart_positions"].format(said["places"][place])
            charts += _charts(points, heading, said["time"], said)
    text = [_data(exercise, said, lang), *_read_positions(_Rows(rows), said)]
    return Section(f"{title} – {said['positions']}", _paragraphs(text), tuple(charts), (_table(rows, said),))


def _rates(exercise: Any, title: str, rows: Sequence[Row], said: Words, lang: str) -> Section:
    charts: list[Chart] = []
    for place in (GENERIC, HARD):
        shown = [r for r in rows if r.place == place and r.max_error is not None]
        steps = [_set(r) for r in shown if r.family == "differences"]
        if steps:
            # What has no step is a level line.
            levels = {
                _method(r, said): ([min(steps), max(steps)], [max(_measured(r), _LEAST)] * 2)
                for r in shown
                if r.family != "differences"
            }
            vee = _series([r for r in shown if r.family == "differences"], said, _set)
            heading = said["chart_rates"].format(said["places"][place])
            charts += _charts({**vee, **levels}, heading, said["step"], said)
    return Section(
        f"{title} – {said['rates']}",
        _paragraphs(_read_rates(_Rows(rows), said)),
        tuple(charts),
        (_table(rows, said),),
    )


def _motion(exercise: Any, title: str, rows: Sequence[Row], said: Words, lang: str) -> Section:
    points = _series(rows, said, lambda row: row.ns_per_configuration * 1e-9)
    charts = _charts(points, said["chart_motion"], said["duration"], said)
    first, last = rows[0], rows[-1]
    text = said["reading"]["motion"].format(
        loose=_number(_set(first)),
        tight=_number(_set(last)),
        ratio=_number(last.ns_per_configuration / first.ns_per_configuration),
        first=_number(_measured(first)),
        last=_number(_measured(last)),
    )
    table = Table(
        (said["tolerance"], said["duration"], said["error"]),
        tuple(
            (_number(_set(r)), _number(r.ns_per_configuration * 1e-9), _number(_measured(r))) for r in rows
        ),
        (True, True, True),
    )
    return Section(f"{title} – {said['motion']}", text, charts, (table,))


def _data(exercise: Any, said: Words, lang: str) -> str:
    """The data of both kinds of places."""
    study = study_of(exercise)
    assert study is not None  # it was measured

    def listed(values: Mapping[str, Any]) -> str:
        shown = []
        for name, value in values.items():
            unit = exercise.units.get(name, "1")
            if isinstance(value, str):
                shown.append(value)
            elif isinstance(value, (list, tuple)):
                low, high = (_number(v, unit, lang, 4) for v in (min(value), max(value)))
                shown.append(f"${exercise.symbol(name)}$ {low} … {high}")
            else:
                shown.append(f"${exercise.symbol(name)} = $ {_number(value, unit, lang, 9)}")
        return ", ".join(shown)

    lines = [said["generic_data"].format(listed(study.given))]
    if study.hard:
        lines.append(said["hard_data"].format(listed(study.hard)))
    return " ".join(lines)


def _paragraphs(sentences: Iterable[str]) -> str:
    return "\n\n".join(filter(None, sentences))


# ------------------------------------------------------------------------- reading


class _Rows:
    """Rows of one kind, looked up by family, place and setting."""

    def __init__(self, rows: Sequence[Row]) -> None:
        self.rows = rows

    def of(self, family: str, place: str = GENERIC) -> list[Row]:
        found = [r for r in self.rows if r.family == family and r.place == place]
        return sorted(found, key=lambda r: (r.setting is not None, r.setting))

    def answered(self, family: str, place: str = GENERIC) -> list[Row]:
        """Those that have an answer somewhere, and so an error."""
        return [r for r in self.of(family, place) if r.max_error is not None]

    def one(self, family: str, place: str = GENERIC) -> Row | None:
        found = self.of(family, place)
        return found[0] if found else None

    def cheapest_within(self, limit: float) -> Row | None:
        good = [
            r
            for r in self.rows
            if r.place == GENERIC and not r.failed and r.max_error is not None and r.max_error <= limit
        ]
        return min(good, key=lambda r: r.ns_per_configuration, default=None)


def _read_positions(rows: _Rows, said: Words) -> list[str]:
    reading = said["reading"]
    stable, textbook = rows.one("stable"), rows.one("textbook")
    found = []
    for limit in _LIMITS:
        best = rows.cheapest_within(limit)
        if best is not None:
            time = f"{_number(best.ns_per_configuration)} ns"
            found.append(
                reading["enough"].format(limit=_number(limit), method=_method(best, said), time=time)
            )
    found = [" ".join(found)]
    hard, hard_stable = rows.one("textbook", HARD), rows.one("stable", HARD)
    if textbook and hard and hard_stable:
        failed = reading["hard_textbook_failed"].format(hard.failed, hard.n) if hard.failed else ""
        found.append(
            reading["hard_textbook"].format(
                error=_error(hard, said), failed=failed, stable=_error(hard_stable, said)
            )
        )
    newton, hard_newton = rows.of("newton"), rows.of("newton", HARD)
    if newton:
        errors = ", ".join(_error(r, said) for r in newton)
        # Where two solutions meet, Newton's method halves the error and no more.
        halves = len(hard_newton) > 1 and all(
            a.max_error and b.max_error and 0.3 < b.max_error / a.max_error < 0.7
            for a, b in pairwise(hard_newton)
        )
        key = "newton" if halves else "newton_generic"
        hard_error = _error(hard_newton[-1], said) if halves else ""
        found.append(reading[key].format(errors=errors, hard=hard_error))
    solver, hard_solver = rows.of("fsolve"), rows.of("fsolve", HARD)
    if solver and stable and hard_solver:
        tightest, hardest = solver[0], hard_solver[0]
        found.append(
            reading["solver"].format(
                ratio=_number(tightest.ns_per_configuration / stable.ns_per_configuration),
                error=_error(tightest, said),
                hard=_error(hardest, said),
            )
        )
    many = rows.one("mpmath")
    if many and stable:
        ratio = many.ns_per_configuration / stable.ns_per_configuration
        found.append(reading["digits"].format(ratio=_number(ratio)))
    return found


def _read_rates(rows: _Rows, said: Words) -> list[str]:
    reading = said["reading"]
    stable, complex_step = rows.one("stable"), rows.one("complex_step")
    found = []
    best = min(rows.answered("differences"), key=_measured, default=None)
    if best is not None and stable is not None:
        key = "differences" if complex_step else "differences_plain"
        found.append(
            reading[key].format(
                step=_number(_set(best)),
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


def _series(rows: Sequence[Row], said: Words, across: Any) -> dict[str, tuple[list[float], list[float]]]:
    """Points by family, those of one family joined."""
    found: dict[str, tuple[list[float], list[float]]] = {}
    for row in rows:
        name = said["series"].get(row.family) or _method(row, said)
        x, y = found.setdefault(name, ([], []))
        x.append(across(row))
        y.append(max(_measured(row), _LEAST))
    return found


def _charts(points: Mapping[str, Any], heading: str, horizontal: str, said: Words) -> tuple[Chart, ...]:
    """The chart, where charts can be drawn."""
    if lacking():
        return ()
    svg = scatter(points, heading, horizontal, said["error"]).decode("utf-8")
    return (Chart(svg, said["alt"].format(heading)),)


def _table(rows: Sequence[Row], said: Words) -> Table:
    """A line a method, both kinds of places side by side."""
    by_method: dict[str, dict[str, Row]] = {}
    for row in rows:
        by_method.setdefault(row.method, {})[row.place] = row
    places = [p for p in (GENERIC, HARD) if any(row.place == p for row in rows)]
    lines = []
    for own in by_method.values():
        any_row = next(iter(own.values()))
        first = own.get(GENERIC, any_row)
        errors = [_error_cell(own.get(p), said) for p in places]
        lines.append((_method(any_row, said), _number(first.ns_per_configuration), *errors))
    heads = (
        said["method"],
        said["time_head"],
        *(said["error_head"].format(said["places"][p]) for p in places),
    )
    return Table(heads, tuple(lines), (False, *[True] * (len(heads) - 1)))


def _set(row: Row) -> float:
    """The setting of a method that has one."""
    assert row.setting is not None
    return row.setting


def _measured(row: Row) -> float:
    """The error of a method that has answers."""
    assert row.max_error is not None
    return row.max_error


def _error_cell(row: Row | None, said: Words) -> str:
    if row is None:
        return ""
    failed = said["failed"].format(row.failed, row.n) if row.failed and row.max_error is not None else ""
    return ", ".join(filter(None, (_error(row, said), failed)))


def _error(row: Row, said: Words) -> str:
    return said["none"] if row.max_error is None else _number(row.max_error)


def _method(row: Row, said: Words) -> str:
    return said["methods"][row.family].format("" if row.setting is None else _setting(row.setting))


def _setting(value: float) -> str:
    """A setting as plain text, in charts too: powers of ten by their exponent."""
    if value >= 1:
        return f"{value:g}"
    exponent = round(-math.log10(value))
    return "10⁻" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(d)] for d in str(exponent))


def _number(value: float, unit: str = "1", lang: str = "en", digits: int = 2) -> str:
    shown = unit_text(unit, lang)
    space = "" if shown in ("", "°") else "\N{NO-BREAK SPACE}"
    if 10 <= value < 1e4 and digits == 2:
        return rf"$\num{{{round(value):d}}}$"
    if value >= 1e4 and digits == 2:
        return rf"$\num{{{value:.1e}}}$".replace("e+0", "e")
    return rf"$\num{{{significant(value, digits)}}}${space}{shown}"
