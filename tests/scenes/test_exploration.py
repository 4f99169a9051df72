"""Exploration with freely chosen data: rates against slopes of positions, links against their lengths, and
what does not close."""

import math

import numpy as np
import pytest
from animations import COURSE, DRIVEN
from sweeps import at_once
from tables import each_row

from coursework.errors import CannotAssemble
from coursework.scenes.exploration import Exploration, parameters

TYPICAL = 2  #: seed of the data that are changed
#: Of some mechanisms, changed data with which they still close.
CHANGED = {
    "four_bar_motion": {"r1": 200, "r2": 50, "r3": 170, "r4": 130, "omega2": -7, "mode": "open"},
    "slider_crank": {"r2": 40, "r3": 190, "e": 15, "omega2": 11},
    "slotted_mechanism": {"r1": 180, "r2": 77, "theta1": 30, "omega2": 3},
    "quick_return_shaper": {"r1": 260, "r2": 90, "omega2": -4},
    "two_loop_linkage": {"omega2": 8},
    "three_loop_shaper": {"omega2": -5},
    "quick_return": {"omega2": 6},
    "curved_slot": {"omega2": 9},
}


def explored(name, lang="en", **changed):
    exercise = COURSE[name]
    return Exploration(exercise, exercise.variant(TYPICAL, lang).given, changed, lang)


@each_row("name", list(CHANGED))
def test_rates_are_the_slopes_of_positions(name):
    found = explored(name, **CHANGED[name])
    assert found.closes.all()
    speed = CHANGED[name]["omega2"]
    rates = {n: pair for loop in COURSE[name].solution.loops.values() for n, pair in loop.rates.items()}
    curves = {c.name: c for effect in ("position", "velocity", "acceleration") for c in found.curves(effect)}
    step = math.radians(1.0)
    compared = 0
    for position, names in rates.items():
        for lower, higher in ((position, names[0]), *([names] if len(names) == 2 else [])):
            if lower not in curves or higher not in curves:
                continue
            values = curves[lower].values
            if curves[lower].unit == "deg":
                values = np.unwrap(np.radians(values))
            # Of fourth order, by the turn that closes.
            v = np.concatenate(
                [values[-5:-1] - (values[-1] - values[0]), values, values[1:5] + (values[-1] - values[0])]
            )
            slope = (8 * (v[5:-3] - v[3:-5]) - (v[6:-2] - v[2:-6])) / (12 * step) * speed
            if "alpha2" in COURSE[name].spec.given and lower == names[0]:
                continue  # the driver gains speed besides
            wanted = curves[higher].values
            assert abs(slope - wanted).max() < 2e-3 * abs(wanted).max(), (lower, higher)
            compared += 1
    assert compared >= 1


def test_links_keep_the_lengths_that_were_chosen():
    data = CHANGED["four_bar_motion"]
    found = explored("four_bar_motion", **data)
    A, B = found.points["A"], found.points["B"]
    for vector, name in ((A, "r2"), (B - A, "r3"), (B - data["r1"], "r4")):
        assert abs(vector) == pytest.approx(data[name], rel=1e-12)
    assert ((B - A) * (data["r1"] - A).conj()).imag.min() > 0  # B on the left of AC


@each_row(
    ("lengths", "expected"),
    [
        ((120, 40, 100, 90), "crank-rocker"),
        ((120, 90, 100, 40), "rocker-crank"),
        ((40, 90, 120, 100), "double-crank"),
        ((120, 90, 40, 100), "double-rocker"),
        ((120, 90, 70, 50), "triple-rocker"),
        ((120, 40, 100, 60), "change-point"),
    ],
)
def test_the_type_of_four_bars_is_named(lengths, expected):
    r1, r2, r3, r4 = lengths
    assert explored("four_bar_motion", r1=r1, r2=r2, r3=r3, r4=r4).type == expected


def test_where_bars_do_not_reach_each_other_the_gap_is_told_and_drawn():
    r1, r2, r3, r4 = 200.0, 100.0, 90.0, 80.0
    found = explored("four_bar_motion", r1=r1, r2=r2, r3=r3, r4=r4, theta2=150.0)
    between = math.sqrt(r1**2 + r2**2 - 2 * r1 * r2 * math.cos(math.radians(150.0)))
    assert found.is_open
    assert found.gap == pytest.approx(between - r3 - r4, rel=1e-2)
    limit = math.degrees(math.acos((r1**2 + r2**2 - (r3 + r4) ** 2) / (2 * r1 * r2)))
    assert found.ranges == [(360 - math.floor(limit), math.floor(limit))]
    assert found.nearest == math.floor(limit)
    assert np.isnan([v for n, v in found.values_now().items()]).all()
    shown = found.drawing()
    tips = [t for t in shown.tracks if t.effect == "acceleration" and t.closed]
    ends = np.array([t.numbers[0, :2] @ (1, 1j) for t in tips])
    assert abs(ends[1] - ends[0]) / shown.scale == pytest.approx(between - r3 - r4, rel=1e-6)


def test_bars_that_close_nowhere_are_still_drawn():
    found = explored("four_bar_motion", r1=500, r2=30, r3=50, r4=60)
    assert (found.ranges, found.type, found.nearest) == ([], "", None)
    assert found.drawing() is not None
    with pytest.raises(CannotAssemble) as fault:
        explored("quick_return", r1=590, r2=20, r3=60, r4=50)
    assert Exploration.gap_of(fault.value) > 0


@at_once(DRIVEN, DRIVEN[::4])
def test_whatever_is_chosen_within_its_bounds_is_drawn_or_refused_by_a_course_error(names):
    """The corners of the box of bounds, and some places inside it."""
    from coursework.errors import CourseworkError

    for name in names:
        exercise = COURSE[name]
        typical = exercise.variant(TYPICAL).given
        choices = parameters(exercise, typical)
        assert choices[-1].name == exercise.spec.driver.moved
        draw = np.random.default_rng(3)
        for k in range(4):
            share = draw.integers(0, 2, len(choices)) if k < 2 else draw.random(len(choices))
            changed = {
                p.name: p.choices[int(x * 0.99 * len(p.choices))]
                if p.choices
                else p.low + x * (p.high - p.low)
                for p, x in zip(choices, share, strict=True)
            }
            try:
                found = Exploration(exercise, typical, changed, "fr")
                drawing = found.drawing()
                assert drawing is None or np.isfinite(drawing.size).all()
                assert all(0 <= end <= found.steps[-1] for ends in found.ranges for end in ends)
            except CourseworkError:
                pass


@each_row("name", DRIVEN)
def test_typical_data_close_and_a_single_solution_agrees(name):
    exercise = COURSE[name]
    typical = exercise.variant(TYPICAL).given
    found = Exploration(exercise, typical, {}, "en")
    assert not found.is_open
    assert found.nearest is not None
    k = int(np.flatnonzero(found.closes)[len(found.steps) // 3 % found.closes.sum()])
    moved = exercise.spec.driver.moved
    here = Exploration(exercise, typical, {moved: float(found.steps[k])}, "en").values_now()
    for effect in ("position", "velocity", "acceleration", "forces"):
        for curve in found.curves(effect):
            assert here[curve.name] == pytest.approx(curve.values[k], rel=1e-9, abs=1e-9, nan_ok=True)


@each_row(
    ("text", "expected"),
    [
        ("70", 70.0),
        (" 70,5 ", 70.5),
        ("−3", 10.0),
        ("1e9", 90.0),
        ("1e999", None),
        ("nan", None),
        ("inf", None),
        ("", None),
        ("70 mm", None),
        ("'; drop", None),
        ("9" * 5000, 90.0),
        ("0x10", None),
        ("７０", 70.0),
    ],
)
def test_a_number_is_read_and_kept_within_its_bounds(text, expected):
    from coursework.scenes.exploration import Parameter

    assert Parameter("r2", "mm", 10.0, 90.0).value(text) == expected
    assert Parameter("mode", "1", choices=("open", "crossed")).value(text) is None
