"""Positions of a coupler: the pole in fifty digits, and linkages that the judge lets pass because they do
it."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework

COURSE = coursework.open_course()
TWO, THREE = COURSE["two_positions"], COURSE["three_positions"]
PIVOTS = ("x_O", "y_O", "x_C", "y_C")


def placed(given, k):
    """A and B in a position."""
    x, y, phi, L = (mpmath.mpf(given[n]) for n in (f"x{k}", f"y{k}", f"phi{k}", "L"))
    A = mpmath.mpc(x, y)
    return A, A + L * mpmath.expj(mpmath.radians(phi))


@each_row("seed", range(10))
def test_the_pole_is_the_fixed_point_of_the_displacement(seed):
    variant = TWO.variant(seed)
    found = variant.solution()
    with mpmath.workdps(50):
        (A1, B1), (A2, B2) = placed(variant.given, 1), placed(variant.given, 2)
        turn = (B2 - A2) / (B1 - A1)
        P = (A2 - turn * A1) / (1 - turn)
    assert found["x_P"] == pytest.approx(float(P.real), rel=1e-12)
    assert found["y_P"] == pytest.approx(float(P.imag), rel=1e-12)


def passes(given, O, C):
    """Whether a pair of pivots carries the coupler into both places, assembled alike."""
    (A1, B1), (A2, B2) = (map(complex, placed(given, k)) for k in (1, 2))
    sides = [((C - A).conjugate() * (B - A)).imag > 0 for A, B in ((A1, B1), (A2, B2))]
    r2, r4, L = abs(A1 - O), abs(B1 - C), given["L"]
    return (
        abs(r2 - abs(A2 - O)) <= 1
        and abs(r4 - abs(B2 - C)) <= 1
        and min(r2, r4) >= L / 3
        and max(r2, r4) <= 4 * L
        and abs(C - O) >= L / 2
        and sides[0] == sides[1]
    )


def test_any_pivots_of_the_bisectors_are_right_if_the_linkage_passes():
    variant = TWO.variant(2)
    (A1, B1), (A2, B2) = (map(complex, placed(variant.given, k)) for k in (1, 2))
    tried = {True: 0, False: 0}
    for s in np.linspace(-2, 2, 9):
        for t in np.linspace(-2, 2, 9):
            O, C = (A1 + A2) / 2 + 1j * s * (A2 - A1), (B1 + B2) / 2 + 1j * t * (B2 - B1)
            own = dict(zip(PIVOTS, (O.real, O.imag, C.real, C.imag), strict=True))
            marks = variant.grade({**own, "r2": abs(A1 - O), "r4": abs(B1 - C)})
            expected = passes(variant.given, O, C)
            tried[expected] += 1
            assert [marks[name].verdict == "correct" for name in PIVOTS] == [expected] * 4, (s, t)
            assert marks["r2"].points == marks["r2"].out_of
    assert min(tried.values()) > 5


@each_row("seed", range(10))
def test_pivots_for_three_positions_are_where_the_bisectors_cross(seed):
    """In fifty digits, as the fixed point of no rotation: the crossing of two lines of equal distances."""
    variant = THREE.variant(seed)
    found = variant.solution()
    with mpmath.workdps(50):
        places = [placed(variant.given, k) for k in (1, 2, 3)]
        for k, pivot in enumerate(("O", "C")):
            p, q, r = (place[k] for place in places)
            # |z|^2 - |p|^2 = 2 Re(conj(z - p) pivot) for both other places.
            rows = [[(z - p).real, (z - p).imag] for z in (q, r)]
            right = [(abs(z) ** 2 - abs(p) ** 2) / 2 for z in (q, r)]
            x, y = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix(right))
            assert found[f"x_{pivot}"] == pytest.approx(float(x), rel=1e-10, abs=1e-9)
            assert found[f"y_{pivot}"] == pytest.approx(float(y), rel=1e-10, abs=1e-9)
        # The coupler reaches the three places with B on one side of AC.
        C = mpmath.mpc(found["x_C"], found["y_C"])
        assert len({mpmath.sign(((C - A).conjugate() * (B - A)).imag) for A, B in places}) == 1


def test_a_pivot_from_which_all_places_look_equally_far_is_none():
    variant = THREE.variant(0)
    marks = variant.grade(dict.fromkeys(PIVOTS, 1e9) | {"r2": 1e9, "r4": 1e9})
    assert all(marks[name].points == 0 for name in PIVOTS)
