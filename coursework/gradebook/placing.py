"""Answers to the variants that they belong to; what cannot be placed is kept with its reason."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from coursework.course.answer_keys import part_called
from coursework.course.course import Course
from coursework.errors import UnknownName, nearest
from coursework.gradebook.rows import Collected, Rejected, Row, Seen
from coursework.making.issued import Issued

_LISTED = 8  #: names that a message lists
SheetPlace = tuple[
    str, str, int, int
]  #: student, exercise, seed, and the attempt where a platform tells it, else 0


@dataclass
class Sheets:
    """Rows of answers in their places, before they are marked."""

    sheets: dict[SheetPlace, dict[str, Row]] = field(default_factory=dict)
    rejected: list[Rejected] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    rows_in: int = 0
    blanks: int = 0  #: rows without an answer where another row answers to the same part, or is blank too
    langs: dict[SheetPlace, str] = field(default_factory=dict)  #: of the sheets that tell theirs
    seen: Counter[Seen] = field(default_factory=Counter)  #: what platforms wrote
    submitted: dict[SheetPlace, str] = field(default_factory=dict)  #: when, where that is told
    apart: set[SheetPlace] = field(
        default_factory=set
    )  #: of which the platform asked those parts alone that came

    @property
    def answers(self) -> int:
        return sum(map(len, self.sheets.values()))


# ------------------------------------------------------------------------ placing


class Refused(Exception):
    """Why a row cannot be marked."""


def place_of(issued: Issued, row: Row) -> tuple[str, str, int]:
    """Student, exercise and seed of a row.

    Raises
    ------
    Refused
        It has none.
    """
    student = (
        issued.student(row.student) if row.origin is None else _told_student(issued, row.student, row.origin)
    )
    if not row.student:
        raise Refused("no student's name")
    if student is None:
        raise Refused(f"no student {row.student!r} on the roster{near(row.student, issued.students)}")
    if row.exercise not in issued.exercises:
        raise Refused(
            f"no exercise {row.exercise!r} was issued{_near_or_all(row.exercise, issued.exercises)}"
        )
    mine = issued.seeds_of(student, row.exercise)
    if not row.seed and mine:
        return student, row.exercise, mine[-1]
    if not row.seed and issued.has_roster and not issued.is_pool:
        raise Refused(f"{student} was issued no {row.exercise}")
    if not re.fullmatch(r"[0-9]{1,30}(\.0)?", row.seed):
        raise Refused(f"a seed is a whole number; found {row.seed[:40]!r}")
    seed = int(row.seed.removesuffix(".0"))
    theirs = _theirs(issued, student, row.exercise, mine) if issued.has_roster and not issued.is_pool else ""
    if (row.exercise, seed) not in issued.records:
        raise Refused(f"seed {seed} of {row.exercise} was not issued{theirs}")
    if row.origin is not None:
        _check_version(issued.records[row.exercise, seed], row.origin.version)
    if issued.has_roster and seed not in mine and not issued.is_pool:
        raise Refused(f"seed {seed} of {row.exercise} is {_whose(issued, row.exercise, seed)}{theirs}")
    return student, row.exercise, seed


def _told_student(issued: Issued, name: str, origin: Collected) -> str | None:
    """The student whom a platform tells; an answer that names another than who handed it in is nobody's."""
    by = issued.account(origin.by)
    if by is not None and name in origin.by:
        return by
    student = issued.student(name, origin.ids)
    if None not in (by, student) and by != student:
        raise Refused(
            f"handed in by {by} ({origin.by[0]}), but it names {student}: a person must say whose it is"
        )
    return student


def _check_version(record: Mapping[str, Any], version: str) -> None:
    if version and version != str(record["version"]):
        raise Refused(
            f"version {version} of {record['exercise']} was answered, and version {record['version']} is issued: name the "
            "issued.json of the export that the platform had"
        )


def _whose(issued: Issued, exercise: str, seed: int) -> str:
    version = issued.versions.get((exercise, seed))
    return f"version {version}'s" if version else "another student's"


def _theirs(issued: Issued, student: str, exercise: str, mine: Sequence[int]) -> str:
    """What a student has, to end a refusal."""
    if not mine:
        return f"; {student} was issued none"
    version = issued.versions.get((exercise, mine[0]))
    letter = f"version {version}, " if version else ""
    return f"; {student} has {letter}seed {' and '.join(map(str, mine))}"


def near(name: str, known: Iterable[str]) -> str:
    """``"; did you mean 'x'?"``, or nothing: a class is not listed."""
    hint = nearest(name[:60], known)
    return hint if "did you mean" in hint else ""


def _near_or_all(name: str, known: Sequence[str]) -> str:
    if hint := near(name, known):
        return hint
    return f"; issued: {', '.join(known[:_LISTED])}{', …' if len(known) > _LISTED else ''}"


def placed(course: Course, issued: Issued, rows: Iterable[Row | Rejected | Seen]) -> Sheets:
    """Rows by sheet; those that belong nowhere are rejected with their reason.

    Raises
    ------
    CourseworkError
        The course cannot mark: no solutions, an exercise that the records do not fit.
    """
    found = Sheets()
    for exercise, one in {key[0]: record for key, record in issued.records.items()}.items():
        if exercise not in course:
            raise UnknownName(
                f"no exercise {exercise!r} in {course.folder.label}, though it was issued: name the course that it was built "
                "from, coursework --course FOLDER grade …"
            )
        _ = course[exercise].solution
        course[exercise].from_record(one)
    asked: dict[tuple[str, int], tuple[str, ...]] = {}
    places: dict[tuple[str, str, str, Collected | None], SheetPlace | str] = {}
    unsaid: set[SheetPlace] = set()  #: sheets of several sittings, whose answers do not say which
    for row in rows:
        if isinstance(row, Seen):
            found.seen[row] += 1
            continue
        found.rows_in += 1
        if isinstance(row, Rejected):
            found.rejected.append(row)
            continue
        if row.warning and row.warning not in found.warnings:
            found.warnings.append(row.warning)
        named = row.student, row.exercise, row.seed, row.origin
        if named not in places:
            try:
                places[named] = (*place_of(issued, row), 0 if row.origin is None else row.origin.sitting)
            except Refused as why:
                places[named] = str(why)
        place = places[named]
        if isinstance(place, str):
            found.rejected.append(Rejected(row.source, place, as_texts(row)))
            continue
        key, reason = place[1:3], ""
        if (
            issued.has_sittings
            and not row.seed
            and place not in unsaid
            and len(issued.seeds_of(*place[:2])) > 1
        ):
            unsaid.add(place)
            found.warnings.append(_latest(issued, place))
        if key not in asked:
            asked[key] = tuple(str(part["id"]) for part in issued.records[key]["parts"])
        sheet = found.sheets.setdefault(place, {})
        if row.origin is not None:
            _note(issued, found, place, row.origin)
        if not row.part and row.origin is not None and _is_blank(row):
            _leave_blank(found, place, asked[key], row)
            continue
        if row.part not in asked[key]:
            row = row._replace(part=part_called(row.part, asked[key]))
        if row.part not in asked[key]:
            near = nearest(row.part[:60], sorted(asked[key]))
            reason = f"{row.exercise} has no part {row.part[:60]!r}{near}"
        elif row.part in sheet:
            before = sheet[row.part]
            if _is_blank(row):
                found.blanks += 1
                continue
            if _is_blank(before):
                found.blanks += 1
            else:
                reason = f"repeats {before.source}, which is marked"
        if reason:
            found.rejected.append(Rejected(row.source, reason, as_texts(row)))
        else:
            sheet[row.part] = row
            if row.lang and place not in found.langs and row.lang in course[place[1]].languages:
                found.langs[place] = row.lang
    found.sheets = {place: sheet for place, sheet in found.sheets.items() if sheet}
    return found


def _leave_blank(found: Sheets, place: SheetPlace, asked: Sequence[str], row: Row) -> None:
    """A sheet that came back without a word: each of its questions is a row."""
    sheet = found.sheets[place]
    found.rows_in += len(asked) - 1
    found.blanks += len(asked) - sum(part not in sheet for part in asked)
    for part in asked:
        sheet.setdefault(part, row._replace(part=part))


def _note(issued: Issued, found: Sheets, place: SheetPlace, origin: Collected) -> None:
    """Keep which attempt a sheet is of, and when it was handed in."""
    issued.has_sittings = issued.has_sittings or origin.sitting > 1
    if origin.submitted:
        found.submitted.setdefault(place, origin.submitted)
    if origin.apart:
        found.apart.add(place)


def _latest(issued: Issued, place: SheetPlace) -> str:
    """That answers without a seed are taken for those of the latest sitting."""
    sitting = issued.sitting_of(*place[:3])
    return (
        f"{place[0]}, {place[1]}: answers without a seed are taken for sitting {sitting}, seed {place[2]}, the latest; "
        "write the seed of the other sitting where they are of that one"
    )


def _is_blank(row: Row) -> bool:
    return row.answer is None or (isinstance(row.answer, str) and not row.answer.strip())


def as_texts(row: Row) -> dict[str, str]:
    answer = "" if row.answer is None else str(row.answer)
    return {
        "student": row.student,
        "exercise": row.exercise,
        "seed": row.seed,
        "part": row.part,
        "answer": answer,
    }
