"""Where polygons are shown: solutions, builds, notebooks; and where there are none."""

from __future__ import annotations

import cmath
import math
import re

import pytest
from courses_polygons import COURSE, PLACES, every_language, variants
from sweeps import sampled

import coursework
from coursework.cli import run
from coursework.cli.options import DONE
from coursework.errors import BadCourse
from coursework.rendering.renderer import renderer_of


@pytest.mark.parametrize(
    "name", sampled(PLACES, ["slotted_mechanism", "four_bar_motion", "three_loop_shaper"])
)
@every_language
def test_a_solution_shows_every_polygon_in_black_and_white_in_every_back_end(name, lang):
    variant = variants(name, lang)[3]
    sheet = variant.answer_sheet()
    page, tex = (
        renderer_of(COURSE.folder).html(sheet),
        renderer_of(COURSE.folder).tex(sheet, ["f.pdf"], ["p.pdf"]),
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


@pytest.mark.parametrize(
    ("parts", "kinds"),
    [(("theta3",), []), (("theta3", "omega3"), ["velocity"]), (("alpha3",), ["velocity", "acceleration"])],
)
def test_a_solution_shows_the_polygons_that_its_questions_need(parts, kinds):
    sheet = COURSE["slider_crank"].variant(3, "en", parts).answer_sheet()
    assert [drawn.polygon.kind for drawn in sheet.polygons] == kinds


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
        "\n\nfrom coursework.figures.polygons import Polygon, Side\n\n\ndef polygons(v):\n    return "
        f"{returned}\n"
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
