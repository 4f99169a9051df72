"""Feedback on submissions: the sheets that ``grade`` prints, as far as the publication releases them."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from coursework.database.assignments import issued_content
from coursework.database.current_marks import adjusted_sheets
from coursework.database.marking import mark_submission
from coursework.database.submissions import Submission, drawings_of
from coursework.figures import Figure
from coursework.gradebook.feedback_form import FeedbackForm, shows_solutions
from coursework.gradebook.feedback_sheets import FeedbackOptions, feedback_paper
from coursework.gradebook.scale import mark_of
from coursework.issuing.issued import Issued
from coursework.language.numbers import localise
from coursework.rendering.surface import drawn_figure
from coursework.rendering.views import points_number
from coursework.sheets.paper import FeedbackPaper
from coursework.site.frame.requests import Request
from coursework.site.frame.times import length_text
from coursework.site.papers.assignment_state import AssignmentState
from coursework.site.papers.student_paper import StudentPaper


def feedback_of(
    request: Request, state: AssignmentState, paper: StudentPaper, chosen: Submission
) -> tuple[FeedbackPaper, list[str]]:
    """Return the feedback on a submission, and the notes above it: for a late one, the penalty."""
    mark_submission(request.site.course, request.site.store, chosen.id)
    with request.site.store.reading() as connection:
        _, adjustments, sheets = adjusted_sheets(
            connection, state.assignment.id, paper.student, request.site.course
        )
        content = issued_content(connection, state.assignment.id, request.user.id)
    issued = adjustments.on(Issued(_allowed(content, state), state.assignment.name))
    sheets = [sheet for sheet in sheets if sheet.sitting == chosen.number]
    telling = FeedbackOptions(solutions=_shows_solutions(issued, state))
    document = feedback_paper(
        request.site.course, issued, paper.student, sheets, request.lang, telling=telling
    )
    return document, _charged(request, state, issued, document, chosen)


def drawings_in(
    request: Request, state: AssignmentState, paper: StudentPaper, chosen: Submission
) -> list[tuple[str, Figure]]:
    """Return the student's drawings of a submission, each with the title of its exercise."""
    if not paper.drawn:
        return []
    with request.site.store.reading() as connection:
        texts = drawings_of(connection, state.assignment.id, paper.student)
    drawn = (
        (v.exercise.title(v.lang), drawn_figure(texts, chosen.number, v.handout())) for v in paper.variants
    )
    return [(title, figure) for title, figure in drawn if figure is not None]


def _allowed(content: dict[str, Any], state: AssignmentState) -> dict[str, Any]:
    """Return the issued content, without the right answers before their release."""
    stated = content.get("assignment") or {"name": state.assignment.name, "exercises": _exercises(content)}
    if not state.releases("answers"):
        stated = {**stated, "answers": "never"}
    return {**content, "assignment": stated}


def _exercises(content: dict[str, Any]) -> list[str]:
    return list(dict.fromkeys(str(item["record"]["exercise"]) for item in content["issued"]))


def _shows_solutions(issued: Issued, state: AssignmentState) -> bool:
    """Return True if the worked solutions are released: with the right answers, and not before the day that
    the assignment states."""
    stated = issued.assignment or {}
    if not state.releases("answers") or stated.get("answers") == "never":
        return False
    today = state.now.astimezone().date()
    return not stated.get("solutions_after") or shows_solutions(issued, FeedbackForm(today=today))


def _charged(
    request: Request, state: AssignmentState, issued: Issued, document: FeedbackPaper, chosen: Submission
) -> list[str]:
    """Return notes on the penalty for lateness, which is separate from the marks of the answers."""
    if not chosen.late:
        return []
    messages = request.words["assignments"]
    late = length_text(timedelta(seconds=chosen.late), request.lang)
    share = state.assignment.own_publication.charged(
        min(chosen.late, state.assignment.own_publication.late_seconds(chosen.received_at))
    )
    if not share:
        return [messages["was_late"].format(late)]
    left = round(document.points * (1 - share), 9)
    points, out_of = points_number(left, request.lang), points_number(document.out_of, request.lang)
    notes = [messages["was_charged"].format(late, charged_text(share, request.lang), points, out_of)]
    if mark := mark_of(issued, left, document.out_of):
        notes.append(messages["charged_mark"].format(localise(mark, request.lang)))
    return notes


def charged_text(share: float, lang: str) -> str:
    """Return a share as a number of percent, without the sign: ``10`` for 0.1."""
    return points_number(100 * share, lang)
