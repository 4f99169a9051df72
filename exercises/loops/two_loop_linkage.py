"""Six links, two loops of pivots: a rocker that is a plate drives a second rocker (Figure 13)."""

import numpy as np

from coursework.degrees import angle, cos, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin
from coursework.kinematics.dyads import rrr, side_of
from coursework.model import Driver, Exercise, Part, chosen, detectable, drawn, in_turn, loop_equations

SYMBOLS_OF_THE_LOOPS = (
    "xC",
    "yC",
    "xF",
    "yF",
    "r2",
    "r3",
    "r4",
    "r5",
    "beta",
    "r6",
    "r7",
    "theta2",
    "theta3",
    "theta4",
    "theta6",
    "theta7",
)
LENGTHS = ("r2", "r3", "r4", "r5", "r6", "r7")


def frame(xC, yC, xF, yF):
    """Pins C and F."""
    return xC + 1j * yC, xF + 1j * yF


def crank(r2, theta2):
    return polar(r2, theta2)


def bars(frame, crank, r3, r4, r5, beta, r6, r7, mode_1, mode_2):
    """Vectors AB, CB, DE and FE, and CD."""
    C, F = frame
    B = rrr(crank, C, r3, r4, side_of(mode_1))
    CB = B - C
    CD = CB * polar(r5 / r4, beta)
    E = rrr(C + CD, F, r6, r7, side_of(mode_2))
    return B - crank, CB, E - (C + CD), E - F, CD


def _about(share, spread=0.15):
    """Bounds of a length that is about this share of xC."""
    return (lambda xC: (1 - spread) * share * xC), (lambda xC: (1 + spread) * share * xC)


def _cosine_at(side, next_side, opposite):
    """The law of cosines: of the angle between two sides."""
    return (side**2 + next_side**2 - opposite**2) / (2 * side * next_side)


def _within(cosine, least):
    """Return whether an angle lies at least this many degrees from 0 and from 180."""
    return abs(cosine) <= cos(least)


def crank_turns(frame, r2, r3, r4):
    """The crank is the shortest bar of its loop, and clears both of its aligned positions."""
    r1 = abs(frame[0])
    return (r2 < np.minimum(np.minimum(r1, r3), r4)) & (abs(r3 - r4) < r1 - r2) & (r1 + r2 < r3 + r4)


def angle_at_B_from_30_to_150(frame, r2, r3, r4):
    """Its extremes are those of AC, the crank along the frame."""
    r1 = abs(frame[0])
    return _within(_cosine_at(r3, r4, r1 - r2), 30) & _within(_cosine_at(r3, r4, r1 + r2), 30)


def reach_of_D(frame, r2, r3, r4, r5, beta, mode_1):
    """The least and the greatest distance DF over the turn.

    The rocker turns back where crank and coupler line up; between, DF is extreme where D lies on the line CF.
    """
    C, F = frame
    r1, CF = abs(C), F - C
    turned = [
        angle(-C / CF * (cosine - 1j * side_of(mode_1) * np.sqrt(np.maximum(1 - cosine**2, 0)))) + beta
        for cosine in (_cosine_at(r1, r4, r3 - r2), _cosine_at(r1, r4, r3 + r2))
    ]
    start = turned[0]
    swing = (turned[1] - start + 180) % 360 - 180
    cosines = np.cos(np.radians(start)), np.cos(np.radians(start + swing))

    def passes(direction):
        ahead = (direction - start + 180) % 360 - 180
        return (ahead * swing > 0) & (abs(ahead) < abs(swing))

    nearest = np.where(passes(0), 1.0, np.maximum(*cosines))
    farthest = np.where(passes(180), -1.0, np.minimum(*cosines))
    around = abs(CF) ** 2 + r5**2
    return tuple(np.sqrt(around - 2 * abs(CF) * r5 * cosine) for cosine in (nearest, farthest))


def angle_at_E_from_25_to_155(reach_of_D, r6, r7):
    return _within(_cosine_at(r6, r7, reach_of_D[0]), 25) & _within(_cosine_at(r6, r7, reach_of_D[1]), 25)


def crank_turns_visibly(omega2):
    return abs(omega2) >= 2


def plate_is_bent(beta):
    return abs(beta) >= 15


def figure(frame, crank, bars, theta2, beta):
    O, A, (C, F) = 0j, crank, frame
    AB, CB, DE, _, CD = bars
    B, D = A + AB, C + CD
    E = D + DE
    return Figure(
        line(O, 0.35 * C.real, dashed=True),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, D),
        line(C, B, label="r_4"),
        line(C, D, label="r_5"),
        link(D, E, label="r_6"),
        link(F, E, label="r_7"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        ground_pivot(F, "F"),
        pin(A, "A"),
        pin(B, "B"),
        pin(D, "D"),
        pin(E, "E"),
        angle_mark(O, 0, theta2, r"\theta_2"),
        angle_mark(C, angle(CB), angle(CB) + beta, r"\beta"),
    )


def links_turn_visibly(omega3, omega4, omega6, omega7, omega2):
    return np.all([abs(rate) > 0.04 * abs(omega2) for rate in (omega3, omega4, omega6, omega7)], axis=0)


def links_accelerate_visibly(alpha3, alpha4, alpha6, alpha7, omega2):
    return np.all([abs(gain) > 0.03 * omega2**2 for gain in (alpha3, alpha4, alpha6, alpha7)], axis=0)


def acceleration_of_the_plate_tells(omega4, omega6, omega7, alpha4, alpha6, alpha7):
    """In the second loop, beside the terms in the squares of the rates."""
    share_6, share_7 = abs(omega6 / omega4 * alpha4 / alpha6), abs(omega7 / omega4 * alpha4 / alpha7)
    return (share_6 > 0.02) & (share_7 > 0.02)


MOTION = tuple(f"{symbol}{link}" for symbol in ("theta", "omega", "alpha") for link in (3, 4, 6, 7))


def _equations(loop, usual=("x", "y")):
    return loop_equations(
        loop,
        SYMBOLS_OF_THE_LOOPS,
        rates=("omega2", "omega3", "omega4", "omega6", "omega7"),
        second_rates=("alpha3", "alpha4", "alpha6", "alpha7"),
        parameters=LENGTHS,
        usual=usual,
    )


EXERCISE = Exercise(
    given={
        "xC": drawn(140, 280, step=5, unit="mm"),
        "yC": drawn(lambda xC: -0.2 * xC, lambda xC: 0.2 * xC, step=5, unit="mm"),
        "xF": drawn(*_about(1.7), step=5, unit="mm"),
        "yF": drawn(lambda xC: -0.3 * xC, lambda xC: 0.3 * xC, step=5, unit="mm"),
        "r2": drawn(*_about(0.27, 0.25), step=5, unit="mm", positive=True),
        "r3": drawn(*_about(0.82), step=5, unit="mm", positive=True),
        "r4": drawn(*_about(0.75), step=5, unit="mm", positive=True),
        "r5": drawn(*_about(0.4, 0.25), step=5, unit="mm", positive=True),
        "beta": drawn(-90, 90, step=5, unit="deg"),
        "r6": drawn(*_about(0.7), step=5, unit="mm", positive=True),
        "r7": drawn(*_about(0.7), step=5, unit="mm", positive=True),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-20, 20, unit="rad/s"),
        "mode_1": chosen("open", "crossed"),
        "mode_2": chosen("open", "crossed"),
    },
    helpers=(frame, crank, bars, reach_of_D),
    constraints=(
        plate_is_bent,
        crank_turns,
        angle_at_B_from_30_to_150,
        angle_at_E_from_25_to_155,
        crank_turns_visibly,
        links_turn_visibly,
        links_accelerate_visibly,
        *(
            detectable(mistake, *MOTION)
            for mistake in ("beta_forgotten", "beta_sign", "r4_for_r5", "mode_1_other", "mode_2_other")
        ),
        acceleration_of_the_plate_tells,
    ),
    parts=(
        *in_turn(
            2,
            ("r2", "theta2", "omega2"),
            Part("mobility", kind="integer", points=1),
            Part("cycles", kind="integer", points=1),
            Part("third_loop", kind="choice", choices=("sum", "difference", "new"), points=1),
        ),
        *_equations("loop_1"),
        *_equations("loop_2"),
        *_equations("loop_3", ("x",)),
        Part("theta3", unit="deg", kind="angle", points=2),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("theta6", unit="deg", kind="angle", points=2),
        Part("theta7", unit="deg", kind="angle", points=1),
        Part("omega3", unit="rad/s", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("omega6", unit="rad/s", points=1),
        Part("omega7", unit="rad/s", points=1),
        Part("alpha3", unit="rad/s^2", points=1),
        Part("alpha4", unit="rad/s^2", points=1),
        Part("alpha6", unit="rad/s^2", points=1),
        Part("alpha7", unit="rad/s^2", points=1),
    ),
    figure=figure,
    version=3,
    symbols={
        "mobility": "w",
        "cycles": r"\gamma",
        "mode_1": r"\mathrm{mode 1}",
        "mode_2": r"\mathrm{mode 2}",
    },
    driver=Driver("theta2", "omega2", output="omega7"),
)
