"""Commands that are begun to be ended: each in a session of its own, whose processes can be counted."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import coursework

LONGEST = 90  #: seconds; so long that a busy machine is no fault
HAS_SESSIONS = sys.platform == "linux"
_MAIN = "import sys; from coursework.cli import main; sys.exit(main())"


def begun(place, *words, script=None):
    """A command, or a Python script, with a temporary folder of its own: ``place / "tmp"``."""
    temporary = place / "tmp"
    temporary.mkdir(exist_ok=True)
    main = place / "main.py"
    main.write_text(script or f"if __name__ == '__main__':\n    {_MAIN}\n")
    path = str(Path(coursework.__file__).parents[1])
    env = {**os.environ, "TMPDIR": str(temporary), "PYTHONPATH": path, "COLUMNS": "300"}
    return subprocess.Popen(
        [sys.executable, "-P", str(main), *map(str, words)],
        cwd=place,
        env=env,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )


def ended(process):
    """What a command has said on both streams when it ends; its whole session is ended where it does not."""
    try:
        return process.communicate(timeout=LONGEST)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        raise AssertionError(f"not ended after {LONGEST} s: {process.args}") from None


def at_work(session):
    """The processes of a session that have not ended."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                state, _, _, own = (entry / "stat").read_text().rpartition(")")[2].split()[:4]
            except OSError:
                continue
            if own == str(session) and state not in "ZX":
                found.append(int(entry.name))
    return found


def left_in(*folders):
    """What a command that was stopped may leave: locks, files half written, temporary folders."""
    found = [p for folder in folders for p in folder.rglob("*")]
    return [p for p in found if p.suffix == ".part" or p.name.startswith((".coursework.lock", ".building"))]
