"""What the exercises on chains of solids share."""

from functools import cache

from coursework.model import GivenSpec, chosen, drawn
from coursework.solids import aligned, in_parallel, in_series

COMBINE = {"parallel": in_parallel, "series": in_series}

#: The joints that are drawn: those of the table that have freedoms, without the screw.
DRAWN = (
    "revolute",
    "prismatic",
    "cylindrical",
    "spherical_pin",
    "spherical",
    "planar",
    "annular",
    "line_contact",
    "point_contact",
)
WITH_DIRECTION = (
    "revolute",
    "prismatic",
    "helical",
    "cylindrical",
    "planar",
    "annular",
    "line_contact",
    "point_contact",
)
WITH_LINE = ("revolute", "helical", "cylindrical", "point_contact")


def joint_kind() -> GivenSpec:
    return chosen(*DRAWN)


def direction() -> GivenSpec:
    return chosen("x", "y", "z")


def coordinate() -> GivenSpec:
    """Few values, so that axes often meet or coincide."""
    return drawn(-40, 40, step=20, unit="mm")


@cache
def equivalent_of(combination: str, *joints: tuple) -> tuple[int, str]:
    """Freedoms and name of the equivalent joint; each joint is (name, direction, x, y, z).

    Every axis lies along x, y or z: stretching space along these changes neither a rank nor a name, so that it
    is enough to know which coordinates are zero.
    """
    made = COMBINE[combination]([aligned(name, along, point) for name, along, *point in joints])
    return made.rank.value, made.equivalent.name
