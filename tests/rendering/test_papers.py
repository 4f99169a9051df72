"""Papers: several exercises under one heading, whose every page says whose it is, which numbers, and where it
stands."""

from __future__ import annotations

import ast
import json
import re
import struct
import zlib
from collections import Counter
from dataclasses import replace
from itertools import pairwise, permutations, product

import nbformat
import pytest
from page_scripts import allowed, digest, runs
from paper_samples import ALT, COURSE, NAMES, bare, feedback, heading, paper, solution
from pdf_text import page_texts
from sweeps import sampled
from tables import each_row

from coursework.errors import BadInput
from coursework.language.words import words
from coursework.rendering import papers
from coursework.rendering.feedback import tally
from coursework.rendering.papers import variants
from coursework.rendering.renderer import PAPERS, renderer_of
from coursework.rendering.views import worked
from coursework.sheets.paper import Logo, Paper
from coursework.sheets.sheet import FeedbackLine

RENDERER = renderer_of(COURSE.folder)
every_language = pytest.mark.parametrize("lang", ["fr", "en"])
every_size = pytest.mark.parametrize("size", PAPERS)
one_language = pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
KINDS = {
    "full": lambda lang: paper(heading(lang)),
    "cover": lambda lang: paper(heading(lang, cover=True)),
    "bare": lambda lang: paper(bare(lang, "Zoé #1 Martin")),
    "solution": lambda lang: solution(heading(lang)),
    "feedback": lambda lang: feedback(heading(lang)),
}
every_kind = pytest.mark.parametrize("make", KINDS.values(), ids=KINDS)


_TEXTS = {}  #: of each paper, which stands beside them: a paper that is made no more has no place of its own


def texts(made, size="a4"):
    """The texts of the pages of a paper; typeset once."""
    if (id(made), size) not in _TEXTS:
        pages = page_texts(RENDERER.on(size).pdf(made))
        _TEXTS[id(made), size] = made, [plainly(text) for text in pages]
    return _TEXTS[id(made), size][1]


def plainly(text: str) -> str:
    """Spaces alike, and apostrophes as they are set."""
    return re.sub(r"\s+", " ", text).replace("'", "’")


def full_points(names=NAMES) -> float:
    """What the exercises' records are out of, added up."""
    return sum(p["points"] for n in names for p in COURSE[n].variant(seed=7).record["parts"])


@pytest.mark.parametrize(
    "printed", sampled(product(["fr", "en"], PAPERS), [("fr", "a4"), ("en", "letter")]), ids="-".join
)
@every_kind
def test_every_page_says_whose_it_is_which_seeds_and_which_page_of_how_many(make, printed):
    lang, size = printed
    pages = texts(make(lang), size)
    for number, page in enumerate(pages, 1):
        foot = (
            f"Zoé #1 Martin · slotted_mechanism 7 · grashof 8 · four_bar_positions 9page {number} / "
            f"{len(pages)}"
        )
        assert page.endswith(foot)


@every_language
def test_nobodys_paper_has_room_for_the_name_on_every_page(lang):
    pages = texts(paper(heading(lang, "")))
    for number, page in enumerate(pages, 1):
        assert re.search(
            rf"{words(lang)['sheet']['name']} ?: · slotted_mechanism 7 .*page {number} / {len(pages)}$", page
        )


def test_the_seeds_alone_stand_at_the_foot_where_the_names_have_no_room():
    long = paper(bare("en"), NAMES * 3)
    assert variants(long) == " · ".join(str(7 + place) for place in range(9))
    assert page_texts(RENDERER.pdf(long))[0].count(variants(long)) == 1


@one_language
@every_kind
def test_every_paper_is_an_accessible_pdf_and_the_same_bytes_twice(make, lang):
    made = RENDERER.pdf(make(lang))
    assert b"pdfuaid:part" in made
    assert b"<pdfaid:conformance>A<" in made
    assert RENDERER.pdf(make(lang)) == made


@every_language
@each_row("cover", [False, True])
def test_the_head_says_what_the_paper_is_and_its_total(lang, cover):
    top = heading(lang, cover=cover)
    first, *others = texts(paper(top))
    for said in (
        top.title,
        top.course,
        top.date,
        top.version,
        "20261234",
        words(lang)["paper"]["instructions"],
    ):
        assert plainly(said) in first
    assert f"{full_points():g}" in first
    starts = words(lang)["paper"]["numbered"].format(1, "")
    assert (starts in first) is not cover
    if cover:
        assert starts in others[0]
        row = "".join(f"{n}{h.title}{h.points:g}" for n, h in enumerate(paper(top).handouts, 1))
        assert plainly(row) in first


def test_every_exercise_says_its_points_and_numbers_its_questions_under_its_own():
    said = " ".join(texts(paper(heading("en"))))
    for place, sheet in enumerate(paper(heading("en")).handouts, 1):
        assert plainly(f"Exercise {place}. {sheet.title} ({sheet.points:g} points)") in said
        for question in sheet.questions:
            assert f"{place}.{question.number}." in said
    assert "questions 3.2–3.4: to within 1%" in said


@every_size
@each_row("names", list(permutations(NAMES)))
def test_no_page_ends_with_a_heading_or_with_one_question_alone(names, size):
    made = paper(heading("en"), names)
    pages = texts(made, size)
    for place, sheet in enumerate(made.handouts, 1):
        (page,) = [page for page in pages if f"Exercise {place}." in page]
        assert plainly(sheet.statement.split(".")[0].split("$")[0]) in page
        first = next(page for page in pages if f"{place}.1." in page)
        assert f"{place}.2." in first
        assert "Questions" in first


@every_size
@pytest.mark.parametrize("step", [6, pytest.param(2, marks=pytest.mark.slow)])
def test_wherever_an_exercise_comes_its_first_question_has_the_second_on_its_page(size, step, monkeypatch):
    # However little room it is thought to take.
    monkeypatch.setattr(papers, "_start_mm", lambda sheet: 10)
    for lines in range(0, 30, step):
        top = replace(heading("en"), instructions="\n\n".join(["One rule."] * lines))
        pages = texts(paper(top, ("grashof", "slotted_mechanism")), size)
        for place in (1, 2):
            (page,) = [page for page in pages if f"{place}.1." in page]
            assert f"{place}.2." in page, f"{lines} rules before exercise {place}"


@one_language
def test_a_booklet_gives_each_paper_its_own_numbers_from_an_odd_page_on(lang):
    handed = [paper(heading(lang, f"N{k}"), NAMES[: k + 1]) for k in range(3)]
    made, pages = RENDERER.booklet(handed)
    alone = [len(page_texts(RENDERER.pdf(one))) for one in handed]
    assert [last - first + 1 for first, last in pages] == alone
    assert all(first % 2 for first, _ in pages)
    assert all(then - last in (1, 2) for (_, last), (then, _) in pairwise(pages))
    said = page_texts(made)
    for k, (first, last) in enumerate(pages):
        for number, page in enumerate(said[first - 1 : last], 1):
            assert f"N{k} · " in page
            assert page.endswith(f"page {number} / {alone[k]}")


def test_a_solution_repeats_each_question_before_its_answer_and_ends_with_one_guide():
    made = solution(heading("en"))
    said = " ".join(texts(made))
    guide = said.rindex("Marking guide")
    assert f"Marking guide ({full_points():g} points)" in said
    place = 0
    for number, sheet in enumerate(made.sheets, 1):
        for answer in sheet.answers:
            asked = said.index(f"{number}.{answer.question.number}", place)
            place = said.index("Answer", asked)
            # As far as the first formula, or a word that may be divided.
            words_asked = plainly(re.split(r"[$-]", answer.question.prompt)[0])
            assert said.index(words_asked, asked) < place < guide
            assert f"{number}.{answer.question.number}" in said[guide:]
    assert "Question 1." not in said, "a step below its question need not name it"


@pytest.mark.parametrize("name", COURSE.names)
def test_each_step_of_a_solution_stands_once_and_in_order(name):
    sheet = COURSE[name].variant(seed=3, lang="en").answer_sheet(polygons=False)
    groups = worked(sheet, "en", "2.")
    assert [answer for answer, _ in groups] == list(sheet.answers)
    assert [step.name for _, steps in groups for step in steps] == [step.name for step in sheet.steps]
    shown = set()
    named = {part["id"]: part["quantity"] for part in sheet.handout.record["parts"]}
    for answer, steps in groups:
        shown |= {step.name for step in steps}
        assert named[answer.question.id] in shown | {g.name for g in sheet.handout.given}


@every_language
def test_feedback_gives_one_total_the_mark_and_a_row_an_exercise(lang):
    made = feedback(heading(lang))
    first, *_ = pages = texts(made)
    comma = "," if lang == "fr" else "."
    assert f"14{comma}5 / 20" in first
    assert f"{made.points:g} / {full_points():g} points" in first
    for number, sheet in enumerate(made.sheets, 1):
        counts = "".join(str(count) for _, count in tally(sheet))
        row = f"{number}{sheet.handout.title}{counts}{sheet.points:g} / {sheet.out_of:g}"
        assert plainly(row) in first
    assert words(lang)["paper"]["advice"] in pages[-1]
    assert "chapter 3" in pages[-1]


@every_language
def test_the_right_answer_stands_beside_a_wrong_one_unless_it_is_kept_back(lang):
    right = words(lang)["feedback"]["right"]
    shown, kept = (feedback(heading(lang), answers=answers) for answers in (True, False))
    wrong = sum(line.points < line.out_of for sheet in shown.sheets for line in sheet.lines)
    assert wrong > 10
    assert " ".join(texts(shown)).count(right) == RENDERER.html(shown).count(right) == wrong
    for text in (" ".join(texts(kept)), RENDERER.html(kept)):
        assert right not in text
    whole = replace(
        shown, sheets=tuple(replace(s, lines=tuple(map(rewarded, s.lines))) for s in shown.sheets)
    )
    assert right not in " ".join(texts(whole))


def rewarded(line: FeedbackLine) -> FeedbackLine:
    return replace(line, points=line.out_of)


@every_language
def test_feedback_calls_a_question_as_the_paper_does(lang):
    made = feedback(heading(lang))
    noun = words(lang)["sheet"]["question"]["one"].capitalize()
    (line,) = [line for line in made.sheets[1].lines if line.question.choices]
    assert line.says.startswith(f"{noun} 3")
    for text in (" ".join(texts(made)), RENDERER.html(made)):
        assert f"{noun} 2.3" in text
        assert not re.search(rf"{noun} \d(?!\.)", text)


@every_language
@every_kind
def test_a_page_of_a_paper_fetches_nothing_and_no_two_parts_share_an_id(make, lang):
    page = RENDERER.html(make(lang))
    assert len(runs(page)) == isinstance(make(lang), Paper)
    assert allowed(page) == [digest(script) for script in runs(page)]
    assert not re.search(r"https?:", page)
    assert page.count("<h1>") == 1
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert max(Counter(ids).values(), default=1) == 1
    assert set(re.findall(r'\bfor="([^"]+)"', page)) <= set(ids)
    # The name stands in the style sheet, for the foot of the printed pages, and cannot end it.
    assert page.count("</style>") == 1


def test_questions_of_one_name_in_two_exercises_are_answered_apart():
    page = RENDERER.html(paper(heading("en"), ("grashof", "four_bar_positions", "grashof")))
    groups = set(re.findall(r'type="radio" name="([^"]+)"', page))
    assert groups == {f"e{place}-linkage_type" for place in (1, 2, 3)}


@every_language
@each_row("student", ["", "Zoé"])
def test_a_notebook_has_a_cell_of_answers_an_exercise_that_says_whose_it_is(lang, student):
    handed = paper(heading(lang, student), (*NAMES, "grashof"))
    text = RENDERER.notebook(handed)
    assert text == RENDERER.notebook(handed)
    nbformat.validate(nbformat.reads(text, as_version=4))
    book = json.loads(text)
    sheets = [{"exercise": h.exercise, "seed": h.seed} for h in handed.handouts]
    assert book["metadata"]["coursework"] == {"student": student, "sheets": sheets, "lang": lang}
    ids = [cell["id"] for cell in book["cells"]]
    assert len(set(ids)) == len(ids)
    tagged = [cell for cell in book["cells"] if "answers" in cell["metadata"].get("tags", ())]
    for place, (cell, handout) in enumerate(zip(tagged, handed.handouts, strict=True)):
        source = "".join(cell["source"])
        assert source.startswith(f"answers = {{  # {handout.exercise} {handout.seed}\n")
        assert cell["metadata"]["coursework"] == sheets[place]
        (statement,) = ast.parse(source).body
        asked = {question.key: "" for question in handout.questions}
        assert ast.literal_eval(statement.value) == ({} if student or place else {"student": ""}) | asked
    figures = [cell for cell in book["cells"] if cell.get("attachments")]
    assert len({json.dumps(cell["attachments"]) for cell in figures}) == len(handed.handouts)


def png(wide: int, high: int) -> bytes:
    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = (b"\0" + b"\x1b\x3a\x57" * wide) * high
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", wide, high, 8, 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


@each_row(("data", "form"), [(png(40, 10), "png"), (heading("en").logo.data, "svg")])
def test_a_logo_is_a_picture_told_in_words(data, form):
    handed = paper(replace(heading("en"), logo=Logo(data, form, "A <blue> & white sign")), NAMES[:1])
    assert b"pdfuaid:part" in RENDERER.pdf(handed)
    assert 'alt="A &lt;blue&gt; &amp; white sign"' in RENDERER.html(handed)
    assert RENDERER.pdf(handed) != RENDERER.pdf(paper(replace(heading("en"), logo=None), NAMES[:1]))


@each_row(("data", "form"), [(b"GIF89a", "png"), (png(1, 1), "svg"), (b"", "svg"), (b"", "png")])
def test_a_logo_of_another_format_is_refused(data, form):
    with pytest.raises(BadInput, match=r"logo is not an? (PNG|SVG)"):
        RENDERER.pdf(paper(replace(heading("en"), logo=Logo(data, form, ALT["en"])), NAMES[:1]))


@every_language
def test_latex_of_a_paper_names_its_figures_and_closes_what_it_opens(lang):
    files = [f"{place}.figure.pdf" for place in range(3)]
    for made in (paper(heading(lang, cover=True)), paper(bare(lang)), solution(heading(lang))):
        source = RENDERER.tex(made, files)
        assert all(source.count(f"{{{name}}}") == 1 for name in files)
        assert source.count("\\begin{") == source.count("\\end{")
        assert source.count("{") - source.count("\\{") == source.count("}") - source.count("\\}")
        assert f"/~{full_points():g} points" in source or f"({full_points():g} points)" in source
        assert "2.3" in source


@one_language
def test_a_name_that_no_font_draws_is_printed_with_squares_and_stops_nobodys_paper(lang):
    for made in (paper(heading(lang, "李 明")), solution(heading(lang, "李 明"))):
        assert "□ □" in page_texts(RENDERER.pdf(made))[0]
    made, pages = RENDERER.booklet([paper(bare(lang, name), NAMES[:1]) for name in ("李 明", "Zoé Roy")])
    assert len(pages) == 2
    assert "Zoé Roy" in "".join(page_texts(made))
