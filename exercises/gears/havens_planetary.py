"""Havens planetary gear: velocities, by composition of motions and by a rolling contact (our own layout)."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
    circle,
    contact,
    ground_pivot,
    line,
    link,
    note,
    pin,
    slot_link,
    vector,
)
from coursework.kinematics.vectors import dot
from coursework.model import Driver, Exercise, Part, drawn, loop_equations

REASONS = ("fixed_pivot", "slot", "translation", "composition", "no_slip")


def arm(d, r2, r3, theta1):
    """Vector O4A1."""
    return d + polar(r2 + r3, theta1)


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


def guide_turns_fully(d, r2, r3):
    return (0.15 * (r2 + r3) < d) & (d < 0.8 * (r2 + r3))


def crank_off_the_axes(theta1):
    return theta1 % 90 != 0


def crank_turns_visibly(omega1):
    return abs(omega1) >= 2


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
    """Whether a mistake moves a value by two tolerances of 1 % and more, or not at all."""
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


def figure(arm, d, r2, r3, b, theta1, omega1):
    O4, O1, e = complex(-d), 0j, r2 + r3
    A1, along = polar(e, theta1), arm / abs(arm)
    B2, I = A1 + b * along, polar(r3, theta1)
    end = B2 + 0.25 * e * along
    return Figure(
        slot_link(O4, end),
        circle(O1, r3, label="3"),
        circle(A1, r2, label="2"),
        line(O1, 0.7 * e, dashed=True),
        link(O1, A1, label="1"),
        vector(A1, 0.75j * np.sign(omega1) * A1, "V"),
        contact(I, "I"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O1, "O_1"),
        pin(A1, "A_1"),
        pin(B2, "B_2"),
        note(end + 0.1 * e * along, "4"),
        angle_mark(O1, 0, theta1, r"\theta_1", radius=0.55 * r3),
    )


def _reason(quantity):
    return Part(quantity, kind="choice", choices=REASONS, points=1)


EXERCISE = Exercise(
    given={
        "d": drawn(10, 80, unit="mm"),
        "r2": drawn(24, 60, step=2, unit="mm"),
        "r3": drawn(14, 40, step=2, unit="mm"),
        "b": drawn(10, 50, step=2, unit="mm"),
        "theta1": drawn(-175, 180, step=5, unit="deg"),
        "omega1": drawn(-20, 20, unit="rad/s"),
    },
    helpers=(arm, speeds, pinion_speed, velocity_of_B2),
    keep=(
        guide_turns_fully,
        crank_off_the_axes,
        crank_turns_visibly,
        guide_turns_visibly,
        block_slides_visibly,
        pinion_turns_visibly,
        B2_moves_visibly,
        rotation_of_S2_tells,
        carrier_tells,
        slide_tells,
        length_of_the_arm_tells,
        direction_of_the_guide_tells,
    ),
    parts=(
        Part(
            "nature_42", kind="choice", choices=("rotation", "translation", "general"), ordered=True, points=1
        ),
        _reason("why_v_40_A1"),
        _reason("why_v_14_A1"),
        _reason("why_v_24_B2"),
        _reason("why_v_20_B2"),
        _reason("why_v_30_I"),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("rA", unit="mm", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("omega2", unit="rad/s", points=1),
        Part("v_A1_4", unit="mm/s", points=1),
        Part("v_slide", unit="mm/s", points=1),
        Part("v_B2_x", unit="mm/s", points=1),
        Part("v_B2_y", unit="mm/s", points=1),
        Part("omega3", unit="rad/s", points=2),
        Part("v_I", unit="mm/s", points=1),
        *loop_equations("loop_1", ("d", "r2", "r3", "theta1", "rA", "theta4")),
    ),
    figure=figure,
    symbols={
        "v_A1_4": "V_{4/0}(A_1)",
        "v_slide": "V_{1/4}(A_1)",
        "v_B2_x": "v_{B_2,x}",
        "v_B2_y": "v_{B_2,y}",
    },
    driver=Driver("theta1", "omega1", output="v_slide"),
)
