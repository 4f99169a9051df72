"""A course's rules of marking: ``[marking]`` in ``exercises/course.toml``, each with its usual value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from coursework.errors import BadCourse, nearest

#: Beyond these a variant is ill-conditioned: rounding alone may cost a student the answer.
ILL_SHARE, ILL_DEGREES = 0.03, 1.0


@dataclass(frozen=True)
class Rules:
    """``digits``: significant digits that a student keeps on the way; the tolerance is as wide as that
    may cost. ``follow_through`` and ``slip``: share of the points for a right method from an earlier wrong
    answer, and for a slip that nobody declared."""

    digits: int = 4
    follow_through: float = 1.0
    slip: float = 0.0

    @staticmethod
    def of(table: Any, source: str) -> Rules:
        """The rules that a course states.

        Raises
        ------
        BadCourse
            A rule that there is not, or a value that makes no sense.
        """
        if not isinstance(table, Mapping):
            raise BadCourse(f"{source}: [marking] is a table: digits = 4")
        names = {f.name for f in fields(Rules)}
        for name, value in table.items():
            if name not in names:
                raise BadCourse(f"{source}: no rule of marking {name!r}{nearest(str(name), names)}")
            whole = isinstance(value, int) and not isinstance(value, bool)
            if name == "digits" and not (whole and 2 <= value <= 12):
                raise BadCourse(f"{source}: digits is a whole number from 2 to 12; found {value!r}")
            if name != "digits" and not (isinstance(value, (int, float)) and 0 <= value <= 1):
                raise BadCourse(f"{source}: {name} is a share from 0 to 1; found {value!r}")
        return Rules(**table)
