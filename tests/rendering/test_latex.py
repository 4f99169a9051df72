"""Promises of the LaTeX sources: they hold what the sheet shows, and nothing that LaTeX would obey."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import replace

import pytest
from formula_samples import FORMULAS, call
from rendering_samples import answer_sheet, handout, many_given
from sweeps import sampled, whole_course
from tables import each_row

from coursework.cli import run
from coursework.cli.options import DONE
from coursework.course.builtin import builtin_root
from coursework.issuing import build as building
from coursework.issuing import issuing
from coursework.markup.formula_tree import GRIDS, MACROS
from coursework.markup.latex import latex_text, plain_latex, to_latex
from coursework.markup.spoken import spoken
from coursework.rendering.latex import to_latex_markup
from coursework.rendering.renderer import PAPERS, Renderer

RENDERER = Renderer([builtin_root() / "templates"])
HOSTILE = (
    r"100% & {x}_#^~ \input{/etc/passwd} $y$ <a> [b] * -- `c' ,, "
    + "≥ θ₂ × 10⁻⁵ Žižek Ωmega 李 é\u0301 \u202f…"
)
PDFLATEX = shutil.which("pdflatex")

every_language = pytest.mark.parametrize("lang", ["fr", "en"])
with_pdflatex = pytest.mark.skipif(PDFLATEX is None, reason="pdflatex is not here")


def check_source(source: str) -> None:
    """Braces and environments close in order, and dollars come in pairs."""
    open_environments: list[str] = []
    depth = 0
    body = re.sub(r"(?m)(?<!\\)%.*$", "", source)
    for token in re.findall(r"\\(?:begin|end)\{[^}]*\}|\\(?:[A-Za-z]+|.)|[{}]", body, re.DOTALL):
        if token.startswith(r"\begin{"):
            open_environments.append(token[7:-1])
        elif token.startswith(r"\end{"):
            assert open_environments.pop() == token[5:-1]
        elif token in "{}":
            depth += 1 if token == "{" else -1
            assert depth >= 0
    assert depth == 0
    assert not open_environments
    assert len(re.findall(r"(?<!\\)\$", body)) % 2 == 0


def compile_latex(source: str, folder, name: str = "sheet") -> str:
    """The log of a run of pdflatex that wrote a PDF."""
    (folder / f"{name}.tex").write_text(source, "utf-8")
    command = [PDFLATEX, "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", f"{name}.tex"]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=120)
    log = done.stdout.decode("latin-1")
    assert done.returncode == 0, "\n".join(line for line in log.splitlines() if line.startswith(("!", "l.")))
    assert (folder / f"{name}.pdf").exists()
    return log


def document(*lines: str) -> str:
    packages = r"\usepackage[T1]{fontenc}\usepackage[utf8]{inputenc}\usepackage{textcomp,amsmath,amssymb}"
    return "\n".join([r"\documentclass{article}", packages, r"\begin{document}", *lines, r"\end{document}"])


# -- text and formulas ------------------------------------------------------------------------------


@every_language
def test_no_mark_of_latex_in_a_text_is_left_to_be_obeyed(lang):
    written = latex_text(r"100% & {x}_#^~\$", lang)
    assert written == (r"100\% \& \{x\}\_\#\textasciicircum{}\textasciitilde{}\textbackslash{}\$")
    check_source(latex_text(HOSTILE, lang))


def test_characters_that_latex_would_join_or_does_not_have_are_written_out():
    assert plain_latex("--") == "{-}{-}"
    assert plain_latex("[a]*") == "{[}a{]}{*}"
    assert plain_latex("θ₂") == r"\ensuremath{\theta}\textsubscript{2}"
    assert plain_latex("李") == r"\ensuremath{\square}"
    assert plain_latex("e\u0301") == "é"
    assert plain_latex("3\u202fmm\u00a0") == r"3\,mm~"


@each_row(
    ("tex", "fr", "en"),
    [
        (r"\num{-1234.5e-3}", r"{-}1234{,}5 \times 10^{-3}", r"{-}1234.5 \times 10^{-3}"),
        (r"\theta_4^2", r"\theta_{4}^{2}", r"\theta_{4}^{2}"),
        (
            r"\mathrm{rad/s^2}",
            r"\textnormal{rad/} {\textnormal{s}}^{2}",
            r"\textnormal{rad/} {\textnormal{s}}^{2}",
        ),
        (r"\mathrm{N\cdot m}", r"\textnormal{N·m}", r"\textnormal{N·m}"),
        (r"\operatorname{atan2}(y, x)", r"\operatorname{atan2} ( y , x )", r"\operatorname{atan2} ( y , x )"),
        (r"\text{100 % & #}", r"\textnormal{100 \% \& \#}", r"\textnormal{100 \% \& \#}"),
        (r"B''", r"B^{\prime \prime}", r"B^{\prime \prime}"),
    ],
)
def test_a_formula_is_written_with_the_numbers_of_its_language(tex, fr, en):
    assert to_latex(tex, "fr") == fr
    assert to_latex(tex, "en") == en


@each_row("tex", [f for f in FORMULAS if not re.search(r"num|text|mathrm|operatorname|'", f)])
def test_a_formula_read_back_from_its_source_says_the_same(tex):
    written = re.sub(r"\\mkern-?\d+mu|\\relax", " ", to_latex(tex, "en"))
    assert spoken(written, "en") == spoken(tex, "en")


@with_pdflatex
def test_every_macro_grid_and_formula_compiles(tmp_path):
    formulas = [
        *(call(macro) for macro in sorted(MACROS)),
        *(rf"\begin{{{kind}}} [a] & b \\ [c] & d \\ \end{{{kind}}}" for kind in GRIDS),
        *FORMULAS,
    ]
    compile_latex(document(*(f"${to_latex(tex, 'fr')}$\n" for tex in formulas)), tmp_path)


@with_pdflatex
def test_markdown_of_every_kind_and_hostile_text_compile(tmp_path):
    text = (
        "**Deux** mots, *un* `a_b%{}` $x$(y)\n\n1. [a]\n2. b\n\n- c\n\n| n | v |\n|:--|--:|\n| $x$ | 2 "
        "|\n| [z] | * |\n\n"
        "$$x = 1$$\n\n> note\n\n## Titre\n\n    code  {x} % \\y\n\n---\n\n[lien](http://a.b/c_d)"
    )
    written = to_latex_markup(text, "fr").replace(r"\toprule", "").replace(r"\midrule", "")
    check_source(written)
    latin = "".join(map(chr, [*range(0x20, 0x7F), *range(0xA0, 0x17F), *range(0x370, 0x400)]))
    lines = [written.replace(r"\bottomrule", ""), plain_latex(HOSTILE), plain_latex(latin)]
    compile_latex(document(*lines), tmp_path)


# -- sheets -----------------------------------------------------------------------------------------


@every_language
@each_row("make", [handout, answer_sheet, many_given])
def test_a_source_is_whole_and_the_same_twice(make, lang):
    source = RENDERER.tex(make(lang), ["figure.pdf"])
    check_source(source)
    assert source == RENDERER.tex(make(lang), ["figure.pdf"])
    assert (r"{figure.pdf}" in source) == (make is not many_given)


@every_language
def test_a_source_prints_names_as_they_are(lang):
    source = RENDERER.tex(handout(lang, student="100% & {x}_# \\end{document}"), ["figure.pdf"])
    assert r"\textbf{100\% \& \{x\}\_\# \textbackslash{}end\{document\}}" in source
    assert source.count(r"\end{document}") == 1
    check_source(source)


def test_a_source_names_its_paper_and_its_language():
    assert r"\documentclass[11pt,letterpaper]" in RENDERER.on("letter").tex(handout("en"), ["f.pdf"])
    source = RENDERER.tex(handout("fr"), ["f.pdf"])
    assert r"\documentclass[11pt,a4paper]" in source
    assert "french]{babel}" in source
    assert "{-}12{,}5" in source, "a French decimal comma"


@with_pdflatex
@every_language
def test_a_sheet_compiles_with_a_tex_that_lacks_its_language(lang, tmp_path):
    """Its words are then left whole, and babel is not asked for."""
    (tmp_path / "figure.pdf").write_bytes(RENDERER.figure_pdf(handout(lang)))
    source = RENDERER.tex(handout(lang), ["figure.pdf"])
    lacking = re.sub(r"(french|english)(?=\.ldf|\]\{babel)", r"\1ofnowhere", source)
    assert lacking.count("ofnowhere") == 2
    assert "babel.sty" not in compile_latex(lacking, tmp_path).replace("\n", "")


def test_a_box_has_its_unit_or_the_words_that_ask_for_one():
    sheet = handout("en")
    (question,) = [q for q in sheet.questions if q.id == "omega4"]
    with_unit = RENDERER.tex(replace(sheet, questions=(question,)), ["f.pdf"])
    asked = RENDERER.tex(replace(sheet, questions=(replace(question, unit="", asks_unit=True),)), ["f.pdf"])
    assert r"\answerbox{42mm}~rad/s}" in with_unit
    assert r"\answerbox{42mm}~{\small with its unit}}" in asked


@with_pdflatex
@every_language
@pytest.mark.parametrize("paper", PAPERS)
def test_a_sheet_and_its_solution_compile_with_a_hostile_name(lang, paper, tmp_path):
    sheet = answer_sheet(lang, student=HOSTILE)
    asks = tuple(replace(q, unit="", asks_unit=True) for q in sheet.handout.questions)
    (tmp_path / "figure.pdf").write_bytes(RENDERER.figure_pdf(sheet))
    for number, one in enumerate((sheet.handout, replace(sheet.handout, questions=asks), sheet)):
        log = compile_latex(RENDERER.on(paper).tex(one, ["figure.pdf"]), tmp_path, f"sheet{number}")
        assert "Missing character" not in log


def test_build_writes_sources_with_their_figures(tmp_path):
    out = tmp_path / "out"
    command = ["build", "slotted_mechanism", "four_bar_positions", "--formats", "tex", "--lang", "fr,en"]
    assert run([*command, "--out", str(out)]) == DONE
    sources = sorted(out.rglob("*.tex"))
    assert len(sources) == 8
    for source in sources:
        text = source.read_text("utf-8")
        check_source(text)
        shown = re.findall(r"\\includegraphics\[[^]]*\]\{([^}]*)\}", text)
        assert shown
        assert all((source.parent / name).read_bytes().startswith(b"%PDF") for name in shown)
    assert not list((out / "handouts").rglob("*solution*"))


@whole_course
@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
def test_every_exercise_has_a_whole_source(course, lang):
    issues = issuing.issue(course, course.names, first_seed=0, count=1, langs=[lang])
    for file in building.files(course, issues, ["tex"]):
        if file.path.suffix == ".tex":
            check_source(file.make().decode("utf-8"))
