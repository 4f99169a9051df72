"""Report of a class's statistics: charts, tables, and conclusions in words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from coursework.course.course import Course
from coursework.errors import WrongValue, cut_short
from coursework.figures.charts import bars, histogram
from coursework.figures.plot import written as printed
from coursework.figures.text import LabelText, joined, read
from coursework.gradebook.columns import VERDICTS
from coursework.gradebook.statistics.captions import SHORT, Names, as_it_is
from coursework.gradebook.statistics.measures import (
    BINS,
    ENOUGH,
    MISTAKE_COLUMNS,
    TO_MARK,
    WEAK,
    MistakeStatistics,
    PartStatistics,
    Statistics,
)
from coursework.issuing.questions import PaperQuestions
from coursework.language.numbers import localise, plain
from coursework.language.typography import typeset
from coursework.language.words import listed, words
from coursework.markup.markdown import to_text
from coursework.sheets.report import Chart, ReportContent, ReportSection, ReportTable

_QUOTED = 160  #: characters of a mistake's words in a sentence
_NAMED = 5  #: questions that a sentence names
_CHARTED = 12  #: mistakes in the chart
_LISTED = 12  #: mistakes in the table of an exercise
_HEADED = 160  #: characters of a chart's title, two lines of it or three
_CHART_ROWS = 16  #: bars that one chart holds

Words = Mapping[str, Any]


def sheet_order(course: Course, exercises: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Return the part ids in the order of the sheets, for those exercises that the course has."""
    return {name: tuple(p.id for p in course[name].spec.parts) for name in exercises if name in course}


def report(
    course: Course, statistics: Statistics, lang: str, questions: PaperQuestions | None = None
) -> ReportContent:
    """Return the report: conclusions, points, a section for each exercise, mistakes. Questions are numbered
    where those of the papers are given."""
    page = _StatisticsPage(course, statistics, lang, questions or PaperQuestions())
    sections = [page.short()]
    if statistics.percents.size:
        sections.append(page.points())
    sections += [page.exercise(name) for name in statistics.exercises]
    if statistics.mistakes:
        sections.append(page.mistakes())
    return ReportContent(
        lang,
        course.folder.title(lang),
        page.texts["title"],
        page.texts["source"],
        page.texts["opening"],
        tuple(sections),
    )


def mistake_rows(course: Course, statistics: Statistics, lang: str) -> Iterator[dict[str, Any]]:
    """Yield the lines of ``mistakes.csv``."""
    names = Names(course, lang)
    for item in statistics.mistakes:
        yield {c: {**item.row(), "says": names.says(item)}[c] for c in MISTAKE_COLUMNS}


class _StatisticsPage:
    """Sections of one report."""

    def __init__(self, course: Course, statistics: Statistics, lang: str, questions: PaperQuestions) -> None:
        self.course = course
        self.statistics = statistics
        self.lang = lang
        self.texts: Words = words(lang)["statistics"]
        self.verdicts: Words = words(lang)["verdicts"]
        self.names, self.questions = Names(course, lang), questions

    # ---------------------------------------------------------------- sections

    def short(self) -> ReportSection:
        wording = self.statistics
        percents = wording.percents
        rows = [
            (self.texts["students"], self._number(wording.students)),
            (self.texts["silent"], self._number(wording.silent)),
            (self.texts["unread"], self._number(wording.unread)),
            (self.texts["answers"], self._number(wording.answers)),
            (self.texts["without_line"], self._number(wording.without_line)),
            (self.verdicts["missing"], self._number(wording.counts["missing"])),
            (self.verdicts["unreadable"], self._number(wording.counts["unreadable"])),
            (self.texts["rejected"], self._number(wording.rejected)),
        ]
        if wording.counts[TO_MARK]:
            rows.append((self.texts["to_mark"], self._number(wording.counts[TO_MARK])))
        if percents.size:
            rows.append((self.texts["mean_percent"], self._percent(percents.mean() / 100)))
            rows.append((self.texts["median_percent"], self._percent(np.median(percents) / 100)))
        text = "\n".join(f"- {sentence}" for sentence in self._reading())
        table = ReportTable((self.texts["measure"], self.texts["count"]), tuple(rows), (False, True))
        return ReportSection(self.texts["short"], text, tables=(table,))

    def points(self) -> ReportSection:
        counts = self.statistics.histogram().tolist()
        edges = [round(100 * k / BINS) for k in range(BINS + 1)]
        heads = tuple(f"{a}–{b}" for a, b in pairwise(edges))
        named = (self.texts["chart_points"], self.texts["axis_points"], self.texts["axis_students"])
        table = ReportTable(heads, (tuple(self._number(c) for c in counts),), (True,) * BINS)
        return ReportSection(
            self.texts["points"],
            self.texts["points_text"],
            (self._chart(histogram(counts, edges, *named), self.texts["chart_points"]),),
            (table,),
        )

    def exercise(self, name: str) -> ReportSection:
        parts = [p for p in self.statistics.parts if p.exercise == name]
        title = self._heading(name)
        heading = self.texts["chart_right"].format(title)
        charts = tuple(
            self._chart(self._right_chart(rows, heading), heading) for rows in _shared_out(parts, _CHART_ROWS)
        )
        return ReportSection(title, "", charts, (self._part_table(parts), self._verdict_table(parts)))

    def _right_chart(self, parts: Sequence[PartStatistics], heading: str) -> str:
        rows = [(self._label(p), 100 * p.right, self._chart_text(self._percent(p.right))) for p in parts]
        return bars(rows, self._chart_text(heading), self.texts["axis_right"], full=100)

    def mistakes(self) -> ReportSection:
        wording = self.statistics
        rows = [
            (self._mistake_label(m), m.count, str(m.count))
            for m in wording.mistakes_of_exercises()[:_CHARTED]
        ]
        heading = self.texts["chart_mistakes"]
        chart = self._chart(bars(rows, self._chart_text(heading), self.texts["axis_answers"]), heading)
        tables, left_out = [], 0
        for name in wording.exercises:
            selected = [m for m in wording.mistakes if m.exercise == name]
            left_out += len(selected[_LISTED:])
            if selected:
                tables.append(self._mistake_table(name, selected[:_LISTED]))
        text = [self.texts["mistakes_text"]]
        if left_out:
            text.append(self.texts["mistakes_more"].format(left_out))
        return ReportSection(self.texts["mistakes"], " ".join(text), (chart,), tuple(tables))

    # ------------------------------------------------------------------ tables

    def _part_table(self, parts: Sequence[PartStatistics]) -> ReportTable:
        keys = ("part", "part_answers", "right", "mean", "discrimination")
        rows = tuple(
            (
                self._name_and_id(p),
                self._number(p.answers),
                self._percent(p.right),
                self._percent(p.mean),
                self._discriminates(p),
            )
            for p in parts
        )
        return ReportTable(tuple(self.texts[k] for k in keys), rows, (False, True, True, True, True))

    def _discriminates(self, part: PartStatistics) -> str:
        if part.discrimination is not None:
            return self._decimal(part.discrimination)
        return self.texts["too_few" if part.students < ENOUGH else "all_alike"]

    def _verdict_table(self, parts: Sequence[PartStatistics]) -> ReportTable:
        """Return the table of verdicts, with a column for each verdict that occurs."""
        met = [f for f in VERDICTS if any(p.counts[f] for p in parts)]
        rows = tuple(
            (self._name(p), *(self._hundredths(p.share(f)) if p.counts[f] else "" for f in met))
            for p in parts
        )
        heads = (self.texts["part"], *(self.verdicts[f] for f in met))
        return ReportTable(heads, rows, (False, *[True] * len(met)), self.texts["became"])

    def _mistake_table(self, exercise: str, mistakes: Sequence[MistakeStatistics]) -> ReportTable:
        parts = {p.part: p for p in self.statistics.parts if p.exercise == exercise}
        rows = tuple(
            (
                self._name(parts[item.part]),
                self.names.says_markdown(item) or as_it_is(self.names.says(item) or item.name),
                self._number(item.count),
                self._percent(item.share),
                self._decimal(item.lost, 1),
            )
            for item in mistakes
        )
        heads = tuple(self.texts[h] for h in ("part", "says", "part_answers", "share", "lost"))
        return ReportTable(heads, rows, (False, False, True, True, True), self._heading(exercise))

    # ----------------------------------------------------------------- reading

    def _reading(self) -> list[str]:
        if not self.statistics.answers:
            results = [self.texts["reading"]["nothing"]]
        else:
            results = [self._hardest(), self._discrimination(), self._costly()]
        return [*results, self._to_look_at()]

    def _hardest(self) -> str:
        lost = [p for p in self.statistics.parts if p.marked and p.mean < 1]
        if not lost:
            return self.texts["reading"]["all_full"]
        hardest = sorted(lost, key=lambda p: p.mean)[:3]
        displayed = [self._with(p, self._percent(p.mean)) for p in hardest]
        return self.texts["reading"]["hardest"].format(parts=listed(displayed, self.lang))

    def _discrimination(self) -> str:
        reading = self.texts["reading"]
        pairs = ((p, p.discrimination) for p in self.statistics.parts)
        measured = [(p, d) for p, d in pairs if d is not None]
        if not measured:
            return reading["unmeasured"].format(ENOUGH)
        active = self.statistics.students - self.statistics.silent - self.statistics.unread
        # The standard error of a correlation near 0.
        uncertain = reading["uncertain"].format(
            students=active, error=self._decimal(1 / math.sqrt(active - 1))
        )
        limit = self._decimal(WEAK)
        weak = sorted(((p, d) for p, d in measured if d < WEAK), key=lambda item: item[1])
        if not weak:
            return f"{reading['none_weak'].format(limit=limit)} {uncertain}"
        displayed = [self._with(p, self._decimal(d)) for p, d in weak[:_NAMED]]
        parts = listed(displayed, self.lang)
        if len(weak) > _NAMED:
            parts = ", ".join([*displayed, reading["more"].format(len(weak) - _NAMED)])
        return f"{reading['weak'].format(limit=limit, parts=parts)} {uncertain}"

    def _costly(self) -> str:
        reading = self.texts["reading"]
        costly = max(self.statistics.mistakes_of_exercises(), key=lambda m: m.lost, default=None)
        if costly is None:
            return reading["no_mistake"]
        return reading["costly"].format(
            name=f"*{as_it_is(self.names.mistake(costly, most=_QUOTED))}*",
            exercise=self._title(costly.exercise),
            count=self._number(costly.count),
            answers=self._number(round(costly.count / costly.share)),
            share=self._percent(costly.share_of_lost),
        )

    def _to_look_at(self) -> str:
        text, reading = self.statistics, self.texts["reading"]
        waiting, rest = text.counts[TO_MARK], text.needs_a_look - text.counts[TO_MARK]
        look = reading["look"].format(
            total=rest, unreadable=text.counts["unreadable"], rejected=text.rejected
        )
        result = [look] if rest else []
        result += [reading["to_mark"].format(self._number(waiting))] if waiting else []
        return " ".join(result) or reading["no_look"]

    # ------------------------------------------------------------------- names

    def _title(self, name: str) -> str:
        """Return an exercise's title as Markdown."""
        exercise = self.names.exercise(name)
        return exercise.title(self.lang) if exercise and self.lang in exercise.languages else as_it_is(name)

    def _heading(self, name: str) -> str:
        """Return an exercise's title as plain text."""
        return " ".join(to_text(self._title(name), self.lang).split())

    def _numbered(self, part: PartStatistics, name: str) -> str:
        number = self.questions.number(part.exercise, part.part)
        return f"{number} · {name}" if number else name

    def _name(self, part: PartStatistics) -> str:
        symbol = self.names.symbol(part)
        return self._numbered(part, f"${symbol}$" if symbol else self.names.question_markdown(part))

    def _name_and_id(self, part: PartStatistics) -> str:
        """Return the name of a part with its id, for the table in which authors look parts up."""
        name, names = self._name(part), as_it_is(part.part)
        return name if name == names else f"{name} ({names})"

    def _with(self, part: PartStatistics, value: str) -> str:
        """Return a part and its value, for a sentence about the class."""
        several = len(self.statistics.exercises) > 1
        note = f"{self._title(part.exercise)}, {value}" if several else value
        return f"{self._name(part)} ({note})"

    def _label(self, part: PartStatistics) -> LabelText:
        """Return the label of a part in a chart: its number, and its symbol where a figure can have it."""
        number = self._numbered(part, "")
        try:
            if symbol := self.names.symbol(part):
                return joined(printed(number), read(symbol)) if number else read(symbol)
        except WrongValue:
            return printed(number + _short(part.part))
        return printed(number + _short(self.names.question(part), SHORT))

    def _mistake_label(self, item: MistakeStatistics) -> str:
        several = len(self.statistics.exercises) > 1
        name = _short(self.names.mistake(item), SHORT)
        return f"{name} ({_short(self._heading(item.exercise), 24)})" if several else name

    # ------------------------------------------------------------------ pieces

    def _number(self, value: float) -> str:
        return localise(plain(value), self.lang)

    def _decimal(self, value: float, digits: int = 2) -> str:
        text = f"{value:.{digits}f}"
        return localise(text.removeprefix("-") if float(text) == 0 else text, self.lang)

    def _hundredths(self, share: float) -> str:
        """Format a share in percent as a bare number; a share strictly between 0 and 1 never shows as 0 or
        100."""
        value = round(100 * float(share), 9)
        rounded = min(max(round(value), 1), 99) if 0 < value < 100 else round(value)
        return localise(str(rounded), self.lang)

    def _percent(self, share: float) -> str:
        return self.texts["percent"].format(self._hundredths(share))

    def _chart_text(self, text: str) -> str:
        return typeset(_short(text, _HEADED), self.lang)

    def _chart(self, svg: str, heading: str) -> Chart:
        return Chart(svg, self.texts["alt"].format(heading))


def _shared_out(rows: Sequence[PartStatistics], most: int) -> list[Sequence[PartStatistics]]:
    """Split the rows into as few runs as hold them, of about equal length."""
    runs = -(-len(rows) // most)
    size = -(-len(rows) // runs)
    return [rows[start : start + size] for start in range(0, len(rows), size)]


def _short(name: str, most: int = 40) -> str:
    """Shorten a name from a file to one line of a chart."""
    return cut_short(" ".join(name.split()), most)
