"""Form of a new assignment: its file or selected exercises, and a roster.

What comes from a browser names no file on this machine: of a file that is sent, its contents alone are read.
"""

from __future__ import annotations

import json
import math
import re
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from datetime import date, time
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from coursework.course.course import Course
from coursework.database.assignments import names
from coursework.database.people import people
from coursework.errors import BadInput
from coursework.making.assignment import FILES, OPTIONS, Assignment, assignment_of, table_of
from coursework.making.issued import Issued
from coursework.making.roster import Student, read_roster
from coursework.site.frame.budgets import DESK_FILE, read_apart
from coursework.site.frame.visits import Upload, Visit
from coursework.site.publication.dealings import Wanted

_LONGEST = 80  #: characters of a name


class HandOut(NamedTuple):
    """Assignment to hand out: with variants to draw here, or as issued elsewhere."""

    name: str
    wanted: Wanted | None = None
    issued: Mapping[str, Any] | None = None


class Shelf(NamedTuple):
    """Exercises that stand together: name and title of each."""

    title: str
    exercises: tuple[tuple[str, str], ...]


def read(visit: Visit) -> HandOut:
    """Return the assignment that the form states.

    Raises
    ------
    BadInput
        It says what makes no sense, or what there is already.
    """
    said = visit.said["publishing"]["faults"]
    if sent := _sent(visit, "issued"):
        return _issued(visit, sent)
    name, table, source = _asked(visit)
    _check_new(visit, name)
    asked = assignment_of(name, table, visit.site.course, source)
    students = roster(visit)
    if not students:
        raise BadInput(said["nobody"])
    return HandOut(name, Wanted(name, table, students, spoken(visit, asked)))


def spoken(visit: Visit, asked: Assignment) -> str:
    """Return the reader's language if all the exercises have it, or else the course's default."""
    all_have = all(visit.lang in visit.site.course[name].languages for name in asked.names)
    return visit.lang if all_have else visit.site.languages[0]


def _sent(visit: Visit, field: str) -> Upload | None:
    return next((one for one in visit.form.files.get(field, ()) if one.data), None)


def _issued(visit: Visit, sent: Upload) -> HandOut:
    issued = Issued.of(sent.data, "issued.json")
    name = str((issued.assignment or {}).get("name") or _name(visit.form.text("name")))
    if not name:
        raise BadInput(visit.said["publishing"]["faults"]["name"])
    for (exercise, _), record in issued.records.items():
        if exercise not in visit.site.course:
            raise BadInput(visit.said["publishing"]["faults"]["no_exercise"].format(exercise[:80]))
        visit.site.course[exercise].from_record(record)
    return HandOut(name, issued=json.loads(sent.data.decode("utf-8")))


def _check_new(visit: Visit, name: str) -> None:
    with visit.site.store.reading() as connection:
        if name in names(connection):
            raise BadInput(visit.said["publishing"]["faults"]["known"].format(name))


# ------------------------------------------------------------------------ the asked


def _asked(visit: Visit) -> tuple[str, dict[str, Any], str]:
    """Name, table and text of the assignment: of a file, else of what was chosen."""
    if sent := _sent(visit, "file"):
        name = _name(PurePosixPath(sent.name.replace("\\", "/")).stem)
        try:
            source = sent.data.decode("utf-8-sig")
        except UnicodeDecodeError:
            raise BadInput(visit.said["publishing"]["faults"]["utf8"]) from None
        table = table_of(source, f"{name}.toml")
        return name, _as_json({k: v for k, v in table.items() if k not in {*FILES, *OPTIONS}}), source
    return _chosen(visit)


def _chosen(visit: Visit) -> tuple[str, dict[str, Any], str]:
    form, said = visit.form, visit.said["publishing"]["faults"]
    title, known = form.text("title").strip()[:200], set(visit.site.course.names)
    name = _name(form.text("name") or title)
    exercises = [one for one in form.texts.get("exercise", ()) if one in known]
    if not name or not title:
        raise BadInput(said["name"])
    if not exercises:
        raise BadInput(said["exercises"])
    table: dict[str, Any] = {"title": title, "exercises": [{"name": one} for one in exercises]}
    if form.text("instructions").strip():
        table["instructions"] = form.text("instructions").strip()[:4000]
    if form.text("mark_of").strip():
        table["mark"] = {"of": _number(form.text("mark_of"), said["mark"])}
    if (versions := form.text("versions", "each")) != "each":
        table["versions"] = int(_number(versions, said["versions"]))
    return name, table, ""


def _number(text: str, fault: str) -> float:
    try:
        number = float(text.replace(",", "."))
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise BadInput(fault)
    return number


def _name(text: str) -> str:
    """Return a name of letters, digits and dashes, for use in addresses and file names."""
    return re.sub(r"[^\w.-]+", "-", text.strip()).strip("-.")[:_LONGEST]


def _as_json(value: Any) -> Any:
    """Return a table of TOML as JSON, with dates as texts."""
    if isinstance(value, dict):
        return {key: _as_json(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_as_json(one) for one in value]
    return value.isoformat() if isinstance(value, (date, time)) else value


# ------------------------------------------------------------------------- students


def roster(visit: Visit) -> list[Student]:
    """Return the students of the uploaded roster, or else, if the form states so, all who sign in as
    students.

    Raises
    ------
    BadInput
        The roster cannot be read.
    """
    if sent := _sent(visit, "roster"):
        with tempfile.TemporaryDirectory(prefix="coursework-") as folder:
            path = Path(folder) / "roster.csv"
            path.write_bytes(sent.data)
            try:
                students: list[Student] = read_apart(
                    DESK_FILE, visit.said["refused"]["too_much"], read_roster, path
                )
                return students
            except BadInput as fault:
                raise BadInput(str(fault).replace(str(path), "roster.csv")) from None
    return students_with_accounts(visit) if visit.form.text("accounts") else []


def students_with_accounts(visit: Visit) -> list[Student]:
    """Everybody who signs in as a student, so named that the very same people are meant."""
    with visit.site.store.reading() as connection:
        found = {one.id: one for one in people(connection) if one.role == "student"}.values()
    often = Counter(one.name for one in found)
    return [_student(one, apart=often[one.name] > 1) for one in found]


def _student(one: Any, *, apart: bool) -> Student:
    name = f"{one.name} ({one.who})" if apart else one.name
    plain = Student(name, one.lang, dict(one.columns or {}))
    if plain.who == one.who:
        return plain
    column = "email" if "@" in one.who else "number"
    return Student(name, one.lang, {column: one.who, **plain.columns})


# ------------------------------------------------------------------------ exercises


def shelves(course: Course[Any], lang: str) -> list[Shelf]:
    """Return the exercises by chapter, then the others."""
    return [shelf for shelf in _shelves(course, lang) if shelf.exercises]


def _shelves(course: Course[Any], lang: str) -> Iterator[Shelf]:
    folder = course.folder
    placed: set[str] = set()
    for chapter in folder.chapters:
        placed |= set(chapter.exercises)
        yield Shelf(f"{chapter.number}. {chapter.title(lang)}", _titled(course, chapter.exercises, lang))
    yield Shelf("…", _titled(course, [name for name in folder.names if name not in placed], lang))


def _titled(course: Course[Any], found: Sequence[str], lang: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, _title(course, name, lang)) for name in found)


def _title(course: Course[Any], name: str, lang: str) -> str:
    exercise = course[name]
    return str(exercise.title(lang if lang in exercise.languages else exercise.languages[0]))
