"""Form of a new assignment: its file or selected exercises, and a roster.

Input from a browser never names a file of this machine: only the content of an upload is read.
"""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from datetime import date, time
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from coursework.course.course import Course
from coursework.database.assignments import names
from coursework.database.people import people
from coursework.errors import BadInput
from coursework.issuing.assignment import FILES, OPTIONS, Assignment, assignment_of
from coursework.issuing.issued import Issued
from coursework.issuing.roster import Student, read_roster
from coursework.language.numbers import typed_number
from coursework.site.frame.budgets import DESK_FILE
from coursework.site.frame.forms import read_upload
from coursework.site.frame.requests import Request, Upload
from coursework.site.frame.settings import Site
from coursework.site.publication.assigning import AssignmentRequest
from coursework.system.toml_files import table_of

_LONGEST = 80  #: characters of a name


class NewAssignment(NamedTuple):
    """New assignment: with variants to draw here, or issued elsewhere."""

    name: str
    wanted: AssignmentRequest | None = None
    issued: Mapping[str, Any] | None = None


class ExerciseGroup(NamedTuple):
    """Group of exercises with names and titles, under a title."""

    title: str
    exercises: tuple[tuple[str, str], ...]


def read(request: Request) -> NewAssignment:
    """Return the assignment that the form states.

    Raises
    ------
    BadInput
        The form is inconsistent, or the assignment exists already.
    """
    texts = request.words["publishing"]["faults"]
    if sent := request.form.upload("issued"):
        return _issued(request, sent)
    name, table, source = _stated(request)
    _check_new(request, name)
    definition = assignment_of(name, table, request.site.course, source)
    students = students_of(request)
    if not students:
        raise BadInput(texts["nobody"])
    return NewAssignment(
        name, AssignmentRequest(name, table, students, spoken(request.site, definition, request.lang))
    )


def spoken(site: Site, definition: Assignment, lang: str) -> str:
    """Return the reader's language if all the exercises have it, or else the course's default."""
    all_have = all(lang in site.course[name].languages for name in definition.names)
    return lang if all_have else site.languages[0]


def _issued(request: Request, sent: Upload) -> NewAssignment:
    issued = Issued.of(sent.data, "issued.json", by_name=True)
    name = str((issued.assignment or {}).get("name") or _name(request.form.text("name")))
    if not name:
        raise BadInput(request.words["publishing"]["faults"]["name"])
    for (exercise, _), record in issued.records.items():
        if exercise not in request.site.course:
            raise BadInput(request.words["publishing"]["faults"]["no_exercise"].format(exercise[:80]))
        request.site.course[exercise].from_record(record)
    return NewAssignment(name, issued=json.loads(sent.data.decode("utf-8")))


def _check_new(request: Request, name: str) -> None:
    with request.site.store.reading() as connection:
        if name in names(connection):
            raise BadInput(request.words["publishing"]["faults"]["known"].format(name))


# ------------------------------------------------------------------ form


def _stated(request: Request) -> tuple[str, dict[str, Any], str]:
    """Return name, table and source text of the assignment, from a file or else from the chosen exercises."""
    if sent := request.form.upload("file"):
        name = _name(PurePosixPath(sent.name.replace("\\", "/")).stem)
        try:
            source = sent.data.decode("utf-8-sig")
        except UnicodeDecodeError:
            raise BadInput(request.words["publishing"]["faults"]["utf8"]) from None
        table = table_of(source, f"{name}.toml")
        return name, _as_json({k: v for k, v in table.items() if k not in {*FILES, *OPTIONS}}), source
    return _chosen(request)


def _chosen(request: Request) -> tuple[str, dict[str, Any], str]:
    form, texts = request.form, request.words["publishing"]["faults"]
    title, names_of_course = form.text("title").strip()[:200], set(request.site.course.names)
    name = _name(form.text("name") or title)
    exercises = [item for item in form.texts.get("exercise", ()) if item in names_of_course]
    if not name or not title:
        raise BadInput(texts["name"])
    if not exercises:
        raise BadInput(texts["exercises"])
    table: dict[str, Any] = {"title": title, "exercises": [{"name": item} for item in exercises]}
    if form.text("instructions").strip():
        table["instructions"] = form.text("instructions").strip()[:4000]
    if form.text("mark_of").strip():
        table["mark"] = {"of": _number(form.text("mark_of"), texts["mark"])}
    if (versions := form.text("versions", "each")) != "each":
        table["versions"] = int(_number(versions, texts["versions"]))
    return name, table, ""


def _number(text: str, fault: str) -> float:
    number = typed_number(text)
    if not math.isfinite(number):
        raise BadInput(fault)
    return number


def _name(text: str) -> str:
    """Return a name of letters, digits and dashes, for use in addresses and file names."""
    return re.sub(r"[^\w.-]+", "-", text.strip()).strip("-.")[:_LONGEST]


def _as_json(value: Any) -> Any:
    """Return a table of TOML as JSON, with dates as texts."""
    if isinstance(value, dict):
        return {key: _as_json(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_as_json(item) for item in value]
    return value.isoformat() if isinstance(value, (date, time)) else value


# ------------------------------------------------------------------------- students


def uploaded_roster(request: Request) -> list[Student]:
    """Return the students of the uploaded roster; nobody if there is none.

    Raises
    ------
    BadInput
        The roster cannot be read.
    """
    sent = request.form.upload("roster")
    return list(read_upload(request, DESK_FILE, read_roster, "roster.csv", sent.data)) if sent else []


def students_of(request: Request) -> list[Student]:
    """Return the students of the roster, or else, if the form states so, all who sign in as students."""
    if students := uploaded_roster(request):
        return students
    return students_with_accounts(request) if request.form.text("accounts") else []


def students_with_accounts(request: Request) -> list[Student]:
    """Return all who sign in as students, with names and columns that identify the same people."""
    with request.site.store.reading() as connection:
        persons = {person.id: person for person in people(connection) if person.role == "student"}.values()
    often = Counter(person.name for person in persons)
    return [_student(person, apart=often[person.name] > 1) for person in persons]


def _student(person: Any, *, apart: bool) -> Student:
    name = f"{person.name} ({person.who})" if apart else person.name
    plain = Student(name, person.lang, dict(person.columns or {}))
    if plain.draw_key == person.who:
        return plain
    column = "email" if "@" in person.who else "number"
    return Student(name, person.lang, {column: person.who, **plain.columns})


# ------------------------------------------------------------------------ exercises


def exercise_groups(course: Course[Any], lang: str) -> list[ExerciseGroup]:
    """Return the exercises by chapter, then the others."""
    return [group for group in _exercise_groups(course, lang) if group.exercises]


def _exercise_groups(course: Course[Any], lang: str) -> Iterator[ExerciseGroup]:
    folder = course.folder
    placed: set[str] = set()
    for chapter in folder.chapters:
        placed |= set(chapter.exercises)
        yield ExerciseGroup(
            f"{chapter.number}. {chapter.title(lang)}", _titled(course, chapter.exercises, lang)
        )
    yield ExerciseGroup("…", _titled(course, [name for name in folder.names if name not in placed], lang))


def _titled(course: Course[Any], chosen: Sequence[str], lang: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, _title(course, name, lang)) for name in chosen)


def _title(course: Course[Any], name: str, lang: str) -> str:
    exercise = course[name]
    return str(exercise.title(lang if lang in exercise.languages else exercise.languages[0]))
