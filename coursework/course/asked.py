"""Attributes of a variant that an answer key reads."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from coursework.course.exercise import CourseExercise
from coursework.model import Part


class KeySource(Protocol):
    """Some parts of an exercise, asked with given values."""

    @property
    def exercise(self) -> CourseExercise[Any]: ...

    @property
    def parts(self) -> tuple[Part, ...]: ...

    @property
    def given(self) -> Mapping[str, Any]:
        """All the given quantities."""

    @property
    def used(self) -> Mapping[str, Any]:
        """The given quantities that the solution knows, in canonical units."""

    @property
    def effects(self) -> tuple[str, ...]: ...

    @property
    def asked_quantities(self) -> tuple[str, ...]:
        """The quantities of the parts, and those that parts are judged with; none of what a person marks."""

    def solution(self) -> dict[str, Any]:
        """Return the asked quantities in canonical units and full precision."""
