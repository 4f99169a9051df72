"""Hints in steps: the quantities that an answer depends on, the words of the course, the formula, the formula
with numbers.

All of it is read from the solution's graph and texts. No step holds the value: numbers stand for what the
statement gives and for what the student has found; the rest stays a symbol, to be found first.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from coursework.course.answer_keys import answer_keys
from coursework.language.words import is_whole, words
from coursework.markup.formula_tree import tokens
from coursework.quantities.formula_latex import PrintedName, formula_latex, kind_of, number_latex
from coursework.rendering.views import chain_on_lines, given_formula, given_words
from coursework.selfstudy.wording import expect
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.following import needs
from coursework.sheets.handout import handout

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.model import Part
    from coursework.sheets.sheet import Step


_DIGITS = 6
_HERE = re.compile(r"(?<=[.!?])\s+\w+\s*:$")  # "Here:", with nothing behind it
_UNFINISHED = re.compile(r"(?:(?<=[.!?])|\A)[^.!?]*[^.!?\s]\s*\Z")
_LAST_SENTENCE = re.compile(r"(?:(?<=[.!?…])\s|\A)(?:[^.!?…]|[.!?…](?!\s|\Z))*[.!?…]\W*\Z")
_COMPUTED = re.compile(r"\{[{%#]")
_SENTENCE_END = re.compile(r"[.!?…](?=\s|\Z)|\s?:(?=\s|\Z)")
_NUMBER = re.compile(r"\\num\{[^{}]*\}")
_AROUND = re.compile(r"\^\{\\circ\}|\\left|\\right|\\ |[();\s-]")


def quantity_of(variant: Variant, name: str) -> str:
    """Return the quantity of a part's id, or of an intermediate step by its own name.

    Raises
    ------
    UnknownName
        Neither; the message has the nearest name.
    """
    by_part = {p.id: p.quantity for p in variant.parts}
    names = {**{q: q for q in variant.walk if q not in variant.given}, **by_part}
    if not isinstance(name, str) or name not in names:
        expect(variant.lang, "question", name, tuple(answer_keys(variant.parts).values()))
    return names[name]


def steps(
    variant: Variant,
    name: str,
    results: Mapping[str, float] = MappingProxyType({}),
    call: Callable[[str], str] = '`hint("{}")`'.format,
) -> tuple[str, ...]:
    """Return the hints for a part or an intermediate step, the vaguest first, as Markdown.

    ``results`` holds the quantities that the student has right, as the student has them; ``call`` says how to
    ask for the hints of another.
    """
    quantity = quantity_of(variant, name)
    requested = _asking_part(variant, quantity)
    if requested is not None and requested.sort.is_open:
        return (_look_again(variant, requested),)
    all_steps = (
        _depends(variant, quantity, call),
        words_of(variant, quantity),
        _formula(variant, quantity, {}),
        _formula(variant, quantity, {n: v for n, v in {**results, **variant.given}.items() if n != quantity}),
    )
    text = tuple(step for k, step in enumerate(all_steps) if step and step not in all_steps[:k])
    if text or (part := _asking_part(variant, quantity)) is None:
        return text
    return (_against(variant, part) or _look_again(variant, part),)


def _asking_part(variant: Variant, quantity: str) -> Part | None:
    """Return the part that asks for a quantity; None where there is none."""
    return next((p for p in variant.parts if p.quantity == quantity), None)


def _depends(variant: Variant, quantity: str, call: Callable[[str], str]) -> str:
    texts = words(variant.lang)["study"]["hint"]
    needed = needs(variant, quantity)
    text = {g.name for g in handout(variant).given}  # what a figure alone shows has no words
    given = [_given(variant, n) for n in needed if n in text]
    requested = {p.quantity: (k, p.id) for k, p in enumerate(variant.parts, start=1)}
    before = [
        texts["asked"].format(symbol=f"${variant.solution_symbol(n)}$", number=requested[n][0])
        for n in needed
        if n in requested and n not in variant.given
    ]
    between = [
        texts["between"].format(symbol=f"${variant.solution_symbol(n)}$", call=call(n))
        for n in needed
        if n not in requested
        and n not in variant.given
        and isinstance(variant.walk.get(n), (int, float, complex))
    ]
    pieces = [*given, *before, *between]
    return (
        texts["depends"].format(list=f"{words(variant.lang)['sheet']['separator']} ".join(pieces))
        if pieces
        else ""
    )


def _given(variant: Variant, name: str) -> str:
    given = next(g for g in handout(variant).given if g.name == name)
    return f"${given_formula(given)}$" if given.is_number else given_words(given, variant.lang)


def words_of(variant: Variant, quantity: str) -> str:
    """Return the solution's words before the step of a quantity, if they hold no computed number."""
    section = variant.solution_text.sections.get(quantity)
    if section is None or not section.text:
        return ""
    is_free, start = _is_free(variant, quantity), _before_numbers(variant, quantity)
    requested = _asking_part(variant, quantity)
    if requested is None or not requested.choices:
        return start or (section.text if is_free else "")
    text = section.text if is_free else start
    if not text:
        return ""
    # The words before a case break off where the answer follows: "Here the guide". A whole reason tells the
    # answer in its last sentence.
    if not is_whole(text):
        return _UNFINISHED.sub("", text).strip() or f"{text} …"
    return _LAST_SENTENCE.sub("", text).strip() if is_free else text


def _before_numbers(variant: Variant, section: str) -> str:
    """Return the sentences of a section before its first computed number."""
    path = variant.exercise.texts.file("solutions", variant.lang)
    start = _COMPUTED.split(sections(path, path.stat().st_mtime_ns).get(section, ""), maxsplit=1)[0]
    ends = [result.end() for result in _SENTENCE_END.finditer(start)]
    text = _HERE.sub("", start[: ends[-1]].strip()) if ends else ""
    return re.sub(r"\s*:$", ".", text)


def _against(variant: Variant, part: Part) -> str:
    """Return the reason against one wrong case of a choice among three or more; empty for anything else."""
    if len(part.choices) < 3:
        return ""
    step = next(s for s in answer_sheet(variant, polygons=False).steps if s.name == part.quantity)
    texts = words(variant.lang)["study"]["hint"]["against"]
    return next((texts.format(wrong=r.wrong, why=r.words) for r in step.remarks if r.wrong), "")


def _look_again(variant: Variant, part: Part) -> str:
    """Return the hint of last resort: to look at the cases, or at the statement for what its kind asks."""
    texts = words(variant.lang)["study"]["hint"]
    return texts["cases"] if part.choices else texts["kinds"].get(part.kind, texts["statement"])


def _is_free(variant: Variant, section: str) -> bool:
    path = variant.exercise.texts.file("solutions", variant.lang)
    used = variables(path, path.stat().st_mtime_ns).get(section)
    return used is not None and used <= variant.printed.keys()


@lru_cache(maxsize=256)
def sections(path: Path, changed: int) -> Mapping[str, str]:
    """Return the source of each section of a text."""
    from coursework.course.texts import parse

    return {
        name: section.text for name, section in parse(path.read_text("utf-8"), path.name).sections.items()
    }


@lru_cache(maxsize=256)
def variables(path: Path, changed: int) -> Mapping[str, frozenset[str]]:
    """Return the names that each section of a text prints; a section cut by a template block is left out."""
    import jinja2
    from jinja2 import meta

    env = jinja2.Environment()
    results = {}
    for name, text in sections(path, changed).items():
        try:
            results[name] = frozenset(meta.find_undeclared_variables(env.parse(text)))
        except jinja2.TemplateSyntaxError:
            continue
    return results


def _formula(variant: Variant, quantity: str, numbers: Mapping[str, Any]) -> str:
    """Return the formula with numbers for known quantities; empty where only words describe it or it would be
    the value."""
    values, units = variant.walk, variant.exercise.units
    kinds = {n: kind_of(value, units.get(n, "1")) for n, value in values.items()}
    symbols = {n: PrintedName(variant.solution_symbol(n), False, kinds[n]) for n in values}
    displayed = symbols | {
        n: PrintedName(number_latex(value, units.get(n, "1"), _DIGITS), True, kinds[n])
        for n, value in numbers.items()
        if isinstance(values.get(n), (int, float, complex))
    }
    function = variant.exercise.solution.graph.node(quantity).function
    try:
        formula = formula_latex(function, displayed)
        plain = formula_latex(function, symbols)
    except KeyError:
        return ""
    symbol = variant.solution_symbol(quantity)
    if not formula or formula == symbol or _is_value(formula) or not _names_something(plain):
        return ""
    return f"$${symbol} = {formula}$$"


def formula(variant: Variant, quantity: str) -> str:
    """Return the formula of a quantity in symbols, as Markdown; empty where only words describe it."""
    return _formula(variant, quantity, {})


def _is_value(latex: str) -> bool:
    """Return whether a formula is a number, or several numbers, with nothing left to compute."""
    return not _AROUND.sub("", _NUMBER.sub("", latex))


def _names_something(latex: str) -> bool:
    """Return whether a formula contains a symbol: one of numbers alone would give the value."""
    without = "".join(
        t for t in tokens(latex) if t not in (r"\num", r"\times", r"\frac", r"\left", r"\right")
    )
    return any(c.isalpha() for c in without)


def revealed_text(variant: Variant, name: str) -> str:
    """Return the complete step as Markdown; for a question marked by a person, its model answer or a note
    that it has none."""
    requested = next((p for p in variant.parts if p.id == name and p.sort.is_open), None)
    if requested is not None:
        models = (s.words for s in answer_sheet(variant).steps if s.name == requested.id)
        return next(models, words(variant.lang)["solution"]["by_hand"])
    quantity = quantity_of(variant, name)
    return step_text(next(s for s in answer_sheet(variant).steps if s.name == quantity))


def step_text(step: Step) -> str:
    """Return the words and the chain of a step as Markdown."""
    return "\n\n".join(filter(None, [step.words, f"$${chain_on_lines(step)}$$" if step.value else ""]))
