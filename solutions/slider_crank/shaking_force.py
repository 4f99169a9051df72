"""Shaking force of a slider-crank: solution. What the frame feels is minus the masses times their
accelerations.

The masses at A and B have the rod's mass and centre of mass, so that its force is theirs; its moment of
inertia differs.
"""

import numpy as np

from coursework.degrees import cos, polar, sin
from coursework.figures import Figure, ground_pivot, line, link, pin, slider, vector
from coursework.kinematics.dyads import rrp
from coursework.solution import formula, given, mistake, stable

UNITS = {"lam": "1", "S": "N"}
SYMBOLS = {"lam": r"\lambda", "S": "S"}
EFFECTS = {"forces": ("F1", "F2", "X", "Y")}


def mA(m2, m3, s3):
    return m2 + m3 * (1 - s3)


def mB(m4, m3, s3):
    return m4 + m3 * s3


def lam(r2, r3):
    return r2 / r3


def S(mB, r2, omega2):
    """The greatest primary force, in N: millimetres become metres."""
    return mB * r2 * omega2**2 / 1000


def F1(S, theta2):
    return S * cos(theta2)


@formula(r"<lam> \times <S> \times \cos\left(2 \times <theta2>\right)")
def F2(S, lam, theta2):
    return lam * S * cos(2 * theta2)


@formula(r"\frac{\left(<mA> + <k> \times <mB>\right) \times <r2>}{<rc>}")
def mc(mA, k, mB, r2, rc):
    return (mA + k * mB) * r2 / rc


@formula(
    r"\frac{\left(<mA> \times <r2> - <mc> \times <rc>\right) \times <omega2>^2 \times \cos "
    r"<theta2>}{1000} + <F1> + <F2>"
)
@stable(lambda k, F1, F2, mA, rc: (1 - k) * F1 + F2)
def X(mA, r2, mc, rc, omega2, theta2, F1, F2):
    """Rotating masses and counterweight, and the two forces of the reciprocating mass."""
    return (mA * r2 - mc * rc) * omega2**2 * cos(theta2) / 1000 + F1 + F2


@formula(
    r"\frac{\left(<mA> \times <r2> - <mc> \times <rc>\right) \times <omega2>^2 \times \sin <theta2>}{1000}"
)
@stable(lambda k, S, theta2, mA, rc: -k * S * sin(theta2))
def Y(mA, r2, mc, rc, omega2, theta2):
    """The piston has no part in it."""
    return (mA * r2 - mc * rc) * omega2**2 * sin(theta2) / 1000


@mistake("mA", "mB")
def rod_shared_the_other_way(m2, m3, m4, s3):
    return m2 + m3 * s3, m4 + m3 * (1 - s3)


@mistake("mA", "mB", kind="term")
def rod_left_out(m2, m4):
    return m2, m4


@mistake("F1", "F2", kind="sign")
def force_that_brakes_the_piston(F1, F2):
    """That of the frame on the mass."""
    return -F1, -F2


@mistake("F2", kind="constant")
def single_angle(S, lam, theta2):
    return lam * S * cos(theta2)


@mistake("F2", kind="factor")
def obliquity_forgotten(S, theta2):
    return S * cos(2 * theta2)


@mistake("mc")
def rotating_masses_only(mA, r2, rc):
    return mA * r2 / rc


@mistake("mc")
def all_masses(mA, mB, r2, rc):
    return (mA + mB) * r2 / rc


@mistake("mc")
def radii_forgotten(mA, k, mB):
    return mA + k * mB


@mistake("X", kind="term")
def secondary_left_out(mA, r2, mc, rc, omega2, theta2, F1):
    return (mA * r2 - mc * rc) * omega2**2 * cos(theta2) / 1000 + F1


@mistake("X", "Y", kind="term")
def counterweight_left_out(mA, r2, omega2, theta2, F1, F2):
    turning = mA * r2 * omega2**2 / 1000
    return turning * cos(theta2) + F1 + F2, turning * sin(theta2)


def figure(r2, r3, theta2, rc, X, Y, F1, F2):
    """Primary and secondary force at the piston, and the shaking force at O."""
    O, A = 0j, polar(r2, theta2)
    B = rrp(A, r3, 0.0)
    scale = 0.9 * r2 / max(abs(F1), abs(F2), np.hypot(X, Y))
    above = 0.45j * r2
    return Figure(
        line(O, B, dashed=True),
        link(O, A),
        link(O, polar(rc, theta2 + 180)),
        link(A, B),
        slider(B),
        vector(B + above, scale * F1, "F_1"),
        vector(B - above, scale * F2, "F_2"),
        vector(O, scale * complex(X, Y), "F"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        paper_mm=(108, 54),
    )


def residual(r2, r3, s3, m2, m3, m4, k, rc, theta2, omega2, mA, mB, F1, F2, mc, X, Y):
    """The rod's mass and centre of mass; second derivatives of the places of all masses, by their Fourier
    series."""
    turn = np.arange(8) * np.pi / 4
    angle = np.radians(theta2)
    order = np.fft.fftfreq(8, 1 / 8)

    def force(mass, place):
        """Of a mass whose place over a turn is a series that ends before the fourth harmonic."""
        terms = np.fft.fft(place, axis=-1) / 8 * np.exp(1j * order * np.asarray(angle)[..., None])
        accelerations = -(order**2) * terms * np.asarray(omega2)[..., None] ** 2
        return -mass * accelerations / 1000

    r2_, r3_ = np.asarray(r2)[..., None], np.asarray(r3)[..., None]
    crank = r2_ * np.exp(1j * turn)
    piston = r2_ * np.cos(turn) + r3_ - r2_**2 / (2 * r3_) * np.sin(turn) ** 2
    weight = -np.asarray(rc)[..., None] * np.exp(1j * turn)
    of_piston = force(np.asarray(mB)[..., None], piston)
    first = of_piston[..., [1, -1]].sum(axis=-1).real
    second = of_piston[..., [2, -2]].sum(axis=-1).real
    turning = sum(
        force(np.asarray(mass)[..., None], place).sum(axis=-1) for mass, place in ((mA, crank), (mc, weight))
    )
    size = (mA + mB) * r2 * omega2**2 / 1000
    return (
        (mA + mB - m2 - m3 - m4) / (mA + mB),
        ((mB - m4) * r3 - m3 * s3 * r3) / (m3 * r3),
        (F1 - first) / size,
        (F2 - second) / size,
        (mc * rc - (mA + k * mB) * r2) / (mA * r2),
        abs(turning + first + second - X - 1j * Y) / size,
    )


KNOWN = (
    # At the outer dead centre; half of the reciprocating mass of 1 kg is balanced.
    given(r2=50, r3=200, s3=0.25, m2=0.25, m3=1, m4=0.75, k=0.5, rc=50, theta2=0, omega2=100).gives(
        mA=1, mB=1, F1=500, F2=125, mc=1.5, X=375, Y=0
    ),
    # Crank upright: the secondary force alone draws the piston in; the counterweight pulls down.
    given(r2=40, r3=160, s3=0.5, m2=0.5, m3=1, m4=0.5, k=0.5, rc=20, theta2=90, omega2=100).gives(
        mA=1, mB=1, F1=0, F2=-100, mc=3, X=-100, Y=-200
    ),
    # At 45 degrees no secondary force.
    given(r2=40, r3=160, s3=0.5, m2=0.5, m3=1, m4=0.5, k=1, rc=40, theta2=45, omega2=100).gives(
        F1=200 * 2**0.5, F2=0, mc=2, X=0, Y=-200 * 2**0.5
    ),
)
