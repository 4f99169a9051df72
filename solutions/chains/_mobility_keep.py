"""Conditions that chains share about their mobility."""

import hashlib
from functools import cache

import numpy as np

from ...exercises.chains._solids import _carry, _motions, _rows

_IN_SPACE, _IN_PLANE = (
    slice(0, 6),
    slice(2, 5),
)  #: components that count; in the plane rotation z, velocities x, y


def mobility_of_loop(joints, directions, points):
    """Mobility of one closed loop: columns of names, of directions, and of points as triples of columns in mm."""
    return mobility_of_loops([[1]] * len(joints), joints, directions, points)


def mobility_of_loops(senses, joints, directions, points, *, in_plane=False):
    """Mobility of a chain. ``senses`` has a row a joint: in each loop, whether it is met along (1), against (-1)
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
    """A number in [0, 1) for each row of columns, spread evenly and the same for ever: by which draws are thinned out."""
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
