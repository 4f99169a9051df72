"""Element trees of QTI, written as QTI 3 or QTI 2.1, which differ in spelling only.

A tree has the names of QTI 2.1 without a namespace; HTML is in :data:`HTML`, formulas in :data:`MATHML`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from xml.etree import ElementTree as ET
from xml.etree.ElementTree import Element
from xml.sax.saxutils import escape

from coursework.platforms.pieces import filled

HTML = "html"  #: of no namespace in the end: QTI has taken the tags of HTML into its own
MATHML = "http://www.w3.org/1998/Math/MathML"
FORMULA = f"{{{MATHML}}}math"
_XSI = "http://www.w3.org/2001/XMLSchema-instance"
_XML = "http://www.w3.org/XML/1998/namespace"
LANG = f"{{{_XML}}}lang"
#: Element of a file that is not written: the one below it, which many files share, with these ``digits`` in
#: its blanks.
BLANKED = "blanked"

#: Attributes that QTI 2.1 has not.
_NEW = frozenset({"externalScored"})
#: Elements that QTI 2.1 lacks; their content replaces them.
_WRAPPING = frozenset({"contentBody"})
NONE: Mapping[str, str] = MappingProxyType({})
_CAPITAL = re.compile("(?<=[a-z])([A-Z])")


@dataclass(frozen=True, eq=False)
class QtiSpelling:
    """Spelling of a version of QTI."""

    version: str  #: 3.0, 2.1
    namespace: str
    schema: str  #: address of its schema
    manifest: str  #: namespace of the manifest
    manifest_schema: str
    schema_name: str  #: in the manifest
    schema_version: str
    item_type: str  #: of a resource
    test_type: str
    is_kebab: bool  #: qti-assessment-item for assessmentItem

    def tag(self, name: str) -> str:
        return f"qti-{kebab(name)}" if self.is_kebab else name

    def attribute(self, name: str) -> str:
        return kebab(name) if self.is_kebab else name


QTI_3 = QtiSpelling(
    "3.0",
    "http://www.imsglobal.org/xsd/imsqtiasi_v3p0",
    "https://purl.imsglobal.org/spec/qti/v3p0/schema/xsd/imsqti_asiv3p0_v1p0.xsd",
    "http://www.imsglobal.org/xsd/qti/qtiv3p0/imscp_v1p1",
    "https://purl.imsglobal.org/spec/qti/v3p0/schema/xsd/imsqtiv3p0_imscpv1p2_v1p0.xsd",
    "QTI Package",
    "3.0.0",
    "imsqti_item_xmlv3p0",
    "imsqti_test_xmlv3p0",
    is_kebab=True,
)
QTI_21 = QtiSpelling(
    "2.1",
    "http://www.imsglobal.org/xsd/imsqti_v2p1",
    "http://www.imsglobal.org/xsd/qti/qtiv2p1/imsqti_v2p1.xsd",
    "http://www.imsglobal.org/xsd/imscp_v1p1",
    "http://www.imsglobal.org/xsd/qti/qtiv2p1/qtiv2p1_imscpv1p2_v1p0.xsd",
    "QTIv2.1 Package",
    "1.0.0",
    "imsqti_item_xmlv2p1",
    "imsqti_test_xmlv2p1",
    is_kebab=False,
)


def kebab(name: str) -> str:
    """Return ``assessmentItem`` as ``assessment-item``."""
    return _CAPITAL.sub(r"-\1", name).lower()


def written(tree: Element, spelling: QtiSpelling) -> bytes:
    """Return a tree as a file of a version."""
    more = {"xmlns": spelling.namespace, **_schemas(spelling.namespace, spelling.schema)}
    return _file(_text(tree, spelling, more))


def manifest_written(tree: Element, spelling: QtiSpelling) -> bytes:
    """Return a manifest, which is the same in every version."""
    tree.set("xmlns", spelling.manifest)
    tree.attrib.update(_schemas(spelling.manifest, spelling.manifest_schema))
    return _file(ET.tostring(tree, encoding="unicode", short_empty_elements=True))


def _schemas(namespace: str, schema: str) -> dict[str, str]:
    return {"xmlns:xsi": _XSI, "xsi:schemaLocation": f"{namespace} {schema}"}


def _file(text: str) -> bytes:
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()


def _text(element: Element, spelling: QtiSpelling, more: Mapping[str, str] = NONE) -> str:
    """Return the text of an element in a spelling, with ``more`` attributes; that of its content if the
    spelling has no such element."""
    if element.tag == BLANKED:
        return filled(_shared_text(element[0], spelling), element.attrib["digits"])
    inside = "".join([_text(child, spelling) for child in element])
    if element.tag in _WRAPPING and not spelling.is_kebab:
        return inside
    tag, is_formula = _tag(element.tag, spelling), element.tag == FORMULA
    # A formula's root opens its namespace for all below it.
    marks = f' xmlns="{MATHML}"' if is_formula else ""
    in_html = element.tag.startswith("{")
    for name, value in element.attrib.items():
        if spelled := _attribute(name, in_html, spelling):
            marks += f' {spelled}="{_in_attribute(value)}"'
    for name, value in more.items():
        marks += f' {name}="{_in_attribute(value)}"'
    if element.text:
        inside = escape(element.text) + inside
    tail = escape(element.tail) if element.tail else ""
    return f"<{tag}{marks}>{inside}</{tag}>{tail}" if inside else f"<{tag}{marks} />{tail}"


_shared_text = lru_cache(maxsize=4096)(_text)


@lru_cache(maxsize=4096)
def _in_attribute(value: str) -> str:
    return escape(value, {'"': "&quot;", "\r": "&#13;", "\n": "&#10;", "\t": "&#09;"})


@lru_cache(maxsize=1024)
def _tag(tag: str, spelling: QtiSpelling) -> str:
    space, _, name = tag.rpartition("}")
    return name if space else spelling.tag(name)


@lru_cache(maxsize=1024)
def _attribute(name: str, in_html: bool, spelling: QtiSpelling) -> str:
    """Return the name of an attribute in a spelling; nothing if the spelling has none."""
    name = "xml:lang" if name == LANG else name
    if in_html:
        return name
    return spelling.attribute(name) if spelling.is_kebab or not (name in _NEW or "-" in name) else ""


def add(parent: Element, tag: str, text: str = "", **attributes: str) -> Element:
    """Add a child to an element and return it."""
    child = ET.SubElement(parent, tag, attributes)
    child.text = text or None
    return child


def decimal(value: float) -> str:
    """Return a number as a plain decimal that every engine reads: without exponent, with all significant
    digits."""
    from decimal import Decimal

    text = format(Decimal(repr(float(value))), "f")
    return text.rstrip("0").rstrip(".") if "." in text else text
