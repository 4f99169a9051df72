"""One spelling for the many ways in which people write signs, digits, Greek letters and LaTeX."""

from __future__ import annotations

import re
import string
import unicodedata
from html import unescape

from coursework.errors import cut_short

MAX_FOUND = 60  #: characters of a text that a message quotes


def shorten(text: str) -> str:
    """Return a piece of text short enough for a message."""
    return cut_short(text, MAX_FOUND)


_ALIKE = {
    "*": "×⋅·∙•∗✕",
    "/": "÷∕⁄",
    "-": "−–—‐‑‒﹣",
    "≈": "≅≊≒∼",
    "'": "’‘′ʹ´",
    '"': "″”“",
    "°": "º˚∘",
    "°C": "℃",
    "°F": "℉",
    "μ": "µ",
    "Ω": "\N{OHM SIGN}",
    "φ": "ϕ",
    "θ": "ϑ",
    "ε": "ϵ",
    ".": "٫",
    " ": "\t\n\r\v\f\x85\u2028\u2029٬",
    "": "\u200b\u200c\u200d\u2060\ufeff\u00ad",
}
_EMPHASISED = re.compile(r"(\*{1,3}|_{1,3}|`+)([^\s*_`](?:.*[^\s*_`])?)\1", re.DOTALL)
#: A value in bold type before its unit or behind its name; 2**3 is a power.
_BOLD = re.compile(r"(^|[=:≈]\s*)\*\*([^\s*](?:[^*]*[^\s*])?)\*\*(?=$|[\s.,;])")
_QUOTES = {'"': '"', "'": "'", "«": "»", "“": "”", "„": "“", "‘": "’"}


def unwrapped(text: str) -> str:
    """Return a text without what a program put around it: entities of HTML, quotation marks, the ' of a
    spreadsheet, Markdown's emphasis."""
    text = unescape(text).strip() if "&" in text else text.strip()
    if text[:1] in ("*", "_", "`") and (emphasised := _EMPHASISED.fullmatch(text)):
        text = emphasised[2]
    elif "**" in text:
        text = _BOLD.sub(r"\1\2", text)
    if text[:1] in _QUOTES:
        if len(text) > 1 and text[-1] == _QUOTES[text[0]]:
            return text[1:-1].strip()
        if text[0] == "'":
            return text[1:].strip()
    return text


_CLOSING = {"(": ")", "[": "]", "{": "}"}


def in_brackets(text: str) -> str:
    """Return the text between brackets that open at the start and close at the end; else an empty text."""
    opening, closing = text[:1], _CLOSING.get(text[:1])
    if closing is None or text[-1:] != closing:
        return ""
    level = 0
    for at, char in enumerate(text):
        level += (char == opening) - (char == closing)
        if level == 0:
            return text[1:-1].strip() if at == len(text) - 1 else ""
    return ""


_SUPERSCRIPTS = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-", strict=True))
#: ``s-²``, the sign of an exponent that is not raised.
_BROKEN_POWER = re.compile("(?<=[A-Za-z])[-−–‐](?=[²³¹⁰⁴-⁹])")
_SUPERSCRIPT_RUN = re.compile(f"[{''.join(_SUPERSCRIPTS)}]+")


class _Characters(dict):
    """Translation table of ``tidy``, filled as characters are met."""

    def __missing__(self, code: int) -> str:
        char = chr(code)
        if 0xFF01 <= code <= 0xFF5E:  # full-width forms of ASCII
            char = chr(code - 0xFEE0)
        elif unicodedata.category(char) == "Nd" or 0x2080 <= code <= 0x2089:  # subscript digits as well
            char = str(unicodedata.digit(char))
        elif unicodedata.category(char) == "Zs":
            char = " "
        self[code] = char
        return char


_TABLE = _Characters({ord(odd): plain for plain, odds in _ALIKE.items() for odd in odds})


def tidy(text: str) -> str:
    """Return the text with one spelling for each kind of space, sign, digit, dot and quote; ``²`` is
    ``^(2)``."""
    if text.isascii() and text.isprintable():
        return text.strip()
    text = _BROKEN_POWER.sub("⁻", unicodedata.normalize("NFC", text))
    text = _SUPERSCRIPT_RUN.sub(lambda run: f"^({''.join(_SUPERSCRIPTS[c] for c in run[0])})", text)
    return text.translate(_TABLE).strip()


_LATEX = (
    (re.compile(r"\\(?:left|right|displaystyle|quad|qquad)(?![A-Za-z])"), " "),
    (re.compile(r"\\+[,;:! ]|~"), " "),
    (re.compile(r"\{,\}"), ","),
    (re.compile(r"\^\s*\{?\s*\\circ(?![A-Za-z])\s*\}?|\\degree(?![A-Za-z])|\^\s*°"), "°"),
    (re.compile(r"\\(?:cdot|times)(?![A-Za-z])"), "*"),
    (re.compile(r"\\(?:approx|simeq)(?![A-Za-z])"), "≈"),
    (re.compile(r"\\(?:SI|qty)\{([^{}]*)\}\{([^{}]*)\}"), r"\1 \2"),
    (re.compile(r"\\(?:mathrm|mathit|text|operatorname|num|si|unit)\s*\{([^{}]*)\}"), r" \1 "),
    (re.compile(r"\\mu(?![A-Za-z])"), "μ"),
    (re.compile(r"\\Omega(?![A-Za-z])"), "Ω"),
    (re.compile(r"\\%"), "%"),
    (re.compile(r"\^\s*(?:\\prime\s*\\prime|\{\s*(?:\\prime\s*\\prime|'')\s*\})"), "''"),
    (re.compile(r"\^\s*(?:\\prime(?![A-Za-z])|\{\s*(?:\\prime|')\s*\})"), "'"),
    (re.compile(r"\\?\$|\\[()]"), " "),
)


def without_latex(text: str) -> str:
    """Return a tidy text with the commonest LaTeX spelled plainly; fractions and roots are left to the
    parser."""
    if "\\" in text or "$" in text or "{" in text or "^" in text:
        for pattern, plain in _LATEX:
            text = pattern.sub(plain, text)
    return text.strip()


def plain_spelling(text: str) -> str:
    """Return a text as the parsers take it: tidy, its commonest LaTeX spelled plainly. Once made plain, a
    text is handed on."""
    return without_latex(tidy(text))


def as_typed(piece: str, text: str) -> str:
    """Return the piece of a text that is spelled so when it is plain, as it was typed: ``s²`` for ``s^(2)``;
    else the piece itself."""
    if not piece or piece in text or len(text) > _MAX_SEARCHED:
        return piece
    last = (_STAYS if "\\" not in text else _STAYS - _OF_COMMANDS) - {piece[-1]}
    ends = [end for end in range(len(text), 0, -1) if text[end - 1] not in last]
    for start, char in enumerate(text):
        if char.isspace() or (char in _STAYS and char != piece[0] and text[start + 1 : start + 2].isascii()):
            continue
        for end in ends:
            if end <= start:
                break
            plain = plain_spelling(text[start:end])
            if piece in (plain, spelled_out(plain).strip()):
                return text[start:end].strip()
    return piece


_MAX_SEARCHED = 80  #: characters of a text of which each piece is tried
#: What is spelled as itself, unless it ends a command of LaTeX: a piece that is typed so begins and ends with
#: it.
_OF_COMMANDS = frozenset(string.ascii_letters + "(),;:!")
_STAYS = _OF_COMMANDS | frozenset(string.digits + "+/=<>|.?&%")
_DOTS = re.compile(r"\\(d?dot)\s*(?:\{([^{}]*)\}|(\\[A-Za-z]+|[^\W\d_]))")
_PRIMES = re.compile(r"([A-Za-z][A-Za-z0-9_]*)('{1,2}|\")(?!')")
_SUBSCRIPT = re.compile(r"\s*_\s*\{\s*([A-Za-z0-9_]*)\s*\}")
_COMMAND = re.compile(r"\\(?!frac|dfrac|tfrac)([A-Za-z]+)")


_ACCENTS = "\u0300\u0301\u0302"  #: of the name of a letter: ``oméga``, ``thêta``


def _greek(char: str) -> str:
    """ASCII name of a Greek letter, ``θ`` -> ``theta``; of the dots above a letter; an accent is dropped."""
    if char == "\u0307":
        return "_dot"
    if char == "\u0308":
        return "_ddot"
    if char in _ACCENTS:
        return ""
    name = unicodedata.name(char, "").split()
    if len(name) == 4 and name[0] == "GREEK" and name[2] == "LETTER":
        letter = name[3].lower().replace("lamda", "lambda")
        return " " + (letter.capitalize() if name[1] == "CAPITAL" else letter)
    return char


def spelled_out(text: str) -> str:
    """Return a text in which every name is ASCII: ``ψ̇``, ``\\dot\\psi`` -> ``psi_dot``, ``θ_{2}`` ->
    ``theta_2``."""
    text = _DOTS.sub(lambda m: f"{m[2] or m[3]}_{m[1]}", text)
    text = _SUBSCRIPT.sub(r"_\1", text)
    text = _COMMAND.sub(r" \1", text)
    if not text.isascii():
        text = "".join(map(_greek, unicodedata.normalize("NFD", text)))
    return text.replace("**", "^")


def primes_as_dots(text: str) -> str:
    """Return a text with ASCII names in which ``phi'`` and ``r1\"`` are ``phi_dot`` and ``r1_ddot``."""
    return _PRIMES.sub(lambda m: m[1] + ("_dot" if m[2] == "'" else "_ddot"), text)
