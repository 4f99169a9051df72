"""Answer pages are laid out so that everything asked has its place, whatever the answers are."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from course_of_every_kind import Asking, write_course
from tables import each_row

import coursework
from coursework.course.builtin import builtin_root
from coursework.errors import BadCourse, UnknownName
from coursework.kinds.kind import kind_of
from coursework.sheets.answer_pages import (
    FRAME,
    MARK,
    SIZES,
    AnswerPage,
    Box,
    answer_pages,
    code_text,
    paper_code,
)

COURSE = coursework.open_course(builtin_root())
every_exercise = pytest.mark.parametrize("name", COURSE.names)
every_size = pytest.mark.parametrize("size", SIZES)


def laid_out(name, seed=0, size="a4", lang="en"):
    return answer_pages([COURSE[name].variant(seed, lang, parts=["all"])], lang, size, "A" * 13)


def inked(page: AnswerPage):
    """Everything that is printed or written on a page, by what it is."""
    half = MARK / 2
    for x, y in page.marks:
        yield "mark", Box(x - half, y - half, MARK, MARK)
    yield "code", page.code
    yield "title", page.title
    yield "name", page.name
    for one in (page.rules, page.captions):
        if one:
            yield "words", one
    for box in page.guide:
        yield "guide", box
    for head in page.heads:
        yield "head", head.box
    for field in page.fields:
        yield f"{field.part} {field.coordinate}", field.whole


def small(field):
    """The boxes of a field that are filled in."""
    own = [*field.digits, *field.decimals, *field.power, *(box for _, box in field.ticks)]
    own += [box for box in (field.sign, field.power_sign, field.unit) if box]
    return own + ([field.free] if field.free and field.free != field.whole else [])


def overlap(one: Box, other: Box, slack=1e-6):
    return (
        one.x < other.right - slack
        and other.x < one.right - slack
        and one.y < other.bottom - slack
        and other.y < one.bottom - slack
    )


def inside(one: Box, other: Box):
    return one.x >= other.x and one.y >= other.y and one.right <= other.right and one.bottom <= other.bottom


@every_exercise
@every_size
def test_nothing_overlaps_and_all_is_in_the_printable_frame(name, size):
    for page in laid_out(name, size=size):
        frame = Box(FRAME, FRAME, page.width - 2 * FRAME, page.height - 2 * FRAME)
        for (what, one), (also, other) in combinations(inked(page), 2):
            assert not overlap(one, other), (page.number, what, also)
        assert all(inside(box, frame) for _, box in inked(page))
        for field in page.fields:
            assert all(inside(box, field.whole) for box in small(field))
            assert not any(overlap(a, b) for a, b in combinations(small(field), 2))


@every_exercise
def test_every_part_has_its_fields_in_order(name):
    variant = COURSE[name].variant(0, parts=["all"])
    fields = [field for page in answer_pages([variant]) for field in page.fields]
    asked = [field for field in fields if field.part]
    assert tuple(dict.fromkeys(field.part for field in asked)) == variant.part_ids
    assert len(fields) - len(asked) == (variant.exercise.spec.drawing_mm is not None)
    for part in variant.parts:
        own = [field for field in asked if field.part == part.id]
        assert [field.coordinate for field in own] == list(range(own[0].coordinates))
        assert {field.what for field in own} == {part.sort.field}
        if part.sort.field == "number":
            assert len(own) == np.size(variant.reference(part.quantity))
        if part.choices:
            assert [case for case, _ in own[0].ticks][: len(part.choices)] == list(variant.cases(part))


def geometry(pages):
    """The pages without what tells whose they are and in which language, and in which order a variant offers
    its cases."""
    return [
        replace(
            page,
            code_text="",
            fields=tuple(
                replace(
                    field, seed=0, unit_text="", symbol="", ticks=tuple(("", box) for _, box in field.ticks)
                )
                for field in page.fields
            ),
        )
        for page in pages
    ]


def asked_alike(name):
    """Two seeds whose variants ask the same parts, and have other answers."""
    first = COURSE[name].variant(0)
    return 0, next(s for s in range(1, 200) if COURSE[name].variant(s).part_ids == first.part_ids)


# Each variant of the vocabulary asks other parts.
@pytest.mark.parametrize("name", [name for name in COURSE.names if name != "vocabulary"])
def test_the_layout_hangs_neither_on_the_answers_nor_on_the_language(name):
    one, other = (answer_pages([COURSE[name].variant(seed)], "en") for seed in asked_alike(name))
    assert geometry(one) == geometry(other)
    assert geometry(one) == geometry(answer_pages([COURSE[name].variant(0, "fr")], "fr"))


def test_numbers_have_the_same_boxes_whatever_they_are():
    rows = [f for name in COURSE.names for page in laid_out(name) for f in page.fields if f.what == "number"]
    whole = {(f.sign.x, len(f.digits), len(f.decimals), len(f.power)) for f in rows if f.decimals}
    counts = {(f.sign.x, len(f.digits), len(f.decimals), len(f.power)) for f in rows if not f.decimals}
    assert len(whole) == 1
    assert len(counts) == 1
    assert {f.part for f in rows if not f.decimals} == {
        p.id for n in COURSE.names for p in COURSE[n].spec.parts if p.kind == "integer"
    }


def written(value):
    return f"{value:.4f}" if abs(value) < 99_999 else f"{value:.5e}"


def as_found(part, reference):
    """What a page that is filled in rightly says of a part: the number of each row, the ticked cases, the
    words."""
    if part.sort.field == "number":
        return [written(value) for value in np.ravel(reference).tolist()]
    if hasattr(part.sort, "components"):
        return [n for n in part.sort.form.names if n in part.sort.components(reference)] or ["0"]
    return [str(reference)]


@every_exercise
@pytest.mark.parametrize("unit", [False, True])
def test_what_a_page_says_rightly_is_marked_as_right(name, unit):
    variant = COURSE[name].variant(3, "fr")
    said = {
        p.id: p.sort.from_paper(as_found(p, variant.reference(p.quantity)), p, variant, unit=unit)
        for p in variant.parts
    }
    marking = variant.grade(said)
    assert {marking[part].verdict for part in variant.part_ids} == {"correct"}


@each_row(
    ("kind", "reference", "found", "unit", "answer"),
    [
        ("number", 3.5, ["3.5"], "mm", "3.5 mm"),
        ("complex", 3 - 4j, ["3", "-4"], "ohm", "(3 - 4i) ohm"),
        ("vector", np.array([1.0, -2, 3]), ["1", "-2", "3"], "V", "(1 ; -2 ; 3) V"),
        ("matrix", np.array([[1.5, -2], [3, 4]]), ["1.5", "-2", "3", "4"], "mm", "[[1.5 ; -2]; [3 ; 4]] mm"),
        (
            "twist",
            np.array([1.0, 0, -2]),
            ["1", "0", "-2"],
            "mm/s",
            "vx = 1 mm/s; vy = 0 mm/s; wz = -2 rad/s",
        ),
    ],
)
def test_coordinates_are_joined_as_their_kind_reads_them(kind, reference, found, unit, answer):
    sort = kind_of(kind)
    part = coursework.model.Part("x", unit=unit, kind=kind, id="x")

    asking = Asking(reference)
    said = sort.from_paper(found, part, asking, unit=True)
    assert said == answer
    reading = sort.read(said, part, asking)
    assert reading.status == "read"
    assert np.allclose(reading.values[0], reference)
    assert sort.read(sort.from_paper(found, part, asking), part, asking).status == "read"


def test_every_newer_kind_has_its_place(tmp_path):
    coil = coursework.open_course(write_course(tmp_path))["coil"].variant(1)
    fields = {f.part: f for page in answer_pages([coil]) for f in page.fields if not f.coordinate}
    assert {part: (f.what, f.coordinates) for part, f in fields.items()} == {
        "Z": ("number", 2),
        "I": ("number", 2),
        "drops": ("number", 3),
        "M": ("number", 4),
        "true_of_it": ("ticks", 1),
        "why": ("written", 1),
        "sketch": ("drawing", 1),
    }
    ticks = fields["true_of_it"]
    assert ticks.several
    assert len(ticks.ticks) == 5
    assert ticks.ticks[-1][0] == "none"
    assert (fields["sketch"].whole.width, fields["sketch"].whole.height) == (80, 60)


def test_a_paper_of_several_exercises_numbers_them_and_keeps_a_heading_with_its_first_row():
    names = ("grashof", "vocabulary", "two_circles", "quick_return")
    pages = answer_pages([COURSE[n].variant(1) for n in names])
    assert [head.place for page in pages for head in page.heads] == [0, 1, 2, 3]
    assert pages[0].fields[0].number == "1.1"
    for page in pages:
        for head in page.heads:
            below = [field for field in page.fields if field.place == head.place]
            assert below
            assert min(field.whole.y for field in below) < head.box.bottom + 12
    assert [field.place for page in pages for field in page.fields] == sorted(
        field.place for page in pages for field in page.fields
    )


def test_rows_follow_one_another_down_the_page():
    for page in laid_out("ball_reducer"):
        assert all(a.whole.bottom <= b.whole.y for a, b in pairwise(page.fields))


def test_a_drawing_too_high_for_a_usual_page_has_one_of_its_own():
    large = next(p for p in laid_out("crank_shaper_drawn", size="letter") if p.fields[0].what == "drawing")
    assert large.fields[0].whole.height == 180
    assert large.fields[0].whole.width == 160


def test_what_fits_no_page_is_refused(monkeypatch):
    variant = COURSE["crank_shaper_drawn"].variant(0)
    monkeypatch.setitem(SIZES, "postcard", (148.0, 105.0))
    with pytest.raises(BadCourse, match="180 mm high"):
        answer_pages([variant], "en", "postcard")
    with pytest.raises(UnknownName, match="letter"):
        answer_pages([variant], "en", "leter")


RECORD = COURSE["grashof"].variant(7).record


def test_a_paper_has_one_code_and_no_other_paper_has_it():
    usual = ("midterm", "Ann Lee", 1, [RECORD], "a4")
    others = [
        ("final", *usual[1:]),
        (usual[0], "Ann Leigh", *usual[2:]),
        (*usual[:2], 2, *usual[3:]),
        (*usual[:3], [{**RECORD, "seed": 8}], "a4"),
        (*usual[:4], "letter"),
    ]
    codes = {paper_code(*one) for one in (usual, *others)}
    assert len(codes) == 6
    assert paper_code(*usual) == paper_code(*usual)
    assert all(len(code) == 13 and set(code) <= set("ABCDEFGHIJKLMNOPQRSTUVWXYZ234567") for code in codes)
    assert code_text("A" * 13, 0, 2) == "CW1 AAAAAAAAAAAAA 0/2"


def test_the_code_is_the_same_from_what_is_written_and_what_is_read():
    assert paper_code("", "Zoé", 1, [RECORD]) == paper_code("", "Zoé", 1, [json.loads(json.dumps(RECORD))])
