"""Without the libraries of an extra, each command that needs it names it in one line, before anything else is
wrong."""

from __future__ import annotations

import json
import subprocess
import sys

import click

from coursework.cli.commands import commands
from coursework.cli.options import NeedingExtra

#: By extra, commands that need it and whose other arguments are wrong or missing too.
WITHOUT = {
    "site": [
        "serve",
        "serve --demo",
        "serve --db nowhere/x.db --port 0",
        "preview",
        "preview nosuch",
        "database show",
        "database show nothere.db",
        "database history",
        "database dump nothere.db nowhere",
        "database restore nowhere nothere.db",
        "database new-key",
        "database sign-out",
        "build nosuch --db nowhere/x.db",
        "grade nothere.csv --issued nope.json --db nowhere/x.db",
        "report --db nope.db",
        "after nope.toml --db nowhere/x.db",
    ],
    "lti": ["lti keys new", "lti platform", "lti roster", "lti scores"],
    "scan": ["scan", "scan nothere.pdf --issued nope.json", "build nosuch --with scan"],
    "cluster": [
        "build nosuch --cluster local:2",
        "grade nothere.csv --issued nope.json --cluster tcp://127.0.0.1:1",
        "check nosuch --cluster local:2",
        "report nowhere --cluster local:2",
    ],
    "accuracy": ["accuracy", "accuracy nosuch"],
    "parquet": ["grade nothere.parquet --issued nope.json"],
}
BLOCKED = (
    "alembic argon2 cryptography cv2 dask distributed httpx itsdangerous jwt limits mpmath nbgrader "
    "psycopg pyarrow "
    "pypdfium2 python_multipart sqlalchemy starlette uvicorn zxingcpp"
).split()

CHILD = """
import contextlib, io, json, sys

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in BLOCKED:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name.partition(".")[0])

lines, BLOCKED = json.load(sys.stdin)
sys.meta_path.insert(0, Blocked())
from coursework.cli import run

found = {}
for line in lines:
    told = io.StringIO()
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(told):
        try:
            status = run(line.split())
        except BaseException as fault:
            status = repr(fault)
    found[line] = status, told.getvalue()
print(json.dumps(found))
"""


def leaves(command=commands, name=""):
    """Every command by its words."""
    if not isinstance(command, click.Group):
        return {name.strip(): command}
    context = click.Context(command)
    return {
        words: leaf
        for one in command.list_commands(context)
        for words, leaf in leaves(command.get_command(context, one), f"{name} {one}").items()
    }


def test_each_command_names_the_extra_that_it_lacks_before_other_faults(tmp_path):
    lines = [line for listed in WITHOUT.values() for line in listed]
    child = subprocess.run(
        [sys.executable, "-c", CHILD],
        input=json.dumps([lines, BLOCKED]),
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    found = json.loads(child.stdout)
    wrong = {
        line: found[line]
        for extra, listed in WITHOUT.items()
        for line in listed
        if found[line][0] != 2 or found[line][1].count("\n") != 1 or f"[{extra}]" not in found[line][1]
    }
    assert wrong == {}
    assert [*tmp_path.iterdir()] == []


def test_every_command_and_option_that_needs_an_extra_is_listed():
    lines = [line for listed in WITHOUT.values() for line in listed]
    missing = []
    for words, command in leaves().items():
        own = [line for line in lines if f"{line} ".startswith(f"{words} ")]
        if isinstance(command, NeedingExtra) and not own:
            missing.append(words)
        for option in command.params:
            if option.name in ("db", "cluster", "scan") and not isinstance(command, NeedingExtra):
                missing += (
                    [] if any(f"--{option.name}" in line for line in own) else [f"{words} --{option.name}"]
                )
    assert missing == []
