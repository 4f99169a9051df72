"""A page keeps what is typed in it, on this device alone, and hands it in as a file that is marked."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest
from page_scripts import runs
from paper_samples import COURSE, NAMES, bare, heading, paper
from tables import each_row

from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submissions import read_file
from coursework.language.words import words
from coursework.rendering.renderer import renderer_of

RENDERER = renderer_of(COURSE.folder)
NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="runs the script with node, which is not here")
every_exercise = pytest.mark.parametrize("name", COURSE.names)
every_language = pytest.mark.parametrize("lang", ["fr", "en"])


class Page(HTMLParser):
    """The boxes of a page, and what its script is told."""

    def __init__(self, text):
        super().__init__()
        self.boxes, self.labelled, self.ids, self._inside = [], set(), set(), 0
        self.bare = []  #: boxes that no label holds
        self.feed(text)
        (data,) = re.findall(
            r'<script type="application/json" id="sheet-data">(.*?)</script>', text, re.DOTALL
        )
        self.data = json.loads(data)
        self.script, *_ = runs(text)  # the other one draws

    def handle_starttag(self, tag, pairs):
        attributes = dict(pairs)
        if tag == "label":
            self._inside += 1
            self.labelled.add(attributes.get("for"))
        if tag in ("input", "textarea") and "name" in attributes and "hidden" not in attributes:
            self.boxes.append(
                {"type": "text", "value": "", **attributes}
                if tag == "input"
                else {"type": "text", **attributes}
            )
            if not self._inside:
                self.bare.append(attributes.get("id"))

    def handle_endtag(self, tag):
        self._inside -= tag == "label"

    def run(self, *typed, stored=None, storage="there"):
        told = {
            "sheet": {"boxes": self.boxes, "data": self.data},
            "script": self.script,
            "typed": typed,
            "stored": stored,
            "storage": storage,
        }
        program = Path(__file__).with_name("answers_page.js")
        done = subprocess.run(
            [NODE, program], input=json.dumps(told), capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)


def one(name, lang="en", student="Zoé Martin", seed=7):
    return Page(RENDERER.html(COURSE[name].variant(seed, lang).handout(student)))


def read(tmp_path, files):
    """The rows of what a page hands in, as marking reads them."""
    ((name, text),) = files
    assert re.fullmatch(r"[\w-]+\.json", name)
    (tmp_path / name).write_text(text, "utf-8")
    return list(read_file(tmp_path / name))


@every_exercise
def test_every_question_has_a_box_with_a_label_and_the_file_has_its_part(name):
    page = one(name)
    handout = COURSE[name].variant(7, "en").handout("Zoé Martin")
    asked = [question.id for question in handout.questions]
    assert page.data["sheets"] == [{"exercise": name, "seed": "7", "own": "", "parts": asked}]
    assert list(dict.fromkeys(box.get("data-cell", box["name"]) for box in page.boxes)) == asked
    assert set(page.bare) <= page.labelled
    texts = [box for box in page.boxes if box["type"] == "text"]
    # The keypad of decimal numbers of some telephones has no minus, that of others no comma.
    assert all(box["inputmode"] == "text" and box["autocapitalize"] == "off" for box in texts)


@needs_node
@every_exercise
def test_what_is_typed_comes_back_when_the_page_opens_again_and_is_read_as_typed(name, tmp_path):
    page = one(name, "fr")
    typed = {}
    for number, box in enumerate(box for box in page.boxes if "data-cell" not in box):
        typed[box["name"]] = box["value"] if box["type"] != "text" else f"−{number},5e3 mm “'<\\"
    first = page.run(*typed.items(), "save")
    again = page.run("save", stored=first["stored"])
    assert again["restored"] == first["left"] != first["restored"]
    assert again["files"] == first["files"]
    rows = read(tmp_path, again["files"])
    assert {(row.student, row.exercise, row.seed, row.lang) for row in rows} == {
        ("Zoé Martin", name, "7", "fr")
    }
    assert {row.part: row.answer for row in rows} == typed


@needs_node
def test_a_paper_is_one_file_whose_exercises_are_told_apart(tmp_path):
    page = Page(RENDERER.html(paper(bare("en", ""), (*NAMES, "grashof"))))
    assert page.run("save")["focused"] == "student"
    assert page.run("save")["told"] == [words("en")["page"]["name_first"]]
    done = page.run(
        ("student", " Zoé #1 "), ("e2-linkage_type", "b"), ("e4-linkage_type", "c"), ("e1-rA", "1,5"), "save"
    )
    rows = [row for row in read(tmp_path, done["files"]) if row.answer]
    assert [(row.student, row.exercise, row.seed, row.part, row.answer) for row in rows] == [
        ("Zoé #1", "slotted_mechanism", "7", "rA", "1,5"),
        ("Zoé #1", "grashof", "8", "linkage_type", "b"),
        ("Zoé #1", "grashof", "10", "linkage_type", "c"),
    ]


@needs_node
def test_two_students_two_variants_and_two_papers_are_kept_apart():
    pages = [one("grashof"), one("grashof", seed=8), one("grashof", student="Ann"), one("slotted_mechanism")]
    pages.append(Page(RENDERER.html(paper(heading("en")))))
    stored = {}
    for number, page in enumerate(pages):
        done = page.run((page.boxes[-1]["name"], page.boxes[-1]["value"] or str(number)), stored=stored)
        assert not any(done["restored"])
        stored = done["stored"]
    assert len(stored) == len(pages)


@needs_node
@every_language
def test_answers_are_wiped_when_asked_twice_and_what_became_of_them_is_told(lang):
    said = words(lang)["page"]
    done = one("slotted_mechanism", lang).run(("rA", "1"), "save", "wipe")
    assert done["asked"] == [said["sure"]]
    assert done["stored"] == {}
    assert not any(done["left"])
    kept, saved, wiped = done["told"]
    assert kept.startswith(said["kept"].split("{0}")[0])
    assert "{" not in kept + saved
    assert "1" in saved
    assert wiped == said["cleared"]


@needs_node
def test_a_device_that_stores_nothing_is_told_at_once_and_the_file_is_saved_all_the_same(tmp_path):
    done = one("slotted_mechanism").run(("rA", "1"), "save", storage="refused")
    assert done["told"][0] == words("en")["page"]["not_kept"]
    assert {row.part: row.answer for row in read(tmp_path, done["files"])}["rA"] == "1"


@needs_node
@each_row("spoilt", ["", "{", "null", "[1]", '{"typed": 3}', '{"typed": {"rA": {"x": 1}, "theta4": [1]}}'])
def test_a_spoilt_storage_stops_no_page(spoilt):
    page = one("slotted_mechanism")
    done = page.run(("theta4", "2"), stored={page.data["key"]: spoilt})
    assert not done["hidden"]
    assert not any(done["restored"])
    assert json.loads(done["stored"][page.data["key"]])["typed"] == {"theta4": "2"}


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda sheet: sheet.update(answers=[1, 2]), "an item is"),
        (lambda sheet: sheet.update(answers={}), "contains no answer"),
        (lambda sheet: sheet["answers"].update(rA={"$": 1}), "an answer is a text or a number"),
        (lambda sheet: sheet.pop("answers"), "an item is"),
    ],
)
def test_a_file_that_was_spoilt_is_told_by_its_place(change, reason, tmp_path):
    sheet = {
        "student": "Zoé",
        "exercise": "slotted_mechanism",
        "seed": "7",
        "answers": {"rA": "1", "theta4": "2"},
    }
    change(sheet)
    path = tmp_path / "a.json"
    path.write_text(json.dumps([sheet]), "utf-8")
    rows = list(read_file(path))
    (told,) = [row for row in rows if isinstance(row, Rejected)]
    assert reason in told.reason
    assert told.source.startswith(f"{path}, item 1")
    assert all(isinstance(row, AnswerRow) for row in rows if row is not told)


@pytest.mark.parametrize(
    "text", ["", "{", "[[[[", "[" * 100_000, "3", '"a"', "[]", "\x00", "[null]", '[{"answers": {"a": NaN}}]']
)
def test_a_file_of_anything_is_read_without_a_traceback(text, tmp_path):
    (tmp_path / "a.json").write_text(text, "utf-8")
    assert list(read_file(tmp_path / "a.json"))


@every_language
def test_a_page_ends_its_data_nowhere_else(lang):
    page = one("slotted_mechanism", lang, "</script><script>alert(1)</script>")
    assert page.data["student"] == "</script><script>alert(1)</script>"


def test_what_a_french_page_tells_parts_no_high_mark_from_its_word():
    told = words("fr")["page"]
    assert not [text for text in told.values() if re.search(r"[ ][;:!?»]|« ", text) or "'" in text]
    assert set(told) == set(words("en")["page"])
