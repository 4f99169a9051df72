"""The roster: a CSV of students, as an instructor writes it or a school exports it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from coursework.errors import BadInput, counted
from coursework.language.words import languages
from coursework.making.identity import EMAIL, FIRST_NAME, NUMBER, SURNAME, WHOLE, plain, told_apart
from coursework.making.platform_rosters import RosterLine, first_name_first, without_marks
from coursework.making.students import folded
from coursework.system.limits import MOST_COLUMNS, MOST_TABLE_BYTES, beyond, check_size
from coursework.system.tables import as_written, decode, delimiter_of, duplicate_column, record

_LANG = ("lang", "language", "langue")
_ABOVE = 10  #: lines in which the heading is looked for
#: Columns that can be named by hand, and their titles.
COLUMNS = {"name": SURNAME, "first": FIRST_NAME, "number": NUMBER, "email": EMAIL, "lang": _LANG}


@dataclass(frozen=True)
class Student:
    """A line of the roster; ``lang`` is empty where it does not say."""

    name: str
    lang: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)  #: every other column, by its title as written

    @property
    def who(self) -> str:
        """What draws hang on: the number or e-mail where the roster has one, else the name."""
        found = {plain(title): value for title, value in self.columns.items() if value}
        own = next((found[title] for title in (*NUMBER, *EMAIL) if title in found), "")
        return own.strip().casefold() or folded(self.name)


def read_roster(
    path: Path, tell: Callable[[str], None] = lambda note: None, columns: Mapping[str, str] | None = None
) -> list[Student]:
    """Return the students of a CSV.

    The file has a column ``student``, or surname and first name, and, if wanted, ``lang``; the lists that Moodle, Canvas and
    French registrars' offices export are read as they come. A title above the heading is passed over. Numbers or e-mails tell
    two people of one name apart.

    Parameters
    ----------
    path
        The CSV.
    tell
        Called with what should be known and is no error: a column that is not used, a line that is nobody's, an odd encoding.
    columns
        Column of each of ``name``, ``first``, ``number``, ``email`` and ``lang``, by its place from 1 on or by its title, where
        the titles do not say it themselves.

    Raises
    ------
    BadInput
        The file cannot be read, has a row without a name or with too many cells, names no student, or one twice.
    """
    lines = _rows(path, tell) or [(1, [])]
    header, rows = _heading(path, lines, columns, tell)
    if len(header) > MOST_COLUMNS:
        raise BadInput(f"the roster {path}: {beyond('a table', len(header), MOST_COLUMNS, 'columns')}")
    if columns:
        header = _retitled(path, header, columns)
    titles = [plain(cell) for cell in header]
    named = _name_columns(titles)
    if not named:
        raise BadInput(f"the roster {path}: no column says who a student is; {_which(header)}")
    if twice := duplicate_column(titles, (*(titles[own[0]] for own in named), *_LANG, *NUMBER, *EMAIL)):
        raise BadInput(f"the roster {path}: {twice}")
    lang_column = next((titles.index(c) for c in _LANG if c in titles), None)
    rows, unused = without_marks(header, rows)
    for note in unused.notes:
        tell(f"the roster {path}: {note}")
    taken = {*(column for own in named for column in own), *unused.columns, lang_column}
    others = [k for k, title in enumerate(header) if k not in taken and title.strip()]
    found = []
    for number, cells in rows:
        place = f"the roster {path}, line {number}"
        if any(cell.strip() for cell in cells[len(titles) :]):
            raise BadInput(
                f"{place}: {counted(len(cells), 'cell')} where the header has {len(titles)}; "
                "put a name that holds a comma or a semicolon between quotation marks, or give the column a title"
            )
        cells += [""] * (len(titles) - len(cells))
        name = " ".join(" ".join(_first_filled(cells, own) for own in named).split())
        name = first_name_first(name) if unused.turned else name
        lang = cells[lang_column].strip().lower() if lang_column is not None else ""
        if not name:
            raise BadInput(f"{place}: no name; write it, or take the line away")
        if lang and lang not in languages():
            raise BadInput(f"{place}: no language {lang!r}; there is {', '.join(languages())}")
        found.append((number, Student(name, lang, {header[c].strip(): cells[c].strip() for c in others})))
    if not found:
        raise BadInput(f"the roster {path} names no student")
    _tell_lost(path, [header[c].strip() for c in others], tell)
    untitled = [
        column
        for column, title in enumerate(titles)
        if not title and any(column < len(cells) and cells[column].strip() for _, cells in rows)
    ]
    if untitled:
        tell(
            f"the roster {path} has a column without a title, which is not used; give it one to carry it through"
        )
    return _apart(path, found)


def _heading(
    path: Path, lines: list[RosterLine], columns: Mapping[str, str] | None, tell: Callable[[str], None]
) -> tuple[list[str], list[RosterLine]]:
    """Return the heading and the lines below it: the first line that titles columns of names, else the first line of all."""
    known = {plain(title) for title in (columns or {}).values() if not title.isdecimal()}
    for place, (_, cells) in enumerate(lines[:_ABOVE]):
        titles = [plain(cell) for cell in cells]
        if _name_columns(titles) or (known and known <= {*titles}):
            if place:
                above = " ".join(cell.strip() for _, own in lines[:place] for cell in own if cell.strip())
                tell(
                    f"the roster {path}: passed over above the heading: {above[:60]}{'…' if len(above) > 60 else ''}"
                )
            return cells, lines[place + 1 :]
    if columns:
        tell(f"the roster {path}: line {lines[0][0]} is taken for the heading: {', '.join(lines[0][1])[:60]}")
    return lines[0][1], lines[1:]


def _retitled(path: Path, header: Sequence[str], columns: Mapping[str, str]) -> list[str]:
    """Return the heading with the titles of columns that the caller names, and without those that they replace."""
    titles, places = [plain(title) for title in header], {}
    for what, which in columns.items():
        place = int(which) - 1 if which.isdecimal() else -1
        if not which.isdecimal() and plain(which) in titles:
            place = titles.index(plain(which))
        if not 0 <= place < len(header):
            raise BadInput(f"the roster {path} has no column {which!r} for {what}; {_which(header)}")
        places[place] = what
    instead = {title for what in columns for title in COLUMNS[what]}
    if "name" in columns:
        instead |= {*WHOLE, *FIRST_NAME}
    kept = [f"({title})" if plain(title) in instead else title for title in header]
    return [COLUMNS[places[k]][0] if k in places else title for k, title in enumerate(kept)]


def _which(header: Sequence[str]) -> str:
    found = ", ".join(f"{k} {cell.strip()}" for k, cell in enumerate(header, 1) if cell.strip()) or "nothing"
    return f"found {found}. Give the name a title such as student, or nom and prénom, or say which column is what: --columns name=1,first=2"


def _first_filled(cells: Sequence[str], columns: Sequence[int]) -> str:
    return next((cells[column] for column in columns if cells[column].strip()), "")


def roster_and_notes(path: Path) -> tuple[list[Student], list[str]]:
    """Return what :func:`read_roster` gives, and what it tells."""
    told: list[str] = []
    return read_roster(path, told.append), told


def _tell_lost(path: Path, titles: Sequence[str], tell: Callable[[str], None]) -> None:
    """Tell of columns that have one title, of which the last alone is kept."""
    for title, often in Counter(titles).items():
        if often > 1:
            tell(
                f"the roster {path} has {often} columns {title}; the last is kept: give each a title of its own"
            )


def _apart(path: Path, lines: Sequence[tuple[int, Student]]) -> list[Student]:
    """The students, whose names are all different: those of one name have their number or e-mail behind it."""
    often = Counter(folded(student.name) for _, student in lines)
    students: list[Student] = []
    seen: dict[str, int] = {}
    for number, student in lines:
        if often[folded(student.name)] > 1 and (by := told_apart(student.columns)):
            student = replace(student, name=f"{student.name} ({by})")
        if folded(student.name) in seen:
            raise BadInput(
                f"the roster {path}, line {number}: {student.name} stands on line {seen[folded(student.name)]} already; "
                "tell them apart, by a number for instance"
            )
        seen[folded(student.name)] = number
        students.append(student)
    return students


def _name_columns(titles: list[str]) -> list[list[int]]:
    """Return the column of whole names; or those of surnames and of first names, in the file's order, the preferred first."""
    for column, title in enumerate(titles):
        if title in WHOLE:
            return [[column]]
    surnames, first_names = (
        [titles.index(c) for c in known if c in titles] for known in (SURNAME, FIRST_NAME)
    )
    return sorted(filter(None, (surnames, first_names))) if surnames else []


def _rows(path: Path, tell: Callable[[str], None]) -> list[tuple[int, list[str]]]:
    """The lines that are not blank, each with its number."""
    try:
        check_size(f"the roster {path}", path.stat().st_size, MOST_TABLE_BYTES)
        data = path.read_bytes()
    except OSError as fault:
        raise BadInput(f"the roster {path} cannot be read: {fault.strerror}") from fault
    text, warning = decode(data)
    if "\0" in text:
        raise BadInput(f"the roster {path} is no CSV; save it as “CSV UTF-8”")
    if warning:
        tell(f"the roster {path}: {warning}")
    return list(_records(re.split(r"\r\n|\n|\r", text)))


def _records(lines: list[str]) -> Iterator[tuple[int, list[str]]]:
    first = next((line for line in lines if line.strip()), "")
    delimiter, width, start = delimiter_of(first), 0, 0
    while start < len(lines):
        cells, taken = record(lines, start, delimiter, width)
        if any(cell.strip() for cell in cells):
            yield start + 1, list(map(as_written, cells))
            width = width or len(cells)
        start += taken
