"""Every sheet of every exercise prints choices by letter, and shows a case's code name nowhere."""

import json
import re

import pytest

import coursework
from coursework.language.words import languages
from coursework.markup.markdown import to_text
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
RENDERER = renderer_of(COURSE.folder)
with_choices = pytest.mark.parametrize(
    "name", [n for n in COURSE.names if any(p.choices for p in COURSE[n].spec.parts)]
)
every_language = pytest.mark.parametrize("lang", languages())


def cells(book, kind):
    return ["".join(cell["source"]) for cell in json.loads(book)["cells"] if cell["cell_type"] == kind]


def sheets(name, lang):
    """Some variants that together ask every choice of an exercise."""
    found, left = [], {p.id for p in COURSE[name].spec.parts if p.choices}
    for variant in COURSE[name].variants(range(40), lang, ["all"]):
        asked = {p.id for p in variant.parts if p.choices}
        if asked & left:
            found.append(variant)
            left -= asked
    assert not left
    return found


@with_choices
@every_language
def test_no_code_name_of_a_case_is_shown_to_a_student(name, lang):
    for variant in sheets(name, lang):
        handout, study = variant.handout(), variant.study_sheet()
        shown = {
            "terminal": RENDERER.terminal(handout),
            "page": re.sub(r"<[^>]*>", " ", RENDERER.html(handout)),
            "notebook": "\n".join(cells(RENDERER.notebook(handout), "markdown")),
            "note": "\n".join(cells(RENDERER.notebook(handout), "code")),
            "study": "\n".join(
                [*cells(RENDERER.study(study), "markdown"), *cells(RENDERER.study(study), "code")]
            ),
        }
        for part in (p for p in variant.parts if p.choices):
            ids = {p.id for p in variant.exercise.spec.parts} | {*variant.given}
            for case in part.choices:
                label = to_text(variant.label(part.id, case), lang)
                if case in ids or not ({"_", "-"} & {*case}) or case.casefold() in label.casefold():
                    continue  # a name of a part, or a word that may stand anywhere
                for where, text in shown.items():
                    assert not re.search(rf"(?<![\w-]){case}(?![\w-])", text), (where, part.id, case)
        page = RENDERER.html(handout)
        values = re.findall(r'type="radio" name="[^"]*" value="([^"]*)"', page)
        assert set(values) <= set("abcdefghijklmnopqrstuvwxyz")
        assert not re.search(r"- `\w{2,}`[^`]*: ", shown["notebook"].partition("## ")[0])


@with_choices
@every_language
def test_letters_stand_with_their_words_in_every_format(name, lang):
    variant = sheets(name, lang)[0]
    handout = variant.handout()
    terminal, notebook = RENDERER.terminal(handout), RENDERER.notebook(handout)
    markdown, code = "\n".join(cells(notebook, "markdown")), "\n".join(cells(notebook, "code"))
    latex, page = RENDERER.tex(handout, ["figure.pdf"]), RENDERER.html(handout)
    for part, question in zip(variant.parts, handout.questions, strict=True):
        if not part.choices:
            continue
        assert [key for key, _ in question.choices] == list(variant.cases(part))
        assert question.letters == tuple("abcdefghijklmnopqrstuvwxyz"[: len(part.choices)])
        assert f'"{question.key}": "",  # ' in code
        assert re.search(rf'"{question.key}": "",  # .*{", ".join(question.letters)}', code)
        for letter, (_, label) in zip(question.letters, question.choices, strict=True):
            start = to_text(label, lang).split()[0]
            assert f"( ) {letter}) {start}" in terminal
            assert f"- `{letter}`" in markdown
            assert f'name="{question.id}" value="{letter}"' in page
            assert f"{{{letter})}}{{" in latex
    for answer, part in zip(variant.answer_sheet(polygons=False).answers, variant.parts, strict=True):
        if part.choices:
            assert answer.text == variant.called(part, variant.reference(part.quantity))


@with_choices
def test_the_letter_of_every_right_answer_is_right_and_of_every_other_is_not(name):
    for variant in sheets(name, "fr"):
        for part in (p for p in variant.parts if p.choices):
            right = variant.reference(part.quantity)
            for case, letter in variant.letters(part).items():
                mark = variant.grade({part.id: letter})[part.id]
                assert (mark.verdict == "correct") == (case == right), (part.id, letter)
                assert mark.read_as.startswith(f"{letter}) ")


OLD_NAMES = {
    "fr": {
        "point_contact": "une ponctuelle",
        "annular": "linéaire annulaire",
        "spherical": "rotule",
        "spherical_pin": "une rotule à doigt",
        "line_contact": "linéaire rectiligne",
    },
    "en": {
        "point_contact": "a point contact",
        "annular": "annular linear joint",
        "spherical": "a ball joint",
        "spherical_pin": "ball joint with pin",
        "line_contact": "line contact",
    },
}


@pytest.mark.parametrize("lang", OLD_NAMES)
@pytest.mark.parametrize("name", ["parallel_joints", "serial_joints"])
def test_a_joint_is_read_by_the_name_of_one_school_where_the_sheet_gives_both(name, lang):
    variant = sheets(name, lang)[0]
    (part,) = (p for p in variant.parts if p.id == "equivalent")
    for case, text in OLD_NAMES[lang].items():
        assert "(" in variant.label(part.id, case)
        read = variant.grade({part.id: text})[part.id].read_as
        assert read.startswith(f"{variant.letters(part)[case]}) ")
