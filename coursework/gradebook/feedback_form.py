"""Options of the feedback: its formats, and whether it includes the worked solutions."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from typing import NamedTuple

from coursework.errors import BadInput
from coursework.issuing.issued import Issued

FORMATS = ("pdf", "html", "ipynb")


class FeedbackForm(NamedTuple):
    """Options of the feedback: its formats, whether the worked solutions are requested, and the current
    day."""

    formats: Sequence[str] = ("pdf",)
    solutions: bool = False
    today: datetime.date | None = None  #: today, unless stated


USUAL = FeedbackForm()


def shows_solutions(issued: Issued, form: FeedbackForm) -> bool:
    """Return True if feedback includes the worked solutions: if they are requested, or if the assignment
    states a day ``solutions_after`` that has come; never before that day.

    Raises
    ------
    BadInput
        They are wanted, and the assignment keeps them back.
    """
    stated = issued.assignment or {}
    if stated.get("answers") == "never":
        if form.solutions:
            raise BadInput('the assignment never shows its answers (answers = "never"), nor its solutions')
        return False
    if not (after := str(stated.get("solutions_after") or "")):
        return form.solutions
    try:
        is_time = (form.today or datetime.date.today()) >= datetime.date.fromisoformat(after)
    except ValueError:
        raise BadInput(
            "the assignment in issued.json: solutions_after is a day such as 2026-12-04; found {found!r}",
            found=after,
        ) from None
    if form.solutions and not is_time:
        raise BadInput(
            "the assignment does not show its solutions before {after} (solutions_after)", after=after
        )
    return is_time
