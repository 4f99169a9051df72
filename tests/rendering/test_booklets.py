"""Promises of booklets and papers: where each sheet is, and on which paper."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from itertools import pairwise

import pytest
import typst
from rendering_samples import answer_sheet, feedback_sheet, handout, many_given
from tables import each_row

from coursework.cli import run
from coursework.cli.options import DONE
from coursework.course.builtin import builtin_root
from coursework.errors import BadStatement, UnknownName
from coursework.issuing import booklets, build, issuing
from coursework.rendering.pdf import source
from coursework.rendering.renderer import PAPERS, Renderer
from coursework.system import writing

TEMPLATES = [builtin_root() / "templates"]
WIDTHS = {"a4": "595.27", "letter": "612"}


def pages_of(sheets, paper="a4") -> list[str]:
    pages = typst.compile(source(TEMPLATES, sheets, paper).encode(), format="svg")
    return [p.decode() for p in (pages if isinstance(pages, list) else [pages])]


@each_row("paper", PAPERS)
@each_row("make", [handout, answer_sheet, feedback_sheet, many_given])
def test_every_page_of_a_sheet_has_the_size_of_its_paper(make, paper):
    for page in pages_of([make("fr")], paper):
        assert f'width="{WIDTHS[paper]}' in page[:400]


@each_row("paper", PAPERS)
def test_blank_pages_between_the_sheets_of_a_booklet_have_its_size_too(paper):
    pages = pages_of([handout("fr"), handout("en"), answer_sheet("fr")], paper)
    assert all(f'width="{WIDTHS[paper]}' in page[:400] for page in pages)


def test_a_page_to_print_names_its_paper():
    for paper, css in (("a4", "size: a4"), ("letter", "size: letter")):
        assert css in Renderer(TEMPLATES, paper).html(handout("en"))


def test_an_unknown_paper_is_refused_by_name():
    with pytest.raises(UnknownName, match="'letter'"):
        Renderer(TEMPLATES, "leter")


def test_a_booklet_says_the_pages_of_each_sheet():
    long = replace(handout("en"), questions=handout("en").questions * 3)
    sheets = [handout("fr"), long, handout("en"), answer_sheet("fr")]
    made, pages = Renderer(TEMPLATES).booklet(sheets)
    assert made == Renderer(TEMPLATES).pdf(*sheets)
    lengths = [len(pages_of([sheet])) for sheet in sheets]
    assert lengths[1] > 1, "a sheet of several pages is among them"
    assert [last - first + 1 for first, last in pages] == lengths
    assert all(first % 2 for first, _ in pages)
    assert pages[-1][1] == len(pages_of(sheets))
    assert all(then - last in (1, 2) for (_, last), (then, _) in pairwise(pages))


def test_a_booklet_of_a_broken_template_is_an_error_of_the_course(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "figure_and_data.typ.j2").write_text("#nonsense", "utf-8")
    with pytest.raises(BadStatement, match="nonsense"):
        Renderer([tmp_path, *TEMPLATES]).booklet([handout("en")])


def issues_of(course, count, langs=("fr",)):
    return issuing.issue(course, ["slotted_mechanism"], first_seed=0, count=count, langs=langs)


def bound_files(course, issues):
    tables = {"issued.json", "answers.csv", "key.json", "key.csv"}
    return [file for file in build.files(course, issues, ["booklet"]) if file.path.name not in tables]


def test_a_large_class_has_several_booklets_named_with_their_sheets(course, monkeypatch):
    monkeypatch.setattr(booklets, "EXERCISES", 4)
    monkeypatch.setattr(booklets, "SOLVED", 6)
    names = [str(f.path) for f in bound_files(course, issues_of(course, 10))]
    assert names == [
        "handouts/slotted_mechanism.fr.01-04.pdf",
        "handouts/slotted_mechanism.fr.05-08.pdf",
        "handouts/slotted_mechanism.fr.09-10.pdf",
        "instructor/slotted_mechanism.fr.01-06.solutions.pdf",
        "instructor/slotted_mechanism.fr.07-10.solutions.pdf",
        "handouts/pages.csv",
    ]


def test_without_solutions_what_is_handed_out_and_the_key_remain(course):
    formats = ["pdf", "html", "tex", "booklet"]
    whole, less = (
        {file.path.as_posix(): file for file in build.files(course, issues_of(course, 2), [*formats, *more])}
        for more in ((), ("no-solutions",))
    )
    left_out = {name for name in whole if name not in less}
    assert left_out == {name for name in whole if name.startswith("instructor/") and "key." not in name}
    assert {name.rpartition(".solution")[2] for name in left_out if ".solution" in name} == {
        ".pdf",
        ".html",
        ".tex",
        "s.pdf",
    }


def test_exercises_count_not_papers():
    parts = booklets.parted("class.fr", "abcde", 3, 7)
    assert list(parts) == [("class.fr.1-2", "ab"), ("class.fr.3-4", "cd"), ("class.fr.5-5", "e")]
    assert list(booklets.parted("class.fr", "ab", 8, 7)) == [("class.fr.1-1", "a"), ("class.fr.2-2", "b")]


@pytest.mark.e2e
def test_the_table_of_pages_has_a_line_for_each_sheet_whichever_booklet_holds_it(
    course, tmp_path, monkeypatch
):
    monkeypatch.setattr(booklets, "EXERCISES", 2)
    issues = issues_of(course, 3, ("fr", "en"))
    writing.write(tmp_path, bound_files(course, issues))
    rows = list(csv.DictReader(io.StringIO((tmp_path / "handouts" / "pages.csv").read_text("utf-8-sig"))))
    assert [(r["lang"], int(r["seed"])) for r in rows] == [
        (lang, issue.variant.seed) for lang in ("fr", "en") for issue in issues
    ]
    assert [r["first page"] for r in rows] == ["1", "3", "1"] * 2
    assert all((tmp_path / "handouts" / r["file"]).exists() for r in rows)


@pytest.mark.e2e
def test_build_writes_booklets_beside_the_single_files(tmp_path):
    roster = tmp_path / "class.csv"
    roster.write_text("student,lang\nZoé,fr\nJohn & Mary,en\nÉlodie #1,fr\n", "utf-8")
    command = [
        "build",
        "slotted_mechanism",
        "--roster",
        str(roster),
        "--formats",
        "pdf",
        "--with",
        "letter,booklet",
    ]
    assert run([*command, "--out", str(tmp_path / "out")]) == DONE
    made = {str(p.relative_to(tmp_path / "out")) for p in (tmp_path / "out").rglob("*.pdf")}
    assert made >= {
        "handouts/slotted_mechanism.fr.pdf",
        "handouts/slotted_mechanism.en.pdf",
        "handouts/slotted_mechanism/zoe.fr.pdf",
        "instructor/slotted_mechanism.fr.solutions.pdf",
        "instructor/slotted_mechanism/zoe.fr.solution.pdf",
    }
    rows = csv.DictReader(io.StringIO((tmp_path / "out" / "handouts" / "pages.csv").read_text("utf-8-sig")))
    assert [(r["student"], r["lang"]) for r in rows] == [
        ("Zoé", "fr"),
        ("Élodie #1", "fr"),
        ("John & Mary", "en"),
    ]


def test_a_sheet_that_cannot_be_made_ends_the_build_with_its_fault(course, tmp_path, monkeypatch):
    class Broken(Renderer):
        def on(self, paper):
            return self

        def booklet(self, sheets):
            raise BadStatement("no")

    monkeypatch.setattr(build, "renderer_of", lambda folder: Broken(TEMPLATES))
    wanted = bound_files(course, issues_of(course, 1))
    with pytest.raises(BadStatement, match="no"):
        writing.write(tmp_path, wanted)
