"""The page on the database keeps up with it: every table is told of, every question of SQL can be asked."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from sqlalchemy import text
from stored_class import ANA, BEN, CAME, content, put, rows

import coursework
from coursework.database.marking import mark_new
from coursework.database.submissions import insert_submission
from coursework.database.tables import METADATA

PAGE = (Path(__file__).resolve().parents[2] / "docs/database.md").read_text("utf-8")
QUESTIONS = re.findall(r"```sql\n(.*?)```", PAGE, re.DOTALL)


def test_every_table_is_told_of():
    told = re.search(r"## What the tables hold\n(.*?)\n## ", PAGE, re.DOTALL)[1]
    first = "".join(line.split("|")[1] for line in told.splitlines() if line.startswith("| `"))
    assert set(re.findall(r"`(\w+)`", first)) == set(METADATA.tables)


@pytest.fixture
def full(store, small_course):
    course = coursework.open_course(small_course)
    number = put(store, content(course), rows(course, ANA, 0), rows(course, BEN, 1, x="somewhere"))
    with store.begin() as connection:
        insert_submission(
            connection,
            number,
            rows(course, BEN, 1, 2),
            source="site",
            received_at=CAME,
            person_id=1,
            number=2,
            late=120,
        )
    mark_new(course, store, number)
    return store


@pytest.mark.parametrize("question", QUESTIONS, ids=range(len(QUESTIONS)))
def test_every_question_can_be_asked(full, question):
    with full.reading() as connection:
        found = connection.execute(text(question)).all()
    assert found or "FROM decision" in question
