"""A million configurations of a four-bar linkage, beside bare sines and cosines and two rivals.

    python benchmarks/four_bar.py

The rivals need ``pip install pylinkage numba``; without them their rows are left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from unittest.mock import patch

import numpy as np
from timing import Rounds, best_in_turn, machine, print_table, rounds_in_turn

import coursework
from coursework.kinematics import vectors
from coursework.kinematics.elementary import quotient_arctangent, tangent
from coursework.kinematics.four_bar import FourBar
from coursework.system import blocks
from coursework.system.blocks import BLOCK

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


def least_calls(angles: np.ndarray) -> dict:
    """What positions cannot do without, alone: a tangent and two arctangents, numpy's and by our formula, in
    pieces."""
    eighth = np.radians(angles) / 4
    slope = np.tan(eighth)
    room = np.empty_like(slope)
    whole = [slice(start, start + BLOCK) for start in range(0, len(slope), BLOCK)]

    def numpys() -> None:
        for at in whole:
            np.tan(eighth[at], out=room[at])
            np.arctan(slope[at], out=room[at])
            np.arctan(slope[at], out=room[at])

    def by_formula() -> None:
        for at in whole:
            room[at] = tangent(eighth[at])
            room[at] = quotient_arctangent(slope[at])
            room[at] = quotient_arctangent(slope[at])

    return {
        "a tangent and two arctangents, numpy's": numpys,
        "the same by elementary's formulas": by_formula,
    }


def tried(angles: np.ndarray) -> dict:
    """The six outputs in other pieces, with either arctangent, by one thread and by all."""
    solve = coursework.open_course()["four_bar_motion"].solve

    def with_settings(piece: int, arctangent: Callable, threads: int) -> Callable[[], None]:
        def call() -> None:
            with (
                patch.object(blocks, "PIECE", piece),
                patch.object(vectors, "arctangent", arctangent),
                patch.object(blocks, "processors", lambda: threads),
                patch.object(blocks, "_PAYS", math.inf),
                patch.object(blocks, "_NOTICED", 0.0),
            ):
                solve(**DATA, theta2=angles, only=SIX)

        return call

    ways = {"numpy's arctangent": np.arctan, "elementary's": quotient_arctangent}
    return {
        f"pieces of {piece:,}, {way}, {threads} thread{'s' * (threads > 1)}": with_settings(
            piece, call, threads
        )
        for way, call in ways.items()
        for piece in (8192, 16384, 32768, 65536)
        for threads in (1, blocks.processors())
        if threads == 1 or piece >= 32768
    }


def beside(first: Rounds, own: Rounds) -> tuple[str, ...]:
    """Least and median nanoseconds; times the first call's: least by least, median over rounds, by processor
    time."""
    ns = own.clock / COUNT * 1e9
    return (
        f"{ns.min():.1f}",
        f"{np.median(ns):.1f}",
        f"{own.clock.min() / first.clock.min():.2f}",
        f"{np.median(own.clock / first.clock):.2f}",
        f"{own.processor.min() / first.processor.min():.2f}",
        f"{np.median(own.processor / first.processor):.2f}",
    )


HEADS = ("ns, least", "median", "× sin + cos, least", "median", "× by processor time, least", "median")


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


def rivals() -> None:
    """Seconds of the same million by others."""
    few = 2000
    calls = {"scipy, fsolve step by step (positions)": (fsolve_steps(few), few)}
    try:
        calls["pylinkage, step_fast_with_kinematics"] = (pylinkage_steps(COUNT), COUNT)
    except ImportError:
        print("(pylinkage is not installed: its row is left out)\n")
    rows = [(name, f"{best_in_turn({'': call}, 3)[''] / n * 1e9:,.0f}") for name, (call, n) in calls.items()]
    print_table(("others, angles in order", "ns each"), rows)


def main() -> None:
    print(f"{machine()}; 25 rounds, all calls in turn\n")
    for order, angles in {
        "random order": np.random.default_rng(0).uniform(-180, 180, COUNT),
        "in order": np.arange(COUNT) * (360.0 / COUNT) - 180.0,
    }.items():
        found = rounds_in_turn({**ours(angles), **least_calls(angles)})
        bare = found["np.sin and np.cos of the angles"]
        rows = [(name, *beside(bare, own)) for name, own in found.items()]
        print_table((f"{COUNT:,} configurations, angles {order}", *HEADS), rows)
    bare = "np.sin and np.cos of the angles"
    found = rounds_in_turn({bare: ours(angles)[bare], **tried(angles)}, 15)
    rows = [(name, *beside(found[bare], own)) for name, own in found.items()]
    print_table(("tried: solve, six outputs, angles in order", *HEADS), rows)
    rivals()
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
