"""Student lists exported by platforms: their rows without a student, and their columns of marks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from coursework.errors import counted, first_few
from coursework.issuing.identity import EMAIL, FIRST_NAME, is_called, plain
from coursework.messages import Message

RosterLine = tuple[int, list[str]]  #: number and cells of a row


class Unused(NamedTuple):
    """Content of a platform's list other than students."""

    columns: frozenset[int] = frozenset()
    notes: tuple[str, ...] = ()
    turned: bool = False  #: names are written surname first, ``Doe, Ann``


def without_marks(header: Sequence[str], rows: Sequence[RosterLine]) -> tuple[list[RosterLine], Unused]:
    """Return the rows of students of a platform's list, and its other content; all rows of any other list."""
    titles = [plain(title) for title in header]
    for is_this, marks in _LISTS:
        if is_this(titles):
            students = [line for line in rows if not _is_nobody(header, line[1])]
            gone = [" ".join(line[1][0].split()) for line in rows if _is_nobody(header, line[1])]
            columns = frozenset(marks(header, rows))
            notes = []
            if gone:
                notes.append(
                    Message(
                        "{lines} without a student left out: {named}",
                        lines=counted(len(gone), "line"),
                        named=first_few([name or "(no name)" for name in gone], 3),
                    )
                )
            if columns:
                notes.append(
                    Message(
                        "{columns} of marks not used: {named}",
                        columns=counted(len(columns), "column"),
                        named=first_few([header[c].strip() for c in sorted(columns)], 2),
                    )
                )
            return students, Unused(columns, tuple(notes), is_this in (_is_canvas, _is_sakai))
    return list(rows), Unused()


def first_name_first(name: str) -> str:
    """Return ``Doe, Ann`` as ``Ann Doe``."""
    surname, comma, first = name.partition(",")
    return f"{first.strip()} {surname.strip()}" if comma and first.strip() else name


def _is_canvas(titles: Sequence[str]) -> bool:
    return titles[:1] == ["student"] and {"sis login id", "section"} <= {*titles}


def _is_moodle(titles: Sequence[str]) -> bool:
    """Return whether the titles are those of participants, a gradebook or a quiz report: first name and
    e-mail are separate."""
    return any(t in FIRST_NAME for t in titles) and any(t in EMAIL for t in titles)


def _is_blackboard(titles: Sequence[str]) -> bool:
    return "username" in titles and "last name" in titles and any("|" in t for t in titles)


def _is_sakai(titles: Sequence[str]) -> bool:
    return titles[:1] == ["student id"] and titles[1:2] in (["student name"], ["name"])


_POINTS = ("points possible", "manual posting", "muted")
_AVERAGE = ("average", "moyenne", "durchschnitt", "promedio", "gemiddelde")
TEST_STUDENT = ("student, test", "test student")


def _is_nobody(header: Sequence[str], cells: Sequence[str]) -> bool:
    """Return whether a row has no student: maxima, an average, or the test student of Canvas."""
    filled = [cell.strip().casefold() for cell in cells if cell.strip()]
    if not filled or filled[0] in _POINTS or filled[0] in TEST_STUDENT:
        return True
    mail = next((k for k, title in enumerate(header) if is_called(title, EMAIL)), None)
    alone = mail is not None and not "".join(cells[mail : mail + 1]).strip()
    if alone and any(word in filled[0] for word in _AVERAGE):
        return True
    return not cells[0].strip() and filled[0].startswith("manual posting")


def _canvas_marks(header: Sequence[str], rows: Sequence[RosterLine]) -> range:
    section = [plain(title) for title in header].index("section")
    return range(section + 1, len(header))


def _bracketed(header: Sequence[str], rows: Sequence[RosterLine]) -> list[int]:
    return [k for k, title in enumerate(header) if "|" in title]


_SHOWN = re.compile(r".*\S\s*\((?P<how>[^()]+)\)\s*")


def _moodle_marks(header: Sequence[str], rows: Sequence[RosterLine]) -> list[int]:
    """Return the columns of marks of a gradebook, ``Quiz: Week 3 (Real)``, and the last one, the time of the
    download."""
    last = len(header) - 1
    times = [cells[last].strip() for _, cells in rows if len(cells) > last]
    if not times or not all(re.fullmatch("[0-9]{9,11}", time) for time in times):
        return []
    return [k for k, title in enumerate(header) if _SHOWN.fullmatch(title)] + [last]


def _sakai_marks(header: Sequence[str], rows: Sequence[RosterLine]) -> range:
    return range(2, len(header))


_LISTS = (
    (_is_canvas, _canvas_marks),
    (_is_blackboard, _bracketed),
    (_is_sakai, _sakai_marks),
    (_is_moodle, _moodle_marks),
)
