"""A course of nbgrader in a folder: its commands as a teacher types them, notebooks as students hand them in,
its database."""

from __future__ import annotations

import copy
import json
import os
import sqlite3
import subprocess
import sys
from pathlib import Path

import coursework

_ROOT = Path(coursework.__file__).resolve().parent.parent


#: Commands one after the other in one process, which starts as slowly as nbgrader does.
_COMMANDS = """
import json, sys
from jupyter_core.application import NoStart
from nbgrader.apps.nbgraderapp import NbGraderApp
worst = 0
for words in json.loads(sys.argv[1]):
    app = NbGraderApp.instance()
    try:
        app.initialize(words)
        app.start()
    except NoStart:  # it was the command that was started
        pass
    except SystemExit as end:
        worst = worst or end.code
    type(app.subapp).clear_instance()
    NbGraderApp.clear_instance()
sys.exit(worst)
"""


def commands(folder, *all_words):
    """Several commands of nbgrader, all of which must do."""
    told = _told(folder, ["-c", _COMMANDS, json.dumps(all_words)], folder)
    assert told.returncode == 0, told.stderr[-3000:]
    return told.stderr


def python(folder, code):
    """What a piece of Python prints where nbgrader is."""
    told = _told(folder, ["-c", code], folder)
    assert told.returncode == 0, told.stderr[-3000:]
    return told.stdout


def nbgrader(folder, *words, cwd=None):
    """A command of nbgrader, whatever it says."""
    return _told(folder, ["-m", "nbgrader", *map(str, words)], cwd or folder)


def _told(folder, words, cwd):
    """nbgrader's database asks for ``alembic`` by name."""
    home = folder / ".home"
    home.mkdir(exist_ok=True)
    around = {
        **os.environ,
        "PATH": os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", ""))),
        "PYTHONPATH": str(_ROOT),
        "JUPYTER_CONFIG_DIR": str(home),
        "JUPYTER_DATA_DIR": str(home),
        "HOME": str(home),
    }
    command = [sys.executable, "-P", *words]
    return subprocess.run(command, cwd=cwd, env=around, capture_output=True, text=True, timeout=600)


def done(folder, *words, cwd=None):
    told = nbgrader(folder, *words, cwd=cwd)
    assert told.returncode == 0, told.stderr[-3000:]
    return told.stderr


def released(folder, name):
    return json.loads((folder / f"release/{name}/{name}.ipynb").read_text("utf-8"))


def submit(folder, student, name, book):
    """Put a notebook where nbgrader collects it; a text is put as it is."""
    place = folder / "submitted" / student / name
    place.mkdir(parents=True)
    text = book if isinstance(book, str) else json.dumps(book)
    (place / f"{name}.ipynb").write_text(text, "utf-8")


def answers_cells(book):
    return [cell for cell in book["cells"] if "answers" in cell["metadata"].get("tags", ())]


def grade_cells(book):
    return [cell for cell in book["cells"] if cell["metadata"].get("nbgrader", {}).get("grade")]


def answered(book, *answers):
    """A copy of a notebook with answers written into its answers cells, one dict each."""
    book = copy.deepcopy(book)
    for cell, own in zip(answers_cells(book), answers, strict=True):
        lines = "".join(f"    {json.dumps(k)}: {json.dumps(v)},\n" for k, v in own.items())
        cell["source"] = f"answers = {{\n{lines}}}"
    return book


def code(source, **metadata):
    return {
        "cell_type": "code",
        "execution_count": None,
        "metadata": metadata,
        "outputs": [],
        "source": source,
    }


def points(folder):
    """What the database has: the points of each grade cell, by student, and the cells that a person must look
    at."""
    with sqlite3.connect(folder / "gradebook.db") as base:
        rows = base.execute(
            "select sa.student_id, bc.name, g.auto_score, g.needs_manual_grade from grade g "
            "join base_cell bc on bc.id = g.cell_id "
            "join submitted_notebook sn on sn.id = g.notebook_id "
            "join submitted_assignment sa on sa.id = sn.assignment_id"
        ).fetchall()
    base.close()
    found: dict[str, dict[str, float]] = {}
    waiting: dict[str, set[str]] = {}
    for student, cell, score, waits in rows:
        found.setdefault(student, {})[cell] = score
        waiting.setdefault(student, set())
        if waits:
            waiting[student].add(cell)
    return found, waiting


def feedback(folder, student, name):
    return (folder / f"feedback/{student}/{name}/{name}.html").read_text("utf-8")
