"""Twists and wrenches as people write them: ``{0 10; 0 20; 5 0}``, ``{0 0 5 | 10 20 0}_A``, two lists, six
numbers.

A torsor has six cells, those of its resultant before those of its moment; a plane one keeps three of them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from coursework.parsing.digits import in_unit
from coursework.parsing.points import read_point
from coursework.parsing.reading import Reading, Stop, text_of
from coursework.parsing.spelling import plain_spelling, shorten, spelled_out, tidy, unwrapped
from coursework.parsing.units import parse_unit, plain_unit, same_dimension
from coursework.parsing.vocabulary import MAX_LENGTH, Unreadable

_MOST = 10 * MAX_LENGTH  #: characters of a torsor
_MOST_NESTED = 8  #: brackets about all of it


class TorsorForm(NamedTuple):
    """Layout of a sort of torsor: the names of its cells, the cells of a plane one in the order in which they
    are asked, and the words for its two columns."""

    names: tuple[str, ...]
    plane: tuple[int, ...]
    resultant: re.Pattern[str]
    moment: re.Pattern[str]
    component: re.Pattern[str]


TWIST = TorsorForm(
    ("wx", "wy", "wz", "vx", "vy", "vz"),
    (3, 4, 2),
    re.compile(r"\s*(?:vec|overrightarrow|\{|\s)*(?:o?mega|w|rot)", re.I),
    re.compile(r"\s*(?:vec|overrightarrow|\{|\s)*v", re.I),
    re.compile(r"(?P<half>w|omega|v)_?\{?(?P<axis>[xyz])(?:_?\d\w*|_[A-Z]\w?)?(?:[,/]\d+)*'?", re.I),
)
WRENCH = TorsorForm(
    ("X", "Y", "Z", "L", "M", "N"),
    (0, 1, 5),
    re.compile(r"\s*(?:vec|overrightarrow|\{|\s)*[rf]", re.I),
    re.compile(r"\s*(?:vec|overrightarrow|\{|\s)*m", re.I),
    re.compile(
        r"(?P<name>[XYZLMN])(?:_?\d\w*|_[A-Z]\w?)?(?:[,/]\d+)*'?"
        r"|(?P<half>[FRM])_?(?P<axis>[xyz])(?:_?\d\w*|_[A-Z]\w?)?(?:[,/]\d+)*'?"
    ),
)


class _Cells(NamedTuple):
    """The cells of a text by place, none at those that a plane torsor leaves out, and what stands behind
    them."""

    texts: tuple[str | None, ...]
    behind: str


def read_torsor(answer: Any, form: TorsorForm, units: tuple[str, str], count: int) -> Reading:
    """Return the components of a torsor in ``units``, those of its resultant and of its moment, as arrays of
    shape ``(count,)``.

    ``count`` is 6, resultant before moment, or 3 for a plane one in the order of ``form.plane``. A unit
    stands in a cell, behind a column for all of it, or behind the brackets, where it goes to the column that
    it fits.
    """

    def read(text: str) -> Reading:
        cells = _cells(text, form, plane=count == 3, symbols=False)
        own_units = _units_behind(cells.behind, units)
        columns = [
            _column(cells.texts[3 * half : 3 * half + 3], own_units[half], units[half]) for half in (0, 1)
        ]
        for column in columns:
            if column is not None and column.status != "read":
                return Reading(
                    text, column.status, code=column.code, found=shorten(column.found or column.text)
                )
        return _both(text, columns, form.plane if count == 3 else tuple(range(6)), bool(cells.behind))

    return _read_cells(answer, read)


def read_pattern(answer: Any, form: TorsorForm) -> Reading:
    """Return the components that an answer says may differ from zero: a ``frozenset`` of names of ``form``.

    A table as that of :func:`read_torsor`, with 0 where nothing can be and a symbol, ``*``, a number or
    ``free`` where something may; a dash stands where a plane torsor says nothing. Or the names alone,
    ``wz, vx``; ``0`` for none. Other words are not read, nor are symbols in a row that neither brackets nor a
    0 make a table.
    """

    def read(text: str) -> Reading:
        components = _named_components(text, form)
        if components is None:
            components = _marked(text, form)
        order = [name for name in form.names if name in components]
        return Reading(text, "read", (frozenset(components),), (", ".join(order) or "0",))

    return _read_cells(answer, read)


def _read_cells(answer: Any, read: Callable[[str], Reading]) -> Reading:
    """Read any torsor with ``read``; treat a missing answer, one that is too long, and one that breaks
    off."""
    text = _as_text(answer)
    if not text.strip():
        return Reading(text, "missing")
    if len(text) > _MOST:
        return Reading(text, "unreadable", code="too_long", found=shorten(text))
    try:
        reading = read(text)
    except (Stop, Unreadable) as stop:
        status = stop.status if isinstance(stop, Stop) else "unreadable"
        return Reading(text, status, code=stop.code, found=shorten(stop.found or text))
    return reading


def _as_text(answer: Any) -> str:
    """Return the text of an answer; lists in brackets, a mapping by its names."""
    if isinstance(answer, (np.ndarray, np.generic)):
        answer = answer.tolist()
    if answer is None:
        return ""
    if isinstance(answer, (set, frozenset)):
        return ", ".join(sorted(map(text_of, answer))) or "0"
    if isinstance(answer, Mapping):
        return "; ".join(f"{text_of(name)} = {_as_text(value)}" for name, value in answer.items())
    if isinstance(answer, (list, tuple)) and not answer:
        return "{ }"
    if isinstance(answer, (list, tuple)):
        return "[" + " ; ".join(map(_as_text, answer[:_MOST])) + "]"
    return answer if isinstance(answer, str) else text_of(answer)


# ------------------------------------------------------------------------- cells

_GRID = re.compile(
    r"\\(?P<side>begin|end)\s*\{(?:[pbBvV]?matrix\*?|smallmatrix|array)\}(?:\s*\{[lcr|\s]*\})?"
    r"|\\(?:left|right|displaystyle)(?![A-Za-z])\s*\.?"
)
_BRACE = {"begin": "{", "end": "}", None: " "}
_ROW_END = re.compile(r"\\\\(?:\[[^\]]*\])?|\\cr(?![a-z])")
_BAR = re.compile(r"\\(?:mid|vert|middle\s*\|)(?![A-Za-z])")
_TITLE = re.compile(r"[^=;\n]{0,80}=\s*(?=[\[({])")
_POINT_BEFORE = re.compile(r"_?\{?[A-Z]\d?'?\}?\s*(?=[\[({])")
_CALLED = re.compile(r"(?:(?:np|numpy)\s*\.\s*)?(?:array|matrix|Matrix)\s*\(\s*(.*?)\s*\)", re.S)
_GROUP = re.compile(r"[\[({]([^\[\](){}]*)[\])}]")
_ANOTHER_GROUP = re.compile(r"[\s,;|]*(?:[^\W\d][^=\[({|;]*=\s*)?[\[({]")
_INDEX = re.compile(
    r"\s*_?\s*(?:\(\s*[A-Z]\w?'?\s*(?:[,;]\s*\w+\s*)?\)|\{[\w\s,()/']{0,20}\}|[A-MO-Z]\d?'?(?:\s*,"
    r"\s*R\w?)?(?![\w/*^]))"
)


_COMMA_OF_ROWS = re.compile(r",\s+|\s+,|,(?=[^\W\d_])")


def _cells(text: str, form: TorsorForm, *, plane: bool, symbols: bool) -> _Cells:
    """Return the cells of a text, whichever way it is laid out."""
    inside, behind = _opened(_laid_out(text))
    groups = _groups(inside, form) or _columns(inside)
    if groups is not None and len(groups) == 2:
        halves = [_entries(group, (3,), symbols=symbols) for group in groups]
        if None not in halves:
            return _Cells(_counted_cells((*(halves[0] or ()), *(halves[1] or ())), form, plane=plane), behind)
    rows = groups or [row for row in re.split(r"[;\n]", inside) if row.strip(" ,")]
    if len(rows) == 1 and [len(row.split()) for row in re.split(_COMMA_OF_ROWS, inside)] == [2, 2, 2]:
        rows = re.split(_COMMA_OF_ROWS, inside)  # {0 vx, wy 0, 0 vz}
    cells = _of_rows(rows, plane=plane, symbols=symbols, commas=bool(groups) or not plane)
    if cells is None:
        raise Stop("wrong_torsor", text)
    if len(cells) == 3:
        places = dict(zip(form.plane, cells, strict=True))
        return _Cells(tuple(_by_name([places.get(index) for index in range(6)], form)), behind)
    return _Cells(_counted_cells(_by_name(cells, form), form, plane=plane), behind)


def _counted_cells(cells: Sequence[str | None], form: TorsorForm, *, plane: bool) -> tuple[str | None, ...]:
    """Return the cells that count: in the plane, those that a plane torsor has."""
    return tuple(cell if index in form.plane or not plane else None for index, cell in enumerate(cells))


def _laid_out(text: str) -> str:
    """Rows on lines and columns parted by bars, without LaTeX's and Python's own marks."""
    text = unwrapped(text).strip().strip("$").strip()
    text = _GRID.sub(lambda groups: _BRACE[groups["side"]], _ROW_END.sub("\n", text))
    text = _BAR.sub("|", text).replace(r"\{", "{").replace(r"\}", "}").replace("&", "|")
    text = "\n".join(map(tidy, text.splitlines())).strip()
    if match := _CALLED.fullmatch(text):
        text = match[1]
    text = text[title.end() :] if (title := _TITLE.match(text)) and _is_title(title[0]) else text
    text = text[point.end() :] if (point := _POINT_BEFORE.match(text)) else text
    return text.strip()


def _is_title(text: str) -> bool:
    """Return whether the text before an equals sign names the torsor as a whole, and holds no cells
    itself."""
    return not re.search(r"(?<![\w/_{])\d", text)


def _opened(text: str, nested: int = 0) -> tuple[str, str]:
    """Return the text inside the outer brackets, and the units behind them."""
    if nested > _MOST_NESTED:
        raise Stop("wrong_torsor", text)
    end = _end_of_first(text)
    behind = text[end + 1 :]
    if text[:1] not in ("[", "(", "{") or end < 0 or _ANOTHER_GROUP.match(behind):
        return text, ""
    if not any(mark in text[1:end] for mark in " ;,|\n[({"):
        return text, ""
    behind = _INDEX.sub("", behind, count=1) if _INDEX.match(behind) else behind
    inside, more = _opened(text[1:end].strip(), nested + 1)
    return inside, f"{more} {behind}".strip(" .")


def _end_of_first(text: str) -> int:
    """Return the index at which the bracket that a text begins with closes; -1 where it does not."""
    depth = accumulate((char in "[({") - (char in "])}") for char in text)
    return next((index for index, open_ in enumerate(depth) if open_ == 0), -1)


def _groups(text: str, form: TorsorForm) -> list[str] | None:
    """Cells that stand in brackets, a column or a row each; the resultant first where they are named."""
    inner = [match[1] for match in _GROUP.finditer(text)]
    between = [piece.strip(" ,;|\n=:") for piece in _GROUP.split(text)[::2]]
    if len(inner) not in (2, 3) or any(re.search(r"\d", piece) and "/" not in piece for piece in between):
        return None
    if any(re.search(r"[*^+]|frac|sqrt", piece) for piece in between):
        return None
    if len(inner) == 2:
        first, second = (spelled_out(piece).strip(" \\") for piece in between[:2])
        if form.moment.match(first) or form.resultant.match(second):
            inner.reverse()
        if behind := between[2]:
            inner[1] = f"{inner[1]} {behind}"
    return inner


def _columns(text: str) -> list[str] | None:
    """Return the two columns on either side of the only bar."""
    return text.split("|") if text.count("|") == 1 else None


def _of_rows(rows: Sequence[str], *, plane: bool, symbols: bool, commas: bool) -> list[str] | None:
    """Return the cells of rows: two of three, three of two, one of six or six of one; three alone in the
    plane.

    Without ``commas``, a bare one in a row of three is decimal: ``1,5; 2,5; 3,5`` are three numbers.
    """
    if len(rows) == 1:
        return _entries(rows[0], (6, 3) if plane else (6,), symbols=symbols)
    for wanted in {2: (3,), 3: (2, 1) if plane else (2,), 6: (1,)}.get(len(rows), ()):
        commas = commas or len(rows) != 3
        entries = [_entries(row, (wanted,), symbols=symbols, commas=commas) for row in rows]
        if None not in entries:
            readable = [row for row in entries if row is not None]
            return (
                [c for r in readable for c in r]
                if len(rows) != 3
                else [c for k in zip(*readable, strict=True) for c in k]
            )
    return None


def _entries(text: str, counts: Sequence[int], *, symbols: bool, commas: bool = True) -> list[str] | None:
    """Return a row or a column cut into one of the counts of cells, the likeliest cut first."""
    text = text.strip(" \n")
    if (bare := _GROUP.fullmatch(text)) and counts != (1,):
        text = bare[1]
    text = re.sub(r"\s*=\s*", "=", text.strip(" ,;\n"))
    for pieces in _cuts(text, symbols=symbols, commas=commas):
        entries = [piece.strip() for piece in pieces]
        if len(entries) in counts:
            return entries
    return None


def _cuts(text: str, *, symbols: bool, commas: bool) -> Iterator[list[str]]:
    yield [text]
    if "|" in text:
        yield text.split("|")
    if ";" in text or "\n" in text:
        yield re.split(r"[;\n]", text)
    yield re.split(r",\s+|\s+,\s*", text)
    tokens = re.sub(r",\s|\s,", " ", text).split()
    if not symbols:
        yield _merged(tokens, signs=True)
        tokens = _merged(tokens, signs=False)
    yield tokens
    if commas:
        yield text.split(",")


_GOES_ON = re.compile(r"[^\W\d_]|[°%/*^)\]]")


def _merged(tokens: Sequence[str], *, signs: bool) -> list[str]:
    """Tokens between blanks, units and operators put back behind the number that they belong to."""
    merged: list[str] = []
    for token in tokens:
        begins = not _GOES_ON.match(token) or ("=" in token and token[-1] != "=")
        open_before = bool(merged) and (merged[-1][-1] in "*/(^" or (signs and merged[-1] in "+-"))
        if merged and (not begins or open_before):
            merged[-1] = f"{merged[-1]}{'' if merged[-1] in '+-' else ' '}{token}"
        else:
            merged.append(token)
    return merged


def _by_name(cells: Sequence[str | None], form: TorsorForm) -> list[str | None]:
    """Return the cells at the places that they name, where each of them names one: ``wz = 5``."""
    named = [cell.partition("=")[0] if cell and "=" in cell else "" for cell in cells]
    places = [component_place(name, form) if name else None for name in named]
    placed = [index for index in places if index is not None]
    if len(placed) != sum(cell is not None for cell in cells) or len(set(placed)) != len(placed):
        return list(cells)
    by_index: list[str | None] = [None] * 6
    for index, cell in zip(places, cells, strict=True):
        if index is not None and cell is not None:
            by_index[index] = cell
    return by_index


def component_place(text: str, form: TorsorForm) -> int | None:
    """Return the place of the component that a text names, ``ω_z``, ``\\omega_z``, ``M``, ``Mz``; nothing
    where it names none."""
    spelled = spelled_out(plain_spelling(text))
    if not re.fullmatch(r"[^{}]*(?:\{[^{}]*\}[^{}]*)*", spelled):
        return None
    name = re.sub(r"[\s{}\\$]", "", spelled)
    match = form.component.fullmatch(name)
    if match is None:
        return None
    parts = match.groupdict()
    if parts.get("name"):
        return "XYZLMN".index(parts["name"])
    return 3 * (parts["half"] in "vVM") + "xyz".index(parts["axis"].lower())


# ------------------------------------------------------------------------ values


def _units_behind(text: str, units: tuple[str, str]) -> tuple[str, str]:
    """Return the units behind the brackets, each for the column of its kind; ``SI`` for both."""
    text = plain_spelling(text).strip(" ()[]{}.")
    if text.upper() in ("SI", "S.I", "USI"):
        return units[0], units[1].replace("mm", "m")
    own_units = ["", ""]
    for piece in re.split(r"\s*[;,|&]\s*|\s+(?:et|and|puis)\s+|\s+", text):
        unit = plain_unit(piece) if piece else None
        if piece and unit is None:
            raise Stop("unknown_unit", piece)
        if unit is not None:
            fits = [half for half in (0, 1) if same_dimension(unit, parse_unit(units[half]))]
            if not fits:
                in_unit(0.0, unit, parse_unit(units[1]))
            own_units[fits[0]] = piece
    return own_units[0], own_units[1]


def _column(cells: Sequence[str | None], stated: str, unit: str) -> Reading | None:
    """Return the cells of one column, in its unit."""
    filled = [cell for cell in cells if cell is not None]
    if not filled:
        return None
    empty = next((cell for cell in filled if cell in ("", "-", "+")), None)
    if empty is not None:
        raise Stop("wrong_torsor", " ".join(filled))
    if len(filled) == 1:
        from coursework.parsing.numbers import read_number

        reading = read_number(f"{filled[0]} {stated}".strip(), unit)
        values = tuple((value,) for value in reading.values)
        return Reading(
            reading.text,
            reading.status,
            values,
            reading.read_as,
            reading.unit_given,
            reading.code,
            reading.found,
        )
    return read_point(f"({' ; '.join(filled)}) {stated}".strip(), unit, len(filled))


def _both(text: str, columns: Sequence[Reading | None], order: Sequence[int], behind: bool) -> Reading:
    """Both columns as one array in an order of cells; two readings where a column has two."""
    ways: dict[bytes, tuple[np.ndarray, str]] = {}
    places = [sorted(index for index in order if index // 3 == half) for half in (0, 1)]
    for which in (0, -1):
        components = np.zeros(6)
        for column, column_places in zip(columns, places, strict=True):
            if column is not None:
                components[column_places] = column.values[which]
        value = components[list(order)]
        ways.setdefault(value.tobytes(), (value, _echo(columns, which, order)))
    values, echoes = zip(*ways.values(), strict=True)
    given = behind or any(column.unit_given for column in columns if column is not None)
    return Reading(text, "read", values, echoes, given)


def _echo(columns: Sequence[Reading | None], which: int, order: Sequence[int]) -> str:
    """Both columns as they were read, ``{0; 0; 5} {10; 20; 0}``; three components in the order in which they
    are asked."""
    echoes = [re.sub(r"^\(|\)", "", column.read_as[which]) for column in columns if column is not None]
    if len(order) == 3:
        return "(" + "; ".join(echoes if order[0] < 3 else echoes[::-1]) + ")"
    return " ".join(f"{{{echo}}}" for echo in echoes)


# ---------------------------------------------------------------------- patterns

_GREEK = (
    "alpha|beta|gamma|delta|epsilon|zeta|eta|theta|iota|kappa|lambda|mu|nu|xi|omicron|pi|rho|sigma|tau"
    "|upsilon|phi|chi|psi|o?mega"
)
_NONE = re.compile(
    r"0|∅|(?:none|nothing|zero|null?|nulle?|aucune?|rien|z[ée]ro|tout(?:es)?\s+nulle?s)\.?", re.I
)
_ZERO = re.compile(r"[+-]?0+(?:[.,]0*)?|(?:zero|z[ée]ro|nulle?|null|nil|none|no|non)", re.I)
_FREE = re.compile(
    r"libres?|free|oui|yes|variables?|quelconques?|any|inconnue?s?|unknown|non[- ]?nulle?s?|non[- ]?zero",
    re.I,
)  #: words in a cell for what may differ from zero
_MARK = re.compile(r"[+-]?\\?[^\W_][\w\\{},'/=.*]{0,20}|[*?≠]{1,2}0?", re.I)  #: a symbol, a number, a star
_LETTERS = re.compile(r"[^\W\d_]+")
_SYMBOL = re.compile(rf"(?:[a-z]|{_GREEK})[xyz]?", re.I)
_TABLE = re.compile(r"[\[({;|\n&]|\\\\")  #: what makes a table of cells
_DASHES = ("", "-", "--", ".", "/")


def _named_components(text: str, form: TorsorForm) -> set[str] | None:
    """Return the components of a list of names alone; nothing where it is something else."""
    plain = tidy(unwrapped(text)).strip().strip("{}[]()$.").strip()
    if _NONE.fullmatch(plain) or (not plain and re.fullmatch(r"\\?\{\s*\\?\}", text.strip())):
        return set()
    if not plain:
        return None
    pieces = [piece for piece in re.split(r"\s*[,;|\n]\s*|\s+(?:et|and)\s+|\s+", plain) if piece]
    places = [component_place(piece, form) for piece in pieces]
    named = [index for index in places if index is not None]
    return {form.names[index] for index in named} if named and len(named) == len(pieces) else None


def _marked(text: str, form: TorsorForm) -> set[str]:
    """Return the components of a table that hold something else than 0."""
    try:
        (cells, behind), plane = _cells(text, form, plane=False, symbols=True), False
    except Stop:
        (cells, behind), plane = _cells(text, form, plane=True, symbols=True), True
    if behind:
        raise Stop("wrong_torsor", text)
    stripped = [None if cell is None else cell.strip(" ()[]{}") for cell in cells]
    is_table = bool(_TABLE.search(text))
    has_dashes = any(cell in _DASHES for cell in stripped)
    if has_dashes and not (is_table and (plane or _dashed_as_plane(cells, form))):
        raise Stop("wrong_torsor", text)
    written = {form.names[index]: cell for index, cell in enumerate(stripped) if cell and cell not in _DASHES}
    if not written or ("≠" in written.values() and not is_table):  # && says nothing, 0 ≠ 1 is not a row
        raise Stop("wrong_torsor", text)
    marked = {name: cell for name, cell in written.items() if not _ZERO.fullmatch(cell)}
    has_zero = len(marked) < len(written) or all(
        component_place(c, form) is not None for c in marked.values()
    )
    if not all(map(_is_mark, marked.values())) or not (
        has_zero or (is_table and len(written) == len(form.names))
    ):
        raise Stop("wrong_torsor", text)
    return set(marked)


def _is_mark(cell: str) -> bool:
    """Return whether a cell marks a component that may differ from zero: a symbol, a product of symbols, a
    number, a star, ``free``."""
    if _FREE.fullmatch(cell):
        return True
    return bool(_MARK.fullmatch(cell)) and all(map(_SYMBOL.fullmatch, _LETTERS.findall(_plain_symbols(cell))))


def _plain_symbols(cell: str) -> str:
    """Return a cell with its Greek letters spelled, indices and LaTeX's commands of form left out."""
    cell = re.sub(r"\\(?:mathrm|mathit|text|vec|overrightarrow|dot|cdot|times)(?![A-Za-z])", " ", cell)
    return re.sub(r"_\{[^{}]*\}|_\w+", " ", spelled_out(cell))


def _dashed_as_plane(cells: Sequence[str | None], form: TorsorForm) -> bool:
    """Return whether dashes stand exactly in the cells that a plane torsor leaves empty."""
    dashed = {index for index, cell in enumerate(cells) if cell is not None and cell.strip() in _DASHES}
    return dashed.isdisjoint(form.plane)
