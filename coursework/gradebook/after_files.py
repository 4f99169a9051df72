"""Marked exam in a folder of marks: its answers are those of ``marks.csv``, its decisions those of
``decisions.csv``."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from coursework.course.course import Course
from coursework.errors import BadInput
from coursework.gradebook.after import Exam
from coursework.gradebook.book import Gradebook
from coursework.gradebook.decisions import Decision, DecisionFiles
from coursework.gradebook.edited_marks import EditedMarks
from coursework.gradebook.feedback_form import FeedbackForm
from coursework.gradebook.grading import write_marks
from coursework.gradebook.presence import presence_by_student
from coursework.issuing.issued import Issued
from coursework.system.tables import SPREADSHEETS, delimiter_of, open_csv
from coursework.system.writing import Progress


class MarkedFolder:
    """Folder of marks that ``grade`` wrote.

    Raises
    ------
    BadInput
        There are no marks, or a file cannot be read.
    """

    def __init__(self, course: Course, issued: Path, folder: Path) -> None:
        path = folder / "marks.csv"
        if not path.is_file():
            raise BadInput(
                "no {file} yet: first coursework grade SUBMISSIONS… --issued {issued}",
                file=path,
                issued=issued,
            )
        self.course, self.folder = course, folder
        self.issued = Issued.read(issued)
        self.files = DecisionFiles(folder)
        standing = EditedMarks(course, self.issued, path)
        self._sheets, self._machine = standing.sheets, standing.marked()
        with open_csv(path) as file:
            has_commas = delimiter_of(file.readline()) == ";"
        self._spreadsheet = SPREADSHEETS["comma" if has_commas else "point"]

    @property
    def exam(self) -> Exam:
        """Marked exam with the decisions as they stand."""
        return Exam(
            self.course,
            self.issued,
            self._machine,
            self.files.decisions,
            tuple(self._sheets.rejected),
            presence=presence_by_student(self.folder, self.issued),
        )

    def write(
        self,
        decisions: Iterable[Decision],
        *,
        feedback: bool = False,
        progress: Progress = lambda done, of: None,
    ) -> Gradebook:
        """Add decisions to ``decisions.csv``, and write the tables of marks with them; with ``feedback`` the
        feedback sheets."""
        self.files.add(decisions)
        return write_marks(
            self.course,
            self.issued,
            self._sheets,
            self._machine,
            self.folder,
            files=self.files,
            decisions=self.files.decisions,
            feedback=feedback,
            spreadsheet=self._spreadsheet,
            progress=progress,
            form=FeedbackForm(),
        )
