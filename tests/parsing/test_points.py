"""Points and directions are read however they are written."""

import pytest
from strategies import NARROW, NBSP
from tables import each_row

import coursework
from coursework.parsing.points import read_point


@each_row(
    ("text", "values"),
    [
        *[
            (s, ((12.3, 4.5),))
            for s in (
                "(12,3 ; 4,5) mm",
                "12.3, 4.5",
                "12,3 ; 4,5",
                "12,3;4,5 mm",
                "(12.3, 4.5)",
                "[12.3 4.5]",
                "12,3 4,5",
                "12,3, 4,5",
                "12,3,4,5",
                "12.3,4.5",
                "12,3 mm ; 4,5 mm",
                "1.23 cm, 0.45 cm",
                "(1,23 ; 0,45) cm",
                "A = (12.3 ; 4.5)",
                "A(12,3 ; 4,5)",
                "x = 12.3 ; y = 4.5",
                "x=12,3 mm; y=4,5 mm",
                "{12.3 ; 4.5}",
                "12,3 mm ; 0,45 cm",
                "1.23, 0.45 cm",
                f"(12,3{NBSP};{NBSP}4,5){NARROW}mm",
                "24.6/2 ; 4.5",
                "(12.3 | 4.5)",
                [12.3, 4.5],
                ["12,3", "4,5"],
                (12.3, "4.5 mm"),
            )
        ],
        ("1,5", ((1, 5),)),
        ("1,234 ; 5", ((1.234, 5), (1234, 5))),
        ("1 234,5 ; −2", ((1234.5, -2),)),
    ],
)
def test_a_point_is_read_however_it_is_written(text, values):
    reading = read_point(text, "mm", 2)
    assert reading.status == "read", reading
    assert reading.values == tuple(pytest.approx(v) for v in values)


@each_row("text", ["[1, 0, 1]", "1;0;1", "(1 0 1)", "1,0,1", "(1 ; 0 ; 1)", "1, 0, 1", "1,0 ; 0 ; 2/2"])
def test_a_direction_of_three_coordinates_is_read(text):
    assert read_point(text, "1", 3).values == ((1, 0, 1),)


@each_row(
    ("text", "value"),
    [
        *[
            (s, (0, 1, 0))
            for s in (
                "y",
                "Y",
                "\\vec y",
                "\\vec{y}",
                "$\\vec{y}$",
                "y\u20d7",
                "vec y",
                "axe y",
                "l'axe y",
                "y axis",
                "y-axis",
            )
        ],
        *[(s, (0, 0, -1)) for s in ("-z", "−z", "-\\vec z", "- \\overrightarrow{z}")],
        ("x", (1, 0, 0)),
    ],
)
def test_an_axis_is_a_direction(text, value):
    reading = read_point(text, "1", 3)
    assert (reading.values, reading.read_as) == ((value,), (f"({value[0]:g}; {value[1]:g}; {value[2]:g})",))


@each_row(
    ("text", "value"),
    [
        ("x_a + z", (1, 0, 1)),
        ("\\vec{x}_a + 1,36\\,\\vec{z}", (1, 0, 1.36)),
        ("ω(x\u20d7_a + z\u20d7)", (1, 0, 1)),
        ("(3x - 4y)/5", (0.6, -0.8, 0)),
        ("2y", (0, 2, 0)),
        ("(1, 0, 1)_a", (1, 0, 1)),
        ("(1 ; 0 ; 1)_{a}", (1, 0, 1)),
    ],
)
def test_a_sum_of_vectors_of_the_base_is_a_direction(text, value):
    assert read_point(text, "1", 3).values == (pytest.approx(value),)


def test_a_point_may_name_its_base_but_is_no_sum_of_vectors():
    assert read_point("(7 cm; 0; 0)_a", "mm", 3).values == ((70, 0, 0),)
    assert read_point("70 x_a", "mm", 3).status == "unreadable"


@each_row(
    "text",
    [
        "w",
        "xy",
        "x, y",
        "5",
        "y2",
        "axe",
        "\\vec",
        "--y",
        "x + 1",
        "x^2",
        "x*z",
        "1/x",
        "x_0 + z_0",
        "Ax + z",
    ],
)
def test_what_is_no_axis_is_no_direction(text):
    assert read_point(text, "1", 3).status == "unreadable"


def test_an_axis_is_no_point_and_none_of_the_plane_has_a_third():
    assert read_point("y", "mm", 3).status == read_point("z", "1", 2).status == "unreadable"


@each_row(
    ("text", "status", "code"),
    [
        ("1,2,3", "unreadable", "wrong_count"),
        ("5", "unreadable", "wrong_count"),
        (5, "unreadable", "wrong_count"),
        ([1, 2, 3], "unreadable", "wrong_count"),
        ("(1 ; 2) kg", "wrong_unit", "other_dimension"),
        ("(1 ; 2 kg)", "wrong_unit", "other_dimension"),
        ("(1 ; 2) frogs", "unreadable", "unknown_unit"),
        ("1 ; nan", "unreadable", "not_finite"),
        ([1, None], "unreadable", "unknown_symbol"),
        (True, "unreadable", "not_a_number"),
    ],
)
def test_what_is_no_point_says_why(text, status, code):
    reading = read_point(text, "mm", 2)
    assert (reading.status, reading.code) == (status, code)


def test_a_point_says_whether_a_unit_is_written():
    assert read_point("(12,3 ; 4,5) mm", "mm", 2).unit_given
    assert read_point("12,3 ; 4,5 mm", "mm", 2).unit_given
    assert not read_point("1.2e1 ; 4.5", "mm", 2).unit_given
    assert read_point("(12,3 ; 4,5) mm", "mm", 2).read_as == ("(12.3; 4.5) mm",)


@each_row(
    ("text", "verdict"),
    [
        *[
            (s, "correct")
            for s in (
                "(R+2r, 0, 0)",
                "R + 2*r ; 0 ; 0",
                "[R+2r 0 0]",
                "P(R+2r, 0, 0)_a",
                "(R+2r, 0, 0) mm",
                "(R+2r) x_a",
                "O_1P = (R+2r) \\vec{x}_a",
                "(R+r) x_a - r z",
                ["R+2r", 0, "0"],
                "(R+10, 0, 0)",
            )
        ],
        ("(R, 0, 0)", "wrong"),
        ("(R+2r, 0)", "unreadable"),
        ("(q, 0, 0)", "unreadable"),
        ("(R/0, 0, 0)", "unreadable"),
    ],
)
def test_a_vector_of_formulas_is_worked_out(text, verdict):
    variant = coursework.open_course()["ball_reducer"].variant(0, lang="en")
    assert variant.given["r"] == 5  # mm, for R + 10
    assert variant.grade({"axis_30_point": text})["axis_30_point"].verdict == verdict
