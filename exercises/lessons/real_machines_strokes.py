"""Figures and numbers of the lesson on strokes and pauses: a shaper, a sewing machine, an engine, a
projector, each beside its scheme."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import Figure, disc, note, shape, trace

from ._machines import (
    FINE,
    ROUND,
    beside,
    box,
    capsule,
    counted,
    crossing,
    data,
    given,
    in_motion,
    joints,
    open_line,
    path,
    poly,
    rows_of,
    scheme,
    solved,
    swing,
    unlettered,
)

# ------------------------------------------------------------------ shaper

SHAPER = {"r2": 100.0, "omega2": 6.0}
NEEDLE = 100.0  #: speed of the sewing machine's shaft, rad/s
SHAPER_AT = 35.0


def shaper():
    """A shaper, its cover taken off: bull gear with crank pin, slotted lever, link, ram with its tool, table
    with the work."""
    elements, z = scheme("shaper", theta2=SHAPER_AT, **SHAPER)
    O, A, C, D, E = (z[n] for n in "OACDE")
    up = (D - C) / abs(D - C)
    slot = [C + k * up for k in (110.0, 390.0)]
    nose = E - 330
    real = [
        poly(-280 - 190j, 330 - 190j, 330 - 120j, -280 - 120j, shade="mid"),
        poly(-190 - 120j, 280 - 120j, 260 + 400j, -150 + 400j, shade="light"),
        poly(-165 + 400j, 275 + 400j, 275 + 425j, -165 + 425j, shade="mid"),
        disc(O, 150, "white"),
        disc(O, 138, "light", thin=True),
        capsule(C, D, 44, 28, "mid"),
        capsule(slot[0], slot[1], 17, shade="white"),
        shape(tuple(A + up * w for w in (-26 - 16j, 26 - 16j, 26 + 16j, -26 + 16j)), "dark"),
        poly(
            nose + 425j - 1j * nose.imag,
            nose + 700 + 425j - 1j * nose.imag,
            nose + 700 + 560j - 1j * nose.imag,
            nose + 40 + 560j - 1j * nose.imag,
            nose + 540j - 1j * nose.imag,
            shade="light",
        ),
        capsule(D, E, 20, 17, "dark"),
        poly(nose - 95 + 90j, nose - 5 + 90j, nose - 5 - 110j, nose - 95 - 110j, shade="mid"),
        box(nose - 65 + 90j, nose - 35 + 150j, "light"),
        poly(nose - 75 - 110j, nose - 45 - 110j, nose - 45 - 175j, nose - 62 - 195j, shade="dark"),
        poly(-640 + 60j, -205 + 60j, -205 + 210j, -640 + 210j, shade="light"),
        poly(-640 + 60j, -560 + 60j, -560 - 190j, -640 - 190j, shade="mid"),
        box(-590 + 210j, -240 + 285j, "dark"),
        *joints([(O, 18), (A, 12), (C, 20), (D, 15), (E, 15)]),
        note(O + 105 * polar(1, SHAPER_AT + 190), "2"),
        note(A + 60 - 45j, "3"),
        note(C + 60 * up + 75, "4"),
        note((D + E) / 2 + 50j, "5"),
        note(nose + 560 + 60j, "6"),
        note(-415 + 140j, "1"),
    ]
    return beside(real, elements, paper_mm=(165, 100))


# ------------------------------------------------------------------ sewing machine

SEWING_AT = 205.0
PLATE = -116.0  #: height of the needle plate, mm
POINT = 68.0  #: from the pin of the needle bar to the point of the needle, mm


def needle_bar():
    """The head of a sewing machine seen from its end, its cover taken off: needle bar and thread take-up on
    one crank."""
    elements, z = scheme("needle_bar", theta2=SEWING_AT)
    O, A, B, D, F, G, P = (z[n] for n in "OABDFGP")
    tip = B - 1j * POINT
    real = [
        poly(-72 - 150j, 62 - 150j, 62 + PLATE * 1j, -72 + PLATE * 1j, shade="light"),
        box(-72 + 1j * (PLATE - 4), 62 + 1j * PLATE, "mid"),
        poly(
            -46 - 66j,
            34 - 66j,
            40 - 58j,
            44 + 92j,
            36 + 104j,
            -44 + 104j,
            -52 + 92j,
            -50 - 58j,
            shade="light",
        ),
        poly(-42 - 58j, 31 - 58j, 36 + 90j, 30 + 97j, -38 + 97j, -44 + 90j, shade="white", thin=True),
        disc(O, 25, "mid"),
        box(-9 - 66j, 9 - 52j, "dark"),
        box(-3.2 + 1j * (B.imag - 46), 3.2 + 1j * (B.imag + 12), "light"),
        box(-6 + 1j * (B.imag - 6), 6 + 1j * (B.imag + 6), "dark"),
        poly(
            tip,
            tip - 1.1 + 10j,
            complex(-1.1, B.imag - 46),
            complex(1.1, B.imag - 46),
            tip + 1.1 + 10j,
            shade="white",
        ),
        box(complex(14, PLATE + 18), 18 - 60j, "light"),
        poly(
            -8 + 1j * (PLATE + 2),
            19 + 1j * (PLATE + 2),
            19 + 1j * (PLATE + 6),
            14 + 1j * (PLATE + 20),
            10 + 1j * (PLATE + 6),
            -8 + 1j * (PLATE + 5),
            shade="mid",
        ),
        box(-60 + 1j * PLATE, 55 + 1j * (PLATE + 2), "glass"),
        capsule(G, D, 5.5, 4, "light"),
        shape((F + 3.4, F - 3.4j, D - 4 - 1j, P - 3 - 2j, P - 2 + 3j, P + 3 + 1j, D + 3 + 3j), "mid"),
        capsule(A, B, 4.2, 3.6, "light"),
        capsule(A, F, 4, shade="dark"),
        disc(P, 3.2, "white"),
        open_line(30 + 112j, -20 + 108j, -58 + 96j, -58 + 20j, P, -14 - 40j, tip + 14j, thin=True),
        *joints([(O, 4.5), (A, 2.6), (F, 2.2), (B, 2.4), (D, 2.6), (G, 3.6)]),
        note(O + 17 - 14j, "2"),
        note((A + B) / 2 + 9, "3"),
        note(14 + 1j * (B.imag - 22), "4"),
        note((D + P) / 2 + 8 + 4j, "5"),
        note((G + D) / 2 - 9j, "6"),
    ]
    way = tuple(map(complex, path("needle_bar", "P", theta2=FINE[::8])))
    return beside(real, [trace((*way, way[0])), *elements], paper_mm=(165, 125))


# ------------------------------------------------------------------ Atkinson's engine

ENGINE_AT = 75.0


def atkinson_engine():
    """Atkinson's engine in section: piston and cylinder, the swinging link, the long rod and the crank with
    its flywheel."""
    elements, z = scheme("atkinson_engine", theta2=ENGINE_AT)
    O, A, B, C, E = (z[n] for n in "OABCE")
    level, head = E.imag, float(solved("atkinson_engine", "x", theta2=FINE).max()) + 58
    real = [
        poly(-260 - 170j, 330 - 170j, 330 - 130j, -260 - 130j, shade="mid"),
        disc(O, 128, "light"),
        disc(O, 108, "white", thin=True),
        *(capsule(O, O + polar(112, a + 20), 7, shade="light") for a in range(0, 360, 60)),
        poly(
            -170 - 130j,
            -120 - 130j,
            -85 + 150j,
            complex(-85, level),
            complex(-128, level),
            -150 + 150j,
            shade="light",
        ),
        poly(150 - 130j, 300 - 130j, complex(300, level - 62), complex(150, level - 62), shade="light"),
        box(complex(95, level - 62), complex(head + 8, level - 46), "mid"),
        box(complex(95, level + 46), complex(head + 8, level + 62), "mid"),
        box(complex(head + 4, level - 62), complex(head + 26, level + 62), "mid"),
        box(complex(E.real + 42, level - 46), complex(head + 4, level + 46), "glass"),
        poly(E - 30 - 45j, E + 42 - 45j, E + 42 + 45j, E - 30 + 45j, shade="dark"),
        box(E - 32 - 30j, E + 26 + 30j, "white"),
        *(open_line(E + w - 45j, E + w + 45j, thin=True) for w in (30, 36)),
        capsule(B, E, 13, 11, "light"),
        capsule(C, B, 15, 13, "mid"),
        capsule(A, B, 13, 12, "light"),
        capsule(O, A, 24, 16, "dark"),
        *joints([(O, 15), (A, 11), (B, 11), (C, 13), (E, 9)]),
        note((O + A) / 2 + 40, "2"),
        note((A + B) / 2 - 28, "3"),
        note((C + B) / 2 - 18 + 22j, "4"),
        note((B + E) / 2 + 26j, "5"),
        note(complex(E.real + 78, level), "6"),
    ]
    way = [complex(w) for w in path("atkinson_engine", "B", theta2=FINE)]
    order = sorted(way, key=lambda w: w.imag)[::40]
    return beside(real, [trace(tuple(order)), *elements], paper_mm=(165, 105))


# ------------------------------------------------------------------ Maltese cross

CROSS_AT = 20.0
SLOTS, PIN = 4, 2.6  #: slots of the cross, and the radius of its pin, mm
TEETH, PITCH = 16, 4.75  #: of the sprocket, and the pitch of the perforations, mm


def maltese_cross():
    """The drive of a film projector: driver with pin and locking disc, cross, and the sprocket that pulls the
    film."""
    elements, z = scheme("maltese_cross", theta2=CROSS_AT)
    O, A, C = (z[n] for n in "OAC")
    turned = float(np.degrees(np.angle(A - C)))
    r1, r2 = abs(C - O), abs(A - O)
    lock = r2 - 7.0
    real = [
        shape(
            tuple(
                (O + C) / 2 + complex(62 * np.cos(t), 47 * np.sin(t))
                for t in np.radians(np.arange(0, 360, 4))
            ),
            "light",
        ),
        shape(
            tuple(
                (O + C) / 2 + complex(58 * np.cos(t), 43 * np.sin(t))
                for t in np.radians(np.arange(0, 360, 4))
            ),
            "white",
            thin=True,
        ),
        disc(O, r2 + 5, "light"),
        shape(_outline(C, turned, r1, r2, lock), "mid"),
        shape(_lock(O, CROSS_AT, lock), "dark"),
        capsule(O, A, 6, 5, "dark"),
        disc(A, PIN, "white"),
        *_sprocket(C, turned),
        *joints([(O, 4.5), (C, 4)]),
        note(O - 12 - 6j, "2"),
        note(C + 20 * polar(1, turned + 45), "4"),
    ]
    return beside(real, elements, paper_mm=(165, 95))


def _outline(centre, turned, r1, r2, lock):
    """The outline of a cross: slots as wide as the pin, hollows in which the locking disc turns."""
    tip = (r1**2 - r2**2) ** 0.5
    depth = r1 - r2 - PIN
    half = 180 / SLOTS
    outline = []
    for k in range(SLOTS):
        slot = complex(polar(1.0, turned + 2 * half * k))
        outline += [slot * complex(tip, -PIN), slot * complex(depth + PIN, -PIN)]
        outline += [slot * (depth + PIN + PIN * complex(polar(1.0, a))) for a in range(260, 90, -20)]
        outline += [slot * complex(depth + PIN, PIN), slot * complex(tip, PIN)]
        away = slot * complex(polar(1.0, half))
        hollow = lock + 0.4
        reach = np.degrees(np.arccos((r1**2 + hollow**2 - tip**2) / (2 * r1 * hollow)))
        outline += [away * (r1 - hollow * complex(polar(1.0, a))) for a in np.linspace(reach, -reach, 13)]
    return tuple(centre + complex(w) for w in outline)


def _lock(centre, at, radius):
    """The locking disc, cut away where the pin is in the cross."""
    arc = [centre + radius * complex(polar(1.0, at + a)) for a in np.linspace(50, 310, 40)]
    return (*arc, centre + 5 * complex(polar(1.0, at - 70)), centre + 5 * complex(polar(1.0, at + 70)))


def _sprocket(centre, turned):
    """The sprocket in front of the cross, and the film that leaves it."""
    radius = TEETH * PITCH / (2 * np.pi)
    rim = [centre + complex(radius * polar(1.0, a)) for a in np.linspace(0, -60, 13)]
    teeth = [
        centre + complex((radius + rise) * polar(1.0, turned + (k + part) * 360 / TEETH))
        for k in range(TEETH)
        for part, rise in ((0.15, 0), (0.35, 1.8), (0.6, 1.8), (0.8, 0))
    ]
    gate = centre + radius
    return [
        shape(tuple(teeth), "none"),
        box(gate + 1.2 + 16j, gate + 6 + 56j, "mid"),
        box(gate + 6 + 26j, gate + 12 + 46j, "glass"),
        open_line(gate + 62j, *rim, rim[-1] + 40 * complex(polar(1.0, 210))),
    ]


# ------------------------------------------------------------------ schemes in motion


def shaper_moves():
    """The shaper, in motion."""
    return in_motion("shaper", ROUND, **SHAPER)


def needle_bar_moves():
    """Needle bar and take-up, in motion."""
    return in_motion("needle_bar", ROUND, "P")


def atkinson_engine_moves():
    """Atkinson's engine, in motion."""
    return in_motion("atkinson_engine", ROUND)


def maltese_cross_moves():
    """The cross in motion, nearly from the entry of the pin to its exit."""
    return in_motion("maltese_cross", np.linspace(-43.0, 43.0, 36))


# ------------------------------------------------------------------ schemes to be named

#: What is shown without a name: the mechanism, and what is given instead of what its variant draws.
NAMELESS = (
    ("inverted_slider_crank", {}),
    ("toggle", {}),
    ("scotch_yoke", {}),
    ("digger_arm", {}),
    ("shaper", {"r2": 90.0, "theta2": 60.0}),
    ("class_three", {}),
    ("jansen_leg", {"theta2": 65.0}),
    ("peaucellier", {"theta2": 25.0}),
)


def to_be_named():
    """Eight schemes without a name."""
    drawings = [unlettered(scheme(name, **changed)[0]) for name, changed in NAMELESS]
    return Figure(*rows_of(drawings, 4, 100 + 90j), paper_mm=(165, 105))


# ------------------------------------------------------------------ numbers


def values():
    """The numbers that the lesson's text states, as they are printed."""
    return {**_shaper(), **_needle(), **_engine(), **_cross(), **_named()}


def _named():
    """How many bodies move in a scheme without a name, and how many lower pairs join them."""
    found = {}
    for letter, (name, _) in zip("abcdefgh", NAMELESS, strict=True):
        bodies, pairs = counted(name)
        found |= {f"{letter}_bodies": f"{bodies}", f"{letter}_pairs": f"{pairs}"}
    return found


def _shaper():
    found = solved("shaper", ("theta4", "xE", "v_E_x"), theta2=FINE, **SHAPER)
    x = found["xE"]
    cut = (FINE[x.argmin()] - FINE[x.argmax()]) % 360
    wished = solved("shaper", "xE", theta2=FINE, r2=125.0, r5=450.0, h=400.0)
    slow = (FINE[wished.argmin()] - FINE[wished.argmax()]) % 360
    return {
        "design_Q": f"{slow / (360 - slow):.2f}",
        "design_stroke": f"{np.ptp(wished):.0f}",
        **given("shaper", "shaper", "r1", "r5", "r6", "h"),
        "shaper_r2": f"{SHAPER['r2']:.0f}",
        "shaper_speed": f"{SHAPER['omega2']:.0f}",
        "shaper_swing": f"{swing(found['theta4']):.1f}",
        "shaper_stroke": f"{np.ptp(x):.0f}",
        "shaper_cut": f"{cut:.0f}",
        "shaper_Q": f"{cut / (360 - cut):.2f}",
        "shaper_forward": f"{-found['v_E_x'].min() / 1000:.2f}",
        "shaper_back": f"{found['v_E_x'].max() / 1000:.2f}",
    }


def _needle():
    found = solved("needle_bar", ("x", "x_dot", "x_ddot", "yP"), theta2=FINE, omega2=NEEDLE)
    down, eye = found["x"], found["yP"]
    inside = -down - POINT < PLATE
    late = (FINE[eye.argmin()] - FINE[down.argmax()]) % 360
    return {
        **given("needle", "needle_bar", "r2", "r3", "OF"),
        "needle_stroke": f"{np.ptp(down):.0f}",
        "needle_turns": f"{NEEDLE * 60 / (2 * np.pi):.0f}",
        "needle_share": f"{100 * inside.mean():.0f}",
        "needle_speed": f"{abs(found['x_dot']).max() / 1000:.2f}",
        "needle_low": f"{abs(found['x_ddot'][down.argmax()]) / 1000:.0f}",
        "needle_high": f"{abs(found['x_ddot'][down.argmin()]) / 1000:.0f}",
        "eye_lift": f"{np.ptp(eye):.0f}",
        "eye_late": f"{late:.0f}",
        "eye_rise": f"{(FINE[eye.argmax()] - FINE[eye.argmin()]) % 360:.0f}",
    }


def _engine():
    found = solved("atkinson_engine", ("theta3", "theta4", "x"), theta2=FINE)
    x = found["x"]
    ends = x[(x < np.roll(x, 1)) & (x < np.roll(x, -1))]
    tops = x[(x > np.roll(x, 1)) & (x > np.roll(x, -1))]
    full, part = x.max() - ends.min(), x.max() - ends.max()
    return {
        **given("engine", "atkinson_engine", "r2", "r3", "r4", "r5"),
        "engine_strokes": f"{len(ends) + len(tops):.0f}",
        "engine_swing": f"{swing(found['theta4']):.0f}",
        "engine_long": f"{full:.0f}",
        "engine_short": f"{part:.0f}",
        "engine_ratio": f"{full / part:.2f}",
        "engine_least_mu": f"{crossing(found['theta3'], found['theta4']).min():.0f}",
    }


FRAMES = 24  #: pictures a second, and turns a second of the driver


def _cross():
    inside = np.linspace(-45.0, 45.0, 3601)
    found = solved("maltese_cross", ("omega4", "alpha4"), theta2=inside, omega2=1.0)
    share = np.ptp(inside) / 360
    fastest = abs(found["omega4"]).max()
    radius = TEETH * PITCH / (2 * np.pi)
    return {
        **given("cross", "maltese_cross", "r1"),
        "cross_r2": f"{data('maltese_cross')['r2']:.1f}",
        "cross_frames": f"{FRAMES:.0f}",
        "cross_teeth": f"{TEETH:.0f}",
        "cross_pitch": f"{PITCH:.2f}",
        "cross_film": f"{TEETH * PITCH / SLOTS:.0f}",
        "cross_share": f"{100 * share:.0f}",
        "cross_moves": f"{1000 * share / FRAMES:.1f}",
        "cross_stands": f"{1000 * (1 - share) / FRAMES:.1f}",
        "cross_fast": f"{fastest:.2f}",
        "cross_entry": f"{abs(found['alpha4'][0]):.2f}",
        "cross_peak": f"{abs(found['alpha4']).max():.2f}",
        "cross_film_speed": f"{fastest * 2 * np.pi * FRAMES * radius / 1000:.1f}",
    }
