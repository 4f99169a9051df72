"""A lesson's file read: its blocks, its links, and what is said of what is none."""

from __future__ import annotations

import pytest
from tables import each_row

from coursework.errors import BadCourse
from coursework.markup.links import TextLink, links, relinked
from coursework.selfstudy.workbook.lesson_source import (
    CodeCell,
    LessonAnswer,
    LessonImage,
    LessonProse,
    blocks,
)

TEXT = """# Rods

A [rod](#index) and [two rods](#index "rod, two").

![Two rods, $A$ and $B$](figure:two_rods)

```python {tags=shown}
x = 1
```

See [the exercise](exercise:crank_pin) and `[code](exercise:none)`.

```answer
It is $x = 1$.
```

```console
not a cell
```

![](exercise:crank_pin?seed=3&motion=velocity,coriolis)
"""


def test_a_lesson_is_read_into_its_blocks_in_order():
    found = blocks(TEXT, "rods.en.md")
    assert [type(one) for one in found] == [
        LessonProse,
        LessonImage,
        CodeCell,
        LessonProse,
        LessonAnswer,
        LessonProse,
        LessonImage,
    ]
    assert found[1] == LessonImage("Two rods, $A$ and $B$", "figure", "two_rods", {}, 5)
    assert found[2] == CodeCell("x = 1", ("shown",), 8)
    assert found[4] == LessonAnswer("It is $x = 1$.")
    assert "not a cell" in found[5].text
    assert found[6].asked == {"seed": "3", "motion": "velocity,coriolis"}


def test_nothing_of_a_text_is_lost():
    pieces = "".join(
        getattr(one, "text", getattr(one, "code", getattr(one, "caption", "")))
        for one in blocks(TEXT, "rods")
    )
    assert [
        word for word in ("Rods", "two rods", "x = 1", "It is", "not a cell", "See") if word not in pieces
    ] == []


@each_row(
    ("text", "told"),
    [
        ("\n```python {tags=show}\n```\n", r"rods, line 2: no tag 'show'; did you mean 'shown'"),
        ("\n\n![x](rods.png)\n", r"rods, line 3: the picture 'rods.png': write figure:NAME"),
    ],
)
def test_what_is_none_is_refused_with_its_line(text, told):
    with pytest.raises(BadCourse, match=told):
        blocks(text, "rods")


def test_links_are_found_and_written_anew_outside_code():
    assert links(TEXT) == (
        TextLink("rod", "term", "rod"),
        TextLink("two rods", "term", "rod, two"),
        TextLink("the exercise", "exercise", "crank_pin"),
    )
    assert links("[a\nb](lesson:rods#3)") == (TextLink("a b", "lesson", "rods", "3"),)
    written = relinked(TEXT, lambda link: link.said.upper())
    assert "A ROD and TWO RODS." in written
    assert "`[code](exercise:none)`" in written
    assert relinked("[a](https://example.org)", lambda link: "") == "[a](https://example.org)"
