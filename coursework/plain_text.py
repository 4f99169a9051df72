"""Markdown with ``$LaTeX$`` as plain text, for tables and terminals: ``$\\dot r_A$`` -> ``ṙA``."""

from __future__ import annotations

import re
import unicodedata

from coursework.language import localise

_GREEK = {
    name: unicodedata.lookup(f"GREEK SMALL LETTER {name.upper().replace('LAMBDA', 'LAMDA')}")
    for name in (
        "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau "
        "upsilon phi chi psi omega"
    ).split()
}
_SIGNS = {
    "cdot": "·",
    "times": "×",
    "pm": "±",
    "le": "≤",
    "ge": "≥",
    "neq": "≠",
    "approx": "≈",
    "Omega": "Ω",
    "circ": "°",
    "infty": "∞",
    "quad": " ",
    "qquad": " ",
    "wedge": "∧",
    "perp": "⟂",
    "parallel": "∥",
    "Rightarrow": "⇒",
    "to": "→",
}
_ACCENTS = {"dot": "\N{COMBINING DOT ABOVE}", "ddot": "\N{COMBINING DIAERESIS}"}
_POWERS = str.maketrans("0123456789-+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺")
_BRACED = r"\{([^{}]*)\}"


def _formula(tex: str, lang: str) -> str:
    text = re.sub(r"\\num" + _BRACED, lambda m: localise(m.group(1), lang), tex)
    for name, sign in {**_GREEK, **_SIGNS}.items():
        text = re.sub(rf"\\{name}(?![A-Za-z])", sign, text)
    text = re.sub(r"\\[,;! ]", " ", text)
    before = None
    while before != text:  # innermost braces first
        before = text
        text = re.sub(
            r"\\(d?dot)\s*(?:\{(.)\}|([^\s\\{}]))",
            lambda m: (m.group(2) or m.group(3)) + _ACCENTS[m.group(1)],
            text,
        )
        text = re.sub(r"\\[dt]?frac" + _BRACED + _BRACED, r"(\1)/(\2)", text)
        text = re.sub(r"\\sqrt" + _BRACED, r"√(\1)", text)
        text = re.sub(r"\^\{?°\}?", "°", text)
        text = re.sub(r"\^(?:\{([-+0-9]+)\}|([0-9]))", lambda m: (m[1] or m[2]).translate(_POWERS), text)
        text = re.sub(r"_" + _BRACED, lambda m: ("_" if len(m[1]) > 2 else "") + m[1], text)
        text = re.sub(
            r"\\(?:vec|overrightarrow|overline|mathrm|text|operatorname|mathbf)\s*" + _BRACED, r"\1", text
        )
        text = re.sub(r"\\(?:vec|overrightarrow|overline)\s+", "", text)
    text = re.sub(r"\\(?:left|right)", "", text)
    text = re.sub(r"\\([A-Za-z]+)", r"\1", text)
    text = re.sub(r"_(?=\w{1,2}\b)", "", text).replace("{", "").replace("}", "")
    return unicodedata.normalize("NFC", re.sub(r"\s+", " ", text).strip())


def plain_text(markdown: str, lang: str) -> str:
    """One line of plain text; formulas in Unicode, emphasis dropped."""
    text = re.sub(r"\$\$?(.+?)\$\$?", lambda m: _formula(m.group(1), lang), markdown, flags=re.DOTALL)
    text = re.sub(r"(\*\*|__|`)(.+?)\1", r"\2", text)
    return re.sub(r"[ \t\n]+", " ", text).strip()
