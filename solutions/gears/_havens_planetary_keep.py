"""Havens planetary gear: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.kinematics.vectors import dot

__all__ = ["HELPERS", "KEEP"]


def speeds(arm, r2, r3, theta1):
    """omega4 and v_slide, over omega1."""
    velocity = 1j * polar(r2 + r3, theta1) / arm
    return velocity.imag, velocity.real * abs(arm)


def pinion_speed(speeds, r2, r3):
    """omega3 over omega1."""
    return (r2 + r3 - r2 * speeds[0]) / r3


def velocity_of_B2(speeds, arm, r2, r3, b, theta1):
    """Over omega1: S2 turns as the guide does, about A1 that the crank carries."""
    return 1j * polar(r2 + r3, theta1) + 1j * speeds[0] * b * arm / abs(arm)


def guide_turns_visibly(speeds):
    return abs(speeds[0]) > 0.1


def block_slides_visibly(speeds, r2, r3):
    return abs(speeds[1]) > 0.12 * (r2 + r3)


def pinion_turns_visibly(pinion_speed):
    return abs(pinion_speed) > 0.3


def B2_moves_visibly(velocity_of_B2, r2, r3):
    least = 0.1 * (r2 + r3)
    return (abs(velocity_of_B2.real) > least) & (abs(velocity_of_B2.imag) > least)


def _tells(wrong, right):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return (gap > 2) | (gap < 0.25)


def _both_tell(wrong, right):
    return _tells(wrong.real, right.real) & _tells(wrong.imag, right.imag)


def rotation_of_S2_tells(speeds, pinion_speed, velocity_of_B2, r2, r3, theta1):
    """In the speeds of wheel and pinion, and in the velocity of B2, which is not that of A1."""
    of_wheels = _tells(1.0, speeds[0]) & _tells(1.0, pinion_speed)
    return of_wheels & _both_tell(1j * polar(r2 + r3, theta1), velocity_of_B2)


def carrier_tells(speeds, pinion_speed, r2, r3):
    return _tells(-r2 * speeds[0] / r3, pinion_speed)


def slide_tells(speeds, velocity_of_B2, arm):
    """Left out, or taken the other way."""
    slide = speeds[1] * arm / abs(arm)
    mistaken = (velocity_of_B2 - slide, velocity_of_B2 - 2 * slide)
    return np.all([_both_tell(wrong, velocity_of_B2) for wrong in mistaken], axis=0)


def length_of_the_arm_tells(arm, speeds, pinion_speed, velocity_of_B2, d, r2, r3, theta1, b):
    """With the other sign in the law of cosines; what changes omega4 changes all that follows."""
    other = abs(d - polar(r2 + r3, theta1))
    omega4 = dot(polar(r2 + r3, theta1), arm / abs(arm)) / other
    along = arm / abs(arm)
    of_B2 = (speeds[1] + 1j * (other + b) * omega4) * along
    pinion = (r2 + r3 - r2 * omega4) / r3
    told = (_tells(other, abs(arm)), _tells(omega4, speeds[0]), _tells(pinion, pinion_speed))
    return np.all([*told, _both_tell(of_B2, velocity_of_B2)], axis=0)


def direction_of_the_guide_tells(arm, speeds, pinion_speed, velocity_of_B2, r2, r3, b, theta1):
    """From that of the crank."""
    omega4 = (r2 + r3) / abs(arm)
    of_B2 = 1j * (abs(arm) + b) * omega4 * polar(1.0, theta1)
    pinion = (r2 + r3 - r2 * omega4) / r3
    told = (
        abs(angle(arm * polar(1.0, -theta1))) > 2,
        _tells(omega4, speeds[0]),
        _tells(abs(arm) * omega4, abs(arm) * speeds[0]),
        _tells(pinion, pinion_speed),
    )
    return np.all([*told, _both_tell(of_B2, velocity_of_B2)], axis=0)


HELPERS = (speeds, pinion_speed, velocity_of_B2)
KEEP = (
    guide_turns_visibly,
    block_slides_visibly,
    pinion_turns_visibly,
    B2_moves_visibly,
    rotation_of_S2_tells,
    carrier_tells,
    slide_tells,
    length_of_the_arm_tells,
    direction_of_the_guide_tells,
)
