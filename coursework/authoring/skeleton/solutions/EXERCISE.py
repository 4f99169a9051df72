"""The solution: a function a quantity, whose parameters are the quantities it needs.

A one-line function is printed as its formula in the worked solution.
"""

import numpy as np

from coursework.degrees import cos, sin
from coursework.solution import mistake


def x(r, theta):
    return r * cos(theta)


def y(r, theta):
    return r * sin(theta)


def v(r, omega):
    return r * omega


@mistake("x", "y")
def sine_and_cosine_exchanged(x, y):
    """A parameter that bears a target's name stands for its right value."""
    return y, x


@mistake("v", kind="constant")
def turns_for_radians(r, omega):
    return r * omega * 2 * np.pi


def residual(r, theta, x, y, v, omega):
    """The equations that hold, written another way; 0 when right."""
    return x**2 + y**2 - r**2, x * np.sin(np.radians(theta)) - y * np.cos(np.radians(theta)), v / r - omega


#: Values known without running the solution.
KNOWN = (
    ({"r": 100, "theta": 60, "omega": 2}, {"x": 50, "y": 50 * 3**0.5, "v": 200}),
    ({"r": 100, "theta": 180, "omega": 1}, {"x": -100, "y": 0, "v": 100}),
)
