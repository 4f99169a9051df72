"""The command line as a function, and a small build."""

from __future__ import annotations

import contextlib
import io
import shutil

import pytest
from class_of_three import ROSTER

from coursework.cli import run


@pytest.fixture
def cli(capsys):
    """Run a command; gives its status, output and errors."""

    def call(*arguments):
        status = run([str(a) for a in arguments])
        said = capsys.readouterr()
        assert "Traceback" not in said.err + said.out
        return status, said.out, said.err

    return call


@pytest.fixture(scope="session")
def built_once(tmp_path_factory):
    """A class of three with sheets of two exercises; nobody writes in it."""
    folder = tmp_path_factory.mktemp("built")
    (folder / "class.csv").write_text(ROSTER, "utf-8")
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        status = run(
            [
                "build",
                "slotted_mechanism",
                "four_bar_positions",
                "--roster",
                str(folder / "class.csv"),
                "--out",
                str(folder / "out"),
                "--formats",
                "pdf,ipynb",
                "--seed",
                "7",
            ]
        )
    assert status == 0
    assert str(folder / "out") in said.getvalue()
    return folder


@pytest.fixture
def built(built_once, tmp_path):
    """A copy of the small build to write in, with the roster beside it."""
    return shutil.copytree(built_once, tmp_path, dirs_exist_ok=True) / "out"
