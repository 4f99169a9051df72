"""Files beyond all measure: told with their limit, before they are unpacked; what is read is read in steps,
not in squares."""

from __future__ import annotations

import json

import pytest

from coursework.gradebook.decisions import DecisionFiles
from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submissions import read_file
from coursework.system import tables

COLUMNS = ["student", "exercise", "seed", "part", "answer"]
HEADER = ",".join(COLUMNS)


def read(path, data):
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return list(read_file(path))


def parquet(path, rows, **texts):
    """Every row alike: a few hundred bytes, however many they are."""
    pa, pq = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    column = {
        name: pa.DictionaryArray.from_arrays(
            pa.array([0] * rows, pa.int32()), pa.array([texts.get(name, "1")])
        )
        for name in COLUMNS
    }
    pq.write_table(pa.table(column), path, compression="zstd")
    return list(read_file(path))


@pytest.mark.parametrize(
    ("limit", "most", "told"),
    [("MOST_ROWS", 999, "1,000 rows"), ("MOST_UNPACKED", 100, "bytes unpacked"), ("MAX_BYTES", 10, "bytes")],
)
def test_a_file_beyond_its_limits_is_one_rejected_row(tmp_path, monkeypatch, limit, most, told):
    monkeypatch.setattr(f"coursework.gradebook.submissions.{limit}", most)
    if limit == "MAX_BYTES":
        found = read(tmp_path / "a.csv", HEADER + "\n" + 1000 * "A,x,1,rA,2\n")
    else:
        found = parquet(tmp_path / "a.parquet", 1000)
    assert [type(row) for row in found] == [Rejected]
    assert told in found[0].reason
    assert f"limit is {most:,}" in found[0].reason


def test_a_csv_of_too_many_rows_or_columns_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("coursework.gradebook.submissions.MOST_ROWS", 3)
    assert "the limit is 3" in read(tmp_path / "a.csv", HEADER + "\n" + 9 * "A,x,1,rA,2\n")[0].reason
    wide = read(tmp_path / "b.csv", HEADER + 9000 * "," + "\nA,x,1,rA,2\n")
    assert len(wide) == 1
    assert "9,005 columns" in wide[0].reason


def test_one_text_of_a_small_parquet_file_is_kept_once(tmp_path):
    rows = parquet(tmp_path / "a.parquet", 5000, student="s" * 500, answer="9" * 500)
    assert len(rows) == 5000
    assert len({id(row.student) for row in rows}) == len({id(r.answer) for r in rows}) == 1
    assert rows[0][:5] == ("s" * 500, "1", "1", "1", "9" * 500)


def test_an_answer_of_a_million_characters_is_told_and_the_others_are_read(tmp_path):
    pa, pq = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    answers = ["12", "1" * 1_000_000, None]
    pq.write_table(
        pa.table({**dict.fromkeys(COLUMNS[:4], ["1"] * 3), "answer": answers}), tmp_path / "a.parquet"
    )
    found = list(read_file(tmp_path / "a.parquet"))
    assert [type(row) for row in found] == [AnswerRow, Rejected, AnswerRow]
    assert [found[0].answer, found[2].answer] == ["12", None]
    assert "1,000,000 characters" in found[1].reason
    assert len(json.dumps(found[1].row)) < 1000


@pytest.mark.parametrize("line", ['"', '"\n"', 'x"', '""', '"a\n\n"', '","'])
def test_lone_quotation_marks_cost_a_try_or_two_a_line(tmp_path, monkeypatch, line):
    tried = []
    cells = tables._cells
    monkeypatch.setattr(tables, "_cells", lambda text, by: tried.append(len(text)) or cells(text, by))
    read(tmp_path / "a.csv", HEADER + "\n" + 300 * f"{line}\n")
    lines = 300 * (line.count("\n") + 1)
    assert len(tried) < 4 * lines
    assert max(tried) < 100


@pytest.mark.parametrize("blank", ["\n", "\r\n\r\n", "  \n\t\n", ";;;;\n"[4:]])
def test_a_blank_first_line_rejects_nothing(tmp_path, blank):
    for comma in ",;":
        rows = read(tmp_path / "a.csv", blank + f"{HEADER}\nA,x,1,rA,2\n".replace(",", comma))
        assert [row[:5] for row in rows] == [("A", "x", "1", "rA", "2")]
    (tmp_path / "accepted.csv").write_text(blank + "student,exercise,part\nA,x,rA\n")
    assert [one.answer_id for one in DecisionFiles(tmp_path).lines] == [("A", "x", "", "rA")]
