"""Gear trains in exact fractions: tooth by tooth, by the table of turns, and by the balance of forces at the
teeth."""

from fractions import Fraction

import pytest
from tables import each_row

import coursework

COURSE = coursework.open_course()


@each_row("seed", range(20))
def test_an_ordinary_train_passes_teeth_on_one_by_one(seed):
    """While wheel 1 passes so many teeth, each next wheel passes as many; those of one shaft make the same
    turns."""
    variant = COURSE["gear_train"].variant(seed)
    found, z = variant.solution(), {k: int(v) for k, v in variant.given.items() if k.startswith("z")}
    teeth = Fraction(1000)  # past the first contact, anticlockwise
    shaft = teeth / z["z3"]  # twice reversed
    output = shaft * z["z4"] / z["z5"] * (-1 if variant.given["mode"] == "external" else 1)
    ratio = output / (teeth / z["z1"])
    assert found["r"] == pytest.approx(float(ratio), rel=1e-14)
    assert found["omega5"] == pytest.approx(float(ratio * int(variant.given["omega1"])), rel=1e-14)
    power = [variant.given["Gamma1"] * abs(variant.given["omega1"]), found["Gamma5"] * abs(found["omega5"])]
    assert power[1] / power[0] == pytest.approx(variant.given["eta"] ** 3, rel=1e-14)


def by_the_table(z1, z2, fixed, n):
    """All turn once with the carrier; then, the carrier held, the sun is turned back by some turns."""
    z3 = z1 + 2 * z2
    back = {"ring": Fraction(-z3, z1), "sun": Fraction(1), "carrier": None}[fixed]
    once = Fraction(1)
    if back is None:
        once, back = Fraction(0), Fraction(1)
    sun, planet, ring = once - back, once + back * Fraction(z1, z2), once + back * Fraction(z1, z3)
    turns = {"ring": (sun, once), "sun": (ring, once), "carrier": (sun, ring)}[fixed]
    scale = n / turns[0]
    return {"omega_b": turns[1] * scale, "omega2": planet * scale, "omega24": (planet - once) * scale}


@each_row("seed", range(20))
def test_an_epicyclic_train_turns_as_the_table_says(seed):
    variant = COURSE["epicyclic_train"].variant(seed)
    given, found = variant.given, variant.solution()
    expected = by_the_table(int(given["z1"]), int(given["z2"]), given["mode"], int(given["omega_a"]))
    for name, value in expected.items():
        assert found[name] == pytest.approx(float(value), rel=1e-13), name


@each_row("fixed", ["ring", "sun", "carrier"])
def test_torques_are_those_of_the_forces_at_the_teeth(fixed):
    """A planet bears equal forces at both meshes, and twice that on its pin."""
    z1, z2, force = 24, 18, 5.0
    torques = {"sun": z1 * force, "ring": (z1 + 2 * z2) * force, "carrier": -2 * (z1 + z2) * force}
    driver, load = {"ring": ("sun", "carrier"), "sun": ("ring", "carrier"), "carrier": ("sun", "ring")}[fixed]
    found = COURSE["epicyclic_train"].solve(
        z1=z1, z2=z2, mode=fixed, omega_a=-500, Gamma_in=torques[driver], only=("Gamma_out", "Gamma_fix")
    )
    assert found["Gamma_out"] == pytest.approx(torques[load])
    assert found["Gamma_fix"] == pytest.approx(torques[fixed])
