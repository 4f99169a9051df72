"""What comes back is read as data: every row comes out once, and one damage costs one row."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coursework.api import open_course
from coursework.errors import BadInput
from coursework.gradebook.notebooks import literal_answers
from coursework.gradebook.placing import UnplacedError, sheet_of_row
from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submissions import find, read_file
from coursework.issuing.issued import Issued
from coursework.messages import localised
from coursework.system.tables import inert

HEADER = "student,exercise,seed,part,answer\n"


def read(tmp_path: Path, name: str, data: str | bytes):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8"))
    rows = list(read_file(path))
    return [r for r in rows if isinstance(r, AnswerRow)], [r for r in rows if isinstance(r, Rejected)]


def test_a_plain_csv(tmp_path):
    rows, rejected = read(tmp_path, "a.csv", HEADER + "Ann,x,1,rA,319.8 mm\nBob,x,2,rA,\n")
    assert [(r.student, r.seed, r.answer) for r in rows] == [("Ann", "1", "319.8 mm"), ("Bob", "2", "")]
    assert rejected == []


@pytest.mark.parametrize(
    "titles", ["Étudiant;Exercice;Graine;Question;Réponse", "ETUDIANT;exercice;graine;question;reponse"]
)
def test_titles_of_the_columns_in_french_are_read_and_told(tmp_path, titles):
    rows, rejected = read(tmp_path, "a.csv", f"{titles}\nAnn;x;1;rA;319,8 mm\n")
    assert ([tuple(r[:5]) for r in rows], rejected) == ([("Ann", "x", "1", "rA", "319,8 mm")], [])
    _, (refused,) = read(
        tmp_path, "b.csv", titles.replace("Graine", "").replace("graine", "") + "\nAnn;x;;rA;3\n"
    )
    assert "étudiant, exercice, graine, question, réponse ; il manque" in localised(
        refused.reason, "fr"
    ).replace("\u202f", " ")
    assert "student, exercise, seed, part, answer" in str(refused.reason)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_encodings_that_say_what_they_are(tmp_path, encoding):
    rows, rejected = read(tmp_path, "a.csv", (HEADER + "Émilie,x,1,rA,104°\n").encode(encoding))
    assert (rows[0].student, rows[0].answer) == ("Émilie", "104°")
    assert rejected == []


def test_a_wrong_encoding_is_read_and_reported(tmp_path):
    rows, _ = read(tmp_path, "a.csv", (HEADER + "Émilie,x,1,rA,104°\n").encode("cp1252"))
    assert (rows[0].student, rows[0].answer) == ("Émilie", "104°")
    assert "Windows-1252" in rows[0].warning
    assert "a.csv: the file is not UTF-8" in rows[0].warning


def test_semicolons_leave_decimal_commas_alone(tmp_path):
    rows, _ = read(tmp_path, "a.csv", "student;exercise;seed;part;answer\r\nAnn;x;1;rA;319,8\r\n")
    assert rows[0].answer == "319,8"


def test_columns_in_any_order_with_others_between(tmp_path):
    rows, _ = read(tmp_path, "a.csv", "Answer,note,student,part,seed,exercise\n3,hm,Ann,rA,1,x\n")
    assert (rows[0].student, rows[0].part, rows[0].answer) == ("Ann", "rA", "3")


def test_an_unclosed_quotation_mark_costs_no_other_row(tmp_path):
    rows, rejected = read(tmp_path, "a.csv", HEADER + 'Ann,x,1,rA,"319.8\nBob,x,2,rA,12\nCy,x,3,rA,13\n')
    assert [r.student for r in rows] == ["Ann", "Bob", "Cy"]
    assert rows[0].answer == "319.8"
    assert rejected == []


def test_a_quoted_answer_may_run_over_lines(tmp_path):
    rows, rejected = read(tmp_path, "a.csv", HEADER + 'Ann,x,1,rA,"319.8\nmm"\nBob,x,2,rA,"a ""b"""\n')
    assert [r.answer for r in rows] == ["319.8\nmm", 'a "b"']
    assert rejected == []


def test_a_row_of_another_width_is_rejected_with_its_line(tmp_path):
    rows, rejected = read(tmp_path, "a.csv", HEADER + "Ann,x,1,rA\nBob,x,2,rA,12\nCy,x,3,rA,13,14\n")
    assert [(r.student, r.answer) for r in rows] == [("Bob", "12"), ("Cy", "13,14")]
    assert [r.source.rpartition(", ")[2] for r in rejected] == ["line 2"]
    assert rejected[0].row["student"] == "Ann"
    assert "quotation marks" not in rejected[0].reason


def test_a_header_without_the_columns_says_which_are_missing(tmp_path):
    _, rejected = read(tmp_path, "a.csv", "student,exercise,part,answer\nAnn,x,rA,3\n")
    assert "seed missing" in rejected[0].reason


@pytest.mark.parametrize("data", [b"", b"  \n", b"\0\0\0\0", b"\xff\xfe\x00"])
def test_a_file_that_is_no_csv_is_one_rejection(tmp_path, data):
    rows, rejected = read(tmp_path, "a.csv", data)
    assert rows == []
    assert len(rejected) == 1


@given(st.binary(max_size=300))
@settings(max_examples=200)
def test_any_bytes_are_read_without_a_traceback(tmp_path_factory, data):
    folder = tmp_path_factory.mktemp("any")
    for ending in (".csv", ".json", ".ipynb"):
        path = folder / f"a{ending}"
        path.write_bytes(data)
        assert all(isinstance(r, (AnswerRow, Rejected)) for r in read_file(path))


@given(
    st.lists(
        st.text(st.characters(exclude_characters='"\0\r\n', exclude_categories=["Cs"]), max_size=20),
        min_size=1,
    )
)
@settings(max_examples=100)
def test_rows_in_are_rows_out(tmp_path_factory, answers):
    import csv
    import io

    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["student", "exercise", "seed", "part", "answer"])
    writer.writerows([f"s{i}", "x", i, "rA", inert(a)] for i, a in enumerate(answers))
    path = tmp_path_factory.mktemp("rows") / "a.csv"
    path.write_bytes(out.getvalue().encode("utf-8"))
    rows = list(read_file(path))
    assert [r.answer for r in rows] == answers


def sheet(**more):
    return {"student": "Ann", "exercise": "x", "seed": 1, "answers": {"rA": "3 mm", "theta4": 104.6}, **more}


def test_json_of_one_sheet_or_of_many(tmp_path):
    rows, _ = read(tmp_path, "a.json", json.dumps(sheet()))
    assert [(r.part, r.answer, r.seed) for r in rows] == [("rA", "3 mm", "1"), ("theta4", 104.6, "1")]
    rows, rejected = read(tmp_path, "a.json", json.dumps([sheet(), {"answers": 3}, sheet(student="Bob")]))
    assert [r.student for r in rows] == ["Ann", "Ann", "Bob", "Bob"]
    assert rejected[0].source.endswith("item 2")


@pytest.mark.parametrize("text", ["{", "3", "[]", '{"student": "A"}', "[" * 100_000])
def test_json_that_is_no_sheet_is_one_rejection(tmp_path, text):
    rows, rejected = read(tmp_path, "a.json", text)
    assert rows == []
    assert len(rejected) == 1


def test_a_nested_answer_costs_its_own_part(tmp_path):
    rows, rejected = read(tmp_path, "a.json", json.dumps(sheet(answers={"rA": {"v": 3}, "b": "4"})))
    assert [r.part for r in rows] == ["b"]
    assert len(rejected) == 1


def notebook(code, tags=("answers",), about=None, cells=None):
    about = {"student": "Ann", "exercise": "x", "seed": 1} if about is None else about
    cell = {"cell_type": "code", "metadata": {"tags": list(tags)}, "source": code}
    return json.dumps({"cells": cells if cells is not None else [cell], "metadata": {"coursework": about}})


@pytest.mark.parametrize(
    "code", ['answers = {"rA": "3", "b": -4.5, "c": None}', '{"rA": "3", "b": -4.5, "c": None}']
)
def test_the_answers_cell_of_a_notebook(tmp_path, code):
    rows, rejected = read(tmp_path, "a.ipynb", notebook(code))
    assert [(r.part, r.answer) for r in rows] == [("rA", "3"), ("b", -4.5), ("c", None)]
    assert rejected == []


@pytest.mark.parametrize(
    "code",
    [
        'answers = {"rA": "3"}\nanswers["rA"] = "4"',
        'answers = {"rA": "3"}\nanswers = {}',
        'answers = {"rA": "3"}\nanswers.clear()',
        "answers = dict(rA=3)",
        "answers = {",
        "answers = 3",
        "",
        "x" * 300_000,
        "answers = " + "{" * 5000,
        'answers = {**{"rA": "3"}}',
        'answers = {"rA": "3" "b": "4"}',
    ],
)
def test_code_in_the_answers_cell_is_told_and_never_run(tmp_path, monkeypatch, code):
    monkeypatch.chdir(tmp_path)
    rows, rejected = read(tmp_path, "a.ipynb", notebook(code))
    assert rows == []
    assert len(rejected) == 1
    assert rejected[0].row["student"] == "Ann"
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize(
    ("value", "answer"),
    [
        ("r1*2", "r1*2"),
        ("rA", "rA"),
        ("f'{3}'", "f'{3}'"),
        ('__import__("os").system("touch ran")', '__import__("os").system("touch ran")'),
        ("(2 +\n 3) * r1", "(2 +\n 3) * r1"),
        ("é*2", "é*2"),
        ("111,5", "111,5"),
        ("12.5 mm", "12.5 mm"),
        ("72°", "72°"),
        ('"72', "72"),
        ('72"', "72"),
        ("", ""),
    ],
)
@pytest.mark.parametrize("comma", [",  # mm", ",", ""])
def test_a_value_not_written_as_asked_costs_no_other_answer(tmp_path, monkeypatch, value, answer, comma):
    monkeypatch.chdir(tmp_path)
    code = (
        f'# Your answers.\r\nanswers = {{\n  "a": "é 1",  # deg\n  "rA": {value}{comma}\n  "b": 2,\n  "c": '
        f'"3"}}\n'
    )
    if "\n" in value and not comma:
        return
    rows, rejected = read(tmp_path, "a.ipynb", notebook(code))
    assert [(r.part, r.answer) for r in rows] == [("a", "é 1"), ("rA", answer), ("b", 2), ("c", "3")]
    assert rejected == []
    assert not (tmp_path / "ran").exists()


def test_an_answers_cell_that_cannot_be_read_is_told_by_its_line_and_part(tmp_path):
    code = 'answers = {\n  "a": "1",\n  "rA": "2" "b": "3",\n}'
    _, (rejected,) = read(tmp_path, "ann.ipynb", notebook(code, about={"exercise": "x", "seed": 1}))
    assert rejected.source.endswith("ann.ipynb")
    assert (
        "line 3, part rA, is not written as in the notebook: quotes around text, a comma" in rejected.reason
    )
    assert (rejected.row["student"], rejected.row["exercise"]) == ("ann", "x")


@pytest.mark.parametrize(
    "text", ["{", "[]", "3", "{}", notebook("{}", about=3), notebook("{}", tags=()), notebook("", cells=3)]
)
def test_a_notebook_that_is_none_is_one_rejection(tmp_path, text):
    rows, rejected = read(tmp_path, "a.ipynb", text)
    assert rows == []
    assert len(rejected) == 1


def test_a_literal_may_hold_points():
    assert literal_answers("answers = {'p': (1, 0, -2.5), 'q': [1, 2, 3]}") == {
        "p": (1, 0, -2.5),
        "q": [1, 2, 3],
    }


def test_folders_are_walked_in_name_order_and_strangers_are_reported(tmp_path):
    for name in ("b.csv", "a.json", "sub/c.ipynb", "notes.docx", ".hidden/x.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("x")
    found = list(find([tmp_path]))
    assert [p.name for p in found if isinstance(p, Path)] == ["a.json", "b.csv", "c.ipynb"]
    assert ["docx" in r.reason for r in found if isinstance(r, Rejected)] == [True]


def test_a_path_that_is_not_there_is_told_with_the_nearest(tmp_path):
    (tmp_path / "returned").mkdir()
    (tmp_path / "returned" / "a.csv").write_text(HEADER)
    with pytest.raises(BadInput, match=r"no such file or folder: .*retuned \(did you mean .*returned/\?\)"):
        list(find([tmp_path / "returned", tmp_path / "retuned"]))
    with pytest.raises(BadInput, match=r"no such file or folder: [^(]*zzz$"):
        list(find([tmp_path / "nowhere" / "zzz"]))


@given(st.lists(st.text("ab1,\"° '", max_size=12), min_size=1, max_size=8))
@settings(max_examples=200)
def test_stray_quotation_marks_lose_no_row(tmp_path_factory, answers):
    """Lines written without any quoting: each line with the right number of cells stays its own row."""
    import re

    path = tmp_path_factory.mktemp("quotes") / "a.csv"
    lines = [f"s{i};x;{i};rA;{a.replace(';', '')}" for i, a in enumerate(answers)]
    path.write_text("student;exercise;seed;part;answer\n" + "\n".join(lines) + "\n", "utf-8")
    rows = [r for r in read_file(path) if isinstance(r, AnswerRow)]
    assert [r.student for r in rows] == [f"s{i}" for i in range(len(answers))]
    for row, answer in zip(rows, answers, strict=True):
        if not re.match(r'\s*"', answer):
            assert row.answer == answer


@pytest.mark.parametrize(
    "text",
    [
        '{"student": "A", "exercise": "x", "seed": 1, "answers": {"rA": ' + "9" * 5000 + "}}",
        '{"student": "A", "exercise": "x", "seed": 1, "answers": {"rA": "\\ud800"}}',
        '{"student": "\\ud800", "exercise": "x", "seed": 1, "answers": {"rA": "1"}}',
    ],
)
def test_absurd_numbers_and_half_characters_are_texts(tmp_path, text):
    rows, rejected = read(tmp_path, "a.json", text)
    assert len(rows) == 1
    assert rejected == []
    (rows[0].student + str(rows[0].answer)).encode("utf-8")


def test_a_hexadecimal_monster_in_a_notebook_is_a_text(tmp_path):
    rows, _ = read(tmp_path, "a.ipynb", notebook("answers = {'rA': 0x" + "F" * 5000 + "}"))
    assert isinstance(rows[0].answer, str)


def test_an_answer_given_twice_comes_out_twice(tmp_path):
    rows, _ = read(
        tmp_path, "a.json", '{"student": "A", "exercise": "x", "seed": 1, "answers": {"rA": "1", "rA": "2"}}'
    )
    assert [r.answer for r in rows] == ["1", "2"]
    rows, _ = read(tmp_path, "a.ipynb", notebook("answers = {'rA': '1', 'rA': '2'}"))
    assert [r.answer for r in rows] == ["1", "2"]


def test_a_file_too_large_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("coursework.gradebook.submissions.MAX_BYTES", 10)
    _, rejected = read(tmp_path, "a.csv", HEADER)
    assert "limit" in rejected[0].reason


# --------------------------------------------------- behind a hash, between commas


@pytest.mark.parametrize(
    ("line", "kept"),
    [
        ('"rA": 319#.8,', "319#.8,"),
        ('"rA": 319#.8', "319#.8"),
        ('"rA": #"319.8",  # mm', '"319.8",  # mm'),
        ('# "rA": "319.8",  # mm', '"319.8",  # mm'),
        ('"x": "1",  # mm    "rA": "319.8",', '"319.8"'),
        ('"rA": "",  # "rA": 319.8', "319.8"),
        ('"rA": #319.8,\n  35,', "319.8,"),
    ],
)
@pytest.mark.parametrize("last", ['"b": "2",\n}', '"b": "2"}', '"b": 1 "\n}'])
def test_an_answer_behind_a_hash_is_rejected_with_its_text(tmp_path, line, kept, last):
    rows, rejected = read(tmp_path, "a.ipynb", notebook(f"answers = {{\n  {line}\n  {last}\n"))
    assert "rA" not in [r.part for r in rows]
    (cut,) = rejected
    if cut.row["part"]:
        assert (cut.row["part"], cut.row["answer"], cut.row["student"]) == ("rA", kept, "Ann")
        assert "behind a #" in cut.reason
        assert "b" in [r.part for r in rows]
    else:  # the cell is not as written, and is rejected whole
        assert line in cut.row["answer"]


@pytest.mark.parametrize(
    "line",
    [
        '"rA": "3",  # mm/s^2, e.g. 12.5',
        '"rA": "3",  # my first try was "rA": "4"',
        '"rA": "3 # of 4",',
        "\"rA\": '3#',",
        '"rA": 3,  # 4',
        '"rA": 3  # 4',
        '"rA": "3" #,',
        '# Your answers, e.g. 12.5\n  "rA": "3",',
    ],
)
def test_a_remark_behind_a_hash_is_no_answer(tmp_path, line):
    code = f'answers = {{\n  {line}\n  "b": "2",  # mm/s²\n}}'
    rows, rejected = read(tmp_path, "a.ipynb", notebook(code))
    assert rejected == []
    assert [r.part for r in rows] == ["rA", "b"]
    assert str(rows[0].answer)[:1] == "3"


def test_an_empty_box_with_its_unit_behind_a_hash_is_missing(tmp_path):
    code = 'answers = {\n  "rA": "",  # mm/s²\n  "b":   # rad\n  "c": "",  # a, b\n}'
    rows, rejected = read(tmp_path, "a.ipynb", notebook(code))
    assert [(r.part, r.answer) for r in rows] == [("rA", ""), ("b", ""), ("c", "")]
    assert rejected == []


CUT_AT = ("#", " # ", "#\n", "\n#", '"#', '#"', "# ")


@pytest.mark.parametrize("count", [300, pytest.param(800, marks=pytest.mark.slow)])
def test_no_mutation_with_a_hash_loses_an_answer(tmp_path, count):
    """Each value that was handed in comes out: in a row, or in a rejection."""
    parts = {f"p{n}": f"{31 + 7 * n}.{n}77" for n in range(8)}
    lines = [f'  "{part}": "{value}",  # mm' for part, value in parts.items()]
    code = "answers = {\n" + "\n".join(lines) + "\n}"
    rng, tried = random.Random(5), 0
    for _ in range(count):
        place, cut = rng.randrange(len(code)), rng.choice(CUT_AT)
        length = rng.choice((0, 0, 1, 1, 2))
        mutated = code[:place] + cut * (length < 2) + code[place + length :]
        rows, rejected = read(tmp_path, "a.ipynb", notebook(mutated))
        out = " ".join([str(r.answer) for r in rows] + [r.row.get("answer", "") for r in rejected])
        # The cell itself, which is kept with its notebook.
        whole = any("behind a #" not in r.reason for r in rejected)
        lost = [v for v in parts.values() if v in mutated and v not in out]
        assert whole or not lost, (mutated, lost)
        tried += not whole
    assert tried > 0.375 * count


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("Ann,x,1,rA,12,5", "12,5"),
        ("Ann,x,1,rA,12,5 ; 3,2", "12,5 ; 3,2"),
        ("Ann,x,1,rA,(1, 2, 3)", "(1, 2, 3)"),
        ("Ann,x,1,rA,12.5,", "12.5,"),
    ],
)
def test_a_comma_without_quotation_marks_belongs_to_the_answer_at_the_end_of_a_line(tmp_path, line, answer):
    rows, rejected = read(
        tmp_path, "a.csv", f"student,exercise,seed,part,answer\nBo,x,1,rA,3\n{line}\nCy,x,1,rA,4\n"
    )
    assert [(r.student, r.part, r.answer) for r in rows] == [
        ("Bo", "rA", "3"),
        ("Ann", "rA", answer),
        ("Cy", "rA", "4"),
    ]
    assert rejected == []
    assert "line 3" in rows[1].warning
    assert "comma" in rows[1].warning


@pytest.mark.parametrize(
    ("header", "line"),
    [
        ("student,exercise,seed,part,answer", "Durand, Paul,x,1,rA,12.5"),
        ("student,exercise,answer,seed,part", "Ann,x,12,5,1,rA"),
        ("student,exercise,seed,part,answer,room", "Ann,x,1,rA,12,5,B2"),
    ],
)
def test_where_a_comma_may_belong_elsewhere_the_whole_text_is_kept(tmp_path, header, line):
    rows, (rejected,) = read(tmp_path, "a.csv", f"{header}\n{line}\n")
    assert rows == []
    assert "quotation marks" in rejected.reason
    if "12,5" in line:
        assert rejected.row["answer"].startswith("12,5")
    else:
        assert rejected.row["answer"] == "rA,12.5"


def test_of_namesakes_none_is_meant_before_the_others():
    record, names = open_course()["grashof"].variant(1).record, ("Marie Martin (1)", "Marie Martin (2)")
    dealt = [{"student": name, "record": record} for name in names]
    issued = Issued({"format": 1, "roster": True, "issued": dealt}, "issued.json")
    row = AnswerRow("marie martin", "grashof", "1", "s_plus_l", "2", "answers.csv, line 2")
    with pytest.raises(UnplacedError, match=r"which of 'Marie Martin \(1\)', 'Marie Martin \(2\)'"):
        sheet_of_row(issued, row)
