"""A crank pin in the curved slot of a lever: the relative motion along its tangent, and all its
accelerations."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import Figure, angle_mark, arc, ground_pivot, line, link, pin, point
from coursework.kinematics.dyads import rrr, side_of
from coursework.model import Driver, Exercise, Part, chosen, drawn, loop_equations


def bars(r1, r2, d, rho, theta2, mode):
    """Vectors OA, AC and DC."""
    A, D = polar(r2, theta2), r1 + 0j
    C = rrr(A, D, rho, d, side_of(mode))
    return A, C - A, C - D


def ends(r1, r2, d, rho):
    """The angle ACD when the crank lies along the frame, inwards and outwards: the pin's way along the
    slot."""
    with np.errstate(invalid="ignore"):
        return tuple(
            np.degrees(np.arccos((rho**2 + d**2 - reach**2) / (2 * rho * d))) for reach in (r1 - r2, r1 + r2)
        )


def crank_turns(r1, r2, d, rho):
    return (r2 < np.minimum(np.minimum(r1, d), rho)) & (abs(d - rho) < r1 - r2) & (r1 + r2 < d + rho)


def slot_is_less_than_half_a_circle(ends):
    return (ends[0] > 28) & (ends[1] < 150)


def crank_off_the_frame(theta2):
    return theta2 % 180 >= 5


def crank_turns_visibly(omega2):
    return abs(omega2) >= 2


def pin_slides_visibly(v_rel, rho, omega2):
    return abs(v_rel) > 0.15 * rho * abs(omega2)


def lever_turns_visibly(omega4, omega2):
    return abs(omega4) > 0.12 * abs(omega2)


def rates_of_sliding_change_visibly(a_rel_t, alpha4, rho, omega2):
    return (abs(a_rel_t) > 0.1 * rho * omega2**2) & (abs(alpha4) > 0.08 * omega2**2)


def figure(bars, ends, r1, r2, rho, theta2):
    O, A, D = 0j, complex(bars[0]), complex(r1)
    C = A + complex(bars[1])
    turned = float(angle((A - C) / (D - C)))
    first = float(angle(D - C)) + np.sign(turned) * (float(ends[0]) - 9)
    last = first + np.sign(turned) * (float(ends[1] - ends[0]) + 18)
    low, high = sorted((float(first), float(last)))
    half = 0.045 * (r1 + r2)
    tips = [C + polar(rho, way) for way in (low, high)]
    towards = [(D - tip) / abs(D - tip) for tip in tips]
    return Figure(
        line(O, D, dashed=True, label="r_1"),
        link(tips[0] + half * towards[0], D, tips[1] + half * towards[1], weld=True),
        *(arc(C, rho + side * half, low, high) for side in (1, -1)),
        arc(C, rho, low, high, dashed=True),
        arc(tips[0], half, low + 180, low + 360),
        arc(tips[1], half, high, high + 180),
        line(C, A, dashed=True, label=r"\rho"),
        line(D, C, dashed=True, label="d"),
        link(O, A, label="r_2"),
        ground_pivot(O, "O"),
        ground_pivot(D, "D"),
        pin(A, "A"),
        point(C, "C"),
        angle_mark(O, 0, theta2, r"\theta_2"),
        paper_mm=(110, 90),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(100, 220, step=5, unit="mm"),
        "r2": drawn(25, 70, step=5, unit="mm"),
        "d": drawn(70, 200, step=5, unit="mm"),
        "rho": drawn(70, 200, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-20, 20, unit="rad/s", nonzero=True),
        "mode": chosen("open", "crossed"),
    },
    helpers=(bars, ends),
    constraints=(
        crank_turns,
        slot_is_less_than_half_a_circle,
        crank_off_the_frame,
        crank_turns_visibly,
        pin_slides_visibly,
        lever_turns_visibly,
        rates_of_sliding_change_visibly,
    ),
    parts=(
        Part("theta3", unit="deg", kind="angle", points=1),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("tau", unit="deg", kind="angle", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("v_A4", unit="mm/s", points=1),
        Part("v_rel", unit="mm/s", points=2),
        Part("a_rel_n", unit="mm/s^2", points=1),
        Part("a_coriolis", unit="mm/s^2", points=1),
        Part("alpha4", unit="rad/s^2", points=2),
        Part("a_rel_t", unit="mm/s^2", points=2),
        *loop_equations("loop_1", ("r1", "r2", "theta2", "rho", "theta3", "d", "theta4")),
    ),
    figure=figure,
    symbols={
        "v_A4": "v_{A4}",
        "v_rel": "v_r",
        "a_rel_n": "a_r^n",
        "a_rel_t": "a_r^t",
        "a_coriolis": "a_c",
    },
    driver=Driver("theta2", "omega2", output="omega4"),
)
