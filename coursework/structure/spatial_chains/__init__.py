"""Spatial chains: joints as spaces of twists, combined in parallel, in series and in loops.

A joint is a mapping ``{"joint": NAME, "axis": [x, y, z], "normal": …, "point": …, "pitch": p}`` with the
keys that it needs, and ``"between": [i, j]`` in a chain; body 0 is the frame. Points and pitches are in
one unit of length, any one; axes and normals need not be unit vectors.

* :func:`in_parallel`, :func:`in_series`: joints between two bodies, joints in a row;
* :class:`Chain`, :class:`PlanarChain`: loops of joints, in space and in a plane;
* :func:`twist_components`, :func:`wrench_components`: which components may differ from zero at a point;
* :func:`recognise`: the joint of the table that a space of twists is.
"""

from coursework.structure.spatial_chains.aligned import (
    ARRANGEMENTS,
    AlignedJoint,
    aligned,
    arranged,
    directions_of,
    each_distinct,
    placed,
)
from coursework.structure.spatial_chains.chains import Chain, PlanarChain, planar_kind
from coursework.structure.spatial_chains.combining import CONDITIONS, Parallel, Series, in_parallel, in_series
from coursework.structure.spatial_chains.joints import FREEDOMS, JOINTS, Joint, joint_of, joints_of
from coursework.structure.spatial_chains.ranks import Rank, rank_of
from coursework.structure.spatial_chains.recognition import EQUIVALENTS, Equivalent, recognise
from coursework.structure.spatial_chains.torsors import moved, twist_components, wrench_components

__all__ = [
    "ARRANGEMENTS",
    "CONDITIONS",
    "EQUIVALENTS",
    "FREEDOMS",
    "JOINTS",
    "AlignedJoint",
    "Chain",
    "Equivalent",
    "Joint",
    "Parallel",
    "PlanarChain",
    "Rank",
    "Series",
    "aligned",
    "arranged",
    "directions_of",
    "each_distinct",
    "in_parallel",
    "in_series",
    "joint_of",
    "joints_of",
    "moved",
    "placed",
    "planar_kind",
    "rank_of",
    "recognise",
    "twist_components",
    "wrench_components",
]
