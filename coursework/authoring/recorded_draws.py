"""Recorded draws of a students' copy: the candidate that is the variant of each seed, in a file beside the
exercise.

An exercise that is kept by its solution cannot choose its variants without it. ``NAME.draws`` holds, for the first
seeds in order, the place of the one that is chosen: no condition, and nothing of an answer. Written by
``python -m coursework.authoring.recorded_draws [NAME…]`` after a condition or a range has changed.
"""

from __future__ import annotations

import sys
import textwrap
from pathlib import Path
from typing import Any

from coursework.course import draws
from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.folder import course_folder
from coursework.course.variant import Variant
from coursework.system.writing import write_whole

SEEDS = 1000  #: that are recorded


def path_of(exercise: CourseExercise[Any]) -> Path:
    """Return the path of an exercise's recorded draws."""
    home = exercise.folder.home("exercises", exercise.name)
    assert home is not None, f"{exercise.name} has a file"
    return home.with_name(f"{exercise.name}.draws")


def recorded(exercise: CourseExercise[Any]) -> str:
    """Return the content of the file."""
    places = draws.places(exercise.name, exercise.drawing, range(SEEDS))
    return textwrap.fill(" ".join(map(str, places)), 120) + "\n"


def fault(exercise: CourseExercise[Any]) -> str:
    """Return the fault of an exercise's record; an empty text where it is right, or where none is needed."""
    path = path_of(exercise)
    if not exercise.spec.kept_by_solution:
        return f"{path} is not read: the exercise draws by itself" if path.exists() else ""
    content = path.read_text("ascii") if path.is_file() else ""
    if content == recorded(exercise):
        return ""
    why = "is out of date" if content else "is missing"
    return f"{path} {why}; write it: python -m coursework.authoring.recorded_draws {exercise.name}"


def main(names: list[str]) -> None:
    """Write the records of exercises of the built-in course, or of those that are named."""
    course = Course(course_folder(None), variant=Variant)
    for name in names or course.names:
        if course[name].spec.kept_by_solution:
            write_whole(path_of(course[name]), recorded(course[name]).encode("ascii"))


if __name__ == "__main__":
    main(sys.argv[1:])
