"""Figures and numbers of the lesson on points that draw lines: a claw, a packing line, an inversor, a walking
toy, each beside its scheme."""

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
    enlarged,
    given,
    in_motion,
    joints,
    open_line,
    path,
    poly,
    scheme,
    solved,
    swing,
    to_and_fro,
)

# ------------------------------------------------------------------ claw of a camera

CLAW_AT = 330.0
DEPTH = 1.3  #: the claw holds the film while it is less than this from the straight side of its path, mm


def film_claw():
    """A film camera, its cover taken off: film between two reels, gate, lens, and the claw with its crank."""
    elements, z = scheme("film_claw", theta2=CLAW_AT)
    unit = 8 / 11  # of the drawing, mm
    O, A, B, C, P = (z[n] / unit for n in "OABCP")
    film = float(path("film_claw", "P", theta2=FINE).real.max()) / unit - 0.5
    upper, lower = -12 + 62j, -14 - 44j
    real = [
        poly(
            -58 - 66j, 30 - 66j, 34 - 62j, 34 + 84j, 30 + 88j, -58 + 88j, -62 + 84j, -62 - 62j, shade="light"
        ),
        poly(-54 - 60j, 28 - 60j, 28 + 82j, -54 + 82j, shade="white", thin=True),
        *(
            disc(at, r, s)
            for at in (upper, lower)
            for r, s in ((21, "mid"), (15 if at == upper else 9, "dark"), (4, "white"))
        ),
        box(complex(film + 1.2, -6), complex(film + 5, 40), "mid"),
        box(complex(film + 5, 2), complex(film + 12, 32), "dark"),
        poly(34 - 1j, 46 - 1j, 46 + 35j, 34 + 35j, shade="mid"),
        poly(46 - 6j, 62 - 6j, 62 + 40j, 46 + 40j, shade="light"),
        shape(
            tuple(
                complex(57 + 5 * np.cos(t), 17 + 19 * np.sin(t))
                for t in np.linspace(-np.pi / 2, np.pi / 2, 25)
            ),
            "glass",
        ),
        open_line(
            upper + 21j * polar(1, -95.0),
            complex(film, 52),
            complex(film, -20),
            complex(film - 6, -31),
            lower + 9 * polar(1, -5.0),
        ),
        open_line(*(complex(film, 44 - 0.1 * k) for k in range(560))),
        disc(O, 14.5, "mid"),
        capsule(C, B, 4.2, 3, "light"),
        capsule(A, B, 3.4, shade="dark"),
        shape((B + 2.8j, P - 5 + 2.2j, P - 1 + 1.6j, P + 2.4, P - 1 - 1.6j, A + 3, A - 3), "dark"),
        *joints([(O, 2.6), (A, 2), (B, 2), (C, 2.8)]),
        note(-8 - 9j, "2"),
        note(0.55 * B + 0.45 * P + 8j, "3"),
        note((B + C) / 2 - 6j, "4"),
    ]
    way = trace(tuple(map(complex, path("film_claw", "P", theta2=FINE[::8]))))
    return beside(enlarged(real, unit), [way, *elements], paper_mm=(165, 100))


# ------------------------------------------------------------------ packing line

RAKE = 50.0  #: crank, mm
RAKE_AT = 150.0


def hoecken():
    """A pusher of a packing line: its roller pushes parcels along the table and comes back above them."""
    elements, z = scheme("hoecken", theta2=RAKE_AT, r2=RAKE)
    O, A, B, C, P = (z[n] for n in "OABCP")
    parcels = [(P.real - 42 - w, P.real - 42) for w in (90,)] + [(-190.0, -110.0), (255.0, 335.0)]
    real = [
        poly(-110 - 80j, 190 - 80j, 190 + 130j, -110 + 130j, shade="light"),
        poly(-130 - 110j, 210 - 110j, 210 - 80j, -130 - 80j, shade="mid"),
        box(-240 + 145j, 360 + 160j, "mid"),
        *(box(complex(x, -110), complex(x + 16, 145), "mid") for x in (-220, 330)),
        *(box(complex(a, 160), complex(b, 226), "white") for a, b in parcels),
        *(open_line(complex(a, 200), complex(b, 200), thin=True) for a, b in parcels),
        disc(O, 66, "mid"),
        capsule(C, B, 17, 12, "light"),
        capsule(A, P, 13, 10, "dark"),
        disc(P, 25, "light"),
        *joints([(O, 12), (A, 9), (B, 9), (C, 12), (P, 9)]),
        note(O - 45 - 45j, "2"),
        note(0.35 * A + 0.65 * P + 30, "3"),
        note((B + C) / 2 + 32, "4"),
    ]
    way = tuple(map(complex, path("hoecken", "P", theta2=FINE[::8], r2=RAKE)))
    return beside(
        [*real[:-3], trace((*way, way[0])), *real[-3:]],
        [trace((*way, way[0])), *elements],
        paper_mm=(165, 95),
    )


# ------------------------------------------------------------------ Peaucellier's pump

CELL_AT = 28.0


def peaucellier():
    """A pump whose rod is led along a straight line by revolute joints alone."""
    elements, z = scheme("peaucellier", theta2=CELL_AT)
    O, A, B, C, D, P = (z[n] for n in "OABCDP")
    line_at = P.real
    piston = P - 560j
    real = [
        poly(-150 - 760j, 900 - 760j, 900 - 700j, -150 - 700j, shade="mid"),
        poly(-110 - 700j, 260 - 700j, 200 - 120j, 200 + 90j, -60 + 90j, -60 - 120j, shade="light"),
        box(complex(line_at - 120, -700), complex(line_at + 120, -205), "light"),
        box(complex(line_at - 95, -690), complex(line_at + 95, -215), "glass"),
        box(complex(line_at - 140, -230), complex(line_at + 140, -195), "mid"),
        poly(piston - 95, piston + 95, piston + 95 + 55j, piston - 95 + 55j, shade="dark"),
        box(complex(line_at - 13, piston.imag + 55), complex(line_at + 13, P.imag), "white"),
        box(complex(line_at + 120, -660), complex(line_at + 190, -610), "light"),
        box(complex(line_at - 190, -660), complex(line_at - 120, -610), "light"),
        capsule(O, B, 22, shade="light"),
        capsule(O, D, 22, shade="light"),
        *(capsule(p, q, 17, shade="mid") for p, q in ((A, B), (A, D), (B, P), (D, P))),
        capsule(C, A, 26, 20, "dark"),
        *joints([(O, 24), (C, 22), (A, 17), (B, 17), (D, 17), (P, 20)]),
        note(C + 50 - 62j, "2"),
        note((O + B) / 2 + 60j, "3"),
        note((A + B) / 2 - 50, "4"),
        note(O + 0.8 * (D - O) - 62j, "5"),
        note((A + D) / 2 - 50 - 20j, "6"),
        note((B + P) / 2 + 60j, "7"),
        note((D + P) / 2 + 30 - 60j, "8"),
    ]
    way = path("peaucellier", "P", theta2=np.linspace(-45, 45, 19))
    return beside(real, [trace(tuple(map(complex, way))), *elements], paper_mm=(165, 110))


# ------------------------------------------------------------------ walking toy

TOY = {"r2": 15.0}
TOY_AT = 115.0


def klann_leg():
    """A wind-up toy that walks on legs of five bodies: a fore leg and a hind leg on one crank."""
    elements, z = scheme("klann_leg", theta2=TOY_AT, **TOY)
    _, other = scheme("klann_leg", theta2=180 - TOY_AT, **TOY)
    hind = {n: -p.conjugate() for n, p in other.items()}
    ground = float(path("klann_leg", "G", theta2=FINE, **TOY).imag.min()) - 2.5
    shell = [complex(66 * np.cos(t), 12 + 42 * np.sin(t)) for t in np.radians(np.arange(0, 360, 6))]
    real = [
        open_line(complex(-150, ground), complex(150, ground)),
        *_leg(hind, "light", "light"),
        shape(tuple(shell), "mid"),
        disc(-50 + 24j, 7, "white"),
        disc(-52 + 25j, 3, "black"),
        capsule(36 + 40j, 36 + 66j, 3, shade="light"),
        disc(29 + 70j, 8, "light"),
        disc(43 + 70j, 8, "light"),
        *_leg(z, "dark", "light"),
        *joints([(z[n], 3.2) for n in "ABD"], "white"),
        note((z["A"] + z["C"]) / 2 + 9 - 4j, "2"),
        note((z["C"] + z["F"]) / 2 + 9j, "3"),
        note((z["B"] + z["H"]) / 2 - 9, "4"),
        note((z["F"] + z["G"]) / 2 - 12, "5"),
        note((z["D"] + z["E"]) / 2 + 9j, "6"),
    ]
    way = tuple(map(complex, path("klann_leg", "G", theta2=FINE[::8], **TOY)))
    return beside(real, [trace((*way, way[0])), *elements], paper_mm=(165, 95))


def _leg(z, crank, shade):
    """The parts of a leg, its foot a rounded tip."""
    return [
        capsule(z["B"], z["H"], 4, 3, shade),
        capsule(z["D"], z["E"], 4, 3, shade),
        shape((z["C"] - 2.5j, z["H"] - 3j, z["F"] - 2.5, z["F"] + 3j, z["H"] + 3j, z["C"] + 2.5j), shade),
        shape((z["E"] + 3j, z["F"] + 4, z["G"] + 2.5, z["G"] - 2.5, z["F"] - 4, z["E"] - 3), shade),
        disc(z["G"], 3.5, "dark"),
        capsule(z["A"], z["C"], 5.5, 4, crank),
        *joints([(z[n], 2.4) for n in "CHFE"]),
    ]


# ------------------------------------------------------------------ schemes in motion


def film_claw_moves():
    """The claw, in motion."""
    return in_motion("film_claw", -ROUND, "P")


def hoecken_moves():
    """Hoecken's linkage, in motion."""
    return in_motion("hoecken", ROUND, "P", r2=RAKE)


def peaucellier_moves():
    """Peaucellier's cell, in motion."""
    return in_motion("peaucellier", to_and_fro(-45.0, 45.0), "P")


def klann_leg_moves():
    """The leg, in motion."""
    return in_motion("klann_leg", ROUND, "G", **TOY)


# ------------------------------------------------------------------ numbers


def values():
    """The numbers that the lesson's text states, as they are printed."""
    return {**_claw(), **_pusher(), **_pump(), **_toy()}


def _claw():
    places = path("film_claw", "P", theta2=FINE)
    holds = places[places.real > places.real.max() - DEPTH]
    share = len(holds) / len(places)
    return {
        **given("claw", "film_claw", "r2", "r3", "r4", "AP"),
        "claw_depth": f"{DEPTH:.1f}",
        "claw_pitch": f"{np.ptp(holds.imag):.1f}",
        "claw_share": f"{100 * share:.0f}",
        "claw_moves": f"{1000 * share / 24:.0f}",
        "claw_stands": f"{1000 * (1 - share) / 24:.0f}",
    }


LEVEL = np.linspace(80.0, 280.0, 801)  #: angles of the crank between which the roller goes level, degrees
STEADY = np.linspace(105.0, 255.0, 601)  #: and between which it goes at nearly one speed


def _pusher():
    around = path("hoecken", "P", theta2=FINE, r2=RAKE)
    level = path("hoecken", "P", theta2=LEVEL, r2=RAKE)
    speed = abs(solved("hoecken", "v_P_x", theta2=STEADY, r2=RAKE, omega2=4.0))
    return {
        "pusher_r2": f"{RAKE:.0f}",
        "design_r2": f"{300 * RAKE / np.ptp(level.real):.1f}",
        "design_off": f"{300 * np.ptp(level.imag) / np.ptp(level.real):.2f}",
        "pusher_r1": f"{2 * RAKE:.0f}",
        "pusher_r3": f"{2.5 * RAKE:.0f}",
        "pusher_AP": f"{5 * RAKE:.0f}",
        "pusher_length": f"{np.ptp(level.real):.0f}",
        "pusher_off": f"{np.ptp(level.imag):.2f}",
        "pusher_share": f"{100 * np.ptp(LEVEL) / 360:.0f}",
        "pusher_lift": f"{np.ptp(around.imag):.0f}",
        "pusher_speed": f"{100 * (1 - speed.min() / speed.max()):.0f}",
    }


def _pump():
    sizes = data("peaucellier")
    swung = np.linspace(-45.0, 45.0, 361)
    places = path("peaucellier", "P", theta2=swung)
    rods = solved("peaucellier", ("theta7", "theta8"), theta2=swung)
    return {
        **given("pump", "peaucellier", "r2", "a", "b"),
        "pump_product": f"{(sizes['a'] ** 2 - sizes['b'] ** 2) / 1e6:.3f}",
        "pump_line": f"{places.real.mean():.0f}",
        "pump_stroke": f"{np.ptp(places.imag):.0f}",
        "pump_swing": f"{np.ptp(swung):.0f}",
        "pump_least": f"{crossing(*rods.values()).min():.0f}",
    }


TREAD = 3.0  #: the foot bears while it is less than this above its lowest place, mm


def _toy():
    foot = path("klann_leg", "G", theta2=FINE, **TOY)
    bears = foot[foot.imag < foot.imag.min() + TREAD]
    share = len(bears) / len(foot)
    return {
        "toy_r2": f"{TOY['r2']:.0f}",
        "toy_tread": f"{TREAD:.0f}",
        "toy_share": f"{100 * share:.0f}",
        "toy_stride": f"{np.ptp(bears.real):.0f}",
        "toy_lift": f"{np.ptp(foot.imag):.0f}",
        "toy_width": f"{np.ptp(foot.real):.0f}",
        "toy_rocker": f"{swing(solved('klann_leg', 'theta4', theta2=FINE, **TOY)):.0f}",
    }
