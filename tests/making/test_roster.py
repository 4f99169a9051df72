"""Rosters as they come: nothing in them is dropped without a word."""

import pytest

from coursework.cli import run
from coursework.cli.options import DONE
from coursework.making.roster import Student, read_roster


def read(tmp_path, content):
    path = tmp_path / "class.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    notes = []
    return read_roster(path, notes.append), notes


@pytest.mark.parametrize(
    "content",
    [
        'student,lang\n"durand,fr\nmbaye,en\nroux,\n',
        '"student,lang\ndurand,fr\n"mbaye",en\nroux\n',
        "Élève;Langue\r\ndurand;FR\r\n\r\nmbaye;en\r\n;\r\nroux;;\r\n",
    ],
)
def test_a_stray_quotation_mark_or_a_blank_line_costs_no_student(tmp_path, content):
    students = [Student("durand", "fr"), Student("mbaye", "en"), Student("roux")]
    assert read(tmp_path, content) == (students, [])


@pytest.mark.parametrize(
    ("header", "names"),
    [
        ("Nom;Prénom;Langue", ["Durand Paul", "Durand Zoé"]),
        ("Prénom;Nom de famille;Langue", ["Durand Paul", "Durand Zoé"]),
        ("LAST_NAME;First Name;lang", ["Durand Paul", "Durand Zoé"]),
    ],
)
def test_surname_and_first_name_make_one_name_in_the_files_order(tmp_path, header, names):
    students, notes = read(tmp_path, f"{header}\nDurand;Paul;fr\nDurand;Zoé;en\n")
    assert [s.name for s in students] == names
    assert [s.lang for s in students] == ["fr", "en"]
    assert notes == []


def test_other_columns_are_carried_through_and_one_without_a_title_is_told_once(tmp_path):
    students, (note,) = read(tmp_path, "Groupe,student,Nom,\nA,Ann,Smith,x\nB,Bo,Roux,\n")
    assert [s.name for s in students] == ["Ann", "Bo"]
    assert [s.columns for s in students] == [{"Groupe": "A", "Nom": "Smith"}, {"Groupe": "B", "Nom": "Roux"}]
    assert "a column without a title, which is not used" in note


def test_a_roster_that_excel_saved_is_read_and_said(tmp_path):
    students, (note,) = read(tmp_path, "nom;prénom\nLefèvre;Émilie\n".encode("cp1252"))
    assert [s.name for s in students] == ["Lefèvre Émilie"]
    assert "class.csv: the file is not UTF-8; it was read as Windows-1252" in note


def test_a_language_that_the_roster_overrides_is_told(small_course, tmp_path, capsys):
    roster = tmp_path / "class.csv"
    roster.write_text("student,lang\nAnn,en\nBo,\n", "utf-8")

    def build(*options):
        command = ["--course", small_course, "build", "--roster", roster, "--formats", "html", *options]
        assert run([str(a) for a in command]) == DONE
        return capsys.readouterr().err

    assert build("--out", tmp_path / "one") == ""
    assert "of 1 of its 2 students, which counts; --lang fr,en is for" in build(
        "--lang", "fr,en", "--out", tmp_path / "two"
    )
    made = {p.name for p in (tmp_path / "two" / "handouts").rglob("*.html")}
    assert made == {"ann.en.html", "bo.fr.html", "bo.en.html"}
