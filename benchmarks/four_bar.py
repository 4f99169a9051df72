"""A million configurations of a four-bar linkage, beside bare sines and cosines and two rivals.

    python benchmarks/four_bar.py

The rivals need ``pip install pylinkage numba``; without them their rows are left out.
"""

from __future__ import annotations

import math

import numpy as np
from timing import best_in_turn, machine, print_table

import coursework
from coursework.kinematics.four_bar import FourBar

COUNT = 1_000_000
SIX = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")
R1, R2, R3, R4 = 200.0, 60.0, 180.0, 140.0
OMEGA, ALPHA = 10.0, 5.0
DATA = {"r1": R1, "r2": R2, "r3": R3, "r4": R4, "omega2": OMEGA, "alpha2": ALPHA, "mode": "open"}


def ours(angles: np.ndarray) -> dict:
    """Public requests, and the core below them."""
    solve = coursework.open_course()["four_bar_motion"].solve
    radians = np.radians(angles)
    core = FourBar(R1, R2, R3, R4)
    return {
        "np.sin and np.cos of the angles": lambda: (np.sin(radians), np.cos(radians)),
        "solve, six outputs": lambda: solve(**DATA, theta2=angles, only=SIX),
        "solve, two positions": lambda: solve(**DATA, theta2=angles, only=SIX[:2]),
        "kinematics.FourBar.motion, six outputs": lambda: core.motion(radians, OMEGA, ALPHA),
        "kinematics.FourBar.coefficients, two rates": lambda: core.coefficients(radians),
    }


def pylinkage_steps(count: int):
    """The same linkage with pylinkage's compiled steps: positions, velocities, accelerations."""
    from pylinkage.actuators import Crank
    from pylinkage.components import Ground
    from pylinkage.dyads import RRRDyad
    from pylinkage.simulation import Linkage

    O, C = Ground(0.0, 0.0, name="O"), Ground(R1, 0.0, name="C")
    crank = Crank(anchor=O, radius=R2, angular_velocity=2 * math.pi / count, name="A")
    joint = RRRDyad(anchor1=crank.output, anchor2=C, distance1=R3, distance2=R4, name="B")
    linkage = Linkage([O, C, crank, joint])
    linkage.set_input_velocity(crank, omega=OMEGA, alpha=0.0)
    linkage.compile()
    return lambda: linkage.step_fast_with_kinematics(iterations=count)


def fsolve_steps(count: int):
    """Positions by scipy's fsolve, each from the last."""
    from scipy.optimize import fsolve

    def gaps(x: np.ndarray, turn: float) -> list[float]:
        coupler, rocker = x
        return [
            R2 * math.cos(turn) + R3 * math.cos(coupler) - R4 * math.cos(rocker) - R1,
            R2 * math.sin(turn) + R3 * math.sin(coupler) - R4 * math.sin(rocker),
        ]

    start = np.array(FourBar(R1, R2, R3, R4).angles(0.0))

    def run() -> None:
        x = start
        for i in range(count):
            x = fsolve(gaps, x, args=(2 * math.pi * i / count,))

    return run


def main() -> None:
    print(f"{machine()}; best of 15 rounds, all calls in turn\n")
    for order, angles in {
        "random order": np.random.default_rng(0).uniform(-180, 180, COUNT),
        "in order": np.arange(COUNT) * (360.0 / COUNT) - 180.0,
    }.items():
        times = best_in_turn(ours(angles))
        bare = times["np.sin and np.cos of the angles"]
        full = times["solve, six outputs"]
        rivals = {}
        if order == "in order":
            try:
                rivals["pylinkage, step_fast_with_kinematics"] = best_in_turn(
                    {"": pylinkage_steps(COUNT)}, 5
                )[""]
            except ImportError:
                print("(pylinkage is not installed: its row is left out)\n")
            few = 2000
            rivals["scipy, fsolve step by step (positions)"] = (
                best_in_turn({"": fsolve_steps(few)}, 3)[""] * COUNT / few
            )
        rows = [
            (name, f"{seconds / COUNT * 1e9:,.1f}", f"{seconds / bare:.2f}", f"{seconds / full:.2f}")
            for name, seconds in {**times, **rivals}.items()
        ]
        print_table((f"{COUNT:,} configurations, angles {order}", "ns each", "× sin + cos", "× solve"), rows)
    few = np.linspace(-180, 180, 100)
    solve = coursework.open_course()["four_bar_motion"].solve
    calls = {
        "one configuration, six outputs": lambda: solve(**DATA, theta2=33.0, only=SIX),
        "one configuration, one output": lambda: solve(**DATA, theta2=33.0, only="theta4"),
        "100 configurations, six outputs": lambda: solve(**DATA, theta2=few, only=SIX),
    }
    found = best_in_turn(calls, 200)
    print_table(("a small request", "µs"), [(n, f"{s * 1e6:.0f}") for n, s in found.items()])


if __name__ == "__main__":
    main()
