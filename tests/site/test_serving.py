"""The command that serves: its one line, its end, and what it refuses."""

import re
import signal
import socket
import subprocess
import sys
import threading
import time
from functools import cache
from pathlib import Path

import httpx
import pytest
from site_assignments import dealt, handed_in, right
from site_people import ZOE, Class
from site_server import Served, kill, lives, until

from coursework import open_course
from coursework.cli import run
from coursework.database.current_marks import adjusted_sheets
from coursework.database.pool import Pooled, pools, put_pooled
from coursework.database.publication import Publication
from coursework.database.store import Store

pytestmark = pytest.mark.e2e

needs_processes = pytest.mark.skipif(
    not Path("/proc/self/stat").exists(), reason="this system does not list processes in /proc"
)


def answers(url):
    return httpx.get(f"{url}/no-such-page", trust_env=False, timeout=30).status_code


#: A run that ignores one, as under nohup, leaves that to what it starts.
each_end = pytest.mark.parametrize(
    "number",
    [
        pytest.param(
            one, marks=pytest.mark.skipif(signal.getsignal(one) == signal.SIG_IGN, reason="ignored here")
        )
        for one in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    ],
)


@each_end
def test_it_says_where_it_is_and_ends_cleanly(tmp_path, number):
    with Served(tmp_path, "serve", "--port", "0") as site:
        assert (
            site.said.read_text()
            == f"coursework: {site.url}/ (kept in {tmp_path / 'coursework.db'}; Ctrl-C ends it)\n"
        )
        assert answers(site.url) == 404
        assert site.end(number) == 0
        assert "Traceback" not in site.log.read_text()


TOLD_TO_END_AT_ONCE = """
import os, signal, sys
from coursework.site.server import listening, run
async def nothing(scope, receive, send): pass
def made(): return nothing
def end(): os.kill(os.getpid(), int(sys.argv[1])); print("told")
if __name__ == "__main__": run(made, listening("127.0.0.1", 0), int(sys.argv[2]), ready=end)
"""


@each_end
@pytest.mark.parametrize("workers", [1, 2])
def test_it_ends_cleanly_where_it_is_told_to_as_soon_as_it_says_where_it_is(tmp_path, number, workers):
    script = tmp_path / "at_once.py"
    script.write_text(TOLD_TO_END_AT_ONCE)
    command = [sys.executable, script, str(int(number)), str(workers)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (ended.returncode, ended.stdout) == (0, "told\n"), ended.stderr


@needs_processes
@pytest.mark.parametrize("workers", [1, 2])
def test_halves_of_requests_do_not_fill_it(tmp_path, workers):
    """It holds as many connections as the machine lets it, and not the usual 1024 that one person can
    open."""
    with Served(tmp_path, "serve", "--port", "0", "--workers", workers) as site:
        asked = (
            until(lambda: len(site.workers) == workers and site.workers)
            if workers > 1
            else [site.process.pid]
        )
        for pid in asked:
            limits = Path(f"/proc/{pid}/limits").read_text()
            least, most = re.search(r"Max open files +(\d+) +(\d+)", limits).groups()
            assert int(least) == min(int(most), 65_536)


@needs_processes
def test_processes_are_begun_again_and_end_with_the_first(tmp_path):
    with Served(tmp_path, "serve", "--port", "0", "--workers", "2") as site:
        first = until(lambda: len(site.workers) == 2 and site.workers)
        assert answers(site.url) == 404
        kill(first[0])
        # It may be taken for one that is slow.
        until(lambda: first[0] not in site.workers and len(site.workers) == 2, 120)
        assert answers(site.url) == 404
        now = site.workers
        assert site.end() == 0
        assert not any(lives(pid) for pid in now)


@needs_processes
def test_no_process_outlives_the_first_that_is_killed(tmp_path):
    with Served(tmp_path, "serve", "--port", "0", "--workers", "2") as site:
        workers = until(lambda: len(site.workers) == 2 and site.workers)
        answers(site.url)
        site.kill()
        until(lambda: not any(lives(pid) for pid in workers))


@needs_processes
@pytest.mark.parametrize("workers", [1, 2])
def test_one_process_finds_variants_ahead_and_ends_with_the_first(tmp_path, workers):
    with Served(tmp_path, "serve", "--port", "0", "--workers", workers) as site:
        until(lambda: len(site.workers) == (workers if workers > 1 else 0))
        (filler,) = until(lambda: site.fillers)
        # It is the last to have a processor: with other tests beside it that takes minutes.
        until(lambda: len(found_ahead(tmp_path)) > 1, 300)
        assert site.fillers == [filler]
        site.kill()
        until(lambda: not lives(filler))


@needs_processes
@pytest.mark.parametrize("workers", [1, 2])
def test_one_process_marks_is_begun_again_and_ends_with_the_first(tmp_path, workers):
    with Served(tmp_path, "serve", "--port", "0", "--workers", workers) as site:
        (marker,) = until(lambda: site.markers)
        kill(marker)
        (again,) = until(lambda: not lives(marker) and [one for one in site.markers if one != marker])
        site.kill()
        until(lambda: not lives(again))


@needs_processes
def test_what_is_handed_in_is_marked_by_the_process_beside(tmp_path):
    one = Class(f"sqlite:///{tmp_path}/coursework.db")
    number = dealt(one, Publication(tries=None))
    one.site.has_worker = True
    handed_in(one.browser(ZOE), number, right(one, ZOE))

    def marks():
        with one.site.store.reading() as connection:
            return len(adjusted_sheets(connection, number, ZOE)[-1])

    assert marks() == 0
    with Served(tmp_path, "serve", "--port", "0") as site:
        until(lambda: marks() == 2)
        assert site.end() == 0
        assert "Traceback" not in site.log.read_text()
    one.site.store.close()


@needs_processes
def test_what_finds_variants_ahead_ends_with_a_server_that_ends_cleanly(tmp_path):
    with Served(tmp_path, "serve", "--port", "0") as site:
        (filler,) = until(lambda: site.fillers)
        assert site.end() == 0
        assert not lives(filler)
        assert not site.log.read_text()


@needs_processes
def test_no_process_is_begun_where_all_was_found(tmp_path):
    course, store = open_course(), Store(str(tmp_path / "coursework.db"))
    with store.begin() as connection:
        for name in course:
            put_pooled(connection, name, course[name].version, Pooled(tuple(range(60)), name == "grashof"))
    store.close()
    with Served(tmp_path, "serve", "--port", "0") as site:
        assert answers(site.url) == 404
        assert not site.fillers


@cache
def versions():
    course = open_course()
    return {name: course[name].version for name in course}


def found_ahead(folder):
    store = Store(str(folder / "coursework.db"))
    try:
        with store.reading() as connection:
            return pools(connection, versions())
    finally:
        store.close()


def test_a_request_under_way_is_answered_before_the_end(tmp_path):
    found = []
    with Served(tmp_path, "serve", "--port", "0") as site:
        answers(site.url)
        host, port = site.url.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port)), timeout=30) as line:
            body = b"back=/practice"
            head = (
                f"POST /language HTTP/1.1\r\nHost: {host}:{port}\r\nContent-Type: "
                f"application/x-www-form-urlencoded\r\nContent-Length: {len(body)}\r\n\r\n"
            )
            line.sendall(head.encode() + body[:5])
            time.sleep(0.5)
            ending = threading.Thread(target=lambda: found.append(site.end()))
            ending.start()
            time.sleep(0.5)
            line.sendall(body[5:])
            assert line.recv(100).startswith(b"HTTP/1.1 403")
        ending.join()
    assert found == [0]


def test_other_machines_are_served_once_an_instructor_can_come_in(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    address = ("--url", "https://mechanics.example.org")
    assert "no administrator has an account" in refusal(capsys, "--port", "0", *address)
    assert run(["serve", *address, "--instructor", "ada@example.org"]) == 0
    link = capsys.readouterr().out.strip()
    assert link.startswith("https://mechanics.example.org/invitation/")
    with Served(tmp_path, "serve", "--port", "0", *address, "--no-open") as site:
        assert site.url == address[1]


def test_an_address_that_is_told_asks_for_accounts_on_this_machine_too(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = str(free.getsockname()[1])
    address = ("--port", port, "--url", f"http://127.0.0.1:{port}")
    assert "no administrator has an account" in refusal(capsys, *address)
    assert run(["serve", *address, "--instructor", "ada@example.org"]) == 0
    with Served(tmp_path, "serve", *address) as site:
        assert "/sign-in" in httpx.get(f"{site.url}/desk", trust_env=False, timeout=30).headers["location"]


def refusal(capsys, *arguments):
    assert run(["serve", *arguments]) == 2
    said = capsys.readouterr()
    assert not said.out
    assert said.err.startswith("coursework: ")
    return said.err


def test_a_port_that_is_taken_is_told_with_what_to_do(capsys, tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        said = refusal(capsys, "--port", str(port), "--db", str(tmp_path / "x.db"))
    assert f"port {port} of 127.0.0.1 is in use" in said
    assert f"--port {port + 1}" in said


@pytest.mark.parametrize(
    ("told", "says"),
    [
        (("--port", "70000"), "at most 65,535"),
        (("--port", "0", "--host", "203.0.113.7"), "127.0.0.1 is for this machine only"),
        (("--port", "0", "--host", "0.0.0.0"), "--url https://"),
        (("--port", "0", "--url", "mechanics.example.org"), "found 'mechanics.example.org'"),
        (("--port", "0", "--url", "https://example.org/mechanics"), "no path"),
        (("--demo", "x", "--db", "y"), "--demo has its own database"),
        (("--port", "0", "--db", "mysql://x/y"), "mysql"),
        (("--port", "0", "--db", "/no/such/folder/x.db"), "/no/such/folder"),
    ],
)
def test_what_cannot_be_served_is_told(capsys, tmp_path, monkeypatch, told, says):
    monkeypatch.chdir(tmp_path)
    assert says in refusal(capsys, *told)
