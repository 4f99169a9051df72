"""Scores for platforms: the points of the class page, less the penalty for lateness, once they are released;
sent again after each change.

Every change of marks, on the site or from the command line, changes the stamp of the assignment. A thread
compares the stamps every few seconds.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from typing import Any, NamedTuple

from sqlalchemy import Connection

from coursework.course.course import Course
from coursework.database.class_state import ClassState
from coursework.database.current_marks import adjusted_sheets
from coursework.database.instructor_queries import stamp
from coursework.database.publication import last_end, longer_for, published, student_assignments
from coursework.database.settings import put_value, value_of
from coursework.database.submissions import submissions_of
from coursework.errors import CourseworkError
from coursework.gradebook.book import Gradebook, Result, results
from coursework.gradebook.graded_sheet import Graded
from coursework.issuing.questions import PaperQuestions
from coursework.language.words import words
from coursework.platforms.lti.launch import Launch
from coursework.platforms.lti.storage import Score, Storage
from coursework.rendering.feedback import verdict_word
from coursework.rendering.views import points_number
from coursework.site.desk.class_cache import class_now
from coursework.site.frame.settings import Site
from coursework.site.papers.assignment_state import AssignmentState
from coursework.site.papers.submission import pass_dates

LOG = logging.getLogger("coursework.site")
_COMMENT = 900  #: characters of a comment in the gradebook
_PAUSE = 5.0  #: seconds between two checks


class Marked(NamedTuple):
    """Current marks of a student."""

    questions: PaperQuestions
    result: Result
    sheets: Sequence[Graded]  #: of the submission that counts
    waits: bool  #: some answers wait for a person

    def given(self, state: AssignmentState) -> float:
        """Return the points after the penalty for lateness."""
        late = next(
            (submission.late for submission in state.done if submission.number == self.result.sitting), 0
        )
        return round(self.result.points * (1 - state.assignment.own_publication.charged(late)), 9)


def marked_in(now: ClassState, student: str) -> Marked | None:
    """Return the marks of a student from the state of the class; None before the first submission."""
    sheets = [graded for graded in now.graded.values() if graded.student == student]
    return _marked(now.questions, now.results.get(student), sheets)


def marked_of(course: Course[Any], connection: Connection, number: int, student: str) -> Marked | None:
    """Return the marks of one student alone, at a cost that does not depend on the size of the class."""
    issued, adjustments, sheets = adjusted_sheets(connection, number, student, course)
    book = Gradebook(adjustments.on(issued))
    for graded in sheets:
        book.add(graded)
    questions = PaperQuestions.of(course, issued, on_papers=True)
    return _marked(questions, dict(results(book)).get(student), sheets)


def _marked(questions: PaperQuestions, result: Result | None, sheets: Sequence[Graded]) -> Marked | None:
    counted = [graded for graded in sheets if result and graded.sitting == result.sitting]
    if result is None or not counted:
        return None
    return Marked(questions, result, counted, any(graded.open for graded in counted))


def score_of(
    site: Site, launch: Launch, number: int, person_id: int, now: ClassState | None = None
) -> Score | None:
    """Return the score of a launch's person in an assignment; None before the marks are released."""
    lang = lang_of(site, launch)
    with site.store.reading() as connection:
        state = assignment_state(connection, number, person_id, lang, site.clock())
        if state is None or not state.done or not state.releases("feedback"):
            return None
        student = state.assignment.student
        marked = marked_in(now, student) if now else marked_of(site.course, connection, number, student)
    if marked is None:
        return None
    comment = _comment(marked, marked.given(state), lang)
    return Score(marked.given(state), marked.result.out_of, comment, marked.waits)


def assignment_state(
    connection: Connection, number: int, person: int, lang: str, at: datetime
) -> AssignmentState | None:
    """Return the state of a published assignment for a person; None if they have no paper of it."""
    assignment = next(iter(student_assignments(connection, person, number)), None)
    if assignment is None or assignment.publication is None:
        return None
    longer = longer_for(connection, {number: assignment.publication})[number]
    ends = last_end(assignment.publication, longer.values())
    return AssignmentState(
        assignment, lang, assignment.publication.now(at), submissions_of(connection, number, person), ends
    )


def _comment(marked: Marked, given: float, lang: str) -> str:
    texts = words(lang)["lti"]
    sheets = {sheet.exercise: sheet for sheet in marked.sheets}
    lines = [
        texts["comment_line"].format(number, verdict_word(sheets[name].lines[part].verdict, lang))
        for name in dict.fromkeys(name for name, _ in marked.questions if name in sheets)
        for part, number in marked.questions.on_paper(name, sheets[name].lines).items()
    ]
    values = {"points": points_number(given, lang), "out_of": points_number(marked.result.out_of, lang)}
    comment = str(texts["comment"]).format(**values, number=marked.result.sitting, verdicts="; ".join(lines))
    return comment if len(comment) <= _COMMENT else comment[:_COMMENT].rpartition(";")[0] + "; …"


# ----------------------------------------------------------------- changed scores


class ScoreWatch:
    """Watch that queues changed scores for the platforms."""

    def __init__(self, site: Site, storage: Storage, wake: Any):
        self._site, self._storage, self._wake = site, storage, wake
        self._over = threading.Event()

    def look(self) -> int:
        """Check every assignment that a link opens; return the number of new scores."""
        by_assignment: dict[int, list[tuple[int, Launch]]] = {}
        for number, person_id, launch in self._storage.opened():
            if launch.line or launch.lines:
                by_assignment.setdefault(number, []).append((person_id, launch))
        return sum(self._look(number, launches) for number, launches in by_assignment.items())

    def _look(self, number: int, launches: Sequence[tuple[int, Launch]]) -> int:
        pass_dates(self._site, self._site.clock(), number)
        key, state = f"lti assignment {number}", f"{self._state_text(number)} {len(launches)}"
        with self._site.store.reading() as connection:
            if value_of(connection, key) == state:
                return 0
        now = class_now(self._site, number)
        new = sum(self._queue_score(number, person_id, launch, now) for person_id, launch in launches)
        with self._site.store.begin() as connection:
            put_value(connection, key, state)
        if new:
            self._wake()
        return new

    def _state_text(self, number: int) -> str:
        """Return a text that changes whenever a score may have changed."""
        with self._site.store.reading() as connection:
            publication, stamped = published(connection, number), stamp(connection, number)
            more = longer_for(connection, {number: publication})[number] if publication else {}
        if publication is None:
            return str(stamped)
        passed = sum(
            date < publication.now(self._site.clock())
            for date in publication.dates(own.closes for own in more.values())
        )
        rules = replace(publication, reached=None).as_json()
        return f"{stamped} {passed} {sorted(rules.items())} {len(more)}"

    def _queue_score(self, number: int, person_id: int, launch: Launch, now: ClassState) -> bool:
        score = score_of(self._site, launch, number, person_id, now)
        return score is not None and self._storage.put_score(launch, person_id, score)

    # ------------------------------------------------------------------ beside

    def start(self) -> None:
        self._over.clear()
        threading.Thread(target=self._run, name="lti-watch", daemon=True).start()

    def stop(self) -> None:
        self._over.set()

    def _run(self) -> None:
        while not self._over.wait(_PAUSE):
            try:
                self.look()
            except CourseworkError as fault:
                LOG.warning("scores were not looked at: %s", type(fault).__name__)
            except Exception as fault:
                LOG.error("scores could not be looked at: %s", type(fault).__name__)


def lang_of(site: Site, launch: Launch) -> str:
    """Return the language of a launch."""
    locale = launch.locale[:2].lower()
    return locale if locale in site.languages else site.languages[0]
