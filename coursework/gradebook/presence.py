"""Presence at an exam, where somebody stated it: of a student who is absent, having no points is not having
zero."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from coursework.errors import BadInput
from coursework.gradebook.changes import rows_of
from coursework.issuing.exam_columns import cell
from coursework.issuing.identity import PRESENCE, plain
from coursework.issuing.issued import Issued

PRESENT, ABSENT, EXCUSED = "present", "absent", "excused"
AWAY = (ABSENT, EXCUSED)
_STATES = {
    **dict.fromkeys(
        ("present", "presente", "present(e)", "p", "x", "yes", "oui", "o", "1", "true", "vrai"), PRESENT
    ),
    **dict.fromkeys(
        ("absent", "absente", "absent(e)", "abs", "a", "abi", "no", "non", "n", "0", "defaillant"), ABSENT
    ),
    **dict.fromkeys(
        (
            "excused",
            "excuse",
            "excusee",
            "excuse(e)",
            "abj",
            "justifie",
            "justifiee",
            "dispense",
            "dispensee",
        ),
        EXCUSED,
    ),
}


def presence_in(columns: Mapping[str, str]) -> str:
    """Return the presence that a student's line of a roster states; "" for none, or one that is not known."""
    return _STATES.get(plain(cell(columns, PRESENCE)), "")


def presence_on_roster(issued: Issued) -> dict[str, str]:
    """Return the presence of students that the columns of the roster state, by student."""
    stated = {student: presence_in(columns) for student, columns in issued.columns.items()}
    return {student: presence for student, presence in stated.items() if presence}


def presence_near(folder: Path) -> dict[str, str]:
    """Return what is filled in of the ``attendance.csv`` of a folder of marks or of its build, by student as
    written.

    Raises
    ------
    BadInput
        A cell is none of the states.
    """
    path = next((p for d in (folder, folder.parent) if (p := d / "attendance.csv").is_file()), None)
    presence = {}
    for number, row in enumerate(rows_of(path) if path else (), start=2):
        text = row.get("present", "").strip()
        if text and plain(text) not in _STATES:
            raise BadInput(
                "{file}, line {number}: present is present, absent or excused; found {found!r}",
                file=path,
                number=number,
                found=text[:40],
            )
        if text:
            presence[row.get("student", "")] = _STATES[plain(text)]
    return presence


def presence_by_student(folder: Path, issued: Issued) -> dict[str, str]:
    """Return the presence that the ``attendance.csv`` of a folder of marks states, else the roster, by
    student as the record shows them."""
    near = {issued.student(name) or name: presence for name, presence in presence_near(folder).items()}
    return presence_on_roster(issued) | near
