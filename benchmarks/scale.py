"""Whole commands by the number of students: seconds, processor seconds, memory, disk, and how fast the cost
grows.

python benchmarks/scale.py [JOB,…] [STUDENTS,…] [FOLDER]

Each job is a function of the number of students and a folder; JOBS names them. Three exercises; a command is
started anew for each measurement. Memory is that of the largest process, and of all processes of the command
at one moment. The exponent is the slope of the processor seconds from one number of students to the next, on
logarithmic scales: 1 is proportional, 2 quadratic. The pages of the site are measured by ``scale_site.py``, a
class that comes at one moment by ``site_rush.py``.
"""

from __future__ import annotations

import math
import resource
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

from marking import Mix
from marking import write as write_answers
from timing import print_table

EXERCISES = ("slider_crank", "four_bar_motion", "quick_return")
_RUN = "import sys; from coursework.cli import main; sys.exit(main())"
_LOOK = 0.05  #: seconds between two looks at the memory
_ANSWERS = 12  #: of a student to one exercise, about


class Cost(NamedTuple):
    """Cost of a command."""

    seconds: float
    processor: float  #: seconds of all its processes
    largest: float  #: MB of its largest process
    together: float  #: MB of all its processes


def cost_of(*arguments: str, codes: tuple[int, ...] = (0,)) -> Cost:
    """Run a command and return its cost; it ends with one of the exit codes.

    Raises
    ------
    SystemExit
        The command failed.
    """
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-P", "-c", _RUN, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    peaks = [0.0, 0.0]
    watch = threading.Thread(target=_watch, args=(process, peaks))
    watch.start()
    _, said = process.communicate()
    watch.join()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if process.returncode not in codes:
        sys.exit(f"{' '.join(arguments)}: {said.decode()[-400:]}")
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(time.perf_counter() - start, used, *peaks)


def _watch(process: subprocess.Popen[bytes], peaks: list[float]) -> None:
    """Keep the most memory of the largest process and of all, while a command runs."""
    while process.poll() is None:
        sizes = [_resident(pid) for pid in (process.pid, *_below(process.pid))]
        peaks[:] = max(peaks[0], *sizes), max(peaks[1], sum(sizes))
        time.sleep(_LOOK)


def _below(pid: int) -> list[int]:
    """Return the processes that a process started, and those that they started."""
    try:
        tasks = Path(f"/proc/{pid}/task").iterdir()
        found = [int(child) for task in tasks for child in (task / "children").read_text().split()]
    except OSError:
        return []
    return [*found, *(one for child in found for one in _below(child))]


def _resident(pid: int) -> float:
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * resource.getpagesize() / 2**20
    except OSError:
        return 0.0


def export(platform: str, students: int, folder: Path) -> Cost:
    """Return the cost of an export of a variant of each exercise for each student."""
    return cost_of(
        "export", platform, *EXERCISES, "--variants", str(students), "--lang", "fr", "--out", str(folder)
    )


def paper(formats: str, students: int, folder: Path, *more: str) -> Cost:
    """Return the cost of a paper of the exercises for each student, with its solutions."""
    tables = "".join(f'[[exercises]]\nname = "{name}"\n\n' for name in EXERCISES)
    assignment, roster = folder.with_suffix(".toml"), folder.with_suffix(".csv")
    assignment.write_text(f'title = "Scale"\nsecret = "{"0123456789abcdef" * 2}"\n\n{tables}', "utf-8")
    roster.write_text("\n".join(["student", *(f"s{number}" for number in range(students))]), "utf-8")
    plain = ("build", str(assignment), "--roster", str(roster), "--formats", formats, "--lang", "fr")
    return cost_of(*plain, *more, "--out", str(folder))


def booklet(students: int, folder: Path) -> Cost:
    """Return the cost of the same papers with booklets."""
    return paper("pdf", students, folder, "--with", "booklet")


def feedback(formats: str, students: int, folder: Path) -> Cost:
    """Return the cost of marking a sheet of each student, with feedback in these formats; none marks
    alone."""
    write_answers(folder, Mix(_ANSWERS * students, EXERCISES, students, 0.05, 0.3))
    form = ("--formats", formats) if formats else ("--no-feedback",)
    files = (str(folder / "answers.csv"), "--issued", str(folder / "issued.json"))
    told = (0, 1)  # by 1 it says that somebody must look at some answers
    return cost_of("grade", *files, *form, "--out", str(folder / "marks"), codes=told)


JOBS: dict[str, Callable[[int, Path], Cost]] = {
    **{platform: partial(export, platform) for platform in ("moodle", "stack", "canvas", "qti21", "qti3")},
    "notebooks": partial(paper, "ipynb"),
    "pages": partial(paper, "html"),
    "PDFs": partial(paper, "pdf"),
    "booklet": booklet,
    "marking": partial(feedback, ""),
    "feedback html": partial(feedback, "html"),
    "feedback pdf": partial(feedback, "pdf"),
}


def main(jobs: str = ",".join(JOBS), students: str = "30,100,300", folder: str = "build/scale") -> None:
    """Print a table of the jobs."""
    rows = []
    for job in jobs.split(","):
        before: tuple[int, float] | None = None
        for count in map(int, students.split(",")):
            home = Path(folder) / f"{job}{count}"
            shutil.rmtree(home, ignore_errors=True)
            home.parent.mkdir(parents=True, exist_ok=True)
            cost = JOBS[job](count, home)
            disk = sum(path.stat().st_size for path in home.rglob("*") if path.is_file()) / 1e6
            shutil.rmtree(home, ignore_errors=True)
            slope = before and math.log(cost.processor / before[1]) / math.log(count / before[0])
            rows.append(
                (
                    job,
                    str(count),
                    *(f"{value:.1f}" for value in (*cost, disk)),
                    f"{slope:.2f}" if slope else "",
                )
            )
            before = count, cost.processor
            print(*rows[-1], file=sys.stderr)
    heads = (
        "job",
        "students",
        "s",
        "processor s",
        "largest process, MB",
        "all processes, MB",
        "on disk, MB",
        "exponent",
    )
    print_table(heads, rows)


if __name__ == "__main__":
    main(*sys.argv[1:])
