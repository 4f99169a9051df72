"""Six links, two loops of pivots: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.degrees import angle
from coursework.kinematics.dyads import side_of
from coursework.kinematics.vectors import cross, dot

from ...exercises.loops.two_loop_linkage import bars_of

__all__ = ["HELPERS", "KEEP"]


def _rates(arm, start_rate, start_acceleration, first, second):
    """The rates and angular accelerations of two rods from a moving pin to a fixed one.

    ``arm`` is the driving vector, that ends at the moving pin and turns at ``start_rate``.
    """
    velocity = 1j * start_rate * arm
    area = cross(first, second)
    rates = -dot(velocity, second) / area, -dot(velocity, first) / area
    acceleration = (1j * start_acceleration - start_rate**2) * arm
    rest = acceleration - rates[0] ** 2 * first + rates[1] ** 2 * second
    return rates, (-dot(rest, second) / area, -dot(rest, first) / area)


def _motion(frame, crank, *links_and_sides):
    """Vectors AB, CB, DE and FE, then their rates over omega2 and accelerations over its square."""
    *rods, CD = bars_of(frame, crank, *links_and_sides)
    rates_1, accelerations_1 = _rates(crank, 1.0, 0.0, *rods[:2])
    rates_2, accelerations_2 = _rates(CD, rates_1[1], accelerations_1[1], *rods[2:])
    return tuple(rods), (*rates_1, *rates_2), (*accelerations_1, *accelerations_2)


def motion(frame, crank, r3, r4, r5, beta, r6, r7, mode_1, mode_2):
    return _motion(frame, crank, r3, r4, r5, beta, r6, r7, side_of(mode_1), side_of(mode_2))


def links_turn_visibly(motion):
    return np.all([abs(rate) > 0.04 for rate in motion[1]], axis=0)


def links_accelerate_visibly(motion):
    return np.all([abs(acceleration) > 0.03 for acceleration in motion[2]], axis=0)


def _tells(wrong, right):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    turned = [abs(angle(bad / good)) for bad, good in zip(wrong[0], right[0], strict=True)]
    moved = [
        abs(bad - good) / abs(0.01 * good)
        for bad, good in zip((*wrong[1], *wrong[2]), (*right[1], *right[2]), strict=True)
    ]
    return ~np.any([(gap > 0.25) & (gap < 2) for gap in (*turned, *moved)], axis=0)


def angle_of_the_plate_tells(motion, frame, crank, r3, r4, r5, beta, r6, r7, mode_1, mode_2):
    """Left out, or taken the other way."""
    sides = side_of(mode_1), side_of(mode_2)
    mistaken = (_motion(frame, crank, r3, r4, r5, wrong, r6, r7, *sides) for wrong in (0 * beta, -beta))
    return np.all([_tells(wrong, motion) for wrong in mistaken], axis=0)


def side_of_the_plate_tells(motion, frame, crank, r3, r4, beta, r6, r7, mode_1, mode_2):
    """r4 where r5 should be."""
    sides = side_of(mode_1), side_of(mode_2)
    return _tells(_motion(frame, crank, r3, r4, r4, beta, r6, r7, *sides), motion)


def modes_tell(motion, frame, crank, r3, r4, r5, beta, r6, r7, mode_1, mode_2):
    one, two = side_of(mode_1), side_of(mode_2)
    mistaken = (
        _motion(frame, crank, r3, r4, r5, beta, r6, r7, *sides) for sides in ((-one, two), (one, -two))
    )
    return np.all([_tells(wrong, motion) for wrong in mistaken], axis=0)


def acceleration_of_the_plate_tells(motion):
    """In the second loop, beside the terms in the squares of the rates."""
    _, (_, omega4, omega6, omega7), (_, alpha4, alpha6, alpha7) = motion
    shares = (abs(omega6 / omega4 * alpha4 / alpha6), abs(omega7 / omega4 * alpha4 / alpha7))
    return np.all([share > 0.02 for share in shares], axis=0)


HELPERS = (motion,)
KEEP = (
    links_turn_visibly,
    links_accelerate_visibly,
    angle_of_the_plate_tells,
    side_of_the_plate_tells,
    modes_tell,
    acceleration_of_the_plate_tells,
)
