"""Export of a platform's gradebook, with one column filled with the points of a class."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from coursework.errors import BadInput, nearest, reason_of
from coursework.gradebook.class_points import Scored
from coursework.gradebook.platform_gradebooks import People, PlatformGradebook, people_in
from coursework.gradebook.presence import EXCUSED
from coursework.gradebook.rows import joined_by_and
from coursework.issuing.identity import same_id, words_of
from coursework.issuing.platform_rosters import TEST_STUDENT, first_name_first
from coursework.issuing.students import folded
from coursework.system.cells import CellTable, PositionedCell

_NUMBER = re.compile(r"\s*-?[0-9]+(?P<sign>[.,])[0-9]+\s*%?\s*")
_LISTED = 5  #: names that a message lists


@dataclass
class Filled:
    """Content of the filled file, and what to report about it."""

    data: bytes = b""
    column: str = ""  #: its title
    most: float | None = None  #: the item's maximum, where it is known
    written: int = 0
    unchanged: list[str] = field(default_factory=list)  #: who has a mark that stays, such as EX
    absent: list[str] = field(default_factory=list)  #: in the file, and without marks
    strangers: list[str] = field(default_factory=list)  #: with marks, and not in the file
    unclear: list[str] = field(default_factory=list)  #: students whose line cannot be identified


def fill(
    platform: PlatformGradebook,
    template: Path,
    item: str,
    scored: Sequence[Scored],
    *,
    most: float | None = None,
    decimal: str = "",
    zeros: bool = False,
) -> Filled:
    """Fill the column of an item; every byte elsewhere stays.

    ``most`` is the item's maximum, unless the file states it; ``zeros`` gives 0 to students without an
    answer.

    Raises
    ------
    BadInput
        The file is none of the platform's, has no such column or several, or somebody has more than the
        maximum.
    """
    try:
        table = CellTable(_bytes_of(template))
    except UnicodeDecodeError as fault:
        raise BadInput(
            "{file} is damaged: it begins in {encoding}, but is not valid {encoding}",
            file=template,
            encoding=fault.encoding,
        ) from fault
    sheet = _sheet(platform, table, item, template)
    result = Filled(column=sheet.title, most=_most(platform, sheet, most, template))
    if result.most is None:
        _check_alike(scored, platform, item)
    sign = decimal or platform.decimal or _sign_in(sheet) or "."
    theirs = _matched(sheet, scored, result)
    for row, student, name in zip(sheet.rows, theirs, sheet.names, strict=True):
        if student is None or not (student.is_marked or (zeros and student.presence != EXCUSED)):
            result.absent.append(name)
        elif sheet.column >= len(row):
            raise BadInput(
                "{file}: the line of {name} has only {cells} cell{cells:|s}, so none for {column}",
                file=template,
                name=name,
                cells=len(row),
                column=sheet.title,
            )
        elif (content := _cell(row, sheet.column)) in platform.special_marks:
            result.unchanged.append(f"{name}: {content}")
        else:
            table.write(row[sheet.column], _points(student, result).replace(".", sign))
            result.written += 1
    result.data = table.data()
    return result


class _Sheet(NamedTuple):
    """Parts of a gradebook: columns, rows of students, and maxima."""

    people: People
    column: int  #: of the item
    title: str
    rows: list[Sequence[PositionedCell]]  #: of students
    maxima: Sequence[PositionedCell] | None

    @property
    def names(self) -> list[str]:
        """Names of the students; a name that occurs twice has an identifier added."""
        names = [first_name_first(_name(row, self.people)) for row in self.rows]
        ids = [_first_of(row, self.people.ids) for row in self.rows]
        often = Counter(names)
        return [
            f"{n} ({identifier})" if often[n] > 1 and identifier else n
            for n, identifier in zip(names, ids, strict=True)
        ]


def _sheet(platform: PlatformGradebook, table: CellTable, item: str, source: Path) -> _Sheet:
    header, *rows = table.records or [[]]
    titles = [cell.text for cell in header]
    people = people_in(titles)
    if not (people.names or people.ids):
        titles_text = ", ".join(title.strip() for title in titles if title.strip())[:200] or "nothing"
        raise BadInput(
            (
                "{file} names nobody: a gradebook of {platform} has columns for names or e-mail "
                "addresses; found "
                "{found}; download it from {menu}"
            ),
            file=source,
            platform=platform.title_of_platform,
            found=titles_text,
            menu=platform.download,
        )
    column = column_of(platform, titles, people, item, source)
    maxima = next((row for row in rows if platform.maxima and _first(row).startswith(platform.maxima)), None)
    students: list[Sequence[PositionedCell]] = [
        row for row in rows if row is not maxima and _is_somebody(row, people)
    ]
    return _Sheet(people, column, titles[column].strip(), students, maxima)


def _bytes_of(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as fault:
        raise BadInput("{file} cannot be read: {problem}", file=path, problem=reason_of(fault)) from fault


def _first(row: Sequence[PositionedCell]) -> str:
    return row[0].text.strip().casefold()


def _cell(row: Sequence[PositionedCell], index: int) -> str:
    return row[index].text.strip() if index < len(row) else ""


def _is_somebody(row: Sequence[PositionedCell], people: People) -> bool:
    return bool(_name(row, people)) and _name(row, people).casefold() not in TEST_STUDENT


def _first_of(row: Sequence[PositionedCell], places: Iterable[int]) -> str:
    """Return the first of some cells that is not empty."""
    return next(filter(None, (_cell(row, k) for k in places)), "")


def _name(row: Sequence[PositionedCell], people: People) -> str:
    return " ".join(filter(None, (_cell(row, k) for k in people.names))) or _first_of(row, people.ids)


# ------------------------------------------------------------------------ column


def column_of(
    platform: PlatformGradebook, titles: Sequence[str], people: People, item: str, source: Path
) -> int:
    """Return the column of an item, by its whole title or by the item's name in it.

    Raises
    ------
    BadInput
        There is none, or there are several.
    """
    places = [k for k in range(len(titles)) if k not in (*people.names, *people.ids)]
    for name_of in (str.strip, platform.item_in):
        columns = [k for k in places if folded(name_of(titles[k])) == folded(item)]
        if len(columns) == 1:
            return columns[0]
        if columns:
            named = ", ".join(repr(titles[k].strip()) for k in columns)
            raise BadInput(
                "{file} has several columns {item!r}: {columns}; give the full name, --item {column!r}",
                file=source,
                item=item,
                columns=named,
                column=titles[columns[0]].strip(),
            )
    names = list(
        dict.fromkeys(name for k in places if k > people.last and (name := platform.item_in(titles[k])))
    )
    raise BadInput(
        "{file} has no column {item!r}{nearest}; create the item in {platform} first, then export",
        file=source,
        item=item,
        nearest=nearest(item, names),
        platform=platform.title_of_platform,
    )


def _most(platform: PlatformGradebook, sheet: _Sheet, stated: float | None, source: Path) -> float | None:
    """Return the item's maximum: that in the file, which must agree with the stated one."""
    text = platform.most_in(sheet.title) if sheet.maxima is None else _cell(sheet.maxima, sheet.column)
    try:
        in_file = float(text.replace(",", ".")) if text else None
    except ValueError:
        in_file = None
    if in_file is not None and stated is not None and in_file != stated:
        raise BadInput(
            (
                "{file} states that {column} is out of {maximum:g}, and --out-of states {stated:g}: "
                "omit the option, "
                "or change the item"
            ),
            file=source,
            column=sheet.title,
            maximum=in_file,
            stated=stated,
        )
    return stated if in_file is None else in_file


def _check_alike(scored: Iterable[Scored], platform: PlatformGradebook, item: str) -> None:
    totals = sorted({student.out_of for student in scored if student.out_of})
    if len(totals) > 1:
        raise BadInput(
            (
                "the class has points out of {totals}, and the export of {platform} does not state the "
                "maximum of "
                "{item!r}: state it, --out-of 20"
            ),
            totals=joined_by_and(totals[:3]),
            platform=platform.title_of_platform,
            item=item,
        )


def _points(student: Scored, filled: Filled) -> str:
    points = student.of(filled.most)
    limit = filled.most if filled.most is not None else float(student.out_of or "inf")
    if not 0 <= float(points) <= limit:
        raise BadInput(
            "{name} has {points}, and {column} is out of {limit:g}: the platform would refuse the "
            "file, and nothing is written",
            name=student.name,
            points=points,
            column=filled.column,
            limit=limit,
        )
    return points


def _sign_in(sheet: _Sheet) -> str:
    """Return the decimal sign of the marks in a file; empty if no mark has decimals."""
    texts = (cell.text for row in sheet.rows for cell in row[sheet.people.last + 1 :])
    signs = [match["sign"] for text in texts if (match := _NUMBER.fullmatch(text))]
    return max("".join(dict.fromkeys(signs)), key=signs.count, default="")


# ------------------------------------------------------------------------ people


def _matched(sheet: _Sheet, scored: Sequence[Scored], filled: Filled) -> list[Scored | None]:
    """Return the student of each line: matched by e-mail or number, else by a name that only one line and one
    student have."""
    ids = _only((same_id(_cell(row, k)), n) for n, row in enumerate(sheet.rows) for k in sheet.people.ids)
    names = _only((words_of(_name(row, sheet.people)), n) for n, row in enumerate(sheet.rows))
    by_line: dict[int, Scored] = {}
    by_name = []
    for student in scored:
        lines = {line for _, value in student.ids if (line := ids.get(same_id(value))) is not None}
        if len(lines) == 1 and not lines & by_line.keys():
            by_line[lines.pop()] = student
        elif lines:
            filled.unclear.append(student.name)
        else:
            by_name.append(student)
    for student in by_name:
        words = words_of(student.name)
        line = names.get(words)
        if line is not None and line not in by_line and not _differs(sheet.rows[line], sheet.people, student):
            by_line[line] = student
        else:
            (filled.unclear if words in names and line is None else filled.strangers).append(student.name)
    return [by_line.get(n) for n in range(len(sheet.rows))]


def _differs(row: Sequence[PositionedCell], people: People, student: Scored) -> bool:
    """Return True if both have an e-mail and these differ; the same name is then that of two people."""
    there = {same_id(_cell(row, k)) for k in people.ids if "@" in _cell(row, k)}
    stated = {same_id(value) for _, value in student.ids if "@" in value}
    return bool(there and stated and not there & stated)


def _only(pairs: Iterable[tuple[object, int]]) -> dict[object, int | None]:
    """Return the line of each key that only one line has; None for a key that several have."""
    lines: dict[object, int | None] = {}
    for key, line in pairs:
        if key:
            lines[key] = line if lines.get(key, line) == line else None
    return lines
