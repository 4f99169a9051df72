"""Files of an assignment: one paper per student in every format, and solutions and the key for the staff."""

from __future__ import annotations

import datetime
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from coursework.issuing.answer_papers import printed_handouts
from coursework.issuing.assignment import Assignment, text_in
from coursework.issuing.exam_columns import (
    duration_text,
    extra_time_of,
    minutes_of,
    room_of,
    seat_of,
    with_extra,
)
from coursework.issuing.identity import column_called, is_same_column, printed_columns
from coursework.issuing.issuing import Issue
from coursework.issuing.students import folded
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.sheets.paper import Paper, PaperHeading, SolutionPaper

_DIGITS = 18  #: of a number by which a booklet is sorted; a longer one is sorted as a word


@dataclass(frozen=True)
class IssuedPaper:
    """Paper: the exercises of one student and sitting, in the assignment's order."""

    assignment: Assignment
    issues: tuple[Issue, ...]
    polygons: bool
    scan: str = ""  #: the size of its answer pages; empty if students answer on the paper itself

    @property
    def first(self) -> Issue:
        return self.issues[0]

    @property
    def sorted_by(self) -> tuple[tuple[tuple[int, int, str], ...], ...]:
        """Return the sort key of the paper in a booklet; papers by room are in the order of the seats."""
        if self.is_by_room:
            return natural(self.room), natural(seat_of(self.first.columns))
        columns = self.first.columns
        return (natural(columns.get(column_called(columns, self.assignment.sort), "")),)

    @property
    def is_by_room(self) -> bool:
        """Return whether each room has a booklet of its own."""
        return bool(self.assignment.sort) and is_same_column(self.assignment.sort, "room")

    @property
    def room(self) -> str:
        return room_of(self.first.columns)

    def heading(self, lang: str) -> PaperHeading:
        assignment, first = self.assignment, self.first
        mark = assignment.mark
        return PaperHeading(
            lang=lang,
            title=text_in(assignment.title, lang) or assignment.name,
            course=text_in(assignment.course, lang) or first.variant.exercise.folder.title(lang),
            student=first.shown,
            is_code=bool(first.code),
            identity=self._identity(lang),
            date=date_text(assignment.date, lang),
            duration=self.duration(lang),
            instructions=instructions_of(assignment, lang),
            version=first.version,
            logo=assignment.picture(lang),
            cover=assignment.cover,
            mark_of="" if mark is None else localise(plain(mark.of), lang),
        )

    def _identity(self, lang: str) -> tuple[tuple[str, str], ...]:
        """Return what the heading prints of the roster: room and seat, then the columns of the assignment."""
        stated, printed = () if self.first.code else self.assignment.identity, words(lang)["sheet"]["columns"]
        places = {"room": room_of(self.first.columns), "seat": seat_of(self.first.columns)}
        unstated = [
            (str(printed[name]), value)
            for name, value in places.items()
            if value and not any(is_same_column(title, name) for title in stated)
        ]
        return (*unstated, *printed_columns(stated, self.first.columns, lang))

    def usual_duration(self, lang: str) -> str:
        return text_in(self.assignment.duration, lang)

    def duration(self, lang: str) -> str:
        """Return the duration as printed: the student's own, where the roster gives extra time."""
        return own_duration(self.usual_duration(lang), self.first.columns)

    @property
    def _work_mm(self) -> tuple[int, ...]:
        """Room for the reasoning after each exercise, mm; empty if there is none."""
        asked = {exercise.name: exercise.work for exercise in self.assignment.exercises}
        own = (asked.get(issue.variant.exercise.name) for issue in self.issues)
        rooms = tuple(self.assignment.work if room is None else room for room in own)
        return rooms if any(rooms) else ()

    def paper(self, lang: str) -> Paper:
        handouts = (i.variant.in_language(lang).handout(i.shown) for i in self.issues)
        return Paper(self.heading(lang), tuple(handouts))

    def printed(self, lang: str) -> Paper:
        """Return the paper as printed in the PDF, with its answer pages if it is scanned."""
        handouts = printed_handouts(self.issues, lang, self.scan, self.assignment.name)
        return Paper(self.heading(lang), handouts, self._work_mm)

    def solution(self, lang: str) -> SolutionPaper:
        sheets = (
            i.variant.in_language(lang).answer_sheet(i.shown, polygons=self.polygons) for i in self.issues
        )
        return SolutionPaper(self.heading(lang), tuple(sheets))

    @property
    def folder(self) -> str:
        """Folder of its files among those of the build."""
        return ""

    @property
    def cells(self) -> dict[str, object]:
        """Cells of its line in the table of a booklet's pages."""
        return {"student": self.first.shown, "version": self.first.version}

    @property
    def drawing_numbers(self) -> tuple[str, ...]:
        """Ends of the names of its exercises' drawings, for LaTeX."""
        return tuple(f"-{number}" for number in range(1, len(self.issues) + 1))


class IssuedSheet(IssuedPaper):
    """Paper of one exercise that is handed out alone, without a heading of its own."""

    @property
    def folder(self) -> str:
        return self.first.variant.exercise.name

    @property
    def cells(self) -> dict[str, object]:
        return {"student": self.first.student, "exercise": self.folder, "seed": self.first.variant.seed}

    @property
    def drawing_numbers(self) -> tuple[str, ...]:
        return ("",)

    @property
    def sorted_by(self) -> tuple[tuple[tuple[int, int, str], ...], ...]:
        return ()

    def paper(self, lang: str) -> Any:
        return self.first.variant.in_language(lang).handout(self.first.student)

    def printed(self, lang: str) -> Any:
        return printed_handouts(self.issues, lang, self.scan)[0]

    def solution(self, lang: str) -> Any:
        variant = self.first.variant.in_language(lang)
        return variant.answer_sheet(self.first.student, polygons=self.polygons)


def papers(
    assignment: Assignment | None, issues: Sequence[Issue], *, polygons: bool, scan: str = ""
) -> list[IssuedPaper]:
    """Return the issued variants grouped by paper, each alone without an assignment; ``scan`` is the size of
    the answer pages."""
    if assignment is None:
        nameless = Assignment("", ())
        return [IssuedSheet(nameless, (issue,), polygons, scan) for issue in issues]
    by_stem: dict[tuple[str, int], list[Issue]] = {}
    for issue in issues:
        by_stem.setdefault((issue.stem, issue.sitting), []).append(issue)
    return [
        IssuedPaper(assignment, tuple(issues_of_paper), polygons, scan)
        for issues_of_paper in by_stem.values()
    ]


def natural(text: str) -> tuple[tuple[int, int, str], ...]:
    """Return the sort key of a text by words and by numbers: group 10 after group 2."""
    pieces = re.findall(r"\d+|\D+", text)
    return tuple(
        (0, int(p), "") if p.isdecimal() and len(p) <= _DIGITS else (1, 0, folded(p)) for p in pieces
    )


def instructions_of(assignment: Assignment, lang: str) -> str:
    """Return the instructions of a paper and the rules of the exam, Markdown; "" if there are none."""
    rules = assignment.rules
    if isinstance(rules, bool):
        text = str(words(lang)["exam"]["rules"]) if rules else ""
    else:
        text = text_in(rules, lang)
    return "\n\n".join(filter(None, (text_in(assignment.instructions, lang), text)))


def own_duration(duration: str, columns: Mapping[str, str]) -> str:
    """Return the duration of a student's exam: with the extra time of the roster, if there is some and the
    duration is one of hours and minutes."""
    share, minutes = extra_time_of(columns), minutes_of(duration)
    return duration if not share or minutes is None else duration_text(with_extra(minutes, share))


def date_text(date: datetime.date | None, lang: str) -> str:
    """Return a date in a language, ``4 décembre 2026``; "" for None."""
    if date is None:
        return ""
    texts = words(lang)["date"]
    return str(texts["form"]).format(day=date.day, month=texts["months"][date.month - 1], year=date.year)
