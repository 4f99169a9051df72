"""Different sheets of one student in several files: the student's own sheet, as far as names of folders and
files tell, and sheets that wait for a person.

Anybody can write a name in a notebook. If two files answer the same variant of a student differently, the
file that is named after the student, or is in their folder, is theirs; if there is none, all of them wait.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cached_property, lru_cache
from pathlib import Path

from coursework.gradebook.rows import AnswerRow, joined_by_and
from coursework.issuing.issued import Issued
from coursework.issuing.students import file_stems
from coursework.messages import Message

Sheet = tuple[str, str, int]  #: student, exercise and seed

#: What students hand in themselves, each in a file of their own.
_OWN = re.compile(r".*?\.(?:ipynb|json)(?=, |$)", re.S)
_AGAIN = re.compile(r"\s*\([0-9]+\)$")  #: what browsers add to the name of a file that is there already


def file_of(row: AnswerRow) -> str:
    """Return the student's own file of a row; empty for a row of a table, or for one whose student a platform
    identifies."""
    if row.origin is not None or not (".ipynb" in row.source or ".json" in row.source):
        return ""  # nearly all
    match = _OWN.match(row.source)
    return match[0] if match else ""


class Doubts:
    """Rows of sheets in several files, and why those wait whose answers differ: known when all rows have been
    noted."""

    def __init__(self, issued: Issued) -> None:
        self._issued = issued
        self._sheets: dict[Sheet, dict[str, dict[str, str]]] = {}
        self._people: dict[str, set[str]] = {}

    def note(self, row: AnswerRow, sheet: Sheet | None) -> None:
        """Note a row, with its sheet if it has one."""
        if not (file := file_of(row)):
            return
        self._people.setdefault(file, set()).add(row.student)
        if sheet is not None and (text := _text(row)):
            self._sheets.setdefault(sheet, {}).setdefault(file, {}).setdefault(row.part, text)

    def why(self, sheet: Sheet, row: AnswerRow) -> str:
        """Return the reason for which a row waits for a person; empty if it does not."""
        return self._reasons.get((sheet, file_of(row)), "") if self._reasons else ""

    @cached_property
    def _reasons(self) -> Mapping[tuple[Sheet, str], str]:
        waiting: dict[tuple[Sheet, str], str] = {}
        for sheet, files in self._sheets.items():
            single_author = {file: answers for file, answers in files.items() if len(self._people[file]) == 1}
            if _differ(list(single_author.values())):
                reasons = _reasons_to_wait(self._issued, sheet, list(single_author))
                waiting |= {(sheet, file): why for file, why in reasons.items()}
        return waiting


def _text(row: AnswerRow) -> str:
    return "" if row.answer is None else " ".join(str(row.answer).split())


def _differ(answers: Sequence[Mapping[str, str]]) -> bool:
    """Return True if two of them answer one question differently."""
    met: dict[str, str] = {}
    return any(met.setdefault(part, text) != text for sheet in answers for part, text in sheet.items())


def _reasons_to_wait(issued: Issued, sheet: Sheet, files: Sequence[str]) -> dict[str, str]:
    """Return the reason to wait, by file; none if all are the student's own, since the first of them
    counts."""
    student = sheet[0]
    theirs = [file for file in files if _student_of_file(issued, file, student) == student]
    if not theirs:
        listed = joined_by_and(files[:2])
        if len(files) > 2:
            listed = Message("{files} and {count} more", files=listed, count=len(files) - 2)
        why = Message(
            (
                "{files} are different sheets of {student}: a person must decide which one counts; "
                "remove the other, "
                "or name the file after its student"
            ),
            files=listed,
            student=student,
        )
        return dict.fromkeys(files, why)
    return {
        file: Message(
            "it names {student}, who has another sheet in {file}: a person must decide whose it is",
            student=student,
            file=theirs[0],
        )
        for file in files
        if file not in theirs
    }


@lru_cache(maxsize=4)
def _stems(students: tuple[str, ...]) -> Mapping[str, str]:
    """Return the students by the file names of their handouts."""
    return dict(zip(file_stems(students), students, strict=True))


def _student_of_file(issued: Issued, file: str, student: str) -> str | None:
    """Return the student named by a file or its folder; None if there is none."""
    stems = _stems(issued.students or (student,))
    path = Path(file)
    for name in (path.name.partition(".")[0], path.stem, path.parent.name):
        name = _AGAIN.sub("", name)
        if (
            student_of_file := stems.get(name)
            or issued.account((name,))
            or (student if name == student else None)
        ) is not None:
            return student_of_file
    return None
