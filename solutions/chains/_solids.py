"""Common base of the solutions on spatial chains. Names begin with an underscore: none of it is a
quantity."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from coursework.language.numbers import significant
from coursework.quantities.columns import each_stacked
from coursework.structure.spatial_chains import (
    Chain,
    PlanarChain,
    arranged,
    in_parallel,
    in_series,
    joints_of,
)

_in_parallel = lru_cache(maxsize=4096)(in_parallel)
_chain = lru_cache(maxsize=4096)(Chain)
_planar_chain = lru_cache(maxsize=4096)(PlanarChain)
_in_series = lru_cache(maxsize=4096)(in_series)

#: Equivalent joints of which a line is known, by any of its points.
_WITH_LINE = ("revolute", "helical", "cylindrical", "point_contact")
_NOWHERE = (np.nan, np.nan, np.nan)


def _row_of(bodies, arrangement, tilt, inclined, name, along, *others):
    """Mappings of the joints of an arrangement; ``bodies`` gives those that the joint of a number lies
    between."""
    rest = zip(*[iter(others)] * 5, strict=True)
    placed = arranged(arrangement, tilt, inclined, (name, along, 0, 0, 0), *rest)
    return tuple(joint.mapping(bodies(number)) for number, joint in enumerate(placed))


def _parallel_of(joints):
    return each_stacked(lambda one: _in_parallel(joints_of(one)), joints)


def _series_of(joints):
    return each_stacked(lambda one: _in_series(joints_of(one)), joints)


def _stiffest(whole):
    """The name of the joint that leaves the fewest freedoms; the first of them."""
    return min(whole.joints, key=lambda joint: joint.freedoms).name


def _freest(whole):
    return max(whole.joints, key=lambda joint: joint.freedoms).name


def _direction(whole):
    """NaN where the equivalent joint has no direction."""
    return np.array(whole.equivalent.direction or _NOWHERE)


def _point(whole):
    """NaN where no point of the equivalent joint counts."""
    return np.array(whole.equivalent.point or _NOWHERE)


def _point_of_axis(whole):
    """A1, the origin, where the axis passes through it."""
    point, direction = _point(whole), _direction(whole)
    passes = np.linalg.norm(np.cross(direction, point)) <= 1e-9 * np.linalg.norm(point)
    return 0 * point if passes and whole.equivalent.name in _WITH_LINE else point


def _number(value):
    return rf"\num{{{significant(round(float(value), 9) + 0.0)}}}"


def _sum_of(terms):
    """LaTeX of a sum of shares of symbols; empty where each share is 0."""
    told = ""
    for share, symbol in terms:
        if abs(share) > 1e-9:
            size = "" if abs(abs(share) - 1) < 1e-9 else _number(abs(share)) + r"\,"
            sign = (" - " if told else "-") if share < 0 else " + " if told else ""
            told += f"{sign}{size}{symbol}"
    return told


@lru_cache(maxsize=4096)
def _lines(joints, what):
    """A line a free motion, or with ``"wrenches"`` a transmitted action, at the origin: its number, its
    joint, its resultant and its moment as formulas, and how it adds up from those before, where it does."""
    of_joint, twists, letter = [], [], "a" if what == "wrenches" else "t"
    for number, joint in enumerate(joints, start=1):
        for twist in getattr(joint, what)((0.0, 0.0, 0.0), 1.0):
            of_joint.append(number)
            twists.append(np.roll(twist, 3) if what == "wrenches" else np.array(twist))
    first, sums = [], []  # the independent ones among those before
    for twist in twists:
        before = np.array([twists[k] for k in first]).reshape(-1, 6).T
        shares, *_ = np.linalg.lstsq(before, twist, rcond=None)
        if np.allclose(before @ shares, twist, rtol=0, atol=1e-9 * abs(twist).max()):
            sums.append(
                _sum_of((share, f"{letter}_{{{k + 1}}}") for k, share in zip(first, shares, strict=True))
            )
        else:
            first.append(len(sums))
            sums.append("")
    return tuple(
        {"number": k, "joint": j, "resultant": _triple(t[:3]), "moment": _triple(t[3:]), "sum": told}
        for k, (j, t, told) in enumerate(zip(of_joint, twists, sums, strict=True), start=1)
    )


def _triple(vector):
    inner = r";\ ".join(map(_number, vector))
    return rf"\left({inner}\right)"


def _chain_of(joints):
    return each_stacked(lambda one: _chain(joints_of(one)), joints)


def _planar_chain_of(joints):
    return each_stacked(lambda one: _planar_chain(joints_of(one)), joints)
