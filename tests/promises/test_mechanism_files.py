"""The promises that mechanisms stated as files keep: ``coursework check`` over each that comes with the
package."""

import re

import numpy as np
import pytest
from linkage_samples import NAMES, course

from coursework.authoring.checks import check

QUICK = ("crossed_slides", "planet_wheel")  #: of files that are checked, those with other joints than pins


@pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.sweep) for name in NAMES]
)
def test_a_file_to_start_from_passes_its_check(name):
    """With as many different variants as a class takes, where it is no class of three, which takes
    minutes."""
    count = 4 if name in QUICK or name.startswith("class_three") else 30
    assert check(course()[name], count, rendered=0).failures == []


@pytest.mark.parametrize(
    "names",
    [("crossed_slides", "piston_engine"), pytest.param(NAMES, marks=pytest.mark.sweep)],
    ids=["few", "all"],
)
def test_joints_hold_where_nothing_moves_or_only_speeds_up(names):
    """The gaps are measured by what moves: with all rates zero there are none, with the speed alone zero none
    but of rounding."""
    wide = {}
    for name in names:
        exercise = course()[name]
        graph, variant = exercise.solution.residual_graph, exercise.variant(1)
        known = {*graph.names, *graph.leaves}
        given = {n: v for n, v in variant.given.items() if n in known}
        speeds = [n for n in given if n.startswith("omega") or n.endswith("_dot")]
        gains = [n for n in given if n.startswith("alpha") or n.endswith("_ddot")]
        for still in ([], speeds, gains, [*speeds, *gains]):
            gaps = graph.evaluate(("residual",), {**given, **dict.fromkeys(still, 0.0)})["residual"]
            if not np.max(gaps) <= 1e-12:
                wide[name, tuple(still)] = gaps
    assert wide == {}


def test_no_sheet_says_that_a_length_is_itself():
    """A number in a file is called by its ends: its value stands among the data, and there is nothing more to
    say of it."""
    said = {}
    for name in NAMES:
        for lang in ("fr", "en"):
            text = course()[name].variant(1).in_language(lang).handout().statement
            if found := re.findall(r"\b(\w+) = \1\b", text):
                said[name, lang] = found
    assert said == {}
