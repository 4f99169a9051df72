"""Processes that share a large job, and how they end."""

from __future__ import annotations

import time

import pytest
from tables import each_row

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
