"""States of sheets and pages: digests of everything on which they depend. An equal state gives an equal
result."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

from coursework.course.course import Course
from coursework.course.marking_rules import Rules
from coursework.course.sources import sources

_PACKAGE = Path(__file__).parent.parent
#: Folders and files of the package that affect marks.
ENGINE = (
    "messages.py errors.py degrees.py language system kinematics markup figures structure mechanics "
    "parsing quantities "
    "kinds model.py solution.py course marking gradebook/class_marking.py"
).split()

_TEMPLATES = "/templates"  #: no exercise is called so
_known: WeakKeyDictionary[Course, dict[str, str]] = WeakKeyDictionary()


def exercise_state(course: Course, exercise: str) -> str:
    """Return the digest of all files that affect an exercise's marks, as they were at the first call for the
    open course.

    Asked before the exercise is loaded, it is never of a later state than what marks.
    """
    states = _known.setdefault(course, {})
    if exercise not in states:
        root = course.folder.root
        states[exercise] = _of_files(root, sources(course.folder, exercise)) if exercise in course else ""
    return states[exercise]


@cache
def engine_state() -> str:
    """Return the digest of the package's own files that affect marks."""
    paths = [_PACKAGE / name for name in ENGINE]
    files = (p for path in paths for p in ([path] if path.is_file() else path.rglob("*")))
    return _of_files(_PACKAGE, (p for p in files if p.suffix in (".py", ".toml")))


def page_state(course: Course, exercises: Iterable[str], *given: Any) -> str:
    """Return the digest of everything on which the page of a paper depends: the given values, its exercises,
    the templates and the whole package."""
    how = (
        package_state(),
        _templates_state(course),
        *(exercise_state(course, exercise) for exercise in exercises),
    )
    return sha256("\0".join((*how, json.dumps(given, sort_keys=True))).encode()).hexdigest()


@cache
def package_state() -> str:
    """Return the digest of all of the package's own files."""
    return _of_files(_PACKAGE, (p for p in _PACKAGE.rglob("*") if p.suffix in (".py", ".toml")))


def _templates_state(course: Course) -> str:
    """Return the digest of a course's templates and settings, as they were at the first call for the open
    course."""
    states = _known.setdefault(course, {})
    if _TEMPLATES not in states:
        folder = course.folder
        settings = folder.root / "exercises" / "course.toml"
        digests = [_of_files(folder.root, [settings] if settings.is_file() else [])]
        digests += [
            _of_files(directory, directory.rglob("*.j2"))
            for directory in folder.template_folders
            if directory.is_dir()
        ]
        states[_TEMPLATES] = "\0".join(digests)
    return states[_TEMPLATES]


def _of_files(root: Path, files: Iterable[Path]) -> str:
    digest = sha256()
    for path in sorted(files):
        content = path.read_bytes()
        digest.update(f"{path.relative_to(root).as_posix()}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()


def sheet_state(
    course: Course, rules: Rules | None, record: Mapping[str, Any], answers: Mapping[str, Any], *more: Any
) -> str:
    """Return the digest of everything on which the marks of a sheet depend."""
    exercise = str(record["exercise"])
    how = engine_state(), exercise_state(course, exercise), repr(rules or course.folder.rules)
    state = json.dumps([record, list(answers.items()), *more], default=repr)
    return sha256("\0".join((*how, state)).encode()).hexdigest()
