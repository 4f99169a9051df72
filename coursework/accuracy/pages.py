"""Overview of a course, and report on accuracy on paper."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from coursework.accuracy.hard_places import HardPlace
from coursework.accuracy.overview import OverviewLine
from coursework.accuracy.page import charts_of, number, place_text, symbol_of
from coursework.accuracy.paper import PLAIN, PaperRow, Share, total
from coursework.accuracy.subject import Subject
from coursework.accuracy.timing import Times, is_busy
from coursework.accuracy.verdicts import Words
from coursework.course.course import Course
from coursework.language.words import words
from coursework.sheets.report import Chart, ReportContent, ReportSection, ReportTable

_MOST_DIGITS = 16
_HALF = 8


def overview_report(
    course: Course, lines: Sequence[OverviewLine], without: Sequence[str], lang: str
) -> ReportContent:
    """Return the overview, a row for each exercise: digits, times, the hardest place, the check of the
    reference."""
    texts = words(lang)["accuracy"]
    text = texts["overview"]
    right = [line for line in lines if not line.wrong and line.quantities]
    sections = (
        ReportSection(text["short"], _short(course, lines, without, text, lang)),
        ReportSection(text["table"], "", (), (_digits_table(course, right, text, lang),)),
        ReportSection(text["where"], text["where_text"], (), (_places_table(course, right, texts, lang),)),
        ReportSection(
            text["vouched"], text["vouched_text"], (), (_vouched_table(course, right, text, lang),)
        ),
    )
    opening = texts["overview_opening"]
    return ReportContent(
        lang, course.folder.title(lang), texts["overview_title"], "coursework accuracy", opening, sections
    )


def _short(
    course: Course, lines: Sequence[OverviewLine], without: Sequence[str], texts: Words, lang: str
) -> str:
    right = [line for line in lines if not line.wrong and line.quantities]
    losing = [_titled(course, line, lang) for line in right if line.asked_losing]
    key = "keeps_but" if losing else "keeps_all"
    results = [texts[key].format(count=len(right), kept=len(right) - len(losing), others=", ".join(losing))]
    lost = [line for line in right if line.hard_textbook_failed or _digits(line.hard_textbook) <= _HALF]
    results.append(texts["textbook"].format(count=len(lost)))
    wrong = [_titled(course, line, lang) for line in lines if line.wrong]
    if wrong:
        results.append(texts["wrong"].format(", ".join(wrong)))
    if lacking := [
        f"{_titled(course, line, lang)} ({', '.join(line.lacking)})" for line in lines if line.lacking
    ]:
        results.append(texts["lacking"].format(", ".join(lacking)))
    if is_busy(line.stable_ns for line in right if line.stable_ns):
        results.append(texts["busy"])
    if without:
        results.append(texts["without"].format(", ".join(course[name].title(lang) for name in without)))
    return "\n\n".join(results)


def _titled(course: Course, line: OverviewLine, lang: str) -> str:
    return course[line.exercise].title(lang)


def _digits_table(course: Course, lines: Sequence[OverviewLine], texts: Words, lang: str) -> ReportTable:
    heads = [
        texts[key] for key in ("exercise", "generic", "generic_textbook", "hard", "hard_textbook", "allowed")
    ]
    heads += [texts["ns"], texts["ns_textbook"]]
    rows = [
        (
            _titled(course, line, lang),
            _displayed(line.generic),
            _displayed(line.generic_textbook),
            _displayed(line.hard),
            _displayed(line.hard_textbook, line.hard_textbook_failed),
            _allowed(course, line, texts, lang),
            _nanoseconds(line.stable_ns),
            _nanoseconds(line.textbook_ns),
        )
        for line in lines
    ]
    return ReportTable(tuple(heads), tuple(rows), (False, *[True] * 7), texts["caption"])


def _digits(error: float | None) -> int:
    """Return the number of correct digits, at most sixteen."""
    if error is None:
        return _MOST_DIGITS
    return max(0, min(_MOST_DIGITS, math.floor(-math.log10(error)))) if error > 0 else _MOST_DIGITS


def _displayed(error: float | None, failed: int = 0) -> str:
    return "–" if error is None or failed else str(_digits(error))


def _allowed(course: Course, line: OverviewLine, texts: Words, lang: str) -> str:
    """Return whether all digits are kept, and otherwise by which quantity they are lost, asked or not."""
    if not line.places:
        return "–"
    if line.beyond <= 1:
        return str(texts["yes"])
    lost = math.ceil(math.log10(line.beyond)) if math.isfinite(line.beyond) else _MOST_DIGITS
    exercise = course[line.exercise]
    names = line.asked_losing or tuple(line.losing)
    key = "loses" if line.asked_losing else "loses_unasked"
    return str(texts[key].format(lost, ", ".join(symbol_of(exercise, name, lang) for name in names)))


def _nanoseconds(times: Times | None) -> str:
    return "–" if times is None else number(1e9 * times.median)


def _places_table(course: Course, lines: Sequence[OverviewLine], texts: Words, lang: str) -> ReportTable:
    text = texts["overview"]
    rows = []
    for line in lines:
        if line.place is not None:
            subject = Subject(course[line.exercise])
            point = HardPlace(scale=1.0, **line.place)
            rows.append((_titled(course, line, lang), place_text(subject, point, texts, lang)))
    return ReportTable((text["exercise"], text["place"]), tuple(rows), (False, False))


def _vouched_table(course: Course, lines: Sequence[OverviewLine], texts: Words, lang: str) -> ReportTable:
    rows = [
        (
            _titled(course, line, lang),
            texts["none"] if line.lack is None else number(line.lack),
            "" if line.lack is None else texts["doubles" if line.in_doubles else "many"],
            f"{line.vouched} / {line.quantities}",
        )
        for line in lines
    ]
    heads = tuple(texts[key] for key in ("exercise", "lack", "digits", "held"))
    return ReportTable(heads, tuple(rows), (False, True, False, True))


# --------------------------------------------------------------------------- paper


def paper_report(course: Course, rows: Sequence[PaperRow], variants: int, lang: str) -> ReportContent:
    """Return the one-page report that justifies the number of digits and the margin."""
    texts = words(lang)["accuracy"]
    text = texts["paper"]
    digits = course.folder.rules.digits
    full = total(rows)
    sections = (
        ReportSection(text["short"], _paper_words(full, digits, text), _paper_charts(full, texts)),
        ReportSection(text["table"], "", (), (_paper_table(full, text),)),
        ReportSection(
            text["by_exercise"],
            text["by_exercise_text"].format(digits=digits),
            (),
            (_by_exercise(course, rows, digits, text, lang),),
        ),
    )
    opening = text["opening"].format(variants=variants)
    return ReportContent(
        lang,
        course.folder.title(lang),
        texts["paper_title"],
        "coursework accuracy --paper",
        opening,
        sections,
    )


def _paper_words(rows: Sequence[PaperRow], digits: int, texts: Words) -> str:
    by_digits = {row.digits: row for row in rows}
    results = []
    if share := by_digits.get(digits):
        plain = by_digits[PLAIN]
        results += [
            texts["kept"].format(
                digits=digits, plain=_percent(share.wronged, texts), ours=_percent(share.wronged_ours, texts)
            ),
            texts["passes"].format(
                mistakes=_percent(share.mistakes, texts),
                neighbours=_percent(share.neighbours, texts),
                plain_mistakes=_percent(plain.mistakes, texts),
                plain_neighbours=_percent(plain.neighbours, texts),
            ),
        ]
    for fewer in (digits - 1, digits - 2):
        if row := by_digits.get(fewer):
            results.append(texts["fewer"].format(digits=fewer, mistakes=_percent(row.mistakes, texts)))
    return " ".join(results)


def _percent(share: Share, texts: Words) -> str:
    if not share.found:
        return str(texts["none_of"])
    value = 100 * share.value
    return str(texts["few"]) if value < 0.1 else str(texts["percent"].format(number(value)))


def _paper_charts(rows: Sequence[PaperRow], texts: Words) -> tuple[Chart, ...]:
    text = texts["paper"]
    series: dict[str, tuple[list[float], list[float]]] = {}
    for name in ("wronged", "wronged_ours", "mistakes", "neighbours"):
        shares = [(row.digits, 100 * getattr(row, name).value) for row in rows if row.digits != PLAIN]
        retained = [(float(digits), share) for digits, share in shares if share > 0]
        if retained:
            series[text[name]] = [d for d, _ in retained], [s for _, s in retained]
    return charts_of(
        series, text["chart"], text["axis_digits"], {**texts, "error": text["axis_share"]}, digits=True
    )


def _paper_table(rows: Sequence[PaperRow], texts: Words) -> ReportTable:
    heads = tuple(texts[key] for key in ("digits", "wronged", "wronged_ours", "mistakes", "neighbours"))
    return ReportTable(
        heads, tuple(_paper_line(_digits_kept(row, texts), row, texts) for row in rows), (False, *[True] * 4)
    )


def _digits_kept(row: PaperRow, texts: Words) -> str:
    return str(texts["plain"]) if row.digits == PLAIN else str(row.digits)


def _paper_line(first: str, row: PaperRow, texts: Words) -> tuple[str, ...]:
    wronged: Sequence[Any] = ("", "")
    if row.digits != PLAIN:
        wronged = _percent(row.wronged, texts), _percent(row.wronged_ours, texts)
    return (first, *wronged, _percent(row.mistakes, texts), _percent(row.neighbours, texts))


def _by_exercise(
    course: Course, rows: Sequence[PaperRow], digits: int, texts: Words, lang: str
) -> ReportTable:
    """Return a row for each exercise: errors of a plain margin at each number of digits, then of the course's
    margin."""
    retained = [d for d in dict.fromkeys(row.digits for row in rows) if d != PLAIN]
    heads = (
        texts["exercise"],
        *map(str, retained),
        *(texts[k] for k in ("ours_short", "mistakes_short", "neighbours_short")),
    )
    lines = []
    for name in dict.fromkeys(row.exercise for row in rows):
        selected = {row.digits: row for row in rows if row.exercise == name}
        shares = [selected[d].wronged for d in retained]
        shares += (
            [selected[digits].wronged_ours, selected[digits].mistakes, selected[digits].neighbours]
            if digits in selected
            else []
        )
        cells = (_percent(share, texts) if share.found else "–" for share in shares)
        lines.append((course[name].title(lang), *cells))
    return ReportTable(heads, tuple(lines), (False, *[True] * (len(heads) - 1)))
