"""Function generation: the linkage at its precision points and over its range in fifty digits, and what the
judge lets pass."""

import mpmath
import pytest
from tables import each_row

import coursework

EXERCISE = coursework.open_course()["function_generation"]
FUNCTIONS = {
    "logarithm": (mpmath.log10, 1, 2),
    "inverse": (lambda x: 1 / x, 1, 2),
    "sine": (lambda x: mpmath.sin(mpmath.pi / 2 * x), 0, 1),
    "root": (mpmath.sqrt, 1, 4),
}
LENGTHS = ("r2", "r3", "r4")


def rocker(r1, r2, r3, r4, theta2):
    """Both directions of the rocker, degrees, by the half-angle form of the loop."""
    A = r2 * mpmath.expj(mpmath.radians(theta2))
    # (r1 + r4 e^it - A) has the length r3: p cos t + q sin t = m.
    w = r1 - A
    p, q = 2 * r4 * w.real, 2 * r4 * w.imag
    m = r3**2 - r4**2 - abs(w) ** 2
    root = mpmath.sqrt(p**2 + q**2 - m**2)
    return [mpmath.degrees(2 * mpmath.atan2(q + side * root, p + m)) for side in (-1, 1)]


def errors(given, lengths, shares):
    f, a, b = FUNCTIONS[given["law"]]
    r1, theta2_0, range2, theta4_0, range4 = (
        mpmath.mpf(given[n]) for n in ("r1", "theta2_0", "range2", "theta4_0", "range4")
    )
    r2, r3, r4 = (mpmath.mpf(float(lengths[n])) for n in LENGTHS)
    found = [[], []]
    for share in shares:
        x = a + (b - a) * mpmath.mpf(share)
        wanted = theta4_0 + range4 * (f(x) - f(a)) / (f(b) - f(a))
        for k, theta4 in enumerate(rocker(r1, r2, r3, r4, theta2_0 + range2 * mpmath.mpf(share))):
            found[k].append((theta4 - wanted + 180) % 360 - 180)
    return min(found, key=lambda row: max(map(abs, row)))


@each_row("seed", range(8))
def test_the_linkage_is_exact_at_its_precision_points_and_as_wrong_as_told_between(seed):
    variant = EXERCISE.variant(seed)
    found = variant.solution()
    with mpmath.workdps(50):
        precise = [(1 - mpmath.cos(mpmath.pi * k / 6)) / 2 for k in (1, 3, 5)]
        assert max(map(abs, errors(variant.given, found, precise))) < 1e-9
        sampled = errors(variant.given, found, [mpmath.mpf(k) / 180 for k in range(181)])
    assert float(max(map(abs, sampled))) == pytest.approx(found["worst"], rel=1e-9)
    x1 = FUNCTIONS[variant.given["law"]][1:]
    assert found["x1"] == pytest.approx(float(x1[0] + (x1[1] - x1[0]) * precise[0]), rel=1e-12)


def test_another_linkage_that_does_it_is_right_and_one_that_does_not_is_told_by_how_much():
    variant = EXERCISE.variant(0)
    right = variant.solution()
    near = {name: 1.002 * right[name] if name == "r3" else right[name] for name in LENGTHS}
    far = {name: 1.05 * right[name] if name == "r3" else right[name] for name in LENGTHS}
    for lengths, accepted in ((near, True), (far, False)):
        with mpmath.workdps(30):
            deviation = float(max(map(abs, errors(variant.given, lengths, [k / 180 for k in range(181)]))))
        assert (deviation <= variant.given["delta"]) is accepted
        marks = variant.grade({**lengths, "worst": deviation})
        assert [marks[name].verdict == "correct" for name in LENGTHS] == [accepted] * 3
        # The error is that of the student's own linkage.
        assert marks["worst"].points == marks["worst"].out_of
