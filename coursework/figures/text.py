"""Labels: a small subset of LaTeX mathematics turned into runs of letters, and measured.

A label is a symbol (``r_1``, ``\\dot{\\psi}``, ``O_4``) or plain words (``crank``, ``228.6 mm``).
Symbols have italic letters and Greek, upright digits; words are upright.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

from coursework.errors import WrongValue, unknown
from coursework.figures.ink import added

SIZE = 3.7  #: letter size, mm on paper
SMALL = 0.72  #: size of a subscript relative to its base
DROP, RAISE = -0.20, 0.36  #: shift of a subscript and of a superscript, em of the base
_SLACK = 1.06  #: a reader's machine may draw the text in another serif, a little wider

_GREEK_NAMES = """
    alpha beta gamma delta epsilon varepsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau
    phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega
"""
GREEK = dict(zip(_GREEK_NAMES.split(), "αβγδεεζηθικλμνξπρστφφχψωΓΔΘΛΞΠΣΦΨΩ", strict=True))
_SIGNS = {
    "circ": "°", "cdot": "·", "times": "×", "pm": "±", "infty": "∞", "prime": "′",
    ",": " ", " ": " ", ";": " ",
}  # fmt: skip
_ACCENTS = {
    "dot": "dot", "ddot": "ddot", "vec": "arrow", "overrightarrow": "arrow", "bar": "bar", "overline": "bar",
}  # fmt: skip
_UPRIGHT = ("mathrm", "text", "num")

# Advance widths of the embedded serif, upright and italic, hundredths of an em.
_UPRIGHT_WIDTHS = {
    19: "'|", 22: ",.", 25: "ijlI-:;·′  !", 29: "°", 32: "tJ()/[]f", 38: "rs*", 42: "cz",
    46: "aeégèêàç0123456789?ôk", 50: "bdovxhnpquùSPFyLε", 55: "+−=<>±×EBYαβζδηθκλμξτ", 60: "TRZXρσφπνω",
    66: "CKUV&%", 71: "ADGHNOQΩΘ", 79: "mw∞œ", 95: "WM",
}  # fmt: skip
_ITALIC_WIDTHS = {
    19: "|", 23: ",.:;!", 27: "′° ·iîjlι", 32: "ftI()/[]", 37: "rsεξ", 41: "cesτéèêJz",
    45: "0123456789SoôFγδθζμν", 49: "abdghkpqxvyαàκβλρηπσχ", 53: "EnuLTPhù+−=<>±×Γ", 58: "BRYZψφΣ",
    62: "CUXΛΔ", 67: "ADGHKNOQVΘωΞΦ", 70: "wΠΨΩ", 79: "mMœ∞", 92: "W",
}  # fmt: skip


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
        return self.size * added(table.get(letter, 0.75) for letter in self.text)

    @cached_property
    def top(self) -> float:
        return self.rise + self.size * (0.46 if set(self.text) <= _LOW else 0.70)

    @cached_property
    def bottom(self) -> float:
        descending = _ITALIC_DESCENDING if self.italic else _DESCENDING
        return self.rise - self.size * (0.24 if descending & set(self.text) else 0.02)


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
    """Parse a label; UnknownName for an unknown command, WrongValue for stray braces."""
    label = label.strip().removeprefix("$").removesuffix("$").strip()
    if not re.search(r"[\\_^{}]", label) and re.search(r"\s|[^\W\d]{3,}", label):
        return LabelText((LetterRun(label, italic=False),), ())
    reader = _LabelParser(label)
    reader.sequence(LetterRun("", italic=True), stop=None)
    if not reader.runs:
        raise WrongValue(f"label {label!r} has no letter to print")
    return LabelText(tuple(reader.runs), tuple(reader.accents))


class _LabelParser:
    """Parser of one formula, which appends runs from left to right."""

    def __init__(self, label: str) -> None:
        self.label = label
        # A space after a command only ends its name.
        self.tokens = [a or b for a, b in re.findall(r"(\\[A-Za-z]+)\s*|(\\.|.)", label)][::-1]
        self.runs: list[LetterRun] = []
        self.accents: list[LabelAccent] = []
        self.barrier = 0  # runs before this one are complete: accents, indices and exponents count on them
        # The index or the exponent that was just read, if there is one: its sign, _ or ^, and its first run.
        self.script: tuple[str, int] | None = None

    def sequence(self, style: LetterRun, stop: str | None) -> None:
        while self.tokens and self.tokens[-1] != stop:
            self.atom(style)
        if stop is not None and not self.tokens:
            raise WrongValue(f"label {self.label!r} lacks a closing brace")
        if stop is not None:
            self.tokens.pop()

    def atom(self, style: LetterRun) -> None:
        if not self.tokens:
            raise WrongValue(f"label {self.label!r} ends where a symbol is expected")
        token = self.tokens.pop()
        if token.isspace() and style.italic:
            return
        before, self.script = self.script, None
        if token in ("_", "^", "'"):
            self.script = self.index_or_exponent(token, style, before)
            return
        if token == "{":
            self.sequence(style, stop="}")
        elif token == "}":
            raise WrongValue(f"label {self.label!r} has a closing brace without its opening one")
        elif token.startswith("\\"):
            self.command(token[1:], style)
        else:
            self.letters(token.replace("-", "−" if style.italic else "-"), style)
        self.script = None

    def index_or_exponent(
        self, token: str, style: LetterRun, before: tuple[str, int] | None
    ) -> tuple[str, int] | None:
        """Read a subscript, an exponent, or primes; a subscript and an exponent in a row are stacked."""
        first = self.barrier = len(self.runs)
        if token == "'":
            self.letters("′", style)
            while self.tokens and self.tokens[-1] == "'":
                self.letters("′", style)
                self.tokens.pop()
        else:
            shift = DROP if token == "_" else RAISE
            self.atom(replace(style, size=style.size * SMALL, rise=style.rise + shift * style.size))
        kind = "_" if token == "_" else "^"
        if before is None or before[0] == kind:
            return kind, first
        self.stack(before[1], first)
        return None

    def stack(self, low: int, middle: int) -> None:
        """Start the runs from ``middle`` on where those from ``low`` on start, the narrower first, so that
        the next letters follow the wider."""
        first, second = self.runs[low:middle], self.runs[middle:]
        if not first or not second:
            return
        if advance(second) < advance(first):
            self.accents = [_moved(it, low, middle, len(self.runs)) for it in self.accents]
            first, second = second, first
        self.runs[low:] = [*first, replace(second[0], back=advance(first)), *second[1:]]

    def command(self, name: str, style: LetterRun) -> None:
        if name in _ACCENTS:
            first = self.barrier = len(self.runs)
            self.atom(style)
            self.barrier = len(self.runs)
            self.accents.append(LabelAccent(_ACCENTS[name], first, self.barrier))
        elif name in _UPRIGHT:
            self.atom(replace(style, italic=False))
        elif name in GREEK or name in _SIGNS:
            self.letters(GREEK.get(name) or _SIGNS[name], style)
        else:
            commands = [*GREEK, *_SIGNS, *_ACCENTS, *_UPRIGHT]
            raise unknown("label command", name, commands, f"label {self.label!r}")

    def letters(self, text: str, style: LetterRun) -> None:
        style = replace(style, italic=style.italic and text.isalpha())
        last = self.runs[-1] if len(self.runs) > self.barrier else None
        if last is not None and replace(last, text="", back=0.0) == style:
            self.runs[-1] = replace(last, text=last.text + text)
        else:
            self.runs.append(replace(style, text=text))


def _moved(accent: LabelAccent, low: int, middle: int, end: int) -> LabelAccent:
    """Return an accent after the runs from ``middle`` to the end were moved before those from ``low`` to
    ``middle``."""
    shift = 0 if accent.first < low else end - middle if accent.first < middle else low - middle
    return LabelAccent(accent.kind, accent.first + shift, accent.last + shift)
