"""New course folders and new exercises, copied from a small one that works."""

from __future__ import annotations

import keyword
import re
from pathlib import Path

from coursework.errors import BadInput
from coursework.system.writing import write_whole

SKELETON = Path(__file__).parent / "skeleton"
FIRST_EXERCISE = "crank_pin"


def new_course(folder: Path) -> list[Path]:
    """Write a course with one small exercise; gives the files written.

    Raises
    ------
    BadInput
        The folder holds something already.
    """
    if folder.exists() and any(folder.iterdir()):
        raise BadInput(
            f"{folder} is not empty; name a new folder, or add an exercise: coursework new {folder} NAME"
        )
    return [*_copy_course_files(folder), *new_exercise(folder, FIRST_EXERCISE)]


def _copy_course_files(folder: Path) -> list[Path]:
    (folder / "templates").mkdir(parents=True, exist_ok=True)
    target = folder / "exercises" / "course.toml"
    write_whole(target, (SKELETON / "exercises" / "course.toml").read_bytes())
    return [target]


def new_exercise(folder: Path, name: str) -> list[Path]:
    """Write a working exercise into a course folder, which is made if need be; gives the files written.

    Raises
    ------
    BadInput
        The name cannot be a Python module's, or the exercise exists.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name):
        raise BadInput(
            f"{name!r} cannot name an exercise; use small letters, digits and underscores: crank_pin"
        )
    written = [] if (folder / "exercises").is_dir() else _copy_course_files(folder)
    sources = sorted(p for p in SKELETON.rglob("EXERCISE.*") if p.suffix != ".pyc")
    targets = [folder / s.parent.name / s.name.replace("EXERCISE", name, 1) for s in sources]
    for target in targets:
        if target.exists():
            raise BadInput(f"{target} exists already; choose another name")
    for source, target in zip(sources, targets, strict=True):
        write_whole(target, source.read_bytes())
    return [*written, *targets]
