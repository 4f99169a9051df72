"""Statics of a beam: two equations of equilibrium, then the shear, which vanishes where the moment is the
largest."""

from numpy import maximum, minimum

from coursework.solution import given, mistake


def R_A(L, a, F, q):
    return F * (L - a) / L + q * L / 2


def R_B(L, a, F, q):
    return F * a / L + q * L / 2


def x_M(L, a, q, R_A, R_B):
    return maximum(L - R_B / q, minimum(a, R_A / q))


def M(a, F, q, R_A, x_M):
    return R_A * x_M - q * x_M**2 / 2 - F * maximum(x_M - a, 0)


def W(M, sigma):
    """1 kN m is 10^6 N mm, and 1 cm^3 is 10^3 mm^3."""
    return 1000 * M / sigma


@mistake("R_A", "R_B")
def reactions_exchanged(R_A, R_B):
    return R_B, R_A


@mistake("R_A", "R_B")
def load_shared_equally(L, F, q):
    shared = (F + q * L) / 2
    return shared, shared


@mistake("R_A", "R_B")
def even_load_forgotten(L, a, F):
    return F * (L - a) / L, F * a / L


@mistake("x_M")
def middle_of_the_span(L):
    return L / 2


@mistake("M", kind="constant")
def lever_of_the_even_load(a, F, q, R_A, x_M):
    return R_A * x_M - q * x_M**2 - F * maximum(x_M - a, 0)


@mistake("M")
def even_load_without_moment(a, F, R_A, x_M):
    return R_A * x_M - F * maximum(x_M - a, 0)


def residual(L, a, F, q, sigma, R_A, R_B, x_M, M, W):
    """The equilibrium about the load and along the vertical, the moment from the other end, and the change of
    the shear's sign."""
    total = F + q * L
    about_load = R_A * a - R_B * (L - a) + q * L * (L / 2 - a)
    from_B = R_B * (L - x_M) - q * (L - x_M) ** 2 / 2 - F * maximum(a - x_M, 0)
    before, beyond = R_A - q * x_M - F * (x_M > a), R_A - q * x_M - F * (x_M >= a)
    return (
        about_load / (total * L),
        (R_A + R_B - total) / total,
        (M - from_B) / (total * L),
        minimum(before, 0) / total,
        maximum(beyond, 0) / total,
        W * sigma / (1e3 * M) - 1,
    )


#: By hand: under the load in the first, where the shear vanishes in the second, on its right, and in the
#: third, on its left.
KNOWN = (
    given(L=6, a=2, F=30, q=5, sigma=150).gives(R_A=35, R_B=25, x_M=2, M=60, W=400),
    given(L=8, a=2, F=16, q=10, sigma=200).gives(R_A=52, R_B=44, x_M=3.6, M=96.8, W=484),
    given(L=8, a=6, F=16, q=10, sigma=200).gives(R_A=44, R_B=52, x_M=4.4, M=96.8, W=484),
)
