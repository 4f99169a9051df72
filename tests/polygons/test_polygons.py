"""Polygons: as data, as drawings, and as stated by every exercise with rates.

What an exercise states is compared with its positions, differentiated numerically: no rate of the solution is used.
"""

from __future__ import annotations

import cmath
import math
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import cache
from itertools import accumulate

import numpy as np
import pytest
from drawn_svg import SVG, crossed, kinds, overlapping

import coursework
from coursework.cli import run
from coursework.cli.options import DONE
from coursework.errors import BadCourse, NoSolution, UnknownName
from coursework.figures import Figure, vector
from coursework.figures.text import SIZE, read
from coursework.language.words import languages
from coursework.polygons.construction import BOX_MM
from coursework.polygons.polygon import Polygon, Side, normal, tangential, turning
from coursework.rendering.displayed import DisplayedConstruction as Construction
from coursework.rendering.pdf import _letters as letters_to_set
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()


def polar(r, degrees):
    return r * np.exp(1j * np.radians(degrees))


def still(values):
    """The value of the middle sample, as a constant: a length of a body that does not change."""
    return values[len(values) // 2]


def crank_rod(end):
    def points(v):
        A = polar(v["r2"], v["theta2"])
        found = {"a": A, end: A + v["q"] + 1j * v["p"]}
        return found | ({"g": A + v["s3"] * (found[end] - A)} if "s3" in v else {})

    return points


def four_bar(v):
    A = polar(v["r2"], v["theta2"])
    return {"a": A, "b": A + polar(v["r3"], v["theta3"])}


def slider_extras(v):
    return four_bar(v) | {"p": v["r6"] + 0j}


def quick_return(v):
    B = four_bar(v)["b"]
    return four_bar(v) | {"c": B + polar(v["r5"], v["theta5"])}


def slotted(v):
    A = polar(v["r1"], v["theta1"]) + polar(v["r2"], v["theta2"])
    return {"a_2": A, "a_4": polar(still(v["rA"]), v["theta4"])}


def slotted_ram(v):
    return slotted(v | {"theta1": 90}) | {"p": polar(v["r4"], v["theta4"]), "c": v["xC"] + 1j * v["h"]}


def havens(v):
    A = polar(v["r2"] + v["r3"], v["theta1"])
    turned = v["theta4"] - still(v["theta4"]) + still(v["theta1"])
    return {
        "a_1": A,
        "a_4": polar(still(v["rA"]), v["theta4"]),
        "b_2": A + polar(v["b"], v["theta4"]),
        "i": A - polar(v["r2"], turned),
    }


def two_loops(v):
    D = polar(v["r5"], v["theta5"])
    return four_bar(v) | {"d": D, "e": D + polar(v["r6"], v["theta6"])}


def three_loops(v):
    A = polar(v["r2"], v["theta2"])
    return four_bar(v) | {
        "e": A + polar(v["r6"], v["theta6"]),
        "e_5": polar(still(v["d5"]), v["theta5"]),
        "f": polar(v["r5"], v["theta5"]),
        "g": v["x8"] + 0j,
    }


#: The given angle that moves the mechanism, its crank's angle, the quantities that place it, its points.
PLACES = {
    "slider_crank": ("theta2", "theta2", ("p", "q"), crank_rod("b")),
    "slider_crank_torque": ("theta2", "theta2", ("p", "q"), crank_rod("b")),
    "mechanical_advantage_slider": ("theta2", "theta2", ("p", "q"), crank_rod("b")),
    "quick_return_offset": ("theta2", "theta2", ("p", "q"), crank_rod("c")),
    "four_bar_motion": ("theta2", "theta2", ("theta3",), four_bar),
    "mechanical_advantage": ("theta2", "theta2", ("theta3",), four_bar),
    "slider_extras": ("theta2", "theta2", ("theta3", "r6"), slider_extras),
    "quick_return": ("angle_OAB", "theta2", ("theta2", "theta3", "theta5"), quick_return),
    "slotted_mechanism": ("theta2", "theta2", ("rA", "theta4"), slotted),
    "quick_return_whitworth": ("theta2", "theta2", ("rA", "theta4", "xC"), slotted_ram),
    "quick_return_shaper": ("theta2", "theta2", ("rA", "theta4", "xC"), slotted_ram),
    "havens_planetary": ("theta1", "theta1", ("rA", "theta4"), havens),
    "two_loop_linkage": ("theta2", "theta2", ("theta3", "theta5", "theta6"), two_loops),
    "three_loop_shaper": ("theta2", "theta2", ("theta3", "theta6", "theta5", "d5", "x8"), three_loops),
}
VARIANTS = 20

every_exercise = pytest.mark.parametrize("name", PLACES)
every_language = pytest.mark.parametrize("lang", languages())


@cache
def variants(name, lang="fr"):
    return COURSE[name].variants(range(VARIANTS), lang)


def constructions(name):
    return [drawn for variant in variants(name) for drawn in variant.polygons()]


def test_every_exercise_that_asks_a_rate_states_its_polygons():
    """All but those whose rates are one vector, or arrows each at its own point."""
    asking = {
        name
        for name in COURSE.names
        if any(part.unit in ("mm/s", "mm/s^2", "rad/s", "rad/s^2") for part in COURSE[name].spec.parts)
    }
    stating = {name for name in COURSE.names if COURSE[name].solution.polygons is not None}
    assert asking - stating <= {"coriolis", "ball_reducer", "havens_construction"}
    # Polygons that are themselves the answer are compared with those of these exercises elsewhere.
    assert {name for name in stating if not COURSE[name].spec.drawing_mm} == set(PLACES)


def derivatives(name, variant):
    """Velocity and acceleration of every point, from positions at nearby angles of the crank."""
    moved, crank, wanted, points = PLACES[name]
    given = dict(variant.used)
    samples = given[moved] + np.linspace(-0.4, 0.4, 9)
    found = variant.exercise.solve(**{**given, moved: samples}, only=wanted)
    values = {**given, moved: samples, **found}
    along = np.radians(np.unwrap(values[crank], period=360))
    along = along - along[4]
    rate = given["omega1" if name == "havens_planetary" else "omega2"]
    growth = given.get("alpha2", 0.0)
    width = np.abs(along).max()
    for point, place in points(values).items():
        fit = np.polynomial.polynomial.polyfit(along / width, np.broadcast_to(place, along.shape), 6)
        first, second = fit[1] / width, 2 * fit[2] / width**2
        yield point, first * rate, second * rate**2 + first * growth


@every_exercise
def test_image_points_are_the_derivatives_of_the_positions(name):
    compared = set()
    for variant in variants(name):
        polygons = {drawn.polygon.kind: drawn.polygon for drawn in variant.polygons()}
        for point, velocity, acceleration in derivatives(name, variant):
            for kind, value in (("velocity", velocity), ("acceleration", acceleration)):
                if kind in polygons and point in polygons[kind].points:
                    compared.add((kind, point))
                    gap = abs(polygons[kind].points[point] - value)
                    assert gap < 1e-4 * polygons[kind].size, (variant, kind, point)
    kinds = {kind for kind, _ in compared}
    stated = {
        d.polygon.kind: {p[0] for p in d.polygon.points if "'" not in p} for d in variants(name)[0].polygons()
    }
    assert kinds == set(stated)
    for kind, letters in stated.items():
        # Every image of a point is compared, but the pole and the end of the Coriolis term.
        assert letters - {"p", "k"} <= {point[0] for which, point in compared if which == kind}


@every_exercise
def test_ruler_and_compasses_find_every_point(name):
    """The construction done again: known vectors laid off, lines drawn by their directions alone and crossed."""
    for drawn in constructions(name):
        polygon = drawn.polygon
        at, lines = {polygon.pole: 0j}, {}
        for stage in polygon.stages:
            for side in stage.sides[-1:] if stage.kind == "crossing" else stage.sides:
                known = [end for end in (side.start, side.end) if end in at]
                if stage.kind == "result":
                    assert len(known) == 2
                    continue
                assert len(known) == 1, f"{side} hangs on nothing that is drawn"
                other = side.end if known == [side.start] else side.start
                if stage.kind == "known":
                    at[other] = at[known[0]] + side.value * (1 if other == side.end else -1)
                    continue
                assert stage.through == known[0]
                lines.setdefault(other, []).append((at[known[0]], side.along))
                if stage.kind == "crossing":
                    (p, u), (q, v) = lines[other]
                    along = ((q - p) * v.conjugate()).imag / (u * v.conjugate()).imag
                    at[other] = p + along * u
        assert all(len(found) == 2 for found in lines.values())
        assert list(at) == list(polygon.points)
        for point, z in polygon.points.items():
            assert abs(at[point] - z) < 1e-6 * polygon.size


@pytest.mark.parametrize("name", [name for name in PLACES if COURSE[name].solution.motion is not None])
def test_ways_round_the_polygon_agree_with_the_points_in_motion(name):
    """Where the solution moves points for animations, the pole sees them move as its polygon says."""
    motion = COURSE[name].solution.motion
    for variant in variants(name)[:5]:
        graph = COURSE[name].solution.graph.with_functions({"motion": motion})
        given = {n: v for n, v in variant.given.items() if n in graph.leaves or n in graph.quantities}
        moving = graph.evaluate(("motion",), given)["motion"]
        for drawn in variant.polygons():
            for point, value in moving.items():
                image = {"A": "a_2"}.get(point, point.lower())
                image = image if image in drawn.polygon.points else point.lower()
                expected = getattr(value, drawn.polygon.kind)
                if image in drawn.polygon.points and expected is not None:
                    assert abs(drawn.polygon.points[image] - expected) < 1e-8 * drawn.polygon.size


@every_exercise
def test_a_drawing_is_at_its_round_scale_in_its_box(name):
    for drawn in constructions(name):
        decade = drawn.scale / 10 ** math.floor(math.log10(drawn.scale) + 1e-9)
        assert min(abs(decade - k) for k in (1, 2, 5)) < 1e-9
        if drawn.polygon.scale is None:
            width, height = drawn.figure.size_mm
            assert width <= BOX_MM[0]
            assert height <= BOX_MM[1]
        else:
            assert drawn.scale == drawn.polygon.scale
            assert max(drawn.figure.size_mm) <= 170


@every_exercise
def test_a_millimetre_of_the_file_is_a_millimetre_on_paper(name):
    drawn = variants(name)[0].polygons()[0]
    root = ET.fromstring(drawn.svg())
    width, height = drawn.figure.size_mm
    assert root.get("width") == f"{width:g}mm"
    assert root.get("viewBox") == f"0 0 {width:g} {height:g}"
    dots = [complex(float(c.get("cx")), -float(c.get("cy"))) for c in root[1] if c.tag.endswith("circle")]
    longest = max(abs(p - q) for p in dots for q in dots)
    points = list(drawn.polygon.points.values())
    expected = max(abs(p - q) for p in points for q in points) / drawn.scale
    assert longest == pytest.approx(expected, abs=0.3)


@every_exercise
def test_no_label_lies_on_a_line_or_on_another(name):
    for drawn in constructions(name):
        for figure in (drawn.figure, drawn.steps[-1].figure.whole):
            assert overlapping(figure) == []
            assert crossed(figure) == []


def white(label, a, b):
    """Least distance from the box of a label to a segment."""
    gap = a + (b - a) * np.linspace(0, 1, 401) - label.center
    across, up = abs(gap.real) - label.width / 2, abs(gap.imag) - label.height / 2
    return np.hypot(across.clip(0), up.clip(0)).min()


def vectors_and_labels(figure):
    """The vectors of a drawing at true scale, and the labels that name one, each with its place among them."""
    at = {k: (one.p, one.p + one.v) for k, one in enumerate(figure.elements) if isinstance(one, vector)}
    placed = zip(figure._layout.labels, figure._layout.named, strict=True)
    return at, [(label, k) for label, k in placed if k in at]


def misread(figure):
    """Labels nearer to another vector than to their own, without a line that leads to it."""
    at, labels = vectors_and_labels(figure)
    whites = {label: {k: white(label, *ends) for k, ends in at.items()} for label, _ in labels}
    return [
        it.label for it, own in labels if not it.leader and min(whites[it].values()) < whites[it][own] - 0.1
    ]


@every_exercise
def test_a_label_without_a_leader_is_nearer_to_its_own_vector_than_to_another(name):
    found = {(drawn.polygon.kind, k): misread(drawn.figure) for k, drawn in enumerate(constructions(name))}
    assert not {which: labels for which, labels in found.items() if labels}


@every_exercise
def test_few_labels_of_vectors_need_a_leader_where_polygons_have_few_vectors(name):
    figures = [drawn.figure for drawn in constructions(name) if len(drawn.polygon.sides) <= 3]
    led = [label.leader is not None for figure in figures for label, _ in vectors_and_labels(figure)[1]]
    assert sum(led) <= 0.2 * len(led)


def test_the_measure_sees_a_label_beside_another_vector():
    figure = constructions("slider_crank")[0].figure
    assert misread(figure) == []
    layout = figure._layout
    (one, _), (other, _) = vectors_and_labels(figure)[1][:2]
    swapped = tuple(
        replace(it, center=other.center, leader=None) if it is one else it for it in layout.labels
    )
    moved = Figure(*figure.elements, scale=1)
    moved.__dict__["_layout"] = replace(layout, labels=swapped)
    assert misread(moved) == [one.label]


def laid(runs):
    """Where runs start when each goes back by what it says, from the start of the first, mm."""
    ends = accumulate(width - back for width, back in runs)
    return [end - width for end, (width, _) in zip(ends, runs, strict=True)]


@every_exercise
def test_labels_stack_index_and_exponent_alike_in_svg_in_outlines_and_in_pdf(name):
    for drawn in variants(name)[0].polygons():
        figure = drawn.figure
        texts = [read(label.label) for label in figure.labels()]
        shown = ET.fromstring(figure.svg()).findall(f".//{SVG}text")
        paths = iter(ET.fromstring(figure.outlined_svg()).findall(f"{SVG}g[2]/{SVG}path[@transform]"))
        for text, element, one in zip(texts, shown, figure.letters(), strict=True):
            index, exponent, _ = kinds(text)
            assert None in (index, exponent) or index == exponent
            widths = [SIZE * run.width for run in text.runs]
            starts = [SIZE * text.start(k) for k in range(len(text.runs))]
            backs = [-float(span.get("dx", 0)) for span in element] or [0]
            assert laid(list(zip(widths, backs, strict=True))) == pytest.approx(starts, abs=0.02)
            backs = [row[4] for row in letters_to_set(one, 0)[2]]
            assert laid(list(zip(widths, backs, strict=True))) == pytest.approx(starts, abs=0.02)
            lefts = []
            for piece in text.runs:
                moves = [next(paths).get("transform") for c in piece.text if not c.isspace()]
                lefts.append(float(re.match(r"translate\((\S+)", moves[0])[1]))
            assert [x - lefts[0] for x in lefts] == pytest.approx(starts, abs=0.02)


@every_exercise
def test_steps_grow_to_the_whole_in_one_frame(name):
    for drawn in variants(name)[0].polygons():
        sizes = {step.figure.size_mm for step in drawn.steps}
        pieces = [
            step.figure.svg().count("<path") + step.figure.svg().count("<circle") for step in drawn.steps
        ]
        assert len(sizes) == 1
        assert pieces == sorted(set(pieces))
        assert drawn.steps[-1].figure.svg() == drawn.steps[-1].figure.whole.svg()
        assert [step.number for step in drawn.steps] == list(range(1, len(pieces) + 1))


@every_exercise
@every_language
def test_a_solution_shows_every_polygon_in_black_and_white_in_every_back_end(name, lang):
    variant = variants(name, lang)[3]
    sheet = variant.answer_sheet()
    page, tex = (
        renderer_of(COURSE.folder).html(sheet),
        renderer_of(COURSE.folder).tex(sheet, "f.pdf", "p.pdf"),
    )
    assert renderer_of(COURSE.folder).pdf(sheet).startswith(b"%PDF")
    assert len(variant.polygons()) > 0
    shown = 0
    for drawn in variant.polygons():
        assert drawn.title in page
        assert drawn.title in tex
        shown += len(drawn.steps) + 1
        for figure in (drawn.figure, *(step.figure for step in drawn.steps)):
            colours = set(re.findall(r"#[0-9a-f]{3,6}", figure.svg()))
            assert colours <= {"#000", "#fff"}
    assert tex.count(r"\includegraphics[page=") == shown
    assert f"page={shown}]{{p.pdf}}" in tex
    handout = variant.handout()
    assert not hasattr(handout, "polygons")
    assert renderer_of(COURSE.folder).polygons_pdf(handout) is None
    assert variant.polygons()[0].opening not in renderer_of(COURSE.folder).html(handout)


def test_the_pages_of_the_drawings_are_of_their_own_size():
    sheet = variants("slotted_mechanism")[0].answer_sheet()
    made = renderer_of(COURSE.folder).polygons_pdf(sheet)
    boxes = re.findall(rb"/MediaBox ?\[0 0 ([\d.]+) ([\d.]+)\]", made)
    sizes = [
        figure.size_mm
        for drawn in sheet.polygons
        for figure in (*(step.figure for step in drawn.steps), drawn.figure)
    ]
    points_a_mm = 72 / 25.4
    assert len(boxes) == len(sizes)
    for (width, height), size in zip(boxes, sizes, strict=True):
        assert float(width) == pytest.approx(size[0] * points_a_mm, abs=0.05)
        assert float(height) == pytest.approx(size[1] * points_a_mm, abs=0.05)


def test_a_build_puts_the_drawings_beside_the_staffs_source_alone(tmp_path, capsys):
    out = tmp_path / "out"
    assert run(["build", "slotted_mechanism", "--formats", "tex", "--lang", "en", "--out", str(out)]) == DONE
    made = [path for path in out.rglob("*") if path.is_file() and not path.name.startswith(".")]
    assert f"{len(made)} files" in capsys.readouterr().out
    assert [path.parts[-3] for path in made if "polygons" in path.name] == ["instructor"]
    assert not [path for path in (out / "handouts").rglob("*.tex") if "[page=" in path.read_text("utf-8")]


def test_a_solution_without_polygons_has_none():
    assert COURSE["grashof"].variant(0).polygons() == ()
    assert renderer_of(COURSE.folder).polygons_pdf(COURSE["grashof"].variant(0).answer_sheet()) is None


def test_a_course_without_solutions_has_no_polygons(small_course):
    for path in (small_course / "solutions").iterdir():
        path.unlink()
    (small_course / "solutions").rmdir()
    with pytest.raises(NoSolution):
        coursework.open_course(small_course)["crank_pin"].variant(1).polygons()


@pytest.mark.parametrize(
    ("returned", "said"),
    [
        (
            '(Polygon("velocity", (Side("p", "a", "V", v, "x", "r"), Side("p", "a", "W", 2 * v))),)',
            "not close",
        ),
        ('Polygon("velocity", (Side("p", "a", "V", v, "x", "r"),))', "a tuple of Polygon"),
        ("(v,)", "a tuple of Polygon"),
    ],
)
def test_polygons_that_are_none_are_told_with_their_file(small_course, returned, said):
    solution = small_course / "solutions" / "crank_pin.py"
    stated = (
        f"\n\nfrom coursework.polygons import Polygon, Side\n\n\ndef polygons(v):\n    return {returned}\n"
    )
    solution.write_text(solution.read_text("utf-8") + stated, "utf-8")
    with pytest.raises(BadCourse, match=rf"solutions/crank_pin\.py: .*{said}"):
        coursework.open_course(small_course)["crank_pin"].variant(1).answer_sheet()


def test_the_slider_crank_is_drawn_at_the_scales_of_its_statement_and_read_as_it_is_marked():
    for variant in variants("slider_crank"):
        answers = variant.solution()
        velocity, acceleration = variant.polygons()
        assert (velocity.scale, acceleration.scale) == (variant.given["kv"], variant.given["ka"])
        for drawn, start, end, quantity in (
            (velocity, "p_v", "a", "pv_a"),
            (velocity, "p_v", "b", "pv_b"),
            (velocity, "a", "b", "ab"),
            (acceleration, "p_a", "a", "pa_a"),
            (acceleration, "a", "b'", "ab_n"),
            (acceleration, "b'", "b", "bb_t"),
            (acceleration, "p_a", "b", "pa_b"),
        ):
            length = abs(drawn.polygon.side(start, end).value) / drawn.scale
            assert length == pytest.approx(answers[quantity], rel=1e-9)


def test_the_drawing_of_the_courses_slotted_mechanism_reads_as_computed_by_hand():
    """The course's lengths and a crank at 135 degrees: the crank pin at 80.8 left and 309.4 above O_4."""
    variant = COURSE["slotted_mechanism"].variant(0)
    record = {**variant.record, "given": {n: dict(v) for n, v in variant.record["given"].items()}}
    for name, value in {
        "r1": 228.6,
        "r2": 114.3,
        "theta1": 90,
        "theta2": 135,
        "omega2": 1,
        "alpha2": 0,
    }.items():
        record["given"][name]["value"] = value
    velocity, acceleration = COURSE["slotted_mechanism"].from_record(record).polygons()
    along = complex(-80.8223, 309.4223) / 319.804
    v_A = 1j * 114.3 * cmath.exp(1j * math.radians(135))
    sliding, across = (v_A / along).real, (v_A / along).imag
    assert velocity.polygon.side("a_4", "a_2").value == pytest.approx(sliding * along, rel=1e-4)
    assert velocity.polygon.points["a_4"] == pytest.approx(1j * across * along, rel=1e-4)
    coriolis = acceleration.polygon.side("k", "a_2").value
    assert coriolis == pytest.approx(2j * across / 319.804 * sliding * along, rel=1e-4)
    assert acceleration.polygon.points["a_2"] == pytest.approx(1j * v_A, rel=1e-9)


# ------------------------------------------------------------------------------- the data

TRIANGLE = (
    Side("p_v", "a", "V_A", 3, r"\parallel Ox", "3"),
    Side("a", "b", "V_{B/A}", 4j, r"\parallel Oy"),
    Side("p_v", "b", "V_B", 3 + 4j, r"\perp CB"),
)


def test_a_polygon_tells_its_points_what_they_hang_on_and_its_equation():
    polygon = Polygon("velocity", TRIANGLE)
    assert dict(polygon.points) == {"p_v": 0, "a": 3, "b": 3 + 4j}
    assert polygon.hangs == {"a": TRIANGLE[:1], "b": TRIANGLE[1:]}
    assert [stage.kind for stage in polygon.stages] == ["known", "line", "crossing"]
    assert polygon.equations == ("V_B = V_A + V_{B/A}",)
    assert (polygon.pole, polygon.unit, polygon.size) == ("p_v", "mm/s", 5)
    with pytest.raises(UnknownName, match="p_v b"):
        polygon.side("p_v", "c")


def test_a_side_laid_off_backwards_stands_on_the_other_side_of_the_equation():
    """a_A = a_G + a_s + a_c, whose last vector ends at the known point."""
    polygon = Polygon(
        "acceleration",
        (
            Side("p", "a", "A", 5, "x", "5"),
            Side("k", "a", "C", 1j, "y", "1"),
            Side("p", "g", "G", -1j, "y"),
            Side("g", "k", "S", 5, "x"),
        ),
    )
    assert dict(polygon.points) == {"p": 0, "a": 5, "k": 5 - 1j, "g": -1j}
    assert polygon.equations == ("A = G + C + S",)


def test_a_line_of_a_vector_that_vanishes_is_drawn_by_its_way():
    sides = (TRIANGLE[0], Side("a", "b", "V_{B/A}", 0, r"\perp AB", way=2j), Side("p_v", "b", "V_B", 3, "x"))
    drawn = Construction(Polygon("velocity", sides), "en")
    assert drawn.polygon.points["b"] == 3
    assert "a, b" in [box.label.replace(r",\ ", ", ") for box in drawn.figure.labels()]
    assert [row.paper for row in drawn.rows][1] == "0.0"


def test_a_length_on_paper_does_not_hang_on_a_last_bit():
    """46.75 mm, halfway between two tenths, as one processor or another comes by it."""
    printed = []
    for bits in range(-9, 10):
        length = 2 * 46.75 * (1 + bits * 2.0**-52)
        sides = (Side("p_v", "a", "V_A", length, "x", "1"), Side("p_v", "b", "V_B", 100j, "y", "1"))
        drawn = Construction(Polygon("velocity", sides), "en")
        assert drawn.scale == 2
        printed.append([row.paper for row in drawn.rows])
    assert printed == [["46.8", "50.0"]] * 19


@pytest.mark.parametrize(
    ("sides", "said"),
    [
        ((), "at least one side"),
        (TRIANGLE[:2], "b lies on one line only"),
        ((TRIANGLE[0], Side("c", "d", "V", 1, "x", "1")), "neither of its ends"),
        ((TRIANGLE[0], Side("p_v", "a", "V", 3, "x", "3")), "both its ends"),
        ((*TRIANGLE[:2], Side("p_v", "b", "V_B", 3 + 5j, "x")), "does not close"),
        ((*TRIANGLE[:2], Side("p_v", "b", "V_B", 3 + 4j, "x", way=1)), "does not close"),
        ((*TRIANGLE, Side("a", "c", "V_C", 1)), "c is not found"),
        ((*TRIANGLE, Side("a", "b", "V", 5j)), "does not close"),
    ],
)
def test_a_polygon_that_cannot_be_drawn_is_refused(sides, said):
    with pytest.raises(BadCourse, match=said):
        Polygon("velocity", sides)


@pytest.mark.parametrize(
    ("side", "said"),
    [
        ({"value": 1, "length": "r"}, "state it"),
        ({"value": math.nan, "direction": "x"}, "not finite"),
        ({"value": 0, "direction": "x"}, "state way"),
    ],
)
def test_a_side_that_says_too_little_is_refused(side, said):
    with pytest.raises(BadCourse, match=said):
        Side("p", "a", "V", **side)


def test_an_unknown_kind_or_language_is_told():
    with pytest.raises(UnknownName, match="velocity"):
        Polygon("speed", TRIANGLE)
    with pytest.raises(UnknownName, match="fr"):
        Construction(Polygon("velocity", TRIANGLE), "xx")


@pytest.mark.parametrize(
    ("length", "scale"), [(90.0, 1), (90.1, 2), (450, 5), (451, 10), (0.9, 0.01), (123456, 2000)]
)
def test_a_scale_is_the_least_round_one_that_fits(length, scale):
    polygon = Polygon("velocity", (Side("p", "a", "V", length, "x", "v"),))
    assert polygon.scale_in(90, 70) == pytest.approx(scale, rel=1e-12)
    upright = Polygon("velocity", (Side("p", "a", "V", 1j * length, "y", "v"),))
    assert upright.scale_in(1e9, 90) == pytest.approx(scale, rel=1e-12)


def test_what_does_not_move_has_no_scale_and_no_drawing():
    with pytest.raises(BadCourse, match="nothing moves"):
        Polygon("velocity", (Side("p", "a", "V", 0, "x", "v"),)).scale_in(90, 70)
    variant = COURSE["slider_crank"].variant(0)
    record = {**variant.record, "given": {n: dict(v) for n, v in variant.record["given"].items()}}
    record["given"]["omega2"]["value"], record["given"]["alpha2"]["value"] = 0, 8
    (only,) = COURSE["slider_crank"].from_record(record).polygons()
    assert only.polygon.kind == "acceleration"


def test_the_sides_of_a_turning_bar_are_the_derivatives_of_its_vector():
    bar, omega, alpha, h = 3 + 4j, 2.0, -5.0, 1e-4

    def at(t):
        return bar * cmath.exp(1j * (omega * t + alpha * t**2 / 2))

    velocity = (at(h) - at(-h)) / (2 * h)
    acceleration = (at(h) - 2 * at(0) + at(-h)) / h**2
    assert turning("a", "b", "B/A", "AB", bar, omega).value == pytest.approx(velocity, rel=1e-6)
    n = normal("a", "b'", "B/A", "AB", bar, omega, "v")
    t = tangential("b'", "b", "B/A", "AB", bar, alpha)
    assert n.value + t.value == pytest.approx(acceleration, rel=1e-5)
    assert (n.value / bar).imag == pytest.approx(0)
    assert (t.value / bar).real == pytest.approx(0)


def test_a_notebook_shows_a_polygon_with_its_steps_and_its_table():
    drawn = COURSE["slider_crank"].variant(1, "en").polygons()[0]
    page = drawn._repr_html_()
    assert page.count("<img ") == len(drawn.steps) + 1
    assert "Velocity polygon" in page
    assert "<script" not in page
    assert drawn._repr_svg_().startswith("<svg")
    assert repr(drawn) == f"<velocity polygon, {drawn.scale:g} mm/s for 1 mm>"


@every_language
def test_numbers_and_words_are_the_languages_own(lang):
    drawn = COURSE["slider_crank"].variant(1, lang).polygons()[0]
    mark = {"fr": ",", "en": "."}[lang]
    assert all(mark in row.paper for row in drawn.rows)
    texts = [step.text for step in drawn.steps]
    assert len(set(texts)) == len(texts)
    assert all("{" not in re.sub(r"\$[^$]*\$", "", text) for text in texts)
