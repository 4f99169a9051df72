"""An export: the files of a platform, what was issued, what is lost, and how to import it. It holds answers: the staff's half."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coursework.language.words import words
from coursework.making.issued import issued_content
from coursework.making.roster import Student
from coursework.platforms.losses import COLUMNS, Loss, losses
from coursework.platforms.platform import Platform
from coursework.platforms.pools import Drawn
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file, json_text
from coursework.system.writing import File


@dataclass(frozen=True)
class Export:
    """What is written, and what is lost."""

    files: tuple[File, ...]
    lost: tuple[Loss, ...]


def export(
    platform: Platform,
    drawn: Drawn,
    students: Sequence[Student] = (),
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
) -> Export:
    """The files of an export, in every language of the pool; ``students`` are those whom the way back will know."""
    pools = [drawn.pool(lang) for lang in drawn.langs]
    lost = {
        (loss.exercise, loss.part, loss.feature): loss
        for pool in reversed(pools)
        for loss in losses(pool, platform.name, platform.losses(pool))
    }
    made = [file for pool in pools for file in platform.files(pool)]
    return Export(
        (*made, *_beside(platform, drawn, students, tuple(lost.values()), spreadsheet)), tuple(lost.values())
    )


def _beside(
    platform: Platform,
    drawn: Drawn,
    students: Sequence[Student],
    lost: Sequence[Loss],
    spreadsheet: Spreadsheet,
) -> Iterator[File]:
    issued = pool_content(drawn, students)
    lang = drawn.langs[0]
    yield File(Path("issued.json"), lambda: json_text(issued).encode("utf-8"))
    rows = [loss.row(lang) for loss in lost]
    yield File(Path("lost.csv"), lambda: csv_file(rows, COLUMNS, spreadsheet))
    for one in drawn.langs:
        text = steps(platform.name, one)
        yield File(Path(f"IMPORT.{one}.txt"), text.encode, anywhere=False)


def pool_content(drawn: Drawn, students: Sequence[Student]) -> dict[str, Any]:
    """What ``issued.json`` says of a pool: records that belong to nobody, and whom the platform may deal them to."""
    content = issued_content(drawn.issues, drawn.assignment, drawn.secret)
    columns = {student.name: dict(student.columns) for student in students}
    return {
        **content,
        "roster": bool(students),
        "pool": True,
        **({"students": columns} if columns else {}),
    }


def steps(platform: str, lang: str) -> str:
    """How the files of a platform are imported, a step a line."""
    told = words(lang)["platforms"]["steps"][platform]
    return "".join(f"{place}. {step}\n" for place, step in enumerate(told, start=1))
