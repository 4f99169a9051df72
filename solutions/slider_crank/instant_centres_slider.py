"""Instant centres of a slider-crank: solution. Through a centre at infinity pass the lines perpendicular to
the guide.

I13 is above or below B on the line of the crank, I24 above or below O on the line of the rod.
"""

import numpy as np

from coursework.degrees import atan2, polar, sin, sqrt, tan
from coursework.errors import Undefined
from coursework.figures import Figure, ground_pivot, line, link, pin, point, slider, vector
from coursework.figures.polygons import crank_v, polygon_of_velocities, slider_v
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import formula, given, mistake, stable

UNITS = {"p": "mm", "q": "mm", "theta3": "deg", "x_B": "mm", "l_M": "mm"}
SYMBOLS = {"x_B": "x_B", "l_M": r"I_{13}M"}
EFFECTS = {"position": ("y24", "y13"), "velocity": ("v_B", "omega3", "v_M")}
MECHANISM = Mechanism(
    ground={"O": 0},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3", "M": lambda r3: r3 / 2}),
        Body("4", 0, "B"),
    ),
    slides=(Slide("B", "4"),),
)


def where_14():
    return "across_the_guide"


def where_34():
    return "at_the_pin"


def where_12():
    return "at_the_pivot"


def p(e, r2, theta2):
    """Height of B above A: r3 sin theta3."""
    return e - r2 * sin(theta2)


@stable(lambda r2, r3, e, theta2: SliderCrank(r2, r3, e).run(Degrees(theta2)))
def q(r3, p):
    """Distance of B to the right of A: r3 cos theta3, positive."""
    return sqrt(r3**2 - p**2)


def theta3(p, q):
    """Direction of AB, to the right of A: between -90 and 90 degrees."""
    return atan2(p, q)


@formula(r"<r2> \times \cos <theta2> + <q>")
def x_B(r2, theta2, q):
    return polar(r2, theta2).real + q


@stable(lambda r2, theta2, p, q: polar(r2, theta2).imag - polar(r2, theta2).real * p / q)
def y24(e, x_B, theta3):
    """On the line of the rod, at the abscissa of O."""
    return e - x_B * tan(theta3)


def v_B(y24, omega2):
    """I24 as a point of the crank; all points of the piston go alike."""
    return -y24 * omega2


def y13(x_B, theta2):
    """On the line of the crank, at the abscissa of B."""
    if np.ndim(theta2) == 0 and theta2 % 180 == 90:
        raise Undefined("the crank is perpendicular to the guide: the rod's instant centre is at infinity")
    return x_B * tan(theta2)


@formula(r"\frac{<v_B>}{<y13> - <e>}")
@stable(lambda r2, omega2, theta2, q: -polar(r2, theta2).real * omega2 / q)
def omega3(v_B, y13, e):
    """The rod turns about I13, and its end B goes as the piston does."""
    return v_B / (y13 - e)


@formula(r"\sqrt{\frac{<q>^2}{4} + \left(<y13> - <e> + \frac{<p>}{2}\right)^2}")
def l_M(p, q, y13, e):
    """From I13 to the midpoint of the rod."""
    return np.hypot(q / 2, y13 - e + p / 2)


@formula(r"<l_M> \times \left|<omega3>\right|")
@stable(lambda p, q, omega3, v_B: np.hypot(v_B + omega3 * p / 2, omega3 * q / 2))
def v_M(l_M, omega3):
    return l_M * abs(omega3)


@mistake("where_14")
def along_its_own_motion():
    """The direction of the velocity for that of the centre."""
    return "along_the_guide"


@mistake("where_14")
def piston_as_if_pivoted():
    return "at_the_pin"


@mistake("where_34")
def pin_overlooked():
    return "across_the_guide"


@mistake("where_12")
def pivot_overlooked():
    return "at_the_pin"


@mistake("y24", "y13")
def heights_exchanged(y24, y13):
    return y13, y24


@mistake("y24", "y13")
def heights_from_A(y24, y13, r2, theta2):
    return y24 - r2 * sin(theta2), y13 - r2 * sin(theta2)


@mistake("v_B")
def speed_of_A(r2, omega2):
    return r2 * omega2


@mistake("omega3")
def about_O(r2, omega2, x_B, y13):
    """A turns about I13 at the distance OI13."""
    return -r2 * omega2 / np.hypot(x_B, y13) * np.sign(y13 * x_B)


@mistake("v_M")
def about_A(r3, omega3):
    return r3 / 2 * abs(omega3)


@mistake("v_M")
def mean_of_the_ends(r2, omega2, v_B):
    return (r2 * abs(omega2) + abs(v_B)) / 2


def polygons(r2, theta2, omega2, p, q, omega3, v_B):
    """The same velocities without any centre."""
    return (
        polygon_of_velocities(
            crank_v("A", "OA", polar(r2, theta2), omega2), slider_v("B", "A", q + 1j * p, omega3, v_B)
        ),
    )


def figure(r2, theta2, p, q, x_B, e, omega2, omega3, v_B, y13, y24):
    """The lines that cross at both centres, and three velocities, perpendicular to those from I13."""
    O, A, B, I13, I24 = 0j, polar(r2, theta2), complex(x_B, e), complex(x_B, y13), 1j * y24
    M = (A + B) / 2
    v_A, v_M = 1j * omega2 * A, 1j * omega3 * (M - I13)
    scale = r2 / max(abs(v_A), abs(v_M), abs(v_B))
    return Figure(
        *(line(end, I13, dashed=True) for end in (O, A, B, M)),
        *(line(end, I24, dashed=True) for end in (O, A, B)),
        link(O, A),
        link(A, B),
        slider(B),
        vector(A, scale * v_A, "v_A"),
        vector(M, scale * v_M, "v_M"),
        vector(B, scale * complex(v_B), "v_B"),
        ground_pivot(O, "I_{12}"),
        pin(A, "I_{23}"),
        pin(B, "I_{34}"),
        point(M, "M"),
        point(I13, "I_{13}"),
        point(I24, "I_{24}"),
        paper_mm=(120, 90),
    )


def residual(r2, r3, e, theta2, omega2, theta3, y24, v_B, y13, omega3, v_M):
    """The rod's end keeps to its line, also in its velocity; each centre is on its two lines."""
    crank, bar = r2 * np.exp(1j * np.radians(theta2)), r3 * np.exp(1j * np.radians(theta3))
    end = crank + bar
    v_A, at_end = 1j * omega2 * crank, 1j * (omega2 * crank + omega3 * bar)
    speed, I13 = r2 * abs(omega2), end.real + 1j * y13
    return (
        abs(end.imag - e) / r3,
        np.maximum(-bar.real, 0) / r3,
        abs(at_end - v_B) / speed,
        ((1j * y24 - crank) * np.conj(bar)).imag / (r3 * (r2 + abs(y24))),
        (I13 * np.conj(crank)).imag / (r2 * abs(I13)),
        (v_M - abs(v_A + v_B) / 2) / speed,
    )


KNOWN = (
    # Crank and rod equal: I13 is on the circle about O of twice the radius, and B at x = 2 r2 cos theta2.
    given(r2=50, r3=50, e=0, theta2=60, omega2=2).gives(
        y13=50 * 3**0.5, y24=50 * 3**0.5, v_B=-100 * 3**0.5, omega3=-2
    ),
    # A at (40, 30), the rod a 3-4-5 triangle: B at (80, 0).
    given(r2=50, r3=50, e=0, theta2=float(np.degrees(np.arctan2(3, 4))), omega2=10).gives(
        y13=60, y24=60, v_B=-600, omega3=-10
    ),
    # A at (0, 40) and the line 40 below O, the rod at 45 degrees: the rod translates, I13 is at infinity.
    given(r2=40, r3=80 * 2**0.5, e=-40, theta2=90, omega2=5).gives(y24=40, v_B=-200, omega3=0),
    # A at (-30, 40), a rod of 65 down to the line 15: 25 down, 60 across.
    given(r2=50, r3=65, e=15, theta2=float(np.degrees(np.arctan2(4, -3))), omega2=6).gives(
        y13=-40, y24=27.5, v_B=-165, omega3=3, where_14="across_the_guide"
    ),
)
