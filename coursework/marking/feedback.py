"""Feedback for the student on an answer: sentences of the engine, in the sheet's language.

Feedback never contains the reference value.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from coursework.errors import cut_short
from coursework.language.numbers import localise, significant, unit_text, with_unit
from coursework.language.words import listed, quoted, words
from coursework.markup.markdown import plain_line
from coursework.model import Part
from coursework.parsing.choices import read_choice
from coursework.parsing.labels import head
from coursework.parsing.reading import Reading
from coursework.parsing.spelling import plain_spelling, spelled_out
from coursework.parsing.vocabulary import vocabulary_of

if TYPE_CHECKING:
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant


ECHO = 160  #: characters of what was read, in the feedback: a graph of ten joints, a loop equation
QUOTED = 40  #: characters of one that could not be read


class Sentence(NamedTuple):
    """A sentence of the engine, and the Markdown that fills it: ``{name}: {read} is right.``"""

    sentence: str
    pieces: Mapping[str, str]

    def texts(self, lang: str) -> tuple[str, str]:
        """Return the sentence with its pieces: Markdown, and one line of plain text. Sentences and most
        pieces recur: each is made plain once."""
        pieces = {n: text if _is_plain(text) else plain_line(text, lang) for n, text in self.pieces.items()}
        plain = " ".join(_plain_sentence(self.sentence, lang).format(**pieces).split())
        return self.sentence.format(**self.pieces), plain


_BARE = re.compile(r"[\w\s.,;:()=/°%·²³−…+^?!-]*")
_is_plain = _BARE.fullmatch


@lru_cache(maxsize=1024)
def _plain_sentence(sentence: str, lang: str) -> str:
    """Return a sentence with its places still open. Braces are not markup, and come through."""
    return plain_line(sentence, lang)


def part_name(variant: Variant, part: Part) -> str:
    """Return the name of a part in feedback: its symbol, or its number when a symbol says nothing."""
    if not part.sort.is_called_by_symbol:
        number = 1 + [p.id for p in variant.parts].index(part.id)
        return f"{words(variant.lang)['sheet']['question']['one']} {number}"
    return f"${variant.symbol(part.quantity)}$"


def echo(text: str, lang: str) -> str:
    """Return the text that was read, shortened, as the language writes numbers; safe inside Markdown."""
    shortened_text = cut_short(text, ECHO)
    if "=" in text:
        return "`" + "".join(c for c in shortened_text if c.isprintable() and c not in "`$") + "`"
    return _harmless(localised(shortened_text, lang))


_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def localised(read_as: str, lang: str) -> str:
    """Return the text that was read, as the language writes numbers; an equation is left as it is."""
    if "=" in read_as:
        return read_as
    if _NUMBER.fullmatch(read_as):
        return localise(read_as, lang)
    number = re.sub(r"(?<![A-Za-z.])-?\d+(?:\.\d+)?", lambda m: localise(m.group(), lang), read_as)
    return number.replace(" °", "°")


def say(variant: Variant, part: Part, sentence: str, **pieces: str) -> Sentence:
    """Return a sentence of the engine about a part."""
    return Sentence(words(variant.lang)["marking"][sentence], {"name": _opening(variant, part), **pieces})


def _opening(variant: Variant, part: Part) -> str:
    """Return the part's name at the head of a sentence."""
    name = part_name(variant, part)
    return name[:1].upper() + name[1:]


def say_not_read(variant: Variant, part: Part, reading: Reading) -> Sentence:
    """Why an answer could not be read, or that there is none."""
    table = words(variant.lang)["marking"]
    unit = unit_text(part.unit, variant.lang)
    is_piece = reading.found and (reading.status == "wrong_unit" or reading.code in part.sort.quoted)
    piece = shortened(reading.found if is_piece else reading.text)
    pieces = {"name": _opening(variant, part), "found": _harmless(piece), "unit": unit or "1"}
    unitless = part.sort.unitless
    if reading.status == "unreadable":
        kinds = table["unreadable"]
        code = part.sort.faults.get(reading.code, reading.code)
        if code == "unknown_symbol" and (stated := _to_eliminate(variant, part, reading.found)):
            code, pieces["found"] = "to_eliminate", stated
        sentence = kinds.get(code, kinds["otherwise"])
        if "{symbols}" in sentence:
            pieces["symbols"] = listed([f"`{name}`" for name in part.variables], variant.lang, "and")
        if "{offered}" in sentence:
            pieces["offered"] = _offered(variant, part)
        if code == "unknown_unit" and not unit:
            sentence = table[unitless]
    elif reading.status == "wrong_unit":
        sentence = table["wrong_unit" if unit else unitless]
    else:
        sentence = table["missing"]
    return Sentence(sentence, pieces)


def _to_eliminate(variant: Variant, part: Part, run: str) -> str:
    """Return the symbol of the statement in a run of letters that an equation must not contain; nothing where
    none is."""
    stated = {*variant.given, *(p.quantity for p in variant.parts if p.sort.is_scalar)}
    stated |= {name for p in variant.parts for name in p.variables}
    vocabulary, run = vocabulary_of(tuple(sorted(stated))), spelled_out(plain_spelling(run)).strip()
    while run and (known := vocabulary.first(run)):
        if known[1] == "variable" and known[2] not in part.variables:
            return f"${variant.solution_symbol(known[2])}$"
        run = run[known[0] :]
    return ""


def shortened(answer: str) -> str:
    """Return an answer on one line, its end left out where it is long."""
    return cut_short(" ".join(str(answer).split()), QUOTED)


_OFFERED = 200  #: characters of all that is offered
_SAYING = 4  #: words of a beginning that says something


def _offered(variant: Variant, part: Part) -> str:
    """Return the possible answers to a choice: the letter, where there is one, and in quotation marks the
    label, its head, or its shortest beginning that is unique."""
    cases, letters = variant.cases(part), variant.letters(part)
    printed = [variant.label(part.id, case) for case in cases]
    labels = variant.labels(part)
    if sum(map(len, printed)) > _OFFERED:
        heads = [head(label) for label in printed]
        printed = [
            s if _means(s, case, labels) else printed_label
            for s, printed_label, case in zip(heads, printed, cases, strict=True)
        ]
    if sum(map(len, printed)) > _OFFERED:
        printed = [_shortest(s, case, labels, variant.lang) for s, case in zip(printed, cases, strict=True)]
    quotations = [quoted(label, variant.lang) for label in printed]
    offered = [
        f"{letters[case]} ({quotation})" if case in letters else quotation
        for case, quotation in zip(cases, quotations, strict=True)
    ]
    return listed(offered, variant.lang, "or")


def _means(text: str, case: str, labels: Mapping[str, Sequence[str]]) -> bool:
    return read_choice(text, labels).values == (case,)


def _shortest(label: str, case: str, labels: Mapping[str, Sequence[str]], lang: str) -> str:
    """Return a short form of a label that still means its case: its head, or a few words, without article and
    noun."""
    table, pieces = words(lang)["choices"], label.split()
    for small in (table["articles"], table["nouns"]):
        pieces = pieces[1:] if len(pieces) > 1 and pieces[0].lower() in small else pieces
    core = head(" ".join(pieces))
    starts = (
        [core] if len(core) <= _OFFERED // 5 else [" ".join(pieces[:n]) for n in range(_SAYING, len(pieces))]
    )
    return next((s for s in starts if s.count("$") % 2 == 0 and _means(s, case, labels)), label)


def questions(variant: Variant, parts: Sequence[str], joint: str) -> str:
    """Parts by the numbers of their questions: ``questions 3, 4 and 6``, ``question 3 or 4``."""
    numbers = [str(n) for n, part in enumerate(variant.parts, start=1) if part.id in parts]
    is_one = len(numbers) == 1 or joint == "or"
    question_word = words(variant.lang)["sheet"]["question"]["one" if is_one else "many"]
    return f"{question_word} {listed(numbers, variant.lang, joint)}"


_HARMLESS = re.compile(r"[A-Za-z0-9 .,;:()=/°%²³−…+^-]*")  #: nearly all that is read
_MARKUP = re.compile(r"([\\`*_$\[\]|#~<>&])")


def _harmless(text: str) -> str:
    """Return a quotation as it was typed, which no Markdown reader takes for markup."""
    if _HARMLESS.fullmatch(text):
        return text
    return _MARKUP.sub(r"\\\1", "".join(filter(str.isprintable, text)))


def amount(variant: Variant, name: str, value: float) -> str:
    """Return a quantity and its value as Markdown: ``$r_3$ = 120,4 mm``."""
    unit = variant.exercise.units.get(name, "1")
    return f"${variant.solution_symbol(name)}$ = {with_unit(significant(value), unit, variant.lang)}"


def either_symbol(variant: Variant, names: Sequence[str], *, both: bool) -> str:
    """Names of quantities as they are printed: ``$r_2$ or $r_3$``; ``and`` where ``both`` are meant."""
    joint = words(variant.lang)["marking"]["and" if both else "or"]
    return f" {joint} ".join(f"${variant.solution_symbol(name)}$" for name in names)


def right_texts(variant: Variant, part: Part, read_as: str) -> tuple[str, str]:
    """Return the feedback on a right answer: Markdown, and one line of plain text."""
    says, plain = _right(variant.exercise, part, variant.lang)
    read = echo(read_as, variant.lang)
    return says.replace(_READ, read), plain.replace(_READ, read)


_READ = "\N{OBJECT REPLACEMENT CHARACTER}"


@lru_cache(maxsize=4096)
def _right(exercise: CourseExercise, part: Part, lang: str) -> tuple[str, str]:
    name = f"${exercise.symbol(part.quantity, lang)}$"
    pieces = {"name": name[:1].upper() + name[1:], "read": _READ}
    return Sentence(words(lang)["marking"]["correct"], pieces).texts(lang)
