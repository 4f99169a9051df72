"""What the shell completes, and how little is loaded for it."""

import subprocess
import sys

import pytest
from tables import each_row

from coursework.cli.commands import COMMANDS, commands


@pytest.fixture
def completed(monkeypatch, capsys):
    """What a shell is offered for a line whose last word is being written."""

    def call(line):
        words = line.split(" ")
        monkeypatch.setenv("COMP_WORDS", line)
        monkeypatch.setenv("COMP_CWORD", str(len(words) - 1))
        monkeypatch.setenv("_COURSEWORK_COMPLETE", "bash_complete")
        with pytest.raises(SystemExit) as stop:
            commands.main([], prog_name="coursework")
        assert not stop.value.code
        said = capsys.readouterr()
        assert not said.err
        return [item.removeprefix("plain,") for item in said.out.split()]

    return call


def test_commands_are_completed(completed):
    assert completed("coursework ") == sorted(COMMANDS)
    assert completed("coursework s") == ["scan", "semester", "serve", "show", "simulate", "solve"]


@pytest.mark.parametrize(
    "command", ["show", "solve", "variant", "simulate", "animate", "build", "check", "notebook", "accuracy"]
)
def test_exercises_are_completed(completed, course, command):
    assert completed(f"coursework {command} ") == list(course.names)
    assert completed(f"coursework {command} slo") == ["slotted_mechanism"]


def test_several_exercises_are_completed_one_after_another(completed):
    assert completed("coursework build slotted_mechanism havens_p") == ["havens_planetary"]


def test_exercises_of_another_course_are_completed(completed, small_course):
    assert completed(f"coursework --course {small_course} show ") == ["crank_pin"]


def test_where_there_is_no_course_nothing_is_completed(completed, tmp_path):
    assert completed(f"coursework --course {tmp_path}/nowhere show ") == []


def test_a_broken_exercise_is_completed_too(completed, small_course):
    (small_course / "exercises" / "torn.py").write_text("raise SystemExit(3)\n", "utf-8")
    assert completed(f"coursework --course {small_course} show ") == ["crank_pin", "torn"]


def test_languages_are_completed(completed):
    assert completed("coursework show slotted_mechanism --lang ") == ["en", "fr"]
    assert completed("coursework build --lang fr,") == ["fr,en"]


def test_formats_are_completed_one_after_another(completed):
    assert completed("coursework build --formats ") == ["pdf", "ipynb", "html", "tex", "nbgrader"]
    assert completed("coursework build --formats pdf,") == [
        "pdf,ipynb",
        "pdf,html",
        "pdf,tex",
        "pdf,nbgrader",
    ]
    assert completed("coursework build --formats pdf,h") == ["pdf,html"]


def test_options_are_completed(completed):
    assert completed("coursework --c") == ["--course"]
    assert "--effects" in completed("coursework solve slotted_mechanism --")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_every_shell_is_told_how(shell, monkeypatch, capsys):
    monkeypatch.setenv("_COURSEWORK_COMPLETE", f"{shell}_source")
    monkeypatch.setattr("click.shell_completion.BashComplete._check_version", staticmethod(lambda: None))
    with pytest.raises(SystemExit) as stop:
        commands.main([], prog_name="coursework")
    assert not stop.value.code
    assert f"_COURSEWORK_COMPLETE={shell}_complete" in capsys.readouterr().out


LOADED = """
import os, sys
from coursework.cli import main
os.environ.update(COMP_WORDS={line!r}, COMP_CWORD="{place}", _COURSEWORK_COMPLETE="bash_complete")
try:
    main()
finally:
    print("loaded", *sys.modules)
"""


@each_row("line", ["coursework s", "coursework show slo", "coursework build --formats p"])
def test_completion_loads_no_numbers_and_no_exercise(line):
    code = LOADED.format(line=line, place=len(line.split(" ")) - 1)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.partition("loaded ")[2].split())
    assert "coursework.cli" in loaded
    assert not loaded & {"numpy", "scipy", "jinja2", "rich", "coursework.api", "coursework.model"}
    assert not [name for name in loaded if "slotted_mechanism" in name]
    if line == "coursework s":
        assert not loaded & {f"coursework.cli.{file}" for file, _ in COMMANDS.values()}
