"""Havens construction: against the computed planetary, and arrows judged from a student's own."""

import math
import random

import numpy as np
import pytest
from tables import each_row

import coursework

COURSE = coursework.open_course()
EXERCISE, PLANETARY = COURSE["havens_construction"], COURSE["havens_planetary"]
VECTORS = ("v10", "v40", "v14", "v24", "v20", "v30")


def sheet(vectors, scale):
    return {n: f"({v[0]}; {v[1]})" for n, v in vectors.items()} | {"kv": scale}


def right(variant, scale=None):
    """The arrows at a scale."""
    found = variant.solution()
    scale = scale or found["kv"]
    return {n: found[n] * found["kv"] / scale for n in VECTORS}, scale


@each_row("seed", range(12))
def test_arrows_are_the_velocities_that_the_planetary_computes(seed):
    variant = EXERCISE.variant(seed)
    found = variant.solution()
    k = found["kv"]
    motion = PLANETARY.solve(**variant.given)
    assert found["omega4"] == pytest.approx(motion["omega4"], rel=1e-10)
    assert found["omega3"] == pytest.approx(motion["omega3"], rel=1e-9)
    assert found["v20"] * k == pytest.approx([motion["v_B2_x"], motion["v_B2_y"]], rel=1e-9, abs=1e-9)
    assert np.hypot(*found["v40"]) * k == pytest.approx(abs(motion["v_A1_4"]), rel=1e-10)
    assert np.hypot(*found["v14"]) * k == pytest.approx(abs(motion["v_slide"]), rel=1e-9)
    assert np.hypot(*found["v30"]) * k == pytest.approx(abs(motion["v_I"]), rel=1e-9)


def test_arrows_within_two_millimetres_are_right_at_any_scale():
    chance = random.Random(2)
    for variant in EXERCISE.variants(range(60)):
        vectors, scale = right(variant, variant.solution()["kv"] * chance.uniform(0.8, 1.4))
        longest = max(np.hypot(*v) for v in vectors.values())
        if longest < 31:
            continue
        for name in vectors:
            turn, off = chance.uniform(0, 2 * math.pi), 1.95 * math.sqrt(chance.random())
            vectors[name] = vectors[name] + off * np.array([math.cos(turn), math.sin(turn)])
        marking = variant.grade(sheet(vectors, scale))
        assert {marking[n].verdict for n in (*VECTORS, "kv")} == {"correct"}


@each_row("name", VECTORS)
@each_row(
    ("kind", "change"),
    [
        ("length", lambda v: v * (1 + 12 / np.hypot(*v))),
        ("sense", lambda v: -v),
        ("direction", lambda v: np.array([-v[1], v[0]])),
    ],
)
def test_a_fault_is_named_on_its_arrow_alone(name, kind, change):
    for variant in EXERCISE.variants(range(25)):
        vectors, scale = right(variant)
        vectors[name] = change(vectors[name])
        marking = variant.grade(sheet(vectors, scale))
        assert f"vector_{kind}" in marking[name].mistakes
        # The others are where they should be, and so right, whatever this one is.
        assert {marking[n].verdict for n in VECTORS if n != name} == {"correct"}


def test_who_goes_on_rightly_from_a_reversed_slide_loses_it_alone():
    for variant in EXERCISE.variants(range(10)):
        given, (vectors, scale) = variant.given, right(variant)
        arm = given["d"] + (given["r2"] + given["r3"]) * np.exp(1j * np.radians(given["theta1"]))
        vectors["v14"] = -vectors["v14"]
        vectors["v24"] = vectors["v14"]
        vectors["v20"] = vectors["v24"] + vectors["v40"] * (abs(arm) + given["b"]) / abs(arm)
        marking = variant.grade(sheet({n: vectors[n] for n in VECTORS[:5]}, scale))
        assert marking["v14"].verdict == "mistake:vector_sense"
        assert (marking["v24"].verdict, marking["v20"].verdict) == ("follow_through", "follow_through")


def test_arrows_without_length_earn_nothing():
    variant = EXERCISE.variant(0)
    marking = variant.grade(dict.fromkeys(VECTORS, "0; 0"))
    assert sum(marking[n].points for n in VECTORS) == 0
    marking = variant.grade({**dict.fromkeys(VECTORS, "0; 0"), "kv": variant.solution()["kv"]})
    assert sum(marking[n].points for n in VECTORS) == 0


def test_what_is_read_off_a_vector_that_is_not_drawn_is_judged_all_the_same():
    for seed in (5, 11, 16, 38):
        variant = EXERCISE.variant(seed, "fr")
        omega3 = 0.85 * variant.walk["omega3"]
        marking = variant.grade({"kv": "20", "omega3": f"{omega3:.4g}"})
        assert marking["omega3"].points == 0.0
