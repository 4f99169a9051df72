"""Markdown of statements and its printers for every back end.

Markdown here is CommonMark with tables and ``$formulas$``; raw HTML is text like any other. Each
writer escapes whatever the text holds for its back end, so a ``#`` or a ``<`` prints as itself.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from html import escape, unescape
from typing import Any
from urllib.parse import unquote

from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.tree import SyntaxTreeNode
from mdit_py_plugins.dollarmath import dollarmath_plugin

from coursework.errors import BadStatement, bare_letters
from coursework.language.typography import typeset
from coursework.language.words import words
from coursework.markup.line import to_line
from coursework.markup.spoken import spoken
from coursework.markup.symbols import symbol_of


@cache
def _reader() -> MarkdownIt:
    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    # A dollar beside a letter or a digit still opens a formula: $r_1$-$r_2$.
    return reader.use(dollarmath_plugin, allow_digits=True, double_inline=True)


@lru_cache(maxsize=1024)
def tree(markdown: str) -> SyntaxTreeNode:
    """Return the syntax tree of a text."""
    return SyntaxTreeNode(_reader().parse(markdown))


def no_image(source: str) -> BadStatement:
    """Return the error for a text that shows an image."""
    return BadStatement(
        f"the text shows the image {source!r}: a sheet has one figure, drawn by its exercise, and no other"
    )


# -- Typst ------------------------------------------------------------------------------------------

_TYPST_MARKS = re.compile(r"([\\`*_$#<>@~=+/\[\]{}\"'|-])")


#: Scripts and signs that the typesetter's own fonts draw: Latin, Greek, Cyrillic, Armenian, Georgian,
#: punctuation, mathematics. Where a word is more than its letters, from right to left or by syllables, they
#: have some of it only.
_UNDRAWN = re.compile(
    "[^ "
    "-~\u00a0-\u036f\u0370-\u03ff\u0400-\u04ff\u0510-\u0513\u051a-\u051d\u0531-\u0556\u0559-\u058a\u10d0-\u10ff"
    "\u1e00-\u1f15\u1f18-\u1f1d\u1f20-\u1f45\u1f48-\u1f4d\u1f50-\u1f57\u1f59\u1f5b\u1f5d\u1f5f-\u1f7d\u1f80-\u1fb4"
    "\u1fb6-\u1fc4\u1fc6-\u1fd3\u1fd6-\u1fdb\u1fdd-\u1fef\u1ff2-\u1ff4\u1ff6-\u1ffe"
    "\u2000-\u2040\u2070-\u209f\u20a0-\u20bf\u2100-\u211e\u2126-\u214f\u20d0-\u20f0\u2190-\u23ff\u2500-\u25ff\u27c0-\u2aff"
    "\U0001d400-\U0001d454\U0001d456-\U0001d49c\U0001d49e-\U0001d49f\U0001d4a2\U0001d4a5-\U0001d4a6\U0001d4a9-\U0001d4ac"
    "\U0001d4ae-\U0001d4b9\n\t]"
)
#: Signs above a letter, which formulas have; no font of the text has them.
_ABOVE = re.compile("[\u20d0-\u20f0]")
#: A vector's letter and its arrow: one font draws the two of them.
_VECTOR = re.compile("([A-Za-zΑ-Ωα-ω0-9]\u20d7)")
_VECTOR_FONT = "New Computer Modern Math"
SUBSTITUTE = "\N{WHITE SQUARE}"  #: stands for a character that no font at hand draws


def drawable(text: str, drawn: Callable[[str], bool] = lambda char: False) -> str:
    """Replace each character that a PDF sheet cannot draw by a square; ``drawn`` accepts characters of
    fallback fonts."""
    return _UNDRAWN.sub(lambda result: result[0] if drawn(result[0]) else SUBSTITUTE, text)


def undrawn(text: str, drawn: Callable[[str], bool] = lambda char: False) -> list[str]:
    """Return the characters that a PDF sheet cannot draw, each once."""
    return [char for char in dict.fromkeys(_UNDRAWN.findall(text)) if not drawn(char)]


def typst_text(text: str, lang: str) -> str:
    """Return plain text as Typst markup that prints exactly these characters."""
    pieces = _VECTOR.split(text)
    pieces[::2] = [_typst_plain(piece, lang) for piece in pieces[::2]]
    pieces[1::2] = [_vector(item) for item in pieces[1::2]]
    return "".join(pieces)


def _typst_plain(text: str, lang: str) -> str:
    escaped = _TYPST_MARKS.sub(r"\\\1", typeset(_ABOVE.sub(SUBSTITUTE, text), lang))
    # A number with a dot at the head of a line would start a list; three dots would become one sign.
    return re.sub(r"(?<=[\d.])\.(?=\s|\.|$)", r"\\.", escaped)


def typst_string(text: str) -> str:
    """Return a Typst string literal."""
    return (
        '"' + _ABOVE.sub(SUBSTITUTE, text).replace("\\", r"\\").replace('"', r"\"").replace("\n", r"\n") + '"'
    )


def typst_typed(text: str) -> str:
    """Return typed text as a Typst expression that prints exactly these characters, without automatic
    hyphens, quotation marks or spaces."""
    pieces = _VECTOR.split(text.replace("\r\n", "\n"))
    displayed = [f"#{typst_string(piece)}" for piece in pieces]
    displayed[1::2] = [_vector(piece) for piece in pieces[1::2]]
    return f"[{''.join(displayed)}]" if len(pieces) > 1 else typst_string(pieces[0])


def _vector(piece: str) -> str:
    return f'#text(font: "{_VECTOR_FONT}", "{piece[0]}\\u{{20d7}}");'


_WHOLE = 24  #: characters of a formula written out that a line of text does not cut


@lru_cache(maxsize=4096)
def typst_formula(tex: str, lang: str, *, display: bool = False, number: str = "") -> str:
    """Return a formula as Typst markup, with its words as alternative text; a displayed one may bear a
    number.

    The semicolon ends the call: a parenthesis that follows it in the text is text.
    """
    from coursework.markup.typst import to_typst

    call = "display-formula" if display else "formula"
    full = ", whole: true" if not display and len(to_line(tex, lang)) <= _WHOLE else ""
    numbered = f", number: {typst_string(number)}" if number else ""
    return f"#{call}({typst_string(spoken(tex, lang))}, ${to_typst(tex, lang)}${full}{numbered});"


#: A text that is one formula, as most answers are, is read at a glance.
_ONE_FORMULA = re.compile(r"\$([^$`\n]+)(?<![\\\s])\$")


@lru_cache(maxsize=1024)
def to_typst_markup(markdown: str, lang: str) -> str:
    """Return Markdown as Typst markup."""
    if formula := _ONE_FORMULA.fullmatch(markdown):
        return typst_formula(formula[1].strip(), lang)
    return _block(tree(markdown), lang)


_NUMBER_LAST = re.compile(r"(?:^|[=\s{])[\d.,]+\}?\s*$")  #: of a formula
#: A number and its unit.
_VALUE = re.compile(r"\$\\num\{[^{}]*\}(?:\^\{\\circ\}|\\ \\mathrm\{(?:[^{}]|\{\d\})*\})?\$")


def typst_value(markdown: str, lang: str) -> str:
    """Return an answer as Typst markup: a number with its unit as text, which is set far faster than a
    formula."""
    if _VALUE.fullmatch(markdown):
        return typst_text(to_text(markdown, lang), lang)
    return to_typst_markup(markdown, lang)


def _follows_number(node: SyntaxTreeNode) -> bool:
    before = node.previous_sibling
    return before is not None and before.type == "math_inline" and bool(_NUMBER_LAST.search(before.content))


def _block(node: SyntaxTreeNode, lang: str) -> str:
    """Return a node's children as the body of a block: a list begins a line, since Typst nests items by their
    column."""
    begins = node.children and node.children[0].type in ("bullet_list", "ordered_list")
    return "\n" * bool(begins) + "".join(_typst(child, lang) for child in node.children).strip()


def _typst(node: SyntaxTreeNode, lang: str) -> str:
    def inside() -> str:
        return "".join(_typst(child, lang) for child in node.children)

    def items(mark: str, first: str = "") -> str:
        marks = (first or mark, *[mark] * (len(node.children) - 1))
        lines = (textwrap.indent(_typst(item, lang).strip(), "  ").lstrip() for item in node.children)
        return "\n".join(f"{entry} {line}" for entry, line in zip(marks, lines, strict=True)) + "\n\n"

    match node.type:
        case "root" | "inline" | "list_item" | "thead" | "tbody":
            return inside()
        case "paragraph":
            return f"#lead[{inside()}]\n\n" if _leads(node) else inside() + "\n\n"
        case "text":
            # A unit keeps to its number, though that is a formula of its own.
            number = _follows_number(node)
            return typst_text("0" * number + node.content, lang)[number:]
        case "softbreak":
            return "\n"
        case "hardbreak":
            return " \\\n"
        case "em" | "strong":
            # The function call, not the mark: a mark inside a word would print as itself.
            return f"#{'emph' if node.type == 'em' else 'strong'}[{inside()}];"
        case "code_inline":
            return _typst_code(node.content, lang)
        case "fence" | "code_block":
            return f"#raw(block: true, {typst_string(node.content.rstrip())})\n\n"
        case "math_inline":
            return typst_formula(node.content.strip(), lang)
        case "math_inline_double" | "math_block" | "math_block_label":
            return typst_formula(node.content.strip(), lang, display=True, number=_number(node)) + "\n\n"
        case "bullet_list":
            return items("-")
        case "ordered_list":
            start = int(node.attrs.get("start", 1))
            return items("+", "" if start == 1 else f"{start}.")
        case "blockquote":
            return f"#remark[{_block(node, lang)}]\n\n"
        case "heading":
            return f"#heading(level: {min(int(node.tag[1]) + 2, 6)})[{inside()}]\n\n"
        case "hr":
            return "#line(length: 100%, stroke: 0.4pt + luma(60%))\n\n"
        case "link":
            return _typst_link(str(node.attrs["href"]), str(node.attrs.get("title", "")), inside())
        case "image":
            raise no_image(str(node.attrs.get("src", "")))
        case "table":
            return _typst_table(node, lang)
    raise BadStatement(f"the text holds a {node.type}, which a sheet cannot print")


#: Code in running text that may be the name with which a symbol is typed.
_NAME = re.compile(r"[A-Za-z]+(?:\d+|[A-Z])?(?:_d?dot)?")


def _typst_code(code: str, lang: str) -> str:
    """Return code in running text: a symbol in place of its name, since nobody types on paper; other code as
    it is."""
    symbol = symbol_of(code) if _NAME.fullmatch(code) else ""
    return (
        typst_formula(symbol, lang) if symbol and "mathrm" not in symbol else f"#raw({typst_string(code)});"
    )


def _number(formula: SyntaxTreeNode) -> str:
    """Return the number that follows a displayed formula, ``$$…$$ (3.4)``."""
    return formula.info if formula.type == "math_block_label" else ""


def _leads(node: SyntaxTreeNode) -> bool:
    """Return whether a paragraph precedes a displayed formula or a table."""
    after = node.next_sibling
    return after is not None and after.type in ("math_block", "math_block_label", "table")


#: What a link leads to that is not a link: a term of the index, whose entry is the link's title.
INDEX = "#index"
#: What is found for an index and looks like any other word.
FOUND = ("#word", "#machine")


def _typst_link(href: str, title: str, inside: str) -> str:
    if href == INDEX or href in FOUND:
        begin = "#term(" if href == INDEX else f'#indexed("{href[1:]}", '
        return f"{begin}{typst_string(title)}, {typst_string(bare_letters(title))})[{inside}];"
    if href.startswith("#") and title:  # a place of the book, with what paper calls it
        return f"#cited({typst_string(unquote(href[1:]))}, [{inside}], {typst_string(title)});"
    position = f"label({typst_string(unquote(href[1:]))})" if href.startswith("#") else typst_string(href)
    return f"#link({position})[{inside}];"


def anchor(entry: str) -> str:
    """Return the HTML id of a term: its sort key in letters, digits and hyphens."""
    return "term-" + re.sub(r"[^a-z0-9]+", "-", bare_letters(entry)).strip("-")


def _typst_table(node: SyntaxTreeNode, lang: str) -> str:
    rows = [row.children for part in node.children for row in part.children]
    sides = [str(c.attrs.get("style", "")).removeprefix("text-align:") or "left" for c in rows[0]]
    cells = [["[" + "".join(_typst(c, lang) for c in cell.children) + "]" for cell in row] for row in rows]
    head, *body = (", ".join(row) for row in cells)
    lines = "".join(f"  {row},\n" for row in body)
    return f"#data-table(({', '.join(sides)},),\n  ({head},),\n{lines})\n\n"


# -- HTML -------------------------------------------------------------------------------------------


def html_text(text: str, lang: str) -> str:
    """Return plain text as HTML."""
    return escape(typeset(text, lang))


# A browser would send the mark that follows a formula to the next line.
_MARK_AFTER_FORMULA = re.compile(
    r'(<math display="inline"(?:(?!</math>).)*</math>)([\u00a0\u202f]?[,.;:!?)]+)', re.DOTALL
)


@lru_cache(maxsize=4096)
def to_html(markdown: str, lang: str) -> str:
    """Return Markdown as an HTML fragment; its headings stand below those of the page."""
    return _MARK_AFTER_FORMULA.sub(
        r'<span class="kept">\1\2</span>', _html_reader(lang).render(markdown).strip()
    )


def html_inline(markdown: str, lang: str) -> str:
    """Return Markdown of one paragraph as HTML without ``<p>``; several paragraphs keep theirs."""
    displayed = to_html(markdown, lang)
    item = displayed.startswith("<p>") and displayed.endswith("</p>") and displayed.count("<p>") == 1
    return displayed.removeprefix("<p>").removesuffix("</p>") if item else displayed


def html_words(markdown: str, lang: str) -> str:
    """Return Markdown as inline HTML with its tags removed, for pages turned into plain text."""
    return unescape(re.sub(r"<[^>]*>", "", html_inline(markdown, lang)))


def formula_words(markdown: str, lang: str) -> str:
    """Return the spoken words of a text that is a single formula; empty for any other text."""
    formula = _ONE_FORMULA.fullmatch(markdown)
    return spoken(formula[1].strip(), lang) if formula else ""


@cache
def _html_reader(lang: str) -> MarkdownIt:
    from coursework.markup.mathml import to_mathml

    def formula(display: bool) -> Callable[..., str]:
        return lambda renderer, tokens, at, *_: to_mathml(tokens[at].content.strip(), lang, display)

    def numbered(renderer: RendererHTML, tokens: Sequence, at: int, *_: object) -> str:
        number = escape(tokens[at].info)
        math = to_mathml(tokens[at].content.strip(), lang, True)
        return f'<div class="numbered" id="equation-{number}">{math}<span>({number})</span></div>\n'

    def text(renderer: RendererHTML, tokens: Sequence, at: int, *_: object) -> str:
        return html_text(tokens[at].content, lang)

    def heading(renderer: RendererHTML, tokens: Sequence, at: int, *_: object) -> str:
        token = tokens[at]
        level = min(int(token.tag[1]) + 2, 6)
        return f"<h{level}>" if token.nesting == 1 else f"</h{level}>\n"

    def image(renderer: RendererHTML, tokens: Sequence, at: int, *_: object) -> str:
        raise no_image(str(tokens[at].attrs.get("src", "")))

    def link(renderer: RendererHTML, tokens: Sequence, at: int, options: Any, env: Any) -> str:
        opening = next(t for t in reversed(tokens[: at + 1]) if t.type == "link_open")
        href = opening.attrs.get("href")
        if href != INDEX and href not in FOUND:
            return renderer.renderToken(tokens, at, options, env)
        tag = "dfn" if href == INDEX else "span"
        if tokens[at].nesting != 1:
            return f"</{tag}>"
        return f'<{tag} id="{anchor(str(opening.attrs.get("title", "")))}">'

    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    reader.use(dollarmath_plugin, allow_digits=True, double_inline=True)
    reader.add_render_rule("link_open", link)
    reader.add_render_rule("link_close", link)
    for name in ("math_block", "math_inline_double"):
        reader.add_render_rule(name, formula(True))
    reader.add_render_rule("math_block_label", numbered)
    reader.add_render_rule("math_inline", formula(False))
    reader.add_render_rule("text", text)
    reader.add_render_rule("image", image)
    reader.add_render_rule("heading_open", heading)
    reader.add_render_rule("heading_close", heading)
    # A table wider than a telephone scrolls in a box that a keyboard reaches.
    name = escape(words(lang)["sheet"]["table"])
    opening = f'<div class="wide-table" tabindex="0" role="group" aria-label="{name}">\n<table>\n'
    reader.add_render_rule("table_open", lambda *_: opening)
    reader.add_render_rule("table_close", lambda *_: "</table>\n</div>\n")
    return reader


# -- notebooks --------------------------------------------------------------------------------------

_NOTEBOOK_PIECES = re.compile(
    r"(?P<code>```.*?```|`[^`\n]*`)|\$\$(?P<block>.+?)\$\$|(?<!\\)\$(?P<inline>[^$]+?)(?<!\\)\$", re.DOTALL
)
_TABLE_RULE = re.compile(r"[|:\- ]*-[|:\- ]*")
_MARKDOWN_MARKS = re.compile(r"([\\`*_$\[\]|#~])")


def notebook_text(text: str, lang: str) -> str:
    """Return plain text as Markdown that shows exactly these characters."""
    one_line = " ".join(typeset(text, lang).split(" "))
    return _MARKDOWN_MARKS.sub(r"\\\1", one_line.replace("\n", " ").replace("<", "&lt;"))


def to_notebook_markdown(markdown: str, lang: str) -> str:
    """Return Markdown as a notebook shows it: numbers written out in formulas, no HTML."""
    from coursework.markup.latex import to_notebook

    def prose(text: str) -> str:
        lines = text.split("\n")
        set_lines = (line if _TABLE_RULE.fullmatch(line) else typeset(line, lang) for line in lines)
        return "\n".join(set_lines).replace(r"\<", "<").replace("<", "&lt;")

    displayed, end = [], 0
    for piece in _NOTEBOOK_PIECES.finditer(markdown):
        displayed.append(prose(markdown[end : piece.start()]))
        if piece["code"]:
            displayed.append(piece["code"])
        elif piece["block"]:
            displayed.append(f"$${to_notebook(piece['block'].strip(), lang)}$$")
        else:
            displayed.append(f"${to_notebook(piece['inline'].strip(), lang)}$")
        end = piece.end()
    return "".join(displayed) + prose(markdown[end:])


# -- plain text -------------------------------------------------------------------------------------


def to_text(markdown: str, lang: str, width: int = 88) -> str:
    """Return Markdown as plain text for a terminal, its lines at most ``width`` wide where words allow."""
    if formula := _ONE_FORMULA.fullmatch(markdown):
        line = _on_a_line(formula[1], lang)
        if len(line) <= width:
            return line
    return _text(tree(markdown), lang, width).strip("\n")


def _on_a_line(tex: str, lang: str) -> str:
    return to_line(tex.strip(), lang).replace("\n", "; ")


def _text(node: SyntaxTreeNode, lang: str, width: int) -> str:
    def inside(narrower: int = 0) -> str:
        return "".join(_text(child, lang, width - narrower) for child in node.children)

    match node.type:
        case "root" | "inline" | "list_item" | "thead" | "tbody" | "em" | "strong" | "td" | "th":
            return inside()
        case "paragraph" | "heading":
            return textwrap.fill(inside(), width, break_long_words=False, break_on_hyphens=False) + "\n\n"
        case "text":
            return typeset(node.content, lang)
        case "softbreak" | "hardbreak":
            return " "
        case "code_inline":
            return node.content
        case "fence" | "code_block":
            return textwrap.indent(node.content, "    ") + "\n"
        case "math_inline":
            return _on_a_line(node.content, lang)
        case "math_inline_double" | "math_block" | "math_block_label":
            return textwrap.indent(to_line(node.content.strip(), lang), "    ") + "\n\n"
        case "bullet_list" | "ordered_list":
            return _text_list(node, lang, width)
        case "blockquote":
            return textwrap.indent(inside(2).strip(), "| ") + "\n\n"
        case "hr":
            return "-" * width + "\n\n"
        case "link":
            return inside()
        case "image":
            raise no_image(str(node.attrs.get("src", "")))
        case "table":
            rows = [
                [_text(c, lang, width) for c in row.children]
                for part in node.children
                for row in part.children
            ]
            return "\n".join("  ".join(row) for row in rows) + "\n\n"
    raise BadStatement(f"the text holds a {node.type}, which a sheet cannot print")


def _text_list(node: SyntaxTreeNode, lang: str, width: int) -> str:
    lines = []
    for number, item in enumerate(node.children, start=int(node.attrs.get("start", 1))):
        mark = f"{number}. " if node.type == "ordered_list" else "- "
        body = "".join(_text(child, lang, width - len(mark)) for child in item.children).strip("\n")
        lines.append(mark + textwrap.indent(body, " " * len(mark)).lstrip())
    return "\n".join(lines) + "\n\n"


@lru_cache(maxsize=8192)
def plain_line(markdown: str, lang: str) -> str:
    """Return Markdown as one line of plain text."""
    from coursework.markup.markdown import to_text

    return " ".join(to_text(markdown, lang).split())
