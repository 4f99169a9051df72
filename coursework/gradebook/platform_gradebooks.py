"""Formats of the platforms' gradebooks: titles of columns of marks, and their maxima."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from coursework.errors import unknown
from coursework.issuing.identity import FIRST_NAME, SURNAME, WHOLE, identifies, is_called, plain


class PlatformGradebook(NamedTuple):
    """Format of a platform's table of marks."""

    name: str
    title_of_platform: str  #: as people call it
    title: str  #: a pattern of a column's title with ``item`` in it, and ``most`` where it tells the maximum
    download: str  #: how its export is had
    special_marks: tuple[str, ...] = ()  #: contents of cells that are not marks and stay unchanged
    maxima: str = ""  #: what a line of maxima begins with
    decimal: str = ""  #: the decimal sign that it reads in every language; empty where it is that of the file

    def item_in(self, title: str) -> str:
        """Return the item's name in a column's title."""
        match = re.fullmatch(self.title, title.strip())
        return match["item"].strip() if match else title.strip()

    def most_in(self, title: str) -> str:
        """Return the maximum in a column's title; empty if it states none."""
        match = re.fullmatch(self.title, title.strip())
        return (match.groupdict().get("most") or "") if match else ""


PLATFORMS = {
    one.name: one
    for one in (
        # A point is read by Moodle in every language, a comma only where the language has it.
        PlatformGradebook(
            "moodle",
            "Moodle",
            r"(?:[^:()]{1,30}?\s?:\s)?(?P<item>.*?)(?:\s\([^()]+\))?",
            "Grades, Export, Plain text file",
            decimal=".",
        ),
        PlatformGradebook(
            "canvas",
            "Canvas",
            r"(?P<item>.*?)(?:\s\([0-9]+\))?",
            "Grades, Export, Export Entire Gradebook",
            ("EX",),
            "points possible",
            ".",
        ),
        PlatformGradebook(
            "blackboard",
            "Blackboard",
            r"(?P<item>.*?)(?:\s\[[^\[\]|]*?:\s*(?P<most>[0-9.,]+)[^\[\]|]*\])?\s*(?:\|[0-9]+)?",
            "Grade Center, Work Offline, Download",
        ),
        PlatformGradebook(
            "sakai",
            "Sakai",
            r"(?P<item>.*?)(?:\s\[(?P<most>[0-9.,]+)\])?",
            "Gradebook, Import/Export, Export",
        ),
    )
}


def platform_gradebook(name: str) -> PlatformGradebook:
    """Return the gradebook format of a platform.

    Raises
    ------
    UnknownName
        There is none of that name.
    """
    if name not in PLATFORMS:
        raise unknown("platform", name, PLATFORMS)
    return PLATFORMS[name]


class People(NamedTuple):
    """Columns of a table of marks that identify a student."""

    names: tuple[int, ...]  #: first name before surname
    ids: tuple[int, ...]

    @property
    def last(self) -> int:
        return max((*self.names, *self.ids), default=-1)


def people_in(header: Sequence[str]) -> People:
    """Return the columns that identify a student."""
    full_names = [k for k, title in enumerate(header) if plain(title) in WHOLE]
    apart = [k for k, title in enumerate(header) if is_called(title, (*FIRST_NAME, *SURNAME))]
    names = (
        tuple(full_names[:1]) or tuple(sorted(apart, key=lambda k: not is_called(header[k], FIRST_NAME)))[:2]
    )
    return People(names, tuple(k for k, title in enumerate(header) if identifies(title) and k not in names))
