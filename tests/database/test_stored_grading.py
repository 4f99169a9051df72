"""Grading with a database, round by round, writes the very files that grading all at once writes."""

from __future__ import annotations

import csv
import json
import shutil

import pytest
from class_of_three import table, tree, write_rows
from course_of_every_kind import write_course
from tables import each_row

from coursework.cli import run

FORMATS = ("--formats", "html")


class Class:
    """A class with an open question, graded with a database and, beside it, without."""

    def __init__(self, folder, url):
        self.folder, self.url, self.root, self.files = folder, url, folder / "course", []
        write_course(self.root)
        (folder / "class.csv").write_text("student,number\nAna,7\nBen,8\nCléo,9\nDan,10\n", "utf-8")
        self.built = folder / "week3"
        self.status(
            "build",
            "coil",
            "--roster",
            folder / "class.csv",
            "--formats",
            "html",
            "--out",
            self.built,
            "--db",
            url,
        )
        key = json.loads((self.built / "instructor/key.json").read_text("utf-8"))
        self.form = [
            {**row, "answer": str(one["answers"][row["part"]]["value"] or "")}
            for one in key
            for row in table(self.built / "answers.csv")
            if row["student"] == one["student"]
        ]

    def status(self, *told):
        return run(["--course", str(self.root), *map(str, told)])

    def rows(self, student, **changed):
        own = [row for row in self.form if row["student"] == student]
        return [{**row, "answer": changed.get(row["part"], row["answer"])} for row in own]

    def file(self, name, rows):
        return write_rows(self.folder / name, rows)

    def grade(self, *new, more=FORMATS):
        """Grade new files with the database, and all files so far without; both folders."""
        self.files += new
        stored, plain = self.folder / "stored", self.folder / "plain"
        status = self.status("grade", *new, "--db", self.url, "--out", stored, *more)
        assert status == self.status(
            "grade", *self.files, "--issued", self.built / "issued.json", "--out", plain, *more
        )
        return stored, plain

    def both(self, name, change):
        """Change a table of both folders alike."""
        for folder in (self.folder / "stored", self.folder / "plain"):
            rows = table(folder / name) if (folder / name).exists() else []
            rows = change(rows)
            with (folder / name).open("w", encoding="utf-8", newline="") as file:
                writer = csv.DictWriter(file, rows[0].keys())
                writer.writeheader()
                writer.writerows(rows)

    def correct(self):
        """The course with a solution corrected; one that is imported once is not imported again."""
        old = self.root
        self.root = self.folder / f"{old.name}_corrected"
        shutil.copytree(old, self.root)
        path = self.root / "solutions/coil.py"
        text = path.read_text("utf-8")
        assert "return U / Z" in text
        path.write_text(text.replace("return U / Z", "return 2 * U / Z"), "utf-8")


@pytest.fixture
def one(tmp_path, url):
    return Class(tmp_path, url)


def told_apart(folders):
    """What differs between two folders of marks."""
    stored, plain = map(tree, folders)
    return sorted(name for name in {*stored, *plain} if stored.get(name) != plain.get(name))


def accepted(*lines):
    return lambda rows: [
        dict(zip(("student", "exercise", "seed", "part", "points", "reason"), line, strict=True))
        for line in lines
    ]


@pytest.mark.e2e
def test_round_by_round_the_files_are_those_of_all_at_once(one):
    first = one.file(
        "first.csv", [*one.rows("Ana", why="It stores.", Z="somewhere"), *one.rows("Ben", M="", why="Heat.")]
    )
    assert told_apart(one.grade(first)) == []
    assert {row["verdict"] for row in table(one.folder / "stored/marks.csv")} >= {"unreadable", "to_mark"}

    def give(rows):
        return [
            {**row, "points": {"Ana": "1,5", "Ben": "3"}[row["student"]], "reason": "seen"}
            if row["part"] == "why"
            else row
            for row in rows
        ]

    one.both("decisions.csv", give)
    one.both(
        "accepted.csv",
        accepted(("Ana", "coil", "", "Z", "", "read on paper"), ("Cléo", "coil", "", "Z", "1", "")),
    )
    strangers = [{**one.rows("Ana")[0], "student": "Nobody"}, {**one.rows("Ben")[0], "part": "XX"}]
    second = one.file("second.csv", [*one.rows("Cléo", I="0"), *strangers])
    sheet = {"student": "Dan", "exercise": "coil", "answers": {"Z": "12", "I": [1, 2], "drops": 3.0}}
    third = one.folder / "third.json"
    third.write_text(json.dumps([sheet, {"student": 4}]), "utf-8")
    assert told_apart(one.grade(second, third)) == []
    marks = {(row["student"], row["part"]): row["verdict"] for row in table(one.folder / "stored/marks.csv")}
    assert [marks[p] for p in (("Ana", "Z"), ("Ana", "why"), ("Ben", "why"))] == [
        "accepted",
        "partial",
        "accepted",
    ]
    assert {row["student"] for row in table(one.folder / "stored/rejected.csv")} >= {"Nobody", "Ben"}

    one.correct()
    assert told_apart(one.grade()) == []
    assert {row["part"] for row in table(one.folder / "stored/changes.csv")} >= {"I"}

    one.both(
        "accepted.csv",
        accepted(("Ana", "coil", "", "Z", "0.5", "half of it"), ("Ben", "coil", "", "why", "2", "")),
    )
    one.both(
        "decisions.csv",
        lambda rows: [{**row, "points": "" if row["student"] == "Ana" else row["points"]} for row in rows],
    )
    late = one.file("late.csv", one.rows("Ben", why="Something else.")[-2:])
    assert told_apart(one.grade(late)) == []
    marks = {(row["student"], row["part"]): row for row in table(one.folder / "stored/marks.csv")}
    assert marks["Ana", "Z"]["points"] == "0.5"
    assert marks["Ana", "why"]["verdict"] == "to_mark"
    assert marks["Ben", "why"]["feedback"].endswith("2") or marks["Ben", "why"]["points"] == "2"

    assert told_apart(one.grade(more=("--no-feedback", "--decimal", "comma"))) == []


def test_nothing_new_writes_the_same_files_and_marks_nothing(one, capsys):
    first = one.file("first.csv", one.rows("Ana"))
    stored, _ = one.grade(first)
    before = tree(stored)
    capsys.readouterr()
    one.status("grade", first, "--db", one.url, "--out", stored, *FORMATS)
    assert "0 new files, 1 that came before" in (said := capsys.readouterr().out)
    assert "1 sheet: 0 marked now" in said
    assert {**tree(stored), "changes.csv": b""} == {**before, "changes.csv": b""}


def test_a_decision_of_a_file_is_taken_in_once_and_a_later_one_from_elsewhere_stands(one):
    from coursework.database.assignments import assignment_called
    from coursework.database.decisions import decide, history
    from coursework.database.store import Store
    from coursework.gradebook.decisions import Decision

    first = one.file("first.csv", one.rows("Ana", why="It stores."))
    one.grade(first)
    one.both(
        "decisions.csv",
        lambda rows: [{**row, "points": "2"} if row["part"] == "why" else row for row in rows],
    )
    stored, _ = one.grade()
    store = Store(one.url)
    with store.begin() as connection:
        number = assignment_called(connection, "week3")
        told = "given", 1, "second reading", "It stores.", "Prof. Roe"
        decide(connection, number, [Decision("Ana", "coil", "", "why", *told)])
    for _ in range(2):
        one.status("grade", "--db", one.url, "--out", stored, *FORMATS)
    marks = {row["part"]: row for row in table(stored / "marks.csv")}
    assert marks["why"]["points"] == "1"
    assert next(row for row in table(stored / "decisions.csv") if row["part"] == "why")["points"] == "1"
    with store.reading() as connection:
        found = [happened.by for happened in history(connection, number, "Ana", "coil", "why") if happened.by]
    assert found == ["decisions.csv", "Prof. Roe"]
    store.close()


def test_without_a_folder_only_what_changed_is_told(one, capsys):
    first = one.file("first.csv", [*one.rows("Ana"), *one.rows("Ben", Z="somewhere")])
    assert one.status("grade", first, "--db", one.url) == 1
    said = capsys.readouterr()
    assert "2 sheets: 2 marked now, 2 of them for the first time" in said.out
    assert "answers for a person to look at" in said.out
    one.correct()
    one.status("grade", "--db", one.url)
    assert "Ana, coil, I: correct 2 before, wrong 0 now" in capsys.readouterr().out
    assert not (one.built / "marks").exists()


def test_a_mended_file_replaces_what_came_from_it(one, capsys):
    first = one.file("first.csv", one.rows("Ana", Z="somewhere"))
    one.status("grade", first, "--db", one.url)
    one.file("first.csv", one.rows("Ana"))
    capsys.readouterr()
    one.status("grade", first, "--db", one.url)
    assert "repeats" in capsys.readouterr().err
    one.status("grade", first, "--db", one.url, "--replace", "--out", one.folder / "stored", "--no-feedback")
    plain = one.folder / "plain"
    one.status("grade", first, "--issued", one.built / "issued.json", "--out", plain, "--no-feedback")
    assert told_apart((one.folder / "stored", plain)) == []


def test_an_export_that_grew_brings_what_is_new(one, capsys):
    one.status("grade", one.file("monday.csv", one.rows("Ana")), "--db", one.url)
    friday = one.file("friday.csv", [*one.rows("Ana"), *one.rows("Ben")])
    capsys.readouterr()
    one.status("grade", friday, "--db", one.url, "--out", one.folder / "stored", "--no-feedback")
    assert "2 sheets: 1 marked now" in capsys.readouterr().out
    assert table(one.folder / "stored/rejected.csv") == []
    assert len(table(one.folder / "stored/marks.csv")) == 2 * len(one.rows("Ana"))


def test_a_report_of_a_database_is_that_of_the_folder(one):
    stored, _ = one.grade(one.file("first.csv", [*one.rows("Ana"), *one.rows("Ben", Z="somewhere")]))
    shutil.copy(one.built / "issued.json", one.folder)  # beside the marks, for the numbers of questions
    for told in (["--db", one.url, "--assignment", "week3"], [stored]):
        assert one.status("report", *told, "--out", one.folder / f"report{len(told)}", "--lang", "en") == 0
    assert tree(one.folder / "report4") == tree(one.folder / "report1")


@each_row(
    ("told", "says"),
    [
        (["grade", "first.csv"], "--issued"),
        (["grade", "first.csv", "--db", "{url}", "--assignment", "week4"], "did you mean 'week3'"),
        (["grade", "none.csv", "--db", "{url}"], "no such file"),
        (["grade", "first.csv", "--issued", "i.json", "--assignment", "x"], "--assignment needs a database"),
        (["grade", "--from", "first.csv", "--db", "{url}"], "--from takes the marks"),
        (["report", "--db", "{url}", "--out", "r"], "nothing of it is marked yet"),
        (["report"], "name one of them"),
        (["report", "--db", "{url}"], "no folder to write"),
        (["grade", "first.csv", "--db", "no/such.db"], "no database no/such.db"),
        (["database", "history", "{url}", "Anna"], "did you mean 'Ana'"),
    ],
)
def test_what_is_wrong_is_told_in_a_line(one, told, says, capsys, monkeypatch):
    one.file("first.csv", one.rows("Ana"))
    monkeypatch.chdir(one.folder)
    capsys.readouterr()
    assert one.status(*(a.replace("{url}", one.url) for a in told)) == 2
    said = capsys.readouterr().err
    assert says in said
    assert said.count("\n") == 1


def test_a_file_that_cannot_be_marked_at_all_is_not_kept(one, capsys):
    bad = one.folder / "bad.csv"
    bad.write_text("a,b\n1,2\n", "utf-8")
    assert one.status("grade", bad, "--db", one.url) == 2
    capsys.readouterr()
    one.status("database", "show", one.url, "--json")
    assert json.loads(capsys.readouterr().out)[0]["submissions"] == 0


def test_a_longer_roster_adds_and_another_build_is_refused(one, capsys):
    (one.folder / "class.csv").write_text("student,number\nZoé,1\nAna,7\nBen,8\nCléo,9\nDan,10\n", "utf-8")
    job = [
        *"build coil --roster".split(),
        one.folder / "class.csv",
        *"--formats html --out".split(),
        one.built,
        "--db",
        one.url,
    ]
    assert one.status(*job) == 0
    capsys.readouterr()
    one.status("database", "show", one.url, "--json")
    assert json.loads(capsys.readouterr().out)[0]["students"] == 5
    assert one.status(*job, "--seed", "5", "--overwrite") == 2
    assert "choose another name" in capsys.readouterr().err
    elsewhere = [one.folder / "again" if word == one.built else word for word in job]
    assert one.status(*elsewhere, "--seed", "5") == 0
