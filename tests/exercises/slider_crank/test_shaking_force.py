"""Shaking force at fifty digits: momentum of the real rod, with its centre of mass on its way, differentiated
twice."""

import mpmath
from tables import each_row

import coursework

EXERCISE = coursework.open_course()["shaking_force"]


@each_row("seed", range(10))
def test_the_force_is_that_of_the_real_bodies_but_for_the_fourth_harmonic(seed):
    variant = EXERCISE.variant(seed)
    found = variant.solution()
    with mpmath.workdps(50):
        r2, r3, s3, m2, m3, m4, rc, omega = (
            mpmath.mpf(variant.given[n]) for n in ("r2", "r3", "s3", "m2", "m3", "m4", "rc", "omega2")
        )
        start, mc = mpmath.radians(mpmath.mpf(variant.given["theta2"])), mpmath.mpf(float(found["mc"]))

        def moment(t):
            """Masses times places, kg mm."""
            turn = mpmath.expj(start + omega * t)
            A = r2 * turn
            B = A.real + mpmath.sqrt(r3**2 - A.imag**2)
            return m2 * A + m3 * (A + s3 * (B - A)) + m4 * B - mc * rc * turn

        force = -mpmath.diff(moment, 0, 2) / 1000
        lam = r2 / r3
        size = (m3 + m4) * r2 * omega**2 / 1000
    assert abs(complex(force) - complex(found["X"], found["Y"])) < float(size * lam**3 / 2)
    assert abs(float(force.imag) - found["Y"]) < 1e-9 * float(size)


@each_row("seed", range(4))
def test_primary_and_secondary_force_are_the_first_terms_of_the_exact_series(seed):
    variant = EXERCISE.variant(seed)
    found, given = variant.solution(), variant.given
    with mpmath.workdps(30):
        lam, angle = mpmath.mpf(given["r2"]) / given["r3"], mpmath.radians(mpmath.mpf(given["theta2"]))

        def harmonic(n):
            """Of the piston's place over the crank."""
            place = lambda t: mpmath.cos(t) + mpmath.sqrt(1 / lam**2 - mpmath.sin(t) ** 2)  # noqa: E731
            return (
                mpmath.quad(lambda t: place(t) * mpmath.cos(n * t), [0, mpmath.pi / 2, mpmath.pi])
                * 2
                / mpmath.pi
            )

        size = found["mB"] * given["r2"] * given["omega2"] ** 2 / 1000
        first, second = (n**2 * harmonic(n) * mpmath.cos(n * angle) * size for n in (1, 2))
    assert abs(found["F1"] - float(first)) < 1e-9 * size
    assert abs(found["F2"] - float(second)) < abs(float(lam)) ** 3 / 3 * size
