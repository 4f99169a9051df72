"""Mechanisms stated as files, for tests."""

from functools import cache
from pathlib import Path

from coursework import open_course

FOLDER = Path(__file__).parent / "linkages" / "course"
NAMES = tuple(sorted(p.stem for p in (FOLDER / "exercises").glob("*.toml") if p.stem != "course"))


@cache
def course():
    return open_course(FOLDER)
