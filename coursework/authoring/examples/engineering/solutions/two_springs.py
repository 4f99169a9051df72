"""Two springs: each displacement from the force that its spring carries; the energy from the work of the
forces."""

from coursework.quantities.columns import matrix, vector
from coursework.solution import given, mistake

UNITS = {"k_s": "N/mm", "k_p": "N/mm", "u1": "mm", "u2": "mm"}


def k_s(k1, k2):
    return k1 * k2 / (k1 + k2)


def k_p(k1, k2):
    return k1 + k2


def k(k_s, k_p):
    return vector(k_s, k_p)


def K(k1, k2):
    return matrix([k1 + k2, -k2], [-k2, k2])


def u1(k1, F1, F2):
    return (F1 + F2) / k1


def u2(k2, F2, u1):
    return u1 + F2 / k2


def u(u1, u2):
    return vector(u1, u2)


def E(F1, F2, u):
    """1 J is 1000 N mm."""
    return (F1 * u[..., 0] + F2 * u[..., 1]) / 2 / 1000


@mistake("k")
def series_and_parallel_exchanged(k):
    return k[..., ::-1]


@mistake("k", share=0.5)
def mean_for_series(k1, k2):
    return vector((k1 + k2) / 2, k1 + k2)


@mistake("K", kind="sign")
def sign_of_the_coupling(K):
    return abs(K)


@mistake("K")
def springs_alone(k1, k2):
    return matrix([k1, -k2], [-k2, k2])


@mistake("u")
def second_node_from_the_first(u1, k2, F2):
    return vector(u1, F2 / k2)


@mistake("u")
def first_spring_carries_one_force(k1, k2, F1, F2):
    return vector(F1 / k1, F1 / k1 + F2 / k2)


@mistake("E", kind="constant")
def half_forgotten(E):
    return 2 * E


def residual(k1, k2, F1, F2, k, K, u, E):
    """Forces from the matrix; sums of compliances and of stiffnesses; the energy of each spring."""
    forces = (K @ u[..., None])[..., 0]
    stretch1, stretch2 = u[..., 0], u[..., 1] - u[..., 0]
    return (
        forces[..., 0] / F1 - 1,
        forces[..., 1] / F2 - 1,
        k[..., 0] * (1 / k1 + 1 / k2) - 1,
        (k[..., 1] - k1) / k2 - 1,
        (k1 * stretch1**2 + k2 * stretch2**2) / (2000 * E) - 1,
    )


KNOWN = (
    given(k1=6, k2=3, F1=30, F2=60).gives(k=(2, 9), K=((9, -3), (-3, 3)), u=(15, 35), E=1.275),
    given(k1=4, k2=12, F1=20, F2=60).gives(k=(3, 16), K=((16, -12), (-12, 12)), u=(20, 25), E=0.95),
)
