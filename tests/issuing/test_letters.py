"""Names in any script: on sheets, in notes, in the names of files; and letters with signs above them."""

from __future__ import annotations

import itertools
import re
import unicodedata

import pytest
import typst
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from tables import each_row

from coursework.cli import run
from coursework.issuing.students import file_stems
from coursework.markup.markdown import SUBSTITUTE, drawable, typst_text
from coursework.rendering.pdf import compile_pdf
from coursework.rendering.renderer import builtin_renderer

DOCUMENT = '#set document(title: "t", date: auto)\n#set text(lang: "fr", font: "Libertinus Serif")\n'
PRINTED = [
    chr(c)
    for c in (*range(0x20, 0x3000), *range(0x1D400, 0x1D500))
    if drawable(chr(c)) == chr(c) and unicodedata.category(chr(c)) != "Cn"
]


def printed(text):
    """The PDF of a text; a character that no font has is refused by the standard of the file."""
    return compile_pdf(DOCUMENT + typst_text(text, "fr"))


def test_every_character_that_is_said_to_be_drawn_is_drawn():
    assert len(PRINTED) > 2500
    for start in range(0, len(PRINTED), 400):
        assert printed(" ".join(PRINTED[start : start + 400])).startswith(b"%PDF")


@each_row("name", ["Ὀδυσσεύς", "Ѓорѓи Ѣ", "Հայկ", "გიორგი", "Nguyễn Thị", "Łódź", "Əliyev"])
def test_names_in_the_scripts_of_the_fonts_at_hand_are_printed_whole(name):
    assert drawable(name) == name
    assert builtin_renderer().undrawn(name) == []
    printed(f"{name} {unicodedata.normalize('NFD', name)}")


@each_row("char", "李あ한ไمש😀")
def test_a_character_that_is_said_to_have_no_glyph_has_none_that_is_fit_to_print(char):
    assert drawable(f"a{char}b") == f"a{SUBSTITUTE}b"
    assert builtin_renderer().undrawn(f"{char}a{char}") == [char]
    if char not in "مש":  # drawn one by one, by a font that breaks their words
        with pytest.raises(typst.TypstError, match="could not be displayed"):
            typst.Compiler(ignore_system_fonts=True).compile(
                input=(DOCUMENT + char).encode(), format="pdf", pdf_standards=["ua-1"]
            )


@each_row("text", ["v\u20d7", "F\u20d7 = m a\u20d7", "ω\u20d7", "«v\u20d7» #a"])
def test_a_vector_s_arrow_is_printed_above_its_letter(text):
    """Each letter and its arrow come from the one font that has both."""
    source = drawable(typst_text(text, "fr"))
    assert SUBSTITUTE not in source
    assert source.count("New Computer Modern Math") == text.count("\u20d7")
    printed(text)


def test_an_arrow_without_a_letter_is_a_square():
    assert drawable(typst_text("щ\u20d7", "fr")) == f"щ{SUBSTITUTE}"


# ------------------------------------------------------------------------ fonts of a course


def font_of(letters, path):
    """A font that draws each of the letters as a box of its own."""
    path.parent.mkdir(parents=True, exist_ok=True)
    names = [".notdef", *(f"u{ord(c):x}" for c in letters)]
    pen = TTGlyphPen(None)
    for n, corner in enumerate([(50, 0), (50, 700), (650, 700), (650, 0)]):
        (pen.lineTo if n else pen.moveTo)(corner)
    pen.closePath()
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({ord(c): f"u{ord(c):x}" for c in letters})
    builder.setupGlyf(dict.fromkeys(names, pen.glyph()))
    builder.setupHorizontalMetrics(dict.fromkeys(names, (700, 50)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    family = {"familyName": "Course Font", "styleName": "Regular", "uniqueFontIdentifier": "course"}
    builder.setupNameTable({**family, "fullName": "Course Font Regular", "psName": "CourseFont-Regular"})
    builder.setupOS2()
    builder.setupPost()
    builder.save(path)


def build(course, tmp_path, name, capsys):
    (tmp_path / "class.csv").write_text("student\nAda\n李 明\n王 明\n", "utf-8")
    made = ["--roster", tmp_path / "class.csv", "--formats", "pdf", "--out", tmp_path / name]
    capsys.readouterr()
    assert run(["--course", str(course), "build", *map(str, made)]) == 0
    return capsys.readouterr().err, {
        p.name: p.read_bytes() for p in (tmp_path / name / "handouts").rglob("*.pdf")
    }


def test_build_names_the_students_whose_letters_no_font_has(small_course, tmp_path, capsys):
    said, files = build(small_course, tmp_path, "out", capsys)
    assert "2 names with letters that no font of the PDF has" in said
    assert "李 明 (李明), 王 明 (王明)" in said
    assert "Ada" not in said
    assert len(files) == 3


def test_a_font_in_the_course_s_templates_draws_what_the_others_lack(small_course, tmp_path, capsys):
    (small_course / "templates").mkdir(exist_ok=True)
    _, before = build(small_course, tmp_path, "before", capsys)
    font_of("李明", small_course / "templates" / "fonts" / "course.ttf")
    said, files = build(small_course, tmp_path, "after", capsys)
    assert "1 name with letters that no font of the PDF has, printed as squares: 王 明 (王)" in said
    assert files["ada.fr.pdf"] == before["ada.fr.pdf"]
    with_font = [name for name, data in files.items() if b"CourseFont" in data or b"Course Font" in data]
    assert len(with_font) == 2
    assert build(small_course, tmp_path, "again", capsys)[1] == files


def test_pages_and_notebooks_need_no_font(small_course, tmp_path, capsys):
    (tmp_path / "class.csv").write_text("student\n李 明\n", "utf-8")
    made = ["--roster", tmp_path / "class.csv", "--formats", "html", "--out", tmp_path / "out"]
    assert run(["--course", str(small_course), "build", *map(str, made)]) == 0
    assert "font" not in capsys.readouterr().err
    (page,) = (tmp_path / "out" / "handouts").rglob("*.html")
    assert "李 明" in page.read_text("utf-8")


# ------------------------------------------------------------------------ file names


def test_files_of_names_without_a_latin_letter_are_distinct_and_do_not_hang_on_the_roster():
    names = ["李 明", "王 明", "Иван", "Ναι", "😀"]
    stems = dict(zip(names, file_stems(names), strict=True))
    assert len(set(stems.values())) == len(names)
    assert all(re.fullmatch("student-[0-9a-f]{8}", stem) for stem in stems.values())
    for some in itertools.permutations(names, 3):
        assert file_stems(some) == [stems[name] for name in some]
    assert file_stems(["ИВАН"]) == [stems["Иван"]]
    assert file_stems(["Con", "Zoé", "zoe", ""]) == ["student-con", "zoe", "zoe-2", ""]
