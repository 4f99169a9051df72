"""Assignment of answers to their variants; rows without one are rejected with a reason."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from coursework.course.answer_keys import part_called
from coursework.course.course import Course
from coursework.errors import CourseworkError, UnknownName, first_few, nearest
from coursework.gradebook.conflicting_sheets import Doubts
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin, joined_by_and
from coursework.issuing.issued import Issued
from coursework.issuing.students import namesakes
from coursework.messages import Message, as_message

_LISTED = 8  #: names that a message lists
_REMEMBERED = 10_000  #: places of rows, while the next rows are read
#: Student, exercise, seed, and the attempt where a platform tells it, else 0.
SheetKey = tuple[str, str, int, int]


@dataclass
class Sheets:
    """Rows of answers by sheet, before they are marked."""

    sheets: dict[SheetKey, dict[str, AnswerRow]] = field(default_factory=dict)
    rejected: list[Rejected] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    rows_in: int = 0
    blanks: int = 0  #: rows without an answer where another row answers to the same part, or is blank too
    langs: dict[SheetKey, str] = field(default_factory=dict)  #: of the sheets that tell theirs
    seen: Counter[PlatformFile] = field(default_factory=Counter)  #: what platforms wrote
    submitted: dict[SheetKey, str] = field(default_factory=dict)  #: time, if it is stated
    #: Sheets of which the platform asked only the parts received.
    apart: set[SheetKey] = field(default_factory=set)

    @property
    def count(self) -> int:
        return len(self.sheets)

    @property
    def students(self) -> int:
        """Number of students."""
        return len({sheet[0] for sheet in self.sheets})

    @property
    def answers(self) -> int:
        return sum(map(len, self.sheets.values()))

    @property
    def is_dated(self) -> bool:
        """True if a platform states the time of a submission."""
        return bool(self.submitted)

    def parts(self, size: int) -> Iterator[Sheets]:
        """Yield the sheets in their order: all at once, or at most ``size`` at a time if they are not in
        memory."""
        yield self

    def drop_empty(self) -> None:
        """Remove sheets without any row."""
        self.sheets = {key: sheet for key, sheet in self.sheets.items() if sheet}


# ------------------------------------------------------------------------ placing


class UnplacedError(CourseworkError, ValueError):
    """A row that belongs to no sheet; the message is the reason."""


def sheet_of_row(issued: Issued, row: AnswerRow) -> tuple[str, str, int]:
    """Return student, exercise and seed of a row.

    Raises
    ------
    UnplacedError
        It has none.
    """
    student = student_of(issued, row)
    if not row.student:
        raise UnplacedError("no student's name")
    if student is None:
        raise UnplacedError(
            "no student {student!r} on the roster{hint}",
            student=row.student,
            hint=_student_hint(row.student, issued.students),
        )
    if row.exercise not in issued.exercises:
        raise UnplacedError(
            "no exercise {exercise!r} was issued{hint}",
            exercise=row.exercise,
            hint=_near_or_all(row.exercise, issued.exercises),
        )
    mine = issued.seeds_of(student, row.exercise)
    if not row.seed and mine:
        return student, row.exercise, mine[-1]
    if not row.seed and issued.has_roster and not issued.is_pool:
        raise UnplacedError("{student} was issued no {exercise}", student=student, exercise=row.exercise)
    if not re.fullmatch(r"[0-9]{1,30}(\.0)?", row.seed):
        raise UnplacedError("a seed is a whole number; found {seed!r}", seed=row.seed[:40])
    seed = int(row.seed.removesuffix(".0"))
    theirs = (
        _seeds_hint(issued, student, row.exercise, mine) if issued.has_roster and not issued.is_pool else ""
    )
    if (row.exercise, seed) not in issued.records:
        raise UnplacedError(
            "seed {seed} of {exercise} was not issued{hint}", seed=seed, exercise=row.exercise, hint=theirs
        )
    if row.origin is not None:
        _check_version(issued.records[row.exercise, seed], row.origin.version)
    if issued.has_roster and seed not in mine and not issued.is_pool:
        raise UnplacedError(
            "seed {seed} of {exercise} is {owner}{hint}",
            seed=seed,
            exercise=row.exercise,
            owner=_owner_of_seed(issued, row.exercise, seed),
            hint=theirs,
        )
    return student, row.exercise, seed


def student_of(issued: Issued, row: AnswerRow) -> str | None:
    """Return the student of a row, by the name as issued; None for a stranger.

    Raises
    ------
    UnplacedError
        It names another than who handed it in.
    """
    return (
        issued.student(row.student)
        if row.origin is None
        else _stated_student(issued, row.student, row.origin)
    )


def _stated_student(issued: Issued, name: str, origin: RowOrigin) -> str | None:
    """Return the student whom a platform states; refuse an answer that names another student than the one who
    submitted it."""
    by = issued.account(origin.by)
    if by is not None and name in origin.by:
        return by
    student = issued.student(name, origin.ids)
    if None not in (by, student) and by != student:
        raise UnplacedError(
            "submitted by {by} ({account}), but it names {student}: a person must decide whose it is",
            by=by,
            account=origin.by[0],
            student=student,
        )
    return student


def _check_version(record: Mapping[str, Any], version: str) -> None:
    if version and version != str(record["version"]):
        raise UnplacedError(
            (
                "the answers belong to version {version} of {exercise}, and version {issued} was issued: "
                "name the "
                "issued.json of the export that is on the platform"
            ),
            version=version,
            exercise=record["exercise"],
            issued=record["version"],
        )


def _owner_of_seed(issued: Issued, exercise: str, seed: int) -> str:
    version = issued.versions.get((exercise, seed))
    return Message("version {version}'s", version=version) if version else Message("another student's")


def _seeds_hint(issued: Issued, student: str, exercise: str, mine: Sequence[int]) -> str:
    """Return the end of a refusal: the seeds that the student has."""
    if not mine:
        return Message("; {student} was issued none", student=student)
    version = issued.versions.get((exercise, mine[0]))
    seeds = joined_by_and(mine)
    if version:
        return Message(
            "; {student} has version {version}, seed {seeds}", student=student, version=version, seeds=seeds
        )
    return Message("; {student} has seed {seeds}", student=student, seeds=seeds)


def _student_hint(name: str, students: Sequence[str]) -> str:
    """Return the end of a refusal: the similar names, all of them if there are several equal ones."""
    several = namesakes(name, students)
    if len(several) > 1:
        return Message("; which of {names}?", names=", ".join(map(repr, several)))
    return name_hint(name, students)


def name_hint(name: str, names: Iterable[str]) -> str:
    """Return ``"; did you mean 'x'?"``, or an empty text: a class is not listed."""
    hint = nearest(name[:60], names)
    return hint if "did you mean" in hint else ""


def _near_or_all(name: str, names: Sequence[str]) -> str:
    if hint := name_hint(name, names):
        return hint
    return Message("; issued: {names}", names=first_few(names, _LISTED))


def placed_sheets(
    course: Course, issued: Issued, rows: Iterable[AnswerRow | Rejected | PlatformFile]
) -> Sheets:
    """Return the rows by sheet; rows that belong to none are rejected with a reason.

    Raises
    ------
    CourseworkError
        The course cannot mark: no solutions, an exercise that the records do not fit.
    """
    sheets, doubts = Sheets(), Doubts(issued)
    fill(course, issued, sheets, list(placed_rows(course, issued, rows, sheets, doubts)), doubts)
    return sheets


PlacedRow = tuple[SheetKey, AnswerRow] | Rejected  #: a row with its place, or why it has none


def placed_rows(
    course: Course,
    issued: Issued,
    rows: Iterable[AnswerRow | Rejected | PlatformFile],
    sheets: Sheets,
    doubts: Doubts,
) -> Iterator[PlacedRow]:
    """Return an iterator of each row with its sheet, or the rejected row; it records in ``sheets`` what
    concerns all rows, and notes rows in ``doubts``.

    Raises
    ------
    CourseworkError
        As for :func:`placed_sheets`, before the first row is read.
    """
    _check_records(course, issued)
    return _placed_in_order(issued, rows, sheets, doubts)


def _placed_in_order(
    issued: Issued, rows: Iterable[AnswerRow | Rejected | PlatformFile], sheets: Sheets, doubts: Doubts
) -> Iterator[PlacedRow]:
    cached_place = _place_cache(issued)
    unsaid: set[SheetKey] = set()  #: sheets of several sittings whose answers do not state one
    for row in rows:
        if isinstance(row, PlatformFile):
            sheets.seen[row] += 1
            continue
        sheets.rows_in += 1
        if isinstance(row, Rejected):
            yield row
            continue
        if row.warning and row.warning not in sheets.warnings:
            sheets.warnings.append(row.warning)
        key = cached_place(row)
        doubts.note(row, None if isinstance(key, str) else key[:3])
        if isinstance(key, str):
            yield Rejected(row.source, key, as_texts(row))
            continue
        if issued.has_sittings and not row.seed and key not in unsaid and len(issued.seeds_of(*key[:2])) > 1:
            unsaid.add(key)
            sheets.warnings.append(_latest_warning(issued, key))
        if row.origin is not None:
            issued.has_sittings = issued.has_sittings or row.origin.sitting > 1
        yield key, row


def _check_records(course: Course, issued: Issued) -> None:
    """Check that the course has the issued exercises and can mark them."""
    for exercise, record_of_exercise in {key[0]: record for key, record in issued.records.items()}.items():
        if exercise not in course:
            raise UnknownName(
                "no exercise {exercise!r} in {course}, though it was issued: name the course that it "
                "was built from, coursework --course FOLDER grade …",
                exercise=exercise,
                course=course.folder.label,
            )
        _ = course[exercise].solution
        course[exercise].from_record(record_of_exercise)


def _place_cache(issued: Issued) -> Callable[[AnswerRow], SheetKey | str]:
    """Return a function that returns the sheet of a row, or the reason for which it has none. Results are
    cached for neighbouring rows of one sheet."""
    passing: dict[tuple[str, str, str, RowOrigin | None], SheetKey | str] = {}
    lasting = passing.copy()

    def cached_place(row: AnswerRow) -> SheetKey | str:
        # Whom a platform names and no roster is who they were when first met; others are found again as they
        # were.
        memory = lasting if row.origin is not None and not issued.has_roster else passing
        named = row.student, row.exercise, row.seed, row.origin
        if (key := memory.get(named)) is None:
            if len(passing) >= _REMEMBERED:
                passing.clear()
            try:
                key = (*sheet_of_row(issued, row), 0 if row.origin is None else row.origin.sitting)
            except UnplacedError as why:
                key = as_message(why)
            memory[named] = key
        return key

    return cached_place


def fill(
    course: Course, issued: Issued, sheets: Sheets, placements: Iterable[PlacedRow], doubts: Doubts
) -> None:
    """Put rows on their sheets, after all of them were placed."""
    put_row = row_placer(course, issued, sheets, doubts)
    for placed_row in placements:
        refused = placed_row if isinstance(placed_row, Rejected) else put_row(*placed_row)
        if refused is not None:
            sheets.rejected.append(refused)
    sheets.drop_empty()


def row_placer(
    course: Course, issued: Issued, sheets: Sheets, doubts: Doubts
) -> Callable[[SheetKey, AnswerRow], Rejected | None]:
    """Return a function that adds a row to its sheet, or returns the rejected row; it receives the rows of a
    sheet in their order."""
    parts_of_variant: dict[tuple[str, int], tuple[str, ...]] = {}

    def put(key_of_sheet: SheetKey, row: AnswerRow) -> Rejected | None:
        if doubt := doubts.why(key_of_sheet[:3], row):
            return Rejected(row.source, doubt, as_texts(row))
        key, reason = key_of_sheet[1:3], ""
        if key not in parts_of_variant:
            parts_of_variant[key] = tuple(str(part["id"]) for part in issued.records[key]["parts"])
        sheet = sheets.sheets.setdefault(key_of_sheet, {})
        if row.origin is not None:
            _note(sheets, key_of_sheet, row.origin)
        if not row.part and row.origin is not None and _is_blank(row):
            _leave_blank(sheets, key_of_sheet, parts_of_variant[key], row)
            return None
        if row.part not in parts_of_variant[key]:
            row = row._replace(part=part_called(row.part, parts_of_variant[key]))
        if row.part not in parts_of_variant[key]:
            name_hint = nearest(row.part[:60], sorted(parts_of_variant[key]))
            reason = Message(
                "{exercise} has no part {part!r}{nearest}",
                exercise=row.exercise,
                part=row.part[:60],
                nearest=name_hint,
            )
        elif row.part in sheet:
            before = sheet[row.part]
            if _is_blank(row):
                sheets.blanks += 1
                return None
            if _is_blank(before):
                sheets.blanks += 1
            else:
                reason = Message("repeats {file}, which is marked", file=before.source)
        if reason:
            return Rejected(row.source, reason, as_texts(row))
        sheet[row.part] = row
        if row.lang and key_of_sheet not in sheets.langs and row.lang in course[key_of_sheet[1]].languages:
            sheets.langs[key_of_sheet] = row.lang
        return None

    return put


def _leave_blank(sheets: Sheets, key: SheetKey, parts: Sequence[str], row: AnswerRow) -> None:
    """Add a row for each question of a sheet that was returned without answers."""
    sheet = sheets.sheets[key]
    sheets.rows_in += len(parts) - 1
    sheets.blanks += len(parts) - sum(part not in sheet for part in parts)
    for part in parts:
        sheet.setdefault(part, row._replace(part=part))


def _note(sheets: Sheets, key: SheetKey, origin: RowOrigin) -> None:
    """Record the time of submission of a sheet, and whether its parts were asked one by one."""
    if origin.submitted:
        sheets.submitted.setdefault(key, origin.submitted)
    if origin.apart:
        sheets.apart.add(key)


def _latest_warning(issued: Issued, key: SheetKey) -> str:
    """Return the warning that answers without a seed count for the latest sitting."""
    return Message(
        (
            "{student}, {exercise}: answers without a seed count for sitting {sitting}, seed {seed}, "
            "the latest; "
            "write the seed of the other sitting if they belong to it"
        ),
        student=key[0],
        exercise=key[1],
        sitting=issued.sitting_of(*key[:3]),
        seed=key[2],
    )


def _is_blank(row: AnswerRow) -> bool:
    return row.answer is None or (isinstance(row.answer, str) and not row.answer.strip())


def as_texts(row: AnswerRow) -> dict[str, str]:
    answer = "" if row.answer is None else str(row.answer)
    return {
        "student": row.student,
        "exercise": row.exercise,
        "seed": row.seed,
        "part": row.part,
        "answer": answer,
    }
