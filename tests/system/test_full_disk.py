"""A disk that is full is told with the file that it was for."""

from __future__ import annotations

from pathlib import Path

import pytest

from coursework.errors import BadInput
from coursework.system.writing import Tables

pytestmark = pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no full device")


def write(folder, rows):
    with Tables(folder) as tables:
        table = tables.open("marks.csv", ("a",))
        for _ in range(rows):  # few reach the disk at the end alone
            table.write({"a": "x"})
        tables.commit()


@pytest.mark.parametrize("rows", [1, 50_000])
def test_a_table_names_itself_and_leaves_the_one_before(tmp_path, rows):
    (tmp_path / "marks.csv").write_text("before")
    (tmp_path / "marks.csv.part").symlink_to("/dev/full")
    with pytest.raises(BadInput, match=r"marks\.csv cannot be written"):
        write(tmp_path, rows)
    assert [path.name for path in tmp_path.iterdir()] == ["marks.csv"]
    assert (tmp_path / "marks.csv").read_text() == "before"
