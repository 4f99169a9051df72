"""How far sweeps go: a few of each always, the rest where every test runs."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Collection, Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

slow = pytest.mark.slow

#: Of the exercises, one of each sort: lengths and angles, a motion, solids, counts, a drawing.
HANDFUL = ("slotted_mechanism", "four_bar_motion", "parallel_joints", "mobility", "velocity_polygon")


def sampled(values: Iterable[Any], few: Collection[Any] = HANDFUL) -> list[Any]:
    """The values of a parameter in their order; all but the few are slow."""
    return [value if value in few else pytest.param(value, marks=slow) for value in values]


def seeds(few: int, every: int) -> pytest.MarkDecorator:
    """Seeds from 0 on in two blocks: the first few, and the others, slow."""
    blocks = [range(few), pytest.param(range(few, every), marks=slow)]
    return pytest.mark.parametrize("seeds", blocks, ids=["few", "many"])


_MANY = 20  #: exercises from which on a test is a sweep over the course


def mark_sweeps(items: Iterable[pytest.Item], names: Collection[str]) -> None:
    """Mark as ``sweep`` the items of tests over most exercises, except a handful of exercises and those that
    differ."""
    tests: dict[str, list[tuple[pytest.Item, str]]] = {}
    for item in items:
        values = item.callspec.params.values() if hasattr(item, "callspec") else ()
        exercise = next((value for value in values if isinstance(value, str) and value in names), None)
        if exercise is not None:
            tests.setdefault(item.nodeid.partition("[")[0], []).append((item, exercise))
    for found in tests.values():
        if len({exercise for _, exercise in found}) < _MANY:
            continue
        for item, exercise in found:
            if exercise not in HANDFUL and exercise not in changed_exercises():
                item.add_marker(pytest.mark.sweep)


@cache
def changed_exercises() -> frozenset[str]:
    """Return the stems of the files in exercises/ and solutions/ that differ from the main branch.

    Without git or a main branch there are none. On the main branch itself, its upstream is what they are
    compared with.
    """
    root = Path(__file__).resolve().parent.parent
    for base in ("origin/main", "main"):
        fork = _git(root, "merge-base", base, "HEAD")
        if fork:
            files = _git(root, "diff", "--name-only", fork[0], "--", "exercises", "solutions")
            added = _git(root, "ls-files", "--others", "--exclude-standard", "exercises", "solutions")
            return frozenset(Path(file).name.partition(".")[0] for file in (*files, *added))
    return frozenset()


def _git(root: Path, *arguments: str) -> list[str]:
    try:
        done = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=False)
    except OSError:
        return []
    return done.stdout.splitlines() if done.returncode == 0 else []


def at_once(names: Collection[str], few: Collection[str] = HANDFUL) -> pytest.MarkDecorator:
    """The exercises of a test that goes over ``names`` at once: a few and those that differ always; all of
    them as a sweep."""
    always = [name for name in names if name in few or name in changed_exercises()]
    blocks = [always, pytest.param(list(names), marks=pytest.mark.sweep)]
    return pytest.mark.parametrize("names", blocks, ids=["few", "all"])


#: A test that goes over the whole course at once: a sweep, unless an exercise differs from the main branch.
whole_course: Callable[[Any], Any] = (lambda test: test) if changed_exercises() else pytest.mark.sweep
