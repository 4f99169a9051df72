"""The job of Monday: files of answers in; marks, summary, rejected rows and feedback sheets out.

The tables appear together, whole, in place of those before, or not at all: none takes its place before all are written
and each is seen to be replaceable.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from coursework import gradebook
from coursework.build_folder import free_name
from coursework.building import File, write, write_whole
from coursework.course import Course
from coursework.errors import BadInput, CourseworkError
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

    Raises
    ------
    BadInput
        A file that is not there, or nothing that can be marked: then nothing is written.
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
    if not sheets.sheets:
        raise BadInput(_nothing(submissions, sheets.rejected))
    book = Gradebook(issued, sheets.rows_in, sheets.blanks, sheets.rejected, sheets.warnings)
    shown: list[Graded] = []
    with _Tables(out) as tables:
        marks = tables.open("marks.csv", gradebook.MARKS_COLUMNS)
        summary = tables.open("summary.csv", gradebook.SUMMARY_COLUMNS)
        rejected = tables.open("rejected.csv", gradebook.REJECTED_COLUMNS)
        changes = tables.open("changes.csv", CHANGES_COLUMNS) if before.exists else None
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
        for row in gradebook.summary_rows(book):
            summary.write(row)
        for row in gradebook.rejected_rows(book.rejected):
            rejected.write(row)
        if book.changes and before.edited(out / "summary.csv"):
            book.warnings.insert(0, _kept(out / "marks.csv"))
        tables.keep()
    if feedback:
        made = file_stems(dict.fromkeys((*issued.students, *before.students)))
        _write_feedback(course, book, shown, out / "feedback", made, progress)
    return book


def _kept(marks: Path) -> str:
    """Keep marks that were edited, beside those that take their place; says so."""
    kept = free_name(marks)
    write_whole(kept, marks.read_bytes())
    return (
        f"{marks.name} had been edited, and is written anew: the edited one is kept as {kept}; a mark that is to last is "
        f"named in {marks.with_name('accepted.csv')}"
    )


def _nothing(submissions: Sequence[Path], rejected: Sequence[Rejected]) -> str:
    """That nothing can be marked, and why."""
    where = ", ".join(map(str, submissions[:3])) + (", …" if len(submissions) > 3 else "")
    told = f"nothing in {where} can be marked, so nothing is written"
    if not rejected:
        return f"{told}; a file of answers has a line of headings, then a line an answer"
    count = "" if len(rejected) == 1 else f" ({len(rejected)} rows rejected; the first is told)"
    return f"{told}{count}: {rejected[0].source}: {rejected[0].reason}"


class _Table:
    """A CSV file being written, beside the one whose place it is to take."""

    def __init__(self, path: Path, columns: Sequence[str]) -> None:
        self.path, self.part = path, path.with_name(path.name + ".part")
        self.file = self.part.open("w", encoding="utf-8", newline="")
        self._writer = csv.writer(self.file)
        self._columns = tuple(columns)
        self._writer.writerow(self._columns)
        self.rows = 0

    def write(self, row: dict[str, Any]) -> None:
        self._writer.writerow([inert(row[c]) for c in self._columns])
        self.rows += 1


class _Tables:
    """Tables of one folder that take their places together when they are kept, and leave nothing when they are not.

    Raises
    ------
    BadInput
        One of them cannot take its place; told before the first is written, and again before the first is kept.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._tables: list[_Table] = []

    def __enter__(self) -> _Tables:
        self._folder.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(self, *_: object) -> None:
        for table in self._tables:
            with suppress(OSError):  # a full disk has been told already
                table.file.close()
            table.part.unlink(missing_ok=True)

    def open(self, name: str, columns: Sequence[str]) -> _Table:
        path = self._folder / name
        _check_replaceable(path)
        self._tables.append(_Table(path, columns))
        return self._tables[-1]

    def keep(self) -> None:
        """Let the tables take their places: all are whole, and can, before the first does."""
        for table in self._tables:
            table.file.close()
            _check_replaceable(table.path)
        for table in self._tables:
            with _told(table.path):
                table.part.replace(table.path)


def _check_replaceable(path: Path) -> None:
    with _told(path):
        if path.exists():
            path.open("ab").close()


@contextmanager
def _told(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as fault:
        raise BadInput(
            f"{path} cannot be written ({fault.strerror}); close what has it open, move it away, or choose another --out"
        ) from fault


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
                return course.renderer.booklet_pdf([feedback_sheet(course, g) for g in sheets])
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
