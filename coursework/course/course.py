"""An open course: a mapping from names to exercises."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, Generic, TypeVar

from coursework.course.builtin import builtin_root
from coursework.course.exercise import CourseExercise
from coursework.course.folder import Folder, course_folder
from coursework.course.variant import Variant
from coursework.errors import unknown

V = TypeVar("V", bound=Variant)


def opened(folder: str | Path | None, variant: Callable[..., V]) -> Course[V]:
    """Open a course folder, the built-in course where there is none; its variants are of this class.

    Raises
    ------
    BadCourse
        The folder does not exist or has no ``exercises/``.
    """
    return _opened((builtin_root() if folder is None else Path(folder)).resolve(), variant)


@cache
def _opened(root: Path, variant: Callable[..., V]) -> Course[V]:
    return Course(course_folder(root), variant)


class Course(Generic[V]):
    """An open course: a mapping from names to exercises, whose variants are of one class."""

    def __init__(self, folder: Folder, variant: Callable[..., V]):
        self.folder = folder
        self._variant = variant
        self._exercises: dict[str, CourseExercise[V]] = {}

    def __repr__(self) -> str:
        return f"<course {self.folder.root.name}: {len(self.names)} exercises>"

    def __reduce__(self) -> tuple[Any, ...]:
        """In another process the course is opened there."""
        return opened, (str(self.folder.root), self._variant)

    @property
    def names(self) -> tuple[str, ...]:
        """The exercises' names, in alphabetical order, as the folder holds them now."""
        return self.folder.names

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and self.folder.home("exercises", name) is not None

    def __getitem__(self, name: str) -> CourseExercise[V]:
        if name not in self._exercises:
            if name not in self.names:
                raise unknown("exercise", name, self.names, self.folder.label)
            self._exercises[name] = CourseExercise(name, self.folder, self, self._variant)
        return self._exercises[name]
