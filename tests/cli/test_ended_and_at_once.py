"""Commands that are killed, told to end, or begun twice: no process stays, no folder holds the work of
two."""

from __future__ import annotations

import csv
import json
import signal

import ending
import pytest
from class_of_three import table
from site_server import until

from coursework.authoring.scaffold import new_exercise
from coursework.cli import run

sessions = pytest.mark.skipif(not ending.HAS_SESSIONS, reason="processes of a session are counted on Linux")
STUDENTS = 7000  #: with three answers each, so many that several processes mark them


@pytest.fixture
def course(small_course):
    """Two exercises that take a while to check."""
    new_exercise(small_course, "crank_pin_too")
    return small_course


def answers(course, place):
    """A build of one variant, and more answers to it than one process marks."""
    assert (
        run(["--course", str(course), "build", "crank_pin", "--formats", "ipynb", "--out", str(place / "b")])
        == 0
    )
    (record,) = [i["record"] for i in json.loads((place / "b" / "issued.json").read_text())["issued"]]
    with (place / "all.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("student", "exercise", "seed", "part", "answer"))
        for n in range(STUDENTS):
            for part in record["parts"]:
                writer.writerow((f"s{n}", "crank_pin", record["seed"], part["id"], f"{n}/7"))
    return "grade", "all.csv", "--issued", "b/issued.json", "--out", "out", "--no-feedback"


JOBS = {
    "build": lambda course, place: (
        "build",
        "crank_pin",
        "--variants",
        "400",
        "--formats",
        "html",
        "--out",
        "out",
    ),
    "check": lambda course, place: ("check", "--variants", "200000"),
    "grade": answers,
}


@sessions
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("job", [pytest.param(job, marks=pytest.mark.slow) for job in JOBS])
def test_whatever_ends_a_command_no_process_of_it_stays(course, tmp_path, job, number):
    words = JOBS[job](course, tmp_path)
    process = ending.begun(tmp_path, "--course", course, *words)
    assert until(lambda: len(ending.at_work(process.pid)) >= 4 or process.poll() is not None)
    assert process.poll() is None, process.communicate()
    process.send_signal(number)
    said = ending.ended(process)[1]
    assert until(lambda: not ending.at_work(process.pid))
    assert not [*(tmp_path / "tmp").iterdir()]
    if number != signal.SIGKILL:
        assert process.returncode == 128 + number
        assert said == f"coursework: ended by {number.name}\n"
        assert not ending.left_in(tmp_path)
        assert not (tmp_path / "out").exists()


def twice(place, *words):
    """A command begun twice at once: of each the status and what it said."""
    both = [ending.begun(place, *words) for _ in range(2)]
    said = [ending.ended(process) for process in both]
    return [(process.returncode, *one) for process, one in zip(both, said, strict=True)]


def one_at_least_did_it(ended):
    """Who did not do it says in a line that another does."""
    for status, _, err in ended:
        assert status in (0, 2)
        if status == 2:
            assert err.startswith("coursework: another command is writing into ")
            assert err.count("\n") == 1
    assert 0 in [status for status, _, _ in ended]


TIMES = [0, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 12))]


@pytest.mark.e2e
@pytest.mark.parametrize("time", TIMES)
def test_two_builds_at_once_leave_a_whole_one(small_course, tmp_path, time):
    (tmp_path / "r.csv").write_text("student\n" + "\n".join(f"S{n}" for n in range(12)), "utf-8")
    words = (
        "--course",
        small_course,
        "build",
        "crank_pin",
        "--roster",
        "r.csv",
        "--formats",
        "html",
        "--out",
        "out",
    )
    one_at_least_did_it(twice(tmp_path, *words))
    assert len([*(tmp_path / "out" / "handouts").rglob("*.html")]) == 12
    assert len([*(tmp_path / "out" / "instructor").rglob("*.html")]) == 12
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "handouts",
        "instructor",
        "issued.json",
        "answers.csv",
        ".built.json",
    }


@pytest.mark.e2e
@pytest.mark.parametrize("time", TIMES)
def test_two_gradings_at_once_leave_the_marks_of_one(small_course, tmp_path, time):
    assert (
        run(["--course", str(small_course), *"build crank_pin --formats ipynb --out".split(), str(tmp_path)])
        == 0
    )
    (record,) = [i["record"] for i in json.loads((tmp_path / "issued.json").read_text())["issued"]]
    part = record["parts"][0]["id"]
    for name in ("ada", "bob"):
        rows = [f"{name}{n},crank_pin,{record['seed']},{part},1" for n in range(200)]
        (tmp_path / f"{name}.csv").write_text(
            "\n".join(["student,exercise,seed,part,answer", *rows]), "utf-8"
        )
    words = "--course", small_course, "grade"
    more = "--issued", "issued.json", "--out", "marks", "--no-feedback"
    both = [(name, ending.begun(tmp_path, *words, f"{name}.csv", *more)) for name in ("ada", "bob")]
    ended = {name: (ending.ended(p), p.returncode) for name, p in both}
    one_at_least_did_it([(status, *said) for said, status in ended.values()])
    of_whom = {row["student"].rstrip("0123456789") for row in table(tmp_path / "marks" / "marks.csv")}
    assert len(of_whom) == 1
    assert len(table(tmp_path / "marks" / "marks.csv")) == 200
    done = [name for name, (_, status) in ended.items() if status == 0]
    assert of_whom <= set(done)
    assert not ending.left_in(tmp_path)
