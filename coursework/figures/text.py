"""Labels: a small subset of LaTeX mathematics turned into runs of letters, and measured.

A label is a symbol (``r_1``, ``\\dot{\\psi}``, ``O_4``) or plain words (``crank``, ``228.6 mm``).
Symbols have italic letters and Greek, upright digits; words are upright.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

from coursework.errors import BadStatement, WrongValue
from coursework.figures.ink import added
from coursework.markup.formula_tree import (
    Accent,
    Fence,
    FormulaRow,
    FormulaText,
    Name,
    Node,
    Num,
    Script,
    Space,
    Styled,
    Symbol,
    parse,
)

SIZE = 3.7  #: letter size, mm on paper
SMALL = 0.72  #: size of a subscript relative to its base
DROP, RAISE = -0.20, 0.36  #: shift of a subscript and of a superscript, em of the base
_SLACK = 1.06  #: a reader's machine may draw the text in another serif, a little wider

_ACCENTS = {
    "dot": "dot",
    "ddot": "ddot",
    "vec": "arrow",
    "overrightarrow": "arrow",
    "bar": "bar",
    "overline": "bar",
}
_VECTOR = re.compile("([^\\W_])\N{COMBINING RIGHT ARROW ABOVE}")
_DRAWN = str.maketrans("ϵϕ⋅∘∗", "εφ·°*")  #: letters and signs as figures have them

# Advance widths of the embedded serif, upright and italic, hundredths of an em.
_UPRIGHT_WIDTHS = {
    19: "'|",
    22: ",.",
    25: "ijlI-:;·′  !",
    29: "°",
    32: "tJ()/[]f",
    38: "rs*",
    42: "cz",
    46: "aeégèêàç0123456789?ôk",
    50: "bdovxhnpquùSPFyLε",
    55: "+−=<>±×EBYαβζδηθκλμξτ",
    60: "TRZXρσφπνω",
    66: "CKUV&%",
    71: "ADGHNOQΩΘ",
    79: "mw∞œ",
    95: "WM",
}
_ITALIC_WIDTHS = {
    19: "|",
    23: ",.:;!",
    27: "′° ·iîjlι",
    32: "ftI()/[]",
    37: "rsεξ",
    41: "cesτéèêJz",
    45: "0123456789SoôFγδθζμν",
    49: "abdghkpqxvyαàκβλρηπσχ",
    53: "EnuLTPhù+−=<>±×Γ",
    58: "BRYZψφΣ",
    62: "CUXΛΔ",
    67: "ADGHKNOQVΘωΞΦ",
    70: "wΠΨΩ",
    79: "mMœ∞",
    92: "W",
}


def _by_letter(table: dict[int, str]) -> dict[str, float]:
    return {letter: width / 100 for width, letters in table.items() for letter in letters}


_WIDTHS = {False: _by_letter(_UPRIGHT_WIDTHS), True: _by_letter(_ITALIC_WIDTHS)}


_DESCENDING = frozenset("gjpqyQJ,;()[]/βγζημξρφψχ|")
_ITALIC_DESCENDING = _DESCENDING | {"f"}
_LOW = frozenset("acegmnopqrsuvwxyzαεγηικμνοπρστυχω.,:·−+=×-")


@dataclass(frozen=True)
class LetterRun:
    """Letters of one style; lengths in em of the label's own size."""

    text: str
    italic: bool
    size: float = 1.0
    rise: float = 0.0
    back: float = 0.0  #: from the end of the run before it to where it starts, to the left

    @cached_property
    def width(self) -> float:
        table = _WIDTHS[self.italic]
        return self.size * added(table.get(letter) or self.unlisted(letter) for letter in self.text)

    def unlisted(self, letter: str) -> float:
        """Return the width of a letter that the tables lack, em."""
        return 0.75

    @cached_property
    def top(self) -> float:
        return self.rise + self.size * (0.46 if set(self.text) <= _LOW else 0.70)

    @cached_property
    def bottom(self) -> float:
        descending = _ITALIC_DESCENDING if self.italic else _DESCENDING
        return self.rise - self.size * (0.24 if descending & set(self.text) else 0.02)


class MeasuredRun(LetterRun):
    """Letters of texts that anybody wrote: those that the tables lack are measured."""

    def unlisted(self, letter: str) -> float:
        from coursework.figures.typesetting import glyph_width

        return glyph_width(letter, self.italic)


@dataclass(frozen=True)
class LabelAccent:
    """Accent over the runs ``first`` to ``last - 1``: dot, ddot, arrow or bar."""

    kind: str
    first: int
    last: int


@dataclass(frozen=True)
class LabelText:
    """A parsed label; lengths in em."""

    runs: tuple[LetterRun, ...]
    accents: tuple[LabelAccent, ...]

    @cached_property
    def width(self) -> float:
        return advance(self.runs)

    @cached_property
    def top(self) -> float:
        above = 0.36 if any(accent.kind == "arrow" for accent in self.accents) else 0.24
        return max(run.top for run in self.runs) + (above if self.accents else 0.0)

    @cached_property
    def bottom(self) -> float:
        return min(run.bottom for run in self.runs)

    def start(self, index: int) -> float:
        """Return the abscissa of a run, from the left of the label."""
        back = self.runs[index].back if index < len(self.runs) else 0.0
        return round(advance(self.runs[:index]) - back, 6)

    @cached_property
    def box(self) -> tuple[float, float]:
        """Width and height of the label's box, mm on paper, with some slack."""
        return self.width * SIZE * _SLACK + 0.2, (self.top - self.bottom) * SIZE


def advance(runs: Sequence[LetterRun]) -> float:
    """Return the total width of letters set one after the other."""
    return added(run.width - run.back for run in runs)


@lru_cache(maxsize=2048)
def read(label: str) -> LabelText:
    """Read a label: words, or a formula of one line; WrongValue for any other."""
    label = label.strip().removeprefix("$").removesuffix("$").strip()
    is_plain = not re.search(r"[\\_^{}]", label)
    if is_plain and re.search(r"\s|[^\W\d]{3,}", label):
        return words(label)
    letters = _Letters()
    try:
        letters.put(parse(label), LetterRun("", italic=True))
    except BadStatement as fault:
        if is_plain and label:
            return words(label)
        raise WrongValue("label {label!r}: {fault}", label=label, fault=fault) from None
    if not letters.runs:
        raise WrongValue("label {label!r} has no letter to print", label=label)
    return LabelText(tuple(letters.runs), tuple(letters.accents))


def words(text: str, run: type[LetterRun] = LetterRun) -> LabelText:
    """Return words in upright letters; a letter with a combining arrow becomes one with an arrow over it."""
    letters = _Letters()
    pieces = _VECTOR.split(text)
    for position, piece in enumerate(pieces):
        if position % 2:
            letters.put(Accent("vec", Symbol(piece, "letter")), run("", italic=True))
        elif piece or len(pieces) == 1:
            letters.letters(piece, run("", italic=False))
    return LabelText(tuple(letters.runs), tuple(letters.accents))


def joined(*texts: LabelText) -> LabelText:
    """Return texts one after the other."""
    letters = _Letters()
    for text in texts:
        letters.add(text.runs, text.accents)
    return LabelText(tuple(letters.runs), tuple(letters.accents))


class _Letters:
    """Letters of a formula, appended from left to right."""

    def __init__(self) -> None:
        self.runs: list[LetterRun] = []
        self.accents: list[LabelAccent] = []
        self.barrier = 0  # letters are not added to the runs before this one

    def put(self, node: Node, style: LetterRun) -> None:
        match node:
            case FormulaRow(items):
                for item in items:
                    self.put(item, style)
            case Symbol(text, _):
                self.letters(text.translate(_DRAWN), style)
            case FormulaText(text) | Name(text, _):
                self.letters(text, replace(style, italic=False))
            case Num(negative, digits, ""):
                self.letters(("−" if negative else "") + digits, style)
            case Styled(_, body):
                self.put(body, style)
            case Fence(left, body, right):
                self.letters(left, style)
                self.put(body, style)
                self.letters(right, style)
            case Space(_):
                self.letters(" ", style)
            case Accent(name, body) if name in _ACCENTS:
                first = self.barrier = len(self.runs)
                self.put(body, style)
                self.barrier = len(self.runs)
                self.accents.append(LabelAccent(_ACCENTS[name], first, self.barrier))
            case Script(base, below, above, primes):
                self.put(base, style)
                self.stack(_script(above, primes, style, RAISE), _script(below, 0, style, DROP))
            case _:
                raise BadStatement("a figure has no fractions, roots and tables")

    def stack(self, *scripts: _Letters) -> None:
        """Append an exponent and an index that start at the same place, the narrower first, so that the next
        letters follow the wider."""
        self.barrier, back = len(self.runs), 0.0
        for script in sorted((s for s in scripts if s.runs), key=lambda s: advance(s.runs)):
            first, *rest = script.runs
            self.add([replace(first, back=back) if back else first, *rest], script.accents)
            back = advance(script.runs)

    def add(self, runs: Sequence[LetterRun], accents: Sequence[LabelAccent]) -> None:
        """Append runs with the accents over them."""
        start = len(self.runs)
        self.runs += runs
        self.accents += [LabelAccent(a.kind, a.first + start, a.last + start) for a in accents]

    def letters(self, text: str, style: LetterRun) -> None:
        style = replace(style, italic=style.italic and text.isalpha())
        last = self.runs[-1] if len(self.runs) > self.barrier else None
        if last is not None and replace(last, text="", back=0.0) == style:
            self.runs[-1] = replace(last, text=last.text + text)
        else:
            self.runs.append(replace(style, text=text))


def _script(node: Node | None, primes: int, style: LetterRun, shift: float) -> _Letters:
    """Return the letters of an index or of an exponent, after its primes."""
    script = _Letters()
    if primes:
        script.letters("′" * primes, style)
    script.barrier = len(script.runs)
    if node is not None:
        script.put(node, replace(style, size=style.size * SMALL, rise=style.rise + shift * style.size))
    return script
