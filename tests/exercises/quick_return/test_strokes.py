"""What the quick returns have in common: strokes of a swept turn, apart from the instant."""

import numpy as np
import pytest
from swept_turn import TURN, swept, turns_back

import coursework

COURSE = coursework.open_course()
INSTANT = {
    "quick_return_offset": {"p", "q", "xC", "v_C"},
    "quick_return_whitworth": {"rA", "theta4", "xP", "p", "xC", "v_C"},
    "quick_return_shaper": {"rA", "theta4", "xP", "p", "xC", "v_C"},
}
#: What of the strokes the velocity does not need.
OF_THE_TURN = {"quick_return_whitworth": "x1", "quick_return_shaper": "sigma"}

every_stroke = pytest.mark.parametrize("name", INSTANT)


@every_stroke
@pytest.mark.parametrize("seed", range(12))
def test_stroke_and_arcs_are_those_of_a_swept_turn(name, seed):
    given = dict(COURSE[name].variant(seed).given)
    found, answers = swept(COURSE[name], given), COURSE[name].solve(**given)
    sampling = 1e-3 if name == "quick_return_shaper" else 1e-4  # mm: a guide swings fast near its ends
    assert np.ptp(found["xC"]) == pytest.approx(answers["stroke"], abs=sampling)
    forward = (found["v_C"] > 0).mean() * 360
    assert max(forward, 360 - forward) == pytest.approx(answers["alpha"], abs=0.03)
    assert turns_back(found) == 2


@pytest.mark.parametrize("name", ["quick_return_whitworth", "quick_return_shaper"])
def test_turning_the_other_way_changes_the_velocity_alone(name):
    given = {**COURSE[name].variant(2).given, "omega2": 6.0}
    here, there = COURSE[name].solve(**given), COURSE[name].solve(**{**given, "omega2": -6.0})
    assert there == {**here, "v_C": -here["v_C"]}


@every_stroke
def test_strokes_compute_nothing_of_the_instant(name):
    exercise = COURSE[name]
    assert not INSTANT[name] & set(exercise.plan(TURN))
    assert OF_THE_TURN.get(name) not in exercise.plan(("v_C",))
    if name == "quick_return_offset":
        assert set(exercise.plan(("v_C",))) == {"p", "q", "omega3", "v_C"}
