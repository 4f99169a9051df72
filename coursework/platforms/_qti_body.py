"""What a page shows, as QTI takes it: the tags that both versions have, formulas as MathML, nothing that runs or is fetched."""

from __future__ import annotations

from html.parser import HTMLParser
from xml.etree.ElementTree import Element

from coursework.platforms._qti_tree import HTML, MATHML

_INLINE = frozenset("a abbr b br cite code em i img kbd q small span strong sub sup var".split())
_BLOCK = frozenset(
    "blockquote dd div dl dt h1 h2 h3 h4 h5 h6 hr li ol p pre table tbody td tfoot th thead tr ul".split()
)
#: Tags that one of the versions has not, and what stands for each; any other tag goes, and its content stays.
_FOR = {"figure": "div", "section": "div", "figcaption": "p"}
_ALONE = frozenset({"img", "br", "hr", "input"})
_KEPT = {
    "img": ("src", "alt"),
    "a": ("href",),
    "td": ("colspan", "rowspan"),
    "th": ("colspan", "rowspan", "scope"),
}
_OF_FORMULAS = (
    "display", "alttext", "mathvariant", "stretchy", "form", "fence", "separator", "accent", "accentunder", "lspace", "rspace",
    "width", "columnalign", "rowspacing", "columnspacing", "linethickness", "displaystyle", "scriptlevel",
    "largeop", "movablelimits", "symmetric", "minsize", "maxsize", "height", "depth", "class", "style",
)  # fmt: skip
#: Between two braces: a player that makes a template of what it shows would work out what stands within them.
_JOINED = "\N{WORD JOINER}"
BOX = "input"  #: stands in a page where its answer is typed


def html(tag: str) -> str:
    """The name of a tag of HTML in a tree."""
    return f"{{{HTML}}}{tag}"


class _Reader(HTMLParser):
    """From a piece of a page to elements below a ``<div>``."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.root = Element(html("div"))
        self._open: list[tuple[str, Element | None]] = [("", self.root)]
        self._in_formula = 0

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self._in_formula += tag == "math"
        made = self._made(tag, {name: value or "" for name, value in attributes})
        if made is not None:
            self._place().append(made)
        if tag not in _ALONE:
            self._open.append((tag, made))

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
        place = self._place()
        if len(place):
            place[-1].tail = (place[-1].tail or "") + data
        else:
            place.text = (place.text or "") + data

    def _place(self) -> Element:
        """The innermost element that is open."""
        return next(made for _, made in reversed(self._open) if made is not None)

    def _made(self, tag: str, attributes: dict[str, str]) -> Element | None:
        """The element of a tag; None of one that is no content of QTI."""
        if self._in_formula:
            kept = {name: value for name, value in attributes.items() if name in _OF_FORMULAS}
            return Element(f"{{{MATHML}}}{tag}", kept)
        if tag == BOX:
            return Element(BOX, attributes)
        name = _FOR.get(tag, tag)
        if name not in _INLINE and name not in _BLOCK:
            return None
        kept = {one: attributes[one] for one in _KEPT.get(tag, ()) if one in attributes}
        told = attributes.get("class", "") or (tag if tag in _FOR else "")
        return Element(html(name), {**kept, **({"class": told} if told else {})})


def elements(page: str, **attributes: str) -> Element:
    """A piece of a page as one ``<div>``; of a piece that is one ``<div>`` already, that."""
    reader = _Reader()
    reader.feed(page.strip())
    reader.close()
    found = reader.root
    if (
        len(found) == 1
        and found[0].tag == html("div")
        and not ((found.text or "") + (found[0].tail or "")).strip()
    ):
        found = found[0]
        found.tail = None
    found.attrib.update(attributes)
    return found


def is_inline(element: Element) -> bool:
    """Whether all below an element may stand within a line."""
    return all(
        one.tag.startswith(f"{{{MATHML}}}") or one.tag.rpartition("}")[2] in _INLINE
        for one in element.iter()
        if one is not element
    )


def put_in_box(tree: Element, put: Element) -> None:
    """Let an element take the place of the box of a page."""
    for parent in tree.iter():
        for place, child in enumerate(parent):
            if child.tag == BOX:
                put.tail = child.tail
                parent[place] = put
                return
