"""What is printed stands where the layout says, and its codes are read back."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from itertools import product

import numpy as np
import pypdfium2
import pytest
import zxingcpp
from course_of_every_kind import write_course
from sweeps import sampled
from tables import each_row

from coursework import open_course
from coursework.cli import run
from coursework.course.builtin import builtin_root
from coursework.issuing.answer_papers import answer_papers
from coursework.rendering.codes import qr_modules
from coursework.rendering.pdf import source
from coursework.rendering.renderer import builtin_renderer
from coursework.sheets.answer_pages import MARK, SIZES, Box, answer_pages, paper_code

PER_MM = 20.0  #: pixels
TEMPLATES = [builtin_root() / "templates"]


def handout(course, name, lang="en", size="a4", student="Zoé Lemaître"):
    variant = course[name].variant(1, lang)
    code = paper_code("", student, 1, [variant.record], size)
    return replace(variant.handout(student), answer_pages=answer_pages([variant], lang, size, code))


def pictures(pdf, per_mm=PER_MM):
    """The pages as arrays of darkness, 0 for white and 1 for black."""
    document = pypdfium2.PdfDocument(pdf)
    for page in document:
        grey = page.render(scale=per_mm * 25.4 / 72, grayscale=True).to_numpy()
        yield 1 - grey.reshape(grey.shape[:2]) / 255.0


def answer_pictures(pdf, count, per_mm=PER_MM):
    return list(pictures(pdf, per_mm))[-count:]


def line_at(picture, along, at, across, reach=0.45):
    """Where a line is, mm: the middle of what is dark within ``reach`` of a place, on a cut through the
    page."""
    first, last = round((at - reach) * PER_MM), round((at + reach) * PER_MM)
    if along == "x":
        strip = picture[round(across * PER_MM), first:last]
    else:
        strip = picture[first:last, round(across * PER_MM)]
    assert strip.max() > 0.1, f"no line at {along} = {at}"
    dark = np.where(strip > 0.5 * strip.max(), strip, 0)
    return (first + 0.5 + np.average(np.arange(len(dark)), weights=dark)) / PER_MM


def edges(box: Box):
    """The sides of a box that nothing else touches: which way they are met, where, and the cut."""
    yield "x", box.x, box.y + 0.3 * box.height
    yield "x", box.right, box.y + 0.3 * box.height
    yield "y", box.y, box.x + 0.3 * box.width
    yield "y", box.bottom, box.x + 0.3 * box.width


def outlined(page):
    yield from page.guide
    for field in page.fields:
        yield from (*field.digits, *field.decimals, *field.power, *(box for _, box in field.ticks))
        yield from (b for b in (field.sign, field.power_sign, field.unit, field.free) if b)
        if field.what == "drawing":
            yield field.whole


def dark_box(picture, box: Box, around=1.0):
    """What is dark about a box, mm: its four sides."""
    top, left = round((box.y - around) * PER_MM), round((box.x - around) * PER_MM)
    bottom, right = round((box.bottom + around) * PER_MM), round((box.right + around) * PER_MM)
    rows, columns = np.nonzero(picture[top:bottom, left:right] > 0.5)
    return [
        (left + columns.min()) / PER_MM,
        (top + rows.min()) / PER_MM,
        (left + columns.max() + 1) / PER_MM,
        (top + rows.max() + 1) / PER_MM,
    ]


@pytest.mark.parametrize(
    ("name", "lang", "size"),
    [
        ("two_circles", "fr", "a4"),
        pytest.param("joint_twist", "en", "letter", marks=pytest.mark.slow),
        pytest.param("ball_reducer", "fr", "letter", marks=pytest.mark.slow),
        pytest.param("crank_shaper_drawn", "en", "a4", marks=pytest.mark.slow),
        pytest.param("vocabulary", "fr", "a4", marks=pytest.mark.slow),
    ],
)
@pytest.mark.e2e
def test_a_printed_page_is_its_layout_to_a_tenth_of_a_millimetre(course, name, lang, size):
    sheet = handout(course, name, lang, size)
    printed = answer_pictures(builtin_renderer().on(size).pdf(sheet), len(sheet.answer_pages))
    for page, picture in zip(sheet.answer_pages, printed, strict=True):
        assert picture.shape == pytest.approx((page.height * PER_MM, page.width * PER_MM), abs=2)
        for box in outlined(page):
            for along, at, across in edges(box):
                assert line_at(picture, along, at, across) == pytest.approx(at, abs=0.1)
        for x, y in page.marks:
            square = Box(x - MARK / 2, y - MARK / 2, MARK, MARK)
            wanted = [square.x, square.y, square.right, square.bottom]
            assert dark_box(picture, square) == pytest.approx(wanted, abs=0.1)
        code = [page.code.x, page.code.y, page.code.right, page.code.bottom]
        assert dark_box(picture, page.code) == pytest.approx(code, abs=0.1)


def codes_on(picture):
    grey = np.ascontiguousarray(np.round(255 * (1 - picture)), dtype=np.uint8)
    return [(one.text, one.ec_level) for one in zxingcpp.read_barcodes(grey)]


@pytest.mark.parametrize("printed", sampled(product(["fr", "en"], SIZES), [("en", "letter")]), ids="-".join)
def test_every_page_says_which_it_is_at_150_dots_an_inch(course, printed):
    lang, size = printed
    sheet = handout(course, "slider_extras", lang, size)
    made = builtin_renderer().on(size).pdf(sheet)
    pages = sheet.answer_pages
    assert len(pages) > 1
    found = [codes_on(picture) for picture in pictures(made, 150 / 25.4)]
    assert found[-len(pages) :] == [[(page.code_text, "Q")] for page in pages]
    code = pages[0].code_text.split()[1]
    statement = [codes for codes in found[: -len(pages)] if codes]
    assert statement == [[(f"CW1 {code} 0/{len(pages)}", "Q")]] * len(statement)
    assert len(statement) >= len(found) - len(pages) - 1, "all but a blank page before the answer pages"
    assert (len(found) - len(pages)) % 2 == 0, "answer pages begin on the front of a leaf"


@each_row("size", SIZES)
def test_a_page_left_blank_before_answer_pages_is_of_their_size(course, size):
    made = pypdfium2.PdfDocument(builtin_renderer().on(size).pdf(handout(course, "grashof", "en", size)))
    assert len(made) == 3, "statement, blank, answers"
    assert len({page.get_size() for page in made}) == 1


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_every_kind_of_part_is_printed(tmp_path, lang):
    coil = open_course(write_course(tmp_path))["coil"].variant(1, lang)
    sheet = replace(coil.handout(), answer_pages=answer_pages([coil], lang, "a4", "A" * 13))
    made = pypdfium2.PdfDocument(builtin_renderer().pdf(sheet))
    said = " ".join(page.get_textpage().get_text_bounded() for page in made)
    assert {"fr": "aucune", "en": "none"}[lang] in said
    assert said.count("Re") >= 2, "a row for the real part of each complex number"


def test_a_code_has_the_size_that_its_box_is_made_for():
    assert {qr_modules(f"CW1 {'A' * 13} {n}/{n}").shape for n in (0, 9, 12)} == {(25, 25)}


def test_the_statement_of_a_scanned_sheet_has_no_place_to_answer(course):
    scanned, usual = (
        source(TEMPLATES, [one]).partition("\n//=\n")[2].partition("#answer-page(")[0]
        for one in (handout(course, "two_circles"), course["two_circles"].variant(1, "en").handout())
    )
    for box in ("#short-question", "#millimetre-paper"):
        assert box in usual
        assert box not in scanned
    assert "answer page 1" in scanned


def test_a_sheet_that_is_not_scanned_knows_nothing_of_it(course):
    usual = source(TEMPLATES, [course["two_circles"].variant(1, "en").handout()])
    assert not [
        word for word in ("sheet-code", "answer-page", "asked-question", "background") if word in usual
    ]


@each_row("lang", ["fr", "en"])
def test_a_page_tells_its_rules_and_its_student_in_words_and_the_code_tells_neither(course, lang):
    sheet = handout(course, "grashof", lang)
    pdf = pypdfium2.PdfDocument(builtin_renderer().pdf(sheet))
    said = " ".join(pdf[len(pdf) - 1].get_textpage().get_text_bounded().split())
    assert "Zoé Lemaître" in said
    assert sheet.answer_pages[0].code_text in said
    assert {"fr": "Noircir toute la case", "en": "Fill a crossed box wholly"}[lang] in said
    assert {"fr": "barrer sa ligne", "en": "strike out its row"}[lang] in said
    assert "Zo" not in sheet.answer_pages[0].code_text


# -------------------------------------------------------------------- the command


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A small class, two languages: exercises by themselves, with and without answer pages."""
    folder = tmp_path_factory.mktemp("scan")
    roster = folder / "class.csv"
    roster.write_text("student,lang\nAnn Lee,en\nZoé Dupont,fr\n", "utf-8")
    usual = ["build", "grashof", "coriolis", "--roster", str(roster), "--formats", "pdf,html"]
    assert run([*usual, "--out", str(folder / "plain")]) == 0
    assert run([*usual, "--with", "scan,booklet", "--out", str(folder / "scan")]) == 0
    return folder


def tree(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.e2e
def test_two_builds_with_answer_pages_are_the_same_bytes(built):
    usual = ["build", "grashof", "coriolis", "--roster", str(built / "class.csv"), "--formats", "pdf,html"]
    assert run([*usual, "--with", "scan,booklet", "--out", str(built / "again")]) == 0
    assert tree(built / "scan") == tree(built / "again")


@pytest.mark.e2e
def test_only_the_students_own_pdfs_differ_from_a_build_without(built):
    plain, scan = tree(built / "plain"), tree(built / "scan")
    differ = {name for name in plain if plain[name] != scan[name]}
    assert differ - {".built.json"} == {n for n in plain if n.startswith("handouts/") and n.endswith(".pdf")}


@pytest.mark.e2e
def test_every_code_of_a_build_is_found_again_from_what_was_issued(built, course):
    papers = answer_papers(json.loads((built / "scan" / "issued.json").read_text("utf-8")))
    on_a4 = {code: paper for code, paper in papers.items() if paper.size == "a4"}
    assert len(papers) == 2 * len(on_a4) == 8
    met = set()
    for file in sorted((built / "scan" / "handouts").rglob("*/*.pdf")):
        said = [text for picture in pictures(file.read_bytes(), 6) for text, _ in codes_on(picture)]
        _, code, _ = said[-1].split()
        paper = on_a4[code]
        assert (paper.student == "Ann Lee") == (".en.pdf" in file.name)
        assert paper.records[0]["exercise"] == file.parent.name
        assert [page.code_text for page in paper.pages(course)] == said[-len(paper.pages(course)) :]
        met.add(code)
    assert met == set(on_a4)


def test_a_booklet_counts_answer_pages_to_their_student(built):
    table = list(
        csv.DictReader((built / "scan" / "handouts" / "pages.csv").read_text("utf-8-sig").splitlines())
    )
    for row in table:
        pdf = (built / "scan" / "handouts" / row["file"]).read_bytes()
        shown = list(pictures(pdf, 6))[int(row["first page"]) - 1 : int(row["last page"])]
        codes = [code for picture in shown for code, _ in codes_on(picture)]
        assert len({code.split()[1] for code in codes}) == 1
        assert codes[-1].split()[2][0] != "0"
        assert int(row["first page"]) % 2


@pytest.mark.e2e
def test_papers_of_an_assignment_are_known_again_with_and_without_names(tmp_path, course):
    (tmp_path / "midterm.toml").write_text(
        'title = "Midterm"\nscan = true\nformats = ["pdf"]\nlang = ["fr", "en"]\n'
        '[[exercises]]\nname = "grashof"\n[[exercises]]\nname = "two_circles"\n',
        "utf-8",
    )
    out = tmp_path / "out"
    assert run(["build", str(tmp_path / "midterm.toml"), "--variants", "2", "--out", str(out)]) == 0
    papers = answer_papers(json.loads((out / "issued.json").read_text("utf-8")))
    seen = {}
    for file in sorted((out / "handouts").glob("*.pdf")):
        *_, (last, _) = [code for picture in pictures(file.read_bytes(), 6) for code in codes_on(picture)]
        seen[file.name] = last.split()[1]
    assert len(seen) == 4
    assert len(set(seen.values())) == 2, "a paper has one code in every language"
    for code in seen.values():
        assert [record["exercise"] for record in papers[code].records] == ["grashof", "two_circles"]


@pytest.mark.parametrize("names", [["grashof"], ["grashof", "coriolis"], []], ids=["one", "two", "alone"])
def test_an_answer_page_numbers_a_question_as_its_paper_does(tmp_path, course, names):
    exam = tmp_path / "exam.toml"
    exam.write_text("".join(f'[[exercises]]\nname = "{name}"\n' for name in names), "utf-8")
    asked = [str(exam)] if names else ["grashof"]
    usual = ["build", *asked, "--with", "scan,no-solutions", "--formats", "pdf", "--lang", "en"]
    assert run([*usual, "--out", str(tmp_path / "out")]) == 0
    paper = next(iter(answer_papers(json.loads((tmp_path / "out/issued.json").read_text("utf-8"))).values()))
    [pdf] = (tmp_path / "out" / "handouts").rglob("*.pdf")
    text = "".join(page.get_textpage().get_text_range() for page in pypdfium2.PdfDocument(pdf.read_bytes()))
    statement, _, answers = text.partition("CW1")
    fields = [field for page in paper.pages(course) for field in page.fields]
    asked_for = list(dict.fromkeys(field.number for field in fields if field.number))
    assert asked_for == re.findall(r"^((?:\d\.)?\d+)\. ", statement, re.MULTILINE)
    assert not [number for number in asked_for if not re.search(rf"^{number}\s", answers, re.MULTILINE)]
    assert len(asked_for) == sum(len(record["parts"]) for record in paper.records)


def test_answer_pages_without_a_pdf_are_refused(tmp_path, capsys):
    out = tmp_path / "out"
    assert run(["build", "grashof", "--with", "scan", "--formats", "html", "--out", str(out)]) != 0
    assert "add pdf, or --with booklet" in capsys.readouterr().err
    assert not out.exists()
