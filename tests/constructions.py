"""The drawn exercises of the course, each constructed as a student does: from what the sheet states, and what
is drawn."""

import math

from site_pencil import cis

POLE = 80 + 45j


def velocity_polygon(hand):
    _crank(hand, "OA", hand.given["omega2"])
    hand.meet("b", (hand.at["a"], "perpendicular", "AB"), (hand.at["p"], "perpendicular", "CB"))
    _measure(hand, ab="ab")
    _measure(hand, "v_B", pv_b="pb")
    return {
        "omega3": hand.rate("a", "b", "AB", hand.given["r3"]),
        "omega4": hand.rate("p", "b", "CB", hand.given["r4"]),
    }


def velocity_polygon_slider(hand):
    _crank(hand, "OA", hand.given["omega2"])
    hand.meet("b", (hand.at["a"], "perpendicular", "AB"), (hand.at["p"], "parallel", "x"))
    _measure(hand, ab="ab", pv_b="pb")
    return {"omega3": hand.rate("a", "b", "AB", hand.given["r3"]), "r1_dot": _along(hand, "p", "b")}


def velocity_polygon_slotted(hand):
    _crank(hand, "O2A", hand.given["omega2"])
    hand.meet("b", (hand.at["a"], "parallel", "O4A"), (hand.at["p"], "perpendicular", "O4A"))
    _measure(hand, ab="ab", pv_b="pb")
    return {"omega4": hand.rate("p", "b", "O4A", hand.given["rA"]), "rA_dot": _along(hand, "b", "a", "O4A")}


def velocity_polygon_six_bar(hand):
    _crank(hand, "OA", hand.given["omega2"])
    hand.meet("b", (hand.at["a"], "perpendicular", "AB"), (hand.at["p"], "perpendicular", "DB"))
    hand.meet("c", (hand.at["b"], "perpendicular", "CB"), (hand.at["p"], "parallel", "x"))
    _measure(hand, ab="ab", pv_b="pb", bc="bc", pv_c="pc")
    return {
        "omega3": hand.rate("a", "b", "AB", hand.given["r3"]),
        "omega4": hand.rate("p", "b", "DB", hand.given["r4"]),
        "omega5": -hand.rate("b", "c", "CB", hand.given["r5"]),
        "r6_dot": _along(hand, "p", "c"),
    }


def acceleration_polygon(hand):
    given = hand.given
    _crank_turning_steadily(hand, "OA")
    _normal(hand, "n", "a", "AB", given["V_BA"], given["r3"])
    _normal(hand, "m", "p", "CB", given["V_B"], given["r4"])
    hand.meet("b", (hand.at["n"], "perpendicular", "AB"), (hand.at["m"], "perpendicular", "CB"))
    _measure(hand, bb_t="nb")
    _measure(hand, "a_B", pa_b="pb")
    return {
        "alpha3": hand.rate("n", "b", "AB", given["r3"]),
        "alpha4": hand.rate("m", "b", "CB", given["r4"]),
    }


def acceleration_polygon_slider(hand):
    given = hand.given
    _crank_turning_steadily(hand, "OA")
    _normal(hand, "n", "a", "AB", given["V_BA"], given["r3"])
    hand.meet("b", (hand.at["n"], "perpendicular", "AB"), (hand.at["p"], "parallel", "x"))
    _measure(hand, bb_t="nb", pa_b="pb")
    return {"alpha3": hand.rate("n", "b", "AB", given["r3"]), "r1_ddot": _along(hand, "p", "b")}


def acceleration_polygon_slotted(hand):
    given = hand.given
    _crank_turning_steadily(hand, "O2A")
    _lever(hand, "O4A", "a", "k", "n", "b", given["omega4"], given["rA_dot"], given["rA"])
    _measure(hand, bk="bk", nb_t="nb")
    return {"alpha4": hand.rate("n", "b", "O4A", given["rA"]), "rA_ddot": _along(hand, "b", "k", "O4A")}


def acceleration_polygon_six_bar(hand):
    given = hand.given
    _crank_turning_steadily(hand, "OA")
    _normal(hand, "n", "a", "AB", given["V_BA"], given["r3"])
    _normal(hand, "m", "p", "DB", given["V_B"], given["r4"])
    hand.meet("b", (hand.at["n"], "perpendicular", "AB"), (hand.at["m"], "perpendicular", "DB"))
    _normal(hand, "f", "b", "CB", -given["V_CB"], given["r5"])
    hand.meet("c", (hand.at["f"], "perpendicular", "CB"), (hand.at["p"], "parallel", "x"))
    _measure(hand, bb_t="nb", pa_c="pc")
    return {"alpha3": hand.rate("n", "b", "AB", given["r3"]), "r6_ddot": _along(hand, "p", "c")}


def crank_shaper_drawn(hand):
    given = hand.given
    ratio, OP = given["r4"] / given["OP"], given["OP"]
    _crank(hand, "CP", given["omega2"], pole=80 + 135j, scale="kv")
    hand.meet("b", (hand.at["a"], "parallel", "OP"), (hand.at["p"], "perpendicular", "OP"))
    hand.circle(hand.at["p"], f"{abs(hand.at['b'] - hand.at['p']) * ratio:.4g}")
    hand.crossing(hand.at["p"] + ratio * (hand.at["b"] - hand.at["p"]), "d")
    hand.meet("e", (hand.at["d"], "perpendicular", "DE"), (hand.at["p"], "parallel", "x"))
    _measure(hand, pv_b="pb", pv_e="pe")
    omega4, sliding, along_rod = (
        hand.rate("p", "b", "OP", OP),
        _along(hand, "b", "a", "OP"),
        abs(hand.at["e"] - hand.at["d"]) * hand.scale,
    )
    velocities = {"omega4": omega4, "v_C": _along(hand, "p", "e")}
    _crank_turning_steadily(hand, "CP", pole=60 + 45j, scale="ka", names="q a2")
    _lever(hand, "OP", "a2", "k", "n", "b2", omega4, sliding, OP, pole="q")
    q, b2 = hand.at["q"], hand.at["b2"]
    hand.tool("vector")
    hand.sure(q)
    hand.sure(b2)
    hand.tool("parallel")
    hand.sure(q + 0.4 * (b2 - q))
    hand.sure(q)
    hand.circle(q, f"{abs(b2 - q) * ratio:.4g}")
    hand.crossing(q + ratio * (b2 - q), "d2")
    _normal(hand, "m", "d2", "DE", along_rod, given["r5"])
    hand.meet("e2", (hand.at["m"], "perpendicular", "DE"), (q, "parallel", "x"))
    _measure(hand, pa_e=("q", "e2"))
    ends = math.degrees(math.asin(given["r2"] / given["r1"]))
    speed = given["r2"] * abs(given["omega2"])
    return velocities | {
        "a_C": _along(hand, "q", "e2"),
        "alpha": 180 + 2 * ends,
        "beta": 180 - 2 * ends,
        "Q": (180 + 2 * ends) / (180 - 2 * ends),
        "mechanical_advantage": speed / abs(velocities["v_C"]),
    }


def two_circles(hand):
    given = hand.given
    hand.set_scale(max(given[f"r{k}"] for k in (1, 2, 3, 4)), most=60)
    r1, r2, r3, r4 = (given[f"r{k}"] / hand.scale for k in (1, 2, 3, 4))
    p = POLE
    hand.start(p, "p")
    A = hand.lay_off(p, "parallel", "OA", r2 * cis(given["theta2"]), "a", f"{given['r2']:g}/{hand.scale:g}")
    C = hand.lay_off(p, "parallel", "x", r1, "c", f"{given['r1']:g}/{hand.scale:g}")
    if "radii" in hand.mistakes:
        r3, r4 = r4, r3
    hand.circle(A, f"{r3 * hand.scale:g}/{hand.scale:g}")
    centre = hand.at[hand.mistakes.get("centre", "c")]
    hand.circle(centre, f"{r4 * hand.scale:g}/{hand.scale:g}")
    way = centre - A
    along = (abs(way) ** 2 + r3**2 - r4**2) / (2 * abs(way))
    for name, side, mode in (("b1", 1j, "open"), ("b2", -1j, "crossed")):
        B = A + way / abs(way) * (along + side * math.sqrt(r3**2 - along**2))
        hand.crossing(B, name)
        hand.measure(A, B, f"theta3_{mode}")
        hand.measure(C, B, f"theta4_{mode}")
    return {}


def havens_construction(hand):
    given = hand.given
    arm = given["r2"] + given["r3"]
    speed, O4A = abs(given["omega1"]) * arm, given["rA"]
    hand.set_scale(speed, most=50)
    start, sense = 90 + 30j, math.copysign(1, given["omega1"])
    hand.tool("point")
    hand.sure(start)
    tip = hand.lay_off(
        start, "perpendicular", "O1A1", sense * 1j * cis(hand.links["O1A1"]) * speed / hand.scale, step="v10"
    )
    _arrow(hand, "v10", start, tip)
    foot = hand.meet(None, (start, "perpendicular", "O4A1"), (tip, "parallel", "O4A1"))
    _arrow(hand, "v40", start, foot)
    _arrow(hand, "v14", foot, tip)
    _arrow(hand, "v24", foot, tip)
    ratio = (O4A + given["b"]) / O4A
    hand.circle(start, f"{abs(foot - start) * ratio:.4g}")
    of_guide = hand.crossing(start + ratio * (foot - start))
    hand.at |= {"foot": foot}
    of_B2 = hand.lay_off(of_guide, "parallel", "O4A1", tip - foot, step="v20")
    _arrow(hand, "v20", start, of_B2)
    across = hand.line("perpendicular", start, "O1A1")
    square = hand.line("perpendicular", of_B2, degrees=given["line"])
    slope = (across.conjugate() * square).imag
    of_I = hand.crossing(start + across * ((of_B2 - start).conjugate() * square).imag / slope)
    _arrow(hand, "v30", start, of_I)
    hand.at |= {"s": start, "foot": foot, "I": of_I}
    return {"omega4": hand.rate("s", "foot", "O4A1", O4A), "omega3": hand.rate("s", "I", "O1A1", given["r3"])}


# --------------------------------------------------------------------------- steps


def _crank(hand, link, omega, pole=POLE, scale=""):
    """The velocity of the end of the crank, square to it."""
    speed = abs(omega) * hand.given["r2"]
    hand.set_scale(speed, scale)
    hand.start(pole, "p")
    vector = math.copysign(1, omega) * 1j * cis(hand.links[link]) * speed / hand.scale
    hand.lay_off(pole, "perpendicular", link, vector, "a", f"{speed:g}/{hand.scale:g}")


def _crank_turning_steadily(hand, link, pole=POLE, scale="", names="p a"):
    """The acceleration of the end of the crank, towards its pivot."""
    size = hand.given["omega2"] ** 2 * hand.given["r2"]
    hand.set_scale(size, scale)
    p, a = names.split()
    hand.start(pole, p)
    hand.lay_off(
        pole, "parallel", link, -cis(hand.links[link]) * size / hand.scale, a, f"{size:g}/{hand.scale:g}"
    )


def _normal(hand, name, start, link, speed, length):
    """The normal part of an acceleration, towards the start of a link; towards its end where the speed is
    negative."""
    size = speed**2 / length / hand.scale
    way = -math.copysign(1, speed) * cis(hand.links[link])
    hand.lay_off(hand.at[start], "parallel", link, way * size, name, f"{size:.4g}")


def _lever(hand, link, a, k, n, b, omega, sliding, arm, pole="p"):
    """The acceleration of a slotted lever: Coriolis' ends in the point of the crank, then the two that are
    unknown meet."""
    along = cis(hand.links[link])
    hand.lay_off(hand.at[a], "perpendicular", link, -2j * omega * sliding * along / hand.scale, k)
    hand.lay_off(hand.at[pole], "parallel", link, -(omega**2) * arm * along / hand.scale, n)
    hand.meet(b, (hand.at[k], "parallel", link), (hand.at[n], "perpendicular", link))


def _arrow(hand, name, start, end):
    hand.tool("vector")
    hand.sure(start)
    hand.sure(end)
    hand.press(f"[data-name={name}]")


def _along(hand, start, end, link="x"):
    """The part of a drawn vector along a link, in the unit of the drawing."""
    return ((hand.at[end] - hand.at[start]) * hand.scale / cis(hand.links[link])).real


def _measure(hand, *same, **parts):
    """Measure each part between two named points; the last is also of the parts ``same``."""
    for part, (start, end) in parts.items():
        hand.measure(hand.at[start], hand.at[end], part, *same)
