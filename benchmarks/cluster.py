"""A cluster beside the processes of one machine: the same marking and the same sheets, by 1, 2 and 4 workers.

python benchmarks/cluster.py [ANSWERS] [SHEETS] [FOLDER]

A scheduler and its workers are processes of this machine, started before the clock with the settings of
docs/cluster.md (variables of the environment go before them). Every round runs each way once, in turn; told
are the least seconds of the whole command by the clock, the least of the processor (of all processes
together, which says more where others take the processors too), the most memory of the process that was
called, and whether what it wrote is, byte by byte, what one machine writes. Feedback sheets are not made.

python benchmarks/cluster.py memory [ANSWERS …]

The most memory of the process that was called, by how many answers it marks, with a cluster and without; in
one file, and in files of 50 000.

python benchmarks/cluster.py caller [ANSWERS …]

The same of the caller alone: nobody marks, and every answer has the same mark at once. What the caller reads,
keeps, puts in order and writes is what it is otherwise, and a million answers take a minute.
"""

from __future__ import annotations

import hashlib
import itertools
import os
import resource
import shutil
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

from marking import write
from timing import print_table

from coursework.system.cluster import SELDOM

RUN = "import sys; from coursework.cli import main; sys.exit(main())"
ALONE = """
from coursework.gradebook import class_marking

def answered_as(part, text):
    return part, text, "1.234", "wrong", 0.0, 1.0, "fr", (), False, "", f"Pas tout à fait : {part}."

def answered(course, chunks, answers, how):
    for chunk in chunks:
        yield [[answered_as(part, str(answer)) for part, answer in job.answers.items()] for job in chunk]

class_marking._marked_chunks = answered
"""
IN_A_FILE = 50_000
ROUNDS = int(os.environ.get("ROUNDS", "3"))


@contextmanager
def machines(folder, count):
    """A scheduler and so many workers: its address, and their processes."""
    with socket.socket() as asked:
        asked.bind(("127.0.0.1", 0))
        port = asked.getsockname()[1]
    address, log = f"tcp://127.0.0.1:{port}", folder.joinpath("cluster.log").open("wb")
    dask = [sys.executable, "-m", "dask"]
    scheduler = [
        *dask,
        *"scheduler --host 127.0.0.1 --port".split(),
        str(port),
        "--no-dashboard",
        "--no-show",
    ]
    worker = [
        *dask,
        "worker",
        address,
        *"--nthreads 1 --no-dashboard --no-nanny --local-directory".split(),
        str(folder),
    ]
    seldom = {
        "DASK_" + name.replace(".", "__").replace("-", "_").upper(): str(value)
        for name, value in SELDOM.items()
    }
    environment = {"OPENBLAS_NUM_THREADS": "1", **seldom, **os.environ}
    started = [
        subprocess.Popen(told, stdout=log, stderr=log, env=environment)
        for told in (scheduler, *[worker] * count)
    ]
    try:
        from distributed import Client

        with Client(address, timeout=60, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=60)
        yield address, started
    finally:
        for process in started:
            process.kill()
            process.wait()
        log.close()


def processor(process):
    """Seconds of the processor that a process has had."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def command(arguments, out, others=(), *, first=""):
    """Of a whole command: seconds, seconds of the processor with those of others, megabytes of its own
    process at most, and the digest of what it wrote."""
    shutil.rmtree(out, ignore_errors=True)
    start, before = time.perf_counter(), sum(map(processor, others))
    told = [sys.executable, "-P", "-c", first + RUN, *map(str, arguments), "--out", str(out)]
    process = subprocess.Popen(told, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, used = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    busy = used.ru_utime + used.ru_stime + sum(map(processor, others)) - before
    digest = hashlib.sha256()
    for path in sorted(p for p in out.rglob("*") if p.is_file()):
        digest.update(f"{path.relative_to(out)}\0".encode() + path.read_bytes())
    assert digest.hexdigest() != hashlib.sha256().hexdigest(), "nothing was written"
    return seconds, busy, used.ru_maxrss / 1024, digest.hexdigest()


def compare(name, arguments, folder, counts=(1, 2, 4)):
    """A row a way, of a job on one machine and by clusters."""
    found: dict[str, list] = {}
    for _ in range(ROUNDS):
        found.setdefault("processes of one machine", []).append(command(arguments, folder / "out"))
        for count in counts:
            with machines(folder, count) as (address, others):
                way = f"{count} worker{'s' * (count > 1)}"
                told = command([*arguments, "--cluster", address], folder / "out", others)
                found.setdefault(way, []).append(told)
    usual = next(iter(found.values()))
    rows = []
    for way, runs in found.items():
        (seconds, busy), (_, first) = (
            [min(run[i] for run in them) for i in range(2)] for them in (runs, usual)
        )
        same = all(run[3] == usual[0][3] for run in runs)
        told = f"{max(run[2] for run in runs):.0f}", "the same" if same else "OTHER"
        rows.append((way, f"{seconds:.1f}", f"{busy:.1f}", f"{100 * (busy / first - 1):+.0f} %", *told))
    heads = "s", "s of the processor", "beside one machine", "MB of the caller", "bytes"
    print_table((name, *heads), rows)


def marking_of(count, folder):
    rows = write(folder / str(count), count, mixed=True)
    home = folder / str(count)
    return rows, ["grade", home / "answers.csv", "--issued", home / "issued.json", "--no-feedback"]


def in_files(grade):
    """The same command of the same answers, in several files."""
    home = grade[1].with_name("parts")
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir()
    with grade[1].open(encoding="utf-8", newline="") as file:
        heading = next(file)
        for number in itertools.count():
            rows = list(itertools.islice(file, IN_A_FILE))
            if not rows:
                return ["grade", home, *grade[2:]]
            (home / f"{number:04}.csv").write_text(heading + "".join(rows), "utf-8", newline="")


def memory(counts, folder):
    rows = []
    with machines(folder, 2) as (address, _):
        for count in counts:
            told, grade = marking_of(count, folder)
            for come, asked in (("one file", grade), ("files", in_files(grade))):
                for way, more in (("one machine", []), ("2 workers", ["--cluster", address])):
                    seconds, _, most, _ = command([*asked, *more], folder / "out")
                    rows.append((f"{told:,}", come, way, f"{seconds:.1f}", f"{most:.0f}"))
    print_table(("answers", "in", "by", "s", "MB of the caller"), rows)


def caller(counts, folder):
    rows = []
    for count in counts:
        told, grade = marking_of(count, folder)
        for come, asked in (("one file", grade), ("files", in_files(grade))):
            seconds, _, most, _ = command(asked, folder / "out", first=ALONE)
            rows.append((f"{told:,}", come, f"{seconds:.1f}", f"{most:.0f}"))
    print_table(("answers", "in", "s", "MB of the caller"), rows)


def main(arguments):
    folder = Path("build/cluster")
    folder.mkdir(parents=True, exist_ok=True)
    print(
        f"{len(os.sched_getaffinity(0))} processors; open files at most "
        f"{resource.getrlimit(resource.RLIMIT_NOFILE)[0]}"
    )
    ways = {"memory": memory, "caller": caller}
    if arguments and arguments[0] in ways:
        ways[arguments[0]]([*map(int, arguments[1:])] or [100_000, 1_000_000], folder)
        return
    answers, sheets, *_ = (
        [*map(int, arguments), 200_000, 300][:2] if len(arguments) < 2 else map(int, arguments)
    )
    rows, grade = marking_of(answers, folder)
    compare(f"{rows:,} answers as people write them", grade, folder)
    build = ["build", "slotted_mechanism", "--variants", sheets, "--formats", "pdf"]
    compare(f"{sheets} sheets and their solutions, PDF", build, folder)


if __name__ == "__main__":
    main(sys.argv[1:])
