"""Functions of one mechanism, applied to one or to many."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from coursework.errors import WrongValue


def each(function: Callable[..., Any], *arguments: Any, dtype: Any = object) -> Any:
    """Evaluate ``function``; element by element where some arguments are arrays, which broadcast.

    Lists and records are single values. ``dtype`` is that of the array of results: ``int``, ``str``, or
    objects.
    """
    arrays = [np.asarray(a) for a in arguments if isinstance(a, np.ndarray)]
    if not arrays:
        return function(*arguments)
    shape = np.broadcast_shapes(*[a.shape for a in arrays])
    columns = [np.broadcast_to(a, shape).ravel() if isinstance(a, np.ndarray) else a for a in arguments]
    result = np.empty(int(np.prod(shape)), dtype=object)
    for index in range(result.size):
        result[index] = function(*[c[index] if isinstance(c, np.ndarray) else c for c in columns])
    return result.reshape(shape) if dtype is object else result.reshape(shape).astype(dtype)


def each_stacked(read: Callable[[Any], Any], stacked: Any) -> Any:
    """Evaluate ``read`` on a single object, or on each of an array of objects; vectors lie along a last
    axis."""
    if not isinstance(stacked, np.ndarray):
        return read(stacked)
    if stacked.dtype != object or not stacked.size:
        raise WrongValue(
            "joints is a list of joints, each a mapping; found {stacked!r}", stacked=str(stacked)[:60]
        )
    result = np.array([read(item) for item in stacked.ravel()])
    return result.reshape(stacked.shape + result.shape[1:])


def vector(*entries: Any) -> np.ndarray:
    """Return a vector of entries that broadcast, shape ``(..., n)``: the entries along a last axis."""
    return np.stack(np.broadcast_arrays(*(np.asarray(e, dtype=float) for e in entries)), axis=-1)


def matrix(*rows: Sequence[Any]) -> np.ndarray:
    """Return a matrix of rows of entries that broadcast, shape ``(..., m, n)``.

    Raises
    ------
    WrongValue
        Rows of different lengths.
    """
    lengths = {len(row) for row in rows}
    if len(lengths) != 1:
        raise WrongValue("the rows of a matrix have one length; found {lengths}", lengths=sorted(lengths))
    entries = np.broadcast_arrays(*(np.asarray(e, dtype=float) for row in rows for e in row))
    return np.stack(entries, axis=-1).reshape(*entries[0].shape, len(rows), lengths.pop())


def cases(**holds: Any) -> Any:
    """Return the names of the true conditions, as the answer to several choices: ``"stable fast"``, or an
    array of such."""

    def named(*which: Any) -> str:
        return " ".join(name for name, is_so in zip(holds, which, strict=True) if is_so)

    return each(named, *holds.values(), dtype=str)
