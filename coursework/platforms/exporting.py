"""Export for a platform: its files, the record of the pool, the losses, and the steps of the import. It
contains answers and is for the staff."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coursework.issuing.issued import issued_content
from coursework.issuing.roster import Student
from coursework.platforms.items import Loss, MadeItem
from coursework.platforms.losses import COLUMNS, loss_row, losses, platform_words
from coursework.platforms.platform import Platform
from coursework.platforms.pools import DrawnPool
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file, json_text
from coursework.system.writing import File


@dataclass(frozen=True)
class Export:
    """Files and losses of an export."""

    files: tuple[File, ...]
    lost: tuple[Loss, ...]


def export(
    platform: Platform,
    drawn: DrawnPool,
    students: Sequence[Student] = (),
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    progress: Callable[[MadeItem], None] = lambda made: None,
) -> Export:
    """Return the files of an export, in every language of the pool; ``students`` are those whose marks may
    come back."""
    pools = [drawn.pool(lang, platform, progress) for lang in drawn.langs]
    lost = {
        (loss.exercise, loss.part, loss.feature): loss
        for pool in reversed(pools)
        for loss in losses(pool, platform.name, platform.losses(pool))
    }
    return Export(
        (
            *platform.files_of(pools),
            *_common_files(platform, drawn, students, tuple(lost.values()), spreadsheet),
        ),
        tuple(lost.values()),
    )


def _common_files(
    platform: Platform,
    drawn: DrawnPool,
    students: Sequence[Student],
    lost: Sequence[Loss],
    spreadsheet: Spreadsheet,
) -> Iterator[File]:
    issued = pool_content(drawn, students)
    lang = drawn.langs[0]
    yield File(Path("issued.json"), lambda: json_text(issued).encode("utf-8"))
    rows = [loss_row(loss, lang) for loss in lost]
    yield File(Path("lost.csv"), lambda: csv_file(rows, COLUMNS, spreadsheet))
    for code in drawn.langs:
        text = steps(platform.name, code)
        yield File(Path(f"IMPORT.{code}.txt"), text.encode, anywhere=False)


def pool_content(drawn: DrawnPool, students: Sequence[Student]) -> dict[str, Any]:
    """Return the ``issued.json`` of a pool: records without owner, and the students to whom the platform may
    give them."""
    content = issued_content(drawn.issues, drawn.assignment, drawn.secret)
    columns = {student.name: dict(student.columns) for student in students}
    return {**content, "roster": bool(students), "pool": True, **({"students": columns} if columns else {})}


def steps(platform: str, lang: str) -> str:
    """Return the steps of the import, one per line."""
    sentences = platform_words("steps", platform, lang)
    return "".join(f"{number}. {step}\n" for number, step in enumerate(sentences, start=1))
