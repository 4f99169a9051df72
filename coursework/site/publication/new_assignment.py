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

from coursework.authoring.new_assignment import toml_of
from coursework.course.course import Course
from coursework.course.exercise import ALL
from coursework.database.assignments import names
from coursework.database.people import people
from coursework.errors import BadInput, CourseworkError
from coursework.gradebook.statistics.captions import shortened
from coursework.issuing.assignment import FILES, OPTIONS, Assignment, assignment_of
from coursework.issuing.issued import Issued
from coursework.issuing.roster import Student, read_roster
from coursework.language.numbers import localise, typed_number
from coursework.language.words import words
from coursework.markup.markdown import plain_line
from coursework.sheets.handout import prompt
from coursework.site.frame.budgets import DESK_FILE
from coursework.site.frame.forms import read_upload
from coursework.site.frame.requests import FormData, Request, Upload
from coursework.site.frame.settings import Site
from coursework.site.publication.assigning import AssignmentRequest
from coursework.system.toml_files import table_of

_LONGEST = 80  #: characters of a name
_WORDS = 110  #: characters of a question in the form


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
    stated = stated_assignment(request)
    _check_new(request, stated.name)
    students = students_of(request)
    if not students:
        raise BadInput(texts["nobody"])
    lang = spoken(request.site, stated.definition, request.lang)
    return NewAssignment(stated.name, AssignmentRequest(stated.name, stated.table, students, lang))


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


class StatedAssignment(NamedTuple):
    """Assignment as a form states it."""

    name: str
    table: Mapping[str, Any]
    source: str  #: text of its file
    definition: Assignment
    is_of_file: bool  #: it was sent as a file, and not put together by the form


def stated_assignment(request: Request) -> StatedAssignment:
    """Return the assignment that the form states: as a file, as the text of one, or by chosen exercises. What
    is chosen becomes a file, which is read as any other.

    Raises
    ------
    BadInput
        The form or the file is inconsistent.
    """
    form, texts = request.form, request.words["publishing"]["faults"]
    sent, source = form.upload("file"), form.text("source")
    is_of_file = bool(sent or source.strip())
    if sent:
        name = _name(PurePosixPath(sent.name.replace("\\", "/")).stem)
        try:
            source = sent.data.decode("utf-8-sig")
        except UnicodeDecodeError:
            raise BadInput(texts["utf8"]) from None
    elif is_of_file:
        name = _name(form.text("source_name"))
    else:
        name, chosen = _chosen(request)
        source = toml_of(chosen)
    if not name:
        raise BadInput(texts["name"])
    table = table_of(source, f"{name}.toml")
    ignored = {*FILES, *OPTIONS} if is_of_file else ()
    fields = _as_json({key: value for key, value in table.items() if key not in ignored})
    definition = assignment_of(name, fields, request.site.course, source)
    return StatedAssignment(name, fields, source, definition, is_of_file)


def _chosen(request: Request) -> tuple[str, dict[str, Any]]:
    """Return name and table of an assignment of chosen exercises. Raises BadInput: the form is
    inconsistent."""
    form, texts = request.form, request.words["publishing"]["faults"]
    title, names_of_course = form.text("title").strip()[:200], set(request.site.course.names)
    name = _name(form.text("name") or title)
    exercises = [item for item in form.texts.get("exercise", ()) if item in names_of_course]
    if not name or not title:
        raise BadInput(texts["name"])
    if not exercises:
        raise BadInput(texts["exercises"])
    table: dict[str, Any] = {"title": title}
    if day := form.text("date").strip():
        try:
            table["date"] = date.fromisoformat(day)
        except ValueError:
            raise BadInput(texts["date"]) from None
    if duration := form.text("duration").strip()[:80]:
        table["duration"] = duration
    if form.text("instructions").strip():
        table["instructions"] = form.text("instructions").strip()[:4000]
    if form.text("mark_of").strip():
        step = (
            {"step": _number(form.text("mark_step"), texts["mark"])} if form.text("mark_step").strip() else {}
        )
        table["mark"] = {"of": _number(form.text("mark_of"), texts["mark"]), **step}
    if (versions := form.text("versions", "each")) != "each":
        table["versions"] = int(_number(versions, texts["versions"]))
    places = {item: _place(form.text(f"place.{item}"), k) for k, item in enumerate(exercises)}
    table["exercises"] = [_asked(request, item) for item in sorted(exercises, key=places.__getitem__)]
    return name, table


def _place(text: str, index: int) -> tuple[float, int]:
    """Return the key by which a chosen exercise is sorted: its stated place, else that in the form."""
    number = typed_number(text)
    return (number if math.isfinite(number) else index + 1.0, index)


def _asked(request: Request, name: str) -> dict[str, Any]:
    """Return the entry of a chosen exercise: the ticked parts if they are not the usual ones, and the
    points."""
    form, texts = request.form, request.words["publishing"]["faults"]
    spec = request.site.course[name].spec
    entry: dict[str, Any] = {"name": name}
    ids = [part.id for part in spec.parts]
    ticked = [part for part in ids if part in form.texts.get(f"part.{name}", ())]
    if ticked and ticked != [part.id for part in spec.parts if not part.by_request]:
        entry["parts"] = ticked
    stated = {part: form.text(f"points.{name}.{part}").strip() for part in ticked or ids}
    points = {part: _number(text, texts["points"]) for part, text in stated.items() if text}
    usual = {part.id: part.points for part in spec.parts}
    if points and any(points[part] != usual[part] for part in points):
        entry["points"] = points
    return entry


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


class ChosenPart(NamedTuple):
    """Part of a chosen exercise, in the form."""

    id: str
    words: str
    points: str
    is_ticked: bool
    is_usual: bool  #: asked unless parts are chosen


class ChosenExercise(NamedTuple):
    """Chosen exercise with its parts, in the form."""

    name: str
    title: str
    place: int
    parts: tuple[ChosenPart, ...]
    points: str  #: of all ticked parts


def proposed(request: Request) -> FormData:
    """Return the form as an address fills it in: with the exercises that it names, and the title of the
    first."""
    course = request.site.course
    chosen = [name for name in dict.fromkeys(request.query_params.getlist("exercise")) if name in course]
    return FormData(
        {"exercise": chosen, "title": [_title(course, name, request.lang) for name in chosen[:1]]}
    )


def chosen_exercises(request: Request) -> list[ChosenExercise]:
    """Return the exercises that a form chooses, in their order, with the parts and points that it states."""
    form, course = request.form, request.site.course
    chosen = [name for name in dict.fromkeys(form.texts.get("exercise", ())) if name in course]
    places = {name: _place(form.text(f"place.{name}"), k) for k, name in enumerate(chosen)}
    ordered = sorted(chosen, key=places.__getitem__)
    return [_with_parts(request, name, place) for place, name in enumerate(ordered, 1)]


def _with_parts(request: Request, name: str, place: int) -> ChosenExercise:
    exercise, form, lang = request.site.course[name], request.form, request.lang
    lang = lang if lang in exercise.languages else exercise.languages[0]
    variant = exercise.variant(0, lang, (ALL,))
    ticked = form.texts.get(f"part.{name}") or [p.id for p in exercise.spec.parts if not p.by_request]
    parts = []
    for part in exercise.spec.parts:
        stated = form.text(f"points.{name}.{part.id}").strip()
        points = stated or localise(f"{part.points:g}", request.lang)
        parts.append(
            ChosenPart(part.id, _words(variant, part, lang), points, part.id in ticked, not part.by_request)
        )
    total = sum(
        number for part in parts if part.is_ticked and math.isfinite(number := typed_number(part.points))
    )
    text = localise(f"{total:g}", request.lang)
    return ChosenExercise(name, _title(request.site.course, name, request.lang), place, tuple(parts), text)


def _words(variant: Any, part: Any, lang: str) -> str:
    """Return the words of a question as plain text, shortened; empty if they cannot be made."""
    try:
        return shortened(plain_line(prompt(variant, part), lang), _WORDS)
    except CourseworkError:
        return ""


def exercise_groups(course: Course[Any], lang: str) -> list[ExerciseGroup]:
    """Return the exercises by chapter, then the others."""
    return [group for group in _exercise_groups(course, lang) if group.exercises]


def _exercise_groups(course: Course[Any], lang: str) -> Iterator[ExerciseGroup]:
    folder = course.folder
    placed: set[str] = set()
    for chapter in folder.chapters:
        placed |= set(chapter.exercises)
        yield ExerciseGroup(
            f"{chapter.label}. {chapter.title(lang)}", _titled(course, chapter.exercises, lang)
        )
    rest = [name for name in folder.names if name not in placed]
    yield ExerciseGroup(words(lang, "site")["publishing"]["rest"], _titled(course, rest, lang))


def _titled(course: Course[Any], chosen: Sequence[str], lang: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, _title(course, name, lang)) for name in chosen)


def _title(course: Course[Any], name: str, lang: str) -> str:
    exercise = course[name]
    return str(exercise.title(lang if lang in exercise.languages else exercise.languages[0]))
