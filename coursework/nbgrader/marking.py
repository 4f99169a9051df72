"""A notebook that nbgrader collected, marked against what was issued. The answers are read as data; no nbgrader here."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from coursework.course.answer_keys import answer_keys, part_called
from coursework.course.course import Course, opened
from coursework.course.variant import Variant
from coursework.gradebook.by_student import OwnMarks, for_student, marks_of_student
from coursework.gradebook.graded import Graded
from coursework.gradebook.notebooks import read_notebook
from coursework.gradebook.rows import Rejected
from coursework.making.issued import Issued
from coursework.nbgrader import told as words_of
from coursework.nbgrader.cells import answers_id, grade_id
from coursework.nbgrader.told import Output
from coursework.rendering.feedback import WAITING

_EPSILON = 1e-9  #: points


@dataclass(frozen=True)
class MarkedNotebook:
    """What became of a notebook, by the names that nbgrader has for its cells."""

    points: dict[str, tuple[float, float]]  #: and out of how many
    outputs: dict[str, list[Output]]
    notes: dict[str, list[Output]]  #: of answers cells
    waiting: frozenset[str]  #: grade cells that a person must look at
    told: tuple[str, ...]  #: to the staff

    def grade_outputs(
        self, name: str, most: float, warn: Callable[[str], object] = lambda told: None
    ) -> list[Output]:
        """The outputs of a grade cell worth ``most`` points; a cell of a part that was not issued earns nothing."""
        points, out_of = self.points.get(name, (0.0, most))
        if abs(out_of - most) > _EPSILON:
            warn(
                f"{name} is worth {most:g} points in nbgrader's database and {out_of:g} as it was issued; "
                "run nbgrader generate_assignment anew"
            )
        return [*self.outputs.get(name, ()), words_of.points(max(0.0, min(points, most)))]

    def notes_of(self, name: str) -> list[Output]:
        return self.notes.get(name, [])


def marked_notebook(course: str | Path | None, issued: Path, student: str, text: bytes) -> MarkedNotebook:
    """Mark the notebook of a student, whom nbgrader names, against ``issued.json``.

    Raises
    ------
    BadInput
        The file is not there, or is not what ``build`` writes.
    CourseworkError
        The course cannot mark.
    """
    opened_course, known = opened(course, Variant), Issued.read(issued)
    name = known.account([student]) or student
    found = marks_of_student(opened_course, known, name, read_notebook(text, f"{student}.ipynb", student))
    return _marked(opened_course, found)


class _Exercise:
    """A student's sheet, and what was rejected of it: by part, and what is of no part."""

    def __init__(self, course: Course[Variant], graded: Graded, rejected: Iterable[Rejected]):
        self.graded, self.name = graded, graded.exercise
        self.lang = str(graded.record.get("lang", "fr"))
        self.keys = answer_keys(course[self.name].from_record(graded.record).parts)
        self.by_part: dict[str, list[str]] = {}
        self.loose: list[str] = []
        for one in rejected:
            part = part_called(one.row.get("part", ""), tuple(self.keys))
            if one.row.get("exercise") == self.name and part in self.keys:
                self.by_part.setdefault(part, []).append(for_student(one.reason))
            elif (why := for_student(one.reason)) not in self.loose:
                self.loose.append(why)

    def waits(self, part: str) -> bool:
        """Whether a person must look at a part: where nothing was read of all that came, at each."""
        nothing_read = bool(self.loose) and not self.graded.answered
        return nothing_read or part in self.by_part or self.graded.lines[part].verdict in WAITING

    def outputs(self, part: str, shown: Sequence[Output]) -> list[Output]:
        why = words_of.said(self.lang, "rejected", self.by_part.get(part, ()))
        return [*shown, *why] if part in self.graded.answered or not why else why

    def notes(self, notes: Sequence[str]) -> list[Output]:
        """What stands under the answers cell."""
        return [*words_of.said(self.lang, "rejected", self.loose), *words_of.said(self.lang, "note", notes)]


def _marked(course: Course[Variant], found: OwnMarks) -> MarkedNotebook:
    known = {graded.exercise for graded in found.sheets}
    points, outputs, notes, waiting = {}, {}, {}, set()
    for graded in found.sheets:
        # What names no exercise that was issued may be of any of them.
        elsewhere = known - {graded.exercise}
        one = _Exercise(course, graded, (r for r in found.rejected if r.row.get("exercise") not in elsewhere))
        shown = words_of.outputs(course, graded)
        for part, mark in graded.lines.items():
            cell = grade_id(one.name, one.keys[part])
            points[cell] = mark.points, mark.out_of
            outputs[cell] = one.outputs(part, shown[part])
            if one.waits(part):
                waiting.add(cell)
        notes[answers_id(one.name)] = one.notes(found.notes)
    return MarkedNotebook(points, outputs, notes, frozenset(waiting), _told(found))


def _told(found: OwnMarks) -> tuple[str, ...]:
    return (*(f"{one.source}: {one.reason}" for one in found.rejected), *found.notes)
