"""A class's sheets: a thousand students, each with a sheet and its worked solution as PDF.

python benchmarks/sheets.py [EXERCISE] [STUDENTS] [--no-polygons]
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
from coursework import building, issuing

BY_LATEX = 20  #: sheets that pdflatex is timed on


def peak_megabytes() -> float:
    """The most memory this process has held so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1 if sys.platform == "darwin" else 1024)


def build(
    name: str, first: int, students: int, formats: tuple[str, ...], out: Path, polygons: bool = True
) -> tuple[float, float]:
    """Seconds of a build of sheets and solutions, on the wall and of all processors."""
    course = coursework.open_course()
    wall, processors = time.perf_counter(), time.process_time()
    issues = issuing.issue(course, [name], first_seed=first, count=students, langs=["fr"])
    building.write(out, list(building.files(course, issues, formats, polygons=polygons)))
    return time.perf_counter() - wall, time.process_time() - processors


def by_latex(name: str, folder: Path, polygons: bool) -> float:
    """Seconds that pdflatex takes for a file of the same content, one after another."""
    build(name, 0, BY_LATEX // 2, ("tex",), folder, polygons)
    sources = sorted(folder.rglob("*.tex"))
    start = time.perf_counter()
    for source in sources:
        command = ["pdflatex", "-interaction=batchmode", "-halt-on-error", source.name]
        subprocess.run(command, cwd=source.parent, check=True, capture_output=True)
    return (time.perf_counter() - start) / len(sources)


def main() -> None:
    told = [argument for argument in sys.argv[1:] if argument != "--no-polygons"]
    polygons = "--no-polygons" not in sys.argv
    name = told[0] if told else "slotted_mechanism"
    students = int(told[1]) if len(told) > 1 else 1000
    drawn = "with its polygons" if polygons else "without polygons"
    print(f"{machine()}; {name}, a sheet and a worked solution {drawn} for each student\n")
    rows = []
    done = 0
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        for count in (students // 10, students * 4 // 10, students // 2):
            wall, processors = build(name, done, count, ("pdf",), out / f"{done}", polygons)
            done += count
            rows.append(
                (
                    f"{count}, {done} so far",
                    f"{wall:.1f}",
                    f"{1e3 * wall / (2 * count):.1f}",
                    f"{1e3 * processors / (2 * count):.1f}",
                    f"{peak_megabytes():.0f}",
                )
            )
        print_table(("students", "s", "ms a PDF", "processor ms a PDF", "peak MB"), rows)
        if shutil.which("pdflatex"):
            each = by_latex(name, out / "latex", polygons)
            total = sum(float(row[1]) for row in rows) / (2 * done)
            rows = [("pdflatex, one after another", f"{each * 1e3:.0f}", f"{each / total:.0f}")]
            print_table(("the same content by", "ms a PDF", "× as long"), rows)


if __name__ == "__main__":
    main()
