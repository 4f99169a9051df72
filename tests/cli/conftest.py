"""The command line as a function, and a small build."""

from __future__ import annotations

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


@pytest.fixture
def built(cli, tmp_path):
    (tmp_path / "class.csv").write_text(ROSTER, "utf-8")
    out = tmp_path / "out"
    status, said, _ = cli(
        "build", "slotted_mechanism", "four_bar_positions", "--roster", tmp_path / "class.csv", "--out", out,
        "--formats", "pdf,ipynb", "--seed", 7,
    )  # fmt: skip
    assert status == 0
    assert str(out) in said
    return out
