"""A course's rules of marking: ``[marking]`` in ``exercises/course.toml``, each with its usual value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from coursework.errors import BadCourse, nearest
from coursework.messages import Message
from coursework.quantities.error_kinds import PENALTIES

#: Beyond these a variant is ill-conditioned: rounding alone may cost a student the answer.
ILL_SHARE, ILL_DEGREES = 0.03, 1.0

DIGITS_KEPT = (2, 12)  #: least and most digits that a student may be said to keep

_SLIPS = ("sign", "conjugate", "unit", "radians", "turns_a_minute", "other_case")


@dataclass(frozen=True)
class Rules:
    """``digits``: significant digits that a student keeps on the way; the tolerance is as wide as that may
    cost. ``follow_through``: share of the points for a right method from an earlier wrong answer;
    ``other_case``: the same where it follows from the other case than the stated one. ``prices``: share that
    an error leaves, by kind; ``slip``: of the answer's sign, unit and case together."""

    digits: int = 4
    follow_through: float = 1.0
    other_case: float = 1.0
    slip: float | None = None
    prices: Mapping[str, float] = field(default_factory=dict)

    def share(self, kind: str) -> float:
        """Return the share of the points that an error of a kind leaves."""
        if kind in self.prices:
            return self.prices[kind]
        if self.slip is not None and kind in _SLIPS:
            return self.slip
        return PENALTIES.get(kind, 0.0)

    @staticmethod
    def of(table: Any, source: str, usual: Rules | None = None) -> Rules:
        """Return the rules that a course states; what it leaves unsaid is as ``usual``.

        Raises
        ------
        BadCourse
            A rule does not exist, or a value makes no sense.
        """
        if not isinstance(table, Mapping):
            raise BadCourse("{place}: [marking] is a table: digits = 4", place=source)
        usual = usual or Rules()
        names = {f.name for f in fields(Rules)}
        stated: dict[str, Any] = {}
        for name, value in table.items():
            if name not in names:
                near = nearest(str(name), names)
                raise BadCourse(
                    "{place}: no rule of marking {name!r}{nearest}", place=source, name=name, nearest=near
                )
            is_integer = isinstance(value, int) and not isinstance(value, bool)
            if name == "digits" and not (is_integer and DIGITS_KEPT[0] <= value <= DIGITS_KEPT[1]):
                raise BadCourse(
                    "{place}: digits is a whole number from 2 to 12; found {found!r}",
                    place=source,
                    found=value,
                )
            if name == "prices":
                value = {**usual.prices, **_penalties(value, source)}
            elif name != "digits":
                _check_share(name, value, source)
            stated[name] = value
        return replace(usual, **stated)


def _penalties(table: Any, source: str) -> Mapping[str, float]:
    if not isinstance(table, Mapping):
        raise BadCourse("{place}: [marking.prices] is a table: sign = 0.5", place=source)
    for kind, value in table.items():
        if kind not in PENALTIES:
            near = nearest(str(kind), PENALTIES)
            raise BadCourse("{place}: no price for {kind!r}{nearest}", place=source, kind=kind, nearest=near)
        _check_share(Message("the price of {kind}", kind=kind), value, source)
    return table


def _check_share(name: str, value: Any, source: str) -> None:
    if isinstance(value, bool) or not (isinstance(value, (int, float)) and 0 <= value <= 1):
        raise BadCourse(
            "{place}: {name} is a share from 0 to 1; found {found!r}", place=source, name=name, found=value
        )
