"""Release of an assignment's content: the paper once it opens, marks once they are released."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from sqlalchemy import Connection

from coursework.database.permissions import Permission
from coursework.database.publication import Phase, student_assignments
from coursework.site.frame.requests import Request
from coursework.site.papers.assignment_state import state_of


class Release(NamedTuple):
    """Released content of an assignment."""

    paper: bool = True
    marks: bool = True


def full_release(number: int) -> Release:
    """Return the content that staff may see: all of it."""
    return Release()


def release_to(connection: Connection, request: Request) -> Callable[[int], Release]:
    """Return the function that gives the released content of an assignment to the current user; nothing of an
    unpublished one."""
    if request.user.may(Permission.ASSIGNMENTS_READ):
        return full_release
    states = [
        state_of(request, item, connection)
        for item in student_assignments(connection, request.user.id)
        if item.publication
    ]
    # A mark's sentence may say what is right.
    releases = {
        item.assignment.id: Release(
            item.phase is not Phase.TO_COME, item.releases("feedback") and item.releases("answers")
        )
        for item in states
    }
    return lambda number: releases.get(number, Release(False, False))
