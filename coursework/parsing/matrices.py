"""Vectors and matrices as people write them: lists, rows on lines, semicolons between rows, LaTeX."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from coursework.parsing.digits import in_unit
from coursework.parsing.numbers import says_value, target_unit
from coursework.parsing.points import read_point
from coursework.parsing.reading import Reading, Stop, text_of
from coursework.parsing.spelling import plain_spelling, shorten, unwrapped
from coursework.parsing.units import Unit, plain_unit
from coursework.parsing.vocabulary import MAX_LENGTH

_MOST = 20 * MAX_LENGTH  #: characters of a matrix
_MOST_ENTRIES = 400

_GRID = re.compile(
    r"\\left\s*[(\[|.]?\s*|\\right\s*[)\]|.]?|\\(?:begin|end)\s*\{(?:[pbvBV]?matrix\*?|smallmatrix"
    r"|array)\}(?:\s*\{[lcr|\s]*\})?"
)
_IS_GRID = re.compile(r"\\begin\s*\{")
_GRID_END = re.compile(r"\\end\s*\{[^{}]*\}(?:\s*\\right\s*[)\]|.])?")
_NAMED = re.compile(r"\s*(?:[^\W\d_]|\\)[^=:\[(]{0,39}[=:]\s*(?=\S)")
_CALLED = re.compile(r"\s*(?:(?:np|numpy)\s*\.\s*)?(?:array|matrix)\s*\(\s*(.*?)\s*\)\s*([^()]*)", re.S)
_INNER = re.compile(r"[\[({]([^\[\](){}]*)[\])}]")
_OUTER = re.compile(r"\s*[\[({<|](.*)[\])}>|]\s*([^\[\](){}|]*)", re.S)


def read_vector(answer: Any, unit: str, count: int) -> Reading:
    """Return the ``count`` entries of a vector, each value an array of shape ``(count,)`` in ``unit``.

    ``[1, 2, 3]``, ``(1 ; 2 ; 3) mm``, ``1; 2; 3``, entries on lines, a column of LaTeX, or a list, flat or of
    lists of one.
    """
    if _is_missing(answer):
        return Reading("" if answer is None else str(answer), "missing")
    text = _as_text(answer)
    if refused := _refused(text):
        return refused
    rows, behind = _rows(text)
    if _is_column(text) and len(rows) == count:
        reading = _read(text, rows, behind, unit, (count, 1))
        flat = tuple(value[:, 0] for value in reading.values)
        echoes = tuple(_flat(echo) for echo in reading.read_as)
        return Reading(text, reading.status, flat, echoes, reading.unit_given, reading.code, reading.found)
    if count == 1:
        return _as_arrays(text, _read(text, [rows[0]], behind, unit, (1, 1)), (1,))
    match = _CALLED.fullmatch(text)
    plain = f"{match[1]} {match[2]}" if match else text
    return _as_arrays(text, read_point(plain, unit, count), (count,))


def _is_column(text: str) -> bool:
    """Return whether each entry stands in brackets of its own, on a line of its own, or in a row of LaTeX."""
    return bool(_IS_GRID.search(text) or "\n" in text.strip() or len(_INNER.findall(text)) > 1)


def read_matrix(answer: Any, unit: str, shape: tuple[int, int]) -> Reading:
    """Return the entries of a matrix of a shape, each value an array of that shape in ``unit``.

    ``[[1, 2], [3, 4]]``, ``1 2; 3 4``, rows on lines, ``\\begin{pmatrix} 1 & 2 \\\\ 3 & 4 \\end{pmatrix}``,
    or a list of lists; a unit behind serves for all. A matrix of another shape has ``code`` ``wrong_shape``.
    """
    if _is_missing(answer):
        return Reading("" if answer is None else str(answer), "missing")
    text = _as_text(answer)
    if refused := _refused(text):
        return refused
    rows, behind = _rows(text)
    if len(rows) == 1 != shape[0] and shape[1] == 1:  # a column, its entries on one line
        rows = re.split(r"\s*;\s*|,\s+|\s+", rows[0].strip())
    return _read(text, rows, behind, unit, shape)


def _is_missing(answer: Any) -> bool:
    return answer is None or (isinstance(answer, str) and not answer.strip())


def _as_text(answer: Any) -> str:
    """Return the text of an answer; of a list, its rows in brackets."""
    if isinstance(answer, (np.ndarray, np.generic)):
        answer = answer.tolist()
    if isinstance(answer, (list, tuple)):
        return "[" + " ; ".join(_as_text(item) for item in answer[:_MOST_ENTRIES]) + "]"
    return answer if isinstance(answer, str) else text_of(answer)


def _refused(text: str) -> Reading | None:
    """Why a text is not looked into, if it is not."""
    if len(text) > _MOST:
        return Reading(text, "unreadable", code="too_long", found=shorten(text))
    if (named := _NAMED.match(unwrapped(text).strip().strip("$").strip())) and says_value(named[0]):
        return Reading(text, "unreadable", code="two_values", found=shorten(text))
    return None


def _rows(text: str) -> tuple[list[str], str]:
    """Return the rows of a text, each its entries as they stand, and what stands behind them all."""
    text = unwrapped(text).strip().strip("$").strip()
    text = text[match.end() :] if (match := _NAMED.match(text)) else text
    if _IS_GRID.search(text):
        return _grid(text)
    text, behind = (match[1], match[2]) if (match := _CALLED.fullmatch(text)) else (text, "")
    outer = _OUTER.fullmatch(text)
    inside = outer[1] if outer else text
    inner = _INNER.findall(inside)
    if inner and not _INNER.sub("", inside).strip(" ,;\n\r\t"):
        return inner, behind or (outer[2] if outer else "")
    inner = _INNER.findall(text)
    tail = _INNER.sub("\N{UNIT SEPARATOR}", text).rpartition("\N{UNIT SEPARATOR}")
    if len(inner) > 1 and not tail[0].replace("\N{UNIT SEPARATOR}", "").strip(" ,;\n\r\t"):
        return inner, tail[2]  # [1, 2]; [3, 4] mm
    behind = behind or (outer[2] if outer else "")
    lines = [line.strip(" ;,") for line in inside.splitlines() if line.strip(" ;,")]
    if len(lines) > 1:
        return lines, behind
    return [row for row in inside.split(";") if row.strip()] or [inside], behind


def _grid(text: str) -> tuple[list[str], str]:
    """Return the rows of LaTeX, their entries parted by semicolons."""
    ends = list(_GRID_END.finditer(text))
    behind = text[ends[-1].end() :] if ends else ""
    body = _GRID.sub(" ", text[: ends[-1].end()] if ends else text)
    rows = [row for row in re.split(r"\\\\|\\cr(?![a-z])", body) if row.strip()]
    return [row.replace("&", " ; ") for row in rows], behind


def _read(text: str, rows: Sequence[str], behind: str, unit: str, shape: tuple[int, int]) -> Reading:
    """Rows read entry by entry; two readings where entries have two, the same of every row."""
    target, source, stated = target_unit(unit), target_unit(unit), plain_spelling(behind).strip(" .;,*")
    try:
        if stated:
            source = _stated(stated, target)
    except Stop as stop:
        return Reading(text, stop.status, code=stop.code, found=shorten(stop.found))
    if len(rows) != shape[0]:
        return Reading(text, "unreadable", code="wrong_shape", found=shorten(text))
    readings = [_row(row, source.text if stated else unit, shape[1]) for row in rows]
    for reading in readings:
        if reading.status != "read":
            code = {"wrong_count": "wrong_shape"}.get(reading.code, reading.code)
            status = "unreadable" if reading.status == "missing" else reading.status
            return Reading(text, status, code=code or "wrong_shape", found=reading.found or shorten(text))
    ways: dict[bytes, tuple[np.ndarray, str]] = {}
    for which in (0, -1):
        value = np.array([reading.values[which] for reading in readings], dtype=float)
        if stated:
            value = np.vectorize(lambda v: in_unit(float(v), source, target))(value)
        echo = "(" + "; ".join(reading.read_as[which] for reading in readings) + ")"
        ways.setdefault(value.tobytes(), (value, f"{echo} {behind.strip()}".strip()))
    values, echoes = zip(*ways.values(), strict=True)
    given = bool(stated) or any(reading.unit_given for reading in readings)
    return Reading(text, "read", values, echoes, given)


def _stated(text: str, target: Unit) -> Unit:
    unit = plain_unit(text)
    if unit is None:
        raise Stop("unknown_unit", text)
    in_unit(0.0, unit, target)
    return unit


def _row(row: str, unit: str, count: int) -> Reading:
    """Return the entries of one row; a row of one entry is a number."""
    if count > 1:
        return read_point(f"({row})", unit, count)
    from coursework.parsing.numbers import read_number

    reading = read_number(row.strip(" ;,()[]"), unit)
    return Reading(
        reading.text,
        reading.status,
        tuple((value,) for value in reading.values),
        tuple(f"({echo})" for echo in reading.read_as),
        reading.unit_given,
        reading.code,
        reading.found,
    )


def _flat(echo: str) -> str:
    """Return the echo of a column as that of a vector: ``((1); (2)) mm`` is ``(1; 2) mm``."""
    return re.sub(r"\(([^()]*)\)(?=[;)])", r"\1", echo)


def _as_arrays(text: str, reading: Reading, shape: tuple[int, ...]) -> Reading:
    """Return the same reading with its values as arrays, and its text as it came."""
    values = tuple(np.array(value, dtype=float).reshape(shape) for value in reading.values)
    return Reading(
        text, reading.status, values, reading.read_as, reading.unit_given, reading.code, reading.found
    )
