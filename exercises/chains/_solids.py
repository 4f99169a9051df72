"""Common base of the exercises on spatial chains."""

import hashlib
from functools import cache
from inspect import Parameter, Signature
from math import gcd, isqrt

import numpy as np

from coursework.model import GivenSpec, Part, chosen, drawn
from coursework.structure.spatial_chains import (
    ARRANGEMENTS,
    FREEDOMS,
    AlignedJoint,
    Parallel,
    Series,
    aligned,
    directions_of,
    in_parallel,
    in_series,
    joint_of,
    placed,
)

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


#: The joints of the chains that are drawn: few freedoms, so that a loop of four does not fall apart.
IN_CHAINS = ("revolute", "prismatic", "cylindrical", "spherical", "planar", "annular")


def joint_kind(names: tuple[str, ...] = DRAWN) -> GivenSpec:
    return chosen(*names, shown=False)


#: Directions in the plane xy, neither along x nor along y, of a wedge or of a line of action.
INCLINED = ("3 4 0", "4 -3 0")
#: Directions in the three coordinate planes along none of their axes.
SLANTING = (*INCLINED, "0 3 4", "0 4 -3", "3 0 4", "4 0 -3")


def direction(*more: str) -> GivenSpec:
    return chosen("x", "y", "z", *more, shown=False)


def coordinate() -> GivenSpec:
    """Few values, so that axes often meet or coincide."""
    return drawn(-40, 40, step=20, unit="mm", shown=False)


def table(*joints, tilt=""):
    """The lines of a statement's table of joints, each (bodies, name, direction, point), all turned by a
    ``tilt``."""
    return [_line(k, *joint, tilt) for k, joint in enumerate(joints, start=1)]


def _line(number, bodies, name, along, point, tilt):
    axis, normal = directions_of(along, tilt)
    return {
        "number": number,
        "bodies": bodies,
        "joint": name,
        "along": along,
        "axis": axis,
        "u": "" if name == "spherical" else vector_latex(axis),
        "n": vector_latex(normal) if name == "line_contact" else "",
        "point": [round(c) for c in placed(tuple(map(float, point)), tilt)],
        "freedoms": FREEDOMS[name],
    }


def vector_latex(vector):
    """The unit vector along whole numbers, as a formula: ``\\vec x``,
    ``\\frac{3\\,\\vec x - 4\\,\\vec y}{5}``."""
    common = gcd(*vector)
    vector = [x // common for x in vector]
    told = ""
    for x, letter in zip(vector, "xyz", strict=True):
        if x:
            size = "" if abs(x) == 1 else rf"{abs(x)}\,"
            sign = (" - " if told else "-") if x < 0 else " + " if told else ""
            told += rf"{sign}{size}\vec {letter}"
    size = isqrt(sum(x * x for x in vector))
    return told if size == 1 else rf"\frac{{{told}}}{{{size}}}"


def freedoms_of(joint):
    """Freedoms in space of a joint, or of each of a column of names."""
    names = np.array(sorted(FREEDOMS))
    return np.array([FREEDOMS[name] for name in names])[np.searchsorted(names, joint)]


@cache
def combined(combination: str, *joints: AlignedJoint) -> Parallel | Series:
    """The joints together, with their rank and the equivalent joint."""
    return COMBINE[combination]([joint.mapping() for joint in joints])


@cache
def _motions() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Names "joint direction" in order, the freedoms of each, and the products T' T of its twists at its
    point."""
    pairs = _every_joint()
    twists = [np.array(joint_of(aligned(n, a)).twists((0.0, 0.0, 0.0), 1.0)) for _, n, a in pairs]
    return (
        np.array([key for key, _, _ in pairs]),
        np.array([len(t) for t in twists]),
        np.array([t.T @ t for t in twists]),
    )


@cache
def _actions() -> np.ndarray:
    """In the same order, the products of what each transmits at its point, (force, moment)."""
    wrenches = [
        np.array(joint_of(aligned(n, a)).wrenches((0.0, 0.0, 0.0), 1.0)).reshape(-1, 6)[:, [3, 4, 5, 0, 1, 2]]
        for _, n, a in _every_joint()
    ]
    return np.array([w.T @ w for w in wrenches])


def _every_joint() -> list[tuple[str, str, str]]:
    return sorted((f"{name} {along}", name, along) for name in DRAWN for along in (*"xyz", *SLANTING))


def _rows(joint, along) -> np.ndarray:
    joint, along = np.atleast_1d(joint), np.atleast_1d(along)
    return np.searchsorted(_motions()[0], np.char.add(np.char.add(joint, " "), along))


def _carry(point, shape) -> np.ndarray:
    """Return the matrix that moves a torsor from a point, columns in mm, to the origin: the moment changes,
    the resultant does not."""
    x, y, z = (np.broadcast_to(np.asarray(c, float) / 20, shape) for c in point)
    carry = np.zeros((*shape, 6, 6))
    carry[..., range(6), range(6)] = 1.0
    # The velocity at the origin of a rotation about an axis through (x, y, z).
    carry[..., 0, 4], carry[..., 0, 5] = z, -y
    carry[..., 1, 3], carry[..., 1, 5] = -z, x
    carry[..., 2, 3], carry[..., 2, 4] = y, -x
    return carry


def rank_together(combination, arrangement, inclined, *joints):
    """The rank of what joints transmit in parallel or let move in series, of columns; each joint is (name,
    direction, x, y, z).

    A tilt turns all of them alike and changes nothing.
    """
    products = _actions() if combination == "parallel" else _motions()[2]
    arrangement = np.atleast_1d(arrangement)
    counts, _, slanted = (
        np.array(column)[_place(arrangement)] for column in zip(*ARRANGEMENTS.values(), strict=True)
    )
    total = 0.0
    for number, (name, along, *point) in enumerate(joints):
        along = np.where(slanted, inclined, along) if number == 1 else along
        row = _rows(name, along)
        carry = _carry(point, np.broadcast_shapes(row.shape, arrangement.shape))
        moved = np.swapaxes(carry, -1, -2) @ products[row] @ carry
        total = total + moved * (number < counts)[..., None, None]
    return (np.linalg.eigvalsh(total) > 1e-6).sum(axis=-1)


def _place(arrangement) -> np.ndarray:
    return np.array([list(ARRANGEMENTS).index(one) for one in arrangement.ravel()]).reshape(arrangement.shape)


#: Components that count; in the plane rotation z, velocities x, y.
_IN_SPACE, _IN_PLANE = (
    slice(0, 6),
    slice(2, 5),
)


def mobility_of_loop(joints, directions, points):
    """Mobility of one closed loop: columns of names, of directions, and of points as triples of columns in
    mm."""
    return mobility_of_loops([[1]] * len(joints), joints, directions, points)


def mobility_of_loops(senses, joints, directions, points, *, in_plane=False):
    """Mobility of a chain, of columns: for many draws at once, where the solution takes one chain after the
    other.

    ``senses`` has a row a joint: in each loop, whether it is met along (1), against (-1)
    or not (0). The columns are those of :func:`mobility_of_loop`.

    The rank is that of a matrix of small whole numbers and of fifths: its zeros are zeros but for rounding.
    """
    _, freedoms, products = _motions()
    kept = _IN_PLANE if in_plane else _IN_SPACE
    total, count = 0.0, 0
    for sense, joint, along, point in zip(np.array(senses), joints, directions, points, strict=True):
        row = _rows(joint, along)
        carry = _carry(point, row.shape)[..., kept]
        moved = np.swapaxes(carry, -1, -2) @ products[row] @ carry
        total = total + np.kron(np.outer(sense, sense), moved)
        count = count + (_planar_freedoms() if in_plane else freedoms)[row]
    return count - (np.linalg.eigvalsh(total) > 1e-6).sum(axis=-1)


def evenly(*columns):
    """A number in [0, 1) for each row of columns, spread evenly and the same for ever: by which draws are
    thinned out."""
    told = [
        np.asarray(column).astype(str)
        if np.asarray(column).dtype.kind in "US"
        else np.asarray(column, dtype=int).astype(str)
        for column in np.broadcast_arrays(*columns)
    ]
    keys = ("/".join(row).encode() for row in zip(*(column.ravel().tolist() for column in told), strict=True))
    found = [int.from_bytes(hashlib.shake_128(key).digest(6), "little") / 2**48 for key in keys]
    return np.array(found).reshape(told[0].shape)


@cache
def _planar_freedoms() -> np.ndarray:
    """What each joint of :func:`_motions` leaves free in the plane xy."""
    products = _motions()[2][:, _IN_PLANE, _IN_PLANE]
    return (np.linalg.eigvalsh(products) > 1e-6).sum(axis=-1)


def several_joints(third: tuple[str, ...]) -> dict[str, GivenSpec]:
    """Given: two to four joints, the first at the origin, by
    :func:`coursework.structure.spatial_chains.arranged`; ``third`` are the names of the third and the
    fourth."""
    found = {
        "arrangement": chosen(*ARRANGEMENTS, shown=False),
        "tilt": direction(),
        "inclined": chosen(*SLANTING, shown=False),
        "joint_1": joint_kind(),
        "direction_1": direction(),
    }
    for k in (2, 3, 4):
        found |= {f"joint_{k}": joint_kind(DRAWN if k == 2 else third), f"direction_{k}": direction()}
        found |= {f"{axis}{k}": coordinate() for axis in "xyz"}
    return found


GIVEN = tuple(several_joints(DRAWN))


def of_joints(read):
    """A function of all that is given, from one of (arrangement, tilt, inclined, joint, …), each joint (name,
    direction, x, y, z)."""

    def told(*given):
        arrangement, tilt, inclined, name, along, *others = given
        return read(
            arrangement, tilt, inclined, (name, along, 0, 0, 0), *zip(*[iter(others)] * 5, strict=True)
        )

    told.__name__, told.__doc__, told.__module__ = read.__name__, read.__doc__, read.__module__
    told.__signature__ = Signature([Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in GIVEN])
    return told


def table_of(joints, bodies):
    """The lines of a statement's table of joints that are
    :class:`~coursework.structure.spatial_chains.AlignedJoint`."""
    return [_line(k + 1, bodies[k], *joint) for k, joint in enumerate(joints)]


def axis_parts(has_direction, has_line):
    """The questions about the axis of an equivalent joint, each asked where the joint has one; where it has
    none, others worth as much, about the motions that it allows."""

    def without(has):
        def lacks(*given):
            return not has(*given)

        lacks.__signature__ = Signature([Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in GIVEN])
        return lacks

    return (
        Part("axis_dir", kind="direction", points=1, when=has_direction),
        Part(
            "axis_point", unit="mm", kind="point_on_line", along="axis_dir", atol=1.0, points=1, when=has_line
        ),
        Part("turns", kind="integer", points=1, when=without(has_line)),
        Part("slides", kind="integer", points=1, when=without(has_direction)),
    )
