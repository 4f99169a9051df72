"""Roster: a CSV of students, written by an instructor or exported by a school."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from coursework.errors import BadInput, counted, reason_of
from coursework.issuing.exam_columns import extra_time_of
from coursework.issuing.identity import EMAIL, FIRST_NAME, NUMBER, SURNAME, WHOLE, distinguishing_id, plain
from coursework.issuing.platform_rosters import RosterLine, first_name_first, without_marks
from coursework.issuing.students import folded
from coursework.language.words import languages
from coursework.messages import Message
from coursework.system.limits import MOST_COLUMNS, MOST_TABLE_BYTES, beyond, check_size
from coursework.system.tables import as_written, decode, delimiter_of, duplicate_column, record

_LANG = ("lang", "language", "langue")
_ABOVE = 10  #: rows in which the heading is searched
#: Columns that a caller can name, and their titles.
COLUMNS = {"name": SURNAME, "first": FIRST_NAME, "number": NUMBER, "email": EMAIL, "lang": _LANG}


@dataclass(frozen=True)
class Student:
    """Row of the roster; ``lang`` is empty if the row has none."""

    name: str
    lang: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)  #: every other column, by its title as written

    @property
    def draw_key(self) -> str:
        """Return the key of the student's draws: the number or e-mail if the roster has one, else the
        name."""
        by_title = {plain(title): value for title, value in self.columns.items() if value}
        identifier = next((by_title[title] for title in (*NUMBER, *EMAIL) if title in by_title), "")
        return identifier.strip().casefold() or folded(self.name)


def read_roster(
    path: Path, warn: Callable[[str], None] = lambda note: None, columns: Mapping[str, str] | None = None
) -> list[Student]:
    """Return the students of a CSV.

    The file has a column ``student``, or surname and first name, and, if wanted, ``lang``; the lists that
    Moodle, Canvas and French registrars' offices export are read unchanged. Rows above the heading are
    skipped. Numbers or e-mails distinguish people of the same name.

    Parameters
    ----------
    path
        The CSV.
    warn
        Called with notes: an unused column, a row without a student, an unusual encoding.
    columns
        Column of each of ``name``, ``first``, ``number``, ``email`` and ``lang``, by its number from 1 on or
        by its title, if the titles are not the usual ones.

    Raises
    ------
    BadInput
        The file cannot be read, has a row without a name or with too many cells, names no student, or one
        twice.
    """
    lines = _rows(path, warn) or [(1, [])]
    header, rows = _heading(path, lines, columns, warn)
    if len(header) > MOST_COLUMNS:
        raise BadInput(
            "the roster {file}: {problem}",
            file=path,
            problem=beyond("a table", len(header), MOST_COLUMNS, "columns"),
        )
    if columns:
        header = _retitled(path, header, columns)
    titles = [plain(cell) for cell in header]
    named = _name_columns(titles)
    if not named:
        raise BadInput(
            "the roster {file}: no column identifies the students; {advice}", file=path, advice=_which(header)
        )
    if duplicate := duplicate_column(
        titles, (*(titles[group[0]] for group in named), *_LANG, *NUMBER, *EMAIL)
    ):
        raise BadInput("the roster {file}: {problem}", file=path, problem=duplicate)
    lang_column = next((titles.index(c) for c in _LANG if c in titles), None)
    rows, unused = without_marks(header, rows)
    for note in unused.notes:
        warn(Message("the roster {file}: {note}", file=path, note=note))
    used = {*(column for group in named for column in group), *unused.columns, lang_column}
    others = [k for k, title in enumerate(header) if k not in used and title.strip()]
    numbered = []
    for number, cells in rows:
        location = Message("the roster {file}, line {number}", file=path, number=number)
        if any(cell.strip() for cell in cells[len(titles) :]):
            raise BadInput(
                (
                    "{location}: {cells} where the header has {most}; put a name with a comma or a "
                    "semicolon between "
                    "quotation marks, or give the column a title"
                ),
                location=location,
                cells=counted(len(cells), "cell"),
                most=len(titles),
            )
        cells += [""] * (len(titles) - len(cells))
        name = " ".join(" ".join(_first_filled(cells, group) for group in named).split())
        name = first_name_first(name) if unused.turned else name
        lang = cells[lang_column].strip().lower() if lang_column is not None else ""
        if not name:
            raise BadInput("{location}: no name; write it, or delete the line", location=location)
        if lang and lang not in languages():
            raise BadInput(
                "{location}: no language {lang!r}; available: {languages}",
                location=location,
                lang=lang,
                languages=", ".join(languages()),
            )
        columns_of_row = {header[c].strip(): cells[c].strip() for c in others}
        try:
            extra_time_of(columns_of_row)
        except BadInput as fault:
            raise BadInput("{location}: {problem}", location=location, problem=fault) from fault
        numbered.append((number, Student(name, lang, columns_of_row)))
    if not numbered:
        raise BadInput("the roster {file} names no student", file=path)
    _tell_lost(path, [header[c].strip() for c in others], warn)
    untitled = [
        column
        for column, title in enumerate(titles)
        if not title and any(column < len(cells) and cells[column].strip() for _, cells in rows)
    ]
    if untitled:
        warn(
            Message(
                "the roster {file} has a column without a title, which is not used; give it a title to "
                "use it",
                file=path,
            )
        )
    return _apart(path, numbered)


def _heading(
    path: Path, lines: list[RosterLine], columns: Mapping[str, str] | None, warn: Callable[[str], None]
) -> tuple[list[str], list[RosterLine]]:
    """Return the heading and the rows below it: the first row with titles of name columns, else the first row
    of all."""
    wanted = {plain(title) for title in (columns or {}).values() if not title.isdecimal()}
    for index, (_, cells) in enumerate(lines[:_ABOVE]):
        titles = [plain(cell) for cell in cells]
        if _name_columns(titles) or (wanted and wanted <= {*titles}):
            if index:
                above = " ".join(cell.strip() for _, row in lines[:index] for cell in row if cell.strip())
                warn(
                    Message(
                        "the roster {file}: skipped above the heading: {above}",
                        file=path,
                        above=above[:60] + ("…" if len(above) > 60 else ""),
                    )
                )
            return cells, lines[index + 1 :]
    if columns:
        warn(
            Message(
                "the roster {file}: line {line} is taken as the heading: {cells}",
                file=path,
                line=lines[0][0],
                cells=", ".join(lines[0][1])[:60],
            )
        )
    return lines[0][1], lines[1:]


def _retitled(path: Path, header: Sequence[str], columns: Mapping[str, str]) -> list[str]:
    """Return the heading with the titles of the columns that the caller names, and without the titles they
    replace."""
    titles, places = [plain(title) for title in header], {}
    for field_name, which in columns.items():
        index = int(which) - 1 if which.isdecimal() else -1
        if not which.isdecimal() and plain(which) in titles:
            index = titles.index(plain(which))
        if not 0 <= index < len(header):
            raise BadInput(
                "the roster {file} has no column {column!r} for {name}; {advice}",
                file=path,
                column=which,
                name=field_name,
                advice=_which(header),
            )
        places[index] = field_name
    instead = {title for field_name in columns for title in COLUMNS[field_name]}
    if "name" in columns:
        instead |= {*WHOLE, *FIRST_NAME}
    remaining = [f"({title})" if plain(title) in instead else title for title in header]
    return [COLUMNS[places[k]][0] if k in places else title for k, title in enumerate(remaining)]


def _which(header: Sequence[str]) -> Message:
    titles = ", ".join(f"{k} {cell.strip()}" for k, cell in enumerate(header, 1) if cell.strip())
    return Message(
        (
            "found {titles}. Give the name a title such as student, or nom and prénom, or state the columns: "
            "--columns name=1,first=2"
        ),
        titles=titles or Message("nothing"),
    )


def _first_filled(cells: Sequence[str], columns: Sequence[int]) -> str:
    return next((cells[column] for column in columns if cells[column].strip()), "")


def roster_and_notes(path: Path) -> tuple[list[Student], list[str]]:
    """Return the students of :func:`read_roster`, and its notes."""
    notes: list[str] = []
    return read_roster(path, notes.append), notes


def _tell_lost(path: Path, titles: Sequence[str], warn: Callable[[str], None]) -> None:
    """Warn of columns of the same title, of which only the last is used."""
    for title, often in Counter(titles).items():
        if often > 1:
            warn(
                Message(
                    "the roster {file} has {count} columns {title}; the last one is used: give each "
                    "its own title",
                    file=path,
                    count=often,
                    title=title,
                )
            )


def _apart(path: Path, lines: Sequence[tuple[int, Student]]) -> list[Student]:
    """Return the students with distinct names: those of the same name get their number or e-mail appended."""
    often = Counter(folded(student.name) for _, student in lines)
    students: list[Student] = []
    seen: dict[str, int] = {}
    for number, student in lines:
        if often[folded(student.name)] > 1 and (by := distinguishing_id(student.columns)):
            student = replace(student, name=f"{student.name} ({by})")
        if folded(student.name) in seen:
            raise BadInput(
                (
                    "the roster {file}, line {number}: {student} is already on line {other}; "
                    "distinguish them, for "
                    "instance by a number"
                ),
                file=path,
                number=number,
                student=student.name,
                other=seen[folded(student.name)],
            )
        seen[folded(student.name)] = number
        students.append(student)
    return students


def _name_columns(titles: list[str]) -> list[list[int]]:
    """Return the column of full names; or those of surnames and of first names, in the file's order, the
    preferred ones first."""
    for column, title in enumerate(titles):
        if title in WHOLE:
            return [[column]]
    surnames, first_names = (
        [titles.index(c) for c in titles_of if c in titles] for titles_of in (SURNAME, FIRST_NAME)
    )
    return sorted(filter(None, (surnames, first_names))) if surnames else []


def _rows(path: Path, warn: Callable[[str], None]) -> list[tuple[int, list[str]]]:
    """Return the rows that are not blank, each with its line number."""
    try:
        check_size(Message("the roster {file}", file=path), path.stat().st_size, MOST_TABLE_BYTES)
        data = path.read_bytes()
    except OSError as fault:
        raise BadInput(
            "the roster {file} cannot be read: {reason}", file=path, reason=reason_of(fault)
        ) from fault
    text, warning = decode(data)
    if "\0" in text:
        raise BadInput("the roster {file} is not a CSV; save it as “CSV UTF-8”", file=path)
    if warning:
        warn(Message("the roster {file}: {problem}", file=path, problem=warning))
    return list(_records(re.split(r"\r\n|\n|\r", text)))


def _records(lines: list[str]) -> Iterator[tuple[int, list[str]]]:
    first = next((line for line in lines if line.strip()), "")
    delimiter, width, start = delimiter_of(first), 0, 0
    while start < len(lines):
        cells, line_count = record(lines, start, delimiter, width)
        if any(cell.strip() for cell in cells):
            yield start + 1, list(map(as_written, cells))
            width = width or len(cells)
        start += line_count
