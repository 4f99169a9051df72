"""An assignment of the small course: what was issued, answers to it, and its tables."""

from __future__ import annotations

import csv
import json

from coursework.cli import run

STATED = {
    "name": "week3",
    "title": {"fr": "Devoir 2", "en": "Midterm 2"},
    "course": {"": "Mechanics 2A"},
    "date": "2026-12-04",
    "duration": {"": "1 h 30"},
    "mark": {"of": 20, "step": 0.5},
    "identity": ["number"],
    "sittings": "best",
    "answers": "shown",
    "marking": {},
    "exercises": ["crank_pin"],
}
COLUMNS = ("student", "exercise", "seed", "part", "answer")


def item(course, student, seed, **more):
    return {"student": student, **more, "record": course["crank_pin"].variant(seed, "en").record}


def issue(tmp_path, items, students=(), **stated):
    content = {
        "format": 1,
        "roster": any(i["student"] for i in items),
        "assignment": {**STATED, **stated},
        "students": dict(students),
        "issued": items,
    }
    path = tmp_path / "issued.json"
    path.write_text(json.dumps(content), "utf-8")
    return path


def right(course, student, seed, written=None, **changed):
    """Rows of right answers to a variant, but those that are changed."""
    solution = {**course["crank_pin"].variant(seed, "en").solution(), **changed}
    written = seed if written is None else written
    return [[student, "crank_pin", written, part, value] for part, value in solution.items()]


def write(path, rows):
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    return path


def table(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def grade(course, issued, rows, *more):
    answers = write(issued.parent / "answers.csv", rows)
    asked = ["--course", course.folder.root, "grade", answers, "--issued", issued, "--no-feedback", *more]
    return run(list(map(str, asked))), issued.parent / "marks"
