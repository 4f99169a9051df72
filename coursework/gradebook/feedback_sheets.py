"""Feedback: a sheet a student and exercise, printed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from coursework.course.course import Course
from coursework.errors import CourseworkError
from coursework.gradebook.book import Gradebook
from coursework.gradebook.graded import Graded
from coursework.making.students import file_stems
from coursework.marking.feedback import localised
from coursework.rendering.renderer import renderer_of
from coursework.sheets.handout import handout as handout_of
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet
from coursework.system.writing import File, Progress, write


def feedback_sheet(course: Course, graded: Graded) -> FeedbackSheet:
    """A student's marks on one exercise, ready to print."""
    variant = course[graded.exercise].from_record(graded.record)
    handout = handout_of(variant, graded.student)
    lines = []
    for question in handout.questions:
        line = graded.lines[question.id]
        read_as = localised(line.read_as, variant.lang)
        lines.append(
            FeedbackLine(question, line.answer, read_as, line.verdict, line.points, line.out_of, line.says)
        )
    return FeedbackSheet(handout, tuple(lines), graded.points, graded.out_of)


def write_feedback(
    course: Course,
    book: Gradebook,
    shown: Sequence[Graded],
    folder: Path,
    before: Sequence[str],
    progress: Progress,
) -> None:
    """One PDF a student, an exercise after another, called as the student's handouts are.

    Those of an earlier marking, whose stems are ``before``, make way; any other file stays. A sheet that cannot be printed is a warning, and costs no other.
    """
    by_student: dict[str, list[Graded]] = {student: [] for student in book.issued.students}
    for graded in shown:
        by_student.setdefault(graded.student, []).append(graded)

    def maker(student: str, sheets: list[Graded]) -> Callable[[], bytes | None]:
        def make() -> bytes | None:
            try:
                return renderer_of(course.folder).booklet_pdf([feedback_sheet(course, g) for g in sheets])
            except CourseworkError as fault:
                book.warnings.append(f"no feedback sheet for {student}: {fault}")
                return None

        return make

    for stem in before:
        (folder / f"{stem}.pdf").unlink(missing_ok=True)
    stems = file_stems(by_student)
    files = [
        File(Path(f"{stem}.pdf"), maker(student, mine))
        for stem, (student, mine) in zip(stems, by_student.items(), strict=True)
        if mine
    ]
    done = iter(range(1, len(files) + 1))
    write(folder, files, lambda _: progress(next(done), len(files)))
