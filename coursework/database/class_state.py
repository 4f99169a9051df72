"""Current state of a class: sheets, marks, totals, answers that wait for a person."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, partial
from hashlib import sha256
from typing import Any, TypeVar

from coursework.course.course import Course
from coursework.database.coded import by_code, coded_graded, coded_row, coded_sheets, codes_of
from coursework.database.instructor_queries import AssignmentOverview, Placing, SiteSubmissions, Stamp
from coursework.errors import closest
from coursework.gradebook.after import Exam
from coursework.gradebook.book import Gradebook, Result, Sitting, results
from coursework.gradebook.class_marking import rejecting
from coursework.gradebook.decisions import Decisions
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import SheetKey, Sheets
from coursework.gradebook.presence import presence_on_roster
from coursework.gradebook.rows import TITLES, Rejected
from coursework.gradebook.waiting import (
    AnswerGroup,
    Measure,
    OpenGroup,
    SheetOfStudent,
    sheet_of_student,
)
from coursework.issuing.issued import Issued
from coursework.issuing.questions import PaperQuestions
from coursework.issuing.students import namesakes
from coursework.messages import localised

_GROUPS = 40  #: parts of a class that are kept at hand
_Key = TypeVar("_Key", bound=tuple[Any, ...])
_Value = TypeVar("_Value")


@dataclass(frozen=True)
class UnplacedRow:
    """Row that belongs to no sheet."""

    id: str  #: digest of what it says and where
    row: Rejected
    student: str  #: whom it names, as issued; empty for a stranger
    became: Placing | None
    near_of: Callable[[str], str] = field(repr=False, compare=False)

    @property
    def near(self) -> str:
        """Similar name of a student, if it names a stranger."""
        return "" if self.student else self.near_of(self.row.row.get("student", ""))

    @property
    def waits(self) -> bool:
        """Return True if a person must still look at the row."""
        return self.became is None

    @property
    def reason(self) -> str:
        """Reason of the rejection, in the language of the current messages."""
        return localised(self.row.reason)

    @property
    def stranger(self) -> str:
        """Name that it states, if nobody of the class has it."""
        return "" if self.student else self.row.row.get("student", "")

    @property
    def cells(self) -> list[tuple[str, str]]:
        """Values that it states, with their titles in the language of the current messages."""
        return [(localised(TITLES.get(name, name)), value) for name, value in self.row.row.items() if value]

    @property
    def place(self) -> str:
        """Place of the row in its file, in the language of the current messages."""
        return localised(self.row.place)


@dataclass
class ClassState:
    """Class of an assignment at one stamp."""

    course: Course
    about: AssignmentOverview
    issued: Issued
    stamp: Stamp
    machine: Mapping[SheetKey, Graded]  #: as the marking gave them
    numbers: Mapping[SheetKey, int]  #: of the markings
    measured: Mapping[int, Measure]  #: by marking
    sheets: Sheets
    faults: Mapping[SheetKey, str]
    decisions: Decisions
    placings: Mapping[str, Placing]
    site_submissions: Mapping[str, SiteSubmissions]
    charged: Mapping[Sitting, float]  #: penalties of late submissions, as shares of the points
    is_whole: bool = True  #: False for a part of the class

    def within(self, students: frozenset[str]) -> ClassState:
        """Return the class as it is for some of its students: nothing of the others, and no row that names
        nobody."""
        narrowed: dict[frozenset[str], ClassState] = self.__dict__.setdefault("_narrowed", {})
        if students not in narrowed:
            while len(narrowed) >= _GROUPS:
                del narrowed[next(iter(narrowed))]
            narrowed[students] = self._only(students)
        narrowed[students].about = self.about
        return narrowed[students]

    def _only(self, students: frozenset[str]) -> ClassState:
        def of_them(table: Mapping[_Key, _Value]) -> dict[_Key, _Value]:
            return {key: value for key, value in table.items() if key[0] in students}

        rejected = [row for row in self.sheets.rejected if self._named_by(row) in students]
        sheets = replace(self.sheets, sheets=of_them(self.sheets.sheets), rejected=rejected, warnings=[])
        part = replace(
            self,
            issued=self.issued.among(students),
            machine=of_them(self.machine),
            numbers=of_them(self.numbers),
            sheets=sheets,
            faults=of_them(self.faults),
            site_submissions={name: one for name, one in self.site_submissions.items() if name in students},
            charged=of_them(self.charged),
            is_whole=False,
        )
        # Adjustments are of the whole class, and names stay hidden until nothing of the whole class waits.
        part.exam.__dict__["adjusted"] = [*of_them(self.graded).values()]
        part.__dict__["adjusted"] = self.adjusted.among(students)
        part.__dict__["codes"] = {name: code for name, code in self.codes.items() if name in students}
        return part

    @cached_property
    def coded(self) -> ClassState:
        """Class as its tables and files tell of it: by codes, in their order, where these stand in place of
        names."""
        if not self.codes:
            return self

        codes = self.codes
        part = replace(
            self,
            issued=self.issued.by_codes(codes),
            sheets=coded_sheets(self.sheets, codes, self._named_by),
            faults=by_code(self.faults, codes),
            charged=by_code(self.charged, codes),
        )
        part.__dict__["presence"] = {self.shown(name): its for name, its in self.presence.items()}
        graded = by_code(self.graded, codes)
        part.__dict__["graded"] = {key: coded_graded(one, codes) for key, one in graded.items()}
        part.__dict__["adjusted"], part.__dict__["open"] = self.adjusted.by_codes(codes), self.open
        part.__dict__["codes"], part.__dict__["coded"], part.__dict__["exam"] = codes, part, self.exam
        part.__dict__["rejected"] = tuple(
            replace(
                one,
                row=coded_row(one.row, one.student, codes),
                student=self.shown(one.student),
                near_of=lambda name: "",
            )
            for one in self.rejected
        )
        return part

    @cached_property
    def is_marked(self) -> bool:
        """Return True if every received sheet is marked or cannot be marked."""
        return self.sheets.sheets.keys() <= self.machine.keys() | self.faults.keys()

    @cached_property
    def exam(self) -> Exam:
        """Marks and waiting answers, as those of any marked exam."""
        waiting = tuple(row.row for row in self.rejected if row.waits)
        return Exam(
            self.course,
            self.issued,
            tuple(self.machine.values()),
            self.decisions,
            waiting,
            self.charged,
            self.measures,
            self.presence,
            self.shown,
        )

    @cached_property
    def graded(self) -> dict[SheetKey, Graded]:
        """Current sheets, with the decisions and adjustments applied."""
        return dict(zip(self.machine, self.exam.adjusted, strict=True))

    @cached_property
    def adjusted(self) -> Issued:
        """Issued records with the adjusted points and scale."""
        return self.decisions.adjustments.on(self.issued)

    @cached_property
    def presence(self) -> dict[str, str]:
        """Presence of students, where the columns of the roster state it."""
        return presence_on_roster(self.issued)

    @cached_property
    def book(self) -> Gradebook:
        """Gradebook of the class."""
        sheets = Sheets(self.sheets.sheets, list(self.sheets.rejected), list(self.sheets.warnings))
        book = Gradebook(
            self.adjusted, self.sheets.rows_in, self.sheets.blanks, sheets.rejected, sheets.warnings
        )
        book.charged, book.presence = self.charged, self.presence
        book.aside = [row.row for row in self.rejected if not row.waits]
        both: dict[SheetKey, Graded | str] = {**self.graded, **self.faults}
        for graded in list(rejecting(sheets, ((p, both[p]) for p in sheets.sheets if p in both))):
            book.add(graded)
        return book

    @cached_property
    def results(self) -> dict[str, Result]:
        """Result of each student, of the attempt that counts."""
        return dict(results(self.book))

    @property
    def questions(self) -> PaperQuestions:
        """Questions of the papers, with their numbers."""
        return self.exam.questions

    # ------------------------------------------------------------------- waiting

    @property
    def groups(self) -> list[AnswerGroup]:
        """Groups of answers that a person may review, decided or not."""
        return self.exam.groups

    @cached_property
    def measures(self) -> dict[SheetOfStudent, Measure]:
        """Measures by which sheets are compared."""
        return {
            sheet_of_student(self.machine[sheet]): self.measured[number]
            for sheet, number in self.numbers.items()
            if number in self.measured
        }

    @cached_property
    def open(self) -> dict[str, OpenGroup]:
        """Groups with undecided answers, by id, in order; including those that are shown only on request."""
        return {one.group.id: one for one in self.exam.undecided}

    @property
    def waiting(self) -> int:
        """Number of answers and rows that wait for a person."""
        answers = sum(len(group.members) for group in self.exam.open)
        return answers + sum(row.waits for row in self.named)

    @cached_property
    def all_codes(self) -> Mapping[str, str]:
        """Codes on the papers of an anonymous assignment, by student."""
        return codes_of(self.issued)

    @cached_property
    def codes(self) -> Mapping[str, str]:
        """Codes that stand in place of names, by student: of an anonymous assignment, until nothing waits any
        more."""
        return self.all_codes if self.waiting else {}

    def shown(self, student: str) -> str:
        """Return what a page shows of a student: the code, else the name."""
        return self.codes.get(student, student)

    @cached_property
    def unplaced(self) -> tuple[tuple[str, Rejected, str], ...]:
        """Rows that could not be placed or marked: digest, row, and student."""
        sheets = Sheets(self.sheets.sheets, list(self.sheets.rejected))
        list(rejecting(sheets, self.faults.items()))
        return tuple((row_id(row), row, self._named_by(row)) for row in sheets.rejected)

    def _named_by(self, row: Rejected) -> str:
        name = row.row.get("student", "")
        return (self.issued.student(name) if name else None) or ""

    @cached_property
    def rejected(self) -> tuple[UnplacedRow, ...]:
        """Rows that could not be placed, each with its placing by a person."""
        # Slow in a large class: of the rows that are shown alone.
        near = cache(partial(near_name, self.issued))
        return tuple(UnplacedRow(*one, self.placings.get(one[0]), near) for one in self.unplaced)

    @property
    def of_nobody(self) -> int:
        """Number of waiting rows, on the page of files, that name no student of the class."""
        return sum(row.waits for row in self.rejected) - sum(row.waits for row in self.named)

    @property
    def named(self) -> tuple[UnplacedRow, ...]:
        """Rejected rows that name a student of the class."""
        names = frozenset(self.issued.students)
        return tuple(row for row in self.rejected if row.student in names)


def near_name(issued: Issued, name: str) -> str:
    """Return the student whose name is most similar to a stranger's; empty if it is that of several."""
    is_one = name and len(namesakes(name, issued.students)) < 2
    return (closest(name[:60], issued.students) if is_one else None) or ""


def row_id(row: Rejected) -> str:
    """Return the digest that identifies a rejected row."""
    text = "\0".join((row.source, *(f"{k}={v}" for k, v in sorted(row.row.items()))))
    return sha256(text.encode("utf-8", "backslashreplace")).hexdigest()[:32]
