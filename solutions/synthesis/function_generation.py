"""Function generation: solution. Freudenstein's equation is linear in three ratios of lengths: three points
give them.

The judge moves the student's own linkage through the range, in the assembly that suits it better.
"""

from functools import reduce

import numpy as np

from coursework.degrees import angle, cos, polar, sin, sqrt, wrap
from coursework.errors import Undefined
from coursework.figures import Figure, ground_pivot, line, link, pin
from coursework.solution import Judged, formula, given, judge, mistake, stable

UNITS = {
    "a": "1",
    "b": "1",
    "x2": "1",
    "x3": "1",
    "y1": "1",
    "y2": "1",
    "y3": "1",
    "ya": "1",
    "yb": "1",
    "theta2_2": "deg",
    "theta2_3": "deg",
    "theta4_1": "deg",
    "theta4_3": "deg",
    "p1": "1",
    "p3": "1",
    "q1": "1",
    "q3": "1",
    "w1": "1",
    "w3": "1",
    "K1": "1",
    "K2": "1",
    "K3": "1",
    "deviation": "deg",
    "least_transmission": "deg",
}
SYMBOLS = {
    "x2": "x_2",
    "x3": "x_3",
    "ya": "f(a)",
    "yb": "f(b)",
    "y1": "y_1",
    "y2": "y_2",
    "y3": "y_3",
    "theta2_2": r"\theta_2^2",
    "theta2_3": r"\theta_2^3",
    "theta4_1": r"\theta_4^1",
    "theta4_3": r"\theta_4^3",
    "p1": "p_1",
    "p3": "p_3",
    "q1": "q_1",
    "q3": "q_3",
    "w1": "w_1",
    "w3": "w_3",
    "deviation": r"\varepsilon_{\max}",
    "least_transmission": r"\mu_{\min}",
}
_RANGES = {"logarithm": (1.0, 2.0), "inverse": (1.0, 2.0), "sine": (0.0, 1.0), "root": (1.0, 4.0)}
_TURN = 360.0


def _of(law, x):
    """The function."""
    positive = np.maximum(x, 0.5)
    values = {
        "logarithm": np.log(positive) / np.log(10.0),
        "inverse": 1 / positive,
        "root": sqrt(positive),
    }
    found = sin(90 * x)
    for name, value in values.items():
        found = np.where(law == name, value, found)[()]
    return found


def _end(law, which):
    found = 0.0
    for name, ends in _RANGES.items():
        found = np.where(law == name, ends[which], found)[()]
    return found


def a(law):
    return _end(law, 0)


def b(law):
    return _end(law, 1)


@formula(r"\frac{<a> + <b>}{2} - \frac{<b> - <a>}{2} \times \cos 30^{\circ}")
def x1(a, b):
    return (a + b) / 2 - (b - a) / 2 * cos(30)


def x2(a, b):
    return (a + b) / 2


@formula(r"\frac{<a> + <b>}{2} + \frac{<b> - <a>}{2} \times \cos 30^{\circ}")
def x3(a, b):
    return (a + b) / 2 + (b - a) / 2 * cos(30)


def ya(law, a):
    """Of the logarithm from 1 on it is 0, whatever the last bit of the bound is."""
    value = _of(law, a)
    return np.where(abs(value) < 1e-9, 0.0, value)[()]


def yb(law, b):
    return _of(law, b)


def y1(law, x1):
    return _of(law, x1)


def y2(law, x2):
    return _of(law, x2)


def y3(law, x3):
    return _of(law, x3)


def _sweep(degrees):
    """A range within a turn, which is not the same as one that is a turn longer."""
    if np.ndim(degrees) == 0 and abs(degrees) >= _TURN:
        raise Undefined(f"crank and rocker are to turn by less than a turn; found {degrees:g} degrees")
    return np.where(abs(degrees) < _TURN, degrees, np.nan)[()]


def _sweep2(range2):
    return _sweep(range2)


def _sweep4(range4):
    return _sweep(range4)


@stable(lambda theta2_0, _sweep2, x1, a, b: wrap(wrap(theta2_0) + _sweep2 * (x1 - a) / (b - a)))
def theta2_1(theta2_0, range2, x1, a, b):
    return wrap(theta2_0 + range2 * (x1 - a) / (b - a))


@stable(lambda theta2_0, _sweep2, x2, a, b: wrap(wrap(theta2_0) + _sweep2 * (x2 - a) / (b - a)))
def theta2_2(theta2_0, range2, x2, a, b):
    return wrap(theta2_0 + range2 * (x2 - a) / (b - a))


@stable(lambda theta2_0, _sweep2, x3, a, b: wrap(wrap(theta2_0) + _sweep2 * (x3 - a) / (b - a)))
def theta2_3(theta2_0, range2, x3, a, b):
    return wrap(theta2_0 + range2 * (x3 - a) / (b - a))


@stable(lambda theta4_0, _sweep4, y1, ya, yb: wrap(wrap(theta4_0) + _sweep4 * (y1 - ya) / (yb - ya)))
def theta4_1(theta4_0, range4, y1, ya, yb):
    return wrap(theta4_0 + range4 * (y1 - ya) / (yb - ya))


@stable(lambda theta4_0, _sweep4, y2, ya, yb: wrap(wrap(theta4_0) + _sweep4 * (y2 - ya) / (yb - ya)))
def theta4_2(theta4_0, range4, y2, ya, yb):
    return wrap(theta4_0 + range4 * (y2 - ya) / (yb - ya))


@stable(lambda theta4_0, _sweep4, y3, ya, yb: wrap(wrap(theta4_0) + _sweep4 * (y3 - ya) / (yb - ya)))
def theta4_3(theta4_0, range4, y3, ya, yb):
    return wrap(theta4_0 + range4 * (y3 - ya) / (yb - ya))


def _steps(range2, range4, y1, y2, y3, ya, yb):
    """By how much crank and rocker turn from the second precision point to the first and to the third."""
    by_crank = range2 * sqrt(3 + 0 * range2) / 4
    return (-by_crank, range4 * (y1 - y2) / (yb - ya)), (by_crank, range4 * (y3 - y2) / (yb - ya))


def _cosines(angle, step):
    """How much the cosine changes from an angle on; in digits that a small step keeps."""
    return -2 * sin(angle + step / 2) * sin(step / 2)


@stable(lambda theta4_2, _steps: _cosines(theta4_2, _steps[0][1]))
def p1(theta4_1, theta4_2):
    return cos(theta4_1) - cos(theta4_2)


@stable(lambda theta4_2, _steps: _cosines(theta4_2, _steps[1][1]))
def p3(theta4_3, theta4_2):
    return cos(theta4_3) - cos(theta4_2)


@stable(lambda theta2_2, _steps: _cosines(theta2_2, _steps[0][0]))
def q1(theta2_1, theta2_2):
    return cos(theta2_1) - cos(theta2_2)


@stable(lambda theta2_2, _steps: _cosines(theta2_2, _steps[1][0]))
def q3(theta2_3, theta2_2):
    return cos(theta2_3) - cos(theta2_2)


@stable(lambda theta2_2, theta4_2, _steps: _cosines(theta2_2 - theta4_2, _steps[0][0] - _steps[0][1]))
def w1(theta2_1, theta4_1, theta2_2, theta4_2):
    return cos(theta2_1 - theta4_1) - cos(theta2_2 - theta4_2)


@stable(lambda theta2_2, theta4_2, _steps: _cosines(theta2_2 - theta4_2, _steps[1][0] - _steps[1][1]))
def w3(theta2_3, theta4_3, theta2_2, theta4_2):
    return cos(theta2_3 - theta4_3) - cos(theta2_2 - theta4_2)


def K1(p1, p3, q1, q3, w1, w3):
    return (w1 * q3 - w3 * q1) / (p1 * q3 - p3 * q1)


def K2(p1, p3, q1, q3, w1, w3):
    return (w1 * p3 - w3 * p1) / (p1 * q3 - p3 * q1)


def K3(K1, K2, theta2_2, theta4_2):
    """The equation itself at the second point."""
    return cos(theta2_2 - theta4_2) - K1 * cos(theta4_2) + K2 * cos(theta2_2)


def r2(r1, K1):
    return r1 / K1


def r4(r1, K2):
    return r1 / K2


@stable(lambda r1, K1, K2, theta2_2, theta4_2: abs(r1 + polar(r1 / K2, theta4_2) - polar(r1 / K1, theta2_2)))
def r3(r1, r2, r4, K3):
    return sqrt(r1**2 + r2**2 + r4**2 - 2 * r2 * r4 * K3)


_STEPS = 180  #: of the range, in which the motion is followed
_OPEN = 180.0  #: degrees, the error of a linkage that does not close all along


def _at(share, K1, K2, level, law, theta2_0, range2, theta4_0, range4):
    """At a share of the range: the error in either assembly, and the lesser angle of coupler and rocker,
    degrees.

    By Freudenstein's equation, since links without end, or of no length, cost a triangle of lengths its
    digits. ``level`` is ``K2 cos(theta2) - K3`` in the middle of the range.
    """
    a, b = _end(law, 0), _end(law, 1)
    rise = (_of(law, a + (b - a) * share) - _of(law, a)) / (_of(law, b) - _of(law, a))
    crank = polar(1.0, theta2_0 + range2 * share)
    to_C = K1 - crank
    cosine = (level + K2 * _cosines(theta2_0 + range2 / 2, range2 * (share - 0.5))) / abs(to_C)
    closes = abs(cosine) <= 1
    cosine = np.where(closes, cosine, 1.0)[()]
    sine = sqrt((1 - cosine) * (1 + cosine))
    rockers = [to_C / abs(to_C) * (cosine + side * 1j * sine) for side in (-1, 1)]
    # Turned back by what is wanted: differences of large angles would cost digits of a small error.
    ahead = (angle(rocker * polar(1.0, -theta4_0) * polar(1.0, -range4 * rise)) for rocker in rockers)
    mu = abs(angle((K1 * K2 - K2 * crank) * np.conjugate(rockers[0]) + K1))
    return (
        *(np.where(closes, abs(error), _OPEN)[()] for error in ahead),
        np.where(closes, np.minimum(mu, 180 - mu), 0.0)[()],
    )


def _motion(*linkage):
    """The structural error in the better assembly, and the least angle of coupler and rocker, 0 where it does
    not close."""
    shares = np.arange(_STEPS + 1) / _STEPS
    if not all(isinstance(value, (str, float, int, np.generic, np.ndarray)) for value in linkage):
        # Numbers of many digits, one by one.
        first, second, mu = zip(*(_at(share, *linkage) for share in shares.tolist()), strict=True)
        return np.minimum(reduce(np.maximum, first), reduce(np.maximum, second)), reduce(np.minimum, mu)
    first, second, mu = _at(shares, *(np.asarray(value)[..., None] for value in linkage))
    return np.minimum(first.max(axis=-1), second.max(axis=-1))[()], mu.min(axis=-1)[()]


def _moved(K1, K2, theta2_2, theta4_2, law, theta2_0, _sweep2, theta4_0, _sweep4):
    level = K1 * cos(theta4_2) - cos(theta2_2 - theta4_2)
    return _motion(K1, K2, level, law, wrap(theta2_0), _sweep2, wrap(theta4_0), _sweep4)


def worst(_moved):
    """By the motion of the linkage, in steps of a 180th of the range."""
    return _moved[0]


def least_transmission(_moved):
    return _moved[1]


LENGTHS = ("r2", "r3", "r4")


def _motion_of(r1, r2, r3, r4, law, theta2_0, range2, theta4_0, range4):
    """The motion of a linkage of these lengths."""
    K3 = (r1**2 + r2**2 + r4**2 - r3**2) / (2 * r2 * r4)
    level = r1 / r4 * cos(theta2_0 + range2 / 2) - K3
    return _motion(r1 / r2, r1 / r4, level, law, theta2_0, range2, theta4_0, range4)


@judge
def generates_the_function(answers, r1, law, theta2_0, range2, theta4_0, range4, delta, K1, K2):
    """Any linkage of this frame, by its own motion; its structural error as it really is."""
    own = {name: np.float64(answers[name]) for name in LENGTHS if name in answers}
    if len(own) < 3:
        return {}
    demands = (law, theta2_0, range2, theta4_0, range4)
    with np.errstate(all="ignore"):  # lengths without end close nowhere
        verdict, deviation = _judged(r1, **own, demands=demands, delta=delta, K1=K1, K2=K2)
    said = dict.fromkeys(own, verdict)
    if "worst" in answers:
        said["worst"] = _error(float(answers["worst"]), deviation, verdict.share < 1)
    return said


def _judged(r1, r2, r3, r4, demands, delta, K1, K2):
    if min(r2, r3, r4) <= 0:
        return Judged(0.0, "does_not_close"), _OPEN
    deviation = float(_motion_of(r1, r2, r3, r4, *demands)[0])
    found = {"deviation": deviation} if deviation < _OPEN else {}
    if deviation <= delta:
        return Judged(1.0, "", found), deviation
    if abs(r2 - r1 * K1) < 0.01 * r2 and abs(r4 - r1 * K2) < 0.01 * r4:
        return Judged(0.0, "ratios_upside_down", found), deviation
    if float(_motion_of(r1, r4, r3, r2, *demands)[0]) <= delta:
        return Judged(0.0, "crank_and_rocker_exchanged", found), deviation
    if deviation == _OPEN:
        return Judged(0.0, "does_not_close"), deviation
    return Judged(0.5 if deviation <= 2 * delta else 0.0, "deviates", found), deviation


def _error(said, deviation, is_wrong):
    right = deviation < _OPEN and abs(abs(said) - deviation) <= max(0.1, deviation / 20)
    return Judged(follows=is_wrong) if right else Judged(0.0)


@mistake("x1")
def equal_spacing(a, b):
    """A quarter of the range."""
    return a + (b - a) / 4


@mistake("x1")
def end_of_the_range(a):
    return a


@mistake("theta2_1", kind="term")
def start_left_out(range2, x1, a, b):
    return range2 * (x1 - a) / (b - a)


@mistake("theta4_2")
def in_proportion_to_x(theta4_0, range4, x2, a, b):
    return wrap(wrap(theta4_0) + range4 * (x2 - a) / (b - a))


@mistake("r2", "r4")
def ratios_upside_down(r1, K1, K2):
    return r1 * K1, r1 * K2


@mistake("r2", "r4", kind="exchanged")
def crank_and_rocker_exchanged(r2, r4):
    return r4, r2


@mistake("r2", "r3", "r4")
def deviates(r1):
    """A parallelogram, whose rocker turns as its crank does."""
    return r1 / 2, r1, r1 / 2


@mistake("r3")
def does_not_close(r1, r2, r4):
    return (r1 + r2 + r4) / 50


def figure(r1, r2, r3, r4, theta2_1, theta4_1, theta2_2, theta4_2, theta2_3, theta4_3):
    """The linkage found, at its three precision points."""
    O, C = 0j, complex(r1)
    first, middle, last = (
        (polar(r2, theta2), C + polar(r4, theta4))
        for theta2, theta4 in ((theta2_1, theta4_1), (theta2_2, theta4_2), (theta2_3, theta4_3))
    )
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        *(line(*ends, thin=False) for A, B in (first, last) for ends in ((O, A), (A, B), (C, B))),
        link(O, middle[0], label="r_2"),
        link(*middle, label="r_3"),
        link(C, middle[1], label="r_4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        *(pin(A, f"A_{k}") for k, (A, _) in enumerate((first, middle, last), 1)),
        *(pin(B, f"B_{k}") for k, (_, B) in enumerate((first, middle, last), 1)),
    )


def residual(law, r1, theta2_0, range2, theta4_0, range4, r2, r3, r4, worst):
    """At each precision point the pins are as far apart as the coupler is long; the worst of a finer
    motion."""
    ends = {"logarithm": (1, 2), "inverse": (1, 2), "sine": (0, 1), "root": (1, 4)}
    start, stop = (np.select([law == name for name in ends], [e[k] for e in ends.values()]) for k in (0, 1))

    def f(x):
        with np.errstate(divide="ignore"):
            values = (np.log10(x), 1 / x, np.sin(np.pi / 2 * x), x**0.5)
        return np.select([law == name for name in ends], values)

    found = []
    for share in (0.5 - 0.75**0.5 / 2, 0.5, 0.5 + 0.75**0.5 / 2):
        x = start + (stop - start) * share
        rise = (f(x) - f(start)) / (f(stop) - f(start))
        A = r2 * np.exp(1j * np.radians(theta2_0 + range2 * share))
        B = r1 + r4 * np.exp(1j * np.radians(theta4_0 + range4 * rise))
        found.append((abs(B - A) - r3) / (r1 + r2 + r3 + r4))
    return tuple(found)


KNOWN = (
    # The middle of the range, its cosines of 30 degrees to both sides.
    given(law="logarithm", theta2_0=40, range2=60).gives(x1=1.5 - 3**0.5 / 4, theta2_1=70 - 15 * 3**0.5),
    given(law="sine").gives(x1=0.5 - 3**0.5 / 4, x3=0.5 + 3**0.5 / 4),
    # A parallelogram turns its rocker as its crank: with these angles at three points, K3 is the cosine of
    # nothing.
    given(
        r1=100, theta2_1=40, theta4_1=40, theta2_2=70, theta4_2=70, theta2_3=100, theta4_3=100, K1=2, K2=2
    ).gives(K3=1, r2=50, r4=50, r3=100),
    # Between 1 and 4 the root goes from 1 to 2.
    given(law="root", theta4_0=50, range4=70).gives(ya=1, yb=2, theta4_2=50 + 70 * (2.5**0.5 - 1)),
)
