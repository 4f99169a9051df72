"""Cam with a flat-faced follower: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.kinematics.cams import rise_345

__all__ = ["HELPERS", "KEEP"]


def bend(h, theta, beta):
    """The second derivative of the lift by the cam angle, in the rise."""
    return h * rise_345(theta / beta)[2] / np.radians(beta) ** 2


def law_bends_visibly(bend, h):
    return abs(bend) > 0.2 * h


HELPERS = (bend,)
KEEP = (law_bends_visibly,)
