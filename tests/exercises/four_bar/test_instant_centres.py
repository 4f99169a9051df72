"""Instant centres at fifty digits: the point of each body pair that moves alike, from the places of the pins
a moment before and after."""

import mpmath
from tables import each_row

import coursework

COURSE = coursework.open_course()
STEP = mpmath.mpf("1e-25")


def four_bar(given, turned):
    """O, A, B, C with the crank so much further, radians; B where two circles meet."""
    r1, r2, r3, r4 = (mpmath.mpf(given[name]) for name in ("r1", "r2", "r3", "r4"))
    A, C = r2 * mpmath.expj(mpmath.radians(mpmath.mpf(given["theta2"])) + turned), mpmath.mpc(r1)
    along = C - A
    share = (abs(along) ** 2 + r3**2 - r4**2) / (2 * abs(along) ** 2)
    height = mpmath.sqrt(r3**2 / abs(along) ** 2 - share**2)
    return mpmath.mpc(0), A, A + along * (share + (1j if given["mode"] == "open" else -1j) * height), C


def slider_crank(given, turned):
    """O, A and B, to the right of A."""
    r2, r3, e = (mpmath.mpf(given[name]) for name in ("r2", "r3", "e"))
    A = r2 * mpmath.expj(mpmath.radians(mpmath.mpf(given["theta2"])) + turned)
    return mpmath.mpc(0), A, mpmath.mpc(A.real + mpmath.sqrt(r3**2 - (e - A.imag) ** 2), e)


def rates(linkage, given):
    """The points, and their velocities."""
    omega2 = mpmath.mpf(given["omega2"])
    before, after = (linkage(given, side * STEP * omega2) for side in (-1, 1))
    moved = [(q - p) / (2 * STEP) for p, q in zip(before, after, strict=True)]
    return linkage(given, mpmath.mpf(0)), moved


def at_rest(A, B, v_A, v_B):
    """The point at rest of the body that carries two points, and its angular velocity."""
    omega = ((v_B - v_A) / (B - A)).imag
    return A + 1j * v_A / omega, omega


def agrees(found, right, size):
    assert abs(mpmath.mpf(float(found)) - right) < 1e-12 * size


@each_row("seed", range(10))
def test_centres_of_a_four_bar_are_where_two_bodies_move_alike(seed):
    variant = COURSE["instant_centres"].variant(seed)
    found, given = variant.solution(), variant.given
    with mpmath.workdps(50):
        (_, A, B, C), (_, v_A, v_B, _) = rates(four_bar, given)
        I13, omega3 = at_rest(A, B, v_A, v_B)
        omega2, omega4 = mpmath.mpf(given["omega2"]), (v_B / (B - C)).imag
        # On the frame's line, a point of the crank and a point of the rocker: omega2 x = omega4 (x - r1).
        agrees(found["x24"], -omega4 * C.real / (omega2 - omega4), given["r1"])
        agrees(found["d13"], (I13 / A).real * abs(A), given["r1"])
        assert abs((I13 / A).imag) < 1e-20
        agrees(found["omega3"], omega3, abs(omega2))
        agrees(found["omega4"], omega4, abs(omega2))
        agrees(found["v_M"], abs(v_A + v_B) / 2, abs(v_A))


@each_row("seed", range(10))
def test_centres_of_a_slider_crank_are_where_two_bodies_move_alike(seed):
    variant = COURSE["instant_centres_slider"].variant(seed)
    found, given = variant.solution(), variant.given
    with mpmath.workdps(50):
        (_, A, B), (_, v_A, v_B) = rates(slider_crank, given)
        I13, omega3 = at_rest(A, B, v_A, v_B)
        agrees(found["y13"], I13.imag, given["r3"])
        agrees(found["y24"], -v_B.real / mpmath.mpf(given["omega2"]), given["r2"])
        agrees(found["v_B"], v_B.real, abs(v_A))
        agrees(found["omega3"], omega3, abs(given["omega2"]))
        agrees(found["v_M"], abs(v_A + v_B) / 2, abs(v_A))


def test_coupler_and_frame_have_their_centre_at_infinity_when_crank_and_rocker_are_parallel():
    row = COURSE["instant_centres"].solve(
        r1=100, r2=50, r3=100, r4=50, theta2=90, omega2=2, mode="open", only=("omega3", "omega4", "v_M")
    )
    assert row == {"omega3": 0, "omega4": 2, "v_M": 100}
