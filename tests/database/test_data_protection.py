"""docs/data_protection.md and its French version name every column that is kept, and nothing that is not."""

import re
from pathlib import Path

import pytest

from coursework.database.tables import METADATA

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = [DOCS / "data_protection.md", DOCS / "data_protection.fr.md"]
both = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)


def stated(page):
    """The columns of each table of the database that a page names."""
    rows = re.findall(
        r"^\| `(\w+)` \| ((?:`\w+`(?:, )?)+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|$",
        page.read_text("utf-8"),
        re.M,
    )
    assert len({table for table, *_ in rows}) == len(rows), "a table is named twice"
    assert all(cell.strip() for row in rows for cell in row)
    return {table: re.findall(r"`(\w+)`", columns) for table, columns, *_ in rows}


@both
def test_no_column_of_the_database_is_forgotten(page):
    kept = {
        table.name: [one.name for one in table.c if one.name != "id" and not one.foreign_keys]
        for table in METADATA.tables.values()
    }
    told = stated(page)
    assert {name: sorted(columns) for name, columns in told.items()} == {
        name: sorted(columns) for name, columns in kept.items()
    }


def test_both_languages_say_the_same_of_each_table():
    english, french = map(stated, PAGES)
    assert list(english) == list(french)
    lines = [
        re.findall(r"^\| `(\w+)` \|.*\| ([WIS, N]+|[TIS, N]+) \| [^|]+ \|$", page.read_text("utf-8"), re.M)
        for page in PAGES
    ]
    classes = [{table: kinds.replace("T", "W") for table, kinds in found} for found in lines]
    assert classes[0] == classes[1]
