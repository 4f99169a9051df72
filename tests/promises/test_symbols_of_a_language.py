"""English writes a torque and the two ends of a machine otherwise than the notes do: in all that is printed
and drawn."""

import re

import pytest

import coursework
from coursework.course.symbols import Symbols
from coursework.errors import BadCourse
from coursework.figures import Figure, line, vector
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
RENDERER = renderer_of(COURSE.folder)
ENGLISH = COURSE.folder.symbols("en").stated
FOREIGN = {"en": [*ENGLISH], "fr": [value for value in ENGLISH.values() if len(value) > 1]}


def foreign(text, lang):
    """Return the pieces of LaTeX in a text that its language writes otherwise."""
    return [p for p in FOREIGN[lang] if re.search(rf"(?<![\\A-Za-z]){re.escape(p)}(?![A-Za-z0-9])", text)]


def with_such_symbols():
    """Yield the exercises whose Python names a quantity otherwise than English does."""
    for name in COURSE.names:
        spec, solution = COURSE[name].spec, COURSE[name].solution
        stated = [*spec.symbols.values(), *solution.symbols.values(), *map(spec.symbol, COURSE[name].units)]
        if foreign(" ".join(stated), "en"):
            yield name


def printed_and_drawn(name, lang):
    """Return the LaTeX of a sheet and of its solution, with the labels of their figures."""
    variant = COURSE[name].variant(3, lang)
    solved = variant.answer_sheet()
    labels = [
        repr(getattr(f, "elements", "")).replace("\\\\", "\\") for f in (*variant.figures, solved.figure)
    ]
    return "\n".join(
        [RENDERER.tex(variant.handout(), ["f"] * 4), RENDERER.tex(solved, ["f"] * 4, ["p"] * 4), *labels]
    )


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_sheets_solutions_and_figures_have_the_symbols_of_their_language(lang):
    names = [*with_such_symbols()]
    assert {"mechanical_advantage", "gear_train", "four_bar_torque"} <= {*names}
    assert not {name: found for name in names if (found := foreign(printed_and_drawn(name, lang), lang))}


def test_the_arcs_of_the_crank_have_one_symbol_in_all_exercises():
    arcs = {"alpha": r"\theta_a", "beta": r"\theta_r"}
    asked = [
        (name, p.quantity) for name in COURSE.names for p in COURSE[name].spec.parts if p.quantity in arcs
    ]
    assert len(asked) > 10
    assert not [(name, arc) for name, arc in asked if COURSE[name].symbol(arc, "fr") != arcs[arc]]


@pytest.mark.parametrize("name", COURSE.names)
def test_no_sheet_has_a_symbol_of_another_language(name):
    assert not {lang: found for lang in FOREIGN if (found := foreign(printed_and_drawn(name, lang), lang))}


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_no_text_of_the_course_has_a_symbol_of_another_language(lang):
    wrong = {}
    for path in sorted(COURSE.folder.root.glob(f"[es][xo]*/*/*.{lang}.md*")):
        prose = re.sub(r"^```.*?^```|^## .*?$", "", path.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
        if found := foreign(prose, lang):
            wrong[path.name] = found
    assert not wrong


def test_a_symbol_is_replaced_whole_and_the_longest_first():
    write = Symbols({"F_e": "F_i", r"\Gamma_e": "T_i", r"\Gamma": "T"})
    asked = [r"\Gamma_e / F_e", r"\Gamma_{13}", r"\Gammax", "F_{e}", "F_ex", r"\vec F_e", r"r_2\,\Gamma"]
    assert [write(one) for one in asked] == [
        "T_i / F_i",
        "T_{13}",
        r"\Gammax",
        "F_{e}",
        "F_ex",
        r"\vec F_i",
        r"r_2\,T",
    ]
    figure = Figure(line(0, 10, label="r_1"), vector(0, 5j, "F_e"))
    assert [e.label for e in figure.labelled(write).elements] == ["r_1", "F_i"]
    assert figure.labelled(Symbols({})) is figure


@pytest.mark.parametrize("stated", ["T", {"en": "T"}, {"en": {"F": 3}}, {"en": {"F": ""}}])
def test_symbols_of_another_form_are_refused(stated):
    with pytest.raises(BadCourse, match=r"course.toml: \[symbols.en\]"):
        Symbols.of({"symbols": stated}, "en", "course.toml", {})
