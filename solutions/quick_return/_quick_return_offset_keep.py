"""Quick return of a slider-crank whose piston is out of line with the crank (Figure 26 a, equations 22, 23): the conditions on answers that a variant must satisfy."""

from coursework.degrees import cos, sin, sqrt

from ...exercises.quick_return.quick_return_offset import rod

__all__ = ["HELPERS", "KEEP"]


def piston(rod, r2, theta2):
    """xC, and v_C over omega2."""
    return _piston(rod, r2, theta2)


def _piston(rod, r2, theta2):
    lean = rod.imag / rod.real
    return r2 * cos(theta2) + rod.real, -r2 * sin(theta2) + r2 * cos(theta2) * lean


def piston_gain(rod, r2, theta2):
    """a_C over omega2**2."""
    turning = -r2 * cos(theta2) / rod.real
    gain = (r2 * sin(theta2) + turning**2 * rod.imag) / rod.real
    return -r2 * cos(theta2) - turning**2 * rod.real - gain * rod.imag


def stroke(r2, r3, e):
    return sqrt((r3 + r2) ** 2 - e**2) - sqrt((r3 - r2) ** 2 - e**2)


def stroke_is_not_twice_the_crank(stroke, r2):
    return stroke > 2 * 1.021 * r2


def piston_moves_visibly(piston, r2):
    return abs(piston[1]) > 0.15 * r2


def piston_accelerates_visibly(piston_gain, r2):
    return abs(piston_gain) > 0.15 * r2


def _told_apart(wrong, right):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return (gap > 2) | (gap < 0.25)


def _tells(wrong, piston):
    return _told_apart(wrong[0], piston[0]) & _told_apart(wrong[1], piston[1])


def side_of_the_line_tells(piston, r2, r3, e, theta2):
    return _tells(_piston(rod(r2, r3, -e, theta2), r2, theta2), piston)


def offset_tells(piston, r2, r3, theta2):
    return _tells(_piston(rod(r2, r3, 0.0, theta2), r2, theta2), piston)


def rotation_of_the_rod_tells(piston, r2, theta2):
    return _told_apart(-r2 * sin(theta2), piston[1])


def sign_under_the_root_tells(stroke, r2, r3, e):
    return _told_apart(sqrt((r3 + r2) ** 2 + e**2) - sqrt((r3 - r2) ** 2 + e**2), stroke)


HELPERS = (
    piston,
    piston_gain,
    stroke,
)
KEEP = (
    stroke_is_not_twice_the_crank,
    piston_moves_visibly,
    piston_accelerates_visibly,
    side_of_the_line_tells,
    offset_tells,
    rotation_of_the_rod_tells,
    sign_under_the_root_tells,
)
