"""A course may speak one language; what no command is told it takes from the environment, else from the
course."""

import json
import os
import re
import tomllib

import nbformat
import pytest
from tables import each_row

import coursework
from coursework.authoring.scaffold import new_course
from coursework.cli import run
from coursework.language.environment import language_of

FRENCH = re.compile(
    r"[éèêàùçœ]|\b(?:le|la|les|une|des|est|sont|avec|pour|réponse|corrigé|manivelle|vitesse|points? sur"
    r"|cours|fr)\b",
    re.I,
)


@each_row(
    ("environment", "lang"),
    [
        ({"LANG": "fr_FR.UTF-8"}, "fr"),
        ({"LANG": "en"}, "en"),
        ({"LANG": "en_GB@euro"}, "en"),
        ({"LANG": "C.UTF-8"}, ""),
        ({"LANG": "C"}, ""),
        ({"LANG": "POSIX"}, ""),
        ({}, ""),
        ({"LANG": ""}, ""),
        ({"LANG": "fr_FR", "LC_ALL": "en_US"}, "en"),
        ({"LANG": "fr", "LC_ALL": "C"}, ""),
        ({"LANG": "fr", "LC_MESSAGES": "en_US"}, "en"),
        ({"LC_MESSAGES": "fr", "LC_ALL": ""}, "fr"),
    ],
)
def test_the_language_of_the_environment(environment, lang):
    assert language_of(environment) == lang


@pytest.fixture
def english(tmp_path):
    new_course(tmp_path / "mine", ("en",))
    return tmp_path / "mine"


@pytest.fixture
def told(capsys, monkeypatch):
    def call(*arguments, lang="C"):
        monkeypatch.setenv("LANG", lang)
        status = run([str(a) for a in arguments])
        out = capsys.readouterr()
        return status, out.out, out.err

    return call


def test_a_course_of_one_language_has_not_one_word_of_another(english, told, tmp_path):
    for path in english.rglob("*"):
        if path.is_file():
            assert ".fr." not in path.name
            assert not FRENCH.search(path.read_text("utf-8")), path
    status, out, err = told("--course", english, "check", "--variants", "20")
    assert status == 0, out + err
    out = tmp_path / "out"
    for lang in ("C", "fr_FR.UTF-8", "en_US.UTF-8"):
        built = out / lang
        assert (
            told("--course", english, "build", "--formats", "html,ipynb", "--out", built, lang=lang)[0] == 0
        )
        assert not [path for path in built.rglob("*") if ".fr." in path.name]
        pages = list(built.rglob("*.html"))
        assert pages
        assert all('lang="en"' in page.read_text("utf-8") for page in pages)
        for book in built.rglob("*.ipynb"):
            for cell in nbformat.read(book, 4).cells:
                assert not FRENCH.search(cell.source), cell.source
        _, shown, _ = told("--course", english, "show", "crank_pin", lang=lang)
        assert "A crank pin" in shown
        assert not FRENCH.search(shown)
        _, record, _ = told("--course", english, "variant", "crank_pin", "--json", lang=lang)
        assert json.loads(record)["lang"] == "en"


def test_python_speaks_the_language_of_a_course_of_one(english, course):
    assert coursework.open_course(english)["crank_pin"].variant(0).lang == "en"
    assert course["grashof"].variant(0).lang == "fr"
    assert coursework.study("crank_pin", course=english, folder=english).variant.lang == "en"


def test_a_language_that_the_course_does_not_speak_is_refused(english, told):
    for command in (("show", "crank_pin"), ("build", "--out", english / "out"), ("notebook",)):
        status, _, err = told("--course", english, *command, "--lang", "fr")
        assert (status, len(err.splitlines())) == (2, 1)
        assert "is not available in 'fr', only in en" in err


@pytest.mark.parametrize(
    ("lang", "spoken"), [("en_US.UTF-8", "en"), ("fr_FR.UTF-8", "fr"), ("de_DE.UTF-8", "fr"), ("C", "fr")]
)
def test_a_command_takes_the_language_of_the_environment_where_the_course_speaks_it(
    told, lang, spoken, tmp_path
):
    _, record, _ = told("variant", "grashof", "--json", lang=lang)
    assert json.loads(record)["lang"] == spoken
    other = {"en": "fr", "fr": "en"}[spoken]
    _, record, _ = told("variant", "grashof", "--json", "--lang", other, lang=lang)
    assert json.loads(record)["lang"] == other
    assert told("build", "grashof", "--formats", "html", "--out", tmp_path, lang=lang)[0] == 0
    assert {path.name.split(".")[-2] for path in (tmp_path / "handouts").rglob("*.html")} <= {spoken, "00000"}


def test_the_first_of_the_languages_is_the_courses_own(small_course, told):
    toml = small_course / "exercises" / "course.toml"
    toml.write_text('languages = ["en", "fr"]\n' + toml.read_text("utf-8"), "utf-8")
    assert json.loads(told("--course", small_course, "variant", "crank_pin", "--json")[1])["lang"] == "en"
    assert (
        json.loads(told("--course", small_course, "variant", "crank_pin", "--json", lang="fr")[1])["lang"]
        == "fr"
    )


@pytest.mark.parametrize("stated", ['"en"', "[]", '["en", "en"]', "[1]", '["english"]'])
def test_languages_that_are_none_are_refused(small_course, told, stated):
    (small_course / "exercises" / "course.toml").write_text(f"languages = {stated}\n", "utf-8")
    status, _, err = told("--course", small_course, "show", "crank_pin")
    assert (status, len(err.splitlines())) == (2, 1)
    assert "course.toml" in err


def test_a_bare_title_does_where_one_language_is_spoken(english, told):
    (english / "exercises" / "course.toml").write_text('languages = ["en"]\ntitle = "Statics"\n', "utf-8")
    assert "Statics" in told("--course", english, "show", "crank_pin")[1]


@pytest.mark.e2e
@pytest.mark.parametrize(
    ("lang", "langs"), [("en_US.UTF-8", {"en"}), ("fr_FR.UTF-8", {"fr"}), ("C", {"en", "fr"})]
)
def test_a_new_course_speaks_the_language_of_the_environment(told, tmp_path, lang, langs):
    assert told("new", tmp_path / "mine", lang=lang)[0] == 0
    assert {path.name.split(".")[-3] for path in (tmp_path / "mine").rglob("*.md.j2")} == langs
    assert told("new", tmp_path / "mine", "second")[0] == 0
    assert {path.name.split(".")[-3] for path in (tmp_path / "mine").rglob("second.*.md.j2")} == langs
    assert told("--course", tmp_path / "mine", "check", "--variants", "10")[0] == 0


def test_no_test_depends_on_the_language_of_the_machine():
    assert [os.environ.get(name) for name in ("LC_ALL", "LC_MESSAGES", "LANG")] == [None, None, "C.UTF-8"]


@pytest.mark.parametrize(
    ("around", "options", "lang", "first"),
    [
        ("fr_FR.UTF-8", (), "fr", "fr"),
        ("en_GB.UTF-8", (), "en", "en"),
        ("C", (), "fr", "fr"),
        ("de_DE", (), "fr", "fr"),
        ("fr_FR.UTF-8", ("--lang", "en"), "en", "en"),
        ("C", ("--lang", "en,fr"), "en,fr", "en"),
    ],
)
def test_a_new_assignment_is_in_the_language_that_is_told_else_that_of_the_environment(
    told, tmp_path, around, options, lang, first
):
    path = tmp_path / "dm.toml"
    assert told("new", "assignment", path, "grashof", "mobility", *options, lang=around)[0] == 0
    stated = tomllib.loads(path.read_text("utf-8"))
    assert (stated["lang"], next(iter(stated["title"]))) == (lang, first)
    assert stated["title"].keys() == {"en", "fr"}


def test_a_new_assignment_in_a_language_that_an_exercise_lacks_is_refused(english, told, tmp_path):
    status, _, err = told(
        "--course", english, "new", "assignment", tmp_path / "dm.toml", "crank_pin", "--lang", "fr"
    )
    assert status == 2
    assert "crank_pin is not available in 'fr', only in en" in err
    assert (
        told("--course", english, "new", "assignment", tmp_path / "dm.toml", "crank_pin", lang="fr_FR")[0]
        == 0
    )
    assert tomllib.loads((tmp_path / "dm.toml").read_text("utf-8"))["lang"] == "en"


@pytest.mark.e2e
def test_notebooks_lead_to_notebooks_that_are_there(told, tmp_path):
    """And a seed that is not worth issuing is told, where it was asked for."""
    for asked in (("slotted_mechanism", "--seed", "3", "--lang", "fr,en"), ("quick_return", "--lang", "en")):
        status, _, err = told("notebook", *asked, "--out", tmp_path)
        assert status == 0
        text = "".join(nbformat.read(tmp_path / f"{asked[0]}.en.ipynb", 4).cells[1].source)
        (seed,) = re.findall(r"seed=(\d+)", text)
        assert (f"seed {seed}" in err) == ("--seed" in asked and seed != "3")
    notebooks = list(tmp_path.glob("*.ipynb"))
    assert len(notebooks) > 6
    for path in notebooks:
        found = re.findall(r"\]\(([\w.]+\.ipynb)", path.read_text("utf-8"))
        assert {*found} <= {one.name for one in notebooks}, path.name


def test_a_line_in_a_language_that_an_exercise_lacks_is_told_by_its_student(told, tmp_path):
    new_course(tmp_path / "mine", ("fr",))
    (tmp_path / "class.csv").write_text("student,lang\nAda,fr\nZoé,en\n", "utf-8")
    assert told("--course", tmp_path / "mine", "new", "assignment", tmp_path / "dm.toml", "crank_pin")[0] == 0
    for asked in ("crank_pin", tmp_path / "dm.toml"):
        build = ("build", asked, "--roster", tmp_path / "class.csv", "--out", tmp_path / "out")
        status, _, err = told("--course", tmp_path / "mine", *build)
        assert status == 2
        assert "'en', which the line of Zoé in the roster requests; it has fr" in err


def test_wrong_arguments_are_named_in_the_readers_language(cli, monkeypatch):
    monkeypatch.setenv("LANG", "fr_FR.UTF-8")
    monkeypatch.delenv("LC_ALL", raising=False)
    monkeypatch.delenv("LANGUAGE", raising=False)
    rows = {
        ("bild",): "aucune commande « bild » ; vouliez-vous dire « build » ?",
        ("show", "--sead", "3"): "aucune option « --sead » ; vouliez-vous dire « --seed » ?",
        ("show", "crank_pin", "--seed", "x"): "valeur non valable pour « --seed » : attend un nombre entier",
        ("show", "crank_pin", "--seed"): "l’option « --seed » demande une valeur",
        ("export",): "il manque « PLATEFORME »",
        ("after", "nothing.toml"): "pour « FICHIER.toml » : il n’y a pas de fichier « nothing.toml »",
        ("after", "."): "pour « FICHIER.toml » : « . » est un dossier",
        ("gradebook", "moodle", "marks", "--score", "best"): "au choix : points, mark, percent",
        (
            "gradebook",
            "moodle",
            ".",
            "--item",
            "x",
            "--out",
            "y",
            "--out-of",
            "a lot",
        ): "un nombre supérieur à 0",
        (
            "grade",
            "x.csv",
            "--issued",
            "x.json",
        ): "x.json ne peut pas être lu : il n’y a ni fichier ni dossier",
    }
    told = {arguments: cli(*arguments) for arguments in rows}
    found = {arguments: (status, err.replace("\u202f", " ")) for arguments, (status, _, err) in told.items()}
    assert {a: found[a] for a, text in rows.items() if found[a][0] != 2 or text not in found[a][1]} == {}
