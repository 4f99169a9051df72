"""Shaper of three loops: four bars, a bar that a block of the coupler swings, a rod and a ram (Figure 14)."""

import numpy as np

from coursework.degrees import angle, cos, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, rail, slider
from coursework.kinematics.dyads import rrp, rrr, side_of
from coursework.kinematics.vectors import cross, dot
from coursework.model import Driver, Exercise, Part, chosen, drawn, loop_equations

SYMBOLS_OF_THE_LOOPS = (
    "xC", "yC", "xD", "yD", "r2", "r3", "r4", "r5", "r6", "beta", "r7", "d3",
    "theta2", "theta3", "theta4", "theta5", "d5", "theta7", "x8",
)  # fmt: skip
LENGTHS = ("r2", "r3", "r4", "r5", "r6", "r7", "d3", "d5", "x8")
TURN = np.arange(0.0, 360.0, 24.0)  #: where the whole turn is looked at


def frame(xC, yC, xD, yD):
    """Pins C and D."""
    return xC + 1j * yC, xD + 1j * yD


def crank(r2, theta2):
    return polar(r2, theta2)


def _pose(frame, crank, r3, r4, r5, r6, beta, r7, d3, side):
    """Vectors AB, CB, AE, DE, DF and FG."""
    C, D = frame
    B = rrr(crank, C, r3, r4, side)
    AE = (B - crank) / r3 * polar(r6, beta)
    DE = crank + AE - D
    DF = DE / abs(DE) * r5
    return B - crank, B - C, AE, DE, DF, rrp(D + DF, r7, d3) - D - DF


def _motion(frame, crank, r3, r4, r5, r6, beta, r7, d3, side):
    """The links' directions and d5, x8; then their derivatives by the crank angle, first and second."""
    AB, CB, AE, DE, DF, FG = _pose(frame, crank, r3, r4, r5, r6, beta, r7, d3, side)
    area, along = cross(AB, CB), DE / abs(DE)
    w3, w4 = -dot(1j * crank, CB) / area, -dot(1j * crank, AB) / area
    rest = -crank - w3**2 * AB + w4**2 * CB
    a3, a4 = -dot(rest, CB) / area, -dot(rest, AB) / area
    of_E = 1j * (crank + w3 * AE) / along
    w5, slide = of_E.imag / abs(DE), of_E.real
    of_E = (-crank + (1j * a3 - w3**2) * AE) / along
    a5, slide_2 = (of_E.imag - 2 * slide * w5) / abs(DE), of_E.real + abs(DE) * w5**2
    w7 = -w5 * DF.real / FG.real
    of_F = (1j * a5 - w5**2) * DF
    a7 = (w7**2 * FG.imag - of_F.imag) / FG.real
    ram, ram_2 = -w5 * DF.imag - w7 * FG.imag, of_F.real - a7 * FG.imag - w7**2 * FG.real
    lengths = abs(DE), (frame[1] + DF + FG).real
    return (AB, CB, DF, FG), lengths, (w3, w4, w5, slide, w7, ram), (a3, a4, a5, slide_2, a7, ram_2)


def motion(frame, crank, r3, r4, r5, r6, beta, r7, d3, mode):
    return _motion(frame, crank, r3, r4, r5, r6, beta, r7, d3, side_of(mode))


def turn(frame, r2, r3, r4, r5, r6, beta, r7, d3, mode):
    """Vectors DE and FG over the turn: one axis more."""
    C, D, r2, r3, r4, r5, r6, beta, r7, d3, side = (
        np.asarray(x)[..., None] for x in (*frame, r2, r3, r4, r5, r6, beta, r7, d3, side_of(mode))
    )
    *_, DE, _, FG = _pose((C, D), polar(r2, TURN), r3, r4, r5, r6, beta, r7, d3, side)
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


def links_turn_visibly(motion):
    w3, w4, w5, _, w7, _ = motion[2]
    return np.all([abs(rate) > 0.02 for rate in (w3, w4, w5, w7)], axis=0)


def sliders_move_visibly(motion, r2):
    return (abs(motion[2][3]) > 0.1 * r2) & (abs(motion[2][5]) > 0.1 * r2)


def links_accelerate_visibly(motion):
    a3, a4, a5, _, a7, _ = motion[3]
    return np.all([abs(acceleration) > 0.02 for acceleration in (a3, a4, a5, a7)], axis=0)


def sliders_accelerate_visibly(motion, r2):
    return (abs(motion[3][3]) > 0.1 * r2) & (abs(motion[3][5]) > 0.1 * r2)


def _tell(wrong, right):
    """Whether values differ by two tolerances of 1 % and more, or not at all; what does not close says nothing."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return ~((gap > 0.25) & (gap < 2))


def _tells(wrong, right):
    """The same of all answers: of directions by degrees."""
    turned = [abs(angle(bad / good)) for bad, good in zip(wrong[0], right[0], strict=True)]
    told = [~((gap > 0.25) & (gap < 2)) for gap in turned]
    for some, others in zip(wrong[1:], right[1:], strict=True):
        told += [_tell(bad, good) for bad, good in zip(some, others, strict=True)]
    return np.all(told, axis=0)


def angle_of_the_coupler_tells(motion, frame, crank, r3, r4, r5, r6, beta, r7, d3, mode):
    """Left out, or taken the other way."""
    side = side_of(mode)
    mistaken = (_motion(frame, crank, r3, r4, r5, r6, wrong, r7, d3, side) for wrong in (0 * beta, -beta))
    return np.all([_tells(wrong, motion) for wrong in mistaken], axis=0)


def length_AE_tells(motion, frame, crank, r3, r4, r5, beta, r7, d3, mode):
    """r5 where r6 should be."""
    return _tells(_motion(frame, crank, r3, r4, r5, r5, beta, r7, d3, side_of(mode)), motion)


def height_of_D_tells(motion, frame, crank, r3, r4, r5, r6, beta, r7, d3, mode):
    """D taken on the other side of the x axis."""
    C, D = frame
    wrong = _motion((C, D.conjugate()), crank, r3, r4, r5, r6, beta, r7, d3, side_of(mode))
    return _tells(wrong, motion)


def mode_tells(motion, frame, crank, r3, r4, r5, r6, beta, r7, d3, mode):
    return _tells(_motion(frame, crank, r3, r4, r5, r6, beta, r7, d3, -side_of(mode)), motion)


def sliding_terms_tell(motion, r5):
    """Coriolis and centripetal terms of the block, and what they change farther on."""
    (_, _, DF, FG), (d5, _), (_, _, w5, slide, *_), (_, _, a5, slide_2, a7, ram_2) = motion
    change = 2 * slide * w5 / d5
    of_rod = -change * DF.real / FG.real
    of_ram = -change * DF.imag - of_rod * FG.imag
    pairs = ((a5 + change, a5), (slide_2 - d5 * w5**2, slide_2), (a7 + of_rod, a7), (ram_2 + of_ram, ram_2))
    return np.all([_tell(wrong, right) for wrong, right in pairs], axis=0)


def rod_tells_in_the_speed_of_the_ram(motion):
    (_, _, DF, _), _, (_, _, w5, _, _, ram), _ = motion
    return _tell(-w5 * DF.imag, ram)


def figure(frame, crank, motion, theta2, r3, r6, beta, d3):
    O, A, (C, D) = 0j, crank, frame
    (AB, _, DF, _), (_, x8) = motion[:2]
    B, E, F, G = A + AB, A + AB / r3 * polar(r6, beta), D + DF, x8 + 1j * d3
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
    helpers=(frame, crank, motion, turn),
    keep=(
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
        angle_of_the_coupler_tells,
        length_AE_tells,
        height_of_D_tells,
        mode_tells,
        sliding_terms_tell,
        rod_tells_in_the_speed_of_the_ram,
    ),
    parts=(
        Part("w", kind="integer", points=1),
        Part("gamma", kind="integer", points=1),
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
    version=2,
    driver=Driver("theta2", "omega2", output="x8_dot"),
)
