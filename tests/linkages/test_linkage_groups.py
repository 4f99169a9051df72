"""Pairs of bodies held in every way: their positions, rates and accelerations meet the joints, placed by the
frame of each body.

One body hangs on a crank, the other on a rocker, with every joint a pin, or a slide on either of its bodies,
whose line is off all frames.
"""

from itertools import product

import numpy as np

from coursework import open_course

FILE = """title = {{ en = "Pair of bodies", fr = "Paire de pièces" }}
[given]
theta2 = {{ from = "10 deg", to = "80 deg", step = "5 deg" }}
omega2 = "3 rad/s"
alpha2 = "5 rad/s^2"
[ground]
O = ["0 mm", "0 mm"]
Q = ["300 mm", "20 mm"]
[bodies]
2 = {{ at = "O", angle = "theta2", points = {{ A = "60 mm", E = ["20 mm", "35 mm"] }} }}
6 = {{ at = "Q", points = {{ F = "140 mm", D = ["60 mm", "-25 mm"] }} }}
7 = {{ points = {{ E = "0 mm", F = "290 mm" }} }}
{bodies}
[slides]
{slides}
[assembly]
F = "left of E -> Q"
{assembly}
[ask]
accelerations = ["a_{inner}"]
"""
WAYS = [  # pins, slides of the body on another, or of another on it; three slides hold no pair
    held for held in product(("pin", "of", "on"), repeat=3) if "pin" in held
]


def a_slide(point, of, on, along, through, distance):
    place = ", ".join(f'"{x} mm"' for x in through)
    return (
        f'{point} = {{ of = "{of}", on = "{on}", through = [{place}], along = "{along} deg", distance = '
        f'"{distance}" }}'
    )


def file_of(first, inner, last, names):
    """The file of a pair: how the crank holds one, how one holds the other, how the rocker holds this; and
    what the two are called."""
    p, q = names
    points, slides = {p: {}, q: {}}, []
    for body, held, holder, pin, block, line, place, along in (
        (p, first, "2", "A", "S", "s", (15, 12), 70),
        (q, last, "6", "D", "T", "t", (18, 11), -35),
    ):
        own = {"pin": pin, "of": block, "on": {p: "G", q: "H"}[body]}[held]
        points[body][own] = (0, 0)
        if held != "pin":
            ends = (block, body, holder) if held == "of" else (pin, holder, body)
            slides.append(a_slide(*ends, along, place, line))
    if inner == "pin":
        points[p]["B"] = (150, 30) if last == "pin" else (220, 20)
        points[q]["B"] = (120, -20) if first == "pin" else (260, -15)
    else:
        body, other = (p, q) if inner == "of" else (q, p)
        points[body]["U"] = (17, -12)
        slides.append(a_slide("U", body, other, 55, (21, 10), "u"))
    bodies = [
        f"{body} = {{ points = {{ "
        + ", ".join(f'{n} = ["{x} mm", "{y} mm"]' if x or y else f'{n} = "0 mm"' for n, (x, y) in own.items())
        + " } }"
        for body, own in points.items()
    ]
    return FILE.format(
        bodies="\n".join(bodies),
        slides="\n".join(slides),
        assembly='B = "left of A -> D"' if (first, inner, last) == ("pin",) * 3 else "",
        inner="B" if inner == "pin" else "U",
    )


def test_pairs_of_bodies_held_in_every_way_meet_their_joints(tmp_path):
    (tmp_path / "exercises").mkdir()
    ways = [(*held, names) for n, held in enumerate(WAYS) for names in (("3", "4"), ("4", "3"))[n % 2 :: 2]]
    files = {f"pair_{n}": way for n, way in enumerate(ways)}
    for name, way in files.items():
        (tmp_path / "exercises" / f"{name}.toml").write_text(file_of(*way), "utf-8")
    course = open_course(tmp_path)
    apart = {}
    for name, way in files.items():
        exercise = course[name]
        given = {**exercise.variant(0).given, "theta2": np.arange(-180.0, 180.0, 15.0)}
        gaps = exercise.solution.residual_graph.evaluate(("residual",), given)["residual"]
        closes = np.isfinite(gaps)
        if not closes.any() or np.max(np.asarray(gaps)[closes]) > 1e-9:
            apart[way] = gaps
    assert apart == {}
