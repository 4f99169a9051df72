"""Equilibrium of a joint: the six equations in exact fractions, and ranks of the wrenches that joints may
pass on."""

from fractions import Fraction

import numpy as np
import pytest
from tables import each_row

import coursework

EXERCISE = coursework.open_course()["joint_equilibrium"]
BEARS = {"ball": 3, "cylindrical": 4, "revolute": 5}


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


@each_row("seed", range(20))
def test_forces_and_moments_about_any_point_add_up_to_nothing(seed):
    variant = EXERCISE.variant(seed)
    given, found = variant.given, variant.solution()
    b, d, R = (Fraction(given[n]) for n in "bdR")
    actions = [
        ([0, 0, 0], [found["X"], found["Y_A"], found["Z_A"]]),
        ([b, 0, 0], [0, found["Y_B"], found["Z_B"]]),
        ([d, R, 0], [given["F_x"], given["F_y"], given["F_z"]]),
    ]
    actions = [(at, [Fraction(float(f)) for f in force]) for at, force in actions]
    for centre in ([0, 0, 0], [7, -5, 3], [-200, 40, 90]):
        moment = [1000 * Fraction(float(found["Gamma"])), Fraction(0), Fraction(0)]
        for at, force in actions:
            arm = [Fraction(p) - c for p, c in zip(at, centre, strict=True)]
            moment = [m + n for m, n in zip(moment, cross(arm, force), strict=True)]
        assert [float(m) for m in moment] == pytest.approx([0, 0, 0], abs=1e-6)
    assert [float(sum(f[k] for _, f in actions)) for k in range(3)] == pytest.approx([0, 0, 0], abs=1e-9)


@pytest.mark.parametrize("other", BEARS)
def test_overconstraint_is_unknowns_less_rank(other):
    """Columns are unit actions at A and B, with their moments about A; b is 1."""
    unit = np.eye(3)
    ball = [np.r_[e, 0, 0, 0] for e in unit]
    at_B = [np.r_[e, np.cross([1, 0, 0], e)] for e in unit]
    couples = [np.r_[0, 0, 0, e] for e in unit[1:]]
    of_B = {"ball": at_B, "cylindrical": at_B[1:] + couples, "revolute": at_B + couples}[other]
    columns = np.array(ball + of_B).T
    rank = np.linalg.matrix_rank(columns)
    found = EXERCISE.solve(other=other, only=("Ns", "h"))
    assert (found["Ns"], found["h"]) == (columns.shape[1], columns.shape[1] - rank)
    assert len(of_B) == BEARS[other]
