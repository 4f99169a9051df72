"""Feedback as a student meets it: nothing torn, nothing boxed, answers that are copied as they were typed,
all of it in three formats."""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
from dataclasses import replace

import nbformat
import pytest
from paper_samples import COURSE, bare, heading
from paper_samples import feedback as paper_feedback
from pdf_text import page_texts
from rendering_samples import answer_sheet, feedback_sheet
from sweeps import at_once, sampled, seeds
from tables import each_row

from coursework.gradebook.columns import VERDICTS
from coursework.language.words import languages, words
from coursework.markup.markdown import SUBSTITUTE
from coursework.rendering import feedback, papers, pdf
from coursework.rendering.renderer import builtin_renderer
from coursework.sheets.paper import FeedbackPaper
from coursework.sheets.sheet import FeedbackSheet, Lesson, Practice

RENDERER = builtin_renderer()
every_language = pytest.mark.parametrize("lang", sampled(languages(), ["fr"]))

SENTENCES = {
    "fr": "Le raisonnement cinématique reste incomplet : reprenez la fermeture géométrique, dérivez-la deux "
    "fois, puis "
    "projetez perpendiculairement au guide avant toute application numérique. ",
    "en": "The kinematic reasoning is not complete yet: start again from the geometrical closure, "
    "differentiate it twice, and "
    "project it perpendicularly to the guide before any numerical application. ",
}
TYPED = (
    "104.6",
    "−75,4 °",
    "12345678901234567890.123456789012345678901234567890123456789012345678901234567890123456789",
    "r2*cos(theta2)+r3*cos(theta3)-r1-r4*cos(theta4)+r2*cos(theta2)+r3*cos(theta3)-r1-r4*cos(theta4)=0",
    "ŒuvreÉlèveGarçonÑandúŁódźŽižekÅngström" * 6,
    "don't -- \"say\" 'so'... <b>#x$ *y* _z_ `w` [a] @b /c ~d ; e ? f !",
    "-79.25925925925925",
    "l'angle vaut 12 mm ; sinon ?",
    "a" * 300,
    "2,5·10³ rad/s²",
)


def synthetic(lang: str, count: int, seed: int, most: int = 6) -> FeedbackSheet:
    """A sheet of so many questions, its answers and sentences of every length: the first and last words of
    each sentence tell its question."""
    choose = random.Random(seed)
    sheet = feedback_sheet(lang, student="Zoé Martin")
    lines = []
    for number in range(1, count + 1):
        line = choose.choice(sheet.lines)
        said = SENTENCES[lang] * choose.randint(0, most)
        says = f"Debut{number}x. {said}Fin{number}x." if choose.random() < 0.7 else ""
        question = replace(line.question, number=number, prompt=f"Quest{number}x {line.question.prompt}")
        verdict = choose.choice(VERDICTS)
        full = verdict == "correct"
        lines.append(
            replace(
                line,
                question=question,
                answer=choose.choice(TYPED),
                verdict=verdict if says else "correct",
                says=says,
                points=line.out_of if full else 0.0,
                right="" if full else r"$\num{319.8}\ \mathrm{mm}$",
                hint="" if full else f"$r_A$, question {number}",
            )
        )
    return replace(sheet, lines=tuple(lines), points=sum(one.points for one in lines))


def together(pages: list[str], words_of: list[str]) -> bool:
    """Whether one page holds all these words."""
    return any(all(word in page for word in words_of) for page in pages)


@every_language
@seeds(2, 6)
@pytest.mark.e2e
def test_a_question_and_all_that_is_said_of_it_stand_on_one_page(lang, seeds):
    for seed in seeds:
        sheet = synthetic(lang, 25, seed)
        whole = FeedbackPaper(heading(lang), (sheet, synthetic(lang, 8, seed + 100)), 1.0, 2.0, "12")
        for pages, sheets in (
            (page_texts(RENDERER.pdf(sheet)), [sheet]),
            (page_texts(RENDERER.pdf(whole)), whole.sheets),
        ):
            assert len(pages) > 2
            for one in sheets:
                for line in one.lines:
                    number = line.question.number
                    said = [f"Debut{number}x", f"Fin{number}x"] if feedback.note(line, lang) else []
                    assert together(pages, [f"Quest{number}x", *said])


@every_language
def test_an_answer_longer_than_a_page_follows_what_is_said_of_it(lang):
    sheet = synthetic(lang, 3, 1)
    essay = "\n".join(f"Ligne {k} de la démonstration, avec ses calculs." for k in range(120))
    line = replace(sheet.lines[1], answer=essay, verdict="to_mark", says="Debut2x. Fin2x.")
    pages = page_texts(RENDERER.pdf(replace(sheet, lines=(sheet.lines[0], line, sheet.lines[2]))))
    assert together(pages, ["Quest2x", "Debut2x", "Fin2x"])
    text = "".join(pages)
    assert all(f"Ligne {k} de" in text for k in range(120))


@every_language
@each_row("answer", TYPED)
def test_a_typed_answer_is_copied_as_it_was_typed(lang, answer):
    sheet = feedback_sheet(lang)
    lines = tuple(replace(line, answer=answer, read_as="") for line in sheet.lines)
    shown = replace(sheet, lines=lines)
    copied = "".join(page_texts(RENDERER.pdf(shown)))
    assert copied.count(answer) == len(lines)
    assert "\u200b" not in RENDERER.typst(shown) + RENDERER.html(shown) + RENDERER.feedback_notebook(shown)
    assert "sym.zws" not in RENDERER.typst(shown)
    assert RENDERER.html(shown).count(_in_html(answer)) == len(lines)
    assert "".join(_cells(shown)).count(answer) == len(lines)


@pytest.mark.skipif(not shutil.which("pdftotext"), reason="pdftotext is not here")
def test_a_typed_letter_with_an_arrow_is_copied_with_it(tmp_path):
    """The two are one cluster of glyphs, whose text the PDF says beside them."""
    answer = "v\u20d7 = 3 x\u20d7 + y\u20d7"
    sheet = feedback_sheet("fr")
    file = tmp_path / "sheet.pdf"
    file.write_bytes(
        RENDERER.pdf(replace(sheet, lines=(replace(sheet.lines[0], answer=answer, read_as=""),)))
    )
    made = subprocess.run(["pdftotext", "-layout", file, "-"], capture_output=True, check=True)
    assert answer in made.stdout.decode()


def _in_html(text: str) -> str:
    from html import escape

    return f'<span class="typed">{escape(text)}</span>'


def _cells(told: FeedbackSheet | FeedbackPaper) -> list[str]:
    return ["".join(cell["source"]) for cell in json.loads(RENDERER.feedback_notebook(told))["cells"]]


def test_a_long_word_that_was_typed_stays_in_its_column():
    """It is cut where the column ends: what is drawn to the right of the page would be lost."""
    import typst

    sheet = feedback_sheet("fr")
    definitions = RENDERER.typst(sheet).partition("\n//=\n")[0]
    high = "measure(block(width: 25mm, typed[#{}])).height.pt()"
    asked = high.format('"' + "8" * 60 + '"'), high.format('"8"')
    found = typst.query(
        f"{definitions}\n#context [#metadata(({', '.join(asked)})) <high>]".encode(), "<high>", field="value"
    )
    ((long, short),) = json.loads(found)
    assert long > 2 * short > 0


@every_language
def test_sentences_are_hyphenated_by_the_rules_of_their_language(lang):
    """The words of narrow columns; what was typed never is."""
    text = RENDERER.typst(feedback_sheet(lang))
    assert "#let prose(body) = {\n  set text(hyphenate: true)" in text
    assert "#let typed(body) = {\n  set text(hyphenate: false)" in text
    assert "set text(lang: lang)" in text
    assert f'#sheet-page("{lang}"' in text


# ------------------------------------------------------------------------ letters


@every_language
@at_once(COURSE.names, ("velocity_polygon", "four_bar_motion", "joint_twist", "ball_reducer"))
def test_every_letter_of_the_sheets_is_drawn_with_its_arrow_and_its_dots(lang, names):
    """Each question of each exercise, answered by a choice with formulas in it or not at all: no square
    stands for a letter."""
    from coursework.gradebook.feedback_sheets import feedback_sheet as told
    from coursework.gradebook.graded_sheet import Graded
    from coursework.marking.marking import mark

    arrows = 0
    for name in names:
        variant = COURSE[name].variant(3, lang)
        solution = variant.solution()
        cases = {p.id: str(solution[p.quantity]) for p in variant.parts if p.choices and not p.sort.is_open}
        lines = dict(mark(variant, cases))
        sheet = told(COURSE, Graded("Zoé", name, 3, lines, tuple(cases), variant.record), answers=True)
        source = RENDERER.typst(sheet)
        assert SUBSTITUTE not in source, name
        assert RENDERER.pdf(sheet).startswith(b"%PDF")  # the standard refuses a letter that no font draws
        arrows += source.count("arrow(")
        # A combining mark above a letter is drawn by mathematics, or by the one font that has it.
        for found in re.finditer("[\u20d0-\u20f0]", pdf.drawn(source, ())):
            assert "New Computer Modern Math" in source[found.start() - 80 : found.start()], name
    assert arrows > 10


@every_language
def test_what_was_read_of_a_choice_shows_its_formulas(lang):
    from coursework.gradebook.feedback_sheets import feedback_sheet as told
    from coursework.gradebook.graded_sheet import Graded
    from coursework.marking.marking import mark

    parts = COURSE["ball_reducer"].spec.parts
    variant = COURSE["ball_reducer"].variant(3, lang, [part.id for part in parts if part.choices])
    part = next(p for p in variant.parts if any("$" in variant.label(p.id, c) for c in p.choices))
    case = next(c for c in part.choices if "$" in variant.label(part.id, c))
    lines = dict(mark(variant, {part.id: case}))
    sheet = told(COURSE, Graded("", "ball_reducer", 3, lines, (part.id,), variant.record))
    (line,) = [one for one in sheet.lines if one.question.id == part.id]
    assert line.read == variant.called(part, case)
    assert "$" not in line.read_as


# ------------------------------------------------------------------------- words


@every_language
def test_no_word_of_a_verdict_judges_and_an_unknown_one_has_words_too(lang):
    table = words(lang)["feedback"]
    assert set(table["verdicts"]) == set(table["means"]) == set(feedback._ORDER)
    assert set(VERDICTS) <= set(table["verdicts"])
    for word in table["verdicts"].values():
        assert not re.search(r"\b(wrong|false|bad|faux|fausse|mauvais)", word)
    sheet = feedback_sheet(lang)
    odd = replace(sheet, lines=(replace(sheet.lines[0], verdict="strange:new", points=0.0),))
    for text in ("".join(page_texts(RENDERER.pdf(odd))), RENDERER.html(odd), "".join(_cells(odd))):
        assert table["verdicts"]["otherwise"] in text
        assert "strange" not in text


@every_language
def test_the_legend_tells_each_verdict_of_the_sheet_once_with_its_points(lang):
    sheet = feedback_sheet(lang)
    found = feedback.legend([sheet, sheet], lang)
    table = words(lang)["feedback"]
    met = {line.verdict.partition(":")[0] for line in sheet.lines}
    assert {one.word for one in found} == {table["verdicts"][kind] for kind in met}
    assert len(found) == len(met)
    worth = {one.word: one.worth for one in found}
    assert worth[table["verdicts"]["correct"]] == table["worth"]["all"]
    assert worth[table["verdicts"]["missing"]] == table["worth"]["none"]
    assert worth[table["verdicts"]["unreadable"]] == table["worth"]["later"]
    assert "50" in worth[table["verdicts"]["slip"]]
    mixed = replace(sheet, lines=(*sheet.lines, replace(sheet.lines[0], points=0.5)))
    ((first, *_),) = [feedback.legend([mixed], lang)]
    assert first.worth == table["worth"]["beside"]


def test_a_sign_tells_the_share_of_the_points_and_none_is_told_by_colour_alone():
    sheet = feedback_sheet("en")
    assert [feedback.sign(line) for line in sheet.lines] == ["full", "part", "none", "part", "wait"]
    assert feedback.tally(sheet) == (("full", 1), ("part", 2), ("none", 1), ("wait", 1))
    drawn = re.findall(
        r'class="verdict (\w+)"><span class="sign" aria-hidden="true"></span>([^<]+)<', RENDERER.html(sheet)
    )
    assert all(word.strip() for _, word in drawn)


@each_row(
    ("prompt", "symbol", "shown"),
    [
        ("The angle. Check it.", "", "The angle."),
        ("The angle $x. y$ of A? Then more.", "", "The angle $x. y$ of A?"),
        ("Write `a. b` so", "q", "Write `a. b` so ($q$)"),
        ("Speed $\\dot\\phi$.", "\\dot{\\phi}", "Speed $\\dot\\phi$."),
        ("Draw it. The angle $\\alpha$, measured.", "\\alpha", "The angle $\\alpha$, measured."),
        ("The crank drives. The linkage is:", "", "The crank drives. The linkage is:"),
        ("At 2.5 s it is:\n\nmore", "", "At 2.5 s it is:"),
    ],
)
def test_a_question_is_called_by_the_sentence_that_asks(prompt, symbol, shown):
    line = feedback_sheet("en").lines[0]
    assert (
        feedback.question_heading(
            replace(line, question=replace(line.question, prompt=prompt, symbol=symbol))
        )
        == shown
    )


@each_row(
    ("typed", "read", "shown"),
    [
        ("60.5", "60,5", ""),
        ("-3", "−3", ""),
        ("1;2", "(1; 2)", ""),
        ("wy vx", "wy, vx", ""),
        ("{1 2 3 | 4 5 6}", "{1; 2; 3} {4; 5; 6}", ""),
        ("1,2", "1; 2", "1; 2"),
        ("12 N*m", "12 N·m", ""),
        ("Une rotation", "b) une rotation", ""),
        ("b", "b) une rotation", "b) une rotation"),
        ("0,32 m", "320 mm", "320 mm"),
        ("x", "", ""),
    ],
)
def test_what_was_read_is_told_where_it_is_not_what_was_typed(typed, read, shown):
    line = replace(feedback_sheet("fr").lines[0], answer=typed, read_as=read)
    assert feedback.read_otherwise(line) == shown


# -------------------------------------------------------------------------- next

ASKED = tuple(q for q in feedback_sheet("en").handout.questions if q.id in ("rA", "theta4"))
NEXT = Practice(
    "slotted_mechanism", 1, "", 57, (Lesson("mechanisms", "One loop", ("7. A block", "8. Coriolis")),), ASKED
)


@every_language
def test_what_to_try_next_is_told_in_every_format(lang):
    sheet = replace(feedback_sheet(lang), practice=NEXT)
    whole = FeedbackPaper(bare(lang), (sheet,), 3, 7)
    command = "coursework notebook slotted_mechanism --seed 57"
    for text in RENDERER.html(sheet), RENDERER.html(whole):
        assert f"{command} --lang {lang}" in text
        assert "8.\N{NO-BREAK SPACE}Coriolis" in text
    for pages in RENDERER.pdf(sheet), RENDERER.pdf(whole):  # nobody types a command that is on paper
        text = " ".join("".join(page_texts(pages)).split())
        assert "coursework" not in text
        assert words(lang)["feedback"]["next"]["on_paper"].split(";")[1].strip() in text.replace("’", "'")
        assert "8. Coriolis" in text
    for told in (sheet, whole):
        cells = _cells(told)
        opens = next(cell for cell in cells if "coursework.study(" in cell)
        assert "seed=57" in opens
        compile(opens, "cell", "exec")
        checks = cells[cells.index(opens) + 1]
        assert re.findall(r'"(\w+)": ""', checks) == ["rA", "theta4"]
        compile(checks, "cell", "exec")
    alone = replace(sheet, practice=replace(NEXT, seed=None))
    assert "--seed" not in RENDERER.html(alone)
    assert not [cell for cell in _cells(alone) if "coursework.study" in cell]


@every_language
def test_the_notebook_of_feedback_is_valid_and_the_same_twice_and_was_never_run(lang):
    sheet = replace(feedback_sheet(lang, student="O'Neil *x*"), practice=NEXT, solution=answer_sheet(lang))
    for told in (
        sheet,
        paper_feedback(heading(lang)),
        FeedbackPaper(bare(lang), (sheet, sheet), 1, 2, numbered=False),
    ):
        made = RENDERER.feedback_notebook(told)
        assert made == RENDERER.feedback_notebook(told)
        book = nbformat.reads(made, as_version=4)
        nbformat.validate(book)
        assert not [cell for cell in book.cells if cell.cell_type == "code" and cell.outputs]
        shown = [name for cell in book.cells for name in re.findall(r"attachment:([\w.-]+)", cell.source)]
        held = [name for cell in book.cells for name in cell.get("attachments", {})]
        assert shown == held


@every_language
def test_the_worked_solution_stands_after_the_feedback_in_every_format(lang):
    sheet = replace(feedback_sheet(lang), solution=answer_sheet(lang))
    title = words(lang)["feedback"]["solution"]
    whole = FeedbackPaper(bare(lang), (sheet,), 3, 7)
    closure = words(lang)["sheet"]["answer"]
    for text in (
        "".join(page_texts(RENDERER.pdf(sheet))),
        RENDERER.html(sheet),
        "".join(_cells(sheet)),
        "".join(page_texts(RENDERER.pdf(whole))),
        RENDERER.html(whole),
        "".join(_cells(whole)),
    ):
        assert title in text
        assert text.index(title) > text.index(words(lang)["feedback"]["legend"])
        assert closure in text[text.index(title) :]
    for text in (RENDERER.html(feedback_sheet(lang)), "".join(_cells(feedback_sheet(lang)))):
        assert title not in text


@every_language
def test_exercises_handed_out_one_by_one_keep_the_numbers_of_their_sheets(lang):
    made = replace(paper_feedback(bare(lang)), numbered=False)
    names = papers.context(made, "typ.j2", lambda template, names: "")
    assert [exercise["prefix"] for exercise in names["exercises"]] == ["", "", ""]
    assert [exercise["called"] for exercise in names["exercises"]] == [s.handout.title for s in made.sheets]
    assert re.search(r'<strong class="no">1</strong>', RENDERER.html(made))
    assert not re.search(r'<strong class="no">\d\.', RENDERER.html(made))
