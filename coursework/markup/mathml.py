"""Formulas as MathML."""

from __future__ import annotations

import re
from html import escape

from coursework.language.numbers import MINUS, localise
from coursework.markup.formula_tree import (
    Accent,
    Fence,
    FormulaRow,
    FormulaText,
    Fraction,
    Grid,
    Name,
    Node,
    Num,
    Root,
    Script,
    Space,
    Styled,
    Symbol,
    parse,
)
from coursework.markup.number_holes import once_for_all_numbers
from coursework.markup.spoken import spoken

# -- MathML -----------------------------------------------------------------------------------------


_TAGS = re.compile(r"<[^>]*>")
_FITS = 24  #: characters that a line of a telephone holds


def to_mathml(tex: str, lang: str, display: bool = False) -> str:
    """Return the formula as a ``<math>`` element that needs no script and no font of its own."""
    layout = "block" if display else "inline"
    label = escape(spoken(tex, lang))
    body = _mathml_body(tex, lang)
    # A displayed formula, or a long one in a text, may be wider than a telephone: it scrolls, so a keyboard
    # must reach it.
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
    """Return whether a thin space separates a function's name from a factor or an argument without
    brackets."""

    def is_term(node: Node, bracket: str) -> bool:
        if isinstance(node, Symbol):
            return node.kind in ("letter", "digits", bracket)
        return not isinstance(node, (Space, Fence)) or (isinstance(node, Fence) and bracket == "closing")

    if _is_name(left):
        return is_term(right, "letter")
    return _is_name(right) and is_term(left, "closing")


def _is_sign(left: Node | None, right: Symbol) -> bool:
    """Return whether a plus or minus is a sign, after ``=``, ``(`` or a comma, set close to its number."""
    return (
        right.text in f"+±{MINUS}"
        and isinstance(left, Symbol)
        and left.kind in ("relation", "opening", "punctuation")
    )


def _mathml_row(items: tuple[Node, ...], lang: str) -> str:
    parts = []
    for at, item in enumerate(items):
        if at and _thin_space_between(items[at - 1], item):
            parts.append('<mspace width="0.167em"></mspace>')
        before = next((left for left in reversed(items[:at]) if not isinstance(left, Space)), None)
        if isinstance(item, Symbol) and _is_sign(before, item):
            parts.append(_operator(item.text, "prefix"))
        else:
            parts.append(_mathml(item, lang))
    return parts[0] if len(parts) == 1 else _tag("mrow", *parts)


def _mathml_script(node: Script, lang: str) -> str:
    base = node.base
    if isinstance(node.above, Symbol) and node.above.text == "∘" and not (node.below or node.primes):
        return _tag("mrow", _mathml(base, lang), _tag("mtext", "°"))  # at the height of degrees in a text
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
    """Return whether brackets around a node must stretch; browsers leave gaps beside stretchable ones that do
    not."""
    match node:
        case Fraction() | Root() | Grid():
            return True
        case Symbol(_, kind):
            return kind == "big"
        case FormulaRow(items):
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
        case FormulaText(text):
            # A blank at the edge of a text counts; a page drops it unless it cannot break.
            return _tag("mtext", escape(text).replace(" ", "\N{NO-BREAK SPACE}"))
        case Space(width):
            return _tag("mspace", width=f"{width / 18:.3f}em")
        case FormulaRow(items):
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
        case Root(body, index):
            return _tag("msqrt", of(body)) if index is None else _tag("mroot", of(body), of(index))
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
    "dot": ("˙", "false"),
    "ddot": ("¨", "false"),
    "dddot": ("˙˙˙", "false"),
    "overline": ("‾", "true"),
    "bar": ("‾", "false"),
    "hat": ("^", "false"),
    "tilde": ("~", "false"),
}
