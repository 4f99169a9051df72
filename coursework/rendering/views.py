"""Values that templates place and should not compute: codes, plurals, groups of questions."""

from __future__ import annotations

import keyword
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, TypeAlias

from coursework.figures.text import SIZE, LetterRun
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.markup.formula_tree import LETTERS, tokens
from coursework.markup.formulas import quantity_formula
from coursework.markup.line import to_line
from coursework.markup.markdown import to_text
from coursework.messages import number_form
from coursework.sheets.sheet import Answer, AnswerSheet, FeedbackSheet, GivenValue, Handout, Question, Step

if TYPE_CHECKING:
    from coursework.figures import Beginning, Figure, Picture
    from coursework.figures.polygons.construction import SideRow

Sheet: TypeAlias = Handout | AnswerSheet | FeedbackSheet

#: Room that a figure has on paper, width and height in mm: beside the data, and with the data below it.
ROOM_BESIDE, ROOM_ALONE = (112.0, 62.0), (165.0, 72.0)
ROOM_DATA = 46.0  #: width of the data beside it, whose longer lines are broken
ROOM_STEP = (53.0, 200.0)  #: of a step of a construction, three of which stand side by side
#: What a figure, the paper to draw on below it and the statement above it take of a page together; the least
#: and the most of it that is the figure's, and a line of text, mm; letters in one.
_PAGE, _BY_PAPER, _LINE_MM, _LETTERS = 229.0, (48.0, 66.0), 5.5, 95
GUIDE_TOGETHER = 16  #: rows at most of a marking guide that no page's end may cut
#: So many questions at most leave a page some height, and each that there are fewer some more, mm; so many at
#: least go on to a second page, and leave the first some.
_FEW, _LEFT, _EACH = 8, 14.0, 6.0
_MANY, _LEFT_BY_MANY = 14, (14.0, 22.0)  #: with the data beside the figure, and below it
_FULL = 25  #: so many at least fill the second page too
SHORT_SOLUTION = 3  #: steps at most to an answer that stands with its question on one page
LAST_TOGETHER = 4  #: questions at least that a sheet's last page holds, where a page's end parts them
_BESIDE = 9  #: data at most that stand beside the figure

#: The template of each type of sheet; its last part is the name by which the template sees the sheet.
TEMPLATES = {Handout: "sheet/sheet", AnswerSheet: "sheet/solution", FeedbackSheet: "feedback/feedback"}


def handout_of(sheet: Sheet) -> Handout:
    return sheet if isinstance(sheet, Handout) else sheet.handout


def _kind(sheet: Sheet) -> str:
    return TEMPLATES[type(sheet)].rpartition("/")[2]


def context(sheet: Sheet, index: int = 0, *, numbered: bool = True) -> dict[str, object]:
    """Return the names that a page's template sees; ``index`` is that of the exercise in a paper, 0 where it
    stands alone, and its questions have it before their numbers where they are ``numbered``."""
    handout = handout_of(sheet)
    prefix = f"{index}." if index and numbered else ""
    return {
        "sheet": handout,
        _kind(sheet): sheet,
        "lang": handout.lang,
        "words": words(handout.lang),
        "title": title(sheet),
        "figure": figure_of(sheet),
        "beside": _data_beside(sheet),
        "room": room(sheet),
        "data_width": _data_width(handout),
        "step_room": ROOM_STEP,
        "summary_mm": SUMMARY_MM,
        "guide_together": GUIDE_TOGETHER,
        "together": LAST_TOGETHER,
        "short_solution": SHORT_SOLUTION,
        "polygon_mm": POLYGON_MM,
        "more_figures": more_figures(sheet),
        "figure_alt": (sheet.figure_alt if isinstance(sheet, AnswerSheet) else "") or handout.figure_alt,
        "variant": variant_code(handout),
        "tolerances": tolerances(handout.questions, handout.lang, prefix),
        "place": index,
        "prefix": prefix,
        "own": f"e{index}-" if index else "",
        "level": 3 if index else 2,
    }


def variant_code(handout: Handout) -> str:
    """Return the code that identifies a sheet: exercise, seed and version."""
    return f"{handout.exercise} · {handout.seed} · v{handout.version}"


def figure_of(sheet: Sheet) -> Figure | Picture | None:
    """Return the figure a sheet shows, laid out for its room: a solution's own, else the handout's."""
    figure = _figure_of(sheet)
    return figure and figure.fitted(*room(sheet))


def more_figures(sheet: Sheet) -> tuple[tuple[Figure | Picture, str], ...]:
    """Return the figures besides the first, laid out for the width of a page, each with what it shows."""
    return tuple((figure.fitted(*ROOM_ALONE), alt) for figure, alt in handout_of(sheet).more_figures)


def room(sheet: Sheet) -> tuple[float, float]:
    """Width and height in mm that a sheet leaves its figure."""
    handout, is_beside = handout_of(sheet), _data_beside(sheet)
    wide, tall = ROOM_BESIDE if is_beside else ROOM_ALONE
    # Paper to draw on stands below the figure, on the same page if it may.
    if handout.drawing_mm and isinstance(sheet, Handout):
        return wide, _by_paper(handout.drawing_mm[1], len(handout.statement))
    return wide, tall + _left(len(handout.questions), is_beside)


def _by_paper(paper: int, letters: int) -> float:
    """Height of a figure above so many mm of paper to draw on, below a statement of so many letters."""
    least, most = _BY_PAPER
    return float(round(min(most, max(least, _PAGE - paper - _LINE_MM * letters / _LETTERS))))


def _left(questions: int, is_beside: bool) -> float:
    """Return the height that the questions of a sheet leave to its figure on a page, mm."""
    if _MANY <= questions < _FULL:
        return _LEFT_BY_MANY[0 if is_beside else 1]
    return _LEFT + _EACH * (_FEW - questions) if is_beside and questions <= _FEW else 0.0


def _figure_of(sheet: Sheet) -> Figure | Picture | None:
    figure = sheet.figure if isinstance(sheet, AnswerSheet) else None
    return figure or handout_of(sheet).figure


def _data_beside(sheet: Sheet) -> bool:
    """Return whether the data stand beside the figure; a longer list stands below it."""
    return _figure_of(sheet) is not None and 0 < len(handout_of(sheet).given) <= _BESIDE


def _data_width(handout: Handout) -> str:
    """Of the data beside a figure: what they take where each surely is on one line, else all the room they
    have."""
    texts = (given_words(datum, handout.lang) for datum in handout.given if not datum.is_number)
    return "auto" if all(_surely_fits(text, ROOM_DATA, handout.lang) for text in texts) else f"{ROOM_DATA}mm"


def polygon_drawings(sheet: Sheet) -> tuple[Figure | Beginning, ...]:
    """Return the drawings of a solution's polygons in the order in which it shows them: steps, then the
    whole."""
    stated = sheet.polygons if isinstance(sheet, AnswerSheet) else ()
    drawings: list[Figure | Beginning] = []
    for polygon in stated:
        drawings += (*(step.figure for step in polygon.steps), polygon.figure)
    return tuple(drawings)


def title(sheet: Sheet) -> str:
    """Return the document's title: the exercise's, and what this sheet is when it is not the student's."""
    handout = handout_of(sheet)
    kind = _kind(sheet)
    return handout.title if kind == "sheet" else f"{handout.title} – {words(handout.lang)[kind]['title']}"


def points_text(points: float, lang: str) -> str:
    """``0,5 point``, ``2 points``."""
    return f"{points_number(points, lang)} {words(lang)['sheet']['points'][number_form(points, lang)]}"


def points_number(points: float, lang: str) -> str:
    """Return points as they are printed: as stated, at most to a thousandth, else to a hundredth."""
    stated = round(points, 3)
    return localise(plain(stated if abs(points - stated) < 1e-9 else round(points, 2)), lang)


def renumbered(text: str, lang: str, prefix: str) -> str:
    """Return the questions that a sentence names by their numbers, with what stands before these in a
    paper."""
    if not prefix:
        return text
    noun, marking = words(lang)["sheet"]["question"], words(lang)["marking"]
    joins = "|".join(re.escape(word) for word in (", ", f" {marking['and']} ", f" {marking['or']} "))
    named = rf"\b(?:{noun['one']}|{noun['many']}) \d+(?:(?:{joins})\d+)*"
    return re.sub(named, lambda match: re.sub(r"\d+", rf"{prefix}\g<0>", match[0]), text, flags=re.IGNORECASE)


def given_formula(given: GivenValue) -> str:
    return quantity_formula(given.symbol, given.value, given.unit, is_number=given.is_number)


def given_words(given: GivenValue, lang: str) -> str:
    """Return a given case as Markdown: ``Mode : ouvert`` where its symbol is a word, ``$B$ : à gauche``
    else."""
    word = re.fullmatch(r"\\(?:text|mathrm)\{([^{}]+)\}", given.symbol)
    name = word[1].capitalize() if word else f"${given.symbol}$"
    return f"{name}{words(lang)['sheet']['colon']} {given.value}"


def value_formula(given: GivenValue) -> str:
    return quantity_formula("", given.value, given.unit, is_number=given.is_number)


def tolerances(questions: Sequence[Question], lang: str, prefix: str = "") -> tuple[tuple[str, str], ...]:
    """Return the margins in words, each with the questions it holds for; none named when all share one.

    ``prefix`` stands before the number of a question: ``2.`` in the second exercise of a paper.
    """
    groups: dict[str, list[int]] = {}
    for question in questions:
        if question.tolerance:
            groups.setdefault(question.tolerance, []).append(question.number)
    if len(groups) == 1 and all(q.tolerance or q.is_exact for q in questions):
        return tuple(("", words_of_group) for words_of_group in groups)
    noun = words(lang)["sheet"]["question"]
    return tuple(
        (f"{noun['one' if len(numbers) == 1 else 'many']} {_ranges(numbers, prefix)}", words_of_group)
        for words_of_group, numbers in groups.items()
    )


def _ranges(numbers: Sequence[int], prefix: str) -> str:
    runs: list[list[int]] = []
    for number in sorted(numbers):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(_range([f"{prefix}{number}" for number in run]) for run in runs)


def _range(run: Sequence[str]) -> str:
    return ", ".join(run) if len(run) <= 2 else f"{run[0]}–{run[-1]}"


def worked(solution: AnswerSheet, lang: str, prefix: str = "") -> tuple[tuple[Answer, tuple[Step, ...]], ...]:
    """Each answer with the steps that lead to it, those shown with an earlier one left out.

    Steps stand in the order in which they follow from one another; what no question asks goes with the last.
    """
    named = {part["id"]: part["quantity"] for part in _parts(solution.handout)}
    step_numbers = {step.name: number for number, step in enumerate(solution.steps, 1)}
    position, numbered = 0, []
    for answer in solution.answers:
        end = step_numbers.get(named.get(answer.question.id, answer.question.id), 0)
        if answer is solution.answers[-1]:
            end = len(solution.steps)
        steps = (_below(answer.question, step, lang, prefix) for step in solution.steps[position:end])
        numbered.append((answer, tuple(steps)))
        position = max(position, end)
    return tuple(numbered)


def _below(question: Question, step: Step, lang: str, prefix: str) -> Step:
    """Return a step as it stands below its question, whose number it need not say."""
    heading = rf"\*{words(lang)['sheet']['question']['one']} {question.number}\.\*\s*"
    text = re.sub(rf"^{heading}", "", step.words, flags=re.IGNORECASE)
    return replace(step, words=renumbered(text, lang, prefix))


def _parts(handout: Handout) -> Sequence[Mapping[str, str]]:
    parts = handout.record.get("parts", ())
    assert isinstance(parts, Sequence)
    return parts


@lru_cache(maxsize=256)
def chain(step: Step) -> tuple[str, ...]:
    """Return the equalities of a worked step, in order: formula, numbers put in, value; those that add
    something."""
    value = "".join(step.value.split())
    repeats = value.startswith("".join(step.substitution.split()))
    parts = (_without_idle_signs(step.formula), "" if repeats else _without_idle_signs(step.substitution))
    return tuple(filter(None, (*parts, step.value)))


#: A multiplication sign says nothing before a letter or the name of a function.
_IDLE_SIGN = re.compile(r"\s*\\times\s+(?=[A-Za-z]|\\(?!num|left|frac|vec|overrightarrow))")


def _without_idle_signs(latex: str) -> str:
    return _IDLE_SIGN.sub(r"\\,", latex)


@lru_cache(maxsize=256)
def _is_equation(step: Step) -> bool:
    return any(token == "=" for token in tokens(step.value))


@lru_cache(maxsize=256)
def chain_on_one_line(step: Step) -> str:
    return " = ".join(chain(step) if _is_equation(step) else (step.symbol, *chain(step)))


def chain_on_lines(step: Step) -> str:
    if _is_equation(step):
        return chain_on_one_line(step)
    lines = [line for member in chain(step) for line in _broken(member)]
    return r"\begin{aligned} " + step.symbol + " " + r" \\ ".join(lines) + r" \end{aligned}"


_SURELY_FITS = 85  #: characters of a formula written out that a printed line holds, however wide they are


def is_short(step: Step, lang: str) -> bool:
    """Return whether the step's chain surely fits on one line."""
    return len(to_line(chain_on_one_line(step), lang)) <= _SURELY_FITS


def fits_on_lines(step: Step, lang: str) -> bool:
    """Return whether each equality of the step's chain surely fits on a line of its own."""
    if _is_equation(step):
        return False
    width = len(to_line(step.symbol, lang)) + 3
    lines = (line for member in chain(step) for line in _broken(member))
    return all(width + len(to_line(line.replace("&", ""), lang)) <= _SURELY_FITS for line in lines)


_LINE = 85  #: characters of a formula written out that a printed line holds


@lru_cache(maxsize=256)
def _broken(member: str) -> tuple[str, ...]:
    """Return a member of a chain as lines of an aligned formula, cut before its signs where it is too
    wide."""
    terms = _terms(member)
    width = len(to_line(member, "en"))
    count = min(len(terms), -(-width // _LINE))
    lines, share = [""], width / count
    for term in terms:
        if lines[-1] and len(lines) < count and len(to_line(lines[-1] + term, "en")) > 1.1 * share:
            lines.append("")
        lines[-1] += term
    return f"&= {lines[0]}", *(rf"&\quad {line}" for line in lines[1:])


def _terms(latex: str) -> list[str]:
    """Return the terms of a sum, each with the sign before it; what brackets hold is one with its term."""
    terms, depth, before = [""], 0, ""
    for token in tokens(latex):
        depth += (token in ("{", "(", r"\left")) - (token in ("}", ")", r"\right"))
        # The bracket after \left has been counted with it.
        depth -= (before == r"\left" and token == "(") - (before == r"\right" and token == ")")
        if depth == 0 and token in "+-" and terms[-1].strip():
            terms.append("")
        terms[-1] += token
        before = token
    return terms


def quantity_words(question: Question, lang: str) -> str:
    """Return the name of an answer without a symbol in a solution's summary."""
    return words(lang)["solution"]["kinds"].get(question.kind, question.id)


def margin_words(answer: Answer, lang: str) -> str:
    """Return the accepted deviation from the reference, in the summary's few words."""
    solution_words = words(lang)["solution"]
    margin = f"±\N{NO-BREAK SPACE}{answer.margin}" if answer.margin else answer.question.tolerance
    if answer.question.room:
        return solution_words["none"]
    if not margin:
        return solution_words["together" if answer.question.judge else "exact"]
    return solution_words["margins"].get(answer.question.kind, "{0}").format(margin)


#: What a table's row on one line takes, without an arrow over a letter and with one, mm; and the sides of a
#: cell.
_ROW, _ROW_WITH_ARROW, _SIDES = 6.2, 7.0, 4.5
_ARROW = re.compile(r"\\(?:vec|overrightarrow)")
_BRACKET = re.compile(r"\\left|\\right.\^?")
_MACRO = re.compile(r"\\(?:[A-Za-z]+|.)", re.DOTALL)
#: Macros that make a formula no taller than a line of text with its scripts; any other may.
_LOW = frozenset(
    rf"\{name}"
    for name in (
        *LETTERS,
        "num",
        "mathrm",
        "text",
        "dot",
        "ddot",
        "vec",
        "overrightarrow",
        "left",
        "right",
        "times",
        "cdot",
        "pm",
        "circ",
        "parallel",
        "perp",
        "infty",
        "prime",
        "sin",
        "cos",
        "tan",
        "mkern",
        ",",
        " ",
        ";",
        ":",
    )
)
#: Blocks of Markdown, which are not lines of text.
_BLOCK = re.compile(r"\s*(?:[#>*+|-]\s|\d+[.)]\s)|.*(?:\n|\$\$)", re.DOTALL)

#: Widths of the columns of a solution's summary and of a polygon's table, mm; what is left is the answer's,
#: or the length's.
SUMMARY_MM = {"number": 10, "quantity": 24, "answer": 84, "margin": 36, "points": 16}
POLYGON_MM = {"name": 24, "direction": 22, "length": 59, "segment": 31, "paper": 14, "value": 20}


def summary_row(answer: Answer, lang: str) -> str:
    """Return the height of a row of a solution's summary."""
    question, wide = answer.question, SUMMARY_MM
    named = f"${question.symbol}$" if question.symbol else quantity_words(question, lang)
    margin = margin_words(answer, lang)
    return _row(lang, (named, wide["quantity"]), (answer.text, wide["answer"]), (margin, wide["margin"]))


def polygon_row(row: SideRow, lang: str) -> str:
    """Return the height of a row of a polygon's table."""
    cells = {name: getattr(row, name) for name in ("name", "direction", "length", "segment")}
    return _row(lang, *((f"${tex}$", POLYGON_MM[name]) for name, tex in cells.items() if tex))


def _row(lang: str, *cells: tuple[str, float]) -> str:
    """Return the height of a row of cells, each of Markdown and so many mm wide; ``auto`` unless all are
    surely on one line, since the typesetter sets a row twice to find its height."""
    if not all(_is_low(text) and _surely_fits(text, wide, lang) for text, wide in cells):
        return "auto"
    return f"{_ROW_WITH_ARROW if any(_ARROW.search(text) for text, _ in cells) else _ROW}mm"


def _is_low(markdown: str) -> bool:
    low = not _BLOCK.match(markdown) and _LOW.issuperset(_MACRO.findall(markdown))
    return low and not _has_power_inside(markdown)


def _has_power_inside(latex: str) -> bool:
    """Return whether a bracket holds another one with an exponent, and so is drawn taller than a line."""
    depth = 0
    for bracket in _BRACKET.findall(latex):
        depth += 1 if bracket == r"\left" else -1
        if depth and bracket.endswith("^"):
            return True
    return False


@lru_cache(maxsize=2048)
def _surely_fits(markdown: str, wide: float, lang: str) -> bool:
    """Return whether a cell holds a text on one line, by its width less its padding, with letters measured
    generously."""
    text = re.sub("[_^\N{COMBINING RIGHT ARROW ABOVE}]", "", to_text(markdown, lang, sys.maxsize))
    return 1.2 * LetterRun(text, italic=False).width * SIZE <= wide - _SIDES


def offered(question: Question) -> tuple[tuple[str, str], ...]:
    """Return the choices as a sheet prints them: letter and label; the letter is empty on a sheet issued
    without."""
    letters = question.letters or ("",) * len(question.choices)
    return tuple((letter, label) for letter, (_, label) in zip(letters, question.choices, strict=True))


#: Width of all choices; of a box and its letter; between columns.
_CHOICES_MM, _BOX_MM, _BETWEEN_MM = (146.0, 11.0, 4.0)


def columns(question: Question, lang: str) -> int:
    """In how many columns the choices stand: as many as hold each label on one line, one row of four at
    most."""
    count = len(question.choices)
    for wanted in {3: (3,), 4: (4, 2)}.get(count, (3, 2)):
        room = _CHOICES_MM / wanted - _BOX_MM - _BETWEEN_MM
        if wanted <= count and all(_surely_fits(label, room, lang) for _, label in question.choices):
            return wanted
    return 1


def column_of(question: Question, lang: str) -> str:
    """Return the share of a line that a column of choices takes."""
    return f"{0.97 / columns(question, lang):.2f}"


def python_name(name: str) -> str:
    """Return a quantity's public name as a Python variable: the same, unless Python keeps the word for
    itself."""
    return name + "_" if keyword.iskeyword(name) else name


def answer_comment(question: Question, lang: str, prefix: str = "") -> str:
    """Return the comment beside an answer in a notebook: the question's number where its key is another, its
    unit, the letters of a choice, or the form of the answer."""
    texts = words(lang)
    if question.choices and question.box != "several":
        offered = question.letters or [to_text(label, lang, sys.maxsize) for _, label in question.choices]
        note = texts["notebook"]["one_of"].format(", ".join(offered))
    else:
        unit = texts["sheet"]["with_unit"] if question.asks_unit else question.unit
        note = ", ".join(filter(None, (texts["hints"].get(question.kind, question.hint), unit)))
    key = question.key or question.id
    number = (
        "" if key == f"q{question.number}" else texts["notebook"]["question"].format(prefix, question.number)
    )
    note = f"{texts['sheet']['colon']} ".join(filter(None, (number, note)))
    return f"  # {note}" if note else ""
