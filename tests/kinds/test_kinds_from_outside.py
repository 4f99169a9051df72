"""A kind of part is one file: a course brings an *interval*, and it is built, marked, studied and checked as
any."""

from __future__ import annotations

import csv
import json

import pytest
from tables import each_row

import coursework
from coursework.authoring import checks
from coursework.cli import run
from coursework.errors import BadCourse
from coursework.kinds.kind import kind_of, kinds
from coursework.model import Part

KIND = '''
"""An interval: right where both its ends are, each within the margin of the longer of the two."""

import numpy as np

from coursework.kinds.kind import AnswerSpelling, Kind
from coursework.kinds.nearness import in_half_widths
from coursework.language.numbers import significant
from coursework.parsing.points import read_point


class Interval(Kind):
    name = "interval"
    family = "point"
    box = "wide"
    hint = {"fr": "deux bornes", "en": "two ends"}

    def read(self, answer, part, asking):
        return read_point(answer, part.unit, 2)

    def distance(self, part, value, reference, along=None, envelope=0.0):
        size = self.size(reference)
        gap = float(np.max(np.abs(np.asarray(value, dtype=float) - reference)))
        return in_half_widths(gap, max(part.half_width(size), envelope), size)

    def size(self, reference):
        return float(np.max(np.abs(reference)))

    def written(self, value, digits, label):
        low, high = (significant(v, digits) for v in value.tolist())
        return f"[{low} ; {high}]"

    def spellings(self, part, value, label):
        yield AnswerSpelling("exact", "; ".join(repr(v) for v in value.tolist()))
        yield from (spelled for spelled in super().spellings(part, value, label) if spelled.way != "exact")
'''

EXERCISE = '''
"""Two cranks in a row: how near and how far does their end come?"""

from coursework.model import Exercise, Part, drawn

from ._interval import Interval  # noqa: F401


def lengths_differ(r1, r2):
    return abs(r1 - r2) >= 0.2 * (r1 + r2)


EXERCISE = Exercise(
    given={"r1": drawn(50, 200, step=5, unit="mm"), "r2": drawn(50, 200, step=5, unit="mm")},
    constraints=(lengths_differ,),
    parts=(Part("reach", unit="mm", kind="interval", points=2),),
)
'''

SOLUTION = '''
"""The ring that two cranks in a row can reach: from the difference of their lengths to the sum."""

import numpy as np

from coursework.solution import mistake


def reach(r1, r2):
    return np.stack(np.broadcast_arrays(abs(r1 - r2), r1 + r2), axis=-1)


@mistake("reach", share=0.5)
def from_nothing(r1, r2):
    return np.stack(np.broadcast_arrays(0.0 * r1, r1 + r2), axis=-1)


def residual(r1, r2, reach):
    return (reach[..., 0] + reach[..., 1]) / (2 * np.maximum(r1, r2)) - 1, (reach[..., 1] - reach[..., 0]) / (
        2 * np.minimum(r1, r2)
    ) - 1


KNOWN = (({"r1": 100, "r2": 40}, {"reach": (60, 140)}),)
'''

STATEMENT = {
    "fr": "# Deux manivelles\n\nDeux manivelles en série, $r_1$ et $r_2$.\n\n## reach\nÀ quelle distance "
    "peut être leur bout ?\n",
    "en": "# Two cranks\n\nTwo cranks in a row, $r_1$ and $r_2$.\n\n## reach\nHow far away may their end "
    "be?\n",
}
WORDS = {
    "fr": "# Deux manivelles\n\n## mistake from_nothing\nLe plus court.\n",
    "en": "# Two cranks\n\n## mistake from_nothing\nThe nearest.\n",
}


@pytest.fixture
def own_course(tmp_path):
    root = tmp_path / "own"
    for folder in ("exercises", "solutions"):
        (root / folder).mkdir(parents=True)
    (root / "exercises" / "_interval.py").write_text(KIND, "utf-8")
    (root / "exercises" / "two_cranks.py").write_text(EXERCISE, "utf-8")
    (root / "solutions" / "two_cranks.py").write_text(SOLUTION, "utf-8")
    for lang in ("fr", "en"):
        (root / "exercises" / f"two_cranks.{lang}.md.j2").write_text(STATEMENT[lang], "utf-8")
        (root / "solutions" / f"two_cranks.{lang}.md.j2").write_text(WORDS[lang], "utf-8")
    return root


def test_every_promise_is_proved_of_it(own_course):
    report = checks.check(coursework.open_course(own_course)["two_cranks"], 40)
    assert not report.failures
    assert report.counts["mistakes recognised"] >= 40
    assert report.counts["right answers"] >= 40


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        ("60 ; 140", "correct"),
        ("[6,0 cm ; 14,0 cm]", "correct"),
        ([60, 140], "correct"),
        ("61.4 ; 140", "correct"),
        ("61.5 ; 140", "wrong"),
        ("0 ; 140", "mistake:from_nothing"),
        ("60", "unreadable"),
        ("60 kg ; 140 kg", "wrong_unit"),
        ("", "missing"),
    ],
)
def test_it_is_marked_by_its_own_rule(own_course, answer, verdict):
    exercise = coursework.open_course(own_course)["two_cranks"]
    variant = coursework.Variant(exercise, 0, {"r1": 100.0, "r2": 40.0}, "en")
    assert variant.grade({"reach": answer})["reach"].verdict == verdict


def test_it_is_printed_handed_in_and_marked_by_the_commands(own_course, tmp_path):
    out, marks = tmp_path / "out", tmp_path / "marks"
    build = [*"build --variants 3 --formats pdf,ipynb,html,tex --lang fr,en --out".split(), str(out)]
    assert run(["--course", str(own_course), *build]) == 0
    key = json.loads((out / "instructor" / "key.json").read_text("utf-8"))
    assert all(len(record["answers"]["reach"]["value"]) == 2 for record in key)
    notebook = next((out / "handouts" / "two_cranks").glob("*.en.ipynb")).read_text("utf-8")
    assert "two ends" in notebook
    answers = tmp_path / "answers.csv"
    with answers.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["student", "exercise", "seed", "part", "answer"])
        for record in key:
            low, high = record["answers"]["reach"]["value"]
            writer.writerow(
                [f"s{record['seed']}", "two_cranks", record["seed"], "reach", f"[{low:.4g} ; {high:.4g}] mm"]
            )
    grade = ["grade", str(answers), "--issued", str(out / "issued.json"), "--out", str(marks)]
    assert run(["--course", str(own_course), *grade]) == 0
    with (marks / "marks.csv").open(encoding="utf-8-sig", newline="") as file:
        assert {row["verdict"] for row in csv.DictReader(file)} == {"correct"}


def test_a_student_alone_is_told_of_it(own_course, tmp_path):
    session = coursework.study("two_cranks", lang="en", course=own_course, folder=tmp_path)
    session.check({"reach": "nothing"})
    assert "✓" in str(session.check({"reach": session.variant.solution()["reach"].tolist()}))


def test_the_kinds_there_are_have_a_file_each_and_a_word():
    known = {"number", "angle", "integer", "choice", "point", "point_on_line", "direction", "equation"}
    assert known <= set(kinds())
    assert all(kind_of(name).name == name for name in kinds())


def test_a_kind_that_is_none_is_told_with_the_nearest():
    with pytest.raises(BadCourse, match=r"part 'rA': no kind 'nombre'.*number"):
        Part("rA", kind="nombre")


@each_row(
    ("stated", "said"),
    [
        ({"kind": "choice"}, "'choices' goes with"),
        ({"choices": ("a", "b")}, "'choices' goes with"),
        ({"kind": "point_on_line"}, "'along' goes with"),
        ({"variables": ("x",)}, "'variables' goes with"),
    ],
)
def test_a_field_that_goes_with_a_kind_must_and_with_no_other(stated, said):
    with pytest.raises(BadCourse, match=said):
        Part("rA", **stated)
