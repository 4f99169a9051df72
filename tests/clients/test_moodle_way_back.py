"""The whole way back with a real Moodle: a quiz answered, its report marked, its gradebook filled and taken
in.

Runs where ``COURSEWORK_MOODLE`` names the folder of a Moodle's code whose web answers, and
``COURSEWORK_MOODLE_LOGIN`` its administrator, ``admin:password``. It makes a course of its own,
``coursework-way-back``, each time anew. PHP must be at hand.
"""

from __future__ import annotations

import csv
import html
import http.cookiejar
import json
import os
import re
import subprocess
import urllib.parse
import urllib.request
from pathlib import Path

import pytest
from class_of_three import table
from collected_pools import COURSE, EXERCISE, graded

from coursework.cli import run
from coursework.cli.options import FOUND

MOODLE = os.environ.get("COURSEWORK_MOODLE", "")
LOGIN = os.environ.get("COURSEWORK_MOODLE_LOGIN", "admin:")
pytestmark = pytest.mark.skipif(not MOODLE, reason="COURSEWORK_MOODLE names no Moodle")

SCRIPT = Path(__file__).with_name("moodle_way_back.php")
NAME = "coursework-way-back"
ITEM = "Week 3, marked"
PEOPLE = {
    "ann": ("Ann", "Doe"),
    "ann2": ("Ann", "Doe"),
    "emile": ("Émile", "D’Été"),
    "bob": ("Bob", "Ray"),
    "cy": ("Cy", "Wu"),
}
PROVISIONAL = ["--provisional"]  #: two of the answers wait for a person


def right_answers(seed):
    """What the solution gives, to six figures, in the order asked; a case as Moodle prints it."""
    variant = COURSE[EXERCISE].variant(seed, "en")
    values = variant.solution()
    return [
        "b) oscillates" if part.choices else f"{complex(values[part.quantity]).real:.6g}"
        for part in variant.parts
    ]


def cloze(seed):
    gaps = []
    for part, answer in zip(COURSE[EXERCISE].variant(seed, "en").parts, right_answers(seed), strict=True):
        gap = f"{answer}:{abs(float(answer)) / 100:.4g}" if not part.choices else ""
        gaps.append(
            f"{{1:NUMERICAL:={gap}}}" if gap else "{1:MULTICHOICE_V:=b) oscillates~a) makes a full turn}"
        )
    asked = "".join(f"<p>{gap}</p>" for gap in gaps)
    return f"""<question type="cloze"><name><text>whole</text></name>
        <questiontext format="html"><text><![CDATA[
        <p>A crank turns.</p><p>[{EXERCISE} · {seed} · v1 · en]</p>{asked}]]></text></questiontext>
        </question>"""


def short(seed, part):
    return f"""<question type="shortanswer"><name><text>{part}</text></name>
        <questiontext format="html"><text><![CDATA[
        <p>[{EXERCISE} · {seed} · v1 · en · {part}]</p>]]></text></questiontext>
        <defaultgrade>1</defaultgrade><usecase>0</usecase>
        <answer fraction="100"><text>x</text></answer></question>"""


class Moodle:
    """The Moodle under test, by PHP and by its web."""

    def __init__(self, folder):
        self.folder = folder
        config = (Path(MOODLE) / "config.php").read_text("utf-8")
        self.root = re.search(r"wwwroot\s*=\s*'([^']+)'", config)[1]
        jar = urllib.request.HTTPCookieProcessor(http.cookiejar.CookieJar())
        self._web = urllib.request.build_opener(jar)
        token = re.search(r'name="logintoken" value="([^"]+)"', self.page("login/index.php"))[1]
        user, _, password = LOGIN.partition(":")
        self.page("login/index.php", username=user, password=password, logintoken=token)

    def do(self, what, **asked):
        path = self.folder / "asked.json"
        path.write_text(json.dumps({"course": NAME, **asked}, ensure_ascii=False), "utf-8")
        command = [
            "php",
            "-d",
            "max_input_vars=5000",
            "-d",
            "memory_limit=1G",
            str(SCRIPT),
            MOODLE,
            what,
            str(path),
        ]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        return json.loads(said.strip().splitlines()[-1])

    def file(self, path, **form):
        data = urllib.parse.urlencode(form).encode() if form else None
        with self._web.open(f"{self.root}/{path}", data) as answer:
            return answer.read()

    def page(self, path, **form):
        return self.file(path, **form).decode("utf-8")

    def report(self, module, kind, lang):
        about = f"mod/quiz/report.php?id={module}&mode=responses"
        key = re.search(r'"sesskey":"([^"]+)"', self.page(about))[1]
        shown = "attempts=enrolled_any&onlygraded=0&qtext=1&resp=1&right=0"
        return self.file(f"{about}&{shown}&sesskey={key}&download={kind}&lang={lang}")

    def gradebook(self, course, lang, separator):
        page = self.page(f"grade/export/txt/index.php?id={course}&lang={lang}")
        form = page[page.index("grade/export/txt/export.php") :].partition("</form>")[0]
        fields = {}
        for field in re.findall(r"<input[^>]*>", form):
            found = dict(re.findall(r'(\w+)="([^"]*)"', field))
            if found.get("type") == "hidden" or "checked" in field:
                fields[html.unescape(found["name"])] = html.unescape(found.get("value", "1"))
        fields |= {"separator": separator, "decimals": "2", "display[real]": "1"}
        return self.file(f"grade/export/txt/export.php?id={course}", **fields)

    def marks(self):
        return {name: mark for name, mark in self.do("marks").get(ITEM, {}).items() if mark is not None}


@pytest.fixture(scope="module")
def moodle(tmp_path_factory):
    return Moodle(tmp_path_factory.mktemp("moodle"))


@pytest.fixture(scope="module")
def quiz(moodle):
    """A quiz that five people had, and its files as Moodle gives them."""
    folder = moodle.folder
    (folder / "questions.xml").write_text(
        f"<quiz>{cloze(5)}{short(4, 'rA')}{short(4, 'theta4')}</quiz>", "utf-8"
    )
    students = [
        {
            "username": f"wb_{name}",
            "firstname": first,
            "lastname": last,
            "email": f"wb.{name}@example.org",
            "idnumber": f"wb-{n}",
        }
        for n, (name, (first, last)) in enumerate(PEOPLE.items(), start=1)
    ]
    item = {"name": ITEM, "idnumber": "week3", "max": 11}
    made = moodle.do(
        "set_up", students=students, items=[item], quiz="Week 3", grade=11, xml=str(folder / "questions.xml")
    )
    assert made["ok"], made["said"]
    right = right_answers(5)

    def attempt(name, answers, more=("", ""), finish=True, language="en"):
        parts = {str(n): {"answer": text} for n, text in enumerate(answers, start=1)}
        slots = {"1": parts, "2": {"answer": more[0]}, "3": {"answer": more[1]}}
        return {"username": f"wb_{name}", "finish": finish, "language": language, "answers": slots}

    odd = [right[0], "x < 3 & y > 2", *right[2:7], "a\tb", f"{right[8]} rad/s² ; part of it"]
    moodle.do(
        "answer",
        attempts=[
            attempt("ann", [""] * 9, ("111.5 mm", "72")),
            attempt("ann", [a.replace(".", ",") for a in right], ("0,1115 m", "71,997°"), language="fr"),
            attempt("ann2", odd),
            attempt("emile", right, finish=False),
            attempt("bob", [""] * 9),
        ],
    )
    files = {}
    for name, kind, lang in (("en.csv", "csv", "en"), ("fr.csv", "csv", "fr"), ("en.json", "json", "en")):
        files[name] = folder / name
        files[name].write_bytes(moodle.report(made["cmid"], kind, lang))
    for lang, separator in (("en", "comma"), ("fr", "semicolon")):
        files[f"gradebook_{lang}"] = folder / f"gradebook_{lang}.csv"
        files[f"gradebook_{lang}"].write_bytes(moodle.gradebook(made["course"], lang, separator))
    return files


def column(quiz, lang):
    """The title of the item's column as Moodle writes it: ``Week 3, marked (Real)``, ``(Brut)`` with the
    French pack."""
    header = quiz[f"gradebook_{lang}"].read_text("utf-8-sig").splitlines()[0]
    cells = next(csv.reader([header], delimiter=";" if lang == "fr" else ","))
    return next(title for title in cells if title.startswith(f"{ITEM} ("))


@pytest.mark.parametrize("name", ["en.csv", "fr.csv", "en.json"])
def test_a_report_that_moodle_wrote_is_marked(quiz, tmp_path, name):
    book = graded(tmp_path, quiz[name])
    found = {row["student"]: (row["points"], row["sitting"]) for row in table(tmp_path / "marks/summary.csv")}
    assert found == {
        "Ann Doe": ("11", "2"),
        "Ann Doe (wb.ann2@example.org)": ("6", "1"),
        "Bob Ray": ("0", "1"),
    }
    assert (book.rows_in, book.marked, len(book.rejected)) == (45, 44, 1)
    assert "1 student without an attempt" in book.seen[0]


def filled(quiz, tmp_path, language, *options):
    graded(tmp_path, quiz["en.csv"])
    out = tmp_path / "filled.csv"
    given = ["--template", str(quiz[f"gradebook_{language}"]), "--item", ITEM, "--out", str(out)]
    assert run(["gradebook", "moodle", str(tmp_path / "marks"), *given, *options, *PROVISIONAL]) == FOUND
    return out


@pytest.mark.parametrize(
    ("language", "separator", "mail"),
    [("en", "comma", "Email address"), ("fr", "semicolon", "Adresse de courriel")],
)
def test_moodle_takes_the_filled_gradebook_in_each_language(
    moodle, quiz, tmp_path, language, separator, mail
):
    asked = {
        "item": ITEM,
        "column": column(quiz, language),
        "by": mail,
        "separator": separator,
        "language": language,
    }
    out = filled(quiz, tmp_path, language, "--out-of", "10.5")
    assert moodle.do("import_csv", file=str(out), **asked)["status"]
    assert moodle.marks() == {"wb_ann": 10.5, "wb_ann2": 5.73}
    above = filled(quiz, tmp_path, language, "--out-of", "11.5")
    refused = moodle.do("import_csv", file=str(above), **asked)
    assert not refused["status"], "the item is out of 11: one mark above it refuses the file"
    assert moodle.marks() == {"wb_ann": 10.5, "wb_ann2": 5.73}


def test_moodle_gives_back_what_was_written(moodle, quiz, tmp_path):
    out = filled(quiz, tmp_path, "en")
    asked = {"file": str(out), "item": ITEM, "column": column(quiz, "en"), "by": "Email address"}
    assert moodle.do("import_csv", **asked)["status"]
    assert moodle.marks() == {"wb_ann": 11, "wb_ann2": 6}


def test_a_comma_is_refused_by_an_english_moodle_and_a_point_taken_by_a_french_one(moodle, quiz, tmp_path):
    summary = tmp_path / "summary.csv"
    graded(tmp_path / "graded", quiz["en.csv"])
    summary.write_text(
        (tmp_path / "graded/marks/summary.csv")
        .read_text("utf-8-sig")
        .replace("Ann Doe,11,", "Ann Doe,6.25,"),
        "utf-8",
    )
    taken = {}
    for sign in ("point", "comma"):
        out = tmp_path / f"{sign}.csv"
        given = [
            "--template",
            str(quiz["gradebook_fr"]),
            "--item",
            ITEM,
            "--out",
            str(out),
            "--decimal",
            sign,
        ]
        assert run(["gradebook", "moodle", str(summary), *given, *PROVISIONAL]) == FOUND
        asked = {
            "file": str(out),
            "item": ITEM,
            "column": column(quiz, "fr"),
            "by": "Adresse de courriel",
            "separator": "semicolon",
        }
        taken |= {
            (sign, lang): moodle.do("import_csv", language=lang, **asked)["status"] for lang in ("en", "fr")
        }
    assert taken == {
        ("point", "en"): True,
        ("point", "fr"): True,
        ("comma", "en"): False,
        ("comma", "fr"): True,
    }
    assert moodle.marks()["wb_ann"] == 6.25


def test_moodle_takes_xml_by_id_numbers(moodle, quiz, tmp_path):
    from coursework.issuing.roster import read_roster

    students = {s.name: dict(s.columns) for s in read_roster(quiz["gradebook_en"])}
    graded(tmp_path, quiz["en.csv"], students=students)
    out = tmp_path / "marks.xml"
    given = ["--item", "week3", "--out", str(out), *PROVISIONAL]
    assert run(["gradebook", "moodle", str(tmp_path / "marks"), *given]) == FOUND
    assert moodle.do("import_xml", file=str(out)) == {"status": True, "errors": []}
    assert moodle.marks() | {"wb_ann": 11, "wb_ann2": 6} == moodle.marks()
