"""Rosters as they come: nothing in them is dropped without a word."""

import pytest
from collected_pools import RECORDED
from tables import each_row

from coursework.cli import run
from coursework.cli.options import DONE
from coursework.errors import BadInput
from coursework.issuing.roster import Student, read_roster


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

    assert "which counts" not in build("--out", tmp_path / "one")
    assert "of 1 of its 2 students, which counts; --lang fr,en is for" in build(
        "--lang", "fr,en", "--out", tmp_path / "two"
    )
    made = {p.name for p in (tmp_path / "two" / "handouts").rglob("*.html")}
    assert made == {"ann.en.html", "bo.fr.html", "bo.en.html"}


# ------------------------------------------------------------------------ as platforms export them


def recorded(name):
    notes = []
    return read_roster(RECORDED / name, notes.append), notes


def test_moodles_list_of_participants_is_a_roster():
    students, notes = recorded("moodle_participants.csv")
    assert [s.name for s in students] == ["Ann Doe", "Émile D’Été", "Bob Ray"]
    assert [s.draw_key for s in students] == ["ann@example.org", "emile@example.org", "bob@example.org"]
    assert notes == []


@each_row(
    ("name", "mail"),
    [("moodle_gradebook.csv", "Email address"), ("moodle_gradebook_fr.csv", "Adresse de courriel")],
)
def test_moodles_gradebook_is_a_roster_without_its_marks(name, mail):
    students, (note,) = recorded(name)
    assert [s.name for s in students] == [
        "Ann Doe (wb-1)",
        "Ann Doe (wb-2)",
        "Émile D’Été",
        "Bob Ray",
        "Cy Wu",
    ]
    assert students[1].columns == {
        "ID number": "wb-2",
        "Institution": "",
        "Department": "",
        mail: "wb.ann2@example.org",
    }
    assert "4 columns of marks not used: Week 3, marked (Real), Quiz: Week 3 (Real), …" in note


def test_canvass_gradebook_is_a_roster_without_maxima_and_without_its_invented_student():
    students, notes = recorded("canvas_gradebook.csv")
    assert [s.name for s in students] == ["Ann Doe (4711)", "Ann Doe (4712)", "Émile D’Été", "Bob Ray"]
    assert students[2].columns == {
        "ID": "4713",
        "SIS User ID": "s-3",
        "SIS Login ID": "emile@example.org",
        "Section": "Mechanisms A",
    }
    assert "2 lines without a student left out: Points Possible, Student, Test" in notes[0]
    assert "3 columns of marks not used" in notes[1]


def test_blackboards_and_sakais_gradebooks_are_rosters():
    assert [s.name for s in recorded("blackboard_gradebook.txt")[0]] == [
        "Doe Ann (s-1)",
        "Doe Ann (s-2)",
        "D’Été Émile",
    ]
    students, _ = recorded("sakai_gradebook.csv")
    assert [(s.name, s.columns) for s in students] == [
        ("Ann Doe", {"Student ID": "adoe"}),
        ("Émile D’Été", {"Student ID": "edete"}),
    ]


def test_an_average_of_moodles_is_no_student_and_a_surname_alone_is_one(tmp_path):
    header = "Nom de famille,Prénom,Adresse de courriel\n"
    students, notes = read(tmp_path, header + "Doe,Ann,a@b.c\nMoyenne globale,,\nPelé,,\n")
    assert [s.name for s in students] == ["Doe Ann", "Pelé"]
    assert "1 line without a student left out: Moyenne globale" in notes[0]


def test_two_of_one_name_are_told_apart_by_what_identifies_them_or_refused(tmp_path):
    students, _ = read(tmp_path, "student,number\nAnn Doe,7\nann  doe,8\nBo,9\n")
    assert [(s.name, s.draw_key) for s in students] == [
        ("Ann Doe (7)", "7"),
        ("ann doe (8)", "8"),
        ("Bo", "9"),
    ]
    with pytest.raises(BadInput, match="is already on line 2; distinguish them, for instance by a number"):
        read(tmp_path, "student,group\nAnn Doe,A\nAnn Doe,B\n")
    with pytest.raises(BadInput, match=r"line 3: Ann Doe \(7\) is already on line 2"):
        read(tmp_path, "student,number\nAnn Doe,7\nAnn Doe,7\n")


def test_a_list_of_ones_own_keeps_every_column(tmp_path):
    students, notes = read(tmp_path, "student,id,section,email\nAnn,1,A,a@b.c\n")
    assert students[0].columns == {"id": "1", "section": "A", "email": "a@b.c"}
    assert notes == []


# --------------------------------------------------------------- as registrars' offices export them

OFFICES = {
    "N° étudiant;Nom de naissance;Nom d'usage;Prénom;Adresse mail institutionnelle\n"
    "22301;Lefèvre;;Loïc;l.lefevre@etu.example.fr\n22302;Roux;Martin;Zoé;z.martin@etu.example.fr\n",
    "Liste des étudiants;;;;\nMécanique 2A, groupe B;;;;\n\n"
    "Code étudiant;Nom de naissance;Nom d'usage;Prénom;Courriel\n"
    "22301;Lefèvre;;Loïc;l.lefevre@etu.example.fr\n22302;Roux;Martin;Zoé;z.martin@etu.example.fr\n",
    "NUM_ETUDIANT,NOM_USUEL,PRENOM,E-MAIL INSTITUTIONNEL\n"
    "22301,Lefèvre,Loïc,l.lefevre@etu.example.fr\n22302,Martin,Zoé,z.martin@etu.example.fr\n",
}


@pytest.mark.parametrize("content", sorted(OFFICES))
def test_lists_of_french_registrars_are_read_as_they_come(tmp_path, content):
    students, notes = read(tmp_path, content)
    assert [s.name for s in students] == ["Lefèvre Loïc", "Martin Zoé"]
    assert [s.draw_key for s in students] == ["22301", "22302"]
    assert [note for note in notes if "above the heading" not in note] == []


def test_namesakes_are_told_apart_by_a_french_number(tmp_path):
    students, _ = read(tmp_path, "Nom,Prénom,N° étudiant\nDurand,Paul,7\nDurand,Paul,8\n")
    assert [s.name for s in students] == ["Durand Paul (7)", "Durand Paul (8)"]


def test_columns_that_no_title_explains_can_be_named_by_place_or_title(tmp_path):
    path = tmp_path / "class.csv"
    path.write_text("Machin;Truc;Chose\n12;Roux;Zoé\n13;Roy;Abel\n", "utf-8")
    with pytest.raises(BadInput, match=r"found 1 Machin, 2 Truc, 3 Chose\..*--columns name=1,first=2"):
        read_roster(path)
    for columns in (
        {"name": "2", "first": "3", "number": "1"},
        {"name": "truc", "first": "Chose", "number": "1"},
    ):
        students = read_roster(path, columns=columns)
        assert [(s.name, s.draw_key) for s in students] == [("Roux Zoé", "12"), ("Roy Abel", "13")]
    with pytest.raises(BadInput, match="has no column '4' for first; found 1 Machin, 2 Truc, 3 Chose"):
        read_roster(path, columns={"name": "1", "first": "4"})


def test_columns_named_by_hand_go_before_titles_that_say_otherwise(tmp_path):
    path = tmp_path / "class.csv"
    path.write_text("nom,prénom,code\nMécanique,Zoé Roux,12\nMécanique,Abel Roy,13\n", "utf-8")
    assert [s.name for s in read_roster(path, columns={"name": "2"})] == ["Zoé Roux", "Abel Roy"]
