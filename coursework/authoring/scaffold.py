"""New course folders and new exercises, copied from a small one that works."""

from __future__ import annotations

import keyword
import re
from collections.abc import Collection, Mapping
from pathlib import Path

from coursework.course.folder import course_folder
from coursework.errors import BadInput
from coursework.language.environment import language_of
from coursework.language.words import languages
from coursework.system.folder_lock import is_bare
from coursework.system.writing import write_whole

SKELETON = Path(__file__).parent / "skeleton"
FIRST_EXERCISE = "crank_pin"


def languages_around(environment: Mapping[str, str]) -> tuple[str, ...]:
    """Return the languages of a new course: the environment's where the engine speaks it, else all."""
    around = language_of(environment)
    return (around,) if around in languages() else languages()


def new_course(folder: Path, langs: Collection[str] | None = None) -> list[Path]:
    """Write a course with one small exercise; gives the files written. By default it has every language.

    Raises
    ------
    BadInput
        The folder holds something already.
    """
    if not is_bare(folder):
        raise BadInput(
            "{folder} is not empty; name a new folder, or add an exercise: coursework new {folder} NAME",
            folder=folder,
        )
    return new_exercise(folder, FIRST_EXERCISE, langs)


def _write_course_files(folder: Path, langs: Collection[str]) -> list[Path]:
    (folder / "templates").mkdir(parents=True, exist_ok=True)
    files = course_files(folder, langs)
    for path, content in files.items():
        write_whole(path, content)
    return list(files)


def course_files(folder: Path, langs: Collection[str]) -> dict[Path, bytes]:
    """Return the files of a course in these languages, without its exercises."""
    content = (SKELETON / "exercises" / "course.toml").read_text("utf-8")
    lines = [
        line
        for line in content.splitlines()
        if line[:5] not in {f"{k} = " for k in {*languages()} - {*langs}}
    ]
    if set(langs) != set(languages()):
        named = ", ".join(f'"{lang}"' for lang in langs)
        lines.insert(lines.index("[title]"), f"languages = [{named}]\n")
    return {folder / "exercises" / "course.toml": ("\n".join(lines) + "\n").encode("utf-8")}


def check_name(name: str) -> None:
    """Stop at a name that no exercise can have.

    Raises
    ------
    BadInput
        It cannot be a Python module's.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name):
        raise BadInput(
            "{name!r} cannot name an exercise; use small letters, digits and underscores: crank_pin",
            name=name,
        )


def new_exercise(folder: Path, name: str, langs: Collection[str] | None = None) -> list[Path]:
    """Write a working exercise into a course folder, which is made if need be; gives the files written.

    It has texts in the languages of the course; ``langs`` are those of one that is made, by default all.

    Raises
    ------
    BadInput
        The name cannot be a Python module's, or the exercise exists.
    """
    check_name(name)
    is_course = (folder / "exercises").is_dir()
    spoken = course_folder(folder).languages if is_course else langs or languages()
    written = [] if is_course else _write_course_files(folder, spoken)
    unspoken = tuple(f".{lang}.md.j2" for lang in languages() if lang not in spoken)
    sources = sorted(p for p in SKELETON.rglob("EXERCISE.*") if not p.name.endswith((".pyc", *unspoken)))
    targets = [folder / s.parent.name / s.name.replace("EXERCISE", name, 1) for s in sources]
    for target in targets:
        if target.exists():
            raise BadInput("{target} exists already; choose another name", target=target)
    for source, target in zip(sources, targets, strict=True):
        write_whole(target, source.read_bytes())
    return [*written, *targets]
