"""Every file that is read back is held against its shape: what does not fit is told by file and place, never
by a traceback.

The cases are what a fuzz of each reader found; the fuzz itself is among the slow tests.
"""

from __future__ import annotations

import json
import random
import shutil
from datetime import UTC, datetime
from pathlib import Path

import pytest
from class_of_three import table, write_rows
from course_of_every_kind import write_course
from mutations import damaged_bytes, damaged_json, damaged_table

from coursework.cli import run
from coursework.database.dump import restore
from coursework.database.store import Store
from coursework.errors import CourseworkError
from coursework.gradebook.submissions import read_file
from coursework.selfstudy.progress import ExerciseStore, ProgressFile, entry

RECORDED = Path(__file__).parents[1] / "gradebook" / "recorded"
DEEP = "[" * 100_000


class Class:
    """A class with an open question that is built, as exercises and as an assignment, marked twice, kept in a
    database, dumped."""

    def __init__(self, folder):
        self.folder = folder
        write_course(folder / "course")
        (folder / "r.csv").write_text("student,number,lang\nAna,7,fr\nBen,8,en\nCléo,9,\n", "utf-8")
        (folder / "a.toml").write_text(
            'title = "W"\n[[exercises]]\nname = "coil"\n[mark]\nof = 20\nstep = 0.5\n'
        )
        build = "--roster", folder / "r.csv", "--formats", "ipynb", "--out"
        assert self("build", "coil", *build, folder / "b") == 0
        assert self("build", folder / "a.toml", *build, folder / "as") == 0
        rows, key = (
            table(folder / "b" / "answers.csv"),
            json.loads((folder / "b/instructor/key.json").read_text()),
        )
        right = {one["student"]: one["answers"] for one in key}
        for row in rows:
            value = right[row["student"]][row["part"]]["value"]
            row["answer"] = (
                "; ".join(map(str, value)) if isinstance(value, list) else str(value or 'so, "because"')
            )
        write_rows(folder / "all.csv", rows)
        (folder / "b" / "marks").mkdir()
        accepted = (
            f"student,exercise,seed,part,points,reason\nAna,coil,{key[0]['seed']},Z,1,good\nBen,coil,,I,,\n"
        )
        (folder / "b" / "marks" / "accepted.csv").write_text(accepted, "utf-8")
        assert self.grade(folder / "b", folder / "b" / "marks") == 1
        assert self.grade(folder / "b", folder / "b" / "marks", "--db", folder / "m.db") == 1
        assert run(["database", "dump", str(folder / "m.db"), str(folder / "dump")]) == 0
        Store(str(folder / "empty.db")).close()
        sheets = [
            {
                "student": who,
                "exercise": "coil",
                "seed": one["seed"],
                "answers": dict.fromkeys(right[who], "1"),
            }
            for who, one in zip(right, key, strict=True)
        ]
        (folder / "sheets.json").write_text(json.dumps(sheets), "utf-8")
        (folder / "p").mkdir()
        what = (("answer", {"answer": "3", "verdict": "wrong", "shown": ["x"]}), ("hint", {"step": 1}))
        file = ProgressFile(folder / "p")
        file.add([entry(datetime(2026, 1, 1, tzinfo=UTC), "coil", 3, "Z", w, **more) for w, more in what])

    def __call__(self, *words):
        return run(["--course", str(self.folder / "course"), *map(str, words)])

    def grade(self, issued, out, *more):
        return self(
            "grade",
            self.folder / "all.csv",
            "--issued",
            issued / "issued.json",
            "--no-feedback",
            "--out",
            out,
            *more,
        )

    def restored(self, folder):
        shutil.copy(self.folder / "empty.db", folder.with_suffix(".db"))
        store = Store(str(folder.with_suffix(".db")))
        try:
            restore(folder, store)
        finally:
            store.close()

    def studied(self, folder):
        kept = ExerciseStore(ProgressFile(folder), "coil")
        kept.add(3, "answers", {"Z": "4"})
        self("progress", folder)


@pytest.fixture(scope="module")
def coil(tmp_path_factory):
    return Class(tmp_path_factory.mktemp("coil"))


def grade_there(coil, folder):
    return coil.grade(coil.folder / "b", folder)


def build_there(coil, folder):
    return coil("build", "coil", "--roster", coil.folder / "r.csv", "--formats", "ipynb", "--out", folder)


def standing(coil, folder):
    more = "--issued", coil.folder / "b" / "issued.json", "--no-feedback", "--out", folder / "o"
    return coil("grade", "--from", folder / "marks.csv", *more)


#: Of each reader: the file, and what reads it in a copy of its folder.
READERS = {
    "issued": ("b/issued.json", lambda coil, folder: coil.grade(folder, folder / "o")),
    "issued, before a build": ("b/issued.json", build_there),
    "issued, of an assignment": ("as/issued.json", lambda coil, folder: coil.grade(folder, folder / "o")),
    "issued, before an assignment": (
        "as/issued.json",
        lambda coil, folder: coil(
            "build",
            coil.folder / "a.toml",
            "--roster",
            coil.folder / "r.csv",
            "--formats",
            "ipynb",
            "--out",
            folder,
        ),
    ),
    "issued, before an export": (
        "b/issued.json",
        lambda coil, folder: coil("export", "moodle", "coil", "--variants", 2, "--out", folder),
    ),
    "issued, into a database": (
        "b/issued.json",
        lambda coil, folder: coil.grade(folder, folder / "o", "--db", folder / "x.db"),
    ),
    "built": ("b/.built.json", build_there),
    "marks": ("b/marks/marks.csv", grade_there),
    "marks, of a report": ("b/marks/marks.csv", lambda coil, folder: coil("report", folder, "--json")),
    "marks, as they stand": ("b/marks/marks.csv", standing),
    "summary": ("b/marks/summary.csv", grade_there),
    "summary, of a report": ("b/marks/summary.csv", lambda coil, folder: coil("report", folder, "--json")),
    "summary, for a platform": (
        "b/marks/summary.csv",
        lambda coil, folder: coil("gradebook", "moodle", folder, "--item", "x", "--out", folder / "x.xml"),
    ),
    "rejected": ("b/marks/rejected.csv", lambda coil, folder: coil("report", folder, "--json")),
    "accepted": ("b/marks/accepted.csv", grade_there),
    "decisions": ("b/marks/decisions.csv", grade_there),
    "answers": (
        "all.csv",
        lambda coil, folder: coil(
            "grade",
            folder / "all.csv",
            "--issued",
            coil.folder / "b/issued.json",
            "--no-feedback",
            "--out",
            folder / "o",
        ),
    ),
    "sheets": (
        "sheets.json",
        lambda coil, folder: coil(
            "grade",
            folder / "sheets.json",
            "--issued",
            coil.folder / "b/issued.json",
            "--no-feedback",
            "--out",
            folder / "o",
        ),
    ),
    "roster": (
        "r.csv",
        lambda coil, folder: coil(
            "build", "coil", "--roster", folder / "r.csv", "--formats", "ipynb", "--out", folder / "o"
        ),
    ),
    "assignment": (
        "a.toml",
        lambda coil, folder: coil("build", folder / "a.toml", "--formats", "ipynb", "--out", folder / "o"),
    ),
    "progress": ("p/progress.json", Class.studied),
    **{
        f"dump, {name}": (f"dump/{name}", Class.restored)
        for name in ("dump.json", "assignment.csv", "variant.csv", "answer.csv", "mark.csv", "person.csv")
    },
}


def read_damaged(coil, place, name, damage):
    """Read a file whose bytes were damaged, in a copy of its folder."""
    file, reads = READERS[name]
    source, folder = coil.folder / file, place / "copy"
    shutil.rmtree(folder, ignore_errors=True)
    if source.parent == coil.folder:
        folder.mkdir()
    else:
        shutil.copytree(
            source.parent, folder, ignore=shutil.ignore_patterns("handouts", "instructor", "marks", "m.db")
        )
    (folder / source.name).write_bytes(damage(source.read_bytes()))
    try:
        return reads(coil, folder)
    except CourseworkError:  # what reads is no command
        return 2


def changed(path, change):
    """A JSON of which one place is changed: the value of the last key."""

    def damage(data):
        content = json.loads(data)
        inside = content
        for key in path[:-1]:
            inside = inside[key]
        if change is GONE:
            del inside[path[-1]]
        else:
            inside[path[-1]] = "@@"
        return json.dumps(content).replace('"@@"', str(change)).encode()

    return damage


GONE = object()
RECORD = ("issued", 0, "record")
PART = (*RECORD, "parts", 0)
ISSUED = {
    "a part without id": (
        changed((*PART, "id"), GONE),
        "item 1 of 3 is not an issued record: id of a part is a text; found nothing",
    ),
    "a part twice": (changed((*PART, "id"), '"I"'), "it has the part 'I' twice"),
    "points that are none": (changed((*PART, "points"), '"2"'), "points of 'Z' are a number above 0"),
    "a seed of 5000 digits": (
        changed((*RECORD, "seed"), "9" * 5000),
        "is not JSON: a number of 5000 digits, 999",
    ),
    "an infinite seed": (changed((*RECORD, "seed"), "1e999"), "is not JSON: a number too great, 1e999"),
    "a seed that is not a number": (
        changed((*RECORD, "seed"), "NaN"),
        "is not JSON: a number that is none, NaN",
    ),
    "a seed that is true": (
        changed((*RECORD, "seed"), "true"),
        "seed is a whole number, 0 or more; found True",
    ),
    "a seed below 0": (changed((*RECORD, "seed"), "-1"), "seed is a whole number, 0 or more; found -1"),
    "a record that is a list": (changed(RECORD, "[]"), "it has no record"),
    "no exercise": (changed((*RECORD, "exercise"), GONE), "exercise is a text; found nothing"),
    "a NUL in a name": (
        changed(("issued", 0, "student"), r'"A\u0000"'),
        r"issued[0].student holds a NUL: 'A\x00'",
    ),
    "half a character in a name": (
        changed(("issued", 0, "student"), r'"A\ud800"'),
        "issued[0].student holds half a character",
    ),
    "100 000 lists": (lambda data: DEEP.encode(), "nested too deep"),
    "a sitting that is a text": (changed(("issued", 0, "sitting"), '"2"'), "sitting is a whole number"),
    "nobody's columns": (changed(("students",), '["Ana"]'), "the students in it have no columns"),
}


OTHERS = [name for name in READERS if name.startswith("issued, ")]


@pytest.mark.parametrize(
    ("reader", "case"),
    [
        *(("issued", case) for case in ISSUED),
        *((name, "a part without id") for name in OTHERS),
        *((name, "100 000 lists") for name in OTHERS),
    ],
)
def test_what_was_issued_is_told_by_its_item(coil, tmp_path, capsys, reader, case):
    damage, told = ISSUED[case]
    assert read_damaged(coil, tmp_path, reader, damage) == 2
    said = capsys.readouterr().err
    assert f"{tmp_path / 'copy' / 'issued.json'}" in said
    assert told in said
    assert said.count("\n") == 1


ROWS = {
    ("built", lambda data: DEEP.encode()): "nested too deep",
    ("built", lambda data: b'{"files": {"../x": []}}'): "is not a list of written files",
    ("built", lambda data: b'{"files": {"x": "y"}}'): "is not a list of written files",
    ("built", lambda data: data.replace(b".ipynb", b"\\ud800", 1)): "holds half a character",
    ("marks", lambda data: data.replace(b"Ben", b"B\0n", 1)): "marks.csv, line 9: a NUL byte",
    ("marks, of a report", lambda data: data.replace(b"Ben", b"B\0n", 1)): "marks.csv, line 9: a NUL byte",
    ("marks, as they stand", lambda data: data.replace(b"Ben", b"B\0n", 1)): "marks.csv, line 9: a NUL byte",
    ("accepted", lambda data: data.replace(b"good", b"g\0od")): "accepted.csv, line 2: a NUL byte",
    (
        "summary, for a platform",
        lambda data: data.replace(b",20,", b",inf,"),
    ): "out_of of Ana must be a number; found 'inf'",
    ("dump, person.csv", lambda data: data.replace(b"Ben", b"B\xe9n", 1)): "person.csv is not UTF-8",
    ("dump, person.csv", lambda data: data + data.splitlines(True)[-1]): "person.csv is damaged",
    ("dump, person.csv", lambda data: data + b"1\r\n"): "person.csv, line 5: 1 cell where the header has",
    (
        "dump, person.csv",
        lambda data: data.replace(b"\n1,", b"\n" + b"9" * 5000 + b","),
    ): "line 2: id has a value that no dump has",
    (
        "dump, person.csv",
        lambda data: data.replace(b"\n1,", b"\n" + b"9" * 30 + b","),
    ): "line 2: id has a value that no dump has",
    ("dump, mark.csv", lambda data: data.replace(b"id,", b"id,id,", 1)): "has the columns",
    ("dump, variant.csv", lambda data: data.replace(b'"{', DEEP.encode() + b'"{', 1)): "variant.csv, line 2",
    (
        "dump, variant.csv",
        lambda data: data.replace(b'""given""', b'""taken""'),
    ): "the part of the dump about",
    ("dump, dump.json", lambda data: DEEP.encode()): "nested too deep",
    ("dump, dump.json", lambda data: data.replace(b'"rows"', b'"row"')): "does not state the number of rows",
    ("dump, dump.json", lambda data: data.replace(b": 3", b": null")): "does not state the number of rows",
}


@pytest.mark.parametrize(("reader", "damage"), ROWS, ids=lambda one: one if isinstance(one, str) else None)
def test_a_damaged_file_is_told_by_its_place(coil, tmp_path, capsys, reader, damage):
    file, reads = READERS[reader]
    told = ROWS[reader, damage]
    assert damage((coil.folder / file).read_bytes()) != (coil.folder / file).read_bytes()
    if reads is Class.restored:
        with pytest.raises(CourseworkError) as fault:
            damaged_dump(coil, tmp_path, file, damage)
        said = str(fault.value)
    else:
        assert read_damaged(coil, tmp_path, reader, damage) == (0 if reader == "built" else 2)
        said = capsys.readouterr().err
    assert told in said


def damaged_dump(coil, place, file, damage):
    folder = shutil.copytree(coil.folder / "dump", place / "copy")
    path = folder / Path(file).name
    path.write_bytes(damage(path.read_bytes()))
    coil.restored(folder)


def test_progress_with_half_a_character_is_kept_apart_and_new_progress_is_written(coil, tmp_path):
    folder = shutil.copytree(coil.folder / "p", tmp_path / "p")
    path = folder / "progress.json"
    path.write_text(path.read_text("utf-8").replace('"3"', r'"\ud800"'), "utf-8")
    coil.studied(folder)
    ExerciseStore(ProgressFile(folder), "coil").add(3, "answers", {"Z": "4\ud800"})
    assert {e["answer"] for e in ProgressFile(folder).progress} == {"4", "4?"}
    assert len([*folder.glob("progress.damaged*")]) == 1


@pytest.mark.parametrize("step", ["null", '"one"', "[]", "1e999", "true", "-1"])
def test_progress_whose_hint_is_none_is_kept_apart(coil, tmp_path, step):
    folder = shutil.copytree(coil.folder / "p", tmp_path / "p")
    path = folder / "progress.json"
    path.write_text(path.read_text("utf-8").replace('"step": 1', f'"step": {step}'), "utf-8")
    coil.studied(folder)
    assert len([*folder.glob("progress.damaged*")]) == 1


def test_a_gradebook_that_is_cut_in_a_character_is_told(coil, tmp_path, capsys):
    data = (RECORDED / "blackboard_gradebook.txt").read_bytes()
    assert data[:2] == b"\xff\xfe"
    (tmp_path / "g.txt").write_bytes(data[:-1])
    words = (
        "gradebook",
        "blackboard",
        coil.folder / "b/marks",
        "--template",
        tmp_path / "g.txt",
        "--item",
        "x",
    )
    assert coil(*words, "--out", tmp_path / "o.txt") == 2
    assert f"{tmp_path / 'g.txt'} is damaged: it begins in utf-16-le" in capsys.readouterr().err


def test_a_parquet_of_odd_columns_is_one_rejection(tmp_path):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    usual = {name: arrow.array(["a"]) for name in ("student", "exercise", "seed", "part", "answer")}
    odd = (
        arrow.array([1], arrow.timestamp("ns")),
        arrow.array([2**62], arrow.timestamp("us")),
        arrow.array([b"\xff"]),
        arrow.array([{"a": 1}]),
        arrow.array([1], arrow.time64("ns")),
    )
    for number, column in enumerate(odd):
        for name in usual:
            parquet.write_table(arrow.table({**usual, name: column}), tmp_path / f"{number}.parquet")
            (rejected,) = read_file(tmp_path / f"{number}.parquet")
            assert f"the column {name} contains {column.type}" in rejected.reason
    parquet.write_table(
        arrow.table({**usual, "answer": arrow.array([[1.5, None]])}), tmp_path / "list.parquet"
    )
    assert [row.answer for row in read_file(tmp_path / "list.parquet")] == ["1.5; None"]
    twice = arrow.Table.from_arrays([*usual.values(), usual["answer"]], names=[*usual, "answer"])
    parquet.write_table(twice, tmp_path / "twice.parquet")
    assert [one.reason for one in read_file(tmp_path / "twice.parquet")] == [
        "the file has the column answer twice"
    ]


@pytest.mark.parametrize(
    "text",
    [
        '{"student": "A\\u0000b", "exercise": "coil", "seed": 1, "answers": {"Z\\u0000": "1\\u0000"}}',
        '[{"Surname": "A\\u0000", "First name": "\\ud800", "Question 1": "x", "Response 1": "\\u0000"}]',
    ],
)
def test_no_row_holds_what_no_file_can(tmp_path, text):
    (tmp_path / "a.json").write_text(text, "utf-8")
    for row in read_file(tmp_path / "a.json"):
        told = json.dumps(row if isinstance(row, tuple) else [row.source, row.row], ensure_ascii=False)
        assert "\\u0000" not in told
        told.encode("utf-8")


@pytest.mark.parametrize(
    "written", [f"title = {DEEP}", f"title = {'9' * 5000}", f"[[exercises]]\nname = {DEEP}"]
)
def test_a_toml_that_is_too_deep_or_too_long_is_told(coil, tmp_path, capsys, written):
    for name, words in (("a.toml", ("build",)), ("s.toml", ("simulate",))):
        (tmp_path / name).write_text(written, "utf-8")
        assert coil(*words, tmp_path / name, "--out", tmp_path / "o") == 2
        assert f"{tmp_path / name}: " in capsys.readouterr().err


# --------------------------------------------------------------------------- fuzz

TIMES = 40  #: of each reader; thousands were tried when this was written


def damaged(random_, file, data):
    if file.suffix == ".json":
        return damaged_json(random_, data.decode("utf-8"))
    if file.suffix == ".csv":
        return damaged_table(random_, data, max(",;\t", key=data.decode("utf-8", "replace").count))
    return damaged_bytes(random_, data)


@pytest.mark.slow
@pytest.mark.parametrize("reader", READERS)
def test_no_damage_ends_a_reader_by_a_traceback(coil, tmp_path, reader):
    file = Path(READERS[reader][0])
    for seed in range(TIMES):
        generator = random.Random(f"{reader} {seed}")
        status = read_damaged(coil, tmp_path, reader, lambda data, by=generator: damaged(by, file, data))
        assert status in (None, 0, 1, 2)
