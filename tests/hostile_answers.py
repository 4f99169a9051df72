"""Right answers however they are written, and right and wrong ones together in one box."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from coursework.course.variant import Variant
from coursework.kinds.choices import cases_of
from coursework.language.numbers import significant
from coursework.model import Part
from coursework.parsing.reading import Reading

# ------------------------------------------------------------------ one verdict


def distance(variant: Variant, part: Part, value: Any) -> float:
    """How far a value is from the part's reference, in the half-widths of its mark."""
    key = variant.key
    if part.judge and not part.is_exact:
        reference = np.asarray(key.reference[part.quantity], dtype=float)
        off = np.asarray(value, dtype=float) - reference
        if turn := part.sort.turn:
            off = (off + turn / 2) % turn - turn / 2
        off = np.linalg.norm(off)
        return float(off) / (0.01 * float(np.linalg.norm(reference)) + 1e-6)
    along = key.reference.get(part.along) if part.along else None
    width = key.envelope.get(part.quantity, 0.0)
    return part.sort.distance(part, value, key.reference[part.quantity], along, width)


def is_right(variant: Variant, part: Part, reading: Reading) -> bool:
    """Whether any honest reading of an answer is right; one of a judge's, where it is that of the key within
    1 %."""
    return reading.status == "read" and any(distance(variant, part, value) <= 1 for value in reading.values)


# --------------------------------------------------------------- right answers


def _numbers(value: float, unit: str, rng: random.Random, turns: bool) -> Iterator[str]:
    """One number in the ways that people write it, to six digits, with and without its unit."""
    digits = significant(value, 6)
    comma = digits.replace(".", ",")
    behind = "" if unit == "1" else unit
    yield digits
    yield comma
    yield f" {digits} "
    yield f"{digits}."
    yield digits.replace("-", "\u2212")
    yield f"x = {digits}"
    yield f"r_2 : {comma} {behind}".strip()
    yield f"\u2248 {digits}"
    yield f"environ {comma} {behind}".strip()
    yield f"({digits})"
    yield f"[{digits}]"
    yield f"${digits}$"
    yield f"{value:.8e}"
    yield f"{value:.8e}".replace("e", "\u00b710^")
    yield f"{value:.8e}".replace("e", " x 10^{") + "}"
    yield f"{digits} ({significant(value, 8)})"
    if behind:
        yield f"{digits} {behind}"
        yield f"{digits}{behind}"
        yield f"{comma}\u202f{behind}"
        yield rf"{digits}\,\mathrm{{{behind}}}"
        yield f"{digits} [{behind}]"
    if not value:
        return  # nobody works out 0, and 0 = 0 holds whatever is asked
    yield f"{significant(value, 9)} = {digits}"
    yield f"x = {significant(value, 9)} \u2248 {digits} {behind}".strip()
    yield f"{digits} {behind} ({significant(value, 9)} {behind})"
    add = round(rng.uniform(1, 90), 3)
    yield f"{significant(value - add, 9)} + {add}"
    yield f"{significant(value * 3, 9)}/3"
    yield f"7*{significant(value / 7, 9)}"
    yield f"2({significant(value / 2 - 3, 9)} + 3)"
    if unit == "deg":
        yield from _angles(value, digits, turns)


def _angles(value: float, digits: str, turns: bool) -> Iterator[str]:
    """An angle in degrees as people write and work it out."""
    radians = math.radians(value)
    turn = math.remainder(value, 360.0) if turns else value
    yield f"{digits}\u00b0"
    yield f"{significant(radians, 7)} rad"
    yield f"{significant(radians, 7)} rad = {digits}\u00b0"
    yield f"{digits}\u00b0 ({significant(radians, 7)} rad)"
    yield f"{significant(radians / math.pi, 9)}\u03c0"
    yield f"{significant(radians / math.pi, 9)} \u03c0 rad"
    yield f"{significant(radians * 7 / math.pi, 9)}\u03c0/7"
    yield f"\u03c0 - {significant(math.pi - radians, 9)}".replace("- -", "+ ")
    yield f"{significant(radians, 9)}*180/\u03c0"
    yield f"{digits}*\u03c0/180"
    yield from (f"{value + 360:.4f}", f"{value - 360:.4f}") if turns else ()
    whole, rest = divmod(abs(value), 1)
    minutes, seconds = divmod(rest * 3600, 60)
    sign = "-" if value < 0 else ""
    yield f"{sign}{int(whole)}\u00b0{int(minutes)}'{math.floor(100 * seconds) / 100:.2f}\""
    for start, name in ((180.0, "arctan"), (90.0, "atan"), (360.0, "Arctan"), (0.0, "arctan")):
        left = math.radians(turn - start)
        if abs(left) < 1.5:
            slope = math.tan(left)
            sign, size = ("-" if slope < 0 else "+"), significant(abs(slope), 9)
            said = f"{name}({size})" if start == 0 and sign == "+" else f"{start:g} {sign} {name}({size})"
            yield said if start else said.replace("0 ", "", 1).replace("- ", "-")
            if start:
                said = {180.0: "\u03c0", 90.0: "\u03c0/2", 360.0: "2\u03c0"}[start]
                yield f"{said} {sign} {name}({size})"
                yield f"{start:g}\u00b0 {sign} {name}({size})"
    if abs(turn) < 170:
        yield f"2*arcsin({significant(math.sin(math.radians(turn / 2)), 9)})"


def _counts(value: int) -> Iterator[str]:
    yield from (
        f"{value}",
        f" {value} ",
        f"{value}.0",
        f"{value},0",
        f"n = {value}",
        f"m_u : {value}",
        f"({value})",
    )
    yield from (
        f"[{value}]",
        f"{value} ddl",
        f"{value} degrees of freedom",
        f"2*{value + 9} - 18 - {value}".replace("- -", "+ "),
        f"{value + 9} - 9 = {value}",
    )
    yield from (
        f"{value} ({value + 1} - 1)",
        f"{value} = {value}.0",
        f"3*{value + 9} - 27 - 2*{value}".replace("2*-", "2*(-1)*"),
        f"$n = {value}$",
        f"\u2248 {value}",
    )
    yield from (
        f"{value}.",
        f"3*(5-1) - 2*4 {value - 4:+d}",
        f"3({value + 2}) - 2({value + 3})",
        f"{value} = {value + 9} - 9",
    )


def _rows(values: list[float], unit: str) -> Iterator[Any]:
    """Coordinates in the ways that people write them."""
    digits = [significant(v, 7) for v in values]
    comma = [d.replace(".", ",") for d in digits]
    behind = "" if unit == "1" else unit
    yield values
    yield digits
    yield "(" + " ; ".join(comma) + f") {behind}"
    yield ", ".join(digits)
    yield ",".join(digits)
    yield ";".join(comma)
    yield " ".join(digits)
    yield "[" + " ".join(digits) + "]"
    yield "[" + ", ".join(digits) + f"] {behind}"
    yield "(" + ", ".join(comma) + ")"
    yield "A = (" + " ; ".join(digits) + ")"
    yield "A(" + " ; ".join(comma) + ")"
    yield "{" + " | ".join(digits) + "}"
    yield " ; ".join(f"{d} {behind}" for d in comma)
    if len(digits) <= 3:
        yield " ; ".join(f"{n} = {d}" for n, d in zip("xyz", digits, strict=False))
    yield r"\left(" + " ; ".join(digits) + r"\right)"


def right_spellings(variant: Variant, part: Part, rng: random.Random) -> Iterator[Any]:
    """A right answer in the ways that people write it."""
    sort, value = part.sort, variant.key.reference[part.quantity]
    label = partial(variant.label, part.id)
    for _, answer in sort.spellings(part, value, label):
        yield answer
    if sort.is_number:
        yield from _numbers(float(value), part.unit, rng, bool(sort.turn))
    elif sort.is_scalar:
        yield from _counts(int(value))
    elif sort.family in ("point", "vector"):
        yield from _rows(np.asarray(value, dtype=float).tolist(), part.unit)
    elif sort.name == "choice":
        case, letters = str(value), variant.letters(part)
        said = label(case)
        yield from (said.lower(), f" {said} ", f"{said}.", f'"{said}"')
        if letter := letters.get(case):
            yield from (
                letter,
                letter.upper(),
                f"({letter})",
                f"{letter})",
                f"{letter}) {said}",
                f"{letter}. {said}",
            )
            yield from (
                f"{said} ({letter})",
                f"r\u00e9ponse {letter}",
                f"{letter} ({said})",
                f"answer: {letter}",
            )
            yield " ".join(("\u2612" if own == letter else "\u2610") + " " + own for own in letters.values())
            yield "\n".join(f"[{'x' if own == letter else ' '}] {own}" for own in letters.values())
    elif sort.name == "choices":
        named = sorted(cases_of(value))
        yield from (" ; ".join(map(label, named)) or "none", ", ".join(named) or "none", named)


# ------------------------------------------------------------ right and wrong

#: Two answers, ``a`` and ``b``, together in one box; ``u`` is the unit.
FORMS = (
    "{a} [{b}]",
    "({a}) ({b})",
    "({a})({b})",
    "[{a}] [{b}]",
    "{a} ({b})",
    "({a}) {b}",
    "{a}({b})",
    "{a}[{b}]",
    "{{{a}}} {{{b}}}",
    "{a}:{b}",
    "{a} : {b}",
    "{a}* {b}",
    "{a} * {b}",
    "{a}*{b}",
    "{a} / {b}",
    "{a}/{b}",
    "{a} // {b}",
    "{a} × {b}",
    "{a} x {b}",
    "{a} or {b}",
    "{a} ou {b}",
    "{a} and {b}",
    "{a} et {b}",
    "{a} or else {b}",
    "{a} sinon {b}",
    "{a} vs {b}",
    "{a} -> {b}",
    "{a} → {b}",
    "{a} => {b}",
    "{a} ; {b}",
    "{a};{b}",
    "{a}\n{b}",
    "{a}\r\n\r\n{b}",
    "{a}\t{b}",
    "{a}, {b}",
    "{a},{b}",
    "{a} {b}",
    "{a}  {b}",
    "{a} . {b}",
    "{a} - {b}",
    "{a} – {b}",
    "{a} — {b}",
    "{a} + {b}",
    "{a}^{b}",
    "{a} | {b}",
    "{a} || {b}",
    "{a} = {b}",
    "{a} == {b}",
    "{a} = {b} = {a}",
    "x = {a} = {b}",
    "{a} ≈ {b}",
    "{a} ~ {b}",
    "~{a} {b}",
    "{a} ≠ {b}",
    "{a} != {b}",
    "{a} (not {b})",
    "{a} not {b}",
    "not {b}, {a}",
    "not {b}: {a}",
    "{a} (non {b})",
    "{a} et non {b}",
    "pas {b} : {a}",
    "x = {a} (not x = {b})",
    "x = {a} x = {b}",
    "x = {a}, x = {b}",
    "x={a};x={b}",
    "x or {b} = {a}",
    "{b} or x = {a}",
    "no, {b} = {a}",
    "[{a}, {b}]",
    "[{a} ; {b}]",
    "{{{a}, {b}}}",
    "({a}, {b})",
    "({a} ; {b})",
    "<{a}|{b}>",
    r"{a} \text{{ or }} {b}",
    r"\text{{{a}}} {b}",
    r"{a} \quad {b}",
    r"{a} \\ {b}",
    r"${a}$ ${b}$",
    r"\frac{{{a}}}{{{b}}}",
    r"{a} \lor {b}",
    "<b>{a}</b> {b}",
    "{a}<br>{b}",
    "{a}&nbsp;{b}",
    "{a} &lt; {b}",
    "<s>{a}</s> {b}",
    "{a} <!-- {b} -->",
    "{a}&#10;{b}",
    "~~{a}~~ {b}",
    "~~{a}~~{b}",
    "{a}\u0336 {b}",
    "{a}…{b}",
    "{a} … {b}",
    "{a}... {b}",
    "{a} ± {b}",
    "{a} +/- {b}",
    "{a} ? {b}",
    "{a}? {b}?",
    "{a} I mean {b}",
    "{a}, I mean {b}",
    "{a} je veux dire {b}",
    "{a} no {b}",
    "{a} maybe {b}",
    "{a} # {b}",
    "{a} & {b}",
    "{a} % {b}",
    "1) {a} 2) {b}",
    "1. {a} 2. {b}",
    "a) {a} b) {b}",
    "1) {a}\n2) {b}",
    "- {a}\n- {b}",
    "{a} u {b}",
    "{a} {u} {b} {u}",
    "{a} {u} ({b} {u})",
    "{a} {u} or {b} {u}",
    "{a} {u} / {b} {u}",
    "{a} {u} = {b} {u}",
    "{a} {u} ; {b}",
    "{a} {u}, {b} {u}",
    "{a} ({b} {u})",
    "min({a}, {b})",
    "'{a}' '{b}'",
    '"{a}" "{b}"',
    "'{a}' {b}",
    "«{a}» {b}",
    "array([{a}, {b}])",
    "np.float64({a}) {b}",
    "{a} {b} !",
    "{a}\u200b {b}",
    "{a}\u00a0{b}",
    "abs({a}) ({b})",
    "{a}{{}}{b}",
    "{a} ddl {b} ddl",
    "{a} dof ({b})",
    "{b} instead of {a}",
    "{a} rather than {b}",
    "{a} plutôt que {b}",
    "{a} 0 + {b}",
    "{a} + 0*{b}",
    "{a} - 0 {b}",
    "{a}!{b}",
    "{a}'{b}",
    "{a}_{b}",
    "{a}\\,{b}",
    "{a}\\;{b}",
    "({a} ({b}))",
    "(({a}) {b})",
)

#: Forms that are a formula, worth one value, where it does something with both numbers.
FORMULAS = (
    "{a} + {b}",
    "{a} - {b}",
    "{a} – {b}",
    "{a} — {b}",
    "{a}*{b}",
    "{a} * {b}",
    "{a}* {b}",
    "{a} × {b}",
    "{a} x {b}",
    "{a}^{b}",
    "{a} / {b}",
    "{a}/{b}",
    "{a} {u} / {b} {u}",
    r"\frac{{{a}}}{{{b}}}",
    "{a}:{b}",
    "{a} : {b}",
    "{a} - 0 {b}",
    "abs({a}) ({b})",
    "({a}) {b}",
    "(({a}) {b})",
    "{a} {u} {b} {u}",
)


class Both(NamedTuple):
    """Two answers in one box: how they stand there, the whole text, and each."""

    form: str
    text: str
    one: str
    other: str


_IN_DIGITS = re.compile(r"-?[0-9]+(?:[.,][0-9]+)?")


def holds_two(part: Part, both: Both, reading: Reading) -> bool:
    """Whether a text that was read says two values: a formula that does something with its numbers says one,
    and so do a ratio to 1, whole numbers with a comma between them, and a measured number with its margin or
    with 0 added."""
    if part.sort.is_number and re.search(r"±|\+/-", both.text):
        numbers = [
            abs(float(said.replace(",", ".")))
            for said in (both.one, both.other)
            if _IN_DIGITS.fullmatch(said)
        ]
        return len(numbers) < 2 or not 0 < min(numbers) <= 0.05 * max(numbers)
    if part.sort.is_number and re.search(r"\+ *0+$|^0+ *\+", both.text):
        return False
    if re.fullmatch(r"-?[0-9]+,[0-9]+", both.text):
        return False
    if both.form not in FORMULAS or not part.sort.is_scalar:
        return True
    one, other = (float(said.replace(",", ".")) for said in (both.one, both.other))
    if other and math.isclose(one / other, other):
        return False  # 100 / 10 is 10
    if part.sort.is_number and part.unit == "1" and other == 1:
        return False
    if part.unit == "mm/mm":
        return False  # a scale of 1 / 2
    return any(math.isclose(value, each) for value in reading.values for each in (one, other)) and not (
        one == 2 * other and both.form in FORMULAS[:4] + FORMULAS[10:16]
    )


def _wrong_values(variant: Variant, part: Part) -> list[Any]:
    """Values that are surely wrong: of a count its neighbours and what leaves a product as it is, another
    case, another place."""
    sort, value = part.sort, variant.key.reference[part.quantity]
    if sort.name == "choice":
        return [case for case in part.choices if case != str(value)]
    if sort.name == "choices":
        named = cases_of(value)
        others = [frozenset({case}) for case in part.choices if case not in named]
        return [*others, frozenset(part.choices) - named][: len(others) + 1]
    if sort.is_scalar and sort.is_exact:
        near = (value - 1, value + 1, value + 2, 0, 1, 2, 10 * value, -value)
        return [other for other in dict.fromkeys(map(int, near)) if other != value]
    if sort.is_number:
        far = (0.0, 1.0, 1.3 * value + 2.0, -value, value + 97.0, value / 2)
        return [w for w in map(float, far) if distance(variant, part, w) > 2]
    if sort.family == "equation":
        return []
    if sort.family == "graph":
        joints = str(value).split(", ")
        return [", ".join(joints[:-1]), f"{value}, {joints[0].split()[0]} prismatic"]
    if sort.family == "pattern":
        found, names = sort.components(value), frozenset(sort.form.names)
        wrong = (names - found, found ^ {sort.form.names[0]}, names, frozenset())
        return [" ".join(sorted(one)) or "0" for one in wrong if one != found]
    value = np.asarray(value)
    far = (-value, 1.5 * value + 2.0, value[..., ::-1] + 1.0 if value.ndim else value * 1j)
    return [w for w in far if distance(variant, part, w) > 2]


def _said(variant: Variant, part: Part, value: Any) -> Iterator[str]:
    """A value as a student writes it."""
    sort, label = part.sort, partial(variant.label, part.id)
    if sort.name == "choice":
        yield label(value)
        if letter := variant.letters(part).get(value):
            yield letter
            yield f"{letter}) {label(value)}"
    elif sort.name == "choices":
        yield ", ".join(sorted(value)) or "none"
    else:
        yield sort.written(value, 5, label)
        if sort.is_number and value != int(value):
            yield sort.written(value, 5, label).replace(".", ",")
            yield f"{value:.4e}"


def both_in_one(variant: Variant, part: Part, rng: random.Random, most: int) -> list[Both]:
    """A right and a wrong answer in one box, in both orders: ``most`` of the ways, drawn at random."""
    value = variant.key.reference[part.quantity]
    value = str(value) if part.sort.name == "choice" else value
    value = cases_of(value) if part.sort.name == "choices" else value
    value = int(value) if part.sort.is_exact and part.sort.is_scalar else value
    pairs = [
        (one, other)
        for wrong in _wrong_values(variant, part)
        for one in _said(variant, part, value)
        for other in _said(variant, part, wrong)
        if one != other
    ]
    ways = [
        Both(form, form.format(a=a, b=b, u="" if part.unit == "1" else part.unit), a, b)
        for form in FORMS
        for one, other in pairs
        for a, b in ((one, other), (other, one))
    ]
    return rng.sample(ways, min(most, len(ways)))


def parts_to_try(variant: Variant) -> list[Part]:
    """The parts with an answer that people spell in many ways."""
    return [part for part in variant.parts if not part.sort.is_open and part.sort.family != "equation"]
