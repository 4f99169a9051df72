"""Freeze what the seeds of the built-in course draw: ``python tests/golden.py``.

Run it when an exercise is added or its version is raised, never to make a test pass: a seed that
draws something else breaks every sheet that was issued with it.
"""

from __future__ import annotations

import json
from pathlib import Path

import coursework

FILE = Path(__file__).with_suffix(".json")
SEEDS = (0, 1, 2, 3, 42, 2024, 123456789, 2**40)


def drawn(exercise) -> dict:
    """What the file has of one exercise."""
    variants = exercise.variants(SEEDS)
    return {"version": exercise.version, "given": {str(v.seed): dict(v.given) for v in variants}}


def written(frozen) -> str:
    """The text of the file: a line for each seed."""
    exercises = []
    for name, content in frozen.items():
        rows = ",\n".join(
            f"   {json.dumps(seed)}: {json.dumps(row)}" for seed, row in content["given"].items()
        )
        exercises.append(f' "{name}": {{"version": {content["version"]}, "given": {{\n{rows}}}}}')
    return "{\n" + ",\n".join(exercises) + "\n}\n"


if __name__ == "__main__":
    course = coursework.open_course()
    FILE.write_text(written({name: drawn(course[name]) for name in course.names}), "utf-8")
