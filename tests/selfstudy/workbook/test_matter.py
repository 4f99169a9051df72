"""Pages before the first chapter and after the last one, and the index: terms, words that are found, persons,
machines."""

from __future__ import annotations

import re

import pytest

import coursework
from coursework.errors import BadCourse, bare_letters
from coursework.language.typography import typeset
from coursework.markup.links import TERM, links
from coursework.selfstudy.workbook import lesson_source as source
from coursework.selfstudy.workbook.concordance import (
    SoughtEntry,
    entries_of,
    machine_entries,
    see_entries,
    with_entries,
)
from coursework.selfstudy.workbook.matter import matter_of, title_page
from coursework.sheets.book import BoxPiece, HeadPiece, LessonText, ProsePiece

LESSON = LessonText(
    "x",
    1,
    "en",
    "X",
    (
        HeadPiece("Joints", 1, 1),
        ProsePiece("The joint graphs of a [joint](#index), `joint`, $joint$; two joints; no jointed bar."),
        BoxPiece("rule", "1.1", "", "A joint graph. Watt said."),
    ),
    (),
)


def test_words_of_the_index_are_marked_where_a_lesson_has_them_first():
    sought = (
        SoughtEntry("word", "joint", ("joint",)),
        SoughtEntry("word", "joint graph", ("joint graph",)),
        SoughtEntry("word", "Watt, James", ("Watt",)),
        SoughtEntry("machine", "pump", ("pump",)),
    )
    found = with_entries(LESSON, sought)
    assert found.words == ("joint graph", "joint", "Watt, James")
    assert found.pieces[1].text == (
        'The [joint graphs](#word "joint graph") of a [joint](#index), `joint`, $joint$; '
        'two [joints](#word "joint"); no jointed bar.'
    )
    assert found.pieces[2].text == 'A joint graph. [Watt](#word "Watt, James") said.'


def test_an_entry_as_it_is_printed_is_the_entry_of_the_list(course):
    """The index of a text sorts by the printed entry, the lists behind the book by the stated one."""
    entries = [
        (lang, one.entry) for lang in course.folder.languages for one in entries_of(course.folder, lang)
    ]
    assert any("'" in entry for _, entry in entries)
    keys = {entry: bare_letters(typeset(entry, lang)) for lang, entry in entries}
    assert [e for e, key in keys.items() if key.replace("\N{NO-BREAK SPACE}", " ") != bare_letters(e)] == []


ARTICLE = re.compile(r"(?:An?|The|Une?|Les?|La) |L['’]")


def test_the_index_has_four_hundred_entries_and_references_lead_to_them(course):
    folder, faults = course.folder, []
    for lang in folder.languages:
        met, sought = set(), entries_of(folder, lang)
        for name in folder.lessons:
            text = (folder.lesson_place / f"{name}.{lang}.md").read_text("utf-8")
            prose = tuple(
                ProsePiece(b.text) for b in source.blocks(text, name) if isinstance(b, source.LessonProse)
            )
            marked = with_entries(LessonText(name, 1, lang, name, prose, ()), sought)
            met |= {*(link.name for link in links(text) if link.kind == TERM), *marked.words}
        see = see_entries(folder, lang)
        faults += [f"{lang}: {one.entry} leads to {one.to!r}" for one in see if one.to not in met]
        machines = [
            one.entry for one in machine_entries(folder, lang) if not one.exercises and one.entry not in met
        ]
        faults += [f"{lang}: no lesson speaks of {one}" for one in machines]
        titles = [course[name].title(lang) for name in folder.names]
        faults += [f"{lang}: {title} is sorted by its article" for title in titles if ARTICLE.match(title)]
        people = {one.entry for one in sought if one.list == "word" and ", " in one.entry}
        if len(met | people) + len(see) + len(folder.names) < 400:
            faults.append(f"{lang}: {len(met | people)} entries and {len(see)} references")
    assert faults == []


#: A word with a capital inside a sentence, or with an English genitive, is the name of a person, but for a
#: few.
NAMED = re.compile(
    r"(?:(?<=[a-zéèà,;’'] )|(?<=\b[dDlL]['’]))[A-ZÉ][a-zéèçïü]{2,}\b(?!-)|\b[A-Z][a-zü]{3,}(?='s )"
)
NO_PERSONS = {"Malte", "Maltese", "Scotch", "French"}
CODE = re.compile(r"```(?:python|text).*?```|\{\{.*?\}\}|\{%.*?%\}|\$[^$]*\$", re.DOTALL)
TEXTS = ("lessons/*.{}.md", "book/*.{}.md", "*/*.{}.md.j2", "../solutions/*/*.{}.md.j2")


def texts_in(folder, lang):
    """Each text of the course in a language: of lessons, pages, statements, solutions, tables."""
    exercises = folder.lesson_place.parent
    for path in (path for pattern in TEXTS for path in exercises.glob(pattern.format(lang))):
        yield path.name, CODE.sub("", path.read_text("utf-8"))
    for name in ("glossary", "machines", "summaries", "true_or_false", "boxes", "notation"):
        told = (folder.book_place / f"{name}.toml").read_text("utf-8")
        yield name, "\n".join(re.findall(lang + r' = (".*?"|\[.*?\])', told))


def test_each_person_whom_a_text_names_has_a_line_with_years(course):
    people = course.folder.book_table("people")["people"]
    known = " ".join(str([row.get(key) for key in ("name", "full", "full_in", "alias")]) for row in people)
    for lang in course.folder.languages:
        texts = texts_in(course.folder, lang)
        names = {(name[0], file) for file, text in texts for name in NAMED.finditer(text)}
        assert len({name for name, _ in names}) > 20
        assert {(n, file) for n, file in names if n not in NO_PERSONS and n not in known} == set()
    assert [row["name"] for row in people if not row["years"]] == []


def test_the_pages_of_the_book_are_there_in_every_language(course):
    folder = course.folder
    parts = {
        lang: [*matter_of(folder, lang, "front"), *matter_of(folder, lang, "back")]
        for lang in folder.languages
    }
    names = {lang: [(part.name, len(part.pieces)) for part in told] for lang, told in parts.items()}
    assert names["en"] == names["fr"]
    assert all(part.title and part.pieces for told in parts.values() for part in told)
    assert all(title_page(folder, lang).author for lang in folder.languages)
    for name in {exercise for one in machine_entries(folder, "en") for exercise in one.exercises}:
        assert name in folder.names


def test_a_page_that_is_missing_is_told(small_course):
    place = small_course / "exercises/book"
    place.mkdir()
    (place / "matter.toml").write_text('front = ["preface"]\n', "utf-8")
    folder = coursework.open_course(small_course).folder
    with pytest.raises(BadCourse, match=r"names 'preface': exercises/book/preface\.en\.md is missing"):
        matter_of(folder, "en", "front")


def test_a_page_of_the_book_names_lessons_by_their_numbers(course):
    """What stands before the chapters names no lesson by a number that is written by hand."""
    pages = {
        (part.name, lang): part
        for lang in course.folder.languages
        for part in matter_of(course.folder, lang, "front")
    }
    plan = "\n".join(piece.text for piece in pages["use", "en"].pieces)
    last = len(course.folder.lessons)
    assert f"lesson {last} |" in plan
    for name, lang in pages:
        path = course.folder.book_place / f"{name}.{lang}.md"
        told = path.read_text(encoding="utf-8") if path.exists() else ""
        by_hand = re.findall(r"(?:lessons?|leçons?) \d+(?! ?\.)", told)
        assert {*by_hand} <= {"lesson 5", "leçon 5"}, path.name  # the one that explains numbers


def test_a_page_of_the_book_that_numbers_no_lesson_is_told(small_course):
    place = small_course / "exercises/book"
    place.mkdir()
    (place / "matter.toml").write_text('front = ["use"]\n')
    (place / "use.en.md").write_text("# Use\n\nSee lesson {=pinss}.\n")
    folder = coursework.open_course(small_course).folder
    with pytest.raises(BadCourse, match=r"book/use\.en\.md: no lesson 'pinss'"):
        matter_of(folder, "en", "front")
