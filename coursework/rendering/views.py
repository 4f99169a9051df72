"""What the templates place and should not work out: codes, plurals, groups of questions."""

from __future__ import annotations

import keyword
from collections.abc import Sequence
from typing import TypeAlias

from coursework.handout import AnswerSheet, FeedbackSheet, Given, Handout, Question, Step
from coursework.language import localise, plain, words
from coursework.rendering.formulas import quantity_formula

Sheet: TypeAlias = Handout | AnswerSheet | FeedbackSheet

#: The template of each type of sheet.
TEMPLATES = {Handout: "sheet", AnswerSheet: "solution", FeedbackSheet: "feedback"}


def handout_of(sheet: Sheet) -> Handout:
    return sheet if isinstance(sheet, Handout) else sheet.handout


def context(sheet: Sheet) -> dict[str, object]:
    """The names that a page's template sees."""
    handout = handout_of(sheet)
    return {
        "sheet": handout,
        TEMPLATES[type(sheet)]: sheet,
        "lang": handout.lang,
        "words": words(handout.lang),
        "title": title(sheet),
        "figure": (sheet.figure if isinstance(sheet, AnswerSheet) else None) or handout.figure,
        "variant": f"{handout.exercise} · {handout.seed} · v{handout.version}",
        "tolerances": tolerances(handout.questions, handout.lang),
    }


def title(sheet: Sheet) -> str:
    """The document's title: the exercise's, and what this sheet is when it is not the student's."""
    handout = handout_of(sheet)
    kind = TEMPLATES[type(sheet)]
    return handout.title if kind == "sheet" else f"{handout.title} – {words(handout.lang)[kind]['title']}"


def points_text(points: float, lang: str) -> str:
    """``0,5 point``, ``2 points``: French is singular below two, English at one only."""
    singular = points < 2 if words(lang)["numbers"]["one_below_two"] else points == 1
    word = words(lang)["sheet"]["points"]["one" if singular else "many"]
    return f"{points_number(points, lang)} {word}"


def points_number(points: float, lang: str) -> str:
    return localise(plain(round(points, 3)), lang)


def verdict_word(verdict: str, lang: str) -> str:
    """A verdict in the sheet's language; what follows its colon names a mistake and is not shown."""
    return words(lang)["verdicts"][verdict.partition(":")[0]]


def given_formula(given: Given) -> str:
    return quantity_formula(given.symbol, given.value, given.unit, is_number=given.is_number)


def value_formula(given: Given) -> str:
    return quantity_formula("", given.value, given.unit, is_number=given.is_number)


def tolerances(questions: Sequence[Question], lang: str) -> tuple[tuple[str, str], ...]:
    """The margins in words, each with the questions it holds for; none named when all share one."""
    groups: dict[str, list[int]] = {}
    for question in questions:
        if question.tolerance:
            groups.setdefault(question.tolerance, []).append(question.number)
    if len(groups) == 1 and all(
        q.tolerance or q.kind in ("choice", "integer", "equation") for q in questions
    ):
        return tuple(("", said) for said in groups)
    noun = words(lang)["sheet"]["question"]
    return tuple(
        (f"{noun['one' if len(numbers) == 1 else 'many']} {_ranges(numbers)}", said)
        for said, numbers in groups.items()
    )


def _ranges(numbers: Sequence[int]) -> str:
    runs: list[list[int]] = []
    for number in sorted(numbers):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(
        str(run[0]) if len(run) == 1 else f"{run[0]}, {run[1]}" if len(run) == 2 else f"{run[0]}–{run[-1]}"
        for run in runs
    )


def chain(step: Step) -> tuple[str, ...]:
    """What a worked step equals, in order: formula, numbers put in, value; those that it has."""
    return tuple(filter(None, (step.formula, step.substitution, step.value)))


def chain_on_one_line(step: Step) -> str:
    return " = ".join((step.symbol, *chain(step)))


def chain_on_lines(step: Step) -> str:
    first, *others = chain(step)
    lines = [f"{step.symbol} &= {first}", *(f"&= {other}" for other in others)]
    return r"\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}"


def python_name(name: str) -> str:
    """A quantity's public name as a Python variable: the same, unless Python keeps the word for itself."""
    return name + "_" if keyword.iskeyword(name) else name


def answer_comment(question: Question, lang: str) -> str:
    """What a notebook says beside an answer: its unit, the keys of a choice, or the form it takes."""
    said = words(lang)
    if question.choices:
        keys = ", ".join(f"{key} ({label})" if key != label else key for key, label in question.choices)
        note = said["notebook"]["one_of"].format(keys)
    else:
        note = ", ".join(filter(None, (said["hints"].get(question.kind, ""), question.unit)))
    return f"  # {note}" if note else ""
