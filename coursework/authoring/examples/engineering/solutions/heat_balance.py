"""Steady conduction: layers in series, as resistors are. Thicknesses are in mm, whence the thousands."""

from coursework.solution import given, mistake

UNITS = {"R_1": "K/W", "R_2": "K/W"}


def R_1(A, e_1, lambda_1):
    return e_1 / (1000 * lambda_1 * A)


def R_2(A, e_2, lambda_2):
    return e_2 / (1000 * lambda_2 * A)


def R_th(R_1, R_2):
    return R_1 + R_2


def Phi(T_i, T_e, R_th):
    return (T_i - T_e) / R_th


def T_12(T_i, Phi, R_1):
    return T_i - Phi * R_1


@mistake("R_th")
def layers_side_by_side(R_1, R_2):
    return R_1 * R_2 / (R_1 + R_2)


@mistake("R_th", kind="factor")
def area_forgotten(A, R_th):
    return R_th * A


@mistake("Phi")
def product_for_quotient(T_i, T_e, R_th):
    return (T_i - T_e) * R_th


@mistake("T_12")
def drop_over_the_other_layer(T_i, Phi, R_2):
    return T_i - Phi * R_2


@mistake("T_12")
def one_slope_through_both(T_i, T_e, e_1, e_2):
    return T_i - (T_i - T_e) * e_1 / (e_1 + e_2)


def residual(A, e_1, lambda_1, e_2, lambda_2, T_i, T_e, R_th, Phi, T_12):
    """The same flow through each layer, by Fourier's law, and the whole as the mean of conductances per
    length."""
    first = lambda_1 * A * (T_i - T_12) * 1e3 / e_1
    second = lambda_2 * A * (T_12 - T_e) * 1e3 / e_2
    return first / Phi - 1, second / Phi - 1, R_th * 1e3 * A / (e_1 / lambda_1 + e_2 / lambda_2) - 1


KNOWN = (
    given(A=10, e_1=200, lambda_1=1, e_2=100, lambda_2=0.04, T_i=20, T_e=-7).gives(
        R_th=0.27, Phi=100, T_12=18
    ),
    given(A=20, e_1=300, lambda_1=0.5, e_2=40, lambda_2=0.05, T_i=21, T_e=0).gives(
        R_th=0.07, Phi=300, T_12=12
    ),
)
