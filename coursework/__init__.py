"""Parameterised exercises in plane-mechanism kinematics: drawn, solved, printed and marked.

>>> import coursework
>>> course = coursework.open_course()
>>> variant = course["slotted_mechanism"].variant(seed=42)
>>> marking = variant.grade({"rA": "319,8 mm"})
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from coursework.system.distribution import VERSION

if TYPE_CHECKING:
    from coursework.api import Variant, mechanisms, mistakes, open_course, show_motion, study, worked
    from coursework.course.course import Course
    from coursework.errors import CannotAssemble, CourseworkError, NoSolution, Undefined, UnknownName
    from coursework.selfstudy.lessons import compare, plot

__version__ = VERSION
__all__ = [
    "CannotAssemble",
    "Course",
    "CourseworkError",
    "NoSolution",
    "Undefined",
    "UnknownName",
    "Variant",
    "compare",
    "mechanisms",
    "mistakes",
    "open_course",
    "plot",
    "show_motion",
    "study",
    "worked",
]


_HOMES = {
    "Course": "course.course",
    "Variant": "api",
    "compare": "selfstudy.lessons",
    "mechanisms": "api",
    "mistakes": "api",
    "open_course": "api",
    "plot": "selfstudy.lessons",
    "show_motion": "api",
    "study": "api",
    "worked": "api",
}


def __getattr__(name: str) -> object:
    # Loaded on first use, so that the command line answers at once.
    if name not in __all__:
        raise AttributeError(f"module 'coursework' has no attribute {name!r}")
    return getattr(import_module(f"coursework.{_HOMES.get(name, 'errors')}"), name)
