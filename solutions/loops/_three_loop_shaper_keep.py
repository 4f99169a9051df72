"""Shaper of three loops: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.degrees import angle
from coursework.kinematics.dyads import side_of
from coursework.kinematics.vectors import cross, dot

from ...exercises.loops.three_loop_shaper import pose_of

__all__ = ["HELPERS", "KEEP"]


def _motion(frame, crank, r3, r4, r5, r6, beta, r7, d3, side):
    """The links' directions and d5, x8; then their derivatives by the crank angle, first and second."""
    AB, CB, AE, DE, DF, FG = pose_of(frame, crank, r3, r4, r5, r6, beta, r7, d3, side)
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
    """Return whether values differ by at least two tolerances of 1 %, or not at all; poses that do not close
    are ignored."""
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


HELPERS = (motion,)
KEEP = (
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
)
