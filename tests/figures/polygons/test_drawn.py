"""Drawn polygons are judged as with ruler and set-square: any pole, any scale, each vector from the student's
own points."""

from __future__ import annotations

import cmath
import math
import random

import pytest
from sweeps import seeds

import coursework
from coursework.errors import BadCourse, UnknownName, WrongValue
from coursework.figures.polygons import Polygon, Side, image
from coursework.figures.polygons.hand_drawn import TOLERANCE_MM, judge_drawing, vector_fault
from coursework.model import Exercise, Part, drawn

COURSE = coursework.open_course()
NAMES = ("velocity_polygon", "velocity_polygon_slider", "acceleration_polygon", "acceleration_polygon_slider")
every_polygon = pytest.mark.parametrize("name", NAMES)


def polygons(name, seeds):
    return [v.polygons()[0].polygon for v in COURSE[name].variants(seeds)]


def on_paper(polygon, scale, pole, noise=0.0, chance=random):
    """The drawing of somebody whose points are up to ``noise`` mm off."""
    return {
        n: pole + z / scale + cmath.rect(noise * math.sqrt(chance.random()), chance.uniform(0, 2 * math.pi))
        for n, z in polygon.points.items()
    }


def fits(polygon, chance):
    """A scale at which the longest vector has 40 to 150 mm: a student's own, not a round one."""
    return polygon.size / chance.uniform(40, 150)


@every_polygon
@pytest.mark.parametrize("stated", [True, False])
@seeds(12, 40)
def test_drawings_within_the_tolerance_are_right_at_any_pole_and_scale(name, stated, seeds):
    chance = random.Random(7)
    for polygon in polygons(name, seeds):
        for _ in range(30):
            scale, pole = fits(polygon, chance), complex(chance.uniform(-300, 300), chance.uniform(-300, 300))
            points = on_paper(polygon, scale, pole, TOLERANCE_MM, chance)
            found = judge_drawing(polygon, points, scale if stated else None)
            assert not found.faults
            assert found.is_legible
            assert found.fits_stated_scale


def moved(polygon, points, point, vector):
    """A vector put in place of the one that ends at a point, and what hangs on it drawn rightly from
    there."""
    (side,) = polygon.hangs[point]
    old = points[point]
    return {**points, point: points[side.start] + vector(points[point] - points[side.start])}, old


def drawn_on(polygon, points, scale, first):
    """Go on rightly from a wrong point: known vectors and lines from the student's own."""
    order = list(polygon.hangs)
    own = dict(points)
    for point in order[order.index(first) + 1 :]:
        sides = polygon.hangs[point]
        if len(sides) == 1:
            own[point] = own[sides[0].start] + sides[0].value / scale
        else:
            (p, u), (q, v) = ((own[s.start], s.along) for s in sides)
            own[point] = p + u * ((q - p).conjugate() * v).imag / (u.conjugate() * v).imag
    return own


FAULTS = {
    "length": lambda d: d * (1 + 8 / abs(d)),
    "direction": lambda d: d * cmath.exp(2j * math.asin(min(1.0, 4 / abs(d)))) if abs(d) > 5 else 1j * d,
    "sense": lambda d: -d,
    "vector": lambda d: 1.9 * d * cmath.exp(1.2j),
}


@every_polygon
@pytest.mark.parametrize("kind", FAULTS)
@seeds(15, 60)
def test_a_fault_in_a_known_vector_is_named_and_costs_nothing_after_it(name, kind, seeds):
    for polygon in polygons(name, seeds):
        scale = polygon.size / 100
        right = on_paper(polygon, scale, 20 + 30j)
        known = [q for q, sides in polygon.hangs.items() if len(sides) == 1]
        for point in known:
            if abs(polygon.hangs[point][0].value) / scale < 12:
                continue
            wrong, _ = moved(polygon, right, point, FAULTS[kind])
            own = drawn_on(polygon, wrong, scale, point)
            found = judge_drawing(polygon, own, scale)
            assert set(found.faults) == {point}
            fault = found.faults[point]
            assert kind in {f.kind for f in fault.explanations}
            assert fault.side == polygon.hangs[point][0]
            assert found.follows("b") == (abs(own["b"] - right["b"]) > 2 * TOLERANCE_MM)


@every_polygon
@pytest.mark.parametrize("kind", FAULTS)
def test_points_in_their_true_places_are_right_beside_a_fault_in_a_known_vector(name, kind):
    """They may follow from the wrong point, or stand where they belong: both are right."""
    for polygon in polygons(name, range(20)):
        scale = polygon.size / 100
        right = on_paper(polygon, scale, 20 + 30j)
        for point, sides in polygon.hangs.items():
            if len(sides) == 1 and abs(sides[0].value) / scale >= 12:
                wrong, _ = moved(polygon, right, point, FAULTS[kind])
                assert set(judge_drawing(polygon, wrong, scale).faults) == {point}


@every_polygon
def test_a_vector_hung_on_another_point_is_told_with_that_point(name):
    told = 0
    for polygon in polygons(name, range(60)):
        scale = polygon.size / 100
        points = on_paper(polygon, scale, 0j)
        before = [polygon.pole]
        for point, sides in polygon.hangs.items():
            for side in sides if len(sides) == 1 else ():
                for other in (q for q in before if q != side.start):
                    if abs(points[other] - points[side.start]) < 15:
                        continue
                    wrong = {**points, point: points[other] + side.value / scale}
                    found = judge_drawing(polygon, wrong, scale).faults[point]
                    assert (found.kind, found.on, found.side) == ("hung", other, side)
                    told += 1
            before.append(point)
    assert told or name.startswith("velocity")


@every_polygon
def test_a_point_off_one_of_its_lines_is_a_wrong_direction_of_that_vector(name):
    for polygon in polygons(name, range(60)):
        scale = polygon.size / 100
        points = on_paper(polygon, scale, 5j)
        for bad, good in ((0, 1), (1, 0)):
            sides = polygon.hangs["b"]
            off = sides[good].along
            across = abs((off.conjugate() * sides[bad].along).imag)
            for step in (2.2, 9.0, -2.2, -9.0):
                wrong = {**points, "b": points["b"] + off * step / across}
                fault = judge_drawing(polygon, wrong, scale).faults["b"]
                assert ("direction", sides[bad]) in {(f.kind, f.side) for f in fault.explanations}
            inside = {**points, "b": points["b"] + off * 1.9 / across}
            assert not judge_drawing(polygon, inside, scale).faults


@every_polygon
@seeds(12, 40)
def test_nothing_is_accepted_that_is_three_tolerances_off_its_vector(name, seeds):
    """Known vectors are told from any others that end more than 2 mm away; lines from points 2 mm off
    them."""
    chance = random.Random(3)
    for polygon in polygons(name, seeds):
        scale = polygon.size / 90
        points = on_paper(polygon, scale, 0j)
        for point, sides in polygon.hangs.items():
            for _ in range(20):
                step = cmath.rect(chance.uniform(2.05, 60), chance.uniform(0, 6.3))
                wrong = {**points, point: points[point] + step}
                off = max(abs((step * s.along.conjugate()).imag) if s.is_line else abs(step) for s in sides)
                found = judge_drawing(polygon, wrong, scale)
                # Along a vector whose like the others are, the point is that of another scale, which is told.
                assert found.is_right(point) == (off <= 2 * TOLERANCE_MM) or not found.fits_stated_scale


def test_a_drawing_turned_or_mirrored_is_another_drawing():
    for polygon in polygons("acceleration_polygon", range(20)):
        scale = polygon.size / 100
        points = on_paper(polygon, scale, 0j)
        for change in (lambda z: z * cmath.exp(0.1j), lambda z: 1j * z, lambda z: z.conjugate()):
            assert judge_drawing(polygon, {n: change(z) for n, z in points.items()}, scale).faults


def test_a_scale_that_the_drawing_does_not_have_costs_the_scale_alone():
    for polygon in polygons("acceleration_polygon", range(20)):
        scale = polygon.size / 100
        found = judge_drawing(polygon, on_paper(polygon, scale, 0j), 3 * scale)
        assert not found.faults
        assert not found.fits_stated_scale
        assert found.scale == pytest.approx(scale, rel=0.05)


def test_a_drawing_too_small_to_tell_directions_is_not_legible():
    (polygon,) = polygons("velocity_polygon", [1])
    assert not judge_drawing(polygon, on_paper(polygon, polygon.size / 15, 0j)).is_legible
    nothing = dict.fromkeys(polygon.points, 5 + 5j)
    assert not judge_drawing(polygon, nothing).is_legible


@every_polygon
def test_points_that_are_all_one_earn_nothing(name):
    for variant in COURSE[name].variants(range(20)):
        points = {p.id: "5; 5" for p in variant.parts if p.kind == "point"}
        k = next(i for i in ("kv", "ka") if i in variant.part_ids)
        for given in (points, {k: variant.key.reference[k], **points}):
            marking = variant.grade(given)
            assert [i for i in points if marking[i].points] == []


def test_what_is_not_drawn_is_missing_and_what_follows_is_judged_from_where_it_should_be():
    (polygon,) = polygons("acceleration_polygon", [2])
    points = on_paper(polygon, polygon.size / 100, 3j)
    del points["b'"]
    found = judge_drawing(polygon, points, polygon.size / 100)
    assert {n: f.kind for n, f in found.faults.items()} == {"b'": "missing"}


def test_short_vectors_have_no_direction_that_a_ruler_shows():
    assert vector_fault(1.5j, 1.5, 2.2) == ""
    assert vector_fault(3j, 3, 2) == "direction"
    assert [vector_fault(z, 50, 2) for z in (50 + 1.9j, 53, -50, 50j, 20j, 1)] == [
        "",
        "length",
        "sense",
        "direction",
        "vector",
        "length",
    ]


def test_what_cannot_be_judged_is_said():
    (polygon,) = polygons("velocity_polygon", [1])
    for points, scale, error in (
        ({"a": 1j}, None, "judged from its pole"),
        ({"p_v": 0j, "q": 1j}, None, "q"),
        ({"p_v": 0j, "a": complex("nan")}, None, "not finite"),
        ({"p_v": 0j}, -1.0, "positive"),
    ):
        with pytest.raises((WrongValue, UnknownName), match=error):
            judge_drawing(polygon, points, scale)


def test_a_box_to_draw_in_fits_a_page():
    with pytest.raises(BadCourse, match="10 to 160 mm wide"):
        Exercise(given={"x": drawn(1, 2)}, parts=(Part("y"),), drawing_mm=(300, 100))


# ---------------------------------------------------------------------------- as students answer


def answers(variant, scale, pole, noise=0.0, chance=random):
    """The answers of somebody who draws at a scale of their own, and reads everything off that drawing."""
    spec, polygon = variant.exercise.spec, variant.polygons()[0].polygon
    points = on_paper(polygon, scale, pole, noise, chance)
    images = dict(zip((p.id for p in spec.parts if p.kind == "point"), polygon.points, strict=True))
    found = {i: f"({points[q].real:.1f}; {points[q].imag:.1f})" for i, q in images.items()}
    found |= {i: f"{v:.1f}" for i, v in lengths(variant, points).items()}
    key = variant.key.reference
    reads = {p.id: key[p.quantity] for p in variant.parts if p.judge and p.unit.split("/")[0] in ("rad",)}
    found |= {p.id: key[p.quantity] for p in variant.parts if p.kind == "choice"} | reads
    return found | {next(p.id for p in variant.parts if p.id in ("kv", "ka")): f"{scale:.6g}"}


def lengths(variant, points):
    ends = {"ab": ("a", "b"), "bb_t": ("b'", "b")}
    ends |= {"pv_b": ("p_v", "b"), "pa_b": ("p_a", "b")}
    return {i: abs(points[q] - points[r]) for i, (q, r) in ends.items() if i in variant.part_ids}


@every_polygon
def test_an_honest_drawing_at_ones_own_pole_and_scale_earns_everything_that_is_drawn(name):
    chance = random.Random(5)
    for variant in COURSE[name].variants(range(30)):
        polygon = variant.polygons()[0].polygon
        marking = variant.grade(given := answers(variant, fits(polygon, chance), 40 - 70j, 0.9, chance))
        assert {i: m.verdict for i, m in marking.items() if i in given and m.verdict != "correct"} == {}


@every_polygon
@seeds(3, 10)
def test_lengths_alone_are_judged_at_the_stated_scale(name, seeds):
    for variant in COURSE[name].variants(seeds):
        polygon = variant.polygons()[0].polygon
        scale = polygon.size / 80
        k = next(i for i in ("kv", "ka") if i in variant.part_ids)
        right = {i: f"{v + 1.5:.1f}" for i, v in lengths(variant, on_paper(polygon, scale, 0j)).items()}
        marking = variant.grade({k: scale, **right})
        assert {marking[i].verdict for i in (k, *right)} == {"slip:not_drawn"}
        wrong = {i: float(v) + 2 for i, v in right.items()}
        assert "slip:not_drawn" not in {variant.grade({k: scale, **wrong})[i].verdict for i in wrong}


@every_polygon
def test_who_goes_on_rightly_from_a_wrong_first_vector_loses_it_alone(name):
    for variant in COURSE[name].variants(range(10)):
        polygon = variant.polygons()[0].polygon
        scale = polygon.size / 100
        wrong, _ = moved(polygon, on_paper(polygon, scale, 0j), "a", lambda d: -d)
        points = drawn_on(polygon, wrong, scale, "a")
        given = answers(variant, scale, 0j)
        parts = (p.id for p in variant.parts if p.kind == "point")
        given |= {
            i: f"{points[q].real}; {points[q].imag}" for i, q in zip(parts, polygon.points, strict=True)
        }
        marking = variant.grade(given)
        assert marking["a"].verdict == "mistake:a_sense"
        assert marking["b"].verdict == "follow_through"


def test_feedback_names_the_vector_and_gives_no_value():
    variant = COURSE["velocity_polygon"].variant(0, "en")
    a, b = variant.key.reference["a"], variant.key.reference["b"]
    told = variant.grade(
        {
            "kv": variant.key.reference["kv"],
            "p": "0;0",
            "a": f"{a[0]};{a[1]}",
            "b": f"{(a - b)[0]};{(a - b)[1]}",
        }
    )["b"].feedback
    assert "hang on the wrong points" in told


@every_polygon
@seeds(3, 10)
def test_a_scale_that_makes_any_drawing_small_explains_no_number(name, seeds):
    """At such a scale a millimetre is worth more than any value."""
    for variant in COURSE[name].variants(seeds):
        reads = [p.id for p in variant.parts if p.judge and p.kind == "number" and p.unit != "mm"]
        scale = next(i for i in reads if i in ("kv", "ka"))
        marking = variant.grade({**dict.fromkeys(reads, "7.7e7"), scale: "1e6"})
        assert {marking[i].points for i in reads} == {0}


# ------------------------------------------------------------------------- in proportion


def lever():
    """A point of a lever by two lines, another of the same lever by proportion, then one more by two
    lines."""
    along = cmath.exp(1.1j)
    of_block, across = 300 * cmath.exp(2.4j), 1j * along
    of_lever = across * (of_block / across).real
    of_end = 1.6 * of_lever
    rod = 1j * cmath.exp(0.2j)
    of_ram = (of_end + rod * -of_end.imag / rod.imag).real
    return Polygon(
        "velocity",
        (
            Side("p", "a", "A", of_block, "across", "known"),
            Side("b", "a", "slide", of_block - of_lever, "along", way=along),
            Side("p", "b", "B", of_lever, "across", way=across),
            image("p", "d", "D", of_end, ("p", "b"), "OD / OB"),
            Side("d", "e", "rod", of_ram - of_end, "square to the rod", way=rod),
            Side("p", "e", "E", of_ram, "along x", way=1),
        ),
    )


def test_a_point_in_proportion_is_judged_by_the_students_own():
    polygon, scale = lever(), 3.0
    points = on_paper(polygon, scale, 5 + 5j)
    assert not judge_drawing(polygon, points, scale).faults
    wrong_b = points["b"] + 9 * polygon.side("p", "b").along
    enlarged = points["p"] + 1.6 * (wrong_b - points["p"])
    rod = polygon.side("d", "e").along
    own_e = complex((enlarged - rod * ((enlarged - points["p"]).imag / rod.imag)).real, points["p"].imag)
    found = judge_drawing(polygon, {**points, "b": wrong_b, "d": enlarged, "e": own_e}, scale)
    assert set(found.faults) == {"b"}
    assert found.follows("d")
    assert found.follows("e")


def test_a_point_out_of_proportion_is_at_fault_and_one_of_nothing_drawn_too():
    polygon, scale = lever(), 3.0
    points = on_paper(polygon, scale, 0j)
    fault = judge_drawing(polygon, {**points, "d": points["b"]}, scale).faults["d"]
    assert (fault.kind, fault.side) == ("length", polygon.side("p", "d"))
    spot = {**points, "b": 0j, "d": 0j}
    assert "d" in judge_drawing(polygon, spot, scale).faults


def test_a_proportion_of_points_that_are_not_found_is_refused():
    with pytest.raises(BadCourse, match="both found"):
        Polygon("velocity", (image("p", "d", "D", 3, ("p", "b"), "2"),))
    with pytest.raises(BadCourse, match="state its length"):
        Side("p", "d", "D", 3, "along", image=("p", "b"))
