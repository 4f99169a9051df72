"""Mechanisms stated as files, for tests: those that come with the package."""

from functools import cache

from coursework import open_course
from coursework.authoring.linkage_files import LINKAGES as FOLDER

NAMES = tuple(sorted(p.stem for p in (FOLDER / "exercises").glob("*.toml") if p.stem != "course"))


@cache
def course():
    return open_course(FOLDER)
