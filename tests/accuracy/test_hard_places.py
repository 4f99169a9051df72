"""Hard places are found from an exercise's formulas: nobody types them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from sweeps import sampled

from coursework.accuracy.hard_places import DISTANCES, VANISHING, Terrain, hard_places


def numbers(exercise):
    return [p.quantity for p in exercise.spec.parts if p.kind in ("number", "angle")]


@cache
def places(course, name):
    exercise = course[name]
    return hard_places(exercise, numbers(exercise))


#: What an expert would type: the linkage at its hardest, the angle at which it is so, and the lengths that
#: meet there.
EXPERT = {
    "four_bar_motion": ({"r1": 100, "r2": 50, "r3": 70, "r4": 80, "theta2": 180}, ("r1", "r2", "r3", "r4")),
    "slider_crank": ({"r2": 100, "r3": 100, "e": 0, "theta2": 90}, ("r2", "r3", "e")),
    "slotted_mechanism": ({"r1": 200, "r2": 200, "theta1": 90, "theta2": -90}, ("r1", "r2")),
}


@pytest.mark.parametrize("name", sampled(EXPERT, ("slider_crank", "slotted_mechanism")))
def test_what_an_expert_would_type_is_found(course, name):
    """The margin that vanishes at the place that is found vanishes at the expert's, and is as double
    there."""
    exercise, (typed, lengths) = course[name], EXPERT[name]
    found = [p for p in places(course, name) if p.double and p.moved == "theta2"]
    assert found
    terrain = Terrain(exercise, numbers(exercise))

    def margins(given):
        arrays = {n: v if isinstance(v, str) else np.array([v], dtype=float) for n, v in given.items()}
        return {key[:2]: abs(m[0]) for key, m in terrain.relative(arrays).items()}

    same = [p for p in found if margins({**p.given, **typed})[p.quantity, p.kind] < 1e-11]
    assert same
    for place in same:
        beside = margins({**place.given, **typed, "theta2": typed["theta2"] + 0.1})[
            place.quantity, place.kind
        ]
        assert 0 < beside < 1e-2  # of second order, or a distance: it does not change its sign
        assert margins(place.given)[place.quantity, place.kind] < 1e-11
        assert any(place.given[n] != terrain.bases[0][n] for n in lengths)


def test_a_change_point_is_told_in_short_numbers(course):
    place = next(p for p in places(course, "four_bar_motion") if p.double)
    longest, *_, shortest = sorted((place.given[n] for n in ("r1", "r2", "r3", "r4")), reverse=True)
    total = sum(place.given[n] for n in ("r1", "r2", "r3", "r4"))
    assert 2 * (longest + shortest) == total
    assert place.given["theta2"] % 180 == 0


def test_equal_crank_and_rod_are_a_change_point_of_the_slider_crank(course):
    found = [p for p in places(course, "slider_crank") if p.double]
    assert any(p.given["e"] == 0 and p.given["r2"] == p.given["r3"] for p in found)
    assert any(abs(p.given["e"]) == abs(p.given["r3"] - p.given["r2"]) != 0 for p in found)


def test_places_are_approached_from_both_sides(course):
    place = next(p for p in places(course, "slotted_mechanism") if p.double)
    way = list(place.approach())
    assert len(way) == 2 * len(DISTANCES)
    gaps = [abs(given[place.moved] - place.given[place.moved]) / place.scale for given in way]
    assert gaps[::2] == pytest.approx(DISTANCES, rel=1e-2)
    assert place.at(0.1, 1e-7)[place.tuned] == place.given[place.tuned] * (1 + 1e-7)


def test_a_length_vanishes_from_one_side(course):
    place = next(p for p in places(course, "slotted_mechanism") if p.kind == VANISHING)
    assert place.given[place.moved] == 0
    assert all(given[place.moved] > 0 for given in place.approach())


def test_those_that_lose_most_come_first_and_easy_exercises_have_none(course):
    lost = [p.lost for p in places(course, "slider_crank")]
    assert lost == sorted(lost, reverse=True)
    assert lost[0] > 1e-6
    assert not places(course, "coriolis")
