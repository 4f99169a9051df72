"""A handout as plain text, to read in a terminal."""

from __future__ import annotations

import textwrap

from coursework.language.words import words
from coursework.markup.line import to_line
from coursework.markup.markdown import to_text
from coursework.rendering import views
from coursework.sheets.sheet import GivenValue, Handout, Question

WIDTH = 88


def statement(handout: Handout) -> str:
    """Return the statement, the given data and the questions as lines of at most 88 characters."""
    lang = handout.lang
    sheet_words = words(lang)["sheet"]
    code = views.variant_code(handout)
    total = views.points_text(handout.points, lang)
    parts = [
        "\n".join((handout.title, "=" * len(handout.title), f"{handout.course} | {code} | {total}")),
        to_text(handout.statement, lang, WIDTH),
    ]
    if handout.figure is not None:
        parts.append(
            textwrap.fill(f"[{sheet_words['figure']}{sheet_words['colon']} {handout.figure_alt}]", WIDTH)
        )
    for _, alt in handout.more_figures:
        parts.append(textwrap.fill(f"[{sheet_words['figure']}{sheet_words['colon']} {alt}]", WIDTH))
    if handout.given:
        lines = (f"  {_given(given, lang)}" for given in handout.given)
        parts.append("\n".join([sheet_words["data"], *lines]))
    parts += [_question(question, lang) for question in handout.questions]
    parts += [
        f"{sheet_words['tolerance']}{sheet_words['colon']} {f'{numbers}, ' if numbers else ''}{margin}"
        for numbers, margin in views.tolerances(handout.questions, lang)
    ]
    return "\n\n".join(parts) + "\n"


def _given(given: GivenValue, lang: str) -> str:
    if given.is_number:
        return to_line(views.given_formula(given), lang)
    return to_text(views.given_words(given, lang), lang)


def _question(question: Question, lang: str) -> str:
    mark = f"{question.number:2d}. "
    unit = words(lang)["sheet"]["with_unit"] if question.asks_unit else question.unit
    details = [question.id, unit, views.points_text(question.points, lang)]
    body = to_text(question.prompt, lang, WIDTH - len(mark))
    lines = [body, f"[{', '.join(filter(None, details))}]"]
    for letter, label in views.offered(question):
        marked = words(lang)["choices"]["lettered"].format(letter, label) if letter else label
        lines.append(
            textwrap.fill(f"( ) {to_text(marked, lang)}", WIDTH - len(mark), subsequent_indent=" " * 7)
        )
    return mark + textwrap.indent("\n".join(lines), " " * len(mark)).lstrip()
