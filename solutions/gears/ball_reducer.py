"""Ball reducer: solution. The frame holds A and B still, so the ball turns about AB at every instant.

Vectors are in the basis (x_a, y_a, z), points from O1. The no-slip conditions at A and B are one
and the same; with those at C and D, three relations tie four rates.
"""

import numpy as np

from coursework.degrees import polar
from coursework.figures import Figure, circle, contact, line, note, point, trace, wheel
from coursework.solution import Film, Moving, formula, given, mistake

UNITS = {"phi_ddot": "rad/s^2"}
EFFECTS = {
    "velocity": ("omega", "phi_dot", "theta_dot", "v_O3", "rolling_D", "spin_D"),
    "acceleration": ("a_O3_x", "a_O3_y"),
}


def _vector(x, y, z):
    """Shape (..., 3)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def graph():
    """Two shafts on pivots of the frame; the ball touches the frame twice and each shaft once."""
    return (
        "0-1 revolute, 0-2 revolute, 0-3 point_contact, 0-3 point_contact, 1-3 point_contact, 2-3 "
        "point_contact"
    )


def omega_why():
    return "A_and_B_at_rest"


def no_slip_A():
    return "(R + r)*phi_dot + r*omega = 0"


def no_slip_B():
    """The same as at A, since the ball turns about AB."""
    return "(R + r)*phi_dot + r*omega = 0"


def no_slip_C():
    return "(R + r)*phi_dot - r*omega - R*psi_dot = 0"


def no_slip_D():
    return "(R + r)*phi_dot - r*omega - (R + r)*theta_dot = 0"


def mobility():
    return 4 - 3


def omega(R, r, psi_dot):
    """From A and C: C, twice as far from A as O3 is, follows the input shaft."""
    return -R * psi_dot / (2 * r)


def phi_dot(R, r, omega):
    """From A."""
    return -r * omega / (R + r)


def theta_dot(R, r, omega):
    """From A and D."""
    return -2 * r * omega / (R + r)


def rho(theta_dot, psi_dot):
    return theta_dot / psi_dot


def phi_ddot(phi_dot, psi_dot, psi_ddot):
    """The ratio of the two rates is constant."""
    return phi_dot * psi_ddot / psi_dot


def v_O3(R, r, phi_dot):
    return (R + r) * phi_dot


def a_O3_x(R, r, phi_dot):
    return -(R + r) * phi_dot**2


def a_O3_y(R, r, phi_ddot):
    return (R + r) * phi_ddot


def axis_30_point(R, r):
    """A."""
    return _vector(R + 2 * r, 0.0, 0.0)


@formula(r"\left(\num{1};\ \num{0};\ \num{1}\right)")
def axis_30_dir(R):
    """From B to A; one direction a configuration, so that its shape follows the given values."""
    one = np.ones_like(R)
    return _vector(one, 0.0, one)


def axis_31_point(R):
    """C."""
    return _vector(R, 0.0, 0.0)


def axis_31_dir(omega, psi_dot):
    """Omega 3/1 = omega (x_a + z) - psi_dot z, over omega."""
    return _vector(1.0, 0.0, 1 - psi_dot / omega)


def axis_32_point(R, r):
    """D."""
    return _vector(R + r, 0.0, r)


def axis_32_dir(omega, theta_dot):
    """Omega 3/2 = omega (x_a + z) - theta_dot z, over omega."""
    return _vector(1.0, 0.0, 1 - theta_dot / omega)


def nature_30():
    return "rotation"


def nature_31():
    return "rotation"


def nature_32():
    return "rotation"


def rolling_D(omega):
    return omega


def spin_D(omega, theta_dot):
    return omega - theta_dot


# The statement's half-section looks the same at every instant: the film looks down along z instead, and sees
# D and B where O3 is. In the basis (x_a, y_a, z) the ball turns about one axis, at Omega 3/0 less phi_dot z.


def _one_round_of_the_ball(psi_dot, phi_dot):
    return psi_dot / phi_dot


def _ball_in_basis(psi, omega, phi_dot, psi_dot):
    """Unit vector of the ball's axis, upwards, and how far it has turned about it, degrees."""
    turning = _vector(1.0, 0.0, 1 - phi_dot / omega)
    return turning / np.linalg.norm(turning), psi * omega / psi_dot * np.linalg.norm(turning)


def _turned(place, axis, angle):
    """A place on the ball, turned about an axis through its centre."""
    angle = np.radians(angle)[..., None]
    along = np.dot(place, axis) * axis
    return along + np.cos(angle) * (place - along) + np.sin(angle) * np.cross(axis, place)


def _seen(vector):
    return vector[..., 0] + 1j * vector[..., 1]


def _seam(axis, place, r):
    """The great circle of the ball through its axis and a place on it: the upper half, which is what one
    sees."""
    normal = np.cross(axis, place)
    normal /= np.linalg.norm(normal)
    end = np.cross((0.0, 0.0, 1.0), normal)
    end /= np.linalg.norm(end)
    top = np.cross(normal, end)
    return [_seen(r * (end * np.cos(s) + top * np.sin(s))) for s in np.linspace(0, np.pi, 13)]


def _spokes(length, angle, label, *, dashed):
    return [
        line(0, polar(length, angle + 120 * k), dashed=dashed, label=label if k == 0 else None)
        for k in range(3)
    ]


def _end_view(psi, R, r, psi_dot, omega, phi_dot, theta_dot):
    phi, theta, outer = psi * phi_dot / psi_dot, psi * theta_dot / psi_dot, R + 2 * r
    x_a = polar(1.0, phi)
    O3 = (R + r) * x_a
    axis, angle = _ball_in_basis(psi, omega, phi_dot, psi_dot)
    seam = _seam(axis, _turned(_vector(1.0, 0.0, 0.0), axis, angle), r)
    return Figure(
        circle(0, outer),
        *(line(polar(outer, a), polar(outer + 0.25 * r, a + 3)) for a in range(0, 360, 12)),
        wheel(0, R),
        wheel(O3, r),
        trace([O3 + x_a * z for z in seam], dotted=False),
        *_spokes(R, psi, "S_1", dashed=False),
        *_spokes(outer, theta, "S_2", dashed=True),
        point(0, "O_1"),
        point(O3, "O_3"),
        contact(outer * x_a, "A"),
        contact(R * x_a, "C"),
        note(polar(outer + 0.8 * r, 135), "S_0"),
    )


def motion(psi, R, r, psi_dot, psi_ddot, omega, phi_dot, theta_dot, v_O3, a_O3_x, a_O3_y):
    """The centre of the ball, and the points of the shafts and of the ball that are at C, D and A at the
    start."""
    phi, theta = psi * phi_dot / psi_dot, psi * theta_dot / psi_dot
    axis, angle = _ball_in_basis(psi, omega, phi_dot, psi_dot)
    from_O3 = _turned(_vector(r, 0.0, 0.0), axis, angle)
    x_a, C_1, D_2 = polar(1.0, phi), polar(R, psi), polar(R + r, theta)
    theta_ddot = theta_dot * psi_ddot / psi_dot
    return {
        "O_3": Moving((R + r) * x_a, 1j * v_O3 * x_a, (a_O3_x + 1j * a_O3_y) * x_a),
        "C_1": Moving(C_1, 1j * psi_dot * C_1, (1j * psi_ddot - psi_dot**2) * C_1),
        "D_2": Moving(D_2, 1j * theta_dot * D_2, (1j * theta_ddot - theta_dot**2) * D_2),
        "A_3": Moving((R + r + _seen(from_O3)) * x_a),  # its velocity leaves the plane of the picture
    }


FILM = Film(_end_view, angle="psi", speed="psi_dot", turns=_one_round_of_the_ball)


# Where two mistakes give one answer, the first is told: what is wrong there before what is wrong earlier.


@mistake("spin_D")
def spin_is_omega(omega):
    return omega


@mistake("spin_D", kind="term_sign")
def spin_plus(omega, theta_dot):
    return omega + theta_dot


@mistake("rolling_D")
def rolling_norm(omega):
    return np.sqrt(2) * abs(omega)


@mistake("nature_30", "nature_31", "nature_32")
def nature_helical():
    return "helical", "helical", "helical"


@mistake("axis_31_dir", "axis_32_dir")
def shaft_left_out(R):
    one = np.ones_like(R)
    return _vector(one, 0.0, one), _vector(one, 0.0, one)


@mistake("axis_31_dir", "axis_32_dir")
def shaft_added(omega, psi_dot, theta_dot):
    return _vector(1.0, 0.0, 1 + psi_dot / omega), _vector(1.0, 0.0, 1 + theta_dot / omega)


@mistake("axis_30_point", "axis_31_point", "axis_32_point")
def axis_through_O3(R, r):
    center = _vector(R + r, 0.0, 0.0)
    return center, center, center


@mistake("a_O3_y")
def notes_phi_dot_for_ddot(R, r, phi_dot):
    return (R + r) * phi_dot


@mistake("v_O3", "a_O3_x", "a_O3_y")
def radius_R(R, phi_dot, phi_ddot):
    return R * phi_dot, -R * phi_dot**2, R * phi_ddot


@mistake("a_O3_x", kind="sign")
def centripetal_sign(a_O3_x):
    return -a_O3_x


@mistake("rho", kind="inverse")
def rho_inverse(rho):
    return 1 / rho


@mistake("theta_dot")
def half_theta(R, r, psi_dot):
    return R * psi_dot / (2 * (R + r))


@mistake("no_slip_D", "theta_dot")
def D_at_radius_R(psi_dot):
    return "(R + r)*phi_dot - r*omega - R*theta_dot = 0", psi_dot


@mistake("phi_dot")
def phi_equals_theta(theta_dot):
    return theta_dot


@mistake("no_slip_A", "no_slip_B", "no_slip_C", "no_slip_D", "omega", kind="sign")
def omega_sign(omega):
    return (
        "(R + r)*phi_dot - r*omega = 0",
        "(R + r)*phi_dot - r*omega = 0",
        "(R + r)*phi_dot + r*omega - R*psi_dot = 0",
        "(R + r)*phi_dot + r*omega - (R + r)*theta_dot = 0",
        -omega,
    )


@mistake("no_slip_C", "omega")
def C_at_radius_of_O3(R, r, psi_dot):
    return "(R + r)*phi_dot - r*omega - (R + r)*psi_dot = 0", -(R + r) * psi_dot / (2 * r)


@mistake("no_slip_C", "no_slip_D", "omega")
def direct_contact(R, r, psi_dot):
    return "r*omega + R*psi_dot = 0", "r*omega + (R + r)*theta_dot = 0", -R * psi_dot / r


@mistake("graph")
def contacts_with_the_frame_as_one():
    return "0-1 revolute, 0-2 revolute, 0-3 point_contact, 1-3 point_contact, 2-3 point_contact"


@mistake("graph")
def shafts_on_one_another():
    """The output shaft pivoted on the input shaft, since they have one axis."""
    return (
        "0-1 revolute, 1-2 revolute, 0-3 point_contact, 0-3 point_contact, 1-3 point_contact, 2-3 "
        "point_contact"
    )


@mistake("no_slip_B")
def B_at_radius_R():
    """The contact B carried about the axis as if it were at C."""
    return "R*phi_dot + r*omega = 0"


@mistake("mobility")
def dependent_condition_counted():
    return 4 - 4


@mistake("mobility")
def no_slip_at_D_left_out():
    return 4 - 2


def residual(
    R,
    r,
    psi_dot,
    psi_ddot,
    omega,
    phi_dot,
    theta_dot,
    v_O3,
    a_O3_x,
    a_O3_y,
    rolling_D,
    spin_D,
    axis_30_point,
    axis_30_dir,
    axis_31_point,
    axis_31_dir,
    axis_32_point,
    axis_32_dir,
):
    """The four no-slip velocities, the motion of O3, and the three axes, with vectors of space."""
    z = _vector(0.0, 0.0, 1.0)
    O3 = _vector(R + r, 0.0, 0.0)
    ball = _vector(omega, 0.0, omega)
    velocity_of_O3 = _vector(0.0, v_O3, 0.0)
    rates = {"0": np.zeros(3), "1": _along(psi_dot, z), "2": _along(theta_dot, z)}
    across = {"A": _vector(r, 0.0, 0.0), "B": _vector(0.0, 0.0, -r)}
    across |= {"C": _vector(-r, 0.0, 0.0), "D": _vector(0.0, 0.0, r)}

    def slip(place, body):
        return velocity_of_O3 + np.cross(ball, place - O3) - np.cross(rates[body], place)

    speed = R * abs(psi_dot)
    bodies = {"A": "0", "B": "0", "C": "1", "D": "2"}
    slips = [_norm(slip(O3 + across[place], body)) / speed for place, body in bodies.items()]
    turned = np.cross(_along(phi_dot, z), O3)
    # The ball turns about A: O3 has half the velocity of C, which is R psi_dot.
    acceleration = _along(a_O3_x, _vector(1.0, 0.0, 0.0)) + _along(a_O3_y, _vector(0.0, 1.0, 0.0))
    expected = np.cross(_along(phi_dot, z), velocity_of_O3) + _vector(0.0, R * psi_ddot / 2, 0.0)
    axes = ((axis_30_point, axis_30_dir), (axis_31_point, axis_31_dir), (axis_32_point, axis_32_dir))
    at_rest = [_norm(slip(place, body)) / speed for body, (place, _) in zip("012", axes, strict=True)]
    parallel = [
        _norm(np.cross(ball - rates[body], way)) / (_norm(ball) * _norm(way))
        for body, (_, way) in zip("012", axes, strict=True)
    ]
    at_D = _vector(rolling_D, 0.0, spin_D) - (ball - rates["2"])
    return (
        *slips,
        _norm(turned - velocity_of_O3) / speed,
        _norm(acceleration - expected) / (R * (psi_dot**2 + abs(psi_ddot))),
        *at_rest,
        *parallel,
        _norm(at_D) / _norm(ball),
    )


def _along(rate, way):
    return np.asarray(rate)[..., None] * way


def _norm(vector):
    return np.linalg.norm(vector, axis=-1)


KNOWN = (
    # R = 2 r: the ball turns as fast as the input, backwards, and all ratios are thirds.
    given(R=20, r=10, psi_dot=30, psi_ddot=6).gives(
        mobility=1,
        omega=-30,
        phi_dot=10,
        theta_dot=20,
        rho=2 / 3,
        v_O3=300,
        a_O3_x=-3000,
        a_O3_y=60,
        rolling_D=-30,
        spin_D=-50,
    ),
    # R = 3 r, input the other way and gaining speed.
    given(R=60, r=20, psi_dot=-80, psi_ddot=-40).gives(
        omega=120,
        phi_dot=-30,
        theta_dot=-60,
        rho=0.75,
        v_O3=-2400,
        a_O3_x=-72000,
        a_O3_y=-1200,
        rolling_D=120,
        spin_D=180,
    ),
    # A ball bearing of pitch diameter 100 with balls of 20, inner ring driven: its cage turns at
    # (1 - 20/100)/2 of the ring.
    given(R=40, r=10, psi_dot=5, psi_ddot=0).gives(phi_dot=2, a_O3_y=0, theta_dot=4),
)
