"""The job of Monday: files of answers in; marks, summary, rejected rows and feedback sheets out.

The tables appear together, whole, in place of those before, or not at all.
"""

from __future__ import annotations

import csv
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from coursework import gradebook
from coursework.building import File, write
from coursework.course import Course
from coursework.errors import CourseworkError
from coursework.gradebook import Gradebook, Graded
from coursework.handout import FeedbackLine, FeedbackSheet
from coursework.issued import Issued
from coursework.issuing import file_stems
from coursework.regrading import CHANGES_COLUMNS, Accepted, Before
from coursework.submissions import Rejected, Row, find, read_file
from coursework.tables import inert
from coursework.telling import localised

#: For so many students at most, feedback sheets are printed unless told.
FEEDBACK_STUDENTS = 1000

#: Called with how many are done, and of how many.
Progress = Callable[[int, int], None]


def grade_files(
    course: Course,
    submissions: Sequence[Path],
    issued_path: Path,
    out: Path,
    *,
    feedback: bool | None,
    accepted: Path | None = None,
    progress: Progress = lambda done, of: None,
) -> Gradebook:
    """Mark files and write ``marks.csv``, ``summary.csv``, ``rejected.csv`` and feedback sheets.

    Where marks were there before, ``changes.csv`` says what differs now. ``accepted`` names answers that
    a person accepts; unless told, those of ``accepted.csv`` in ``out``. ``feedback`` None prints sheets for a
    class of usual size.
    """
    issued = Issued.read(issued_path)
    if feedback is None:
        feedback = max(len(issued.students), len(issued.records)) <= FEEDBACK_STUDENTS
    kept = out / "accepted.csv"
    by_hand = Accepted(accepted if accepted is not None else kept if kept.exists() else None)
    before = Before(out / "marks.csv")

    def rows() -> Iterator[Row | Rejected]:
        for found in find(submissions):
            yield from [found] if isinstance(found, Rejected) else read_file(found)

    sheets = gradebook.placed(course, issued, rows())
    book = Gradebook(issued, sheets.rows_in, sheets.blanks, sheets.rejected, sheets.warnings)
    shown: list[Graded] = []
    with ExitStack() as stack:
        marks = stack.enter_context(_Table(out / "marks.csv", gradebook.MARKS_COLUMNS))
        changes = stack.enter_context(_Table(out / "changes.csv", CHANGES_COLUMNS)) if before.exists else None
        for done, graded in enumerate(gradebook.marked(course, issued, sheets, printed=feedback), start=1):
            graded = by_hand.apply(graded, str(graded.record.get("lang", "fr")))
            book.add(graded)
            for row in gradebook.marks_rows(graded):
                marks.write(row)
                change = before.changed(row) if changes is not None else None
                if change is not None:
                    changes.write(change)
            if feedback:
                shown.append(graded)
            progress(done, len(sheets.sheets))
        if changes is not None:
            for change in before.gone():
                changes.write(change)
            book.changes = changes.rows
        book.warnings += [f"accepted by hand, but never answered: {place}" for place in by_hand.unused]
        with _Table(out / "summary.csv", gradebook.SUMMARY_COLUMNS) as summary:
            for row in gradebook.summary_rows(book):
                summary.write(row)
            with _Table(out / "rejected.csv", gradebook.REJECTED_COLUMNS) as rejected:
                for row in gradebook.rejected_rows(book.rejected):
                    rejected.write(row)
                marks.keep(), summary.keep(), rejected.keep()
                if changes is not None:
                    changes.keep()
    if feedback:
        _write_feedback(course, book, shown, out / "feedback", progress)
    return book


class _Table:
    """A CSV file that appears when it is kept, and leaves nothing behind when it is not."""

    def __init__(self, path: Path, columns: Sequence[str]) -> None:
        self._path, self._part = path, path.with_name(path.name + ".part")
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = self._part.open("w", encoding="utf-8", newline="")
        self._writer = csv.writer(self._file)
        self._columns = tuple(columns)
        self._writer.writerow(self._columns)
        self._kept = False
        self.rows = 0

    def __enter__(self) -> _Table:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()
        if self._kept:
            self._part.replace(self._path)
        else:
            self._part.unlink(missing_ok=True)

    def write(self, row: dict[str, Any]) -> None:
        self._writer.writerow([inert(row[c]) for c in self._columns])
        self.rows += 1

    def keep(self) -> None:
        """Let the file take its place when all are done."""
        self._file.flush()
        self._kept = True


def feedback_sheet(course: Course, graded: Graded) -> FeedbackSheet:
    """A student's marks on one exercise, ready to print."""
    variant = course[graded.exercise].from_record(graded.record)
    handout = variant.handout(graded.student)
    lines = []
    for question in handout.questions:
        line = graded.lines[question.id]
        read_as = localised(line.read_as, variant.lang)
        lines.append(
            FeedbackLine(question, line.answer, read_as, line.verdict, line.points, line.out_of, line.says)
        )
    return FeedbackSheet(handout, tuple(lines), graded.points, graded.out_of)


def _write_feedback(
    course: Course, book: Gradebook, shown: Sequence[Graded], folder: Path, progress: Progress
) -> None:
    """One PDF a student, an exercise after another, called as the student's handouts are.

    A sheet that cannot be printed is a warning, and costs no other.
    """
    by_student: dict[str, list[Graded]] = {student: [] for student in book.issued.students}
    for graded in shown:
        by_student.setdefault(graded.student, []).append(graded)

    def maker(student: str, sheets: list[Graded]) -> Callable[[], bytes | None]:
        def make() -> bytes | None:
            try:
                return course.renderer.booklet_pdf([feedback_sheet(course, g) for g in sheets])
            except CourseworkError as fault:
                book.warnings.append(f"no feedback sheet for {student}: {fault}")
                return None

        return make

    shutil.rmtree(folder, ignore_errors=True)
    stems = file_stems(by_student)
    files = [
        File(Path(f"{stem}.pdf"), maker(student, mine))
        for stem, (student, mine) in zip(stems, by_student.items(), strict=True)
        if mine
    ]
    done = iter(range(1, len(files) + 1))
    write(folder, files, lambda _: progress(next(done), len(files)))
