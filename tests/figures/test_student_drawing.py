"""A student's drawing is read as it is stored, and whatever else a browser sends is refused."""

import json
import re
import time

import pytest

from coursework.errors import BadInput
from coursework.figures.student_drawing import MOST_CHARACTERS, StudentDrawing

POINT = {"k": "point", "id": 1, "x": 12.3, "y": 45.6, "n": "p"}
ITEMS = [
    POINT,
    {"k": "line", "id": 2, "x": 12.3, "y": 45.6, "a": 127.4},
    {"k": "circle", "id": 3, "x": 12.3, "y": 45.6, "r": 60},
    {"k": "vector", "id": 4, "from": 1, "to": 5, "n": "v10"},
    {"k": "point", "id": 5, "x": 40, "y": 60},
]
GRAPH = [
    *({"k": "body", "id": k, "x": 20 * k, "y": 10 * k * k, "n": str(k)} for k in (1, 2, 3)),
    {"k": "joint", "id": 4, "of": [1, 2], "t": "revolute"},
    {"k": "joint", "id": 5, "of": [1, 2, 3], "t": ""},
]


def stored(*items, **more):
    return json.dumps(
        {"v": 1, "items": items, "scale": 5, "view": [0, 0, 170], **more}, separators=(",", ":")
    )


def test_a_drawing_is_read_as_it_is_stored():
    drawing = StudentDrawing.parse(stored(*ITEMS))
    assert drawing.points == {"p": 12.3 + 45.6j}
    assert drawing.arrows == {"v10": (12.3 + 45.6j, 40 + 60j)}
    assert (drawing.items[3].size, drawing.scale) == (60, 5)
    assert StudentDrawing.parse("").items == {}
    assert StudentDrawing.parse(stored(*GRAPH)).items[4].ends == (1, 2)


def test_a_drawing_is_shown_to_true_size():
    figure = StudentDrawing.parse(stored(*ITEMS)).figure({"p": "p_v"})
    assert figure.scale == 1
    assert "p_v" in [box.label for box in figure.labels()]
    assert StudentDrawing.parse(stored(*GRAPH)).svg().startswith("<svg")
    assert StudentDrawing.parse(stored(POINT)).svg() == ""


@pytest.mark.parametrize(
    "text",
    [
        "[" * 15_000,
        "{",
        "null",
        '"x"',
        "[]",
        '{"v": 2, "items": []}',
        '{"v": 1, "items": {}}',
        stored(*({**POINT, "id": 1 + k} for k in range(501)))[:MOST_CHARACTERS],
        json.dumps({"v": 1, "items": [0] * 100_000}),
        json.dumps({"v": 1, "items": [0] * 6000}),
        stored(POINT, POINT),
        stored({**POINT, "n": "<script>alert(1)</script>"}),
        stored({**POINT, "n": "p" * 61}),
        stored({**POINT, "n": 7}),
        stored({**POINT, "x": float("nan")}),
        stored({**POINT, "x": float("inf")}),
        stored({**POINT, "x": 1e308}),
        stored({**POINT, "x": "12"}),
        stored({**POINT, "x": True}),
        stored({**POINT, "x": [1]}),
        '{"v": 1, "items": [{"k": "point", "id": 1, "y": 2}]}',
        '{"v": 1, "items": [{"k": "point", "id": 1, "x": ' + "9" * 400 + ', "y": 2}]}',
        stored({**POINT, "id": -1}),
        stored({**POINT, "id": 1.5}),
        stored({**POINT, "id": True}),
        stored({**POINT, "k": "script"}),
        stored({**POINT, "k": ["point"]}),
        stored("point"),
        stored({"k": "circle", "id": 1, "x": 0, "y": 0, "r": 0}),
        stored({"k": "circle", "id": 1, "x": 0, "y": 0, "r": -4}),
        stored({"k": "vector", "id": 1, "from": 1, "to": 1}),
        stored(POINT, {"k": "vector", "id": 2, "from": 1, "to": 9}),
        stored(POINT, {"k": "vector", "id": 2, "from": 1, "to": [1]}),
        stored({"k": "joint", "id": 1, "of": "ab"}),
        stored(*GRAPH, {"k": "joint", "id": 9, "of": [1], "t": "revolute"}),
        stored(*GRAPH, {"k": "joint", "id": 9, "of": [1, 4], "t": "revolute"}),
        stored(*GRAPH, {"k": "joint", "id": 9, "of": [1, 2], "t": "<b>"}),
        stored(POINT, scale="5"),
        stored(POINT, scale=float("nan")),
    ],
)
def test_what_is_no_drawing_is_refused_at_once(text):
    begun = time.process_time()
    with pytest.raises(BadInput):
        StudentDrawing.parse(text)
    assert time.process_time() - begun < 1


def test_the_largest_drawing_is_read_and_shown_soon():
    items = [{"k": "line", "id": k, "x": k, "y": 1, "a": k} for k in range(1, 400)]
    begun = time.process_time()
    svg = StudentDrawing.parse(stored(*items)).svg()
    assert not re.search("<script|onload", svg)
    assert time.process_time() - begun < 5


def test_coincident_points_make_no_fault():
    same = [{"k": "point", "id": k, "x": 1, "y": 1} for k in (1, 2)]
    assert StudentDrawing.parse(stored(*same, {"k": "vector", "id": 3, "from": 1, "to": 2})).svg() == ""
