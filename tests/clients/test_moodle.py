"""A real Moodle takes what is exported, and judges it as our marking does but for what ``lost.csv`` lists.

Runs where ``COURSEWORK_MOODLE`` names the folder of Moodle's code (with its ``config.php``; PHP on the path).
What is tried stays in a course of its own, deleted at the end. ``COURSEWORK_MOODLE_ADMIN``,
``name:password``, lets the tests of pages log in.
"""

from __future__ import annotations

import csv
import html
import os
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from clients.answer_samples import answers_to
from clients.moodle_site import ADMIN, MOODLE, Site, ask

import coursework
from coursework.gradebook.grading import grade_files
from coursework.platforms.exporting import export
from coursework.platforms.items import item as item_of
from coursework.platforms.losses import losses
from coursework.platforms.moodle import PLATFORM
from coursework.platforms.pieces import PagePieces
from coursework.platforms.pools import of_exercises
from coursework.platforms.posed import CHOICES, COLLECTED, mark_alone

pytestmark = pytest.mark.skipif(not MOODLE, reason="COURSEWORK_MOODLE names no folder of a Moodle's code")

COURSE = coursework.open_course()
LANGS = ("en", "fr")
ANSWERS = 160  #: to an exercise
NAME = "coursework_tests"

every_exercise = pytest.mark.parametrize("name", COURSE.names)
every_language = pytest.mark.parametrize("lang", LANGS)


class Imported:
    """The pool of an exercise, and the questions that Moodle made of it."""

    def __init__(self, name, lang, folder):
        self.drawn = of_exercises(COURSE, [name], 2, 0, LANGS, None)
        self.pool = self.drawn.pool(lang, PLATFORM)
        (file,) = PLATFORM.files(self.pool)
        path = folder / file.path
        path.write_bytes(b"".join(file.make()))
        self.told = ask("import", course=NAME, file=str(path), lang=lang)
        self.questions = self.told["questions"]
        self.variants = [variant.in_language(lang) for variant in self.drawn.variants[0]]
        self.items = [item_of(variant, self.drawn.name) for variant in self.variants]
        self.lost = {(loss.part, loss.feature) for loss in losses(self.pool, "moodle")}


@pytest.fixture(scope="session")
def imported(tmp_path_factory):
    made = {}

    def of(name, lang):
        if (name, lang) not in made:
            made[name, lang] = Imported(name, lang, tmp_path_factory.mktemp("moodle"))
        return made[name, lang]

    ask("reset", course=NAME)
    yield of
    ask("reset", course=NAME)


@pytest.fixture(scope="session")
def figures():
    """Answers by language and by what became of them; written where ``COURSEWORK_MOODLE_FIGURES`` says, for
    the docs."""
    counts = Counter()
    yield counts
    if path := os.environ.get("COURSEWORK_MOODLE_FIGURES"):
        rows = "".join(f"{lang},{sort},{count}\n" for (lang, sort), count in sorted(counts.items()))
        Path(path).write_text(f"lang,sort,answers\n{rows}", "utf-8")


@every_language
@every_exercise
def test_every_exercise_is_imported_whole(imported, name, lang):
    one = imported(name, lang)
    assert (one.told["done"], one.told["said"]) == (True, "")
    assert [q["name"] for q in one.questions] == [item.label[1:-1] for item in one.items]
    for question, item in zip(one.questions, one.items, strict=True):
        judged = [posed for posed in item.questions if posed.kind != COLLECTED]
        scale = next(n for n in (1, 2, 4) if all(n * p.points % 1 == 0 for p in item.questions))
        assert float(question["defaultmark"]) == scale * sum(posed.points for posed in judged)
        assert len(question["boxes"]) == len(item.questions)


@every_language
@every_exercise
def test_right_answers_get_full_marks(imported, name, lang):
    """The answers that Moodle itself shows as right, and ours; a question of which it judges nothing has no
    mark."""
    one = imported(name, lang)
    attempts = [{"id": q["id"], "data": "right"} for q in one.questions]
    for question, item in zip(one.questions, one.items, strict=True):
        attempts.append(
            {"id": question["id"], "data": {k: _right(p) for k, p in enumerate(item.questions, 1)}}
        )
    expected = [1 if float(q["defaultmark"]) else None for q in one.questions] * 2
    assert [made["fraction"] for made in ask("answer", lang=lang, attempts=attempts)] == expected


def _right(posed):
    if posed.kind == COLLECTED:
        return "whatever"
    if posed.options:
        right = [place for place, option in enumerate(posed.options) if option.share > 0]
        return right if posed.kind == CHOICES else max(right, key=lambda place: posed.options[place].share)
    return f"{posed.intervals[0].value:.6g}"


def _as_ours(posed, answer):
    """An answer as our marking reads it: options by their cases."""
    if isinstance(answer, list):
        return ", ".join(posed.options[place].case for place in answer) or "none"
    return posed.options[answer].case if isinstance(answer, int) else answer


def compared(one, lang):
    """Every answer with what Moodle and what our marking gives for it."""
    asked = []
    for question, item, variant in zip(one.questions, one.items, one.variants, strict=True):
        a_part = -(-ANSWERS // (len(one.questions) * len(item.questions)))
        for place, (posed, part) in enumerate(zip(item.questions, variant.parts, strict=True), 1):
            for given in answers_to(posed, part, max(a_part, 36), f"{item.identifier} {part.id}"):
                asked.append((question["id"], place, posed, part, variant, given))
    attempts = [{"id": id, "data": {place: given.answer}} for id, place, *_, given in asked]
    made = ask("answer", lang=lang, attempts=attempts)
    for (_, place, posed, part, variant, given), theirs in zip(asked, made, strict=True):
        ours = mark_alone(variant, part, _as_ours(posed, given.answer))
        yield posed, part, given, theirs["shares"][str(place)] or 0.0, ours.points / ours.out_of, ours.verdict


@every_language
@every_exercise
def test_moodle_judges_as_we_do_but_for_what_is_listed(imported, figures, name, lang):
    one = imported(name, lang)
    unlisted, count = [], 0
    for posed, part, given, theirs, ours, verdict in compared(one, lang):
        count += 1
        excuses = [excuse for excuse in given.excuses if (part.id, excuse) in one.lost]
        if posed.kind == COLLECTED:
            sort = "collected"
        elif abs(theirs - ours) < 1e-6:
            sort = "same"
        elif excuses:
            sort = excuses[0]
        else:
            sort = "unlisted"
            unlisted.append((part.id, given.sort, given.answer, theirs, ours, verdict))
        figures[lang, sort] += 1
    assert count >= ANSWERS
    assert not unlisted


HOSTILE = '} ~ # " & = % \\ \\} \\# {1:SA:=x} 50%~b#c &amp; &lt;b&gt; {#1} $a$ a/b'


def test_hostile_labels_and_odd_shares_come_through(tmp_path):
    """Labels as students read them, shares that are in none of Moodle's lists, to its seven decimals."""
    drawn = of_exercises(COURSE, ["grashof"], 1, 0, ("en",), None)
    pool, given = drawn.pool("en", PLATFORM), item_of(drawn.variants[0][0].in_language("en"), drawn.name)
    choice, pieces = given.questions[-1], PagePieces(pool.folders, "en")
    labels = [re.sub(r"([\\`*_{}\[\]<>#~$&])", r"\\\1", f"{HOSTILE} {k}") for k in range(len(choice.options))]
    options = tuple(
        replace(one, label=label, share=one.share or 0.3712345, message=label)
        for one, label in zip(choice.options, labels, strict=True)
    )
    hostile = replace(given, questions=(*given.questions[:-1], replace(choice, options=options)))
    section = replace(pool.sections[0], items=(PLATFORM.made(hostile, pieces),), title=HOSTILE)
    path = tmp_path / "hostile.xml"
    (file,) = PLATFORM.files(replace(pool, title="Week 3/4", sections=(section,)))
    path.write_bytes(b"".join(file.make()))
    told = ask("import", course=NAME, file=str(path))
    assert (told["done"], told["said"]) == (True, "")
    (question,) = told["questions"]
    made = question["boxes"][-1]["answers"]
    assert [_shown(one["answer"]) for one in made] == [_shown(pieces.option(one)) for one in options]
    assert [one["share"] for one in made] == pytest.approx([one.share for one in options], abs=1e-7)
    assert HOSTILE.split("$")[0] in html.unescape(made[0]["answer"])


def _shown(text):
    return html.unescape(text)


@pytest.mark.parametrize("filtered", [True, False], ids=["multilang on", "multilang off"])
@pytest.mark.skipif(not ADMIN, reason="COURSEWORK_MOODLE_ADMIN names no administrator")
def test_a_french_and_an_english_student_have_one_quiz(tmp_path, filtered):
    """Each reads every question in their own language (both if the filter is off); both reports are marked
    alike."""
    names = ["slotted_mechanism", "grashof", "four_bar_positions"]
    drawn = of_exercises(COURSE, names, 2, 0, LANGS, None)
    course = f"{NAME}_two_languages_{int(filtered)}"
    ask("reset", course=course)
    ask("filter", name="multilang", on=filtered)
    categories = {}
    for file in export(PLATFORM, drawn).files:
        path = tmp_path / file.path
        path.write_bytes(b"".join(made) if not isinstance(made := file.make(), bytes) else made)
        if path.suffix == ".xml":
            told = ask("import", course=course, file=str(path))
            assert (told["done"], told["said"]) == (True, "")
            categories |= {q["category"]: (q["categoryid"], q["defaultmark"]) for q in told["questions"]}
    assert len(categories) == len(names)
    students = [
        {
            "username": f"cw_{lang}",
            "firstname": lang,
            "lastname": "Doe",
            "email": f"{lang}@example.org",
            "lang": lang,
        }
        for lang in LANGS
    ]
    slots = [{"category": category, "mark": float(mark)} for category, mark in categories.values()]
    made = ask("quiz", course=course, name="Two languages", slots=slots, students=students)
    items = {
        (lang, one.label[1:-1].removesuffix(f" · {lang}")): one
        for lang in LANGS
        for variants in drawn.variants
        for one in (item_of(variant.in_language(lang), drawn.name) for variant in variants)
    }
    attempts = []
    for lang, student in zip(LANGS, made["students"], strict=True):
        other = LANGS[1 - LANGS.index(lang)]
        answers = {}
        for slot, name in student["posed"].items():
            code = name.removesuffix(" · en · fr")
            shown = student["shown"][slot]
            assert f"[{code} · {lang}]" in shown
            assert (f"[{code} · {other}]" in shown) is not filtered
            answers[slot] = {
                k: _right(p).replace(".", "." if lang == "en" else ",")
                if isinstance(_right(p), str)
                else _right(p)
                for k, p in enumerate(items[lang, code].questions, 1)
            }
        attempts.append({"attempt": student["attempt"], "answers": answers})
    marks = ask("finish", attempts=attempts)
    assert marks == [pytest.approx(sum(slot["mark"] for slot in slots))] * 2
    report = tmp_path / "responses.csv"
    report.write_bytes(Site(*ADMIN.split(":")).responses(made["cmid"]))
    book = grade_files(COURSE, [report], tmp_path / "issued.json", tmp_path / "marks", feedback=False)
    assert (book.rejected, len(book.students)) == ([], 2)
    judged = {q.question.id for one in items.values() for q in one.questions if q.kind != COLLECTED}
    with (tmp_path / "marks/marks.csv").open(encoding="utf-8-sig") as file:
        wrong = [row for row in csv.DictReader(file) if row["part"] in judged and row["verdict"] != "correct"]
    assert wrong == []
