"""A turn of a quick return, sampled every hundredth of a degree, or in fifty digits."""

import mpmath
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


def times(arc, omega2):
    """What the strokes take, of the shorter arc of the crank in degrees."""
    turn = 2 * mpmath.pi / abs(omega2)
    advance, back = turn * (360 - arc) / 360, turn * arc / 360
    return {"alpha": 360 - arc, "beta": arc, "Q": (360 - arc) / arc, "t_advance": advance, "t_return": back}


def moving(place):
    """Position, velocity and acceleration of a ram whose position is a function of time."""
    step = mpmath.mpf("1e-14")
    before, now, after = map(place, (-step, 0, step))
    return {"xC": now, "v_C": (after - before) / (2 * step), "a_C": (after - 2 * now + before) / step**2}


def assert_answers(variant, exact, share=1e-12):
    """The answers of a variant are all those that fifty digits give."""
    answers, reference = variant.solution(), exact(**variant.given)
    assert set(answers) == set(reference)
    for name, value in reference.items():
        assert abs(float(answers[name] - value)) < share * abs(value), name
