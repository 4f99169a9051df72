"""A turn of a quick return, sampled every hundredth of a degree."""

import numpy as np

TURN = ("stroke", "alpha", "beta", "Q", "t_advance", "t_return")


def swept(exercise, given):
    """Position and velocity of the ram at 36 000 angles of the crank."""
    theta2 = np.arange(36_000) / 100
    return exercise.solve(**{**given, "theta2": theta2}, only=("xC", "v_C"))


def turns_back(found):
    """How often the ram turns back in a turn."""
    moving = np.sign(found["v_C"][found["v_C"] != 0])
    return int((moving != np.roll(moving, 1)).sum())
