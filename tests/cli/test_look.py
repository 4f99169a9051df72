"""The command line, looking and solving."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

import coursework

COURSE = coursework.open_course()
FORCES = [name for name in COURSE.names if COURSE[name].spec.effects]


def test_list_names_every_exercise(cli, course):
    status, out, _ = cli("list", "--json")
    assert status == 0
    assert [e["exercise"] for e in json.loads(out)] == list(course.folder.in_order)
    status, out, _ = cli("list")
    assert all(name in out for name in course.names)


def test_list_follows_the_chapters_and_says_what_is_needed_first(cli, course):
    rows = json.loads(cli("list", "--json")[1])
    assert [r["chapter"] for r in rows] == sorted(r["chapter"] for r in rows)
    assert "mobility" in next(r["needs"] for r in rows if r["exercise"] == "assour")
    out = cli("list")[1]
    places = [
        out.index(f"{chapter.number}. {chapter.title('fr')}")
        for chapter in course.folder.chapters
        if chapter.exercises
    ]
    assert places == sorted(places)
    assert out.index("joint_graph") < out.index("ball_reducer") < out.index("complex_chain")


def test_show_prints_a_statement_in_either_language(cli):
    assert "manivelle" in cli("show", "slotted_mechanism", "--seed", 3)[1]
    assert "crank" in cli("show", "slotted_mechanism", "--seed", 3, "--lang", "en")[1]


def test_variant_prints_one_record_a_line(cli, course):
    status, out, _ = cli("variant", "slotted_mechanism", "--seed", 5, "--count", 3, "--json")
    records = [json.loads(line) for line in out.splitlines()]
    assert status == 0
    assert [r["seed"] for r in records] == [5, 6, 7]
    assert all("answers" not in r for r in records)
    assert records[0] == course["slotted_mechanism"].variant(5).record
    assert set(records[0]) == {"exercise", "version", "seed", "lang", "given", "parts"}


@pytest.mark.parametrize("name", ["slotted_mechanism", "ball_reducer", "slider_extras"])
def test_variant_with_its_solution_is_json_for_every_kind_of_part(cli, name):
    status, out, _ = cli("variant", name, "--seed", 1, "--solution", "--json")
    record = json.loads(out)
    assert status == 0
    assert set(record["answers"]) == {p["id"] for p in record["parts"]}
    assert all(set(a) == {"value", "unit", "tolerance"} for a in record["answers"].values())
    assert cli("variant", name, "--solution")[0] == 0


def test_solve_on_ones_own_numbers_in_any_unit(cli):
    arguments = [
        *"--set r1=228.6mm --set".split(),
        "r2=0.1143 m",
        *"--set theta2=135deg --only rA,theta4".split(),
    ]
    status, out, _ = cli("solve", "slotted_mechanism", *arguments, "--json")
    found = json.loads(out)
    assert status == 0
    assert found["exercise"] == "slotted_mechanism"
    assert found["given"]["r2"] == {"value": 114.3, "unit": "mm"}
    assert found["quantities"]["rA"]["value"] == pytest.approx(319.80, abs=0.005)
    assert found["quantities"]["theta4"] == {"value": pytest.approx(104.64, abs=0.005), "unit": "deg"}
    assert "319.804" in cli("solve", "slotted_mechanism", *arguments)[1]


def test_solve_asks_for_all_that_is_missing_as_it_is_written(cli):
    status, _, err = cli("solve", "slotted_mechanism", "--set", "theta2=30")
    assert status == 2
    assert "r1, r2 and omega2, which are not given; add --set r1=… --set r2=… --set omega2=…" in err
    assert "_arm" not in err


def test_help_answers_without_loading_the_heavy_libraries():
    code = (
        "import sys; from coursework.cli import run; run(['--help']);"
        "heavy = {'numpy', 'scipy', 'typst', 'nbformat', 'jinja2', 'rich'} & set(sys.modules);"
        "sys.exit(', '.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "build" in done.stdout


@pytest.mark.parametrize("name", FORCES)
def test_solve_bears_the_forces_that_an_exercise_asks_about(cli, course, name):
    """Without ``--effects`` the answers are those of the variant of these very numbers."""
    record = json.loads(cli("variant", name, "--seed", 2, "--solution", "--json")[1])
    given = {n: f"{v['value']} {v['unit'] if v['unit'] != '1' else ''}" for n, v in record["given"].items()}
    settings = [word for n, text in given.items() for word in ("--set", f"{n}={text}")]
    status, out, err = cli("solve", name, *settings, "--json")
    assert status == 0, err
    found = json.loads(out)["quantities"]
    of_part = {p.id: p.quantity for p in course[name].spec.parts}
    wanted = {of_part[i]: a["value"] for i, a in record["answers"].items() if isinstance(a["value"], float)}
    assert {n: found[n]["value"] for n in wanted} == pytest.approx(wanted, rel=1e-9)
    none = json.loads(cli("solve", name, *settings, "--effects", "", "--json")[1])["quantities"]
    assert any(none[n]["value"] != found[n]["value"] for n in wanted)
