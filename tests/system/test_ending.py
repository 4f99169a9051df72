"""Processes end with the one that began them, however that ended; told to end, they leave nothing half
written."""

from __future__ import annotations

import signal

import ending
import pytest
from site_server import until

pytestmark = [
    pytest.mark.skipif(not ending.HAS_SESSIONS, reason="processes of a session are counted on Linux"),
    pytest.mark.e2e,
]

WRITES = """
import sys, time
from functools import partial
from pathlib import Path
from coursework.system.writing import File, write_tree
from coursework.system import writing
from coursework.cli.options import complain
from coursework.system.ending import Ended, end_cleanly
from coursework.system.folder_lock import only_writer

def slow(mark):
    mark.touch()
    time.sleep(0.2)
    return b"x" * 100

if __name__ == "__main__":
    writing.workers = lambda *told: 2
    end_cleanly()
    out = Path("out")
    mark = Path("mark").resolve()
    files = [File(Path(f"{n}.txt"), partial(slow, mark), anywhere=True) for n in range(2000)]
    try:
        with only_writer(out):
            write_tree(out, files)
    except Ended as end:
        complain(str(end))
        raise
"""
BESIDE = """
import time
from pathlib import Path
from coursework.system.processes import background_process

def fill(mark):
    mark.touch()
    time.sleep(600)

if __name__ == "__main__":
    with background_process(fill, Path("mark").resolve()):
        time.sleep(600)
"""


@pytest.mark.parametrize("script", [WRITES, BESIDE], ids=["shared work", "work beside"])
def test_a_process_that_is_killed_leaves_no_other(tmp_path, script):
    process = ending.begun(tmp_path, script=script)
    assert until((tmp_path / "mark").exists), process.stderr.read()
    assert len(ending.at_work(process.pid)) > 1
    process.kill()
    assert until(lambda: not ending.at_work(process.pid))
    process.communicate()
    assert not [*(tmp_path / "tmp").iterdir()]


def test_a_process_that_is_told_to_end_puts_away_what_it_has_begun(tmp_path):
    process = ending.begun(tmp_path, script=WRITES)
    assert until((tmp_path / "mark").exists)
    process.terminate()
    _, said = ending.ended(process)
    assert process.returncode == 128 + signal.SIGTERM
    assert said.strip() == "coursework: ended by SIGTERM"
    assert until(lambda: not ending.at_work(process.pid))
    assert not (tmp_path / "out").exists()
    assert not [*(tmp_path / "tmp").iterdir()]


STUBBORN = """
import signal, time
from pathlib import Path
from coursework.system.processes import background_process

def fill(mark):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    mark.touch()
    time.sleep(600)

if __name__ == "__main__":
    mark = Path("mark").resolve()
    with background_process(fill, mark):
        while not mark.exists():
            time.sleep(0.05)
    Path("done").touch()
"""


def test_work_beside_that_does_not_end_when_told_is_ended(tmp_path):
    process = ending.begun(tmp_path, script=STUBBORN)
    assert until((tmp_path / "done").exists)
    assert process.wait(ending.LONGEST) == 0
    assert until(lambda: not ending.at_work(process.pid))
    process.communicate()


BEGINS = """
import os, signal
from coursework.system.ending import end_cleanly
from coursework.system.processes import uninterrupted

if __name__ == "__main__":
    end_cleanly()
    with uninterrupted():
        with uninterrupted():
            os.kill(os.getpid(), signal.SIGTERM)
            print("half", flush=True)
        print("whole", flush=True)
    print("beyond", flush=True)
"""


def test_what_is_being_begun_is_whole_before_the_end(tmp_path):
    process = ending.begun(tmp_path, script=BEGINS)
    told, said = ending.ended(process)
    assert (told, said, process.returncode) == ("half\nwhole\n", "", 128 + signal.SIGTERM)


ELSEWHERE = """
import signal, threading
from coursework.system.ending import end_cleanly

def is_told():
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)

if __name__ == "__main__":
    end_cleanly()
    never = threading.Lock()
    never.acquire()
    threading.Timer(0.5, is_told).start()
    never.acquire()
"""
DROPPED = """
import os, signal, time, weakref
from coursework.system.ending import end_cleanly

class Thing:
    pass

def told(thing):
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(600)

if __name__ == "__main__":
    end_cleanly()
    thing = Thing()
    seen = weakref.ref(thing, told)
    del thing
    time.sleep(600)
"""
SWALLOWED = """
import os, signal, time
from coursework.system.ending import end_cleanly

if __name__ == "__main__":
    end_cleanly()
    for number in (signal.SIGTERM, signal.SIGHUP):
        try:
            os.kill(os.getpid(), number)
            time.sleep(600)
        except BaseException:
            pass
    time.sleep(600)
"""


@pytest.mark.parametrize("script", [ELSEWHERE, DROPPED, SWALLOWED])
def test_a_process_that_did_not_hear_is_told_again(tmp_path, script):
    process = ending.begun(tmp_path, script=script)
    told, said = ending.ended(process)
    assert (told, said) == ("", "")
    assert process.returncode in (128 + signal.SIGTERM, 128 + signal.SIGHUP)


PUTS_AWAY = """
import os, signal, time
from coursework.system.ending import end_cleanly

if __name__ == "__main__":
    end_cleanly()
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(600)
    finally:
        try:
            os.kill(os.getpid(), signal.SIGHUP)
            raise ValueError
        except ValueError:
            time.sleep(1)
        print("put away", flush=True)
"""


def test_what_is_being_put_away_is_not_disturbed(tmp_path):
    process = ending.begun(tmp_path, script=PUTS_AWAY)
    assert ending.ended(process) == ("put away\n", "")
    assert process.returncode == 128 + signal.SIGTERM


ANSWERS = """
from pathlib import Path
from coursework.system.processes import processes

def received():
    return int(Path("/proc/self/io").read_text().split()[1])

if __name__ == "__main__":
    with processes(2) as submit:
        submit(bytes, 10).result()
        before = received()
        submit(bytes, 500_000_000)
        while received() < before + 20_000_000:
            pass
        raise SystemExit(3)
"""


def test_half_an_answer_is_not_waited_for(tmp_path):
    process = ending.begun(tmp_path, script=ANSWERS)
    assert ending.ended(process) == ("", "")
    assert process.returncode == 3
