"""A pool of two variants of one exercise, as an export writes it, and what platforms collected of it."""

from __future__ import annotations

import json
from pathlib import Path

from coursework import open_course
from coursework.gradebook.grading import grade_files

RECORDED = Path(__file__).parent / "gradebook" / "recorded"
COURSE = open_course()
EXERCISE = "slotted_mechanism"


def pool(folder: Path, seeds=(4, 5), students=None, **more) -> Path:
    """The ``issued.json`` of a pool; ``students`` by name, with their columns, where there is a roster."""
    records = [COURSE[EXERCISE].variant(seed, "en").record for seed in seeds]
    content = {
        "format": 1,
        "roster": students is not None,
        "pool": True,
        **({} if students is None else {"students": students}),
        **more,
        "issued": [{"student": "", "record": record} for record in records],
    }
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "issued.json"
    path.write_text(json.dumps(content, ensure_ascii=False), "utf-8")
    return path


def graded(folder: Path, *files: Path, feedback=False, **options):
    """The book of some files of a pool; tables are in ``marks``."""
    issued = pool(folder, **options)
    return grade_files(COURSE, files, issued, folder / "marks", feedback=feedback)
