"""The six links of the supplementary exercise, for drawn polygons: the slider is C here, since p is the image
of none."""

from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, rail, slider
from coursework.model import drawn

from .._drawn import told_angle
from ..loops.slider_extras import EXERCISE as SIX_LINKS
from ..loops.slider_extras import pin_A, pin_B, pin_P

#: With a shorter rod, which turns faster: its accelerations can be drawn.
GIVEN = {
    **SIX_LINKS.given,
    "omega2": drawn(-20, 20, unit="rad/s"),
    "r5": drawn(lambda r4: 1.15 * r4, lambda r4: 1.8 * r4, step=5, unit="mm", positive=True),
}
HELPERS = (pin_A, pin_B, pin_P)


def bars(r1, r2, r3, r4, r5, theta2, mode):
    """Vectors OA, AB, DB and BC."""
    A = pin_A(r1, r2, theta2)
    B = pin_B(A, r3, r4, mode)
    return A - 1j * r1, B - A, B, pin_P(B, r5) - B


def told_directions(bars):
    """Of AB, DB and BC, as the statement tells them."""
    return dict(zip(("theta3", "theta4", "theta5"), map(told_angle, bars[1:]), strict=True))


def crank_off_the_axes(theta2):
    return theta2 % 90 >= 5


def figure(pin_A, pin_B, pin_P, r1, theta2):
    O, D, x = 1j * r1, 0, 0.25 * r1
    return Figure(
        rail(pin_P - x, pin_P + x),
        line(D, O, dashed=True, label="r_1"),
        line(D, pin_P, dashed=True),
        link(O, pin_A, label="r_2"),
        link(pin_A, pin_B, label="r_3"),
        link(D, pin_B, label="r_4"),
        slider(pin_P),
        link(pin_P, pin_B, label="r_5"),
        ground_pivot(D, "D"),
        ground_pivot(O, "O"),
        pin(pin_A, "A"),
        pin(pin_B, "B"),
        pin(pin_P, "C"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )
