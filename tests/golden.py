"""Freeze what the seeds of the built-in course draw: ``python tests/golden.py``.

Run it when an exercise is added or its version is raised, never to make a test pass: a seed that
draws something else breaks every sheet that was issued with it.
"""

from __future__ import annotations

import json
from pathlib import Path

import coursework

FOLDER = Path(__file__).parent / "golden"
SEEDS = (0, 1, 2, 3, 42, 2024, 123456789, 2**40)


def drawn(exercise) -> dict:
    """What the file of one exercise holds."""
    variants = exercise.variants(SEEDS)
    return {
        "exercise": exercise.name,
        "version": exercise.version,
        "given": {str(v.seed): dict(v.given) for v in variants},
    }


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    course = coursework.open_course()
    for name in course.names:
        text = json.dumps(drawn(course[name]), indent=1)
        (FOLDER / f"{name}.json").write_text(text + "\n", "utf-8")
