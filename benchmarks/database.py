"""What a database costs beside files: a class marked plainly, with a database for the first time, and again
with nothing new.

python benchmarks/database.py [STUDENTS] [URL]
"""

from __future__ import annotations

import csv
import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import coursework
from coursework.cli import run

EXERCISES = ("slotted_mechanism", "four_bar_motion", "slider_crank")
WRONG = 5  #: of so many answers one is wrong


def written(folder: Path, students: int) -> int:
    """``issued.json`` and ``answers.csv`` of a class; how many answers."""
    course = coursework.open_course()
    items, rows = [], []
    for name in (n for n in EXERCISES if n in course):
        for place, variant in enumerate(course[name].variants(range(students), "en")):
            student = f"Student {place:05d}"
            items.append({"student": student, "record": variant.record})
            for part, value in variant.solution().items():
                wrong = (place + len(rows)) % WRONG == 0
                rows.append((student, name, variant.seed, part, "12.5" if wrong else value))
    content = {"format": 1, "roster": True, "issued": items}
    (folder / "issued.json").write_text(json.dumps(content), "utf-8")
    with (folder / "answers.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([("student", "exercise", "seed", "part", "answer"), *rows])
    return len(rows)


def timed(what: str, *told: object) -> None:
    begun = time.perf_counter()
    run(list(map(str, told)))
    print(f"{time.perf_counter() - begun:8.2f} s  {what}")


def main() -> None:
    students = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    with TemporaryDirectory() as place:
        folder = Path(place)
        url = sys.argv[2] if len(sys.argv) > 2 else f"sqlite:///{folder}/marks.db"
        print(f"{students} students, {written(folder, students)} answers")
        first = "grade", folder / "answers.csv", "--issued", folder / "issued.json"
        again = "grade", folder / "answers.csv", "--db", url
        timed("files alone", *first, "--out", folder / "plain", "--no-feedback")
        timed(
            "a database, for the first time, with the files",
            *first,
            "--db",
            url,
            "--out",
            folder / "out",
            "--no-feedback",
        )
        timed("nothing new, with the files", *again, "--out", folder / "out", "--no-feedback")
        timed("nothing new, no files", *again)
        timed("no file at all", "grade", "--db", url)
        same = all(
            (folder / "plain" / name).read_bytes() == (folder / "out" / name).read_bytes()
            for name in ("marks.csv", "summary.csv", "rejected.csv")
        )
        print(f"{'the same' if same else 'OTHER'} bytes")
        if url.startswith("sqlite"):
            print(f"{(folder / 'marks.db').stat().st_size / 1e6:.1f} MB in the database")


if __name__ == "__main__":
    main()
