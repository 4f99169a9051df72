"""The example course outside kinematics: copied by a command, it lists, builds, checks clean and marks
answers right."""

from __future__ import annotations

import cmath
import csv
import filecmp
import json
import math
import re

import numpy as np
import pytest
from sweeps import slow
from tables import each_row

from coursework.authoring.example_courses import EXAMPLES
from coursework.cli import run

EXERCISES = ["beam", "heat_balance", "rlc_circuit", "two_springs"]


@pytest.fixture(scope="module")
def copied(tmp_path_factory):
    folder = tmp_path_factory.mktemp("example") / "statics"
    assert run(["new", str(folder), "--example", "engineering"]) == 0
    return folder


@pytest.fixture(scope="module")
def built(copied, tmp_path_factory):
    out = tmp_path_factory.mktemp("built") / "out"
    build = ["build", "--variants", "1", "--formats", "pdf,html,ipynb", "--lang", "fr,en"]
    assert run(["--course", str(copied), *build, "--out", str(out)]) == 0
    return out


def test_the_command_copies_all_of_the_example(copied):
    compared = filecmp.dircmp(EXAMPLES / "engineering", copied, ignore=["__pycache__"])
    for part in (compared, *compared.subdirs.values()):
        assert not part.left_only
        assert not part.diff_files
    assert compared.right_only == ["templates"]


def test_it_lists_its_four_exercises_in_both_languages(copied, capsys):
    assert run(["--course", str(copied), "list", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [entry["exercise"] for entry in listed] == EXERCISES
    assert all({*entry["title"]} == {"fr", "en"} for entry in listed)


@pytest.mark.e2e
def test_it_builds_in_every_format_and_language(built):
    names = {path.relative_to(built / "handouts").as_posix() for path in built.glob("handouts/*/*")}
    for exercise in EXERCISES:
        for lang in ("fr", "en"):
            for form in ("pdf", "html", "ipynb"):
                assert any(re.fullmatch(rf"{exercise}/\d{{5}}\.{lang}\.{form}", name) for name in names)


@pytest.mark.e2e
@pytest.mark.parametrize("variants", [20, pytest.param(100, marks=slow)])
@pytest.mark.parametrize("exercise", EXERCISES)
def test_the_check_finds_no_failure(copied, exercise, variants, capsys):
    status = run(["--course", str(copied), "check", exercise, "--variants", str(variants), "--json"])
    told = json.loads(capsys.readouterr().out)
    assert told["failures"] == []
    assert not told["unproved_units"]
    assert status == 0


def test_an_unknown_example_is_told_with_those_there_are(tmp_path, capsys):
    assert run(["new", str(tmp_path / "own"), "--example", "history"]) == 2
    assert "no example 'history'; available: engineering" in capsys.readouterr().err
    assert not (tmp_path / "own").exists()


def test_an_example_never_overwrites(copied, capsys):
    assert run(["new", str(copied), "--example", "engineering"]) == 2
    assert "is not empty" in capsys.readouterr().err


@pytest.mark.parametrize("more", [["beam"], ["--from", "assour"], ["--as", "mine"], ["--lang", "fr"]])
def test_an_example_is_copied_whole_and_takes_nothing_more(tmp_path, capsys, more):
    assert run(["new", str(tmp_path / "own"), *more, "--example", "engineering"]) == 2
    assert "copied as a whole" in capsys.readouterr().err
    assert not (tmp_path / "own").exists()


# ---------------------------------------------------------------- marked right, from the data alone


def _beam(L, a, F, q, sigma):
    """The largest moment by going along the beam, 20000 steps."""
    reaction = (F * (L - a) + q * L * L / 2) / L
    x = np.linspace(0, L, 20001)
    moments = reaction * x - q * x * x / 2 - np.where(x > a, F * (x - a), 0)
    best = int(np.argmax(moments))
    return {
        "R_A": f"{reaction * 1000:.0f} N",
        "R_B": f"{F + q * L - reaction:.4f} kN",
        "x_M": f"{x[best] * 100:.2f} cm",
        "M": f"{moments[best]:.4f} kN.m",
        "W": f"{moments[best] * 1e6 / sigma:.0f} mm^3",
    }


def _two_springs(k1, k2, F1, F2):
    K = np.array([[k1 + k2, -k2], [-k2, k2]])
    u = np.linalg.solve(K, [F1, F2])
    return {
        "k": f"({1 / (1 / k1 + 1 / k2):.5f} ; {k1 + k2:.5f}) N/mm",
        "K": f"[[{K[0, 0]}, {K[0, 1]}], [{K[1, 0]}, {K[1, 1]}]]",
        "u": f"{u[0]:.5f} ; {u[1]:.5f}",
        "E": f"{u @ K @ u / 2:.3f} mJ",
    }


def _rlc_circuit(U, f, R, L, C):
    L, C, omega = L * 1e-3, C * 1e-6, 2 * math.pi * f
    Z = R + 1j * omega * L + 1 / (1j * omega * C)
    current = U / Z
    true_of_it = {
        "inductive": Z.imag > 0,
        "capacitive": Z.imag < 0,
        "below": (omega * L) * (omega * C) < 1,
        "magnified": abs(current / (omega * C)) > U,
    }
    return {
        "Z": f"{abs(Z):.5f} ∠ {math.degrees(cmath.phase(Z)):.4f}°",
        "I": f"{abs(current) * 1000:.4f} mA",
        "phi": f"{-cmath.phase(current):.6f} rad",
        "f_0": f"{1 / (2 * math.pi * math.sqrt(L * C)) / 1000:.6f} kHz",
        "Q": f"{math.sqrt(L / C) / R:.5f}",
        "holds": ", ".join(name for name, is_so in true_of_it.items() if is_so),
    }


def _heat_balance(A, e_1, lambda_1, e_2, lambda_2, T_i, T_e):
    """The temperature between from the balance of the two flows."""
    inner, outer = lambda_1 * A / (e_1 / 1000), lambda_2 * A / (e_2 / 1000)
    between = (inner * T_i + outer * T_e) / (inner + outer)
    flow = outer * (between - T_e)
    return {
        "R_th": f"{(T_i - T_e) / flow:.7f} K/W",
        "Phi": f"{flow / 1000:.6f} kW",
        "T_12": f"{between + 273.15:.3f} K",
        "why": "The heat flow stays, the temperature between falls.",
    }


ANSWERS = {
    "beam": _beam,
    "two_springs": _two_springs,
    "rlc_circuit": _rlc_circuit,
    "heat_balance": _heat_balance,
}


@pytest.fixture(scope="module")
def marks(copied, tmp_path_factory):
    """What the command line says to right answers on four variants of each exercise, by exercise and part."""
    folder = tmp_path_factory.mktemp("handed_in")
    build = ["build", "--variants", "4", "--formats", "ipynb", "--lang", "en", "--out", str(folder / "out")]
    assert run(["--course", str(copied), *build]) == 0
    issued = json.loads((folder / "out" / "issued.json").read_text("utf-8"))["issued"]
    with (folder / "answers.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["student", "exercise", "seed", "part", "answer"])
        for record in (one["record"] for one in issued):
            data = {name: value["value"] for name, value in record["given"].items()}
            for part, answer in ANSWERS[record["exercise"]](**data).items():
                writer.writerow([f"s{record['seed']}", record["exercise"], record["seed"], part, answer])
    grade = ["grade", str(folder / "answers.csv"), "--issued", str(folder / "out" / "issued.json")]
    # The texts wait for a person, which the status says.
    assert run(["--course", str(copied), *grade, "--out", str(folder / "marks")]) == 1
    with (folder / "marks" / "marks.csv").open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


@each_row("exercise", EXERCISES)
@pytest.mark.e2e
def test_right_answers_are_marked_right_by_the_command_line(marks, exercise):
    of_it = [mark for mark in marks if mark["exercise"] == exercise]
    assert len({mark["seed"] for mark in of_it}) == 4
    for mark in of_it:
        assert mark["verdict"] == ("to_mark" if mark["part"] == "why" else "correct"), mark
