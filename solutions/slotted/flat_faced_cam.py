"""Cam with a flat-faced follower: solution. All follows from the lift and its two derivatives by the cam
angle.

The formulas are those of the rise; they hold over the whole turn, with the share of the rise that the
follower has at each angle.
"""

from math import pi

import numpy as np

from coursework.degrees import polar, wrap
from coursework.errors import Undefined
from coursework.figures import Figure, circle, contact, dimension, ground_pivot, line, link, point, profile
from coursework.kinematics.cams import rise_345, rise_dwell_return
from coursework.solution import Moving, formula, given, mistake, stable

UNITS = {
    "DWELL": "deg",
    "TURN": "deg",
    "u": "1",
    "b": "rad",
    "s2": "mm",
    "w": "1",
    "u_c": "1",
    "s_c": "mm",
    "s2_c": "mm",
}
SYMBOLS = {
    "b": r"\beta_{\mathrm{rad}}",
    "s2": r"s''",
    "w": "w",
    "u_c": "u_c",
    "s_c": "s_c",
    "s2_c": r"s''_c",
}
EFFECTS = {"position": ("s", "q"), "velocity": ("v",), "acceleration": ("a",)}

DWELL, TURN = 40, 360


def _place(theta, _fitting):
    """Over the whole turn: how far in the rise, and whether up or down."""
    return rise_dwell_return(wrap(theta) / _fitting, DWELL / _fitting, TURN / _fitting)


def _fitting(beta):
    """The rise, if it and the return leave room for the dwell in a turn."""
    fits = (beta > 0) & (2 * beta + DWELL < TURN)
    if np.ndim(beta) == 0 and not fits:
        raise Undefined(
            f"a rise and a return of {beta:g} degrees each and a dwell of {DWELL} do not fit in a turn"
        )
    return np.where(fits, beta, np.nan)[()]


def b(_fitting):
    """The rise in radians; told in words, since a degree sign in a formula says as much."""
    radians = pi / 180
    return _fitting * radians


@formula(r"\frac{<theta>}{<beta>}")
def u(_place):
    """Share of the rise."""
    return _place[0]


@stable(lambda h, u: h * rise_345(u)[0])
def s(h, u):
    return h * (10 * u**3 - 15 * u**4 + 6 * u**5)


@formula(r"\frac{30 \times <h> \times \left(<u>^2 - 2 \times <u>^3 + <u>^4\right)}{<b>}")
@stable(lambda h, b, u, _place: _place[1] * h * rise_345(u)[1] / b)
def q(h, u, b, _place):
    """The slope of the lift, by the angle in radians: the point of contact is so far from the follower's
    line."""
    return 30 * h * (u**2 - 2 * u**3 + u**4) / b * _place[1]


@stable(lambda h, b, u: h * rise_345(u)[2] / b**2)
def s2(h, u, b):
    """Its second derivative."""
    return 60 * h * (u - 3 * u**2 + 2 * u**3) / b**2


def v(q, omega):
    return q * omega


def a(s2, omega):
    """The cam turns at a constant rate."""
    return s2 * omega**2


def q_max(h, b):
    """In the middle of the rise."""
    return 15 * h / (8 * b)


def rho(Rb, s, s2):
    return Rb + s + s2


def w(b):
    """Zero of the derivative of s + s'': u (1 - u) there, the smaller root of a quadratic equation."""
    return 2 / (6 + np.sqrt(36 - 2 * b**2))


def u_c(w):
    """In the second half, where the follower slows down."""
    return (1 + np.sqrt(1 - 4 * w)) / 2


def theta_c(u_c, beta):
    return u_c * beta


def s_c(h, u_c):
    return h * (10 * u_c**3 - 15 * u_c**4 + 6 * u_c**5)


def s2_c(h, u_c, b):
    return 60 * h * (u_c - 3 * u_c**2 + 2 * u_c**3) / b**2


def Rb_min(rho_min, s_c, s2_c):
    return rho_min - np.minimum(s_c + s2_c, 0)


@mistake("s")
def lift_in_proportion_to_the_angle(h, u):
    return h * u


@mistake("q", "s2")
def derivatives_by_the_share_of_the_rise(h, u):
    return 30 * h * (u**2 - 2 * u**3 + u**4), 60 * h * (u - 3 * u**2 + 2 * u**3)


@mistake("q", "s2", "q_max")
def rise_in_degrees(q, s2, q_max, b, beta):
    return q * (b / beta), s2 * (b / beta) ** 2, q_max * (b / beta)


@mistake("v")
def speed_of_the_point_of_the_cam(Rb, s, omega):
    return (Rb + s) * omega


@mistake("a")
def first_derivative_for_the_second(q, omega):
    return q * omega**2


@mistake("a")
def rate_not_squared(s2, omega):
    return s2 * omega


@mistake("q")
def contact_as_far_as_the_lift(s):
    return s


@mistake("q_max")
def mean_slope(h, b):
    return h / b


@mistake("rho")
def radius_for_the_radius_of_curvature(Rb, s):
    return Rb + s


@mistake("rho")
def lift_left_out_of_the_curvature(Rb, s2):
    return Rb + s2


@mistake("theta_c", "u_c", kind="term_sign")
def where_the_follower_speeds_up(w, beta):
    return (1 - np.sqrt(1 - 4 * w)) / 2 * beta, (1 - np.sqrt(1 - 4 * w)) / 2


@mistake("Rb_min")
def curvature_at_the_given_angle(rho_min, s, s2):
    return rho_min - (s + s2)


@mistake("Rb_min")
def only_a_convex_cam(s_c, s2_c):
    return -(s_c + s2_c)


@mistake("Rb_min")
def lift_left_out_of_the_smallest_radius(rho_min, s2_c):
    return rho_min - s2_c


def motion(Rb, s, q, v, a):
    """The point of contact, which is none of a body, and the middle of the face."""
    return {"P": Moving(q + 1j * (Rb + s)), "F": Moving(1j * (Rb + s), 1j * v, 1j * a)}


def _outline(h, beta, b, Rb, around):
    """The cam at the angle 0: the contact that each angle has, turned back."""
    share, way = _place(around, beta)
    lift, slope, _ = rise_345(share)
    return (way * h * slope / b + 1j * (Rb + h * lift)) * polar(1, -around)


def figure(h, beta, b, Rb, theta, s, q, rho, theta_c):
    """The circle of curvature at the contact, and the place where the cam is tightest."""
    cam = _outline(h, beta, b, Rb, np.arange(0, 360, 3)) * polar(1, theta)
    tight = _outline(h, beta, b, Rb, theta_c) * polar(1, theta)
    P, half = complex(q, Rb + s), 1.1 * 15 * h / (8 * b)
    return Figure(
        profile(tuple(map(complex, cam))),
        circle(P - 1j * rho, abs(rho), dashed=True),
        line(P, P - 1j * rho, dashed=True, label=r"\rho"),
        line(0, 1j * (Rb + s + 0.5 * h), dashed=True),
        link(1j * P.imag - half, 1j * P.imag + half),
        dimension(1j * P.imag, P, "q"),
        contact(P, "P"),
        point(complex(tight), "T"),
        ground_pivot(0, "O"),
        paper_mm=(108, 70),
    )


def residual(h, beta, Rb, rho_min, theta, omega, s, v, a, q, q_max, rho, theta_c, Rb_min):
    """The law by its degree and its ends; the cam's own point slides along the face; the flattest place by
    its neighbours."""
    radians = np.radians(beta)

    def law(angle):
        """Lift, slope, bend and the derivative of the curvature, by polynomials of the angle itself."""
        x = np.radians(angle) / radians
        c = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])
        parts = [c.deriv(n)(x) * h / radians**n if n else c(x) * h for n in range(4)]
        return (*parts[:3], parts[1] + parts[3])

    lift, slope, bend, _ = law(theta)
    least, _, sharp, flat = law(theta_c)
    # A point of the cam at P goes as the face does, but for sliding along it.
    carried = 1j * omega * (q + 1j * (Rb + s))
    return (
        (s - lift) / h,
        (q - slope) / h,
        (carried.imag - v) / (h * abs(omega)),
        (a - bend * omega**2) / (h * omega**2),
        (rho - Rb - lift - bend) / Rb,
        (q_max - law(beta / 2)[1]) / h,
        flat * radians / abs(sharp),
        (Rb_min + least + sharp - rho_min) / Rb,
    )


KNOWN = (
    # Half of the rise: half of the lift, the greatest slope, no acceleration.
    given(h=16, beta=90, Rb=40, theta=45, omega=10, rho_min=10).gives(
        s=8, q=60 / pi, q_max=60 / pi, v=600 / pi, a=0, rho=48
    ),
    # A quarter of a rise of one radian: 106/1024 of the lift.
    given(h=1024, beta=180 / pi, Rb=5000, theta=45 / pi, omega=1, rho_min=10).gives(
        s=106, q=1080, a=5760, rho=5000 + 106 + 5760
    ),
    # The end of the rise: at rest.
    given(h=20, beta=80, Rb=60, theta=80, omega=5, rho_min=10).gives(s=20, q=0, v=0, a=0, rho=80),
    # The square of the rise is 11/2, so that the root is 5.
    given(h=10, beta=5.5**0.5 * 180 / pi, rho_min=5).gives(w=2 / 11, u_c=(1 + (3 / 11) ** 0.5) / 2),
)
