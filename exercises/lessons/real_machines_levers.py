"""Figures and numbers of the lesson on levers that swing: two wipers, a tipper, a crane, each beside its
scheme."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import disc, note, shape, trace

from ._machines import (
    FINE,
    ROUND,
    beside,
    box,
    capsule,
    crossing,
    data,
    given,
    heading,
    in_motion,
    joints,
    open_line,
    path,
    placed,
    poly,
    scheme,
    sector,
    solved,
    stays,
    swing,
    to_and_fro,
)

# ------------------------------------------------------------------ windscreen wiper

WIPER_AT = 300.0  #: angle of the crank in the drawing, degrees
BLADE = 200.0  #: half of a blade, mm


def windscreen_wiper():
    """Motor, crank, rods, two arms with their blades and the panes that they wipe, and the scheme."""
    elements, z = scheme("windscreen_wiper", theta2=WIPER_AT)
    O, A, B, C, D, E, F, P, Q = (z[n] for n in "OABCDEFPQ")
    first = solved("windscreen_wiper", "theta4", theta2=FINE) - 30.0
    low, high = float(first.min()), float(first.max())
    glass = [-660 + 90j, 860 + 90j, 760 + 600j, -560 + 600j]
    real = [
        poly(*glass, shade="glass"),
        *(sector(at, 340 - BLADE, 340 + BLADE, low, high) for at in (C, D)),
        poly(-700 - 110j, 900 - 110j, 860 + 90j, -660 + 90j, shade="light"),
        box(-38 - 128j, 38 + 20j, "mid"),
        disc(O, 48, "mid"),
        capsule(E, F, 9, shade="light"),
        capsule(A, B, 9, shade="light"),
        capsule(O, A, 17, 12, "dark"),
        *(capsule(at, knob, 22, 12, "mid") for at, knob in ((C, B), (C, E), (D, F))),
    ]
    for at, end in ((C, P), (D, Q)):
        along = (end - at) / abs(end - at)
        real += [
            capsule(end - BLADE * along, end + BLADE * along, 9, shade="black"),
            capsule(at, at + 0.55 * (end - at), 22, 12, "light"),
            capsule(at + 0.5 * (end - at), end, 8, 5, "mid"),
        ]
    real += joints([(O, 10), (A, 8), (B, 8), (E, 8), (F, 8), (C, 13), (D, 13)])
    real += [
        note((O + A) / 2 + 40 - 30j, "2"),
        note((A + B) / 2 - 34j, "3"),
        note(C + 0.3 * (P - C) + 45j, "4"),
        note(0.35 * E + 0.65 * F + 34j, "5"),
        note(D + 0.3 * (Q - D) + 45j, "6"),
    ]
    return beside(real, elements, upright=True, paper_mm=(150, 150))


# ------------------------------------------------------------------ bus wiper

BUS_AT = 330.0


def bus_wiper():
    """A tall blade on two parallel arms: it goes from side to side and stays upright."""
    elements, z = scheme("bus_wiper", theta2=BUS_AT)
    O, A, B, C, D, E, F = (z[n] for n in "OABCDEF")
    middle = (E + F) / 2
    places = path("bus_wiper", "P", theta2=FINE) - 260j
    arch = stays(places)
    wiped = [w - 260j for w in arch] + [w + 260j for w in arch[::-1]]
    real = [
        poly(-330 + 265j, 420 + 265j, 420 + 950j, -330 + 950j, shade="glass"),
        shape(tuple(wiped), "white", thin=True),
        poly(-330 - 100j, 420 - 100j, 420 + 265j, -330 + 265j, shade="light"),
        box(-40 - 85j, 40 + 20j, "mid"),
        disc(O, 46, "mid"),
        capsule(A, B, 9, shade="light"),
        capsule(O, A, 16, 11, "dark"),
        capsule(C, B, 20, 11, "mid"),
        capsule(C, E, 15, 9, "light"),
        capsule(D, F, 11, 7, "light"),
        capsule(E, F, 11, shade="mid"),
        capsule(middle - 255j, middle + 255j, 10, shade="black"),
        capsule(middle - 60j, middle + 60j, 15, shade="mid"),
        *joints([(O, 9), (A, 7), (B, 7), (C, 12), (D, 10), (E, 7), (F, 7)]),
        note(O + 0.5 * (A - O) + 40, "2"),
        note((A + B) / 2 - 28, "3"),
        note((C + E) / 2 - 34, "4"),
        note((D + F) / 2 + 34, "5"),
        note(middle + 38 + 40j, "6"),
    ]
    return beside(real, [trace(tuple(w + 260j for w in arch)), *elements], paper_mm=(165, 125))


# ------------------------------------------------------------------ tipper

TRUCK = {"a": 1900.0, "xC": 900.0, "yC": -600.0, "x_G_4": 1700.0, "y_G_4": 500.0, "F": 100000.0}
DOWN, UP = 1166.19, 2080.0  #: lengths of the jack with the body down and up, mm
TIPPER = {**TRUCK, "L_min": DOWN, "L_max": UP}


def tipper():
    """A lorry with its body raised by a jack, and the scheme."""
    elements, z = scheme("tipper", **TIPPER, L=1700.0)
    O, B, C, G = (z[n] for n in "OBCG")
    turned = heading(O, B)

    def body(*points):
        return placed(points, O, turned)

    real = [
        poly(-700 - 420j, 5600 - 420j, 5600 - 250j, -700 - 250j, shade="mid"),
        box(3950 - 420j, 5500 + 900j, "light"),
        poly(4350 + 250j, 5420 + 250j, 5420 + 820j, 4480 + 820j, shade="glass"),
        box(5440 - 480j, 5640 - 300j, "dark"),
        open_line(4320 - 380j, 4320 + 880j, thin=True),
        *(
            disc(complex(x, -700), r, s)
            for x in (300, 1500, 4700)
            for r, s in ((480, "dark"), (270, "light"), (90, "dark"))
        ),
        poly(-120 - 250j, 120 - 250j, 60 + 60j, -60 + 60j, shade="dark"),
        poly(
            complex(C.real - 140, -420), complex(C.real + 140, -420), C + 70 - 40j, C - 70 - 40j, shade="dark"
        ),
        shape(
            tuple(
                body(
                    -250 + 520j,
                    200 + 900j,
                    900 + 1180j,
                    1700 + 1250j,
                    2700 + 1150j,
                    3400 + 950j,
                    3400 + 120j,
                    -250 + 120j,
                )
            ),
            "mid",
            thin=True,
        ),
        poly(
            *body(-420 + 110j, 3600 + 110j, 3600 + 1050j, 3450 + 1050j, 3450 + 800j, -200 + 800j),
            shade="light",
        ),
        *(open_line(*body(x + 110j, x + 800j), thin=True) for x in (450, 1100, 1750, 2400, 3050)),
        poly(*body(-200 - 40j, 3300 - 40j, 3300 + 110j, -200 + 110j), shade="dark"),
        capsule(C, C + 0.6 * (B - C), 95, shade="light"),
        capsule(C + 0.58 * (B - C), B, 50, shade="white"),
        *joints([(O, 80), (B, 75), (C, 80)]),
        disc(G, 40, "black"),
        open_line(-900 - 1180j, 5800 - 1180j),
        note(C + 0.35 * (B - C) + 260, "2"),
        note(C + 0.8 * (B - C) + 260, "3"),
        note(O + placed([2600 + 500j], 0, turned)[0], "4"),
        note(G + 150 + 100j, "G"),
    ]
    return beside(real, elements, paper_mm=(165, 95))


# ------------------------------------------------------------------ crane

CRANE_AT = 66.0


def level_luffing_crane():
    """A harbour crane whose hook stays at one height while the jib luffs, and the scheme with the path of its
    head."""
    elements, z = scheme("level_luffing_crane", theta2=CRANE_AT)
    O, A, B, C, P = (z[n] for n in "OABCP")

    def lattice(p, q, wide, narrow, bays):
        along = (q - p) / abs(q - p)
        sides = [
            [
                p + (q - p) * k / bays + s * 1j * along * (wide + (narrow - wide) * k / bays)
                for k in range(bays + 1)
            ]
            for s in (1, -1)
        ]
        zigzag = [sides[k % 2][k] for k in range(bays + 1)]
        return [
            poly(*sides[0], *sides[1][::-1], shade="white"),
            open_line(*zigzag, thin=True),
        ]

    quay = -16000
    real = [
        poly(
            -14000 + 1j * (quay - 3000),
            9000 + 1j * (quay - 3000),
            9000 + 1j * quay,
            -14000 + 1j * quay,
            shade="mid",
        ),
        poly(
            9000 + 1j * (quay - 3000),
            40000 + 1j * (quay - 3000),
            40000 + 1j * (quay - 1200),
            9000 + 1j * (quay - 1200),
            shade="glass",
        ),
        *(
            capsule(complex(x, quay + 700), complex(s, -2500), 700, 500, "light")
            for x, s in ((-6000, -3500), (6000, 3500))
        ),
        capsule(complex(-5000, quay + 5000), complex(5000, quay + 5000), 450, shade="light"),
        *(disc(complex(x + d, quay + 500), 500, "dark") for x in (-6000, 6000) for d in (-900, 900)),
        box(-4500 - 3500j, 4500 - 2300j, "dark"),
        poly(
            -8000 - 2300j,
            2500 - 2300j,
            2500 + 1500j,
            0 + 1500j,
            C + 900,
            C - 900,
            -6500 + 2500j,
            -8000 + 2500j,
            shade="light",
        ),
        box(-7700 - 2000j, -5000 + 2000j, "mid"),
        box(600 - 1900j, 2400 + 900j, "glass"),
        *lattice(C, B, 350, 350, 14),
        *lattice(O, A, 1100, 500, 16),
        *lattice(A, P, 900, 250, 7),
        poly(A + 700j * (A - B) / abs(A - B), B, A - 700j * (A - B) / abs(A - B), shade="light"),
        *joints([(O, 600), (A, 500), (B, 400), (C, 500), (P, 450)]),
        open_line(P + 450, complex(P.real + 450, 4000)),
        disc(complex(P.real + 450, 3600), 600, "dark"),
        poly(
            complex(P.real - 1800, -1500),
            complex(P.real + 2700, -1500),
            complex(P.real + 2700, 1400),
            complex(P.real - 1800, 1400),
            shade="mid",
        ),
        open_line(
            complex(P.real - 1800, 1400), complex(P.real + 450, 3100), complex(P.real + 2700, 1400), thin=True
        ),
        note(O + 0.5 * (A - O) + 2400, "2"),
        note(A + 0.5 * (P - A) + 2100j, "3"),
        note(C + 0.5 * (B - C) - 2000, "4"),
    ]
    way = path("level_luffing_crane", "P", theta2=np.arange(46.0, 91.0))
    return beside(real, [trace(tuple(map(complex, way))), *elements], paper_mm=(165, 110))


# ------------------------------------------------------------------ schemes in motion


def windscreen_wiper_moves():
    """The wiper drive, in motion."""
    return in_motion("windscreen_wiper", ROUND)


def bus_wiper_moves():
    """The parallelogram wiper, in motion."""
    return in_motion("bus_wiper", ROUND, "P")


def tipper_moves():
    """The tipper, in motion."""
    return in_motion("tipper", to_and_fro(DOWN, UP), "G", "L", **TIPPER)


def level_luffing_crane_moves():
    """The crane's jib, in motion."""
    return in_motion("level_luffing_crane", to_and_fro(48.0, 90.0), "P")


# ------------------------------------------------------------------ numbers


def values():
    """The numbers that the lesson's text states, as they are printed."""
    sizes = {
        **given("wiper", "windscreen_wiper", "r2", "r3", "r4", "CD"),
        **given("bus", "bus_wiper", "r2", "r3", "r4", "L", "b"),
    }
    return {**sizes, **_wiper(), **_bus(), **_tipper(), **_crane(), **_rear()}


def _rear():
    """The wiper of the last question: a swing of 110 degrees in equal times."""
    r1, r4 = 150.0, 50.0
    r2 = r4 * float(polar(1.0, 55.0).imag)
    r3 = (r1**2 + r2**2 - r4**2) ** 0.5
    found = solved("windscreen_wiper", ("theta3", "theta4"), theta2=FINE, r2=r2, r3=r3, r4=r4, xC=-r1)
    return {
        "design_r2": f"{r2:.1f}",
        "design_r3": f"{r3:.1f}",
        "design_mu": f"{crossing(found['theta3'], found['theta4']).min():.0f}",
    }


def _wiper():
    found = solved("windscreen_wiper", ("theta3", "theta4"), theta2=FINE)
    theta4 = found["theta4"]
    out, back = FINE[theta4.argmin()], FINE[theta4.argmax()]
    wide = swing(theta4)
    return {
        "wiper_sweep": f"{wide:.1f}",
        "wiper_forward": f"{(back - out) % 360:.0f}",
        "wiper_least_mu": f"{crossing(found['theta3'], theta4).min():.1f}",
        "wiper_area": f"{np.pi * wide / 360 * (0.54**2 - 0.14**2):.2f}",
    }


def _bus():
    found = solved("bus_wiper", ("theta3", "theta4", "theta6", "xP", "yP"), theta2=FINE)
    wide, blade = np.ptp(found["xP"]), 2 * data("bus_wiper")["y_P_6"]
    return {
        "bus_blade": f"{blade:.0f}",
        "bus_sweep": f"{swing(found['theta4']):.1f}",
        "bus_travel": f"{wide:.0f}",
        "bus_rise": f"{np.ptp(found['yP']):.0f}",
        "bus_tilt": f"{abs(found['theta6']).max():.0f}",
        "bus_least_mu": f"{crossing(found['theta3'], found['theta4']).min():.1f}",
        "bus_area": f"{blade * wide / 1e6:.2f}",
    }


def _tipper():
    L = np.linspace(DOWN, UP, 400)
    found = solved("tipper", ("theta4", "thrust"), **TIPPER, L=L)
    thrust = abs(found["thrust"]) / 1000
    ahead = solved("tipper", "xG", **TIPPER, L=L) / 1000
    arm = TRUCK["F"] / 1000 * ahead / thrust
    return {
        "tipper_a": f"{TRUCK['a']:.0f}",
        "tipper_xC": f"{TRUCK['xC']:.0f}",
        "tipper_yC": f"{-TRUCK['yC']:.0f}",
        "tipper_down": f"{DOWN:.0f}",
        "tipper_up": f"{UP:.0f}",
        "tipper_load": f"{TRUCK['F'] / 1000:.0f}",
        "tipper_tilt": f"{swing(found['theta4']):.1f}",
        "tipper_stroke": f"{UP - DOWN:.0f}",
        "tipper_ratio": f"{UP / DOWN:.2f}",
        "tipper_first": f"{thrust[0]:.0f}",
        "tipper_last": f"{thrust[-1]:.0f}",
        "tipper_arm_first": f"{arm[0]:.2f}",
        "tipper_arm_most": f"{arm.max():.2f}",
        "tipper_arm_last": f"{arm[-1]:.2f}",
        "tipper_x_first": f"{ahead[0]:.2f}",
        "tipper_x_last": f"{ahead[-1]:.2f}",
    }


HOOK = 100000.0  #: the load on the hook, N
LUFFING = np.linspace(48.0, 90.0, 421)


def _crane():
    head = path("level_luffing_crane", "P", theta2=LUFFING)
    # By the powers: what the load takes, over the angular velocity of the jib.
    rate = data("level_luffing_crane")["omega2"]
    torque = HOOK * solved("level_luffing_crane", "v_P_y", theta2=LUFFING) / 1000 / rate / 1e6
    sizes = {
        f"crane_{n}": f"{v / 1000:.3g}"
        for n, v in data("level_luffing_crane").items()
        if n in ("r2", "r3", "r4", "AP")
    }
    return {
        **sizes,
        "crane_load": f"{HOOK / 1000:.0f}",
        "crane_low": f"{LUFFING[0]:.0f}",
        "crane_high": f"{LUFFING[-1]:.0f}",
        "crane_near": f"{head.real.min() / 1000:.1f}",
        "crane_far": f"{head.real.max() / 1000:.1f}",
        "crane_height": f"{np.ptp(head.imag) / 1000:.2f}",
        "crane_torque": f"{abs(torque).max():.2f}",
        "crane_plain": f"{HOOK * head.real.max() / 1e9:.2f}",
    }
