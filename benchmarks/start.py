"""How long commands take from their start to their end, beside Python that does nothing.

    python benchmarks/start.py [ROUNDS]

Whole processes, one after another, a round of all of them in turn; a first round is not counted, and leaves
behind what Python compiled and what ``list`` keeps. ``list, nothing kept`` begins with an empty folder each
time.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PYTHON = "python -c pass"
SOLVE = "--set r1=228.6mm --set r2=114.3mm --set theta2=135deg --only rA,theta4"
COMMANDS = {
    "list": "list",
    "list, nothing kept": "list",
    "show": "show slotted_mechanism",
    "solve": f"solve slotted_mechanism {SOLVE}",
    "variant": "variant slotted_mechanism --seed 1 --json",
    "--help": "--help",
    "completion of a command": "coursework s",
    "completion of an exercise": "coursework show slo",
}
RUN = "import sys; from coursework.cli import main; sys.argv[0] = 'coursework'; main()"


def process(name, kept):
    """The arguments of one process, and its surroundings."""
    surroundings = {**os.environ, "XDG_CACHE_HOME": str(kept)}
    surroundings.pop("PYTHONDONTWRITEBYTECODE", None)
    if name == PYTHON:
        return [sys.executable, "-c", "pass"], surroundings
    if name == "list, nothing kept":
        surroundings["XDG_CACHE_HOME"] = tempfile.mkdtemp(dir=kept)
    words = COMMANDS[name].split()
    if name.startswith("completion"):
        surroundings |= {
            "_COURSEWORK_COMPLETE": "bash_complete",
            "COMP_WORDS": COMMANDS[name],
            "COMP_CWORD": str(len(words) - 1),
        }
        words = []
    return [sys.executable, "-c", RUN, *words], surroundings


def seconds(name, kept):
    """Wall and processor seconds of one process (user and system)."""
    command, surroundings = process(name, kept)
    begun, spent = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, env=surroundings, stdout=subprocess.DEVNULL, check=True)
    wall, ended = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, ended.ru_utime + ended.ru_stime - spent.ru_utime - spent.ru_stime


def table(measured, which):
    """Lines of a table: least, median and largest milliseconds, and the median as a multiple of bare
    Python's."""
    bare = statistics.median(times[which] for times in measured[PYTHON])
    for name, all_times in measured.items():
        times = sorted(1000 * pair[which] for pair in all_times)
        middle = statistics.median(times)
        yield f"| {name} | {times[0]:.0f} | {middle:.0f} | {times[-1]:.0f} | {middle / (1000 * bare):.1f} |"


def main(rounds):
    measured = {name: [] for name in (PYTHON, *COMMANDS)}
    with tempfile.TemporaryDirectory() as folder:
        for counted in range(-1, rounds):
            for name, times in measured.items():
                took = seconds(name, Path(folder))
                if counted >= 0:
                    times.append(took)
    for which, title in enumerate(("wall, ms", "processor, ms")):
        print(f"\n| {title} | least | median | most | × bare Python |\n|---|--:|--:|--:|--:|")
        print("\n".join(table(measured, which)))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
