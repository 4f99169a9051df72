"""Cam with a roller follower: solution. All follows from the lift and its derivatives by the cam angle.

The instant centre I of cam and follower is on the horizontal through O, at the distance s' from O, and on the
common normal.
"""

import numpy as np

from coursework.degrees import atan, cos, polar, sin, sqrt, wrap
from coursework.errors import Undefined
from coursework.figures import (
    Figure,
    angle_mark,
    circle,
    contact,
    ground_pivot,
    line,
    pin,
    point,
    profile,
    trace,
    vector,
    wheel,
)
from coursework.kinematics.cams import rise, rise_dwell_return
from coursework.quantities import columns
from coursework.solution import Moving, formula, given, mistake, stable

UNITS = {
    "TURN": "deg",
    "u": "1",
    "way": "1",
    "f0": "1",
    "f1": "1",
    "f2": "1",
    "f3": "1",
    "b": "rad",
    "s1": "mm",
    "s2": "mm",
    "s3": "mm",
    "d": "mm",
    "CI": "mm",
    "x_K": "mm",
    "y_K": "mm",
}
SYMBOLS = {
    "way": r"\varepsilon",
    "f0": "f",
    "f1": "f'",
    "f2": "f''",
    "f3": "f'''",
    "b": r"\beta_{\mathrm{rad}}",
    "s1": "s'",
    "s2": "s''",
    "s3": "s'''",
    "CI": "CI",
    "x_K": "x_K",
    "y_K": "y_K",
}
EFFECTS = {"position": ("s", "phi"), "velocity": ("v",), "acceleration": ("a",)}

TURN = 360


def ends(law):
    """The roughest laws first."""
    jerky = (law == "cycloidal") | (law == "polynomial_345")
    rough = (law == "parabolic") | (law == "harmonic")
    return np.where(rough, "acceleration_jumps", np.where(jerky, "jerk_jumps", "jerk_begins_at_zero"))[()]


def _fitting(beta, delta):
    """The rise, if it, the dwell and the return leave room in a turn."""
    fits = (beta > 0) & (delta >= 0) & (2 * beta + delta < TURN)
    if np.ndim(fits) == 0 and not fits:
        raise Undefined(
            f"a rise and a return of {beta:g} degrees each and a dwell of {delta} do not fit in a turn"
        )
    return np.where(fits, beta, np.nan)[()]


def _place(theta, delta, _fitting):
    """How far in the rise, and whether up or down."""
    return rise_dwell_return(wrap(theta) / _fitting, delta / _fitting, TURN / _fitting)


def way(_place):
    return _place[1]


def stroke(way):
    return np.where(way > 0, "up", "down")[()]


def u(_place):
    return _place[0]


def _law(law, u):
    return rise(law, u)


def f0(_law):
    return _law[0]


def f1(_law):
    return _law[1]


def f2(_law):
    return _law[2]


def f3(_law):
    return _law[3]


def b(_fitting):
    """Of the rise, in radians; told in words, since a degree sign in a formula says as much."""
    radians = np.pi / 180
    return _fitting * radians


def s(h, f0):
    return h * f0


def s1(way, h, f1, b):
    """First derivative of the lift by the cam angle."""
    return way * h * f1 / b


def s2(h, f2, b):
    return h * f2 / b**2


def s3(way, h, f3, b):
    return way * h * f3 / b**3


def v(s1, omega):
    return s1 * omega


def a(s2, omega):
    return s2 * omega**2


def j(s3, omega):
    return s3 * omega**3


def jump(h, omega, b):
    """From 4 to -4 of the unit of the law."""
    return 8 * h * omega**2 / b**2


def d(Rb, Rr, e):
    """Height of the centre of the roller at the foot of the rise."""
    return sqrt((Rb + Rr) ** 2 - e**2)


@formula(r"\arctan \frac{\left|<s1> - <e>\right|}{<d> + <s>}")
def phi(s1, e, d, s):
    """Between the follower's line and the normal, which passes through I."""
    return atan(abs(s1 - e) / (d + s))


@formula(r"\sqrt{\left(<s1> - <e>\right)^2 + \left(<d> + <s>\right)^2}")
def CI(s1, e, d, s):
    """From the centre of the roller to I."""
    return np.hypot(s1 - e, d + s)


@formula(r"\frac{<CI>^3}{<CI>^2 + <s1> \times \left(<s1> - <e>\right) - <s2> \times \left(<d> + <s>\right)}")
def rho(CI, s1, s2, e, d, s):
    """Of the path of C on the cam."""
    return CI**3 / (CI**2 + s1 * (s1 - e) - s2 * (d + s))


def side(rho):
    return np.where(rho < 0, "hollow", "round")[()]


def _beyond(CI, Rb, Rr, e, s, s1, d):
    """CI less the radius of the roller, in digits that a large roller leaves."""
    return ((s1 - e) ** 2 + Rb * (Rb + 2 * Rr) - e**2 + s * (2 * d + s)) / (CI + Rr)


def _flatter(CI, s1, s2, e, d, s):
    """rho less CI."""
    bend = s1 * (s1 - e) - s2 * (d + s)
    return -CI * bend / (CI**2 + bend)


@stable(lambda _beyond, _flatter: _beyond + _flatter)
def rho_c(rho, Rr):
    """The profile is parallel to the pitch curve."""
    return rho - Rr


def shape(rho, R2):
    return np.where(rho < 0, "concave", np.where(rho < R2, "undercut", "convex"))[()]


def x_K(e, Rr, s1, CI):
    """From C towards I, by the radius of the roller."""
    return e + Rr * (s1 - e) / CI


@formula(r"\left(<d> + <s>\right) \times \left(1 - \frac{<Rr>}{<CI>}\right)")
@stable(lambda d, s, CI, _beyond: (d + s) * _beyond / CI)
def y_K(d, s, Rr, CI):
    return (d + s) * (1 - Rr / CI)


@formula(
    r"\left(<x_K> \times \cos <theta> + <y_K> \times \sin <theta>;\ "
    r"<y_K> \times \cos <theta> - <x_K> \times \sin <theta>\right)"
)
def K(x_K, y_K, theta):
    """In the axes of the cam, turned back."""
    return columns.vector(x_K * cos(theta) + y_K * sin(theta), y_K * cos(theta) - x_K * sin(theta))


@mistake("ends")
def smoother_than_it_is(law):
    jerky = (law == "cycloidal") | (law == "polynomial_345")
    return np.where(jerky, "jerk_begins_at_zero", "jerk_jumps")[()]


@mistake("ends")
def rougher_than_it_is(law):
    rough = (law == "parabolic") | (law == "harmonic")
    return np.where(rough, "jerk_begins_at_zero", "acceleration_jumps")[()]


@mistake("u", kind="complement")
def return_counted_from_its_beginning(u, way):
    """Down by the law of the way up."""
    return np.where(way < 0, 1 - u, u)[()]


@mistake("s1", "s2", "s3", kind="degrees")
def rise_in_degrees(s1, s2, s3, b, beta):
    return s1 * (b / beta), s2 * (b / beta) ** 2, s3 * (b / beta) ** 3


@mistake("s1", "s2", "s3")
def derivatives_by_the_share_of_the_rise(way, h, f1, f2, f3):
    return way * h * f1, h * f2, way * h * f3


@mistake("s1", "s3", kind="factor")
def falls_as_it_rises(way, s1, s3):
    """The sign of the return left out."""
    return way * s1, way * s3


@mistake("jump", kind="constant")
def from_zero_only(h, omega, b):
    return 4 * h * omega**2 / b**2


@mistake("phi", kind="term")
def offset_left_out_of_the_angle(s1, d, s):
    return atan(abs(s1) / (d + s))


@mistake("phi", kind="term_sign")
def offset_on_the_other_side(s1, e, d, s):
    return atan(abs(s1 + e) / (d + s))


@mistake("phi", kind="term")
def lift_left_out_of_the_height(s1, e, d):
    return atan(abs(s1 - e) / d)


@mistake("rho")
def radius_of_a_flat_face(Rb, Rr, s, s2):
    return Rb + Rr + s + s2


@mistake("rho_c", kind="term_sign")
def roller_added(rho, Rr):
    return rho + Rr


@mistake("shape")
def undercut_overlooked(rho):
    return np.where(rho < 0, "undercut", "convex")[()]


@mistake("shape")
def hollow_taken_for_undercut(rho):
    return np.where(rho < 0, "undercut", "concave")[()]


@mistake("K")
def centre_for_the_contact(e, d, s, theta):
    x, y = e, d + s
    return columns.vector(x * cos(theta) + y * sin(theta), y * cos(theta) - x * sin(theta))


@mistake("K")
def cam_not_turned_back(x_K, y_K):
    return columns.vector(x_K, y_K)


@mistake("K", kind="angle_sign")
def turned_the_wrong_way(x_K, y_K, theta):
    return columns.vector(x_K * cos(theta) - y_K * sin(theta), y_K * cos(theta) + x_K * sin(theta))


def motion(e, d, s, v, a):
    """The centre of the roller."""
    return {"C": Moving(e + 1j * (d + s), 1j * v, 1j * a)}


def _pitch(law, h, delta, beta, d, e, around):
    """The path of C on the cam at the angle 0, and the unit vectors from C to its points of contact."""
    share, way = rise_dwell_return(wrap(around) / beta, delta / beta, TURN / beta)
    lift, slope, *_ = rise(law, share)
    C = e + 1j * (d + h * lift)
    inward = way * h * slope / np.radians(beta) - C
    back = polar(1, -around)
    return C * back, inward / abs(inward) * back


def figure(law, h, delta, beta, Rb, Rr, e, d, theta, s, s1, rho, x_K, y_K, CI):
    """The common normal through I, K and C, and the centre of curvature of the pitch curve."""
    around = np.arange(0, 363, 3)
    pitch, inward = (z * polar(1, theta) for z in _pitch(law, h, delta, beta, d, e, around))
    C, K, I = complex(e, d + s), complex(x_K, y_K), complex(s1)
    normal = (C - I) / CI
    centre = C - rho * normal
    return Figure(
        profile(tuple(map(complex, (pitch + Rr * inward)[:-1]))),
        circle(0, Rb, dashed=True),
        trace(tuple(map(complex, pitch))),
        wheel(C, Rr),
        line(C, C + 0.9j * Rb, dashed=True),
        vector(I, normal * (CI + 0.8 * Rb), "n"),
        angle_mark(C, 90, float(np.degrees(np.angle(normal))), r"\varphi", radius=0.6 * Rb),
        line(0, I, label="s'"),
        *((point(centre, r"\Omega"),) if abs(centre) < 2 * Rb else ()),
        ground_pivot(0, "O", toward=-135),
        contact(K, "K"),
        pin(C, "C"),
        point(I, "I"),
        paper_mm=(108, 80),
    )


def _by_series(law, x):
    """Lift and three derivatives by x, from polynomials of x and from exponentials."""
    polynomials = {
        "parabolic": ([0, 0, 2], [-1, 4, -2]),
        "polynomial_345": ([0, 0, 0, 10, -15, 6],) * 2,
        "polynomial_4567": ([0, 0, 0, 0, 35, -84, 70, -20],) * 2,
    }
    waves = {"harmonic": ([0.5], [-0.5], np.pi), "cycloidal": ([0, 1], [0.5j / np.pi], 2 * np.pi)}
    found = []
    for n in range(4):
        values = {
            name: np.where(x < 0.5, *(np.polynomial.Polynomial(c).deriv(n)(x) for c in halves))
            for name, halves in polynomials.items()
        }
        for name, (mean, wave, rate) in waves.items():
            values[name] = (
                np.polynomial.Polynomial(mean).deriv(n)(x)
                + (wave[0] * (1j * rate) ** n * np.exp(1j * rate * x)).real
            )
        found.append(np.select([law == name for name in values], list(values.values())))
    return found


def residual(law, h, beta, delta, theta, omega, Rb, Rr, e, s, v, a, j, phi, rho, rho_c, K):
    """The pitch curve in the plane of the cam and its two derivatives: velocities, its normal, its curvature,
    and K beside it."""
    down = theta > beta
    radians, way = np.radians(beta), np.where(down, -1.0, 1.0)
    lift, *rates = _by_series(law, np.where(down, 2 * beta + delta - theta, theta) / beta)
    s1, s2, s3 = (h * rate * (way / radians) ** (n + 1) for n, rate in enumerate(rates))
    back = np.exp(-1j * np.radians(theta))
    C = e + 1j * (np.sqrt((Rb + Rr) ** 2 - e**2) + s)
    tangent, bend = 1j * s1 - 1j * C, 1j * s2 + 2 * s1 - C
    to_contact = (K[..., 0] + 1j * K[..., 1]) / back - C
    size = abs(tangent)
    return (
        (s - h * lift) / h,
        (v - s1 * omega) / (h * omega),
        (a - s2 * omega**2) / (h * omega**2),
        (j - s3 * omega**3) / (h * omega**3),
        (to_contact * np.conj(tangent)).real / (Rr * size),
        (abs(to_contact) - Rr) / Rr,
        np.maximum((to_contact * np.conj(C)).real, 0) / (Rr * size),
        np.sin(np.radians(phi)) - abs(tangent.imag) / size,
        1 + rho * (np.conj(tangent) * bend).imag / size**3,
        (rho_c - rho + Rr) / Rr,
    )


_RADIAN = 180 / np.pi  #: a rise of one radian

KNOWN = (
    # Half of a rise of a quarter of a turn: the greatest speed.
    given(law="harmonic", h=20, beta=90, delta=30, theta=45, omega=2).gives(
        ends="acceleration_jumps", s=10, v=40, a=0, j=-640
    ),
    # A quarter of the rise, half of the speed in the middle; a hollow cam, the normal at 1 to 2.
    given(
        law="parabolic", h=16, beta=_RADIAN, delta=30, theta=_RADIAN / 4, omega=3, Rb=24, Rr=6, e=0, R2=20
    ).gives(
        s=2,
        v=48,
        a=576,
        jump=1152,
        phi=float(np.degrees(np.arctan(0.5))),
        rho=-(1280**1.5) / 512,
        shape="concave",
    ),
    # Halfway down, O, C and I a 3-4-5 triangle.
    given(
        law="polynomial_345",
        h=16,
        beta=_RADIAN,
        delta=30,
        theta=1.5 * _RADIAN + 30,
        omega=1,
        Rb=20,
        Rr=12,
        e=0,
        R2=40,
    ).gives(
        ends="jerk_jumps",
        s=8,
        v=-30,
        a=0,
        j=480,
        phi=float(np.degrees(np.arctan(0.75))),
        rho=125000 / 3400,
        x_K=-7.2,
        y_K=30.4,
        shape="undercut",
    ),
    # Three quarters of the rise, the offset as large as the slope: the follower is lifted along its line.
    given(
        law="cycloidal", h=10, beta=_RADIAN, delta=30, theta=0.75 * _RADIAN, omega=1, Rb=20, Rr=6, e=10, R2=10
    ).gives(s=7.5 + 5 / np.pi, v=10, a=-20 * np.pi, j=0, phi=0, x_K=10, shape="convex"),
    given(law="polynomial_4567", h=32, beta=_RADIAN, delta=30, theta=0.5 * _RADIAN, omega=2).gives(
        ends="jerk_begins_at_zero", s=16, v=140, a=0, j=-13440
    ),
)
