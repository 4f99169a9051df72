"""A site to look at: the class of twelve, what it handed in and how it was marked, and what is open to it
now.

The same each time: variants depend on the names of students and a key that is no secret, and times are
written here.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from coursework.api import open_course
from coursework.authoring.new_assignment import new_assignment
from coursework.cli.demo import CLASS, HABITS, ROSTER
from coursework.cli.options import SITE_DATABASE
from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.database.assignments import names, put_issued
from coursework.database.marking import mark_new
from coursework.database.people import people, put_account, put_person
from coursework.database.permissions import ADMINISTRATOR, STUDENT
from coursework.database.publication import AT_ONCE, CLOSED, Publication, publish
from coursework.database.store import Store
from coursework.database.submissions import insert_submission
from coursework.gradebook.rows import AnswerRow, RowOrigin
from coursework.issuing.assignment import Assignment, read_assignment
from coursework.issuing.issued import Issued, issued_content
from coursework.issuing.roster import Student, read_roster
from coursework.issuing.variant_assignment import assign_variants
from coursework.system.folder_lock import only_writer

DONE, NOW = "homework_1", "homework_2"  #: the assignment that is marked, and the one that is open
_OPENED = datetime(2026, 10, 5, 8, tzinfo=UTC)
_CLOSED = datetime(2026, 10, 12, 18, tzinfo=UTC)
_EXERCISES = 3  #: of another course, in each assignment
TEACHER = "Ada Keller"


def demo_database(folder: str | None, target: Path) -> str:
    """Return the database of a demonstration of a course in a folder; as it was left where it is there.

    Raises
    ------
    CourseworkError
        The course cannot be opened, or the folder cannot be written.
    """
    file = target / SITE_DATABASE
    with only_writer(target, "serve"):
        course, store = open_course(folder), Store(str(file))
        with store.reading() as connection:
            is_new = not names(connection)
        if is_new:
            _fill(course, store, folder is None, target)
        store.close()
    return str(file)


def _fill(course: Course[Any], store: Store, is_own: bool, folder: Path) -> None:
    done, now = (_assignment(course, name, k, is_own, folder) for k, name in enumerate((DONE, NOW)))
    students = read_roster(ROSTER)
    number, content = _issue(course, store, done, students)
    other, _ = _issue(course, store, now, students)
    _hand_in(course, store, number, Issued(content, done.name))
    mark_new(course, store, number)
    _sign_up(store, students)
    with store.begin() as connection:
        publish(connection, number, Publication(opens=_OPENED, closes=_CLOSED, answers=CLOSED))
        publish(connection, other, Publication(tries=None, feedback=AT_ONCE))


def _assignment(course: Course[Any], name: str, index: int, is_own: bool, folder: Path) -> Assignment:
    """Return the assignment of the built-in course, or one of some exercises of another."""
    path = CLASS / f"{name}.toml"
    if not is_own:
        path = folder / f"{name}.toml"
        chosen = (
            course.folder.in_order[_EXERCISES * index :][:_EXERCISES] or course.folder.in_order[:_EXERCISES]
        )
        path.unlink(missing_ok=True)
        new_assignment(path, course, chosen, course.folder.languages)
    return replace(read_assignment(path, course), secret=Secret(f"demonstration  {index:1d}".encode()))


def _issue(
    course: Course[Any], store: Store, assignment: Assignment, students: list[Student]
) -> tuple[int, dict[str, Any]]:
    spoken = [_in_language(course, student) for student in students]
    assigned = assign_variants(course, assignment, spoken, course.folder.languages[:1])
    content = issued_content(assigned.issues, assignment)
    with store.begin() as connection:
        return put_issued(connection, content, course=course.folder.root.name), content


def _in_language(course: Course[Any], student: Student) -> Student:
    lang = student.lang if student.lang in course.folder.languages else course.folder.language
    return Student(student.name, lang, student.columns)


def _hand_in(course: Course[Any], store: Store, number: int, issued: Issued) -> None:
    """Each hands in once, by their habit, an hour after another."""
    with store.begin() as connection:
        ids = {person.name: person.id for person in people(connection)}
        for k, student in enumerate(issued.students[:-1]):  # the last one has not handed in
            received_at = _CLOSED - timedelta(days=2) + timedelta(hours=k)
            rows = list(_rows(course, issued, student, k, received_at))
            insert_submission(
                connection,
                number,
                rows,
                source="site",
                received_at=received_at,
                person_id=ids[student],
                number=1,
            )


def _rows(
    course: Course[Any], issued: Issued, student: str, k: int, received_at: datetime
) -> Iterator[AnswerRow]:
    habit = HABITS[k % len(HABITS)]
    origin = RowOrigin(sitting=1, submitted=received_at.isoformat())
    for exercise in issued.exercises:
        seed = issued.seeds[student, exercise]
        variant = course[exercise].from_record(issued.records[exercise, seed])
        for index, part in enumerate(variant.parts):
            answer = habit(variant, variant.key, part, index)
            text = answer if isinstance(answer, str) else str(answer)
            yield AnswerRow(student, exercise, str(seed), part.id, text, "site", "", variant.lang, origin)


def _sign_up(store: Store, students: list[Student]) -> None:
    """Everybody of the class, and who teaches it."""
    with store.begin() as connection:
        teacher = put_person(connection, identifier=TEACHER, name=TEACHER, lang="", columns={})
        put_account(connection, teacher, login="teacher@example.org", role=ADMINISTRATOR)
        for k, student in enumerate(students, 1):
            person = put_person(connection, student.draw_key, student.name, student.lang, student.columns)
            put_account(connection, person, login=f"student{k}@example.org", role=STUDENT)
