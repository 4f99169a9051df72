"""Right values have many digits and close the equations that are stated besides: a wrong formula is
caught."""

from __future__ import annotations

import shutil

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework import degrees
from coursework.accuracy.conditioning import unavoidable
from coursework.accuracy.followed import Followed, NotFollowed, of_arrays, of_many_digits
from coursework.accuracy.measuring import measure
from coursework.accuracy.overview import overview
from coursework.accuracy.reference import Reference
from coursework.accuracy.twins import TextbookFourBar, TextbookSliderCrank, corner, third_side
from coursework.cli import run
from coursework.errors import BadCourse
from coursework.kinematics import four_bar, slider_crank, triangles
from coursework.kinematics.angles import Degrees


@pytest.fixture
def own_course(tmp_path, course):
    """An instructor's course of one exercise, in files that a test may spoil."""
    for folder in ("exercises", "solutions"):
        home = tmp_path / folder
        home.mkdir()
        for path in (course.folder.root / folder / "slotted").glob("*slotted_mechanism*"):
            shutil.copy(path, home / path.name)
    return tmp_path


def spoilt(folder, right, wrong):
    path = folder / "solutions" / "slotted_mechanism.py"
    text = path.read_text("utf-8")
    assert right in text
    path.write_text(text.replace(right, wrong), "utf-8")
    return coursework.open_course(folder)["slotted_mechanism"]


def test_an_instructors_exercise_takes_part_as_it_is(own_course):
    exercise = coursework.open_course(own_course)["slotted_mechanism"]
    line = overview(exercise, quick=True)
    assert not line.wrong
    assert line.lack < 1e-60
    assert line.generic < 1e-14
    assert line.places > 3


@pytest.mark.parametrize(
    ("right", "wrong", "equation"),
    [
        (
            "return r2 * omega2 * sin(theta4 - theta2)",
            "return r2 * omega2 * sin(theta4 - theta2) * (1 + 1e-9)",
            "loop_1_dot",
        ),
        ("return 2 * omega4 * rA_dot", "return 2 * omega4 * rA_dot * (1 - 1e-12)", "loop_1_ddot"),
        ("2 * r1 * r2 * cos(delta)", "2.0000001 * r1 * r2 * cos(delta)", "loop_1"),
    ],
)
def test_a_wrong_formula_is_caught_and_not_called_exact(own_course, capsys, right, wrong, equation):
    exercise = spoilt(own_course, right, wrong)
    with pytest.raises(BadCourse, match="contradict") as caught:
        list(measure(exercise, quick=True))
    assert equation in str(caught.value)
    line = overview(exercise, quick=True)
    assert equation in line.wrong
    assert line.generic is None
    assert run(["--course", str(own_course), "accuracy", "slotted_mechanism", "--quick"]) == 2
    assert "contradict each other" in capsys.readouterr().err


def test_what_no_loop_holds_the_residual_holds(own_course):
    """The residual alone, without loops: at a hundred digits too."""
    exercise = spoilt(own_course, 'LOOPS = {"loop_1"', '_LOOPS = {"loop_1"')
    closing = Reference(exercise, ("rA", "theta4", "alpha4")).closing([exercise.variant(0).given])
    assert closing.is_closed
    assert closing.equation.startswith("residual")
    assert closing.lack < 1e-70


def test_values_are_those_of_a_construction_in_many_digits(course):
    """A four-bar's rocker by two circles, set up here."""
    exercise = course["four_bar_motion"]
    given = exercise.variant(0).given
    found = Reference(exercise, ("theta4",)).at(given)["theta4"]
    with mpmath.workdps(60):
        r1, r2, r3, r4 = (mpmath.mpf(given[n]) for n in ("r1", "r2", "r3", "r4"))
        crank = r2 * mpmath.expjpi(mpmath.mpf(given["theta2"]) / 180)
        line = r1 - crank
        along = (abs(line) ** 2 + r3**2 - r4**2) / (2 * abs(line) ** 2)
        across = mpmath.sqrt(r3**2 / abs(line) ** 2 - along**2)
        side = 1 if given["mode"] == "open" else -1
        rocker = crank + line * (along + 1j * side * across) - r1
        assert abs(mpmath.mpf(str(found)) - mpmath.degrees(mpmath.arg(rocker))) < mpmath.mpf(10) ** -55


def test_conditioning_is_that_of_a_known_function(course):
    """An angle near the end of an arcsine moves by the root of what its data move by."""
    exercise = course["slider_crank"]
    given = {**exercise.variant(0).given, "e": 0.0, "theta2": 30.0, "r2": 100.0, "r3": 50.0 * (1 + 1e-8)}
    reference = Reference(exercise, ("theta3",))
    least = unavoidable(reference, given, reference.at(given))["theta3"]
    slope = np.degrees(1 / np.sqrt(2e-8))
    # By r2, by r3, and by the angle of 30 degrees.
    expected = np.finfo(float).eps * slope * (1 + 1 + np.radians(30) / np.tan(np.radians(30)))
    assert least == pytest.approx(expected, rel=1e-3)


# ------------------------------------------------------------------- followed numbers


def test_numbers_are_followed_through_degrees_and_numpy():
    arithmetic = of_many_digits(50)
    x = Followed(arithmetic.mp.mpf("0.3"), arithmetic)
    assert abs(degrees.sin(degrees.asin(x)).value - x.value) < 1e-48
    assert abs(np.exp(np.radians(180.0 * (1j * x / x))).value + 1) < 1e-48
    assert abs(np.hypot(3 * x, 4 * x).value - 5 * x.value) < 1e-48
    assert np.where(x > 0, x, -x).value == x.value
    assert np.select([x > 1, x > 0], [1.0, x], 2.0).value == x.value
    assert abs(degrees.from_radians(np.radians(x)).value - x.value) < 1e-48


def test_what_makes_plain_numbers_of_values_is_not_followed():
    arithmetic = of_many_digits(50)
    x = Followed(arithmetic.mp.mpf("0.3"), arithmetic)
    for plain in (float, np.asarray, lambda v: np.stack([v, v])):
        with pytest.raises(NotFollowed):
            plain(x)


def test_the_tape_notes_what_must_not_vanish():
    notes = []
    arithmetic = of_arrays(lambda kind, margin: notes.append((kind, np.asarray(margin).tolist())))
    x = Followed(np.array([3.0, 4.0]), arithmetic)
    degrees.atan2(x, 4.0)
    degrees.sqrt(x - 3.0)
    1.0 / x
    assert ("direction", [5.0, np.hypot(4.0, 4.0)]) in notes
    assert ("root", [0.0, 1.0]) in notes
    assert ("quotient", [3.0, 4.0]) in notes


# -------------------------------------------------------------------------- the twins


@each_row("theta", [10.0, 100.0, -160.0])
@each_row("mode", ["open", "crossed"])
def test_twins_agree_with_the_core(theta, mode):
    bars = (235.0, 60.0, 255.0, 170.0)
    core, twin = (
        four_bar.FourBar(*bars, mode).at(Degrees(theta)),
        TextbookFourBar(*bars, mode).at(Degrees(theta)),
    )
    for name in (
        "coupler_angle",
        "rocker_angle",
        "coupler_ratio",
        "rocker_ratio",
        "coupler_gain",
        "rocker_gain",
    ):
        assert getattr(twin, name) == pytest.approx(getattr(core, name), rel=1e-12), name
    own, other = (
        c(60.0, 200.0, 15.0).run(Degrees(theta)) for c in (TextbookSliderCrank, slider_crank.SliderCrank)
    )
    assert own == pytest.approx(other, rel=1e-13)
    sides = (3.0, 5.0, Degrees(abs(theta)))
    assert third_side(*sides) == pytest.approx(triangles.third_side(*sides), rel=1e-13)
    assert corner(3.0, 4.0, 5.0) == pytest.approx(triangles.corner(3.0, 4.0, 5.0), rel=1e-13)
