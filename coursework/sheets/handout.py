"""Content of a student's sheet: the statement, the data, the questions with their margins."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

from coursework.course.answer_keys import answer_keys
from coursework.language.numbers import localise, plain, unit_text
from coursework.language.words import words as engine_words
from coursework.markup.markdown import plain_line
from coursework.model import Part
from coursework.sheets.cells import cells_of, form_of
from coursework.sheets.sheet import GivenValue, Handout, Question
from coursework.sheets.units import units_text

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def handout(variant: Variant, student: str = "") -> Handout:
    """Return the content of a student's sheet; without a name by default.

    Raises
    ------
    BadStatement
        A part has no section in the statement.
    """
    return replace(_unnamed(variant), student=student)


@lru_cache(maxsize=16)  # a variant is rendered in every format before the next
def _unnamed(variant: Variant) -> Handout:
    exercise, text, lang = variant.exercise, variant.text, variant.lang
    return Handout(
        lang=lang,
        course=exercise.folder.title(lang),
        exercise=exercise.name,
        version=exercise.version,
        seed=variant.seed,
        student="",
        title=text.title,
        statement=text.opening,
        given=tuple(
            _given(variant, name)
            for name, spec in exercise.spec.given.items()
            if spec.is_listed(variant.part_ids)
        ),
        figure=variant.figure,
        figure_alt=" ".join(text.section("figure").text.split()) if exercise.spec.figure else "",
        more_figures=tuple(
            (figure, " ".join(text.section(f"figure {k}").text.split()))
            for k, figure in enumerate(variant.figures[1:], start=2)
        ),
        questions=tuple(
            _question(variant, n, p, ways)
            for n, (p, ways) in enumerate(zip(variant.parts, _ways_to_write(variant), strict=True), start=1)
        ),
        record=variant.record,
        drawing_mm=exercise.spec.drawing_mm,
        surface_mm=exercise.spec.surface_mm,
    )


def _given(variant: Variant, name: str) -> GivenValue:
    spec, value = variant.exercise.spec.given[name], variant.given[name]
    symbol = variant.symbol(name)
    if spec.is_choice:
        return GivenValue(name, symbol, variant.text.label(name, value), "", is_number=False)
    return GivenValue(name, symbol, plain(value), unit_text(spec.unit, variant.lang))


def _ways_to_write(variant: Variant) -> list[tuple[str, ...]]:
    """For each part, what its sheet has not said yet of how equations of loops are written."""
    met: list[tuple[str, ...]] = []
    texts = []
    for part in variant.parts:
        new: tuple[str, ...] = ()
        if part.loop and part.id not in variant.text.sections and part.variables not in met:
            new = ("symbols",) if met else ("symbols", "how")
            met.append(part.variables)
        texts.append(new)
    return texts


def prompt(variant: Variant, part: Part, ways: Iterable[str] = ()) -> str:
    """Return the text of a question: its section of the statement. An equation of a loop without one gets the
    engine's words after the section of its loop, and the ``ways`` to write it: ``symbols``, ``how``.

    Raises
    ------
    BadStatement
        The statement has no such section.
    """
    if not part.loop or part.id in variant.text.sections:
        return variant.text.section(part.id).text
    table = engine_words(variant.lang)["loop"]
    loop = variant.text.section(part.loop).text
    form = part.quantity.removeprefix(f"{part.loop}_")
    symbols = ", ".join(f"`{name}`" for name in part.variables)
    return " ".join([loop, *(table[key].format(symbols=symbols) for key in (form, *ways))])


def _question(variant: Variant, number: int, part: Part, ways: Sequence[str]) -> Question:
    choices = tuple((case, variant.text.label(part.id, case)) for case in variant.cases(part))
    return Question(
        number=number,
        id=part.id,
        symbol=variant.symbol(part.quantity) if part.sort.has_symbol else "",
        prompt=prompt(variant, part, ways),
        unit="" if part.asks_unit else units_text(part, variant.lang, variant),
        kind=part.kind,
        is_exact=part.is_exact,
        is_open=part.sort.is_open,
        box="millimetre" if part.millimetre else part.sort.box,
        rule=engine_words(variant.lang)["rules"][part.kind] if part.sort.has_rule else "",
        room=part.room,
        hint=part.sort.hint.get(variant.lang, ""),
        choices=choices,
        letters=tuple(variant.letters(part).values()),
        points=part.points,
        tolerance=tolerance_words(part, variant.lang),
        asks_unit=part.asks_unit,
        judge=part.judge,
        key=answer_keys(variant.parts)[part.id],
        keys=_keys(variant, part),
        types_numbers=not (part.sort.is_text or part.sort.is_open or part.choices or part.asks_unit),
        cells=cells_of(variant, part),
        cells_form=form_of(variant, part),
    )


_SIGNS = {"-": "−", "*": "·", "√(": "√", "cos(": "cos", "sin(": "sin"}  #: as keys show them


def _keys(variant: Variant, part: Part) -> tuple[tuple[str, str], ...]:
    """Return the keys of a part: what each shows, and what it types."""
    shown = {name: plain_line(f"${variant.symbol(name)}$", variant.lang) for name in part.variables}
    decimal = localise("0.5", variant.lang)[1]
    typed = (decimal if key == "," else key for key in part.sort.keys(part))
    return tuple((shown.get(key) or _SIGNS.get(key, key), key) for key in typed)


def tolerance_words(part: Part, lang: str) -> str:
    """Return the accepted margin as a student reads it; empty for what is judged exactly."""
    if part.is_exact or not (part.atol or part.rtol):
        return ""
    table = engine_words(lang)["accepted"]
    percent = localise(plain(round(100 * part.rtol, 6)), lang)
    of_column = len(part.sort.units(part.unit)) > 1
    largest = "share_of_column" if of_column else "share_of_largest"
    share = table[largest if part.sort.of_largest else "share"].format(percent)
    absolute = localise(plain(part.atol), lang)
    if part.atol and part.unit == "deg":
        fixed = table["degrees"].format(absolute)
    else:
        fixed = table["absolute"].format(f"{absolute} {unit_text(part.unit, lang)}".strip())
    if not part.rtol:
        return fixed
    if not part.atol:
        return (table["absolute"] if part.sort.of_largest else table["percent"]).format(
            share if part.sort.of_largest else percent
        )
    return table["either"].format(share, f"{absolute} {unit_text(part.unit, lang)}".strip())
