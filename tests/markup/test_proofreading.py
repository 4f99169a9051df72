"""A text that no sheet could print as it was meant is refused where it stands, and no other."""

from __future__ import annotations

import pytest
from tables import each_row

import coursework
from coursework.cli import run
from coursework.errors import BadStatement
from coursework.markup.proofreading import pair_dollars

STATEMENT = "exercises/crank_pin.en.md.j2"


def changed(course, file, old, new):
    path = course / file
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")


@pytest.mark.parametrize(
    ("file", "old", "new", "line"),
    [
        (STATEMENT, "crank $OA$", "crank $OA", 3),
        (STATEMENT, "pin $A$.\n\n## y", "pin A$.\n\n## y", 7),
        ("solutions/crank_pin.en.md.j2", "radius $r$", "radius r$", 6),
        (STATEMENT, "crank $OA$", r"crank $\foo$", 3),
        (STATEMENT, "with the $x$ axis", r"with the $\foo$ axis", 4),
        ("solutions/crank_pin.en.md.j2", "radius $r$", r"radius $\foo$", 6),
    ],
)
def test_a_dollar_alone_and_an_unknown_macro_are_told_with_file_and_line(small_course, file, old, new, line):
    changed(small_course, file, old, new)
    variant = coursework.open_course(small_course)["crank_pin"].variant(0, "en")
    with pytest.raises(BadStatement, match=f"^{file}, line {line}: "):
        variant.answer_sheet()


def test_a_template_tells_the_line_too_where_it_can(small_course):
    changed(small_course, STATEMENT, "crank $OA$", "crank $OA long {{ r }}")
    with pytest.raises(BadStatement, match=f"^{STATEMENT}, line 3: .*has 11 [$]"):
        coursework.open_course(small_course)["crank_pin"].variant(0, "en").handout()
    changed(small_course, STATEMENT, "A crank $OA", "A {{ r }} crank $OA")
    with pytest.raises(BadStatement, match=f"^{STATEMENT}: .*has 11 [$]"):
        coursework.open_course(small_course)["crank_pin"].variant(0, "en").handout()


def test_check_and_show_refuse_a_dollar_alone(small_course, capsys):
    changed(small_course, STATEMENT, "crank $OA$", "crank $OA")
    assert run(["--course", str(small_course), "show", "crank_pin", "--lang", "en"]) == 2
    assert f"{STATEMENT}, line 3" in capsys.readouterr().err
    assert run(["--course", str(small_course), "check", "--variants", "2"]) == 1
    assert f"{STATEMENT}, line 3" in capsys.readouterr().out


@each_row(
    "text",
    [
        r"It costs \$5.",
        r"It costs $\$5$ and $x$.",
        "The shell says `$`, and ``a `$` b``.",
        "```\n$ coursework list\n```\nThat is all.",
        "$$\nx = y\n\n$$",
        "- one: $x$\n- two: $y$",
    ],
)
def test_what_is_no_formula_needs_no_partner(text):
    pair_dollars(text, lambda piece: piece)


def test_two_items_of_a_list_do_not_lend_each_other_a_dollar():
    with pytest.raises(BadStatement, match=r"“- one: x[$]”"):
        pair_dollars("Which one?\n- one: x$\n- two: $y", lambda piece: "here")


def test_a_text_and_a_course_file_may_begin_with_a_byte_order_mark(small_course):
    for file in (STATEMENT, "exercises/course.toml", "solutions/crank_pin.en.md.j2"):
        path = small_course / file
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    changed(small_course, STATEMENT, "makes the angle", "has {{ r }} and makes the angle")
    sheet = coursework.open_course(small_course)["crank_pin"].variant(0, "en").answer_sheet()
    assert sheet.handout.title == "A crank pin"
    assert sheet.handout.course == "My course"
