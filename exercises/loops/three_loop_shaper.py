"""Shaper of three loops: four bars, a bar that a block of the coupler swings, a rod and a ram (Figure 14)."""

import numpy as np

from coursework.degrees import angle, cos, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, rail, slider
from coursework.kinematics.dyads import rrp, rrr, side_of
from coursework.model import Driver, Exercise, Part, chosen, detectable, drawn, in_turn, loop_equations

SYMBOLS_OF_THE_LOOPS = (
    "xC",
    "yC",
    "xD",
    "yD",
    "r2",
    "r3",
    "r4",
    "r5",
    "r6",
    "beta",
    "r7",
    "d3",
    "theta2",
    "theta3",
    "theta4",
    "theta5",
    "d5",
    "theta7",
    "x8",
)
LENGTHS = ("r2", "r3", "r4", "r5", "r6", "r7", "d3", "d5", "x8")
TURN = np.arange(0.0, 360.0, 24.0)  #: where the whole turn is looked at


def frame(xC, yC, xD, yD):
    """Pins C and D."""
    return xC + 1j * yC, xD + 1j * yD


def crank(r2, theta2):
    return polar(r2, theta2)


def pose_of(frame, crank, r3, r4, r5, r6, beta, r7, d3, side):
    """Vectors AB, CB, AE, DE, DF and FG."""
    C, D = frame
    B = rrr(crank, C, r3, r4, side)
    AE = (B - crank) / r3 * polar(r6, beta)
    DE = crank + AE - D
    DF = DE / abs(DE) * r5
    return B - crank, B - C, AE, DE, DF, rrp(D + DF, r7, d3) - D - DF


def pose(frame, crank, r3, r4, r5, r6, beta, r7, d3, mode):
    return pose_of(frame, crank, r3, r4, r5, r6, beta, r7, d3, side_of(mode))


def turn(frame, r2, r3, r4, r5, r6, beta, r7, d3, mode):
    """Vectors DE and FG over the turn: one axis more."""
    C, D, r2, r3, r4, r5, r6, beta, r7, d3, side = (
        np.asarray(x)[..., None] for x in (*frame, r2, r3, r4, r5, r6, beta, r7, d3, side_of(mode))
    )
    *_, DE, _, FG = pose_of((C, D), polar(r2, TURN), r3, r4, r5, r6, beta, r7, d3, side)
    return DE, FG


def crank_turns(frame, r2, r3, r4):
    """The crank is the shortest bar of its loop, and clears both of its aligned positions."""
    r1 = abs(frame[0])
    return (r2 < np.minimum(np.minimum(r1, r3), r4)) & (abs(r3 - r4) < r1 - r2) & (r1 + r2 < r3 + r4)


def angle_at_B_from_30_to_150(frame, r2, r3, r4):
    """Its extremes are those of AC, by the law of cosines."""
    r1, around, slack = abs(frame[0]), r3**2 + r4**2, 2 * r3 * r4 * cos(30)
    return ((r1 - r2) ** 2 >= around - slack) & ((r1 + r2) ** 2 <= around + slack)


def block_stays_on_its_bar(turn, r5):
    """And well away from the pivot D, all around."""
    d5 = abs(turn[0])
    return np.all((d5 > 40) & (d5 < 0.95 * np.asarray(r5)[..., None]), axis=-1)


def rod_keeps_near_its_line(turn):
    """All around; where the rod does not reach the line, this is not a number and fails."""
    return np.all(abs(turn[1].imag) < np.tan(np.radians(50)) * turn[1].real, axis=-1)


def bar_keeps_off_the_line(turn):
    """It points up all around, from 20 to 160 degrees, or down."""
    DE = turn[0]
    steep = abs(DE.imag) > np.sin(np.radians(20)) * abs(DE)
    return np.all(steep & (np.sign(DE.imag) == np.sign(DE.imag[..., :1])), axis=-1)


def crank_turns_visibly(omega2):
    return abs(omega2) >= 2


def figure(frame, crank, pose, theta2, r3, r6, beta):
    O, A, (C, D) = 0j, crank, frame
    AB, _, AE, _, DF, FG = pose
    B, E, F, G = A + AB, A + AE, D + DF, D + DF + FG
    half_rail = 0.25 * C.real
    return Figure(
        rail(G - half_rail, G + half_rail),
        line(O, 0.4 * C.real, dashed=True),
        link(D, F, label="r_5"),
        link(O, A, label="r_2"),
        link(A, B, E),
        line(A, B, label="r_3"),
        line(A, E, label="r_6"),
        link(C, B, label="r_4"),
        slider(E, angle(DF)),
        link(F, G, label="r_7"),
        slider(G),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        ground_pivot(D, "D"),
        pin(A, "A"),
        pin(B, "B"),
        pin(E, "E"),
        pin(F, "F"),
        pin(G, "G"),
        angle_mark(O, 0, theta2, r"\theta_2"),
        angle_mark(A, angle(AB), angle(AB) + beta, r"\beta", radius=0.7 * min(r3, r6)),
    )


def links_turn_visibly(omega3, omega4, omega5, omega7, omega2):
    return np.all([abs(rate) > 0.02 * abs(omega2) for rate in (omega3, omega4, omega5, omega7)], axis=0)


def sliders_move_visibly(d5_dot, x8_dot, r2, omega2):
    least = 0.1 * r2 * abs(omega2)
    return (abs(d5_dot) > least) & (abs(x8_dot) > least)


def links_accelerate_visibly(alpha3, alpha4, alpha5, alpha7, omega2):
    return np.all([abs(gain) > 0.02 * omega2**2 for gain in (alpha3, alpha4, alpha5, alpha7)], axis=0)


def sliders_accelerate_visibly(d5_ddot, x8_ddot, r2, omega2):
    least = 0.1 * r2 * omega2**2
    return (abs(d5_ddot) > least) & (abs(x8_ddot) > least)


POSITIONS = ("theta3", "theta4", "theta5", "theta7", "d5", "x8")
RATES = ("omega3", "omega4", "omega5", "d5_dot", "omega7", "x8_dot")
ACCELERATIONS = ("alpha3", "alpha4", "alpha5", "d5_ddot", "alpha7", "x8_ddot")


def _about(share, spread=0.15):
    """Bounds of a length that is about this share of xC."""
    return (lambda xC: (1 - spread) * share * xC), (lambda xC: (1 + spread) * share * xC)


def _equations(loop, usual=("x", "y")):
    return loop_equations(
        loop,
        SYMBOLS_OF_THE_LOOPS,
        rates=("omega2", "omega3", "omega4", "omega5", "d5_dot", "omega7", "x8_dot"),
        second_rates=("alpha3", "alpha4", "alpha5", "d5_ddot", "alpha7", "x8_ddot"),
        parameters=LENGTHS,
        usual=usual,
    )


EXERCISE = Exercise(
    given={
        "xC": drawn(130, 260, step=5, unit="mm"),
        "yC": drawn(lambda xC: -0.45 * xC, lambda xC: -0.2 * xC, step=5, unit="mm"),
        "xD": drawn(*_about(0.56), step=5, unit="mm"),
        "yD": drawn(lambda xC: -0.9 * xC, lambda xC: -0.65 * xC, step=5, unit="mm"),
        "r2": drawn(*_about(0.17), step=5, unit="mm", positive=True),
        "r3": drawn(*_about(0.69), step=5, unit="mm", positive=True),
        "r4": drawn(*_about(0.74), step=5, unit="mm", positive=True),
        "r5": drawn(*_about(1.65, 0.1), step=5, unit="mm", positive=True),
        "r6": drawn(*_about(0.41), step=5, unit="mm", positive=True),
        "beta": drawn(20, 60, step=5, unit="deg"),
        "r7": drawn(*_about(0.75), step=5, unit="mm", positive=True),
        "d3": drawn(*_about(0.6), step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-20, 20, unit="rad/s"),
        "mode": chosen("open", "crossed"),
    },
    helpers=(frame, crank, pose, turn),
    constraints=(
        crank_turns,
        angle_at_B_from_30_to_150,
        block_stays_on_its_bar,
        rod_keeps_near_its_line,
        bar_keeps_off_the_line,
        crank_turns_visibly,
        links_turn_visibly,
        sliders_move_visibly,
        links_accelerate_visibly,
        sliders_accelerate_visibly,
        *(
            detectable(mistake, *POSITIONS, *RATES, *ACCELERATIONS)
            for mistake in ("beta_forgotten", "beta_sign", "r6_is_r5", "D_sign", "other_mode")
        ),
        detectable("no_coriolis", "alpha5", "alpha7", "x8_ddot"),
        detectable("no_centripetal", "d5_ddot"),
        detectable("x8_rod_left_out", "x8_dot"),
    ),
    parts=(
        *in_turn(1, ("r2", "theta2", "omega2"), *(Part(i, kind="integer") for i in ("w", "gamma"))),
        *_equations("loop_1"),
        *_equations("loop_2"),
        *_equations("loop_3"),
        *_equations("loop_4", usual=()),
        Part("theta3", unit="deg", kind="angle", points=2),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("theta5", unit="deg", kind="angle", points=1),
        Part("d5", unit="mm", points=1),
        Part("theta7", unit="deg", kind="angle", points=1),
        Part("x8", unit="mm", points=1),
        Part("omega3", unit="rad/s", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("omega5", unit="rad/s", points=1),
        Part("d5_dot", unit="mm/s", points=1),
        Part("omega7", unit="rad/s", points=1),
        Part("x8_dot", unit="mm/s", points=1),
        Part("alpha3", unit="rad/s^2", points=1),
        Part("alpha4", unit="rad/s^2", points=1),
        Part("alpha5", unit="rad/s^2", points=1),
        Part("d5_ddot", unit="mm/s^2", points=1),
        Part("alpha7", unit="rad/s^2", points=1),
        Part("x8_ddot", unit="mm/s^2", points=1),
    ),
    figure=figure,
    version=3,
    driver=Driver("theta2", "omega2", output="x8_dot"),
)
