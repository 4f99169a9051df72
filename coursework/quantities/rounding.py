"""Effect of rounding at each step on an answer, for a student who keeps a few digits.

A student who writes every intermediate value down to ``digits`` significant digits does everything right, and
lands beside the reference. How far at most is the *envelope*: the marking widens its tolerance to it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from coursework.quantities.graph import Graph

#: Rounding errors compound a little beyond their first order.
_BEYOND_FIRST_ORDER = 1.1


def rounded(value: Any, digits: int) -> Any:
    """Round numbers to significant digits, element by element; leave anything else unchanged."""
    if isinstance(value, tuple):
        parts = [rounded(part, digits) for part in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    if isinstance(value, (str, bool)) or not _is_number(value):
        return value
    if np.iscomplexobj(value):
        return rounded(np.real(value), digits) + 1j * rounded(np.imag(value), digits)
    if isinstance(value, (int, float)):
        return float(f"{value:.{digits - 1}e}") if math.isfinite(value) else value
    array = np.asarray(value)
    if array.dtype.kind != "f":
        return value
    step = 2 * half_step(array, digits)
    with np.errstate(all="ignore"):
        return np.where(step > 0, np.rint(array / step) * step, array)[()]


def half_step(value: Any, digits: int) -> Any:
    """Return half of the last of ``digits`` significant digits, the largest change by rounding; 0 for 0.

    A number that a last bit keeps below a power of ten has the digits of the power.
    """
    if isinstance(value, float) and 0 < abs(value) < math.inf:  # one number costs a tenth so
        return 0.5 * 10.0 ** (math.floor(math.log10(abs(value)) + 1e-12) + 1 - digits)
    size = np.abs(np.asarray(value, dtype=float))
    with np.errstate(all="ignore"):
        decade = np.floor(np.log10(np.where(size > 0, size, 1.0)) + 1e-12)
    return np.where(size > 0, 0.5 * 10.0 ** (decade + 1 - digits), 0.0)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, complex)) or (
        isinstance(value, (np.ndarray, np.generic)) and value.dtype.kind in "ifc"
    )


def student_who_rounds(
    graph: Graph, wanted: Sequence[str], given: Mapping[str, Any], effects: Iterable[str], digits: int
) -> dict[str, Any]:
    """Return the answers of a student who follows the textbook way and rounds each value written down.

    ``given`` holds scalars or arrays that broadcast. Errors are those of :meth:`Graph.evaluate`.
    """
    rounding = graph.textbook.observed(lambda name, value: rounded(value, digits))
    return rounding.evaluate(wanted, given, effects)


def envelope(
    graph: Graph,
    wanted: Sequence[str],
    given: Mapping[str, Any],
    effects: Iterable[str],
    digits: int,
    directions: Collection[str] = (),
) -> dict[str, np.ndarray]:
    """Return the largest distance of the student's answers from the reference, in the worst combination of
    roundings.

    ``given`` holds scalars or arrays of one shape ``(n,)``, cases among them. Each step is moved by half of
    its last digit, alone; the moves of an answer add up. ``directions`` are angles known up to a turn. Gives
    an array ``(n,)`` a quantity, in its unit: distances for vectors, amounts of angle for angles; 0 for cases
    and whole numbers, infinite or NaN where some step does not stand being moved.
    """
    wanted = tuple(wanted)
    textbook = graph.textbook
    count = max((np.size(v) for v in given.values() if np.ndim(v)), default=1)
    columns, still = _columns(textbook, wanted, given, effects)
    spread = {n: _down(v, count) for n, v in given.items()}

    def moved(name: str, value: Any) -> Any:
        for column, part in columns.get(name, ()):
            value = _moved(value, part, column, len_all, digits)
        return value

    len_all = 1 + sum(len(places) for places in columns.values())
    result = textbook.observed(moved).evaluate(wanted, spread, effects)
    return {
        name: np.zeros(count) if name in still else _total(value, count, name in directions)
        for name, value in result.items()
    }


def _down(value: Any, count: int) -> Any:
    """Return a given value as a column, so that the moves lie along the rows."""
    if isinstance(value, str):
        return value
    return np.broadcast_to(np.asarray(value), (count,))[:, None] if np.ndim(value) else value


def _columns(
    graph: Graph, wanted: Sequence[str], given: Mapping[str, Any], effects: Iterable[str]
) -> tuple[dict[str, list[tuple[int, Any]]], frozenset[str]]:
    """Return for each step the columns in which it is moved, and the component moved there; and the constant
    matrices, which are not moved.

    One column for a number, two for a complex one, one a coordinate of a vector, one an entry of a matrix.
    """
    first = {n: (v if isinstance(v, str) or not np.ndim(v) else v[:1]) for n, v in given.items()}
    names = [n for n in graph.plan(tuple(wanted), frozenset(given), effects) if not n.startswith("_")]
    values = graph.evaluate(names, first, effects)
    columns: dict[str, list[tuple[int, Any]]] = {}
    still: set[str] = set()
    has_axis = any(np.ndim(v) for v in given.values())
    column = 1
    for name in names:
        value = values[name]
        if isinstance(value, (str, bool, int, tuple)) or not _is_number(value):
            continue
        matrix = _matrix_shape(value, has_axis)
        if matrix == () and np.ndim(value) > 1:
            still.add(name)
            continue
        if matrix:
            parts: list[Any] = list(np.ndindex(*matrix)) if np.asarray(value).dtype.kind == "f" else []
        elif np.iscomplexobj(value):
            parts = ["real", "imag"]
        elif np.asarray(value).dtype.kind != "f":
            continue
        else:
            # Numbers are single, or one in an array of one variant; anything longer is a vector.
            is_vector = np.ndim(value) == 2 or (np.ndim(value) == 1 and np.shape(value) != (1,))
            parts = list(range(np.shape(value)[-1])) if is_vector else [None]
        columns[name] = [(column + i, part) for i, part in enumerate(parts)]
        column += len(parts)
    return columns, frozenset(still)


def _matrix_shape(value: Any, has_axis: bool) -> tuple[int, ...] | None:
    """Return the shape of a matrix of the first variant; ``()`` for one that does not vary, None for no
    matrix.

    Where something ``has_axis``, what varies has an axis of variants before its own, of length 1 here.
    """
    shape = np.shape(value)
    if not has_axis:
        return shape if len(shape) == 2 else None
    if len(shape) == 3:
        return shape[1:]
    return () if len(shape) == 2 and shape[0] != 1 else None


def _moved(value: Any, part: Any, column: int, width: int, digits: int) -> Any:
    """Return the value with one column of it moved by half of its last digit."""
    vector = isinstance(part, int)
    value = np.asarray(value)
    if isinstance(part, tuple):
        base = value if value.ndim == 4 else value.reshape(-1, 1, *value.shape[-2:])
        full = np.array(np.broadcast_to(base, (len(base), width, *base.shape[-2:])))
        full[:, column, *part] += half_step(full[:, column, *part], digits)
        return full
    if vector:
        base = value if value.ndim == 3 else value.reshape(1, 1, -1)
        full = np.array(np.broadcast_to(base, (len(base), width, base.shape[-1])))
        full[:, column, part] += half_step(full[:, column, part], digits)
        return full
    lead = value.shape[0] if value.ndim == 2 else 1
    full = np.array(np.broadcast_to(value, (lead, width)))
    if part == "imag":
        full[:, column] += 1j * half_step(full[:, column].imag, digits)
    else:
        full[:, column] += half_step(full[:, column].real, digits)
    return full


def _total(value: Any, count: int, is_direction: bool) -> np.ndarray:
    """Return the sum of the moves of an answer, from its first column, which is not moved, to the others."""
    value = np.asarray(value)
    if value.dtype.kind not in "fc" or value.ndim < 2:
        return np.zeros(count)
    if value.ndim >= 3:
        value = value.reshape(*value.shape[:2], -1)
        moves = np.linalg.norm(value - value[:, :1], axis=-1)
    else:
        moves = np.abs(value - value[:, :1])
        if is_direction:
            moves = np.minimum(moves, np.abs(moves - 360.0))
    with np.errstate(all="ignore"):
        return np.broadcast_to(_BEYOND_FIRST_ORDER * moves.sum(axis=1), (count,))
