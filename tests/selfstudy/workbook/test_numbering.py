"""Numbers of figures, tables, equations, examples, definitions and rules, and how paper cites what a link
leads to."""

from __future__ import annotations

import re

import pytest
from pdf_text import page_texts

import coursework
from coursework.errors import BadCourse
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.workbook.binding import bound
from coursework.selfstudy.workbook.lessons import lesson_text
from coursework.selfstudy.workbook.numbering import BoxRule, LessonNumbers, boxes_of
from coursework.sheets.book import BoxPiece, DrawnPiece, LaterPiece, ProsePiece, TablePiece

TEXT = """A [rod](#index "rod, rigid") is rigid:

$$ r = 1 $$

and that is all.

| a | b |
|---|---|
| 1 | 2 |

> **It turns** about a pin.

Another [rod](#index "rod, rigid"), and

$$ x = 2 ,
 y = 3 $$

Two rods.
"""


def test_what_a_lesson_shows_is_numbered_in_its_order():
    numbers = LessonNumbers(3, "en", (BoxRule("definition", "Rod, rigid", term="rod, rigid"),))
    assert list(numbers.prose(TEXT)) == [
        BoxPiece(
            "definition",
            "3.1",
            "Rod",
            'A [rod](#index "rod, rigid") is rigid:\n\n$$ r = 1 $$ (3.1)',
        ),
        ProsePiece("and that is all."),
        TablePiece("| a | b |\n|---|---|\n| 1 | 2 |", "3.1"),
        BoxPiece("rule", "3.1", "", "**It turns** about a pin."),
        ProsePiece('Another [rod](#index "rod, rigid"), and\n\n$$ x = 2 ,\n y = 3 $$ (3.2)\n\nTwo rods.'),
    ]
    (posed,) = numbers.example([ProsePiece("**Worked example: Pins.** Where?")])
    assert posed.text == "**Example 3.1 (worked): Pins.** Where?"


def test_every_box_that_the_course_states_finds_its_paragraph(course):
    """In each language, once; none is as long as half a page, or begins in the middle of a sentence."""
    missing = []
    for lang in course.folder.languages:
        for name in course.folder.lessons:
            text = (course.folder.lesson_place / f"{name}.{lang}.md").read_text("utf-8")
            prose = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
            paragraphs = re.split(r"\n\s*\n", prose)
            for box in boxes_of(course.folder, name, lang):
                fitting = [one for one in paragraphs if box.fits(one)]
                if not fitting or len(fitting[0]) > 900 or fitting[0].lstrip("*[$")[0].islower():
                    missing.append((lang, name, box))
                elif (
                    re.search(r", (?!in full|énoncé complet)|\(", title := box.head(fitting[0])) or not title
                ):
                    missing.append((lang, name, title))  # it is turned about, as in an index
    assert missing == []


LESSON = """# Rods

## 1. One

See [the second](lesson:rods#2) and [the pin](exercise:crank_pin).

$$ r = 1 $$

**Predict.** What?

```answer
One.
```

```python
import coursework

coursework.plot(("t", "s", [0, 1]), {"x": ("mm", [0, 1])}, lang="en")
```

**Explain.** Since it is one:

$$ x = 1 $$

On we go.

**Predict.** And then?

```answer
Two.
```

**Explain.** Why not three?

```answer
It is the next.
```

## 2. Two

A [rod](#index "rod") is rigid.
"""


@pytest.fixture
def small(small_course):
    settings = small_course / "exercises/course.toml"
    chapters = (
        '\n[[chapters]]\ntitle = { en = "Pins" }\n[[chapters.sections]]\nlesson = "rods"\nexercises = '
        '["crank_pin"]\n'
    )
    settings.write_text(settings.read_text("utf-8") + chapters, "utf-8")
    (small_course / "exercises/lessons").mkdir()
    (small_course / "exercises/lessons/rods.en.md").write_text(LESSON, "utf-8")
    (small_course / "exercises/book").mkdir()
    (small_course / "exercises/book/boxes.toml").write_text(
        '[rods]\ndefinitions = [{ en = "rod" }]\n', "utf-8"
    )
    return small_course


def test_paper_names_the_place_and_the_page_of_a_link(small):
    text = page_texts(
        renderer_of((course := coursework.open_course(small)).folder).book_pdf(bound(course, "en"))
    )
    whole = " ".join(" ".join(text).split())
    assert re.search(r"See the second \(§2, p. \d\) and the pin \(exercise 1\.1, p. \d\)\.", whole)
    assert re.search(r"\(1\.1\).*Definition1\.1\.RodArodisrigid", whole.replace(" ", ""))


def test_what_explains_a_prediction_stands_with_its_answer(small):
    lesson = lesson_text(coursework.open_course(small), "rods", "en")
    (_, (one, drawing, why)), (_, asked) = lesson.answers
    assert (one.text, why.text) == ("One.", "**Explain.** Since it is one:\n\n$$ x = 1 $$ (1.2)")
    assert isinstance(drawing, DrawnPiece), "it gives the answer away as well"
    assert [piece.text for piece in asked] == ["Two.", "**Explain.** Why not three?", "It is the next."]
    assert any(getattr(piece, "text", "").startswith("On we go.") for piece in lesson.pieces)
    assert sum(isinstance(piece, LaterPiece) for piece in lesson.pieces) == 2


def test_a_box_of_another_form_is_refused(small):
    (small / "exercises/book/boxes.toml").write_text('[rods]\nrules = [{ words = { en = "x" } }]\n', "utf-8")
    with pytest.raises(BadCourse, match=r"boxes\.toml: rods: write definitions"):
        boxes_of(coursework.open_course(small).folder, "rods", "en")
