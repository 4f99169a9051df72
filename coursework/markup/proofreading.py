"""Checks of a text for what a sheet cannot print: a dollar without its partner, an unreadable formula."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from coursework.errors import BadStatement

_FENCE = re.compile(r"^(```|~~~).*?^\1", re.MULTILINE | re.DOTALL)
_HEADING = re.compile(r"^#{1,6}[ \t].*$", re.MULTILINE)
_CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)", re.DOTALL)
#: Between two paragraphs; an item of a list and a heading are paragraphs of their own.
_BETWEEN = re.compile(r"\n\s*\n|\n(?=[ \t]*(?:[-*+]|\d+[.)]|#{1,6})[ \t])")
_DOLLAR = re.compile(r"\\.|(\$)", re.DOTALL)
_SHOWN = 40  #: characters of a paragraph that a message quotes


def pair_dollars(markdown: str, position: Callable[[str], str]) -> None:
    r"""Refuse a paragraph with an odd number of dollars; ``\$`` does not count, nor does code.

    ``position`` says where a piece of the text stands: the file, and the line if it is known.
    """
    if markdown.count("$") == 0:
        return
    alone = _HEADING.sub(r"\g<0>\n", _FENCE.sub("", markdown))
    for paragraph in _BETWEEN.split(alone):
        if _dollars(paragraph) % 2 and (count := _dollars(_CODE.sub("", paragraph))) % 2:
            line = paragraph.strip().split("\n")[0]
            quoted = line if len(line) <= _SHOWN else f"{line[:_SHOWN]}…"
            raise BadStatement(
                f"{position(line)}: the paragraph “{quoted}” has {count} $, and a formula stands "
                "between two; "
                r"the sign itself is written \$"
            )


def _dollars(text: str) -> int:
    return sum(bool(result[1]) for result in _DOLLAR.finditer(text))


def read_formulas(markdown: str, position: Callable[[str], str]) -> None:
    """Refuse a text with an unreadable formula, and report its position."""
    from coursework.markup.formula_tree import parse

    for tex in _formulas(markdown):
        try:
            parse(tex.strip())
        except BadStatement as fault:
            raise BadStatement(f"{position(tex.strip())}: {fault}") from fault


def _formulas(markdown: str) -> Iterator[str]:
    from coursework.markup.markdown import tree

    return (node.content for node in tree(markdown).walk() if node.type.startswith("math_"))
