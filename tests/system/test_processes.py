"""Processes that share a large job, and how they end."""

from __future__ import annotations

import signal
import time

import pytest
from ending import at_work, begun, ended
from site_server import until
from tables import each_row

import coursework.system.processes as processes_module
from coursework.system.processes import processes


def fail_at_work(fault, tasks):
    """Raise a fault while two processes are at work; more tasks wait."""
    with processes(2) as submit:
        submit(time.monotonic).result()  # they have started
        tasks += [submit(time.sleep, 120) for _ in range(8)]
        while not tasks[1].running():
            time.sleep(0.05)
        raise fault


@each_row("fault", [KeyboardInterrupt, ValueError])
def test_a_fault_ends_the_processes_whatever_they_do(fault):
    tasks, started = [], time.monotonic()
    with pytest.raises(fault):
        fail_at_work(fault, tasks)
    assert time.monotonic() - started < 60
    assert all(task.done() for task in tasks)


def test_a_lock_that_an_interrupted_thread_has_left_taken_keeps_nobody(monkeypatch):
    """The executor's thread waits for it for ever."""
    monkeypatch.setattr(processes_module, "_PATIENCE", 0.5)
    tasks, started = [], time.monotonic()

    class Interrupted(Exception):
        def __init__(self):
            tasks[1]._condition.acquire()

    try:
        with pytest.raises(Interrupted):
            fail_at_work(Interrupted, tasks)
        assert time.monotonic() - started < 60
    finally:
        tasks[1]._condition.release()


STUCK = """
import os, signal, time
from coursework import cli
from coursework.system.processes import processes

def stuck(*_, **__):
    with processes(1) as submit:
        task = submit(time.sleep, 300)
        while not task.running():
            time.sleep(0.05)
        task._condition.acquire()
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(300)

if __name__ == "__main__":
    cli.commands.main = stuck
    cli.main()
"""


@pytest.mark.e2e
def test_a_command_whose_threads_wait_for_ever_ends_on_a_signal_with_its_processes(tmp_path):
    command = begun(tmp_path, script=STUCK)
    _, said = ended(command)
    assert (command.returncode, said.splitlines()[0]) == (
        128 + signal.SIGTERM,
        "coursework: ended by SIGTERM",
    )
    assert until(lambda: not at_work(command.pid))
