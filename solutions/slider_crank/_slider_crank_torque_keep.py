"""Slider-crank: the conditions on answers that a variant must satisfy."""

import numpy as np

from ...exercises.slider_crank.slider_crank_torque import WEIGHT

__all__ = ["HELPERS", "KEEP"]


def _cross(u, v):
    return u.real * v.imag - u.imag * v.real


def _answers(scene):
    """Torque, N_guide, R_A and R_B, along a first axis."""
    push = _cross(scene.piston + scene.s3 * scene.at_G, scene.rod) - 1000 * scene.moment
    guide = push / (scene.rod.real + np.sign(push) * scene.friction * scene.rod.imag)
    at_B = scene.friction * abs(guide) - 1j * guide - scene.piston
    at_A = at_B - scene.at_G
    torque = _cross(scene.crank, at_A) / 1000 - scene.on_crank
    return np.stack([torque, guide, abs(at_A), abs(at_B)])


def answers(scene):
    """With every effect, as they are asked."""
    return _answers(scene)


def _told_apart(right, wrong):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    moved = abs(wrong / right - 1)
    return ((moved > 0.022) | (moved < 0.002)).all(axis=0)


def answers_are_no_small_differences(answers, scene):
    forces = abs(scene.piston) + abs(scene.at_G)
    torque = abs(answers[0]) > 0.1 * (abs(scene.crank) * forces / 1000 + abs(scene.on_crank))
    return torque & (abs(answers[1:]) > 0.1 * forces).all(axis=0)


def friction_tells(answers, scene):
    without, other_way = (_answers(scene._replace(friction=f)) for f in (0, -scene.friction))
    return _told_apart(answers, without) & _told_apart(answers, other_way)


def weight_of_the_rod_tells(answers, scene, m3):
    return _told_apart(answers, _answers(scene._replace(at_G=scene.at_G + m3 * WEIGHT)))


def inertia_of_the_rod_tells(answers, scene):
    """In the torque and on the guide; less in the pins."""
    return _told_apart(answers[:2], _answers(scene._replace(moment=0))[:2])


def inertia_of_the_crank_tells(answers, scene):
    return _told_apart(answers, _answers(scene._replace(on_crank=0)))


HELPERS = (answers,)
KEEP = (
    answers_are_no_small_differences,
    friction_tells,
    weight_of_the_rod_tells,
    inertia_of_the_rod_tells,
    inertia_of_the_crank_tells,
)
