"""Budgets of requests: size of a body, concurrent requests of one person, and resources for reading a
file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.system.processes import Exceeded, ResourceLimits, confined

KILOBYTE, MEGABYTE = 1024, 1024 * 1024


class Budget(NamedTuple):
    """Limits of the requests to a page."""

    name: str
    largest: int  #: bytes of a body; the stated length is checked
    fields: int  #: fields of a form
    at_once: int  #: concurrent requests of one person; the others wait
    files: int = 0
    #: Smaller limits in bytes for files with some suffixes.
    by_ending: Mapping[str, int] = MappingProxyType({})
    reading: ResourceLimits | None = None  #: limits of the process in which files are read
    readings: int = 1  #: concurrent readings of this budget in a process of the site


#: Pages without answers: a choice, a name, a password.
PLAIN = Budget("plain", 16 * KILOBYTE, 60, 2)
#: Answers in boxes: as many as a paper has, each of 4000 characters at most.
BOXES = Budget("boxes", 256 * KILOBYTE, 1000, 2)
#: Submission, in its own queue, which no other request of the same person fills.
HAND_IN = Budget("hand_in", 256 * KILOBYTE, 1000, 1)
#: A file of answers. A notebook contains its figures.
ANSWER_FILE = Budget(
    "answer_file",
    2 * MEGABYTE + 4 * KILOBYTE,
    20,
    1,
    1,
    MappingProxyType({".csv": 256 * KILOBYTE, ".json": 256 * KILOBYTE}),
    ResourceLimits(4.0, 192 * MEGABYTE),
    2,
)
#: A file of practice progress.
PROGRESS_FILE = Budget(
    "progress_file",
    MEGABYTE + 4 * KILOBYTE,
    20,
    1,
    1,
    reading=ResourceLimits(4.0, 192 * MEGABYTE),
    readings=2,
)
#: Forms of the staff.
DESK = Budget("desk", 256 * KILOBYTE, 2000, 4)
#: Files of the staff: a class's answers, scans, rosters.
DESK_FILES = Budget(
    "desk_files", 60 * MEGABYTE, 2000, 1, 50, reading=ResourceLimits(60.0, 1024 * MEGABYTE), readings=1
)
DESK_FILE = DESK_FILES._replace(
    name="desk_file", largest=4 * MEGABYTE, reading=ResourceLimits(20.0, 512 * MEGABYTE)
)

#: The text of a mechanism's file, compiled at each change.
MECHANISMS = Budget(
    "mechanisms",
    256 * KILOBYTE,
    300,
    2,
    reading=ResourceLimits(6.0, 384 * MEGABYTE, 0, is_warm=True),
    readings=2,
)

MOST_ROWS = 800  #: of a student's file of answers


def read_apart(budget: Budget, too_much: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Return the result of a function that reads a file, in a process with the budget's resource limits.

    Raises
    ------
    BadInput
        The function raised it, or exceeded its resource limits; the message is then ``too_much``.
    """
    assert budget.reading is not None, f"{budget.name} reads no files"
    try:
        return confined(budget.reading, function, *arguments)
    except Exceeded:
        raise BadInput(too_much) from None
