"""Drawn acceleration polygons: against the exercises that compute the same motion."""

import numpy as np
import pytest
from tables import each_row

import coursework

COURSE = coursework.open_course()
FOUR_BAR, SLIDER = COURSE["acceleration_polygon"], COURSE["acceleration_polygon_slider"]


@each_row("seed", range(12))
def test_four_bar_is_that_of_the_computed_motion(seed):
    variant = FOUR_BAR.variant(seed)
    found = variant.solution()
    motion = COURSE["four_bar_motion"].solve(**variant.given, alpha2=0.0)
    for name in ("alpha3", "alpha4", "a_B"):
        assert found[name] == pytest.approx(motion[name], rel=1e-9)
    k = found["ka"]
    assert np.hypot(*(found["n"] - found["a"])) * k == pytest.approx(motion["a_BA_n"], rel=1e-10)
    assert found["bb_t"] * k == pytest.approx(abs(motion["a_BA_t"]), rel=1e-9)


@each_row("seed", range(12))
def test_slider_crank_is_that_of_the_computed_motion(seed):
    variant = SLIDER.variant(seed)
    found = variant.solution()
    motion = COURSE["slider_crank"].solve(**variant.given, only=("alpha3", "r1_ddot"))
    for name, value in motion.items():
        assert found[name] == pytest.approx(value, rel=1e-9)


@each_row("seed", range(5))
@each_row("lang", ["fr", "en"])
def test_the_statement_gives_the_speeds_that_the_normal_parts_need(seed, lang):
    variant = FOUR_BAR.variant(seed, lang)
    motion = COURSE["four_bar_motion"].solve(**variant.given, alpha2=0.0)
    for name, told in (("v_BA", "V_BA"), ("v_B", "V_B")):
        printed = variant.printed[told]
        assert float(printed.removeprefix(r"\num{").rstrip("}")) == pytest.approx(motion[name], rel=6e-4)
        assert printed in variant.text.opening


@each_row("exercise", [FOUR_BAR, SLIDER])
def test_normal_part_left_out_is_told_and_all_the_rest_is_kept(exercise):
    told = 0
    for variant in exercise.variants(range(20)):
        wrong = exercise.solution.mistaken("bt_on_a").evaluate(("b",), variant.given)["b"]
        found = variant.solution()
        points = {n: found[n] for n in ("p", "a", "n", "m") if n in found} | {"b": wrong}
        given = {n: f"{z[0]}; {z[1]}" for n, z in points.items()} | {"ka": found["ka"]}
        marking = variant.grade(given)
        assert {marking[n].verdict for n in points if n != "b"} == {"correct"}
        told += "bt_on_a" in marking["b"].mistakes
    assert told > 15
