"""A scene that calls for less runs less: quantities evaluated and time, effect by effect.

python benchmarks/scenes.py
"""

from __future__ import annotations

from timing import best_in_turn, machine, print_table

import coursework
from coursework.motion.scenes import Scene

CASES = {
    "slider_crank_torque": (
        ("position",),
        ("position", "velocity"),
        ("position", "velocity", "acceleration"),
        ("load",),
        ("gravity",),
        ("load", "friction"),
        ("inertia",),
        ("load", "gravity", "inertia"),
        ("load", "gravity", "inertia", "friction"),
    ),
    "slotted_mechanism": (
        ("position",),
        ("velocity",),
        ("coriolis",),
        ("acceleration",),
        ("position", "velocity", "acceleration", "coriolis"),
    ),
}
STEPS = 20_000


def main() -> None:
    print(f"{machine()}; a turn in {STEPS:,} steps, best of 15 rounds, all scenes in turn\n")
    for name, cases in CASES.items():
        exercise = coursework.open_course()[name]
        given = exercise.variant(0).used
        scenes = {" + ".join(effects): Scene(exercise, given, effects) for effects in cases}
        times = best_in_turn({n: (lambda s=s: s.over_cycle(STEPS)) for n, s in scenes.items()})
        most = max(times.values())
        rows = [
            (
                n,
                str(len(s.over_cycle(4).evaluated)),
                f"{times[n] / STEPS * 1e9:.0f}",
                f"{times[n] / most:.2f}",
            )
            for n, s in scenes.items()
        ]
        print_table((name, "quantities evaluated", "ns a step", "× the dearest"), rows)


if __name__ == "__main__":
    main()
