"""Content of a page in QTI: the tags that both versions have, formulas as MathML, no scripts and no external
files."""

from __future__ import annotations

import copy
from functools import lru_cache
from html.parser import HTMLParser
from xml.etree.ElementTree import Element

from coursework.platforms._qti_tree import HTML, MATHML

_INLINE = frozenset("a abbr b br cite code em i img kbd q small span strong sub sup var".split())
_BLOCK = frozenset(
    "blockquote dd div dl dt h1 h2 h3 h4 h5 h6 hr li ol p pre table tbody td tfoot th thead tr ul".split()
)
#: Tags that one of the versions lacks, with their replacement; other tags are dropped, and their content
#: stays.
_FOR = {"figure": "div", "section": "div", "figcaption": "p"}
_ALONE = frozenset({"img", "br", "hr", "input"})
_ATTRIBUTES = {
    "img": ("src", "alt"),
    "a": ("href",),
    "td": ("colspan", "rowspan"),
    "th": ("colspan", "rowspan", "scope"),
}
_OF_FORMULAS = (
    "display",
    "alttext",
    "mathvariant",
    "stretchy",
    "form",
    "fence",
    "separator",
    "accent",
    "accentunder",
    "lspace",
    "rspace",
    "width",
    "columnalign",
    "rowspacing",
    "columnspacing",
    "linethickness",
    "displaystyle",
    "scriptlevel",
    "largeop",
    "movablelimits",
    "symmetric",
    "minsize",
    "maxsize",
    "height",
    "depth",
    "class",
    "style",
)
#: Between two braces: a player that treats its pages as templates would evaluate their content.
_JOINED = "\N{WORD JOINER}"
BOX = "input"  #: tag of a page's input box


def html(tag: str) -> str:
    """Return the name of an HTML tag in the tree."""
    return f"{{{HTML}}}{tag}"


class _BodyReader(HTMLParser):
    """Parser from a piece of a page to elements below a ``<div>``."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.root = Element(html("div"))
        self._open: list[tuple[str, Element | None]] = [("", self.root)]
        self._in_formula = 0

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self._in_formula += tag == "math"
        element = self._element(tag, {name: value or "" for name, value in attributes})
        if element is not None:
            self._open_element().append(element)
        if tag not in _ALONE:
            self._open.append((tag, element))

    def handle_startendtag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attributes)
        if tag not in _ALONE:
            self.handle_endtag(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag in _ALONE or tag not in (opened for opened, _ in self._open):
            return
        while self._open[-1][0] != tag:
            self._in_formula -= self._open.pop()[0] == "math"
        self._open.pop()
        self._in_formula -= tag == "math"

    def handle_data(self, data: str) -> None:
        data = data.replace("{{", f"{{{_JOINED}{{")
        parent = self._open_element()
        if len(parent):
            parent[-1].tail = (parent[-1].tail or "") + data
        else:
            parent.text = (parent.text or "") + data

    def _open_element(self) -> Element:
        """Return the innermost open element."""
        return next(element for _, element in reversed(self._open) if element is not None)

    def _element(self, tag: str, attributes: dict[str, str]) -> Element | None:
        """Return the element of a tag; None if QTI has no such content."""
        if self._in_formula:
            allowed = {name: value for name, value in attributes.items() if name in _OF_FORMULAS}
            return Element(f"{{{MATHML}}}{tag}", allowed)
        if tag == BOX:
            return Element(BOX, attributes)
        name = _FOR.get(tag, tag)
        if name not in _INLINE and name not in _BLOCK:
            return None
        allowed = {
            attribute: attributes[attribute]
            for attribute in _ATTRIBUTES.get(tag, ())
            if attribute in attributes
        }
        css_class = attributes.get("class", "") or (tag if tag in _FOR else "")
        return Element(html(name), {**allowed, **({"class": css_class} if css_class else {})})


def elements(page: str, **attributes: str) -> Element:
    """Return a piece of a page as one ``<div>``."""
    root = copy.deepcopy(_parsed(page))
    root.attrib.update(attributes)
    return root


@lru_cache(maxsize=1024)  # variants of an exercise ask the same questions
def _parsed(page: str) -> Element:
    reader = _BodyReader()
    reader.feed(page.strip())
    reader.close()
    root = reader.root
    if (
        len(root) == 1
        and root[0].tag == html("div")
        and not ((root.text or "") + (root[0].tail or "")).strip()
    ):
        root = root[0]
        root.tail = None
    return root


def is_inline(element: Element) -> bool:
    """Return whether all elements below may appear within a line."""
    return all(
        child.tag.startswith(f"{{{MATHML}}}") or child.tag.rpartition("}")[2] in _INLINE
        for child in element.iter()
        if child is not element
    )


def put_in_box(tree: Element, replacement: Element) -> None:
    """Replace the input box of a page by an element."""
    for parent in tree.iter():
        for index, child in enumerate(parent):
            if child.tag == BOX:
                replacement.tail = child.tail
                parent[index] = replacement
                return
