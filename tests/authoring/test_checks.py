"""The check is a proof only if it fails when a promise is broken: each kind of break is tried."""

from __future__ import annotations

import json
import pickle
import shutil
from collections import Counter
from concurrent.futures import Future

import pytest

import coursework
from coursework.authoring import checks
from coursework.authoring.check_report import CheckReport, notes, table
from coursework.authoring.checks import agrees, check, check_solves
from coursework.cli.printing import print_table
from coursework.course.exercise import ALL
from coursework.issuing.issuing import distinct_variants
from coursework.language.words import file_of
from coursework.solution import given

COURSE = coursework.open_course()
X = "return r * cos(theta)"


def test_a_known_case_is_a_sentence_or_a_pair():
    assert given(r=200, theta=60).gives(x=100, y="173.2") == (
        {"r": 200, "theta": 60},
        {"x": 100, "y": "173.2"},
    )
    assert given(F=2).under("load", "friction").gives(T=1) == ({"F": 2}, {"T": 1}, ("load", "friction"))
    assert given().under().gives(T=0) == ({}, {"T": 0}, ())


BREAKS = {
    "a wrong formula": ("solutions/crank_pin.py", X, "return r * sin(theta)", "known case"),
    "a formula wrong on one branch": ("solutions/crank_pin.py", X, "return abs(r * cos(theta))", "residual"),
    "arrays unlike scalars": (
        "solutions/crank_pin.py",
        X,
        "return r * cos(theta) * (1 + 1e-6 * (not isinstance(r, float)))",
        "in an array",
    ),
    "no known case": ("solutions/crank_pin.py", "KNOWN =", "_KNOWN =", "states no KNOWN"),
    "no residual": ("solutions/crank_pin.py", "def residual", "def _residual", "states no residual"),
    "a mistake that never shows": (
        "solutions/crank_pin.py",
        "return r * omega * 2 * np.pi",
        "return r * omega",
        "shows in none",
    ),
    "a mistake without words": (
        "solutions/crank_pin.en.md.j2",
        "## mistake turns_for_radians",
        "## mistake turns",
        "no section '## mistake turns_for_radians'",
    ),
    "a part without words": ("exercises/crank_pin.en.md.j2", "## v", "## w", "has no section '## v'"),
    "a figure without words": ("exercises/crank_pin.en.md.j2", "## figure", "## drawing", "## figure"),
    "a formula that no format can print": ("solutions/crank_pin.fr.md.j2", "$r$", r"$\foo r$", "foo"),
    "a symbol that the sheet does not have": (
        "solutions/crank_pin.py",
        "#: Values known",
        'SYMBOLS = {"v": r"\\nu"}\n#: Values known',
        "'v', which is given or asked: its symbol belongs in Exercise(symbols=…)",
    ),
    "a course without a title in one language": (
        "exercises/course.toml",
        'en = "My course"',
        "",
        "exercises/course.toml has no title in 'en': sheets would be headed 'small'",
    ),
    "no tolerance at zero": (
        "solutions/crank_pin.py",
        "return r * omega\n",
        "return 0.0 * r * omega\n",
        "no absolute tolerance",
    ),
    "a quantity that is not there": (
        "solutions/crank_pin.py",
        "def v(r, omega)",
        "def w(r, omega)",
        "no quantity 'v'",
    ),
}


def checked(folder, variants=2, rendered=0):
    return check(coursework.open_course(folder)["crank_pin"], variants, rendered=rendered)


def test_the_small_course_passes_untouched(small_course):
    report = checked(small_course, 20, rendered=1)
    assert report.failures == []
    assert report.counts["right answers"] > 0
    assert report.counts["mistakes recognised"] > 0


@pytest.mark.parametrize("name", BREAKS)
def test_the_check_fails_on(small_course, name):
    file, old, new, told = BREAKS[name]
    path = small_course / file
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    variants = 60 if name == "a mistake that never shows" else 3
    rendered = name == "a formula that no format can print"
    report = checked(small_course, variants, rendered=rendered)
    assert any(told in failure for failure in report.failures), report.failures[:5]


def test_a_missing_language_is_a_failure(small_course):
    (small_course / "exercises" / "crank_pin.en.md.j2").unlink()
    report = checked(small_course, 2, rendered=1)
    assert any("no statement in 'en'" in f for f in report.failures)


def test_texts_in_a_language_that_the_engine_does_not_speak_are_a_failure(small_course):
    for kind in ("exercises", "solutions"):
        shutil.copy(small_course / kind / "crank_pin.en.md.j2", small_course / kind / "crank_pin.es.md.j2")
    failures = checked(small_course).failures
    told = [f for f in failures if f.endswith(f"words would be {file_of('es')}")]
    assert [f.split(" ")[0] for f in told] == ["exercises/crank_pin.es.md.j2"]


def test_a_text_that_was_copied_and_not_translated_is_a_failure(small_course):
    for kind in ("exercises", "solutions"):
        shutil.copy(small_course / kind / "crank_pin.fr.md.j2", small_course / kind / "crank_pin.en.md.j2")
    told = [f for f in checked(small_course).failures if "translate it" in f]
    assert (
        told[0]
        == "exercises/crank_pin.fr.md.j2: the statement says the same as in crank_pin.en.md.j2; translate it"
    )
    assert any("section '## mistake turns_for_radians'" in f for f in told)


def test_a_check_that_cannot_go_on_leaves_the_others_to_tell_what_they_find(small_course):
    path = small_course / "solutions" / "crank_pin.py"
    text = path.read_text("utf-8").replace("def residual", "def _residual")
    path.write_text(text.replace("return r * omega\n", "return r * omega**2\n", 1), "utf-8")
    failures = checked(small_course).failures
    assert any("states no residual" in f for f in failures)
    assert any(f.startswith("v is declared in mm/s, and its formula gives mm/s^2") for f in failures)


def test_a_solution_without_its_text_is_told_by_its_folder(small_course):
    (small_course / "solutions" / "crank_pin.en.md.j2").unlink()
    failures = checked(small_course).failures
    assert any(
        f.startswith("solutions/crank_pin.en.md.j2 is missing, and with it the section '## mistake")
        for f in failures
    )


def test_a_course_without_any_title_is_headed_by_its_folder(small_course):
    (small_course / "exercises" / "course.toml").unlink()
    assert checked(small_course, rendered=1).failures == []


def test_a_fault_is_told_once_without_the_name_that_is_printed_before_it(small_course):
    path = small_course / "exercises" / "crank_pin.py"
    path.write_text(path.read_text("utf-8").replace("theta % 90 >= 10", "theta > 999"), "utf-8")
    failures = checked(small_course).failures
    starved = [f for f in failures if "found no variant" in f]
    assert [f.split(" ")[0] for f in starved] == ["seed"]
    assert len(failures) == len(set(failures))


def test_a_function_that_fails_everywhere_is_told_once(small_course):
    path = small_course / "solutions" / "crank_pin.py"
    path.write_text(path.read_text("utf-8").replace("return r * omega\n", "return r * omegga\n"), "utf-8")
    (failure,) = checked(small_course).failures
    assert "name 'omegga' is not defined" in failure


def test_a_parameter_that_nothing_gives_is_told_with_the_nearest_name(small_course):
    path = small_course / "solutions" / "crank_pin.py"
    path.write_text(path.read_text("utf-8").replace("def x(r, theta)", "def x(r, thta)"), "utf-8")
    failures = checked(small_course).failures
    assert failures == ["solutions/crank_pin.py: x needs thta, which is not given; did you mean 'theta'?"]


#: Given lengths, and how wrong the height is made: by what rounding never does, where it is made at all.
SIZES = {
    "4 m": ("2000, 4000, step=5", ""),
    "4 m, wrong": ("2000, 4000, step=5", " * (1 + 1e-7)"),
    "microns, wrong": ("0.0001, 0.0002, step=0.00001", " * (1 + 1e-7)"),
}


@pytest.mark.parametrize("case", SIZES)
def test_equations_are_compared_with_the_size_of_their_terms(small_course, case):
    lengths, wrong = SIZES[case]
    for path, old, new in (
        ("exercises", "drawn(50, 200, step=5", f"drawn({lengths}"),
        ("solutions", "return r * sin(theta)", f"return r * sin(theta){wrong}"),
    ):
        file = small_course / path / "crank_pin.py"
        file.write_text(file.read_text("utf-8").replace(old, new), "utf-8")
    report = CheckReport("crank_pin")
    variants = coursework.open_course(small_course)["crank_pin"].variants(range(200))
    for variant in variants:
        check_solves(variant, variant.key, report)
    failing = {failure.split(":")[0] for failure in report.failures}
    assert len(failing) == (len(variants) if wrong else 0)


def test_a_course_without_solutions_is_told_so_once_and_without_numbers_that_are_none(small_course):
    shutil.rmtree(small_course / "solutions")
    report = checked(small_course)
    assert len(report.failures) == 1
    assert "no solution of 'crank_pin'" in report.failures[0]
    assert not any("nan" in note for note in notes([report]))
    assert "NaN" not in json.dumps(report.as_json())


def test_the_table_of_a_check_is_read_on_80_columns(capsys):
    counts = Counter({"right answers": 24_946, "mistakes recognised": 26_601})
    report = CheckReport("acceleration_polygon_slider", 200, counts, acceptance=0.4)
    print_table(table([report]))
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert any("acceleration_polygon_slider" in line and "51547" in line for line in lines)
    assert "24946 right answers, 26601 mistakes" in notes([report])[0]


def test_a_printed_value_agrees_to_its_last_digit():
    assert agrees(319.8037, "319.80")
    assert not agrees(319.8060, "319.80")
    assert agrees(-179.999, "180.00", is_angle=True)
    assert not agrees(1.0 + 1e-8, 1)
    assert agrees("open", "open")


# ---------------------------------------------------------------------------- by several processes


def inline(function, *arguments):
    """Does what another process would, with copies of what it is sent and of what it returns."""
    function, arguments = pickle.loads(pickle.dumps((function, arguments)))
    done = Future()
    done.set_result(pickle.loads(pickle.dumps(function(*arguments))))
    return done


@pytest.mark.e2e
def test_processes_that_share_the_variants_report_what_one_does():
    alone, shared = (check(COURSE["grashof"], 20, rendered=0, submit=submit) for submit in (None, inline))
    assert alone.as_json() == shared.as_json()
    assert list(alone.counts) == list(shared.counts)
    assert alone.counts["right answers"] > 20


@pytest.mark.e2e
def test_where_a_function_fails_on_a_variant_what_was_tried_before_is_reported_and_nothing_after(monkeypatch):
    tried, seen = checks.check_slips, []

    def breaks(variant, key, report):
        seen.append(variant.seed)
        if variant.seed >= last:
            raise ZeroDivisionError("by an author")
        tried(variant, key, report)

    last = 0
    monkeypatch.setattr(checks, "check_slips", breaks)
    seeds = [v.seed for v in distinct_variants(COURSE["grashof"], 0, 20, "en", Counter(), (ALL,))]
    last = seeds[11]
    alone, shared = (check(COURSE["grashof"], 20, rendered=0, submit=submit) for submit in (None, inline))
    assert alone.as_json() == shared.as_json()
    assert alone.failures == ["ZeroDivisionError: by an author"]
    assert not alone.counts["guessed"]
