"""Shaper that cuts: the crank's torque by the power that the ram takes, and the flywheel that evens out the
turn.

The cutting force acts on the working stroke alone, on which the guide turns the same way as the crank, and
takes the same work of every turn. Where the torque equals its mean, the flywheel turns from storing to giving
and back: these two crank angles are zeros of a smooth function of the whole turn, refined to neighbouring
doubles for any number of variants at once.
"""

from dataclasses import replace
from math import pi

import numpy as np

from coursework.degrees import atan2, cos, from_radians, polar, sin, sqrt
from coursework.errors import Undefined
from coursework.figures import Figure, line, note, section, trace, vector
from coursework.kinematics.cycle import turning_points
from coursework.kinematics.vectors import cross, dot
from coursework.mechanics import Load
from coursework.solution import formula, given, mistake, stable

from ._slotted_ram import *
from ._slotted_ram import MECHANISM as _SHAPER
from ._swinging import *

UNITS = {
    "theta5": "deg",
    "rA": "mm",
    "theta4": "deg",
    "omega4": "rad/s",
    "xP": "mm",
    "yP": "mm",
    "p": "mm",
    "q": "mm",
    "omega5": "rad/s",
    "xC": "mm",
    "load": "N",
    "stroke": "mm",
    "sigma": "deg",
    "theta4_rise": "deg",
    "theta4_fall": "deg",
    "xC_rise": "mm",
    "xC_fall": "mm",
    "travel": "mm",
    "arc": "deg",
}
SYMBOLS = {
    "xP": "x_P",
    "yP": "y_P",
    "xC": "x_C",
    "load": "F_x",
    "stroke": "s",
    "theta4_rise": r"\theta_4'",
    "theta4_fall": r"\theta_4''",
    "xC_rise": "x_C'",
    "xC_fall": "x_C''",
    "travel": r"\ell",
    "arc": r"\gamma",
}
EFFECTS = {"forces": ("torque",)}
MECHANISM = replace(_SHAPER, loads=(Load("C", force="F", against=True, during="working stroke"),))


@formula(r"-<F> \times \operatorname{sgn} <v_C>")
def load(F, omega2, omega4, v_C):
    """On the ram, positive to the right: against its motion, while the guide turns with the crank."""
    return np.where(omega2 * omega4 > 0, -F * np.sign(v_C), 0.0)[()]


def torque(v_C, omega2, load=0.0):
    """Torque of the drive, balanced by the cutting force; N*m."""
    return -load * v_C / (1000 * omega2)


def _one_way(turn):
    """The stroke, where the ram goes it without turning back on the way."""
    if np.ndim(turn.stroke) == 0 and turn.lines_up:
        raise Undefined(
            "C turns back more than twice a turn: the rod lines up with the guide within its swing, "
            "so that no one stroke is the working stroke"
        )
    return np.where(turn.lines_up, np.nan, turn.stroke)[()]


@stable(lambda F, _turn: F * _one_way(_turn) / 1000)
def work(F, stroke):
    """Of the cutting force over a turn, J; nothing on the way back."""
    return F * stroke / 1000


def mean_torque(work):
    """The same work over a turn, that is 2 pi."""
    return work / (2 * pi)


def power(mean_torque, omega2):
    """Of the drive, on the average."""
    return mean_torque * omega2


def _ram(theta, r1, r2, r4, r5, h):
    """First and second derivative of xC by the crank angle, mm per radian, at degrees of it."""
    x, y = r2 * cos(theta), r1 + r2 * sin(theta)
    arm = sqrt(x**2 + y**2)
    across, up = x / arm, y / arm
    rate = r2 * (r2 + r1 * sin(theta)) / arm**2
    gain = r1 * across * (1 - 2 * rate) / arm
    p = h - r4 * up
    q = sqrt((r5 - p) * (r5 + p))
    rod_rate = -rate * r4 * across / q
    rod_gain = (p * rod_rate**2 - r4 * (gain * across - rate**2 * up)) / q
    second = -r4 * (gain * up + rate**2 * across) - p * rod_gain - q * rod_rate**2
    return -rate * r4 * up - rod_rate * p, second


def _excess_of_speed(theta, r1, r2, r4, r5, h):
    """Displacement of the ram to the left per radian of the crank, beyond the average over a turn."""
    return -_ram(theta, r1, r2, r4, r5, h)[0] - r4 * r2 / (pi * r1)


def _crossing(low, high, *lengths):
    """Crank angle at which the torque equals its mean, between one where it is less and one where it is more:
    by bisection, then by Newton's method."""
    for _ in range(10):
        middle = 0.5 * (low + high)
        is_less = _excess_of_speed(middle, *lengths) < 0
        low, high = np.where(is_less, middle, low)[()], np.where(is_less, high, middle)[()]
    theta = 0.5 * (low + high)
    for _ in range(7):
        theta = theta + from_radians(_excess_of_speed(theta, *lengths) / _ram(theta, *lengths)[1])
    return theta


def _crossings(r1, r2, r4, r5, h, _turn):
    """The two crank angles at which the torque equals its mean, degrees from -90 to 270, along a last
    axis."""
    lengths = np.broadcast_arrays(r1, r2, r4, r5, h)
    flat = [np.ravel(np.asarray(length, dtype=float)) for length in lengths]
    found = from_radians(
        turning_points(lambda angle, *given: _excess_of_speed(from_radians(angle), *given), flat)
    )
    found = np.sort((found + 90) % 360 - 90, axis=-1).reshape(*lengths[0].shape, -1)
    two = (np.isfinite(found).sum(axis=-1) == 2) & np.isfinite(_one_way(_turn))
    if np.ndim(two) == 0 and not two:
        raise Undefined(
            f"the torque equals its mean at {int(np.isfinite(found).sum())} crank angles, not two: "
            "the flywheel gives more than once a turn"
        )
    return np.where(two[..., None], found[..., :2], np.nan)


@stable(lambda _crossings: _crossings[..., 0][()])
def theta_rise(r1, r2, r4, r5, h):
    """Crank angle at which the torque rises above its mean, and the flywheel begins to give energy."""
    return _crossing(-90.0, 90.0, r1, r2, r4, r5, h)


@stable(lambda _crossings: _crossings[..., 1][()])
def theta_fall(r1, r2, r4, r5, h):
    """Crank angle at which the torque falls below its mean, and the flywheel begins to store energy."""
    return _crossing(270.0, 90.0, r1, r2, r4, r5, h)


def theta4_rise(r1, r2, theta_rise):
    """Direction of the guide there."""
    return atan2(r1 + r2 * sin(theta_rise), r2 * cos(theta_rise))


def theta4_fall(r1, r2, theta_fall):
    return atan2(r1 + r2 * sin(theta_fall), r2 * cos(theta_fall))


def xC_rise(r4, r5, h, theta4_rise):
    """The ram there."""
    return r4 * cos(theta4_rise) + sqrt(r5**2 - (h - r4 * sin(theta4_rise)) ** 2)


def xC_fall(r4, r5, h, theta4_fall):
    return r4 * cos(theta4_fall) + sqrt(r5**2 - (h - r4 * sin(theta4_fall)) ** 2)


def _way_of_the_ram(r1, r2, r4, r5, h, _crossings):
    """From one crossing to the other, from the difference of the two crank pins, which loses nothing beside
    r1."""
    crank = polar(r2, np.moveaxis(_crossings, -1, 0))
    arm, moved = 1j * r1 + crank[0], crank[1] - crank[0]
    turn = np.arctan2(cross(arm, moved), dot(arm, arm + moved))
    pin = r4 * arm / np.sqrt(dot(arm, arm))
    step = pin * 2j * np.sin(turn / 2) * np.exp(0.5j * turn)
    rises = h - pin.imag, h - (pin + step).imag
    runs = (np.sqrt((r5 - rise) * (r5 + rise)) for rise in rises)
    return -(step.real + step.imag * sum(rises) / sum(runs))[()]


@stable(lambda _way_of_the_ram: _way_of_the_ram)
def travel(xC_rise, xC_fall):
    """Of the ram, to the left."""
    return xC_rise - xC_fall


def arc(theta_fall, theta_rise):
    """Rotation of the crank while the torque is above its mean."""
    return theta_fall - theta_rise


@formula(
    r"\frac{<F> \times <travel>}{\num{1000}} - <mean_torque> \times 2\pi \times \frac{<arc>}{360^{\circ}}"
)
def excess(F, travel, mean_torque, arc):
    """Energy that the flywheel gives: the work of the cut minus that of the drive meanwhile; J."""
    return F * travel / 1000 - mean_torque * 2 * pi * arc / 360


def J(excess, delta, omega2):
    """The kinetic energy changes by J times the mean speed times the range of speeds, delta omega2."""
    return excess / (delta * omega2**2)


@mistake("theta4", "omega4")
def guide_turns_with_crank(theta2, omega2):
    return theta2, omega2


@mistake("omega4")
def guide_speed_no_projection(r2, omega2, rA):
    return r2 * omega2 / rA


@mistake("xP", "yP")
def P_at_A(rA, theta4):
    return rA * cos(theta4), rA * sin(theta4)


@mistake("torque")
def force_on_the_crank(r2, F):
    return r2 * F / 1000


@mistake("stroke")
def stroke_2r2(r2):
    return 2 * r2


@mistake("work", kind="constant")
def both_strokes_cut(work):
    return 2 * work


@mistake("mean_torque")
def mean_over_the_working_stroke(work, r1, r2):
    return work / (pi + 2 * np.arcsin(r2 / r1))


@mistake("excess")
def drive_left_out(F, travel):
    return F * travel / 1000


@mistake("excess")
def peak_alone(torque, mean_torque, arc):
    return (torque - mean_torque) * 2 * pi * arc / 360


@mistake("J", kind="constant")
def unevenness_to_either_side(excess, delta, omega2):
    return excess / (2 * delta * omega2**2)


def figure(r1, r2, r4, r5, h, F, mean_torque, theta_rise, theta_fall):
    """The torque over a turn, its mean, and the work that the flywheel gives."""

    def needed(theta):
        beyond = F / 1000 * _excess_of_speed(theta, r1, r2, r4, r5, h)
        return np.maximum(mean_torque + beyond, 0)

    turn, above = np.linspace(-90, 270, 361), np.linspace(theta_rise, theta_fall, 61)
    scale = 130j / needed(turn).max()
    mean = scale * mean_torque
    hatched = above + scale * needed(above)
    return Figure(
        section(tuple(map(complex, hatched)), r"\Delta E"),
        trace(tuple(map(complex, turn + scale * needed(turn))), dotted=False),
        vector(-90, 385, None),
        vector(-90, 160j, None),
        note(complex(305, 0), r"\theta_2"),
        note(complex(-90, 170), r"\Gamma"),
        line(-90 + mean, 270 + mean, dashed=True, label=r"\Gamma_m"),
        line(theta_rise, theta_rise + mean, dashed=True),
        line(theta_fall, theta_fall + mean, dashed=True),
        note(complex(theta_rise, -13), r"\theta_2'"),
        note(complex(theta_fall, -13), r"\theta_2''"),
        paper_mm=(108, 54),
    )


def residual(
    r1,
    r2,
    r4,
    r5,
    h,
    theta2,
    omega2,
    F,
    delta,
    rA,
    theta4,
    omega4,
    xC,
    v_C,
    torque,
    work,
    mean_torque,
    power,
    theta_rise,
    theta_fall,
    excess,
    J,
):
    """Both loops and their derivatives; the powers; the torque at its mean, by differences; the flywheel's
    energy."""

    def ram(theta):
        arm = 1j * r1 + r2 * np.exp(1j * np.radians(theta))
        pin = r4 * arm / abs(arm)
        return pin.real + np.sqrt(r5**2 - (h - pin.imag) ** 2)

    def slope(theta, step=1e-3):
        """Of the ram by the crank angle, to the sixth order."""
        near, far, farther = ((ram(theta + k * step) - ram(theta - k * step)) / (2 * k) for k in (1, 2, 3))
        return (1.5 * near - 0.6 * far + 0.1 * farther) / np.radians(step)

    crank, along = r2 * np.exp(1j * np.radians(theta2)), np.exp(1j * np.radians(theta4))
    swing = np.arcsin(r2 / r1)
    ends = ram(np.degrees(np.pi + swing)), ram(-np.degrees(swing))
    kinetic = [J * (omega2 * (1 + side * delta / 2)) ** 2 / 2 for side in (-1, 1)]
    given_up = F * (ram(theta_rise) - ram(theta_fall)) / 1000 - work * (theta_fall - theta_rise) / 360
    return (
        abs(1j * r1 + crank - rA * along) / (r1 + r2),
        abs((1j * omega2 * crank / along).imag - rA * omega4) / (r2 * abs(omega2)),
        abs(xC - ram(theta2)) / r5,
        abs(v_C - omega2 * slope(theta2)) / (r4 * abs(omega2)),
        abs(1000 * torque * omega2 + F * v_C) / abs(F * v_C),
        abs(1000 * work - F * (ends[1] - ends[0])) / (1000 * work),
        abs(2 * np.pi * mean_torque - work) / work,
        abs(power * 2 * np.pi - work * abs(omega2)) / (work * abs(omega2)),
        abs(1000 * mean_torque / F + slope(theta_rise)) / r4,
        abs(1000 * mean_torque / F + slope(theta_fall)) / r4,
        np.maximum(theta_rise - theta_fall, 0) / 360,
        abs(excess - given_up) / work,
        abs(kinetic[1] - kinetic[0] - excess) / work,
    )


# At theta2 = 0 the guide is along (3, 4); a rod this steep makes the ram go 750 mm / 2 pi per radian there.
_STEEP = (400 - 750 / (2 * pi) / 0.36) / 300

KNOWN = (
    # The guide upright, A above O2: the guide turns at a third of the crank's rate, P-C is level with itself.
    given(r1=200, r2=100, r4=450, r5=100, h=390, theta2=90, omega2=3, F=1000).gives(
        v_C=-450, torque=150, stroke=450, work=450, mean_torque=225 / pi, power=675 / pi
    ),
    # The same on the way back: nothing cuts.
    given(r1=200, r2=100, r4=450, r5=100, h=390, theta2=-90, omega2=3, F=1000).gives(v_C=1350, torque=0),
    given(
        r1=400, r2=300, r4=500, r5=200, h=400 + 200 * _STEEP / np.hypot(1, _STEEP), theta2=0, omega2=2, F=800
    ).gives(theta_rise=0, xC_rise=300 + 200 / np.hypot(1, _STEEP), torque=300 / pi, mean_torque=300 / pi),
    # 0.5 m against 900 N, less 60 N*m over a third of a turn.
    given(F=900, xC_rise=300, xC_fall=-200, mean_torque=60, arc=120).gives(travel=500, excess=450 - 40 * pi),
    # From 9.8 to 10.2 rad/s: 25 (10.2^2 - 9.8^2) / 2 = 100 J.
    given(excess=100, delta=0.04, omega2=10).gives(J=25),
)
