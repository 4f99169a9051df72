"""Formulas of a statement, for every back end.

A formula is LaTeX from a whitelist (:mod:`coursework.rendering.formula_tree`), its numbers written
``\\num{-1234.5}``. Here it becomes Typst, MathML, LaTeX for a notebook, one line of text, or words to be
read aloud, each with numbers as the language prints them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from html import escape

from coursework.language import MINUS, NARROW_SPACE, localise, words
from coursework.rendering.formula_tree import (
    Accent,
    Fence,
    Fraction,
    Grid,
    Name,
    Node,
    Num,
    Root,
    Row,
    Script,
    Space,
    Styled,
    Symbol,
    Text,
    parse,
    tokens,
)
from coursework.rendering.number_holes import once_for_all_numbers

SUPERSCRIPTS = str.maketrans("0123456789-−+()n", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻⁺⁽⁾ⁿ")
SUBSCRIPTS = str.maketrans("0123456789-−+()", "₀₁₂₃₄₅₆₇₈₉₋₋₊₍₎")
_UNITS_THAT_TOUCH = ("°", "′", "″")


def check_formula(tex: str) -> None:
    """Refuse what a statement may not use, by its name, with :class:`BadStatement`."""
    parse(tex)


def number_text(number: str, lang: str) -> str:
    """A number written with a point, as running text: ``1.2e-5`` is ``1,2 × 10⁻⁵`` in French."""
    mantissa, _, exponent = number.lower().partition("e")
    if not exponent:
        return localise(mantissa, lang)
    power = str(int(exponent)).translate(SUPERSCRIPTS)
    return f"{localise(mantissa, lang)}{NARROW_SPACE}×{NARROW_SPACE}10{power}"


def after_number(unit: str) -> str:
    """The unit as it follows a number in running text: degrees touch it, others stand a narrow space off."""
    return unit if unit in ("", *_UNITS_THAT_TOUCH) else NARROW_SPACE + unit


def quantity_formula(symbol: str, value: str, unit: str, *, is_number: bool = True) -> str:
    """LaTeX of ``symbol = value unit``; without a symbol, of the value and its unit."""
    shown = rf"\num{{{value}}}" if is_number else rf"\text{{{value}}}"
    if unit:
        shown += ("" if unit in _UNITS_THAT_TOUCH else r"\,") + rf"\text{{{unit}}}"
    return f"{symbol} = {shown}" if symbol else shown


# -- Typst ------------------------------------------------------------------------------------------

_TYPST_SPECIAL = set("#$&/_^'\"\\;,:()[]{}|!.<>~@`*-=")
_TYPST_STYLES = {
    "bold": "upright(bold({}))",
    "slanted bold": "bold({})",
    "blackboard": "bb({})",
    "calligraphic": "cal({})",
    "display": "display({})",
}
_TYPST_ACCENTS = {
    "dot": "dot", "ddot": "dot.double", "dddot": "dot.triple", "vec": "arrow", "overrightarrow": "arrow",
    "overline": "overline", "bar": "macron", "hat": "hat", "tilde": "tilde", "underline": "underline",
}  # fmt: skip
_TYPST_GRIDS = {"pmatrix": '"("', "bmatrix": '"["', "vmatrix": '"|"', "matrix": "#none"}


@once_for_all_numbers
def to_typst(tex: str, lang: str) -> str:
    """The formula as Typst math, without the dollars."""
    return _typst(parse(tex), lang)


def _typst_join(parts: Iterable[str]) -> str:
    """Typst prints the blanks around a quoted text, so none is written beside a quote."""
    joined = ""
    for part in filter(None, parts):
        touch = not joined or joined.endswith('"') or part.startswith('"')
        joined += part if touch else " " + part
    return joined


def _typst_string(text: str) -> str:
    return '"' + text.replace("\\", r"\\").replace('"', r"\"") + '"'


def _typst_char(text: str) -> str:
    return "\\" + text if text in _TYPST_SPECIAL else text


def _typst_num(num: Num, lang: str) -> str:
    parts = [MINUS if num.negative else "", _typst_string(localise(num.digits, lang))]
    if num.exponent:
        power = _typst_string(localise(str(int(num.exponent)), lang))
        parts += ["×", f'attach("10", t: {power})']
    return _typst_join(parts)


def _typst(node: Node, lang: str) -> str:
    def of(n: Node) -> str:
        return _typst(n, lang)

    match node:
        case Symbol(text, "bar"):
            return f'class("normal", {_typst_char(text)})'
        case Symbol("|" | "‖" as text, kind):
            return f'class("{kind}", {_typst_char(text)})'
        case Symbol(text, _):
            return _typst_char(text)
        case Num():
            return _typst_num(node, lang)
        case Name(text, limits):
            return f"op({_typst_string(text)}{', limits: #true' if limits else ''})"
        case Text(text):
            return _typst_string(text)
        case Space(width):
            return f"#h({width / 18:.4f}em)"
        case Row(items):
            return _typst_join(map(of, items))
        case Styled(style, body):
            return _TYPST_STYLES[style].format(of(body))
        case Fraction(above, below, display):
            drawn = f"frac({of(above)}, {of(below)})"
            return drawn if display is None else f"{'display' if display else 'inline'}({drawn})"
        case Root(body, None):
            return f"sqrt({of(body)})"
        case Root(body, index):
            return f"root({of(index)}, {of(body)})"
        case Accent(name, body):
            return f"{_TYPST_ACCENTS[name]}({of(body)})"
        case Script(base, below, above, primes):
            top = _typst_join(["′" * primes, of(above) if above else ""])
            scripts = [f"b: {of(below)}" if below else "", f"t: {top}" if top else ""]
            return f"attach({', '.join(filter(None, [of(base) or 'zws', *scripts]))})"
        case Fence(left, body, right):
            return f"lr({_typst_join([left and _typst_char(left), of(body), right and _typst_char(right)])})"
        case Grid("aligned", rows):
            return " \\ ".join(" & ".join(map(of, row)) for row in rows)
        case Grid("cases", rows):
            return f"cases({', '.join(' & '.join(map(of, row)) for row in rows)})"
        case Grid(kind, rows):
            return f"mat(delim: {_TYPST_GRIDS[kind]}, {'; '.join(', '.join(map(of, row)) for row in rows)})"
    raise TypeError(node)


# -- notebooks --------------------------------------------------------------------------------------


def to_notebook(tex: str, lang: str) -> str:
    """The formula as MathJax and KaTeX read it: the same LaTeX, with each number written out."""
    check_formula(tex)
    written = re.sub(r"\\num\s*\{([^{}]*)\}", lambda m: _latex_number(m.group(1).strip(), lang), tex)
    written = re.sub(r"\\text\{[^{}]*[²³][^{}]*\}", _figures_raised, written)
    # A bare < would open a tag in the page that shows the notebook.
    return "".join(r"\lt " if token == "<" else token for token in tokens(written))


def _figures_raised(found: re.Match[str]) -> str:
    r"""``\text{rad/s²}`` with its figure as an exponent: KaTeX's own letters have no raised one."""
    text = found.group().replace("²", r"}^2\text{").replace("³", r"}^3\text{")
    return text.replace(r"\text{}", "")


def _latex_number(text: str, lang: str) -> str:
    num = next(n for n in parse(rf"\num{{{text}}}").items if isinstance(n, Num))
    digits = num.digits.replace(".", "{,}") if localise(".", lang) == "," else num.digits
    power = rf" \times 10^{{{int(num.exponent)}}}" if num.exponent else ""
    return ("-" if num.negative else "") + digits + power


# -- MathML -----------------------------------------------------------------------------------------


_TAGS = re.compile(r"<[^>]*>")
_FITS = 24  #: characters that a line of a telephone holds


def to_mathml(tex: str, lang: str, display: bool = False) -> str:
    """The formula as a ``<math>`` element that needs no script and no font of its own."""
    layout = "block" if display else "inline"
    label = escape(spoken(tex, lang))
    body = _mathml_body(tex, lang)
    # A displayed formula, or a long one in a text, may be wider than a telephone: it scrolls, so a keyboard must reach it.
    is_long = len(_TAGS.sub("", body)) > _FITS
    reached = ' tabindex="0"' if display else ' class="long" tabindex="0"' if is_long else ""
    return f'<math display="{layout}" alttext="{label}"{reached}>{body}</math>'


@once_for_all_numbers
def _mathml_body(tex: str, lang: str) -> str:
    return _mathml(parse(tex), lang)


def _tag(name: str, *parts: str, **attributes: str) -> str:
    written = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return f"<{name}{written}>{''.join(parts)}</{name}>"


def _operator(text: str, form: str = "", stretchy: str = "false") -> str:
    attributes = {"form": form} if form else {}
    return _tag("mo", escape(text), stretchy=stretchy, **attributes)


_MATHML_FORMS = {"opening": "prefix", "closing": "postfix"}
#: The page's style sheet says what the classes look like.
_MATHML_STYLES = {
    "bold": "bold upright",
    "slanted bold": "bold",
    "calligraphic": "slanted",
    "blackboard": "upright",
}
#: Letters that Unicode has in these hands: a browser needs no style to draw them.
_MATHML_HANDS = {
    "blackboard": str.maketrans("CHNPQRZ", "ℂℍℕℙℚℝℤ"),
    "calligraphic": str.maketrans("ABCDEFGHIJKLMNOPQRSTUVWXYZ", "𝒜ℬ𝒞𝒟ℰℱ𝒢ℋℐ𝒥𝒦ℒℳ𝒩𝒪𝒫𝒬ℛ𝒮𝒯𝒰𝒱𝒲𝒳𝒴𝒵"),
}


def _mathml_symbol(text: str, kind: str) -> str:
    if kind == "letter":
        return _tag("mi", text)
    if kind == "digits":
        return _tag("mn", text)
    if kind == "ordinary" and text != "/":
        return _tag("mtext", escape(text))
    if kind == "bar" or text == "/":
        return _tag("mo", text, stretchy="false", lspace="0", rspace="0")
    return _operator(text, _MATHML_FORMS.get(kind, ""), "true" if kind == "big" else "false")


def _mathml_num(num: Num, lang: str) -> str:
    parts = [_tag("mn", localise(num.digits, lang))]
    if num.negative:
        parts.insert(0, _tag("mo", MINUS, form="prefix", lspace="0", rspace="0"))
    if num.exponent:
        power = _tag("mn", localise(str(int(num.exponent)), lang))
        parts += [_operator("×"), _tag("msup", _tag("mn", "10"), power)]
    return parts[0] if len(parts) == 1 else _tag("mrow", *parts)


def _is_name(node: Node) -> bool:
    return isinstance(node, Name) or (isinstance(node, Script) and isinstance(node.base, Name))


def _thin_space_between(left: Node, right: Node) -> bool:
    """A function's name stands off from what it multiplies and from an argument without brackets."""

    def is_term(node: Node, bracket: str) -> bool:
        if isinstance(node, Symbol):
            return node.kind in ("letter", "digits", bracket)
        return not isinstance(node, (Space, Fence)) or (isinstance(node, Fence) and bracket == "closing")

    if _is_name(left):
        return is_term(right, "letter")
    return _is_name(right) and is_term(left, "closing")


def _is_sign(left: Node | None, right: Node) -> bool:
    """A plus or a minus after ``=``, ``(`` or a comma is a sign: it stands close to its number."""
    return (
        isinstance(right, Symbol)
        and right.text in f"+±{MINUS}"
        and isinstance(left, Symbol)
        and left.kind in ("relation", "opening", "punctuation")
    )


def _mathml_row(items: tuple[Node, ...], lang: str) -> str:
    parts = []
    for at, item in enumerate(items):
        if at and _thin_space_between(items[at - 1], item):
            parts.append('<mspace width="0.167em"></mspace>')
        before = next((left for left in reversed(items[:at]) if not isinstance(left, Space)), None)
        parts.append(_operator(item.text, "prefix") if _is_sign(before, item) else _mathml(item, lang))
    return parts[0] if len(parts) == 1 else _tag("mrow", *parts)


def _mathml_script(node: Script, lang: str) -> str:
    base = node.base
    tops = ([_operator("′" * node.primes)] if node.primes else []) + (
        [_mathml(node.above, lang)] if node.above else []
    )
    parts = [_mathml(base, lang)]
    if node.below:
        parts.append(_mathml(node.below, lang))
    if tops:
        parts.append(tops[0] if len(tops) == 1 else _tag("mrow", *tops))
    limits = (isinstance(base, Name) and base.limits) or (
        isinstance(base, Symbol) and base.kind == "big" and base.text in "∑∏"
    )
    names = ("munder", "mover", "munderover") if limits else ("msub", "msup", "msubsup")
    return _tag(names[2 if node.below and tops else 0 if node.below else 1], *parts)


def _mathml_grid(kind: str, rows: tuple[tuple[Node, ...], ...], lang: str) -> str:
    sides = {"aligned": ("right", "left"), "cases": ("left", "left")}.get(kind, ("center", "center"))
    table = _tag(
        "mtable",
        *(
            _tag(
                "mtr",
                *(
                    _tag("mtd", _mathml(cell, lang), style=f"text-align:{sides[i % 2]}")
                    for i, cell in enumerate(row)
                ),
            )
            for row in rows
        ),
        **{"class": kind, **({"displaystyle": "true"} if kind == "aligned" else {})},
    )
    fences = {"cases": ("{", ""), "pmatrix": ("(", ")"), "bmatrix": ("[", "]"), "vmatrix": ("|", "|")}
    left, right = fences.get(kind, ("", ""))
    return _fenced(left, table, right) if left else table


def _fenced(left: str, body: str, right: str, grows: bool = True) -> str:
    stretchy = str(grows).lower()
    opening = _operator(left, "prefix", stretchy) if left else ""
    closing = _operator(right, "postfix", stretchy) if right else ""
    return _tag("mrow", opening, body, closing)


def _is_tall(node: Node) -> bool:
    """Whether brackets around it must grow; a browser leaves gaps beside those that could and do not."""
    match node:
        case Fraction() | Root() | Grid():
            return True
        case Symbol(_, kind):
            return kind == "big"
        case Row(items):
            return any(map(_is_tall, items))
        case Styled(_, body) | Accent(_, body) | Fence(_, body, _) | Script(body):
            return _is_tall(body)
    return False


def _mathml(node: Node, lang: str) -> str:
    def of(n: Node) -> str:
        return _mathml(n, lang)

    match node:
        case Symbol(text, kind):
            return _mathml_symbol(text, kind)
        case Num():
            return _mathml_num(node, lang)
        case Name(text, _):
            return _tag("mi", escape(text), **{"class": "name"})
        case Text(text):
            # A blank at the edge of a text counts; a page drops it unless it cannot break.
            return _tag("mtext", escape(text).replace(" ", "\N{NO-BREAK SPACE}"))
        case Space(width):
            return _tag("mspace", width=f"{width / 18:.3f}em")
        case Row(items):
            return _mathml_row(items, lang)
        case Styled("display", body):
            return _tag("mstyle", of(body), displaystyle="true")
        case Styled("blackboard" | "calligraphic" as hand, Symbol(text, "letter")):
            return _tag("mi", text.translate(_MATHML_HANDS[hand]), **{"class": "name"})
        case Styled(style, body):
            return _tag("mstyle", of(body), **{"class": _MATHML_STYLES[style]})
        case Fraction(above, below, display):
            drawn = _tag("mfrac", of(above), of(below))
            return drawn if display is None else _tag("mstyle", drawn, displaystyle=str(display).lower())
        case Root(body, None):
            return _tag("msqrt", of(body))
        case Root(body, index):
            return _tag("mroot", of(body), of(index))
        case Accent("underline", body):
            return _tag("munder", of(body), _operator("_", "", "true"))
        case Accent(name, body):
            if name in ("vec", "overrightarrow"):
                # The page draws this arrow as long as what it covers, whatever the fonts.
                return _tag("mover", of(body), _operator("→"), accent="true", **{"class": "arrow"})
            mark, grows = _MATHML_ACCENTS[name]
            return _tag("mover", of(body), _operator(mark, "", grows), accent="true")
        case Script():
            return _mathml_script(node, lang)
        case Fence(left, body, right):
            return _fenced(left, of(body), right, _is_tall(body))
        case Grid(kind, rows):
            return _mathml_grid(kind, rows, lang)
    raise TypeError(node)


_MATHML_ACCENTS = {
    "dot": ("˙", "false"), "ddot": ("¨", "false"), "dddot": ("˙˙˙", "false"), "overline": ("‾", "true"),
    "bar": ("‾", "false"), "hat": ("^", "false"), "tilde": ("~", "false"),
}  # fmt: skip


# -- words and lines --------------------------------------------------------------------------------


@once_for_all_numbers
def spoken(tex: str, lang: str) -> str:
    """The formula in words, for those who hear the sheet: ``θ_4`` is ``theta 4``."""
    said = _spoken(parse(tex), lang, words(lang)["formula"])
    return re.sub(r"\s+", " ", said).strip() or words(lang)["formula"]["empty"]


def _is_simple(node: Node) -> bool:
    """Whether the words of a node need no end mark: one symbol, or one symbol with a subscript."""
    match node:
        case Row(items):
            return len(items) <= 1 and all(map(_is_simple, items))
        case Script(base, _, None, 0):
            return _is_simple(base)
        case Accent(_, body):
            return _is_simple(body)
    return isinstance(node, (Symbol, Num, Name, Text))


def _spoken(node: Node, lang: str, say: dict) -> str:
    def of(n: Node) -> str:
        return _spoken(n, lang, say)

    def phrase(key: str, *parts: str) -> str:
        return say[key].format(*parts)

    match node:
        case Symbol(text, "letter") if text in say["letters"]:
            return f" {say['letters'][text]} "
        case Symbol(text, _):
            return f" {say['symbols'].get(text, text)} "
        case Num(negative, digits, exponent):
            minus = say["symbols"][MINUS] + " " if negative else ""
            power = phrase("ten_to", localise(str(int(exponent)), lang)) if exponent else ""
            return f" {minus}{localise(digits, lang)} {power} "
        case Name(text, _):
            return f" {say['functions'].get(text, text)} "
        case Text(text):
            return text
        case Space():
            return " "
        case Row(items):
            return "".join(map(of, items))
        case Styled(_, body):
            return of(body)
        case Fraction(above, below, _):
            simple = _is_simple(above) and _is_simple(below)
            return phrase("simple_fraction" if simple else "fraction", of(above), of(below))
        case Root(body, None):
            return phrase("simple_root" if _is_simple(body) else "root", of(body))
        case Root(body, index):
            return phrase("nth_root", of(index), of(body))
        case Accent(name, body):
            return phrase("accent_" + name, of(body))
        case Script():
            return _spoken_script(node, of, phrase, say)
        case Fence(left, body, right):
            return f" {say['symbols'].get(left, left)} {of(body)} {say['symbols'].get(right, right)} "
        case Grid(kind, rows):
            lines = ["; ".join([", ".join(map(of, row)) if kind != "aligned" else " ".join(map(of, row))])
                     for row in rows]  # fmt: skip
            return phrase("grid_" + ("matrix" if kind.endswith("matrix") else kind), "; ".join(lines))
    raise TypeError(node)


def _spoken_script(node: Script, of: Callable[[Node], str], phrase: Callable[..., str], say: dict) -> str:
    said = of(node.base)
    if node.below:
        one = isinstance(node.below, Symbol) and node.below.kind == "digits"
        said = phrase("simple_subscript" if one else "subscript", said, of(node.below))
    said += (" " + say["symbols"]["′"]) * node.primes
    match node.above:
        case None:
            return said
        case Symbol("2" | "3" as power, "digits"):
            return phrase("power_" + power, said)
        case Symbol("∘", _):
            return phrase("degrees", said)
        case Symbol("′", _):
            return f"{said} {say['symbols']['′']} "
    return phrase("power", said, of(node.above))


@once_for_all_numbers
def to_line(tex: str, lang: str) -> str:
    """The formula as one line of plain text, for a terminal: ``θ₄ = arctan(y/x)``."""
    return re.sub(r"  +", " ", _line(parse(tex), lang)).strip()


_LINE_ACCENTS = {"dot": "\u0307", "ddot": "\u0308", "vec": "\u20d7", "overline": "\u0305", "bar": "\u0304"}


def _grouped(node: Node, lang: str) -> str:
    text = _line(node, lang).strip()
    return text if _is_simple(node) else f"({text})"


def _raised(text: str, table: dict[int, str], mark: str) -> str:
    """Small characters where Unicode has them all, else the mark and the text."""
    if all(ord(c) in table for c in text):
        return text.translate(table)
    return mark + (text if len(text) == 1 else f"({text})" if mark == "^" else text)


def _line(node: Node, lang: str) -> str:
    def of(n: Node) -> str:
        return _line(n, lang)

    match node:
        case Symbol(text, "relation" | "binary"):
            return f" {text} "
        case Symbol(",", _):
            return ", "
        case Symbol(text, _) | Text(text):
            return text
        case Num(negative, digits, exponent):
            return number_text(
                ("-" if negative else "") + digits + (f"e{exponent}" if exponent else ""), lang
            )
        case Name(text, _):
            return f"{text} "
        case Space(width):
            return " " if width > 0 else ""
        case Row(items):
            return "".join(map(of, items)).replace(" (", "(") if items else ""
        case Styled(_, body):
            return of(body)
        case Fraction(above, below, _):
            return f"{_grouped(above, lang)}/{_grouped(below, lang)}"
        case Root(body, index):
            return (of(index).translate(SUPERSCRIPTS) if index else "") + f"√{_grouped(body, lang)}"
        case Accent(name, body):
            mark = _LINE_ACCENTS.get(name)
            text = of(body).strip()
            return "".join(c + mark for c in text) if mark else f"{text}{_TEXT_ACCENTS.get(name, '')}"
        case Script(base, below, above, primes):
            low = _raised(of(below).replace(" ", ""), SUBSCRIPTS, "_") if below else ""
            if isinstance(above, Symbol) and above.text in "∘′":
                high = "°" if above.text == "∘" else "′"
            else:
                high = _raised(of(above).replace(" ", ""), SUPERSCRIPTS, "^") if above else ""
            return f"{of(base).rstrip()}{low}{'′' * primes}{high}{' ' if isinstance(base, Name) else ''}"
        case Fence(left, body, right):
            return f"{left}{of(body).strip()}{right}"
        case Grid("aligned", rows):
            return "\n".join("".join(map(of, row)).strip() for row in rows)
        case Grid(kind, rows):
            inner = "; ".join(", ".join(of(cell).strip() for cell in row) for row in rows)
            return "{ " + inner + " }" if kind == "cases" else f"[{inner}]"
    raise TypeError(node)


_TEXT_ACCENTS = {"overrightarrow": "\u20d7", "hat": "\u0302", "tilde": "\u0303", "dddot": "\u20db"}
