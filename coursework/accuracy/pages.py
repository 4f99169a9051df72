"""Overview of a course, and report on accuracy on paper."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from coursework.accuracy.hard_places import HardPlace
from coursework.accuracy.overview import OverviewLine
from coursework.accuracy.page import charts_of, no_charts, number, told_place
from coursework.accuracy.paper import PLAIN, PaperRow, Share, total
from coursework.accuracy.subject import Subject
from coursework.accuracy.timing import Times, is_busy
from coursework.accuracy.verdicts import Words
from coursework.course.course import Course
from coursework.language.words import words
from coursework.sheets.report import Chart, Report, Section, Table

_MOST_DIGITS = 16
_HALF = 8


def overview_report(
    course: Course, lines: Sequence[OverviewLine], without: Sequence[str], lang: str
) -> Report:
    """Return the overview, a row for each exercise: digits, times, the hardest place, the check of the
    reference."""
    said = words(lang)["accuracy"]
    told = said["overview"]
    right = [line for line in lines if not line.wrong and line.quantities]
    sections = (
        Section(told["short"], _short(course, lines, without, told, lang)),
        Section(told["table"], "", (), (_digits_table(course, right, told, lang),)),
        Section(told["where"], told["where_text"], (), (_places_table(course, right, said, lang),)),
        Section(told["vouched"], told["vouched_text"], (), (_vouched_table(course, right, told, lang),)),
    )
    opening = said["overview_opening"]
    return Report(
        lang, course.folder.title(lang), said["overview_title"], "coursework accuracy", opening, sections
    )


def _short(
    course: Course, lines: Sequence[OverviewLine], without: Sequence[str], told: Words, lang: str
) -> str:
    right = [line for line in lines if not line.wrong and line.quantities]
    losing = [_titled(course, line, lang) for line in right if line.beyond > 1]
    key = "keeps_but" if losing else "keeps_all"
    found = [told[key].format(count=len(right), kept=len(right) - len(losing), others=", ".join(losing))]
    lost = [line for line in right if line.hard_textbook_failed or _digits(line.hard_textbook) <= _HALF]
    found.append(told["textbook"].format(count=len(lost)))
    wrong = [_titled(course, line, lang) for line in lines if line.wrong]
    if wrong:
        found.append(told["wrong"].format(", ".join(wrong)))
    if lacking := [
        f"{_titled(course, line, lang)} ({', '.join(line.lacking)})" for line in lines if line.lacking
    ]:
        found.append(told["lacking"].format(", ".join(lacking)))
    if is_busy(line.stable_ns for line in right if line.stable_ns):
        found.append(told["busy"])
    if without:
        found.append(told["without"].format(", ".join(course[name].title(lang) for name in without)))
    return "\n\n".join(found)


def _titled(course: Course, line: OverviewLine, lang: str) -> str:
    return course[line.exercise].title(lang)


def _digits_table(course: Course, lines: Sequence[OverviewLine], told: Words, lang: str) -> Table:
    heads = [
        told[key] for key in ("exercise", "generic", "generic_textbook", "hard", "hard_textbook", "allowed")
    ]
    heads += [told["ns"], told["ns_textbook"]]
    rows = [
        (
            _titled(course, line, lang),
            _shown(line.generic),
            _shown(line.generic_textbook),
            _shown(line.hard),
            _shown(line.hard_textbook, line.hard_textbook_failed),
            _allowed(line, told),
            _nanoseconds(line.stable_ns),
            _nanoseconds(line.textbook_ns),
        )
        for line in lines
    ]
    return Table(tuple(heads), tuple(rows), (False, *[True] * 7), told["caption"])


def _digits(error: float | None) -> int:
    """Return the number of correct digits, at most sixteen."""
    if error is None:
        return _MOST_DIGITS
    return max(0, min(_MOST_DIGITS, math.floor(-math.log10(error)))) if error > 0 else _MOST_DIGITS


def _shown(error: float | None, failed: int = 0) -> str:
    return "–" if error is None or failed else str(_digits(error))


def _allowed(line: OverviewLine, told: Words) -> str:
    if not line.places:
        return "–"
    if line.beyond <= 1:
        return str(told["yes"])
    lost = math.ceil(math.log10(line.beyond)) if math.isfinite(line.beyond) else _MOST_DIGITS
    return str(told["loses"].format(lost))


def _nanoseconds(times: Times | None) -> str:
    return "–" if times is None else number(1e9 * times.median)


def _places_table(course: Course, lines: Sequence[OverviewLine], said: Words, lang: str) -> Table:
    told = said["overview"]
    rows = []
    for line in lines:
        if line.place is not None:
            subject = Subject(course[line.exercise])
            place = HardPlace(scale=1.0, **line.place)
            rows.append((_titled(course, line, lang), told_place(subject, place, said, lang)))
    return Table((told["exercise"], told["place"]), tuple(rows), (False, False))


def _vouched_table(course: Course, lines: Sequence[OverviewLine], told: Words, lang: str) -> Table:
    rows = [
        (
            _titled(course, line, lang),
            told["none"] if line.lack is None else number(line.lack),
            "" if line.lack is None else told["doubles" if line.in_doubles else "many"],
            f"{line.vouched} / {line.quantities}",
        )
        for line in lines
    ]
    heads = tuple(told[key] for key in ("exercise", "lack", "digits", "held"))
    return Table(heads, tuple(rows), (False, True, False, True))


# --------------------------------------------------------------------------- paper


def paper_report(course: Course, rows: Sequence[PaperRow], variants: int, lang: str) -> Report:
    """Return the one-page report that justifies the number of digits and the margin."""
    said = words(lang)["accuracy"]
    told = said["paper"]
    digits = course.folder.rules.digits
    whole = total(rows)
    sections = (
        Section(told["short"], _paper_words(whole, digits, told), _paper_charts(whole, said)),
        Section(told["table"], "", (), (_paper_table(whole, told),)),
        Section(
            told["by_exercise"],
            told["by_exercise_text"].format(digits=digits),
            (),
            (_by_exercise(course, rows, digits, told, lang),),
        ),
    )
    opening = told["opening"].format(variants=variants) + no_charts(said)
    return Report(
        lang, course.folder.title(lang), said["paper_title"], "coursework accuracy --paper", opening, sections
    )


def _paper_words(rows: Sequence[PaperRow], digits: int, told: Words) -> str:
    by_digits = {row.digits: row for row in rows}
    found = []
    if own := by_digits.get(digits):
        plain = by_digits[PLAIN]
        found += [
            told["kept"].format(digits=digits, plain=_percent(own.wronged, told), ours=_percent(own.wronged_ours, told)),
            told["passes"].format(
                mistakes=_percent(own.mistakes, told), neighbours=_percent(own.neighbours, told),
                plain_mistakes=_percent(plain.mistakes, told), plain_neighbours=_percent(plain.neighbours, told),
            ),
        ]  # fmt: skip
    for fewer in (digits - 1, digits - 2):
        if row := by_digits.get(fewer):
            found.append(told["fewer"].format(digits=fewer, mistakes=_percent(row.mistakes, told)))
    return " ".join(found)


def _percent(share: Share, told: Words) -> str:
    if not share.found:
        return str(told["none_of"])
    value = 100 * share.value
    return str(told["few"]) if value < 0.1 else str(told["percent"].format(number(value)))


def _paper_charts(rows: Sequence[PaperRow], said: Words) -> tuple[Chart, ...]:
    told = said["paper"]
    series: dict[str, tuple[list[float], list[float]]] = {}
    for name in ("wronged", "wronged_ours", "mistakes", "neighbours"):
        shares = [(row.digits, 100 * getattr(row, name).value) for row in rows if row.digits != PLAIN]
        kept = [(float(digits), share) for digits, share in shares if share > 0]
        if kept:
            series[told[name]] = [d for d, _ in kept], [s for _, s in kept]
    return charts_of(
        series, told["chart"], told["axis_digits"], {**said, "error": told["axis_share"]}, digits=True
    )


def _paper_table(rows: Sequence[PaperRow], told: Words) -> Table:
    heads = tuple(told[key] for key in ("digits", "wronged", "wronged_ours", "mistakes", "neighbours"))
    return Table(heads, tuple(_paper_line(_kept(row, told), row, told) for row in rows), (False, *[True] * 4))


def _kept(row: PaperRow, told: Words) -> str:
    return str(told["plain"]) if row.digits == PLAIN else str(row.digits)


def _paper_line(first: str, row: PaperRow, told: Words) -> tuple[str, ...]:
    wronged: Sequence[Any] = ("", "")
    if row.digits != PLAIN:
        wronged = _percent(row.wronged, told), _percent(row.wronged_ours, told)
    return (first, *wronged, _percent(row.mistakes, told), _percent(row.neighbours, told))


def _by_exercise(course: Course, rows: Sequence[PaperRow], digits: int, told: Words, lang: str) -> Table:
    """Return a row for each exercise: errors of a plain margin at each number of digits, then of the course's
    margin."""
    kept = [d for d in dict.fromkeys(row.digits for row in rows) if d != PLAIN]
    heads = (
        told["exercise"],
        *map(str, kept),
        *(told[k] for k in ("ours_short", "mistakes_short", "neighbours_short")),
    )
    lines = []
    for name in dict.fromkeys(row.exercise for row in rows):
        own = {row.digits: row for row in rows if row.exercise == name}
        shares = [own[d].wronged for d in kept]
        shares += (
            [own[digits].wronged_ours, own[digits].mistakes, own[digits].neighbours] if digits in own else []
        )
        cells = (_percent(share, told) if share.found else "–" for share in shares)
        lines.append((course[name].title(lang), *cells))
    return Table(heads, tuple(lines), (False, *[True] * (len(heads) - 1)))
