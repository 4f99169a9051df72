"""Joints along the coordinate axes, as exercises draw them, and functions of them on columns of draws."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_NEXT = {"x": "y", "y": "z", "z": "x"}


def aligned(
    name: str, along: str, point: Sequence[float] = (0.0, 0.0, 0.0), between: Sequence[int] = (0, 1)
) -> dict[str, Any]:
    """The mapping of a joint whose direction is ``x``, ``y`` or ``z``.

    The direction is the axis, the normal of a joint that has no axis, and the line of a contact along a
    line, whose normal is then the axis that follows: y after x, z after y, x after z.
    """
    normal = _AXES[_NEXT[along] if name == "line_contact" else along]
    return {
        "between": list(between),
        "joint": name,
        "axis": list(_AXES[along]),
        "normal": list(normal),
        "point": [float(x) for x in point],
    }


def each_distinct(function: Callable[..., Any], *columns: Any) -> Any:
    """``function`` of each row of columns that broadcast, called once for each distinct row.

    Scalars give what the function gives. What is no number or truth value comes in an array of objects.
    """
    if not any(np.ndim(column) for column in columns):
        return function(*columns)
    arrays = np.broadcast_arrays(*[np.asarray(column) for column in columns])
    code = np.zeros(arrays[0].size, dtype=np.int64)
    for array in arrays:
        values, places = np.unique(array.ravel(), return_inverse=True)
        code = code * len(values) + places.ravel()
    _, first, rows = np.unique(code, return_index=True, return_inverse=True)
    flat = [array.ravel() for array in arrays]
    answers = [function(*[column[index].item() for column in flat]) for index in first]
    found = np.empty(len(answers), dtype=object)
    found[:] = answers
    if answers and all(isinstance(answer, (bool, int, float)) for answer in answers):
        found = np.array(answers)
    return found[rows.ravel()].reshape(arrays[0].shape)
