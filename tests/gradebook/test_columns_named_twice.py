"""Of a column that a header names twice it is not guessed which is meant: the table is refused by name."""

from __future__ import annotations

from functools import partial

import pytest

from coursework.errors import BadInput
from coursework.gradebook.decisions import DecisionFiles
from coursework.gradebook.rows import Rejected
from coursework.gradebook.statistics.marks import _lines
from coursework.gradebook.submissions import read_file
from coursework.issuing.roster import read_roster
from coursework.scanning.typed import read_typed


@pytest.mark.parametrize("again", ["answer", " Answer ", "STUDENT", '"part"'])
def test_answers(tmp_path, again):
    path = tmp_path / "a.csv"
    path.write_text(f"student,exercise,seed,part,answer,{again}\nAnn,x,1,rA,3,4\nBob,x,1,rA,3,4\n")
    (found,) = read_file(path)
    assert isinstance(found, Rejected)
    assert "twice" in found.reason
    assert again.strip(' "').lower() in found.reason


def test_columns_of_ones_own_may_be_called_alike(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("student,note,exercise,seed,part,answer,note\nAnn,,x,1,rA,3,4\n")
    (row,) = read_file(path)
    assert row.answer == "3"


@pytest.mark.parametrize(
    ("read", "text"),
    [
        (partial(DecisionFiles, None), "student,exercise,seed,part,points,Points\nAnn,x,1,rA,1,0\n"),
        (read_roster, "student,student\nAnn,Bob\n"),
        (read_roster, "student,lang,lang\nAnn,fr,en\n"),
        (read_typed, "student,exercise,seed,part,coordinate,answer,seen,answer\nAnn,x,1,rA,1,3,,4\n"),
        (lambda path: list(_lines(path, ("points",))), "points,points\n1,0\n"),
    ],
)
def test_every_other_table_that_is_read_back(tmp_path, read, text):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(BadInput, match="twice"):
        read(path)


def test_a_rosters_columns_of_one_title_are_told(tmp_path):
    path, told = tmp_path / "r.csv", []
    path.write_text("student,group,group\nAnn,1,2\n")
    (ann,) = read_roster(path, told.append)
    assert ann.columns == {"group": "2"}
    assert "group" in told[0]
