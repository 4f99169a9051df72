"""Values that an instructor states instead of drawing them: those of a textbook, or some of them, with the
rest drawn."""

import math
from collections import Counter

import pytest

from coursework.errors import BadInput, CannotAssemble, Starved, UnknownName, WrongUnit
from coursework.issuing.assignment import assignment_of
from coursework.issuing.issued import Issued, issued_content
from coursework.issuing.issuing import issue
from coursework.issuing.roster import Student
from coursework.issuing.variant_assignment import assign_variants
from coursework.marking.marking import mark

#: A crank-rocker of a textbook, in inches there.
TEXTBOOK = {
    "r1": "9 in",
    "r2": "114.3 mm",
    "r3": "0.1905 m",
    "r4": "177.8 mm",
    "theta2": "135°",
    "omega2": 10,
    "alpha2": "2 rad/s²",
    "mode": "open",
}
CLASS = [Student("Ada"), Student("Max"), Student("Zoé")]


def assigned(course, students=CLASS, **exercise):
    table = {"secret": "0123456789abcdef" * 2, "exercises": [{"name": "four_bar_motion", **exercise}]}
    assignment = assignment_of("week", table, course)
    return assignment, assign_variants(course, assignment, students, ["en"])


def test_the_numbers_of_a_textbook_are_the_variant_of_everybody_and_are_marked(course):
    assignment, issued = assigned(course, given=TEXTBOOK)
    content = issued_content(issued.issues, assignment, issued.secret)
    values = [
        {name: one["value"] for name, one in item["record"]["given"].items()} for item in content["issued"]
    ]
    assert values == [{**values[0]}] * 3
    assert values[0]["r1"] == pytest.approx(228.6, abs=1e-12)
    assert values[0]["r3"] == pytest.approx(190.5, abs=1e-12)
    record = Issued(content, "issued.json").record_of("Max", "four_bar_motion", 0)
    variant = course["four_bar_motion"].from_record(record)
    # The loop closed by hand: the circle of the coupler about A and that of the rocker about C meet in B.
    a = complex(114.3 * math.cos(math.radians(135)), 114.3 * math.sin(math.radians(135)))
    span = 228.6 - a
    along = (190.5**2 - 177.8**2 + abs(span) ** 2) / (2 * abs(span))
    b = a + span / abs(span) * complex(along, math.sqrt(190.5**2 - along**2))
    theta3 = math.degrees(math.atan2((b - a).imag, (b - a).real))
    marks = mark(variant, {"theta3": f"{theta3:.2f}°", "theta4": "12"})
    assert (marks["theta3"].verdict, marks["theta4"].verdict) == ("correct", "wrong")


def test_a_note_tells_which_errors_such_numbers_hide(course):
    _, issued = assigned(course, given=TEXTBOOK)
    (note,) = map(str, issued.notes)
    assert "alpha2_left_out_is_detectable" in note
    drawn = course["four_bar_motion"].variant(7).record["given"]
    _, issued = assigned(course, given={name: one["value"] for name, one in drawn.items()})
    assert issued.notes == []


def test_what_is_not_stated_is_drawn_and_differs(course):
    _, issued = assigned(course, given={"r2": "60 mm", "mode": "open"})
    given = [one.variant.given for one in issued.issues]
    assert {(one["r2"], one["mode"]) for one in given} == {(60.0, "open")}
    assert len({tuple(one.values()) for one in given}) == len(CLASS)
    draws = course["four_bar_motion"].draws
    assert [draws.refusing(one) for one in given] == [()] * len(CLASS)
    # Whoever comes later changes nobody's numbers.
    _, more = assigned(course, [*CLASS, Student("Eve")], given={"r2": "60 mm", "mode": "open"})
    assert [one.variant.given for one in more.issues][:3] == given


def test_builds_without_an_assignment_take_them_too(course):
    names = ["four_bar_motion", "slider_crank"]
    issues = issue(course, names, first_seed=0, count=2, langs=["fr"], given={"r2": "6 cm"})
    assert Counter((one.variant.exercise.name, one.variant.given["r2"]) for one in issues) == {
        ("four_bar_motion", 60.0): 2,
        ("slider_crank", 60.0): 2,
    }
    notes = []
    alike = issue(
        course,
        names[:1],
        first_seed=0,
        count=1,
        langs=["fr"],
        roster=CLASS,
        given=TEXTBOOK,
        note=notes.append,
    )
    assert len({tuple(one.variant.given.values()) for one in alike}) == 1 < len(alike) == len(notes) + 2


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"r2": "999 mm"}, Starved, "crank_turns"),
        ({**TEXTBOOK, "r1": "900 mm"}, CannotAssemble, "gap"),
        ({"r7": 1}, BadInput, "r4"),
        ({"r2": "4 kg"}, BadInput, "mm"),
        ({"r2": "-4 mm"}, BadInput, "positive"),
        ({"mode": "opne"}, BadInput, "open"),
        ("r2 = 4", BadInput, "table"),
    ],
)
def test_numbers_that_are_none_are_refused_with_what_would_do(course, given, error, words):
    with pytest.raises(error, match=words):
        assigned(course, given=given)


def test_a_variant_of_a_seed_takes_them_as_well(course):
    exercise = course["slider_crank"]
    seeded = exercise.variant(3)
    assert exercise.variant(3, given={}).given == seeded.given
    with pytest.raises(UnknownName):
        exercise.variant(3, given={"radius": 1})
    with pytest.raises(WrongUnit):
        exercise.variant(3, given={"r2": "1 s"})
    assert exercise.variant(3, given=dict(seeded.given)).given == seeded.given
