"""Marking of a notebook that nbgrader collected, against the record of issued variants. Answers are read as
data; nbgrader is not imported."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from coursework.course.answer_keys import answer_keys, part_called
from coursework.course.course import Course, opened
from coursework.course.variant import Variant
from coursework.gradebook.by_student import OwnMarks, for_student, marks_of_student
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.notebooks import read_notebook
from coursework.gradebook.rows import Rejected
from coursework.issuing.issued import Issued
from coursework.marking.mark import WAITING
from coursework.messages import Message
from coursework.platforms.nbgrader import outputs as cell_outputs
from coursework.platforms.nbgrader.cells import answers_id, grade_id
from coursework.platforms.nbgrader.outputs import Output

_EPSILON = 1e-9  #: points


@dataclass(frozen=True)
class MarkedNotebook:
    """Result of marking a notebook, by nbgrader's names of its cells."""

    points: dict[str, tuple[float, float]]  #: earned and possible
    outputs: dict[str, list[Output]]
    notes: dict[str, list[Output]]  #: of answers cells
    waiting: frozenset[str]  #: grade cells that a person must look at
    messages: tuple[str, ...]  #: for the staff

    def grade_outputs(
        self, name: str, most: float, warn: Callable[[str], object] = lambda message: None
    ) -> list[Output]:
        """Return the outputs of a grade cell worth ``most`` points; a part that was not issued earns
        nothing."""
        points, out_of = self.points.get(name, (0.0, most))
        if abs(out_of - most) > _EPSILON:
            warn(
                Message(
                    (
                        "{name} is worth {most:g} points in nbgrader's database and {out_of:g} as "
                        "issued; run nbgrader "
                        "generate_assignment again"
                    ),
                    name=name,
                    most=most,
                    out_of=out_of,
                )
            )
        return [*self.outputs.get(name, ()), cell_outputs.points_output(max(0.0, min(points, most)))]

    def notes_of(self, name: str) -> list[Output]:
        return self.notes.get(name, [])


def marked_notebook(course: str | Path | None, issued: Path, student: str, text: bytes) -> MarkedNotebook:
    """Mark the notebook of ``student``, an account of nbgrader, against ``issued.json``.

    Raises
    ------
    BadInput
        The file is not there, or is not what ``build`` writes.
    CourseworkError
        The course cannot mark.
    """
    opened_course, issued_record = opened(course, Variant), Issued.read(issued)
    name = issued_record.account([student]) or student
    own_marks = marks_of_student(
        opened_course, issued_record, name, read_notebook(text, f"{student}.ipynb", student)
    )
    return _marked(opened_course, own_marks)


class _Exercise:
    """Sheet of a student, and its rejected answers: by part, and those that belong to no part."""

    def __init__(self, course: Course[Variant], graded: Graded, rejected: Iterable[Rejected]):
        self.graded, self.name = graded, graded.exercise
        self.lang = str(graded.record.get("lang", "fr"))
        self.keys = answer_keys(course[self.name].from_record(graded.record).parts)
        self.by_part: dict[str, list[str]] = {}
        self.loose: list[str] = []
        for rejected_row in rejected:
            part = part_called(rejected_row.row.get("part", ""), tuple(self.keys))
            if rejected_row.row.get("exercise") == self.name and part in self.keys:
                self.by_part.setdefault(part, []).append(for_student(rejected_row.reason))
            elif (why := for_student(rejected_row.reason)) not in self.loose:
                self.loose.append(why)

    def waits(self, part: str) -> bool:
        """Return whether a person must look at a part; at every part if no answer could be read."""
        nothing_read = bool(self.loose) and not self.graded.answered
        return nothing_read or part in self.by_part or self.graded.lines[part].verdict in WAITING

    def outputs(self, part: str, mark_outputs: Sequence[Output]) -> list[Output]:
        why = cell_outputs.sentences(self.lang, "rejected", self.by_part.get(part, ()))
        return [*mark_outputs, *why] if part in self.graded.answered or not why else why

    def notes(self, notes: Sequence[str]) -> list[Output]:
        """Return the outputs of the answers cell."""
        return [
            *cell_outputs.sentences(self.lang, "rejected", self.loose),
            *cell_outputs.sentences(self.lang, "note", notes),
        ]


def _marked(course: Course[Variant], own_marks: OwnMarks) -> MarkedNotebook:
    issued_names = {graded.exercise for graded in own_marks.sheets}
    points, outputs, notes, waiting = {}, {}, {}, set()
    for graded in own_marks.sheets:
        # A rejected row that names no issued exercise may belong to any of them.
        elsewhere = issued_names - {graded.exercise}
        exercise = _Exercise(
            course, graded, (r for r in own_marks.rejected if r.row.get("exercise") not in elsewhere)
        )
        mark_outputs = cell_outputs.outputs(course, graded)
        for part, mark in graded.lines.items():
            cell = grade_id(exercise.name, exercise.keys[part])
            points[cell] = mark.points, mark.out_of
            outputs[cell] = exercise.outputs(part, mark_outputs[part])
            if exercise.waits(part):
                waiting.add(cell)
        notes[answers_id(exercise.name)] = exercise.notes(own_marks.notes)
    return MarkedNotebook(points, outputs, notes, frozenset(waiting), _messages(own_marks))


def _messages(own_marks: OwnMarks) -> tuple[str, ...]:
    return (*(f"{row.source}: {row.reason}" for row in own_marks.rejected), *own_marks.notes)
