"""One command at a time writes a folder; a lock whose process is gone is no hindrance."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import threading

import pytest

from coursework.errors import BadInput
from coursework.system import folder_lock
from coursework.system.folder_lock import LOCK, only_writer


@pytest.fixture(autouse=True)
def no_patience(monkeypatch):
    monkeypatch.setattr(folder_lock, "_FILLED", 0.1)


def locked_by(folder, **changed):
    folder.mkdir(exist_ok=True)
    (folder / LOCK).write_text(json.dumps({**folder_lock._this_process("build"), **changed}))


def test_a_second_writer_is_told_who_writes(tmp_path):
    with (
        only_writer(tmp_path / "out", "grade"),
        pytest.raises(BadInput) as told,
        only_writer(tmp_path / "out"),
    ):
        pass
    assert f"process {os.getpid()} on {socket.gethostname()} (coursework grade)" in str(told.value)
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


def ended():
    """The number of a process that has ended."""
    done = subprocess.Popen([sys.executable, "-c", ""])
    done.wait()
    return done.pid


@pytest.mark.parametrize(
    "changed",
    [
        lambda: {"pid": ended()},
        lambda: {"began": "1"},  # its number was given again
        lambda: {"boot": "an earlier one", "numbers": "another"},
        lambda: {"pid": 10**30},
    ],
    ids=["gone", "number given again", "before the start of the machine", "no number"],
)
def test_a_lock_whose_process_is_gone_is_taken_over(tmp_path, changed):
    locked_by(tmp_path, **changed())
    with only_writer(tmp_path):
        assert json.loads((tmp_path / LOCK).read_text()) == folder_lock._this_process("")
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("content", ["", "{", "[1]", "[" * 100_000, "\udcff"])
def test_a_lock_that_says_nothing_is_taken_over_after_a_while(tmp_path, content):
    (tmp_path / LOCK).write_bytes(content.encode("utf-8", "surrogateescape"))
    with only_writer(tmp_path):
        pass


@pytest.mark.parametrize("changed", [{"host": "elsewhere"}, {"numbers": "of a container"}])
def test_a_lock_of_another_machine_stands_and_says_where_it_is(tmp_path, changed):
    locked_by(tmp_path, **changed)
    with pytest.raises(BadInput, match=r"take .* away") as told, only_writer(tmp_path):
        pass
    assert str(tmp_path.resolve() / LOCK) in str(told.value)


def test_of_many_that_find_a_stale_lock_one_writes(tmp_path):
    """Each enters a number; while it is within, nobody else is. What is written by one is never the work of two."""
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
    for _ in range(60):
        locked_by(tmp_path, began="1")
        threads = [threading.Thread(target=writes, args=(n,)) for n in range(6)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        assert not [*tmp_path.iterdir()]
    assert max(most) == 1
    assert len(most) >= 60
    assert len(most) + len(refused) == 360


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(BadInput, match="cannot be written"), only_writer(tmp_path / "file" / "out"):
        pass
