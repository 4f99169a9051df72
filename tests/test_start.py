"""What a command loads: nothing heavy that it does not need."""

import subprocess
import sys

import pytest
from tables import each_row

pytestmark = pytest.mark.e2e  #: each is a command in a process of its own

SOLVE = "solve slotted_mechanism --set r1=228.6mm --set r2=114.3mm --set theta2=135deg --only rA,theta4"
CODE = "import sys; from coursework.cli import run; run(sys.argv[1:]); print('loaded', *sys.modules)"


def loaded(command):
    done = subprocess.run(
        [sys.executable, "-c", CODE, *command.split()], capture_output=True, text=True, check=True
    )
    said, _, modules = done.stdout.partition("loaded ")
    assert said.strip()
    assert not done.stderr
    return set(modules.split())


@each_row("command", ["show slotted_mechanism", "variant slotted_mechanism --seed 1 --json", SOLVE])
def test_a_command_loads_no_library_that_it_does_not_need(command):
    modules = loaded(command)
    assert "numpy" in modules
    assert not modules & {"scipy", "nbformat", "typst", "rich", "concurrent.futures", "jinja2"}


@each_row("command", ["variant slotted_mechanism --seed 1 --json", SOLVE])
def test_numbers_need_no_formulas_and_no_sheets(command):
    modules = loaded(command)
    assert not modules & {"markdown_it", "coursework.markup.formula_tree", "coursework.sheets.sheet"}
    assert not modules & {"coursework.figures.placing", "coursework.course.answer_key"}


def test_a_variant_is_drawn_without_the_solution_unless_a_constraint_asks_it():
    assert not loaded("variant grashof --seed 1 --json") & {
        "coursework.solution",
        "coursework.parsing.numbers",
    }
    asked = loaded("variant slotted_mechanism --seed 1 --json")
    assert "coursework.solution" in asked
    assert not asked & {"coursework.parsing.numbers", "coursework.course.answer_key"}


@pytest.mark.parametrize(
    "command", ["build grashof --variants 1 --formats html --out {}", "check grashof --variants 1"]
)
def test_without_a_cluster_nothing_of_one_is_loaded(command, tmp_path):
    modules = loaded(command.format(tmp_path / "out"))
    assert not modules & {
        "dask",
        "distributed",
        "coursework.system.cluster",
        "coursework.course.course_transfer",
    }
