"""A cluster gives the bytes that one machine gives, whatever happens to its workers, or says in a line what
is missing."""

from __future__ import annotations

import csv
import json
import os
import pickle
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from importlib.util import find_spec
from pathlib import Path

import pytest
from cluster_machines import PACKAGE, Machines

import coursework
from coursework.authoring.scaffold import new_course
from coursework.cli import run
from coursework.course import course_transfer
from coursework.course.course_transfer import Carried
from coursework.course.folder import course_folder
from coursework.errors import BadInput
from coursework.gradebook import class_marking
from coursework.system import cluster as clusters
from coursework.system.cluster import SELDOM, cluster
from coursework.system.processes import Lost, Task, in_turn, processes

pytestmark = [
    pytest.mark.e2e,
    pytest.mark.skipif(not find_spec("distributed"), reason="a cluster needs pip install -e '.[e2e]'"),
]

FORMATS = "pdf,html,ipynb,tex"


@pytest.fixture(scope="module")
def machines(tmp_path_factory):
    """A scheduler that has nothing of the package, and two workers."""
    with Machines(tmp_path_factory.mktemp("machines")) as machines:
        machines.scheduler()
        machines.workers(2, "--no-nanny")
        yield machines


@pytest.fixture(scope="module")
def course_of_one(tmp_path_factory):
    folder = tmp_path_factory.mktemp("course") / "mech"
    new_course(folder)
    return folder


def written(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def both(capsys, machines, *arguments, out=None):
    """What a command says and writes on one machine, and by the cluster."""
    said = []
    for name, more in (("one", ()), ("cluster", ("--cluster", machines.address))):
        place = () if out is None else ("--out", out / "same")
        capsys.readouterr()
        status = run([*map(str, (*arguments, *place, *more))])
        found = {} if out is None else written(out / "same")
        if out is not None:
            (out / "same").rename(out / name)
        said.append((status, capsys.readouterr(), found))
    return said


# ------------------------------------------------------------------ the same bytes


@pytest.mark.slow
def test_a_build_is_the_same_in_all_formats(capsys, machines, course_of_one, tmp_path):
    build = (
        "--course",
        course_of_one,
        "build",
        "--variants",
        3,
        "--lang",
        "fr,en",
        "--formats",
        FORMATS,
        "--with",
        "booklet",
    )
    one, cluster = both(capsys, machines, *build, out=tmp_path)
    assert one == cluster
    assert one[0] == 0
    assert len(one[2]) > 40


@pytest.fixture(scope="module")
def class_of_six(course_of_one, tmp_path_factory):
    """What was issued to six students, and what they answered: right, wrong, and nothing that can be read."""
    folder = tmp_path_factory.mktemp("class")
    (folder / "roster.csv").write_text("student\n" + "".join(f"s{i}\n" for i in range(6)), "utf-8")
    built = "--course", course_of_one, "build", "--roster", folder / "roster.csv", "--formats", "html"
    assert run([*map(str, (*built, "--out", folder / "built"))]) == 0
    key = json.loads((folder / "built" / "instructor" / "key.json").read_text("utf-8"))
    with (folder / "answers.csv").open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(("student", "exercise", "seed", "part", "answer"))
        for i, record in enumerate(key):
            place = record["student"], record["exercise"], record["seed"]
            answers = [(part, one["value"]) for part, one in record["answers"].items()]
            rows.writerows(
                (*place, part, value if i % 3 == 0 else -7 * i if i % 3 == 1 else "?")
                for part, value in answers
            )
        rows.writerow(("nobody", "crank_pin", 1, "rA", "3"))
    return folder


def test_marks_and_feedback_are_the_same(
    capsys, machines, course_of_one, class_of_six, tmp_path, monkeypatch
):
    monkeypatch.setattr(class_marking, "CHUNK", 2)
    grade = (
        "--course",
        course_of_one,
        "grade",
        class_of_six / "answers.csv",
        "--issued",
        class_of_six / "built" / "issued.json",
    )
    one, cluster = both(
        capsys, machines, *grade, "--formats", "pdf,html,ipynb", "--with-solutions", out=tmp_path
    )
    assert one == cluster
    assert one[0] == 1
    assert {"marks.csv", "summary.csv", "rejected.csv", "feedback/s0.pdf", "feedback/s5.ipynb"} <= set(one[2])


def test_a_report_is_the_same(capsys, machines, course_of_one, class_of_six, tmp_path):
    grade = (
        "--course",
        course_of_one,
        "grade",
        class_of_six / "answers.csv",
        "--issued",
        class_of_six / "built" / "issued.json",
    )
    run([*map(str, (*grade, "--no-feedback", "--out", tmp_path / "marks"))])
    report = "--course", course_of_one, "report", tmp_path / "marks"
    one, cluster = both(capsys, machines, *report, out=tmp_path)
    assert one == cluster
    assert one[0] == 0
    assert {"report.html", "report.pdf"} <= set(one[2])


def test_a_check_is_the_same(capsys, machines, course_of_one):
    """What is wrong with a course is told of its own folder."""
    one, cluster = both(capsys, machines, "--course", course_of_one, "check", "--variants", 5, "--json")
    assert one == cluster
    assert one[0] == 0


def test_a_fault_of_a_course_is_told_in_the_same_words(capsys, machines, tmp_path):
    folder = tmp_path / "broken"
    new_course(folder)
    (folder / "exercises" / "crank_pin.en.md.j2").write_text("{{ nonsense }}", "utf-8")
    (folder / "templates").mkdir(exist_ok=True)
    one, cluster = both(capsys, machines, "--course", folder, "check", "--variants", 3)
    assert one == cluster
    assert one[0] == 1
    one, cluster = both(
        capsys, machines, "--course", folder, "build", "--lang", "en", "--out", tmp_path / "out"
    )
    assert one == cluster
    assert one[0] == 2
    assert not (tmp_path / "out").exists() or not written(tmp_path / "out")


def slept(seconds):
    return [
        Task(f"task {i}", divmod if s is None else time.sleep, (7, 2) if s is None else (s,))
        for i, s in enumerate(seconds)
    ]


@pytest.fixture
def load(course_of_one):
    return Carried(course_folder(course_of_one))


def test_workers_of_this_machine_look_at_themselves_seldom(load):
    """Every hundredth of a second costs a tenth of their time."""
    import dask

    with cluster("local:1", load), processes(1) as submit:
        assert {name: submit(dask.config.get, name).result() for name in SELDOM} == SELDOM


def test_the_settings_that_the_docs_give_other_workers_are_those():
    import dask
    import yaml

    page = (Path(__file__).parents[2] / "docs" / "cluster.md").read_text("utf-8")
    (told,) = re.findall(r"^```yaml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    config = yaml.safe_load(told)
    assert {name: dask.config.get(name, config=config) for name in SELDOM} == SELDOM


def test_answers_come_in_turn_whatever_comes_back_first(machines, load):
    tasks = [Task("", os.path.join, (f"{i}", "x")) for i in range(30)]
    tasks[::7] = slept([0.3] * len(tasks[::7]))
    with cluster(machines.address, load):
        found = list(in_turn(tasks, 2))
    assert found == [None if i % 7 == 0 else f"{i}/x" for i in range(30)]


# ------------------------------------------------------------------- the course


def said(folder, word):
    """A course whose statement says a word."""
    if not folder.exists():
        new_course(folder)
    place = folder / "exercises" / "crank_pin.en.md.j2"
    text = place.read_text("utf-8")
    place.write_text(f"{text}\nThis is {word}.\n", "utf-8")
    return folder


def test_two_courses_and_two_states_of_one_stand_side_by_side(capsys, machines, tmp_path):
    first, second = said(tmp_path / "a" / "mech", "first"), said(tmp_path / "b" / "mech", "second")
    made = {}
    for turn, folder in enumerate([first, second, first]):
        out = tmp_path / f"out{turn}"
        build = (
            "--course",
            folder,
            "build",
            "--variants",
            4,
            "--lang",
            "en",
            "--formats",
            "html",
            "--out",
            out,
        )
        assert run([*map(str, (*build, "--cluster", machines.address))]) == 0
        made[turn] = {n: d for n, d in written(out).items() if n.startswith("handouts")}
        said(first, "third")
    for turn, word in enumerate([b"first", b"second", b"third"]):
        assert len(made[turn]) == 4
        assert all(b"This is " + word in page for page in made[turn].values())
    assert not any(b"third" in page for page in made[0].values())


def test_a_course_is_unpacked_once_by_its_content(machines, tmp_path):
    folder = said(tmp_path / "mech", "once")
    for _ in range(2):  # another run finds it there
        with cluster(machines.address, load := Carried(course_folder(folder))):
            list(in_turn((Task("", os.path.exists, (str(folder),)) for _ in range(12)), 2))
    places = list(machines.folder.rglob(f"{load.key[:24]}*"))
    assert [p.name for p in places] == [load.key[:24]] * len(places)
    assert 1 <= len(places) <= 2
    assert [p.name for p in places[0].iterdir()] == ["mech"]


def test_places_are_told_from_the_course_and_back(load, course_of_one):
    """A path of the course is that of the unpacked one where the task is done; what comes back names the
    place here."""

    def done(function, *told):
        return load.unpacked(pickle.loads(load.packed(function, told), buffers=[load.content]))

    inside = course_of_one / "exercises" / "crank_pin.py"
    assert done(os.path.isfile, str(inside)) is True
    assert done(os.path.isfile, f"{course_of_one}2/exercises/crank_pin.py") is False
    assert done(Path.exists, inside) is True
    assert done(os.fspath, inside) == str(inside)
    assert done("{} and {}".format, inside, "no place") == f"{inside} and no place"
    deep = [{"at": (inside, f"see {inside}, line 3")}, ["no place"] * 1000]
    assert done(list, deep) == deep
    with pytest.raises(FileNotFoundError):
        done(open, str(course_of_one / "nothing"))


def test_a_worker_whose_disk_is_full_is_named(course_of_one, tmp_path, monkeypatch):
    """Not to be taken for the disk of who called."""
    (tmp_path / "full").touch()  # a file where the folder is to be: as little room as on a full disk
    monkeypatch.setattr(course_transfer, "_home", lambda: tmp_path / "full")
    load = Carried(course_folder(course_of_one))
    made = pickle.loads(load.packed(os.path.exists, ("/",)), buffers=[load.content])
    with pytest.raises(
        coursework.errors.CourseworkError, match=r"^the worker on .* cannot unpack the course"
    ):
        load.unpacked(made)


# ------------------------------------------------------------------------ versions


def test_another_version_at_a_worker_is_told_in_a_line(capsys, machines, course_of_one, monkeypatch):
    here = {**course_transfer.versions(), "numpy": "1.0", "Python": "2.7"}
    monkeypatch.setattr(course_transfer, "versions", lambda: here)
    status = run(["--course", str(course_of_one), "check", "--variants", "3", "--cluster", machines.address])
    told = capsys.readouterr().err
    assert status == 2
    assert told.count("\n") == 1
    assert "Python: 3." in told
    assert "2.7 here" in told
    assert "1.0 here" in told


@pytest.mark.slow
def test_a_worker_without_the_package_is_told_in_a_line(tmp_path, load):
    with Machines(tmp_path) as machines:
        machines.scheduler()
        machines.worker("--no-nanny", path="")
        with (
            pytest.raises(coursework.errors.CourseworkError, match="does not have this package") as told,
            cluster(machines.address, load),
        ):
            list(in_turn(slept([0]), 2))
    assert "\n" not in str(told.value)


# ------------------------------------------------------------------------ addresses


@pytest.mark.parametrize(
    "address", ["local", "local:0", "localhost:8786", "http://127.0.0.1:1", "tcp://x", "local:-1"]
)
def test_an_address_that_is_none_is_told(address, load):
    with pytest.raises(BadInput, match="--cluster takes the address"), cluster(address, load):
        pass


def test_a_scheduler_that_is_not_there_is_told_in_a_line(capsys, course_of_one, monkeypatch):
    monkeypatch.setattr(clusters, "CONNECT", 1.0)
    before = threading.active_count()
    status = run(["--course", str(course_of_one), "check", "--cluster", "tcp://127.0.0.1:9"])
    told = capsys.readouterr().err
    assert status == 2
    assert told.startswith("coursework: no scheduler answers at tcp://127.0.0.1:9 (waited 1 s: ")
    assert told.count("\n") == 1
    assert threading.active_count() <= before + 3  # threads that Dask keeps for the next client


def test_a_port_that_says_nothing_is_told_in_a_line(load, monkeypatch):
    """As a scheduler is that was stopped, or another service."""
    monkeypatch.setattr(clusters, "CONNECT", 1.0)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(BadInput, match="no scheduler answers at"), cluster(address, load):
            pass


def test_without_dask_a_line_says_what_to_install(monkeypatch, load):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(BadInput, match=r"\[cluster\]"), cluster("local:2", load):
        pass


# ------------------------------------------------------------------------- faults


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr(clusters, "PATIENCE", 3.0)
    monkeypatch.setattr(clusters, "CONNECT", 2.0)


@pytest.fixture
def own_machines(tmp_path, impatient):
    """Machines of one test, whose scheduler gives up a worker that is silent for three seconds."""
    with Machines(tmp_path, SCHEDULER__WORKER_TTL="3s") as machines:
        machines.scheduler()
        yield machines


def meanwhile(what, after=1.0):
    """Do something while tasks are being done."""

    def wait():
        time.sleep(after)
        what()

    thread = threading.Thread(target=wait)
    thread.start()
    return thread


ALL = [f"{i}\n".encode() for i in range(24)]


def done_through(fault, machines, load):
    """What tasks of a quarter of a second give, of which some are done and some are not when a fault
    happens."""
    tasks = [
        Task(f"task {i}", subprocess.check_output, (["sh", "-c", f"sleep 0.25; echo {i}"],))
        for i in range(len(ALL))
    ]
    with cluster(machines.address, load):
        thread = meanwhile(fault)
        try:
            return list(in_turn(tasks, 2))
        finally:
            thread.join()


def lost_by(fault, machines, load):
    """What is told where a fault ends the run."""
    with pytest.raises(Lost) as told:
        done_through(fault, machines, load)
    assert "\n" not in str(told.value)
    assert threading.main_thread() is threading.current_thread()
    return str(told.value)


def children(process):
    """The processes that one has started."""
    found = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False)
    return [int(pid) for pid in found.stdout.split()]


def test_a_worker_that_is_killed_costs_nothing(own_machines, load):
    first, _ = own_machines.workers(2, "--no-nanny")
    assert done_through(first.kill, own_machines, load) == ALL


def test_when_no_worker_is_left_the_missing_is_named(own_machines, load):
    workers = own_machines.workers(2, "--no-nanny")
    told = lost_by(lambda: [worker.kill() for worker in workers], own_machines, load)
    assert told.startswith(f"no worker is left at {own_machines.address} (waited 3 s): task ")
    assert told.endswith("is not done, and later steps may not be")


def test_a_worker_that_comes_late_does_what_waits(own_machines, load):
    (first,) = own_machines.workers(1, "--no-nanny")

    def another():
        first.kill()
        own_machines.worker("--no-nanny")

    clusters.PATIENCE = 30.0
    assert done_through(another, own_machines, load) == ALL


@pytest.mark.slow
def test_workers_that_a_nanny_starts_again_go_on(own_machines, load):
    nannies = own_machines.workers(2)
    clusters.PATIENCE = 30.0
    assert (
        done_through(
            lambda: [os.kill(pid, signal.SIGKILL) for n in nannies for pid in children(n)[-1:]],
            own_machines,
            load,
        )
        == ALL
    )


@pytest.mark.slow
def test_a_worker_that_falls_silent_is_given_up(own_machines, load):
    """As one does whose network stalls."""
    first, _ = own_machines.workers(2, "--no-nanny")
    clusters.PATIENCE = 30.0
    assert done_through(lambda: os.kill(first.pid, signal.SIGSTOP), own_machines, load) == ALL


def test_a_scheduler_that_is_killed_ends_the_run(own_machines, load):
    own_machines.workers(1, "--no-nanny")
    told = lost_by(own_machines.started[0].kill, own_machines, load)
    assert told.startswith(f"the scheduler at {own_machines.address} no longer answers (waited 3 s): task ")


@pytest.mark.slow
def test_a_scheduler_that_falls_silent_ends_the_run(own_machines, load):
    own_machines.workers(1, "--no-nanny")
    told = lost_by(lambda: os.kill(own_machines.started[0].pid, signal.SIGSTOP), own_machines, load)
    assert "no longer answers" in told


@pytest.mark.slow
def test_a_scheduler_that_is_started_again_goes_on(own_machines, load):
    own_machines.workers(2, "--no-nanny")
    clusters.PATIENCE = 60.0

    def restart():
        own_machines.started[0].kill()
        own_machines.started[0].wait()
        own_machines.scheduler()
        own_machines.worker("--no-nanny")

    assert done_through(restart, own_machines, load) == ALL


def test_what_is_called_off_is_not_kept_by_the_scheduler(machines, load):
    def stopped():
        with cluster(machines.address, load):
            for done in in_turn([Task("", time.sleep, (0.2,)) for _ in range(20)], 2):
                assert done is None
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    Machines.wait_for(lambda: machines.asked("len(s.tasks)") == "0", 20)


# --------------------------------------------------------------- whole commands

MAIN = "import sys\nfrom coursework.cli import main\nif __name__ == '__main__':\n    sys.exit(main())\n"


def begun(place, *arguments):
    """A command in a process of its own, in a session of its own."""
    script = place / "main.py"
    script.write_text(MAIN, "utf-8")
    return subprocess.Popen(
        [sys.executable, "-P", str(script), *map(str, arguments)],
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env={**os.environ, "PYTHONPATH": str(PACKAGE)},
    )


def of_session(process):
    found = subprocess.run(["pgrep", "-s", str(process.pid)], capture_output=True, text=True, check=False)
    return found.stdout.split()


def a_long_build(course, out, variants):
    return "--course", course, "build", "--variants", variants, "--formats", "pdf,html", "--out", out


@pytest.mark.slow
@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGKILL])
def test_a_command_that_is_stopped_leaves_nothing_behind(course_of_one, tmp_path, stop):
    out = tmp_path / "out"
    command = begun(tmp_path, *a_long_build(course_of_one, out, 600), "--cluster", "local:2")
    Machines.wait_for(lambda: len(list(out.glob(".building/new/**/*.pdf"))) > 3)
    command.send_signal(stop)
    _, told = command.communicate(timeout=60)
    Machines.wait_for(lambda: not of_session(command), 30)
    if stop == signal.SIGINT:
        assert (command.returncode, told.strip()) == (2, "coursework: interrupted")
        assert not written(out)
    else:
        assert not (out / "issued.json").exists()


@pytest.mark.slow
def test_a_build_through_the_death_of_workers_is_the_same(own_machines, course_of_one, tmp_path):
    own_machines.workers(3, "--no-nanny")
    out, build = tmp_path / "out", a_long_build(course_of_one, tmp_path / "out", 120)
    command = begun(tmp_path, *build, "--cluster", own_machines.address)
    Machines.wait_for(lambda: len(list(out.glob(".building/new/**/*.pdf"))) > 3)
    for worker in own_machines.started[1:3]:
        worker.kill()
    _, told = command.communicate(timeout=300)
    assert (command.returncode, told) == (0, "")
    made = written(out)
    out.rename(tmp_path / "cluster")
    assert run([*map(str, build)]) == 0
    assert made == written(out)


def test_a_build_whose_cluster_is_gone_writes_nothing(own_machines, course_of_one, tmp_path, capsys):
    own_machines.workers(1, "--no-nanny")
    out = tmp_path / "out"

    def end_in_the_middle():
        Machines.wait_for(lambda: len(list(out.glob(".building/new/**/*.pdf"))) > 3)
        own_machines.started[1].kill()

    thread = meanwhile(end_in_the_middle)
    build = a_long_build(course_of_one, out, 600)
    status = run([*map(str, (*build, "--cluster", own_machines.address))])
    thread.join()
    told = capsys.readouterr().err
    assert status == 2
    assert told.startswith(f"coursework: no worker is left at {own_machines.address}")
    assert told.count("\n") == 1
    assert not written(out)


@pytest.mark.slow
def test_a_scheduler_that_speaks_tls(tmp_path, load, monkeypatch):
    import dask
    from distributed import LocalCluster
    from distributed.security import Security

    keys = Security.temporary()
    told = {
        "ca-file": keys.tls_ca_file,
        "client.cert": keys.tls_client_cert,
        "client.key": keys.tls_client_key,
    }
    told = {f"distributed.comm.tls.{name}": value for name, value in told.items()}
    started = {
        "n_workers": 1,
        "threads_per_worker": 1,
        "processes": True,
        "security": keys,
        "dashboard_address": "127.0.0.1:0",
    }
    with LocalCluster(**started, host="127.0.0.1", protocol="tls") as there, dask.config.set(told):
        assert there.scheduler_address.startswith("tls://")
        with cluster(there.scheduler_address, load):
            assert list(in_turn([Task("", divmod, (7, 2))], 2)) == [(3, 1)]
