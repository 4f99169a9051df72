"""Mechanisms of the exercises by number: some from the course's figures, most generated."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from coursework.errors import CourseworkError
from coursework.structure.assour import decompose, drivers
from coursework.structure.growing import (
    DYAD,
    FOLLOWER,
    STIFFENER,
    TETRAD,
    TRIAD,
    NumberStream,
    grow,
    relabelled,
)
from coursework.structure.joints import FRAME, JointGraph, Record
from coursework.structure.library import LIBRARY

_COUNTED_FIGURES = (
    "figure_3",
    "figure_5",
    "figure_6_cam",
    "figure_13",
    "figure_14",
    "figure_26b",
    "figure_27",
)
_DECOMPOSED_FIGURES = ("figure_8c_shaper", "figure_8d", "figure_13", "figure_14", "figure_26b", "figure_27")
_ONE_IN = 6  #: of so many mechanisms, one is of a figure
_HIGHEST = 4  #: class that the course names

_COUNTED_GROUPS = (DYAD, DYAD, FOLLOWER, TRIAD)
_DECOMPOSED_GROUPS = (
    (TRIAD,),
    (DYAD, DYAD, DYAD),
    (TRIAD,),
    (DYAD, TRIAD),
    (TRIAD, DYAD),
    (TETRAD,),
    (DYAD, TETRAD),
    (TETRAD, DYAD),
)


#: Numbers below are those of the exercise's first version: its sheets were issued, and stay what they are.
_FIRST_VERSION = 1_000_000
_DECOMPOSED_FIRST = ((DYAD, DYAD), *_DECOMPOSED_GROUPS[1:])


class Driven(NamedTuple):
    """Mechanism and its driver, (frame, body)."""

    joints: tuple[Record, ...]
    driver: tuple[int, int]

    @property
    def body(self) -> int:
        """Body that the questions name."""
        return last_body(JointGraph.of(self.joints), self.driver)


@lru_cache(maxsize=4096)
def to_count(number: int) -> tuple[Record, ...]:
    """Return a mechanism to count joints and bodies of; its mobility by the formula is 0, 1 or 2.

    Parameters
    ----------
    number
        Whole number that decides every choice.

    Returns
    -------
    The records of its joints.
    """
    choices = NumberStream(number, "count")
    if choices.below(_ONE_IN) == 0:
        return relabelled(number, LIBRARY[choices.one_of(_COUNTED_FIGURES)].joints).joints
    driven = 2 if choices.below(3) == 0 else 1
    groups = [choices.one_of(_COUNTED_GROUPS) for _ in range(2 if choices.below(2) else 3 - driven)]
    if choices.below(5) == 0:
        groups.append(STIFFENER)
    return grow(number, groups, drivers=driven).joints


@lru_cache(maxsize=4096)
def to_decompose(number: int) -> Driven:
    """Return a mechanism to decompose into Assour groups of class II to IV, and any driver that allows it.

    Parameters
    ----------
    number
        Whole number that decides every choice; below 1 000 000 as in the exercise's first version.

    Returns
    -------
    The records of its joints and its driver.
    """
    choices = NumberStream(number, "decompose")
    if choices.below(_ONE_IN) == 0:
        grown = relabelled(number, LIBRARY[choices.one_of(_DECOMPOSED_FIGURES)].joints, (2,))
    else:
        groups = _DECOMPOSED_FIRST if number < _FIRST_VERSION else _DECOMPOSED_GROUPS
        grown = grow(number, choices.one_of(groups))
    graph = grown.graph
    able = (b for b in choices.shuffled(drivers(graph)) if b in grown.drivers or _can_drive(graph, b))
    return Driven(grown.joints, (FRAME, next(able)))


def _can_drive(graph: JointGraph, body: int) -> bool:
    try:
        return decompose(graph, (1, body)).rank <= _HIGHEST
    except CourseworkError:
        return False  # it is held, once the other bodies have their groups


def last_body(graph: JointGraph, driver: tuple[int, int]) -> int:
    """Return the highest body that is neither frame nor driven.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.
    driver
        The frame and the driven body.

    Returns
    -------
    The number of the body; that of the driven one where there is no other.
    """
    return max((body for body in graph.moving if body not in driver), default=max(driver))
