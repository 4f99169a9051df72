"""The check of a stated mechanism: what every exercise keeps, and that a slip in a statement is found."""

from __future__ import annotations

import dataclasses

import pytest

import coursework
from coursework.authoring.check_mechanism import check_mechanism, counts, faults
from coursework.authoring.check_report import CheckReport
from coursework.course.course import Course
from coursework.course.folder import course_folder
from coursework.course.variant import Variant
from coursework.mechanics import Body, Mechanism, Slide

COURSE = coursework.open_course()
STATED = [n for n in COURSE if COURSE[n].solution.mechanism is not None]


def failures(name, mechanism=None, variants=3):
    own = COURSE[name]
    exercise = object.__new__(type(own))  # a copy is the course's own: what is replaced must stay here
    exercise.__dict__.update(own.__dict__)
    if mechanism is not None:
        exercise.__dict__["solution"] = dataclasses.replace(exercise.solution, mechanism=mechanism)
    report = CheckReport(name)
    check_mechanism(exercise.variants(range(variants)), report)
    return report.failures


@pytest.mark.parametrize("name", STATED)
def test_every_statement_agrees_with_its_joint_graph_and_its_solution(name):
    assert failures(name, variants=10) == []


def test_every_driven_exercise_states_its_mechanism():
    # A contact that rolls and slides, and axes in space.
    beyond = {
        "cam_follower",
        "flat_faced_cam",
        "geometrical_closure",
    }
    assert {n for n in COURSE if COURSE[n].spec.driver is not None and n not in STATED} == beyond


def test_a_slip_in_a_statement_is_found():
    stated = COURSE["four_bar_motion"].solution.mechanism
    two, three, four = stated.bodies
    longer = dataclasses.replace(three, points={"B": lambda r3: 1.01 * r3})
    assert (
        "miss each other"
        in failures("four_bar_motion", dataclasses.replace(stated, bodies=(two, longer, four)))[0]
    )
    free = dataclasses.replace(stated, bodies=(two, three, dataclasses.replace(four, points={})))
    assert "leave 3 degrees of freedom" in failures("four_bar_motion", free)[0]


def test_a_slide_along_another_line_turns_bodies_otherwise():
    stated = COURSE["slider_crank"].solution.mechanism
    tilted = dataclasses.replace(stated, slides=(Slide("B", "4", along=10.0),))
    assert "omega3 = " in failures("slider_crank", tilted)[0]


def test_a_jack_is_stated_by_its_slide_and_its_length():
    stated = COURSE["jack_mechanism"].solution.mechanism
    assert "found one alone" in failures("jack_mechanism", dataclasses.replace(stated, pushed=""))[0]
    turned = dataclasses.replace(stated, slides=(Slide("A", "3", on="2", along=180.0),))
    assert "the jack grows by" in failures("jack_mechanism", turned)[0]


def test_counts_are_those_of_the_joint_graph():
    double = Mechanism(
        {"D": 0, "O": 1j},
        (
            Body("2", "a", "O", {"A": 1}),
            Body("3", "b", "A", {"B": 1}),
            Body("4", "c", "D", {"B": 1}),
            Body("5", "d", "B", {"P": 1}),
            Body("6", 0, "P"),
        ),
        (Slide("P", "6"),),
    )
    found = counts(double)
    assert (found.n, found.b, found.h, found.w, found.gamma) == (5, 7, 0, 1, 2)


def test_a_free_body_goes_as_its_slides_let_it(tmp_path):
    """A Scotch yoke in a course of its own, said rightly and with a slip."""
    course = tmp_path / "own"
    (course / "exercises").mkdir(parents=True)
    (course / "solutions").mkdir()
    (course / "exercises" / "course.toml").write_text('language = "en"\n[title]\nen = "Own"\n', "utf-8")
    (course / "exercises" / "yoke.py").write_text(
        "from coursework.model import Driver, Exercise, Part, drawn\n"
        "EXERCISE = Exercise(given={'r': drawn(40, 90, unit='mm'), 'theta': drawn(10, 80, unit='deg'),"
        " 'omega': drawn(2, 9, unit='rad/s')}, parts=(Part('x', unit='mm', points=1),),"
        " driver=Driver('theta', 'omega'))\n",
        "utf-8",
    )
    for turn, found in (("cos", []), ("sin", ["goes otherwise than its slides let it"])):
        (course / "solutions" / "yoke.py").write_text(
            "from coursework.degrees import cos, sin\nfrom coursework.mechanics import Body, "
            "Mechanism, Slide\n"
            "MECHANISM = Mechanism(ground={'O': 0}, bodies=(Body('2', 'theta', 'O', {'A': 'r'}), "
            "Body('3', 0, 'A'),"
            " Body('4', 0, 'Y', origin='x')), slides=(Slide('A', '3', on='4', along=90.0), Slide('Y', "
            "'4')))\n"
            f"def x(r, theta):\n    return r * {turn}(theta)\n" + "\n" * (turn == "sin"),
            "utf-8",
        )
        told = list(faults(Course(course_folder(course), Variant)["yoke"].variant(0)))
        assert [why for why in found if any(why in one for one in told)] == found
        assert len(told) == len(found)
