"""Boxes of components: they make the text that the marker reads, the units stand as the question asks."""

import numpy as np
import pytest
from course_of_every_kind import Asking, write_course
from sweeps import whole_course
from tables import each_row

import coursework
from coursework.kinds.kind import kind_of
from coursework.language.numbers import unit_text
from coursework.sheets.cells import answer_in, cell_names, cells_of, filled_cells, form_of, in_cells

COURSE = coursework.open_course()


def parts_with_cells(course, names, seed=3, lang="fr"):
    for name in names:
        variant = course[name].variant(seed, lang)
        yield from ((name, variant, part) for part in variant.parts if form_of(variant, part))


def read_components(variant, part, texts):
    form = form_of(variant, part)
    text = answer_in({name: [one] for name, one in zip(cell_names("b", form), texts, strict=True)}, "b", form)
    assert in_cells(text, form) == tuple(texts)
    reading = part.sort.read(text, part, variant)
    assert reading.status == "read", text
    return [np.asarray(value, dtype=float).ravel().tolist() for value in reading.values]


@whole_course
def test_components_with_decimal_commas_are_read_in_the_order_of_their_boxes():
    wrong = []
    for name, variant, part in parts_with_cells(COURSE, COURSE.names):
        count = form_of(variant, part).count("{}")
        values = [index + 1.5 for index in range(count)]
        found = read_components(variant, part, [str(value).replace(".", ",") for value in values])
        if found != [values]:
            wrong.append((name, part.id, found))
    assert not wrong


def test_a_matrix_has_a_group_for_each_row_and_a_spatial_torsor_one_for_each_column(tmp_path):
    coil = coursework.open_course(write_course(tmp_path))["coil"].variant(1)
    found = {part.id: [len(group) for group in cells_of(coil, part)] for part in coil.parts}
    assert {name: sizes for name, sizes in found.items() if sizes} == {"drops": [3], "M": [2, 2]}
    matrix = next(part for part in coil.parts if part.id == "M")
    assert read_components(coil, matrix, ["1,5", "2 ohm", "-3", "2*2"]) == [[1.5, 2, -3, 4]]
    twist = COURSE["joint_twist"].variant(1).parts
    groups = [cells_of(COURSE["joint_twist"].variant(1), part) for part in twist if part.kind == "twist"]
    assert [[{cell.unit for cell in group} for group in one] for one in groups] == [
        [{"rad/s"}, {"mm/s"}],
        [{"rad/s"}, {"mm/s"}],
        [{"rad/s", "mm/s"}],
    ]


@pytest.mark.parametrize("lang", ["en", "fr"])
@whole_course
def test_the_units_beside_a_box_stand_in_the_order_in_which_its_question_names_them(lang):
    wrong = []
    for name in COURSE.names:
        variant = COURSE[name].variant(3, lang)
        for question, part in zip(variant.handout().questions, variant.parts, strict=True):
            units = [unit_text(unit, lang) for unit in part.sort.units(part.unit)]
            asked = [unit for unit in sorted(units, key=question.prompt.find) if unit in question.prompt]
            shown = [unit for unit in sorted(units, key=question.unit.find) if unit in asked]
            if len(units) > 1 and shown != asked:
                wrong.append((name, part.id, asked, shown))
            cells = list(dict.fromkeys(cell.unit for group in question.cells for cell in group))
            if len(units) > 1 and cells != sorted(cells, key=question.unit.find):
                wrong.append((name, part.id, "cells", cells))
    assert not wrong


@each_row(
    ("texts", "answer"),
    [
        ({"b": ["(4; 5)"], "b-1": ["1"], "b-2": ["2"]}, "(4; 5)"),  # the line wins where it is filled
        ({"b": [""], "b-1": ["1"], "b-2": [" -2  mm "]}, "(1 ; -2 mm)"),
        ({"b-1": ["(1; 2)"], "b-2": [""]}, "(1; 2)"),  # a whole line in the first box
        ({"b-1": ["1 2"]}, "1 2"),
        ({"b-1": [""], "b-2": ["2"]}, "( ; 2)"),
        ({"b": [" "], "b-1": [" "]}, " "),
        ({}, ""),
    ],
)
def test_the_line_wins_and_else_its_components_are_joined(texts, answer):
    assert answer_in(texts, "b", "({} ; {})") == answer


def test_a_text_of_components_fills_their_boxes_and_another_stays_in_the_line():
    forms = {"b": "({} ; {})", "c": "", "d": "({} ; {})"}
    assert filled_cells({"b": "(1 ;  ; 2)", "c": "(1 ; 2)", "d": "(1; -2)"}, forms) == {
        "b": "(1 ;  ; 2)",
        "c": "(1 ; 2)",
        "d-1": "1",
        "d-2": "-2",
    }


@each_row("text", ["1,5; 2,5; 3,5", "(1,5 ; 2,5 ; 3,5)", "vx = 1,5; vy = 2,5; wz = 3,5", "1.5, 2.5, 3.5"])
def test_three_numbers_with_decimal_commas_are_a_plane_twist(text):
    part = coursework.model.Part("x", unit="mm/s", kind="twist", id="x")
    assert kind_of("twist").read(text, part, Asking(np.ones(3))).values[0].tolist() == [1.5, 2.5, 3.5]
