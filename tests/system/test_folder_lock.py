"""One command at a time writes a folder; the lock of a process that has ended is no hindrance."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading

import pytest

from coursework.errors import BadInput
from coursework.system.folder_lock import LOCK, only_writer


def test_a_second_writer_is_told_who_writes(tmp_path):
    with (
        only_writer(tmp_path / "out", "grade"),
        pytest.raises(BadInput) as told,
        only_writer(tmp_path / "out"),
    ):
        pass
    assert f"coursework grade, PID {os.getpid()}, {socket.gethostname()}" in str(told.value)
    assert "\n" not in str(told.value)


def interrupted(folder):
    with only_writer(folder / "b"):
        (folder / "kept").touch()
        raise KeyboardInterrupt


def test_the_lock_goes_with_the_writer_and_so_does_a_folder_that_stays_empty(tmp_path):
    with only_writer(tmp_path / "a" / "b"):
        assert (tmp_path / "a" / "b" / LOCK).is_file()
    assert not [*tmp_path.iterdir()]
    with pytest.raises(KeyboardInterrupt):
        interrupted(tmp_path / "a")
    assert [p.name for p in tmp_path.rglob("*")] == ["a", "kept"]


KILLED = """
import os, signal, sys
from pathlib import Path
from coursework.system.folder_lock import only_writer
with only_writer(Path(sys.argv[1])):
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_lock_whose_process_was_killed_is_free(tmp_path):
    assert subprocess.run([sys.executable, "-c", KILLED, tmp_path], check=False).returncode
    assert f"PID {os.getpid()}," not in (tmp_path / LOCK).read_text()
    with only_writer(tmp_path):
        assert f"PID {os.getpid()}," in (tmp_path / LOCK).read_text()
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("content", ["", "{", "[" * 100_000, "\udcff"])
def test_a_file_that_nobody_has_locked_is_no_hindrance_and_one_that_says_nothing_no_fault(tmp_path, content):
    (tmp_path / LOCK).write_bytes(content.encode("utf-8", "surrogateescape"))
    with only_writer(tmp_path):
        (tmp_path / LOCK).write_bytes(content.encode("utf-8", "surrogateescape"))
        with pytest.raises(BadInput, match="another command"), only_writer(tmp_path):
            pass


def test_of_many_one_writes(tmp_path):
    """Each enters a number; while it is within, nobody else is. What is written by one is never the work of
    two."""
    within, most, refused = [], [], []

    def writes(number):
        try:
            with only_writer(tmp_path):
                within.append(number)
                most.append(len(within))
                pause.wait(0.002)
                within.remove(number)
        except BadInput:
            refused.append(number)

    pause = threading.Event()
    for _ in range(20):
        threads = [threading.Thread(target=writes, args=(n,)) for n in range(6)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        assert not [*tmp_path.iterdir()]
    assert max(most) == 1
    assert len(most) >= 20
    assert len(most) + len(refused) == 120


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(BadInput, match="cannot be written"), only_writer(tmp_path / "file" / "out"):
        pass
