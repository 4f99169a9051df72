"""Table of a class with its counts: computed from the whole class, and stored until something changes."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from sqlalchemy.exc import IntegrityError

from coursework.database.class_state import ClassState
from coursework.database.class_summaries import (
    ClassCounts,
    put_summary,
    stored_tables,
    summary_states,
)
from coursework.database.instructor_queries import (
    AssignmentOverview,
    Stamp,
    stamp,
    stamps,
)
from coursework.errors import BadInput
from coursework.gradebook.adjustments import NEUTRAL, SPARED
from coursework.gradebook.book import Result
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.presence import PRESENT
from coursework.gradebook.scale import mark_of
from coursework.issuing.identity import column_called
from coursework.issuing.questions import PaperQuestions
from coursework.marking.mark import Mark
from coursework.site.desk.class_cache import class_now, class_within, overview, students_here
from coursework.site.desk.question_cards import sign_of
from coursework.site.frame.requests import Request
from coursework.site.frame.settings import Site
from coursework.site.papers.submission import pass_dates
from coursework.system.garbage import paused_collection


class Cell(NamedTuple):
    """Answer in the table."""

    sign: str  #: full, part, none, wait, missing; empty if the question was not asked
    points: float
    verdict: str
    by_hand: bool


BLANK = Cell("", 0.0, "", False)


@dataclass(frozen=True)
class ClassRow:
    """Student in the table."""

    order: int  #: position in the class
    student: str
    identity: str
    cells: tuple[Cell, ...]
    points: float
    out_of: float
    mark: str
    tries: int
    late: int  #: seconds
    handed_in: bool
    open: int  #: answers that wait for a person; until then the mark is provisional
    counts: float  #: points on which the mark is based
    on_site: bool  #: handed in on the site, perhaps blank
    presence: str = ""  #: where somebody stated it

    @property
    def has_answered(self) -> bool:
        return any(cell.sign not in ("", "missing") for cell in self.cells)

    @property
    def missed(self) -> str:
        """Absent or excused, of somebody of whom that is known and who handed nothing in."""
        return "" if self.handed_in or self.presence == PRESENT else self.presence

    @property
    def waits(self) -> int:
        return sum(cell.sign == "wait" for cell in self.cells)

    @property
    def minutes_late(self) -> int:
        return -(-self.late // 60)


def rows(now: ClassState) -> list[ClassRow]:
    """Return a row for every student of the class, in the order of the roster."""
    counted: dict[str, dict[tuple[str, str], Cell]] = {}
    for sheet, graded in now.graded.items():
        if graded.sitting == now.results[graded.student].sitting:
            counted.setdefault(graded.student, {}).update(_cells(now, now.machine[sheet], graded))
    # In the order of the codes, if names are hidden: that of the roster would tell who is who.
    students = sorted(now.results, key=now.shown) if now.codes else list(now.results)
    return [
        _row(now, number, student, now.results[student], counted.get(student, {}))
        for number, student in enumerate(students)
    ]


def _cells(now: ClassState, machine: Graded, graded: Graded) -> dict[tuple[str, str], Cell]:
    return {
        (graded.exercise, part): Cell(
            sign_of(mark), mark.points, mark.verdict, _by_hand(machine.lines[part], mark)
        )
        for part, mark in graded.lines.items()
    }


def _by_hand(before: Mark, now: Mark) -> bool:
    return before is not now and (before.verdict, before.points) != (now.verdict, now.points)


def _row(
    now: ClassState, number: int, student: str, result: Result, cells: Mapping[tuple[str, str], Cell]
) -> ClassRow:
    columns = now.issued.columns.get(student, {})
    titles = () if now.codes else (now.issued.assignment or {}).get("identity") or ()
    identity = " ".join(
        filter(None, (columns.get(column_called(columns, str(title)), "") for title in titles))
    )
    submitted = now.site_submissions.get(student)
    tries = (
        submitted.attempts
        if submitted
        else max((n for s, n in now.book.students if s == student), default=0)
        if cells
        else 0
    )
    return ClassRow(
        number,
        now.shown(student),
        identity,
        tuple(cells.get(question, BLANK) for question in now.questions),
        result.points,
        result.out_of,
        mark_of(now.adjusted, result.counts, result.out_of),
        tries,
        submitted.late if submitted else 0,
        (bool(cells) and student in now.exam.present) or submitted is not None,
        result.open,
        result.counts,
        submitted is not None,
        now.presence.get(student, ""),
    )


def _means(now: ClassState, table_rows: Sequence[ClassRow]) -> list[str]:
    """Return the mean of each question over the students who submitted, in percent of its points."""
    most: dict[tuple[str, str], float] = {}
    adjustments = now.decisions.adjustments
    for (name, _), record in now.issued.records.items():
        most.update({(name, str(p["id"])): adjustments.worth(name, p) for p in record["parts"]})
    means = []
    for column, question in enumerate(now.questions):
        had = [row.cells[column].points for row in table_rows if row.cells[column].sign]
        counts = had and adjustments.statuses.get(question) not in (NEUTRAL, SPARED)
        means.append(f"{100 * sum(had) / (len(had) * most[question]):.0f}" if counts else "")
    return means


@dataclass(frozen=True)
class ClassTable:
    """Table of a class at one stamp."""

    about: AssignmentOverview
    stamp: Stamp
    counts: ClassCounts
    content: str  #: the rest, as JSON

    @property
    def waiting(self) -> int:
        return self.counts.waiting

    @cached_property
    def _parsed(self) -> Mapping[str, Any]:
        parsed: Mapping[str, Any] = json.loads(self.content)
        return parsed

    @cached_property
    def questions(self) -> PaperQuestions:
        """Questions of the papers, with their numbers."""
        return PaperQuestions(
            {(exercise, part): number for exercise, part, number in self._parsed["questions"]}
        )

    @property
    def means(self) -> Sequence[str]:
        """Mean of each question over the students who submitted, in percent of its points."""
        means: Sequence[str] = self._parsed["means"]
        return means

    @property
    def has_mark(self) -> bool:
        """True if the class has marks: by the assignment, or by a scale that was set after it."""
        return self.of > 0

    @property
    def of(self) -> float:
        """Maximum of a mark; 0 without marks."""
        return float(self._parsed["of"])

    @cached_property
    def rows(self) -> list[ClassRow]:
        """Row of every student, in the order of the roster."""
        cells = [Cell(*cell) for cell in self._parsed["cells"]]
        return [
            ClassRow(number, student, identity, tuple(cells[k] for k in own), *rest)
            for number, (student, identity, own, *rest) in enumerate(self._parsed["rows"])
        ]


def class_table(site: Site, assignment_id: int) -> ClassTable:
    """Return the table of a class: as stored, unless something has changed since.

    Raises
    ------
    HTTPException
        There is no such assignment.
    """
    pass_dates(site, site.clock(), assignment_id)
    with site.store.reading() as connection:
        about = overview(connection, assignment_id)
        at = stamp(connection, assignment_id)
        states = summary_states(connection, site.course, [about], {assignment_id: at})
        stored = stored_tables(connection, states).get(assignment_id)
    return computed_table(site, assignment_id) if stored is None else ClassTable(about, at, *stored)


def class_tables(site: Site, abouts: Sequence[AssignmentOverview]) -> dict[int, ClassTable]:
    """Return the tables of several classes, by assignment: as stored, unless something has changed since."""
    numbers = [about.id for about in abouts]
    pass_dates(site, site.clock(), *numbers)
    with site.store.reading() as connection:
        at = stamps(connection, numbers)
        stored = stored_tables(connection, summary_states(connection, site.course, abouts, at))
    return {
        about.id: ClassTable(about, at[about.id], *stored[about.id])
        if about.id in stored
        else computed_table(site, about.id)
        for about in abouts
    }


def table_here(request: Request, assignment_id: int) -> ClassTable:
    """Return the table of the students whom a page shows: the whole class, or a part of it.

    Raises
    ------
    HTTPException
        There is no such assignment.
    """
    students = students_here(request, assignment_id)
    if students is None:
        return class_table(request.site, assignment_id)
    return _table(class_within(request.site, assignment_id, students))


def _table(now: ClassState) -> ClassTable:
    with paused_collection():
        handed_in = len(now.exam.present & {graded.student for graded in now.machine.values()})
        counts = ClassCounts(len(now.issued.students) or len(now.results), handed_in, now.waiting)
        return ClassTable(now.about, now.stamp, counts, _content(now))


def computed_table(site: Site, assignment_id: int) -> ClassTable:
    """Return the table of a class, computed from the class; store it once every sheet is marked."""
    now = class_now(site, assignment_id)
    table = _table(now)
    counts = table.counts
    if now.is_marked:
        with suppress(BadInput, IntegrityError), site.store.begin() as connection:
            states = summary_states(connection, site.course, [now.about], {assignment_id: now.stamp})
            put_summary(connection, assignment_id, states[assignment_id], counts, table.content)
    return table


def _content(now: ClassState) -> str:
    """Return the table of a class as JSON; equal cells stand once."""
    cells: dict[Cell, int] = {}
    table_rows, lines = rows(now), []
    for row in table_rows:
        own = [cells.setdefault(cell, len(cells)) for cell in row.cells]
        rest = (
            row.points,
            row.out_of,
            row.mark,
            row.tries,
            row.late,
            row.handed_in,
            row.open,
            row.counts,
            row.on_site,
            row.presence,
        )
        lines.append([row.student, row.identity, own, *rest])
    questions = [[*question, number] for question, number in now.questions.items()]
    scale = (now.adjusted.assignment or {}).get("mark") or {}
    content = {
        "questions": questions,
        "means": _means(now, table_rows),
        "cells": list(cells),
        "rows": lines,
        "of": scale.get("of", 0),
    }
    return json.dumps(content)
