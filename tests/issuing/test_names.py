"""Names of students as people type them: accents and case may be wrong, and nobody is taken for a
namesake."""

from tables import each_row

from coursework.errors import closest
from coursework.issuing.identity import printed_columns
from coursework.issuing.students import file_stems, namesakes, student_named

CLASS = ("Faure Loïc", "Faure Noémie", "Łukasz Nowak", "Cœur Anaïs", "Ruiz Ana", "Ruíz Ana")


@each_row(
    ("typed", "meant"),
    [
        ("Faure Loic", "Faure Loïc"),
        ("FAURE LOÏC", "Faure Loïc"),
        ("faure noemie", "Faure Noémie"),
        ("Lukasz Nowak", "Łukasz Nowak"),
        ("coeur anais", "Cœur Anaïs"),
        ("ruíz ana", "Ruíz Ana"),
        ("ruiz ana", "Ruiz Ana"),
        ("RUÌZ ANA", None),
        ("Faure", None),
        ("Faure Lucie", None),
    ],
)
def test_a_name_is_found_whatever_its_case_and_accents_unless_two_have_it(typed, meant):
    assert student_named(typed, CLASS) == meant


@each_row(
    ("typed", "known", "offered"),
    [
        ("Faure Loic", CLASS, "Faure Loïc"),
        ("Faure Loic", ["Faure Noémie", "Favre Luc"], None),
        ("Loic Faure", CLASS, "Faure Loïc"),
        ("Marie Martin", ["MARTIN Loïc", "MARTIN Zoé"], None),
        ("Zoe De La Tour", ["De La Tour Noé", "De La Tour Zoé", "De La Tour Aïcha"], "De La Tour Zoé"),
        ("Li Wie", ["Li Wei", "Li Na"], "Li Wei"),
        ("four_bar_postion", ["four_bar_position", "four_bar_motion"], "four_bar_position"),
        ("THETA4", ["theta4", "theta3"], "theta4"),
        ("zzz", ["theta4", "theta3"], None),
    ],
)
def test_a_suggestion_is_made_only_where_it_is_near(typed, known, offered):
    assert closest(typed, known) == offered


def test_file_names_spell_letters_that_are_not_ascii():
    assert file_stems(["Cœur Łukasz", "Ægir Straße", "Øyvind Đorđe"]) == [
        "coeur-lukasz",
        "aegir-strasse",
        "oyvind-dorde",
    ]


@each_row(
    ("title", "fr", "en"),
    [
        ("number", "Numéro d'étudiant", "Student number"),
        ("numéro_étudiant", "Numéro d'étudiant", "Student number"),
        ("e-mail", "Adresse électronique", "E-mail"),
        ("groupe", "Groupe", "Group"),
        ("td", "TD", "TD"),
        ("N° Apogée", "N° Apogée", "N° Apogée"),
        ("work_bench", "Work bench", "Work bench"),
    ],
)
def test_a_sheet_prints_no_raw_title_of_a_column(title, fr, en):
    for lang, printed in ("fr", fr), ("en", en):
        assert printed_columns([title], {title.lower(): "7"}, lang) == ((printed, "7"),)


def test_namesakes_are_found_in_whatever_order_and_without_accents():
    students = ["MARTIN Zoé (22199001)", "MARTIN Zoé (22199002)", "MARTIN Loïc"]
    assert namesakes("Zoe Martin", students) == namesakes("martin zoé", students) == students[:2]
    assert namesakes("Martin", students) == []
