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
from coursework.making.platform_rosters import first_name_first, without_marks
from coursework.making.students import folded
from coursework.system.limits import MOST_COLUMNS, MOST_TABLE_BYTES, beyond, check_size
from coursework.system.tables import as_written, decode, delimiter_of, record, said_twice

_LANG = ("lang", "language", "langue")


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


def read_roster(path: Path, tell: Callable[[str], None] = lambda note: None) -> list[Student]:
    """The students of a CSV with a column ``student``, or with surname and first name, and, if wanted, ``lang``; or of what
    Moodle and Canvas export, as it comes. Two people of one name are told apart by their numbers or e-mails.

    ``tell`` is called with what should be known and is no error: a column that is not used, a line that is nobody's, an odd
    encoding.

    Raises
    ------
    BadInput
        The file cannot be read, has a row without a name or with too many cells, names no student, or one twice.
    """
    header, *rows = _rows(path, tell) or [(1, [])]
    if len(header[1]) > MOST_COLUMNS:
        raise BadInput(f"the roster {path}: {beyond('a table', len(header[1]), MOST_COLUMNS, 'columns')}")
    titles = [plain(cell) for cell in header[1]]
    named = _name_columns(titles)
    if not named:
        found = ", ".join(cell.strip() for cell in header[1] if cell.strip()) or "nothing"
        raise BadInput(f"the roster {path} needs a column named student; found {found}")
    if twice := said_twice(titles, (*(titles[column] for column in named), *_LANG, *NUMBER, *EMAIL)):
        raise BadInput(f"the roster {path}: {twice}")
    lang_column = next((titles.index(c) for c in _LANG if c in titles), None)
    rows, unused = without_marks(header[1], rows)
    for note in unused.notes:
        tell(f"the roster {path}: {note}")
    taken = {*named, *unused.columns, lang_column}
    others = [k for k, title in enumerate(header[1]) if k not in taken and title.strip()]
    lines = []
    for number, cells in rows:
        place = f"the roster {path}, line {number}"
        if any(cell.strip() for cell in cells[len(titles) :]):
            raise BadInput(
                f"{place}: {counted(len(cells), 'cell')} where the header has {len(titles)}; "
                "put a name that holds a comma or a semicolon between quotation marks, or give the column a title"
            )
        cells += [""] * (len(titles) - len(cells))
        name = " ".join(" ".join(cells[column] for column in named).split())
        name = first_name_first(name) if unused.turned else name
        lang = cells[lang_column].strip().lower() if lang_column is not None else ""
        if not name:
            raise BadInput(f"{place}: no name; write it, or take the line away")
        if lang and lang not in languages():
            raise BadInput(f"{place}: no language {lang!r}; there is {', '.join(languages())}")
        own = {header[1][c].strip(): cells[c].strip() for c in others}
        lines.append((number, Student(name, lang, own)))
    if not lines:
        raise BadInput(f"the roster {path} names no student")
    _tell_lost(path, [header[1][c].strip() for c in others], tell)
    untitled = [
        column
        for column, title in enumerate(titles)
        if not title and any(column < len(cells) and cells[column].strip() for _, cells in rows)
    ]
    if untitled:
        tell(
            f"the roster {path} has a column without a title, which is not used; give it one to carry it through"
        )
    return _apart(path, lines)


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


def _name_columns(titles: list[str]) -> list[int]:
    """The column of whole names; or those of surnames and first names, in the file's order."""
    for column, title in enumerate(titles):
        if title in WHOLE:
            return [column]
    surname = next((titles.index(c) for c in SURNAME if c in titles), None)
    first_name = next((titles.index(c) for c in FIRST_NAME if c in titles), None)
    if surname is None:
        return []
    return sorted({surname, surname if first_name is None else first_name})


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
