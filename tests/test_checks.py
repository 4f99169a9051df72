"""The check is a proof only if it fails when a promise is broken: each kind of break is tried."""

from __future__ import annotations

import pytest

import coursework
from coursework.checks import agrees, check

X = "return r * cos(theta)"

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


def test_the_small_course_passes_untouched(small_course):
    report = check(coursework.open_course(small_course)["crank_pin"], 60)
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
    report = check(coursework.open_course(small_course)["crank_pin"], 60, rendered=1)
    assert any(told in failure for failure in report.failures), report.failures[:5]


def test_a_missing_language_is_a_failure(small_course):
    (small_course / "exercises" / "crank_pin.en.md.j2").unlink()
    report = check(coursework.open_course(small_course)["crank_pin"], 2, rendered=1)
    assert any("no statement in 'en'" in f for f in report.failures)


def test_a_printed_value_agrees_to_its_last_digit():
    assert agrees(319.8037, "319.80")
    assert not agrees(319.8060, "319.80")
    assert agrees(-179.999, "180.00", is_angle=True)
    assert not agrees(1.0 + 1e-8, 1)
    assert agrees("open", "open")
