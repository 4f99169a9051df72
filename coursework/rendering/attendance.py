"""Lists of an exam as PDF: attendance by room, to sign, and rooms and seats, for the door."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from markupsafe import Markup

from coursework.language.words import words
from coursework.rendering import pdf
from coursework.rendering.environment import render
from coursework.sheets.attendance import ExamLists, RoomList


def source(folders: Sequence[Path], lists: ExamLists, paper: str = "a4", *, public: bool = False) -> str:
    """Return the Typst source of the attendance lists, a room after the other; of the list for the door if
    ``public``."""
    heading = lists.heading
    env, texts = pdf.environment_of(tuple(folders), heading.lang), words(heading.lang)
    names = {
        "heading": heading,
        "lang": heading.lang,
        "words": texts,
        "title": f"{heading.title} – {texts['exam']['seats' if public else 'attendance']}",
        "when": " · ".join(filter(None, (heading.date, heading.duration))),
        "public": public,
    }
    bodies = [
        Markup(
            render(
                env, "paper/attendance.typ.j2", {**names, "list": each, "expected": _expected(each, texts)}
            )
        )
        for each in ([lists.everybody] if public else lists.rooms)
    ]
    return render(env, "parts/page.typ.j2", {**names, "bodies": bodies, "paper": paper, "printed": True})


def _expected(room: RoomList, texts: Mapping[str, Any]) -> str:
    count = len(room.students)
    return str(texts["exam"]["expected"]["one" if count == 1 else "many"]).format(count)
