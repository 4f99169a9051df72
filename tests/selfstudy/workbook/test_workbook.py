"""A course bound into a book: one PDF, pages, notebooks; what leads where, and what is given away."""

from __future__ import annotations

import base64
import json
import os
import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote_to_bytes

import nbformat
import pypdfium2
import pytest
from pdf_links import wrong_references
from pdf_text import page_texts

import coursework
from coursework.cli import run
from coursework.errors import BadCourse, BadInput, UnknownName
from coursework.language.words import languages
from coursework.rendering.books import typst_source
from coursework.rendering.pdf import source as sheet_source
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.workbook.binding import bound
from coursework.selfstudy.workbook.files import files, lesson_notebook
from coursework.selfstudy.workbook.lessons import faults, lesson_text
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.book import Book, BookChapter, BookExercise, BookSection
from coursework.sheets.handout import handout
from coursework.site.lessons.lesson_content import render_lesson

CHAPTERS = """
[[chapters]]
title = { en = "Pins", fr = "Pivots" }

[[chapters.sections]]
lesson = "rods"
exercises = ["crank_pin"]
"""

FIGURES = """
from coursework.figures import Figure, Picture, link, pin


def one_rod():
    return Figure(link(0, 100), pin(0, "A"), pin(100, "B"))


def turning_rod():
    import cmath
    return [Figure(link(0, 100 * cmath.exp(1j * k)), pin(0, "A")) for k in range(6)]


def no_rod():
    return Figure(link(0, 1 / 0))


def lost():
    return Picture("lost.svg")


def drawn_elsewhere():
    return Picture("mark.svg")
"""

LESSON = """# Rods & <pins>

A [rod](#index "rod") is rigid; [rods](#index "rod") turn about an [étai](#index "étai").

## What you will be able to do

Nothing less.

## 1. One rod

![A rod $AB$](figure:one_rod)

```python
import coursework

course = coursework.open_course("small")
predicted = {"length": None}
```

```python
print("told by the machine")
coursework.compare(predicted, {"length": 120}, "LANG")
```

```python
print("seen at once")
coursework.worked("crank_pin", seed=3, lang="LANG", level=2, course="small")
```

```python {tags=notebook}
raise SystemError("not for a book")
```

```python {tags=shown}
x = 41 + 1
x
```

```python {tags=still}
undefined_name
```

![A rod that turns](figure:turning_rod)

## 2. Two rods

Back to [section one](lesson:rods#1), on to [the pin](exercise:crank_pin).

**Question 1.** Is it?

```answer
It **is**, as $x = 42$.
```
"""


@pytest.fixture
def folder(small_course):
    settings = small_course / "exercises/course.toml"
    settings.write_text(settings.read_text("utf-8") + CHAPTERS, "utf-8")
    lessons = small_course / "exercises/lessons"
    lessons.mkdir()
    (lessons / "rods.py").write_text(FIGURES, "utf-8")
    for lang in ("en", "fr"):
        (lessons / f"rods.{lang}.md").write_text(LESSON.replace("LANG", lang), "utf-8")
    return small_course


@pytest.fixture
def small(folder):
    return coursework.open_course(folder)


def made(course, lang="en", **options):
    book = bound(course, lang, options.pop("seed", 0), solved=options.pop("solved", True))
    return {str(file.path): file.make() for file in files(course, book, **options)}


def test_a_lesson_is_told_run_and_drawn(small):
    told = lesson_text(small, "rods", "en")
    said = [f"{type(p).__name__.removesuffix('Piece')} {getattr(p, 'text', '')}" for p in told.pieces]
    assert (told.title, told.number) == ("Rods & <pins>", 1)
    assert "Head One rod" in said
    assert "Printed seen at once" in said
    assert "Printed 42" in said
    assert "Code x = 41 + 1\nx" in said
    assert "Code undefined_name" in said
    assert "Printed told by the machine" not in said
    assert [number for number, _ in told.answers] == [1, 2, 3]
    (outcome,), (right,), (own,) = (pieces for _, pieces in told.answers)
    assert outcome.text == "- length: 120\n- told by the machine"
    assert "$" in right.text
    assert own.text == "It **is**, as $x = 42$."
    still, moving = (
        p for p in told.pieces if type(p).__name__ == "DrawnPiece" and p.said.startswith("A rod")
    )
    assert still.figure is not None
    assert len(moving.stills) == 4
    assert "<animate" in moving.svg


def test_a_lesson_cites_its_figures_by_their_numbers(folder):
    path = folder / "exercises/lessons/rods.en.md"
    path.write_text(
        path.read_text("utf-8").replace("Back to", "See [the figure](figure:one_rod). Back to"), "utf-8"
    )
    small = coursework.open_course(folder)
    told = lesson_text(small, "rods", "en")
    cited = "See [figure 1.1](figure:rods#1.1). Back to"
    assert any(cited in getattr(piece, "text", "") for piece in told.pieces)
    page = made(small, formats=["html"])["pages/rods.html"].decode()
    assert '<a href="rods.html#figure-1.1">figure 1.1</a>' in page
    assert 'id="figure-1.1"' in page
    (address,) = re.findall(r'href="/lessons/rods\?whole#(figure-1\.1)"', _on_the_site(small))
    assert f'id="{address}"' in _on_the_site(small)


def _on_the_site(course):
    return "".join(step.html for step in render_lesson(course, "rods", "en").steps)


def test_a_lesson_leaves_nothing_behind(small, tmp_path, monkeypatch):
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    lesson_text(small, "rods", "en")
    assert Path.cwd() == here
    assert list(here.iterdir()) == []


def test_the_pdf_has_contents_lessons_exercises_solutions_and_an_index(small):
    pdf = made(small, formats=["pdf"])["workbook.en.pdf"]
    wrong, count = wrong_references(pdf)
    assert (wrong, count > 1) == ([], True)
    text = page_texts(pdf)
    whole = "".join("".join(text).split())
    assert "Contents" in text[1]
    for part in (
        "Chapter1.Pins",
        "Lesson1.Rods&<pins>",
        "Exercise1.1.",
        "1.Onerod",
        "Arodthatturns",
        "Solutions",
        "Indexofterms",
    ):
        assert part in whole, part
    assert "notforabook" not in whole
    assert whole.index("seenatonce") < whole.index("toldbythemachine")
    # Sorted without accents: étai before rod, each with its page.
    assert re.search(r"étai,\d+rod,\d+", whole[whole.rindex("Indexofterms") :])


def test_the_same_course_language_and_seed_give_the_same_bytes(small):
    first, second = made(small, "fr"), made(small, "fr")
    assert first == second
    other = made(small, "fr", seed=1)
    assert other["pages/crank_pin.html"] != first["pages/crank_pin.html"]
    assert other["pages/rods.html"] == first["pages/rods.html"]


#: Words that lead back to another question, in a list or a drill to none; an instant or a position is that of
#: the figure. A noun that says nothing without what it is of.
CLIPPED = re.compile(r"\b(component|coefficient|side|number|composante|membre|nombre|norme|magnitude)$", re.I)
REFERRING = {
    "en": re.compile(
        r"^(Its|Their|Likewise)\b|\b(same|these|those|they|them|with it|[Nn]umber of its|which it)\b"
        r"|\bthat (velocity|equation|instant)\b"
    ),
    "fr": re.compile(
        r"^(Son|Sa|Ses|De même)\b|\b(même|ces|elles?|eux|de (?:ses|son|sa))\b|\bcette (?!position)"
        r"|\bcet (?!instant)|\bauquel il\b"
    ),
}


def test_the_list_of_symbols_has_the_same_symbols_in_every_language(course):
    """Over all exercises: a symbol that one language's first clause lacks is missing from its list. Each
    meaning stands alone."""
    listed = []
    for lang in languages():
        asked = [
            BookExercise(str(k), handout(course[name].variant(3, lang)), None)
            for k, name in enumerate(course.folder.names)
        ]
        book = Book(lang, "", 0, (BookChapter(1, "", (BookSection(None, tuple(asked)),)),), True)
        assert all(row.meaning[0].isupper() for row in book.symbols)
        assert [row for row in book.symbols if REFERRING[lang].search(row.meaning)] == []
        assert [row for row in book.symbols if CLIPPED.search(row.meaning)] == [], "of what?"
        write = course.folder.symbols("en")
        found = {(row.symbol, one.handout.exercise) for row in book.symbols for one in row.exercises}
        listed.append({(write(symbol), name) for symbol, name in found})
    first, second = listed
    assert first ^ second == set()
    assert len(first) > len(course.folder.names)


@pytest.mark.slow
@pytest.mark.parametrize("lang", languages())
def test_paper_prints_the_symbols_that_equations_are_typed_with(course, lang):
    """Nobody types on paper: a code that is the name of a symbol is printed as this symbol."""
    typed = [name for name in course.folder.names if any(part.variables for part in course[name].spec.parts)]
    asked = tuple(
        BookExercise(str(k), handout(variant), answer_sheet(variant))
        for k, variant in enumerate(course[name].variant(3, lang) for name in typed)
    )
    book = Book(lang, "", 0, (BookChapter(1, "", (BookSection(None, asked),)),), True)
    folders = renderer_of(course.folder).template_folders
    names = {name for one in typed for part in course[one].spec.parts for name in part.variables}
    assert {"phi_dot", "theta3"} <= names
    for source in (typst_source(folders, book), sheet_source(folders, [one.handout for one in asked])):
        codes = set(re.findall(r'#raw\("(.*?)"\)', source))
        assert codes & names == set()
        assert "dot(ϕ)" in source
    page = renderer_of(course.folder).html(asked[0].handout)
    assert any(f"<code>{name}</code>" in page for name in names), "where one types, the names stay"


class _Pages(HTMLParser):
    """The places that a page leads to, and those that it has."""

    def __init__(self, page: str):
        super().__init__()
        self.hrefs, self.ids = [], []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        named = dict(attrs)
        self.hrefs += [named["href"]] if tag == "a" and "href" in named else []
        self.ids += [named["id"]] if "id" in named else []


@pytest.mark.parametrize(
    ("solutions", "place"), [("end", "pages/solutions"), ("none", None), ("apart", "solutions")]
)
def test_every_link_of_the_pages_leads_to_a_place_that_is_there(small, solutions, place):
    asked = {"solved": solutions == "end", "apart": solutions == "apart"}
    found = {path: _Pages(text.decode()) for path, text in made(small, formats=["html"], **asked).items()}
    assert {f"pages/{one}.html" for one in ("index", "symbols", "terms", "rods", "crank_pin")} <= set(found)
    solved = [path for path in found if "solutions/" in path]
    assert solved == ([f"{place}/crank_pin.html"] if place else [])
    for path, page in found.items():
        assert len(set(page.ids)) == len(page.ids)
        for href in page.hrefs:
            file, _, place = href.partition("#")
            target = path if not file else os.path.normpath(Path(path).parent / file).replace(os.sep, "/")
            assert target in found, href
            assert not place or place in found[target].ids, href


def test_every_link_of_the_notebooks_leads_to_a_notebook_beside_it(small):
    books = {path: nbformat.reads(text.decode(), 4) for path, text in made(small, formats=["ipynb"]).items()}
    assert set(books) == {"notebooks/rods.en.ipynb", "notebooks/crank_pin.en.ipynb"}
    links = {
        link
        for book in books.values()
        for cell in book.cells
        if cell.cell_type == "markdown"
        for link in re.findall(r"\]\(([^()#]+\.ipynb)", cell.source)
    }
    assert links == {"rods.en.ipynb", "crank_pin.en.ipynb"}


def test_a_notebook_holds_its_pictures_and_folds_its_answers(small):
    cells = json.loads(lesson_notebook(small, "rods", "en"))["cells"]
    pictures = [mime for cell in cells for p in cell.get("attachments", {}).values() for mime in p]
    assert pictures == ["image/png", "image/svg+xml"]
    png = next(p for cell in cells for p in cell.get("attachments", {}).values() if "image/png" in p)
    assert base64.b64decode(png["image/png"])[:8] == b"\x89PNG\r\n\x1a\n"
    text = "".join("".join(c["source"]) for c in cells if c["cell_type"] == "markdown")
    assert "<details><summary>Answer</summary>\n\nIt **is**" in text
    assert "#index" not in text
    assert "Exercises of this lesson" in text


def test_what_is_given_away_has_no_solution_where_they_stand_apart(small):
    found = made(small, formats=["pdf", "html"], solved=False, apart=True)
    assert set(found) >= {"workbook.en.pdf", "solutions.en.pdf", "solutions/crank_pin.html"}
    assert "Solutions" not in "".join(page_texts(found["workbook.en.pdf"]))
    assert "Solutions" in "".join(page_texts(found["solutions.en.pdf"]))
    assert not any(b"solutions/" in text for path, text in found.items() if path.startswith("pages/"))


def test_the_contents_of_solutions_apart_name_each(small):
    text = page_texts(made(small, formats=["pdf"], solved=False, apart=True)["solutions.en.pdf"])
    assert re.search(r"Solutions.*1\.1\. ", " ".join(text[1].split()))


def test_a_section_without_a_lesson_bears_its_title(folder):
    settings = folder / "exercises/course.toml"
    was = 'lesson = "rods"\n'
    now = f'{was}\n[[chapters.sections]]\ntitle = {{ en = "More & more", fr = "Encore" }}\n'
    settings.write_text(settings.read_text("utf-8").replace(was, now), "utf-8")
    found = made(coursework.open_course(folder), formats=["pdf", "html"])
    assert '<li class="section">More &amp; more</li>' in found["pages/index.html"].decode()
    pages = page_texts(found["workbook.en.pdf"])
    assert [k for k, page in enumerate(pages) if "More & more" in page][:1] == [1]
    assert sum("More & more" in page for page in pages) == 2


def test_a_chapter_may_be_an_appendix(folder):
    settings = folder / "exercises/course.toml"
    titled = '[[chapters]]\ntitle = { en = "Pins"'
    now = settings.read_text("utf-8").replace(titled, titled.replace("\n", "\nappendix = true\n"))
    settings.write_text(now, "utf-8")
    found = made(coursework.open_course(folder), formats=["pdf", "html"])
    assert "<h2>A. Pins</h2>" in found["pages/index.html"].decode()
    text = " ".join(page_texts(found["workbook.en.pdf"]))
    assert "Appendix A. Pins" in text
    assert "Chapter 1" not in text


def test_no_page_ends_with_what_stands_above_other_lines(folder):
    """A heading in bold and a line that announces others go to the next page with them."""
    path = folder / "exercises/lessons/rods.en.md"
    told = "".join(
        f"{'Words ' * (1 + 13 * k % 37)}.\n\n**Solution.**\n\n- one\n- two\n\nWhat follows:\n\n- three\n\n"
        for k in range(90)
    )
    path.write_text(path.read_text("utf-8").replace("**Question 1.**", told + "**Question 1.**"), "utf-8")
    pdf = made(coursework.open_course(folder), formats=["pdf"])["workbook.en.pdf"]
    texts = [page.get_textpage().get_text_bounded() for page in pypdfium2.PdfDocument(pdf)]
    # Below the last line stands the footer.
    ends = [text.splitlines()[-2].strip() for text in texts if "Solution." in text]
    assert len(ends) > 10
    assert {"Solution.", "What follows:"} & {*ends} == set()


def test_a_word_that_is_longer_than_a_line_is_broken(folder):
    """On one line it would run off the paper, all on one page."""
    path = folder / "exercises/lessons/rods.en.md"
    path.write_text(path.read_text("utf-8").replace("x = 41 + 1", "x = 9000 * 'W'"), "utf-8")
    pages = page_texts(made(coursework.open_course(folder), formats=["pdf"])["workbook.en.pdf"])
    counts = [page.count("W") for page in pages]
    assert sum(counts) >= 9000
    assert max(counts) < 7000


def test_a_book_prints_no_variant_that_a_class_is_given(small):
    book = bound(small, "en")
    assert [one.handout.seed >= 500_000 for one in book.exercises] == [True]


@pytest.mark.parametrize(
    ("was", "now", "told"),
    [
        (
            "lesson:rods#1",
            "lesson:rods#7",
            "line 47: a link to section 7 of rods, which does not exist; available: 1, 2",
        ),
        (
            "lesson:rods#1",
            "lesson:rod",
            "line 47: a link to the lesson 'rod', which does not exist; did you mean 'rods'",
        ),
        ("exercise:crank_pin)", "exercise:crank_pim)", "line 47: a link to the exercise 'crank_pim'"),
        (
            "(exercise:crank_pin)",
            "(exercice:crank_pin)",
            "line 47: the link 'exercice:crank_pin' leads nowhere",
        ),
        ('#index "étai"', '#indx "étai"', "line 3: the link '#indx' leads nowhere"),
        ("It **is**", "It [is](lesson:rod)", "line 52: a link to the lesson 'rod'"),
        ("as $x = 42$", "as $x = 42", "line 52: the paragraph “It **is**, as $x = 42.” has 1 $"),
        ("as $x = 42$", r"as $x = \thetaa$", "line 52: formula $x = \\thetaa$"),
        ("(figure:one_rod)", "(figure:one_rod) and more", "line 11: a picture stands on a line of its own"),
        ("(figure:one_rod)", "(figure:one rod)", "line 11: a picture stands on a line of its own"),
        ("figure:one_rod", "figure:one_road", "line 11: no figure 'one_road'; did you mean 'one_rod'"),
        ("figure:one_rod", "figure:link", "line 11: the figure link fails: TypeError"),
        (
            "figure:one_rod",
            "figure:no_rod",
            "line 11: the figure no_rod fails in line 15 of rods.py: ZeroDivisionError",
        ),
        ("figure:one_rod", "figure:lost", "line 11: no picture"),
        ("figure:turning_rod", "exercise:crank_pin?sed=1", "line 43: a picture has no option 'sed'"),
        ("figure:one_rod", "figure:one_rod?tal=90", "line 11: a picture has no option 'tal'"),
        ("figure:one_rod", "figure:one_rod?tall=high", "line 11: the height of a picture is a whole number"),
        ("It **is**", "It is ${=sweep}$", "line 52: values() of rods.py has no 'sweep'"),
        ("![A rod that turns]", "![]", "line 43: the figure turning_rod has no caption"),
        ("level=2", "level=9", "line 27: a worked example has a level from 0"),
        ("x = 41 + 1", "x = 41 + y", "line 35: NameError"),
        ("x = 41 + 1", "x = 41 +", "line 35: the cell is not Python: invalid syntax"),
        ("x = 41 + 1", "raise SystemExit", "line 35: the cell ends Python"),
        ("x = 41 + 1", "x = object()", "line 35: the cell shows '<object object at 0x"),
        ("x = 41 + 1", "import os; x = os.getcwd()", "line 35: the cell shows "),
        (
            "x = 41 + 1",
            "x = '\\n'.join('abc' * 100)",
            "line 35: the cell prints 300 lines; a book has room for 200",
        ),
        ("```answer", "```anwser", "line 51: no fence 'anwser'; did you mean 'answer'?"),
        ("```python {tags=still}", "```python {tag=still}", "line 39: a fence opens with a word"),
        (
            "x = 41 + 1\nx\n```",
            "x = 41 + 1\nx\n",
            "line 34: the fence that opens here is not closed before line 39",
        ),
        ("42$.\n```", "42$.\n", "line 51: the fence that opens here is never closed"),
        ("# Rods & <pins>\n", "", "line 1: a lesson begins with its title"),
        ("## 2. Two rods", "# 2. Two rods", "line 45: a lesson has one title"),
        ("## 2. Two rods", "## 1. Two rods", "line 45: section 1 stands twice"),
    ],
)
def test_what_is_wrong_in_a_lesson_is_said_with_its_place(folder, was, now, told):
    path = folder / "exercises/lessons/rods.en.md"
    text = path.read_text("utf-8")
    assert was in text
    path.write_text(text.replace(was, now), "utf-8")
    course = coursework.open_course(folder)
    with pytest.raises(BadCourse) as caught:
        lesson_text(course, "rods", "en")
    assert f"exercises/lessons/rods.en.md, {told}" in str(caught.value)
    assert len(faults(course, "rods")) == 1


def test_a_lesson_shows_a_picture_that_lies_beside_it(folder):
    lessons = folder / "exercises/lessons"
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="30"><circle cx="20" cy="15" r="9"/></svg>'
    )
    (lessons / "mark.svg").write_text(svg, "utf-8")
    path = lessons / "rods.en.md"
    path.write_text(path.read_text("utf-8").replace("figure:one_rod", "figure:drawn_elsewhere"), "utf-8")
    course = coursework.open_course(folder)
    page = made(course, formats=["html"])["pages/rods.html"]
    shown = [unquote_to_bytes(one) for one in re.findall(rb'svg\+xml,([^"]+)"', page)]
    assert any(b'cx="20"' in one for one in shown)
    assert made(course, formats=["pdf"])["workbook.en.pdf"][:5] == b"%PDF-"


def test_what_a_cell_writes_or_keeps_stays_out_of_the_folders_and_of_the_book(folder):
    """A session of self-study keeps a file, which another run would read."""
    path = folder / "exercises/lessons/rods.en.md"
    study = 'study = coursework.study("crank_pin", seed=1, lang="en", course="small")'
    writes = (
        f"from pathlib import Path\nPath('left.txt').write_text('x')\n{study}\nstudy.check({{'x': '1 "
        f"mm'}})\nx = 42"
    )
    path.write_text(path.read_text("utf-8").replace("x = 41 + 1", writes), "utf-8")
    before = sorted(folder.parent.iterdir())
    course = coursework.open_course(folder)
    first = lesson_text(course, "rods", "en")
    assert sorted(folder.parent.iterdir()) == before
    assert lesson_text(course, "rods", "en") == first


def test_signs_that_no_page_shows_are_left_out_of_what_a_cell_prints(folder):
    path = folder / "exercises/lessons/rods.en.md"
    path.write_text(path.read_text("utf-8").replace("x = 41 + 1", r"x = 'a\x1b[31m b\x00'"), "utf-8")
    course = coursework.open_course(folder)
    assert "a b" in [getattr(one, "text", "") for one in lesson_text(course, "rods", "en").pieces]


def test_a_text_in_another_encoding_is_told(folder, capsys):
    (folder / "exercises/lessons/rods.fr.md").write_bytes("# Étais\n".encode("latin-1"))
    assert run(["--course", str(folder), "lesson", "--check"]) == 1
    assert "rods.fr.md is not written in UTF-8, from byte 2 on" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("crank_pin", "is an exercise as well"),
        ("index", "is a page of every book as well"),
        ("two rods", "two_rods.LANG.md"),
        ("2-rods", "lesson_2_rods.LANG.md"),
    ],
)
def test_a_name_that_no_lesson_can_have_is_told(folder, name, told, capsys):
    lessons = folder / "exercises/lessons"
    for lang in ("en", "fr"):
        (lessons / f"{name}.{lang}.md").write_text("# Two rods\n", "utf-8")
    for command in (["lesson", "--check"], ["workbook", "--lang", "en", "--out", str(folder / "out")]):
        assert run(["--course", str(folder), *command]) == 1 + (command[0] == "workbook")
        assert told in "".join(capsys.readouterr())


def test_a_name_may_have_letters_of_any_language(folder):
    lessons = folder / "exercises/lessons"
    (lessons / "épure.en.md").write_text("# Épure\n\n## 1. See\n\nSee [one](lesson:épure#1).\n", "utf-8")
    course = coursework.open_course(folder)
    found = made(course, formats=["pdf", "html"])
    assert found["workbook.en.pdf"][:5] == b"%PDF-"
    assert 'href="%C3%A9pure.html#section-1"' in found["pages/épure.html"].decode()


def test_an_exercise_that_would_take_the_contents_place_is_told(folder):
    for path in [*folder.glob("*/crank_pin.*")]:
        path.rename(path.with_name(path.name.replace("crank_pin", "index")))
    settings = folder / "exercises/course.toml"
    settings.write_text(settings.read_text("utf-8").replace("crank_pin", "index"), "utf-8")
    with pytest.raises(BadCourse, match="the exercise index has a name that is a page of every book"):
        bound(coursework.open_course(folder), "en")


@pytest.mark.parametrize(
    ("was", "now", "told"),
    [
        (', fr = "Pivots"', "", "chapter 1 has no title in 'fr'"),
        (
            "exercises = [",
            'exercises = []\n\n[[chapters.sections]]\ntitle = { fr = "Un" }\nexercises = [',
            "section 2 has no title in 'en'",
        ),
        (
            "[[chapters]]",
            '[lessons]\ncrank_pin = "rod"\n\n[[chapters]]',
            "[lessons]: crank_pin: no lesson 'rod'",
        ),
    ],
)
def test_the_check_reads_the_order_of_the_course_as_well(folder, was, now, told, capsys):
    settings = folder / "exercises/course.toml"
    text = settings.read_text("utf-8")
    assert was in text
    settings.write_text(text.replace(was, now), "utf-8")
    assert run(["--course", str(folder), "lesson", "--check"]) == 1
    assert told in capsys.readouterr().out


def test_the_check_goes_on_where_a_language_is_missing(folder, capsys):
    lessons = folder / "exercises/lessons"
    (lessons / "rods.fr.md").unlink()
    (lessons / "pins.en.md").write_text("# Pins\n\n[x](lesson:rod)\n", "utf-8")
    assert run(["--course", str(folder), "lesson", "--check"]) == 1
    told = capsys.readouterr().out
    assert "rods, fr: the lesson rods has no text in 'fr': exercises/lessons/rods.fr.md is missing" in told
    assert "pins, en: exercises/lessons/pins.en.md, line 3: a link to the lesson 'rod'" in told
    assert run(["--course", str(folder), "lesson", "--check", "rod"]) == 2
    assert "no lesson 'rod'" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["lesson", "workbook"])
def test_a_book_is_in_one_language_that_there_is(folder, command, capsys):
    out = folder / "out"
    assert run(["--course", str(folder), command, "--lang", "en,fr", "--out", str(out)]) == 2
    assert "no language 'en,fr'; available: en, fr" in capsys.readouterr().err
    assert not out.exists()


def test_lessons_that_differ_between_languages_are_told(folder, capsys):
    path = folder / "exercises/lessons/rods.fr.md"
    path.write_text(path.read_text("utf-8").partition("**Question")[0], "utf-8")
    assert run(["--course", str(folder), "lesson", "--check"]) == 1
    assert "rods is not the same in every language" in capsys.readouterr().out


def test_the_command_writes_all_and_says_what_to_open(folder, tmp_path, capsys):
    out = tmp_path / "book"
    assert run(["--course", str(folder), "workbook", "--lang", "en", "--out", str(out)]) == 0
    assert "workbook.en.pdf, pages/index.html, notebooks/" in capsys.readouterr().out
    assert (out / "pages/solutions/crank_pin.html").exists()
    assert run(["--course", str(folder), "workbook", "--chapters", "4", "--out", str(tmp_path / "b")]) == 2
    assert "no chapter 4; available: 1" in capsys.readouterr().err


def test_chapters_and_formats_that_are_none_are_refused(small):
    with pytest.raises(BadInput, match="no chapter 3"):
        bound(small, "en", chapters=[3])
    with pytest.raises(UnknownName, match="format"):
        list(files(small, bound(small, "en"), ["docx"]))


def test_a_course_without_chapters_is_bound_as_well(small_course):
    course = coursework.open_course(small_course)
    (chapter,) = bound(course, "fr").chapters
    assert [one.handout.exercise for one in chapter.exercises] == ["crank_pin"]
    assert renderer_of(course.folder).book_pdf(bound(course, "fr"))[:5] == b"%PDF-"


def test_pages_fit_a_telephone_and_print_what_is_folded(small):
    """The rule for narrow screens must weigh more than the one that it takes back, ``.columns-4``; a folded
    answer is no gap on paper."""
    found = made(small, formats=["html"])
    narrow = re.search(
        r"@media \(max-width: 40rem\) \{(.*?\})\s*\}", found["pages/crank_pin.html"].decode(), re.DOTALL
    )
    assert re.search(r"fieldset\[class\] \{ grid-template-columns: minmax\(0, 1fr\); \}", narrow[1])
    printed = re.search(
        r"@media print \{\s*nav\.book(.*?\})\s*\}", found["pages/rods.html"].decode(), re.DOTALL
    )
    assert "details::details-content { content-visibility: visible; block-size: auto; }" in printed[1]


def test_the_notebooks_of_a_chapter_lead_to_one_another_alone(folder):
    (folder / "exercises/lessons/pins.en.md").write_text("# Pins\n", "utf-8")
    path = folder / "exercises/lessons/rods.en.md"
    path.write_text(path.read_text("utf-8").replace("(lesson:rods#1)", "(lesson:pins)"), "utf-8")
    course = coursework.open_course(folder)
    for chapters, expected in (((), {"pins", "crank_pin"}), ((1,), {"crank_pin"})):
        book = bound(course, "en", chapters=chapters)
        written = {str(file.path): file.make().decode() for file in files(course, book, ["ipynb"])}
        assert set(re.findall(r"\]\((\w+)\.en\.ipynb", written["notebooks/rods.en.ipynb"])) == expected


def test_the_lesson_of_the_documentation_passes_its_check(tmp_path, capsys):
    page = Path(__file__).parents[3] / "docs/workbook.md"
    text = page.read_text("utf-8")
    lesson = re.search(r"^````markdown\n(.*?)^````$", text, re.DOTALL | re.MULTILINE)[1]
    (module,) = [
        one
        for one in re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
        if "def circle" in one
    ]
    mine = tmp_path / "mine"
    assert run(["new", str(mine), "--lang", "en"]) == 0
    exercise = mine / "exercises/crank_pin.py"
    driven = exercise.read_text("utf-8").replace("import Exercise", "import Driver, Exercise")
    driven = driven.replace("figure=figure,", 'figure=figure,\n    driver=Driver("theta", speed="omega"),')
    exercise.write_text(driven, "utf-8")
    lessons = mine / "exercises/lessons"
    lessons.mkdir()
    (lessons / "pins.en.md").write_text(lesson, "utf-8")
    (lessons / "pins.py").write_text(module, "utf-8")
    assert run(["--course", str(mine), "lesson", "--check"]) == 0, capsys.readouterr()
