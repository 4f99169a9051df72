"""A class's sheets: a thousand students, each with a sheet and its worked solution as PDF.

python benchmarks/sheets.py [EXERCISE] [STUDENTS] [--no-polygons]
python benchmarks/sheets.py every [STUDENTS] [--no-polygons]
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from timing import machine, print_table

import coursework
from coursework.issuing import build as building
from coursework.issuing import issuing
from coursework.system import writing

BY_LATEX = 20  #: sheets that pdflatex is timed on


def used() -> tuple[float, float, float]:
    """Seconds of processor so far, of this process and of those that it has started; the most memory that
    this process has held, MB, and the most that one of the others has."""
    own, others = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    unit = 1 if sys.platform == "darwin" else 1024
    seconds = own.ru_utime + own.ru_stime + others.ru_utime + others.ru_stime
    return seconds, own.ru_maxrss / unit, others.ru_maxrss / unit


def build(
    name: str, students: int, formats: tuple[str, ...], out: Path, polygons: bool = True
) -> tuple[float, float]:
    """Seconds of a build of sheets and solutions, on the wall and of all processors."""
    course = coursework.open_course()
    wall, processors = time.perf_counter(), used()[0]
    issues = issuing.issue(course, [name], first_seed=0, count=students, langs=["fr"])
    writing.write(
        out, list(building.files(course, issues, [*formats, *([] if polygons else ["no-polygons"])]))
    )
    return time.perf_counter() - wall, used()[0] - processors


def by_latex(name: str, folder: Path, polygons: bool) -> float:
    """Seconds that pdflatex takes for a file of the same content, one after another."""
    build(name, BY_LATEX // 2, ("tex",), folder, polygons)
    sources = sorted(folder.rglob("*.tex"))
    start = time.perf_counter()
    for source in sources:
        command = ["pdflatex", "-interaction=batchmode", "-halt-on-error", source.name]
        subprocess.run(command, cwd=source.parent, check=True, capture_output=True)
    return (time.perf_counter() - start) / len(sources)


def every(students: int, polygons: bool) -> None:
    """Each exercise of the course in turn."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in coursework.open_course().names:
            out = Path(folder) / name
            wall, _ = build(name, students, ("pdf",), out, polygons)
            size = sum(path.stat().st_size for path in out.rglob("*.pdf")) / (2 * students)
            rows.append((name, f"{wall:.1f}", f"{1e3 * wall / (2 * students):.1f}", f"{size / 1e3:.0f}"))
            shutil.rmtree(out)
    print_table(("exercise", f"s for {students} students", "ms a PDF", "kB a PDF"), rows)
    walls = sorted(float(row[1]) for row in rows)
    print(f"half of them in {walls[len(walls) // 2]:.0f} s or less; all of them in {sum(walls) / 60:.0f} min")


def main() -> None:
    told = [argument for argument in sys.argv[1:] if argument != "--no-polygons"]
    polygons = "--no-polygons" not in sys.argv
    name = told[0] if told else "slotted_mechanism"
    students = int(told[1]) if len(told) > 1 else 1000
    drawn = "with its polygons" if polygons else "without polygons"
    print(f"{machine()}; {name}, a sheet and a worked solution {drawn} for each student\n")
    if name == "every":
        every(students, polygons)
        return
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        for count in (students // 4, students):
            wall, processors = build(name, count, ("pdf",), out / f"{count}", polygons)
            _, own, others = used()
            rows.append(
                (
                    str(count),
                    f"{wall:.1f}",
                    f"{1e3 * wall / (2 * count):.1f}",
                    f"{1e3 * processors / (2 * count):.1f}",
                    f"{own:.0f}",
                    f"{others:.0f}",
                )
            )
        print_table(
            ("students", "s", "ms a PDF", "processor ms a PDF", "peak MB", "of a process beside it"), rows
        )
        if shutil.which("pdflatex"):
            each = by_latex(name, out / "latex", polygons)
            total = wall / (2 * students)
            rows = [("pdflatex, one after another", f"{each * 1e3:.0f}", f"{each / total:.0f}")]
            print_table(("the same content by", "ms a PDF", "× as long"), rows)


if __name__ == "__main__":
    main()
