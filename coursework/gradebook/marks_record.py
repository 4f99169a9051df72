"""Record of a folder of marks: its scale, its kind of names and the numbers of its questions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.gradebook.book import Gradebook
from coursework.issuing.questions import PaperQuestions
from coursework.system.json_files import read_json
from coursework.system.tables import json_text
from coursework.system.writing import write_whole

_FILE = ".exam.json"


class MarksRecord(NamedTuple):
    """Scale, names and numbers of the tables of a folder of marks."""

    scale: Mapping[str, Any] | None  #: of marks, as the assignment states it; None without one
    by_codes: bool  #: True if codes stand in place of names
    questions: PaperQuestions


def write_record(folder: Path, book: Gradebook, questions: PaperQuestions) -> None:
    """Write the record of a folder beside the tables of a gradebook."""
    content = {
        "mark": (book.issued.assignment or {}).get("mark"),
        "by_codes": book.issued.is_anonymous,
        "questions": [[*question, number] for question, number in questions.items()],
    }
    write_whole(folder / _FILE, json_text(content).encode("utf-8", "backslashreplace"))


def read_record(folder: Path) -> MarksRecord | None:
    """Return the record of a folder of marks; None if it has none.

    Raises
    ------
    BadInput
        It is not a record.
    """
    path = folder / _FILE
    if not path.is_file():
        return None
    content = read_json(path)
    try:
        questions = PaperQuestions(((str(e), str(p)), str(number)) for e, p, number in content["questions"])
        return MarksRecord(content["mark"], bool(content["by_codes"]), questions)
    except (TypeError, KeyError, ValueError):
        raise BadInput("{file} is not as grade wrote it: mark the answers again", file=path) from None
