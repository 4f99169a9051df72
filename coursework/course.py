"""A course is a folder: ``exercises/``, ``solutions/``, ``templates/`` side by side.

Nothing is registered: the stem of ``exercises/NAME.py`` is the exercise's name everywhere. Opening a
course imports its Python, as any import does, under a private package name; ``sys.path`` is left alone.
"""

from __future__ import annotations

import importlib
import itertools
import sys
import tomllib
import traceback
from collections.abc import Iterator, Mapping
from functools import cache, cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from coursework.builtin import builtin_root
from coursework.errors import BadCourse, CourseworkError, unknown
from coursework.exercise import CourseExercise
from coursework.rules import Rules

if TYPE_CHECKING:
    from coursework.rendering import Renderer

_packages = itertools.count()


def open_course(folder: str | Path | None = None) -> Course:
    """Open a course folder; the built-in course unless told.

    Raises
    ------
    BadCourse
        The folder does not exist or has no ``exercises/``.
    """
    root = (builtin_root() if folder is None else Path(folder)).resolve()
    return _open(root)


@cache
def _open(root: Path) -> Course:
    if not root.is_dir():
        raise BadCourse(f"no course at {root}: there is no such folder; 'coursework new DIR' makes one")
    if not (root / "exercises").is_dir():
        raise BadCourse(f"{root} is no course: it has no folder 'exercises'; 'coursework new DIR' makes one")
    return Course(root)


class Course:
    """An open course: a mapping from names to exercises."""

    def __init__(self, root: Path):
        self.root = root
        self._package = f"_coursework_course_{next(_packages)}"
        package = ModuleType(self._package)
        package.__path__ = [str(root)]
        sys.modules[self._package] = package
        self._exercises: dict[str, CourseExercise] = {}

    def __repr__(self) -> str:
        return f"<course {self.root.name}: {len(self.names)} exercises>"

    def __reduce__(self) -> tuple[Any, ...]:
        """In another process the course is opened there."""
        return open_course, (str(self.root),)

    @property
    def label(self) -> str:
        """What messages call it."""
        return "the built-in course" if self.root == builtin_root().resolve() else f"course {self.root.name}"

    @property
    def names(self) -> tuple[str, ...]:
        """The exercises' names, in alphabetical order, as the folder holds them now."""
        folder = self.root / "exercises"
        files = {p.stem for p in folder.glob("*.py")}
        folders = {p.parent.name for p in folder.glob("*/__init__.py")}
        return tuple(sorted(n for n in files | folders if n.isidentifier() and not n.startswith("_")))

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> CourseExercise:
        if name not in self._exercises:
            if name not in self.names:
                raise unknown("exercise", name, self.names, self.label)
            self._exercises[name] = CourseExercise(self, name)
        return self._exercises[name]

    @cached_property
    def settings(self) -> Mapping[str, Any]:
        """What ``exercises/course.toml`` says, or nothing."""
        path = self.root / "exercises" / "course.toml"
        if not path.exists():
            return {}
        try:
            return tomllib.loads(path.read_text("utf-8-sig"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as fault:
            raise BadCourse(f"{path}: {fault}") from fault

    @cached_property
    def rules(self) -> Rules:
        """How the course marks."""
        source = str(self.root / "exercises" / "course.toml")
        return Rules.of(self.settings.get("marking", {}), source)

    def title(self, lang: str) -> str:
        """The course's title in a language; the folder's name when it states none."""
        return str(self._titles(lang).get(lang, self.root.name))

    def lacks_title(self, lang: str) -> bool:
        """Whether the course states its title in other languages than this one alone."""
        titles = self._titles(lang)
        return bool(titles) and lang not in titles

    def _titles(self, lang: str) -> Mapping[str, Any]:
        titles = self.settings.get("title", {})
        if not isinstance(titles, dict):
            raise BadCourse(f'{self.root / "exercises" / "course.toml"}: write [title], then {lang} = "…"')
        return titles

    @cached_property
    def template_folders(self) -> tuple[Path, ...]:
        """Where templates are looked up: this course first, then the built-in one."""
        folders = dict.fromkeys([self.root / "templates", builtin_root() / "templates"])
        return tuple(f for f in folders if f.is_dir())

    @cached_property
    def renderer(self) -> Renderer:
        """Renders this course's sheets."""
        from coursework.rendering import Renderer

        return Renderer(self.template_folders)

    @property
    def lessons(self) -> tuple[str, ...]:
        """Names of the lessons, ``exercises/lessons/NAME.LANG.md``, in alphabetical order."""
        return tuple(sorted({p.name.split(".")[0] for p in self._lesson_folder.glob("*.*.md")}))

    @property
    def _lesson_folder(self) -> Path:
        return self.root / "exercises" / "lessons"

    def lesson(self, name: str, lang: str) -> str:
        """A lesson as a notebook (JSON).

        Raises
        ------
        UnknownName
            No such lesson.
        BadCourse
            The lesson is not written in this language.
        """
        if name not in self.lessons:
            raise unknown("lesson", name, self.lessons, self.label)
        path = self._lesson_folder / f"{name}.{lang}.md"
        if not path.exists():
            raise BadCourse(f"the lesson {name} has no text in {lang!r}: {path.name} is missing")
        return self.renderer.lesson(name, path.read_text("utf-8"), lang)

    @property
    def has_solutions(self) -> bool:
        """False for a students' copy."""
        return (self.root / "solutions").is_dir()

    def module(self, kind: str, name: str) -> ModuleType:
        """Import ``KIND/NAME.py`` of this course.

        Raises
        ------
        BadCourse
            The file cannot be imported; the message names the file, the line and the fault.
        """
        try:
            return importlib.import_module(f"{self._package}.{kind}.{name}")
        except CourseworkError as fault:
            raise BadCourse(f"{kind}/{name}.py: {fault}") from fault
        except Exception as fault:
            raise BadCourse(f"{kind}/{name}.py cannot be used: {_where(fault, self.root)}") from fault


def _where(fault: Exception, root: Path) -> str:
    """The fault in one line, with the last line of the course's own code on its way."""
    said = f"{type(fault).__name__}: {fault}"
    if isinstance(fault, SyntaxError):
        return f"line {fault.lineno}: {fault.msg}"
    frames = [f for f in traceback.extract_tb(fault.__traceback__) if f.filename.startswith(str(root))]
    return f"line {frames[-1].lineno}: {said}" if frames else said
