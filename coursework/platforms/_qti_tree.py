"""Element trees of QTI, written as QTI 3 or QTI 2.1, which differ in spelling only.

A tree has the names of QTI 2.1 without a namespace; HTML is in :data:`HTML`, formulas in :data:`MATHML`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree import ElementTree as ET
from xml.etree.ElementTree import Element

HTML = "html"  #: of no namespace in the end: QTI has taken the tags of HTML into its own
MATHML = "http://www.w3.org/1998/Math/MathML"
FORMULA = f"{{{MATHML}}}math"
_XSI = "http://www.w3.org/2001/XMLSchema-instance"
_XML = "http://www.w3.org/XML/1998/namespace"
LANG = f"{{{_XML}}}lang"

#: Attributes that QTI 2.1 has not.
_NEW = frozenset({"externalScored"})
#: Elements that QTI 2.1 lacks; their content replaces them.
_WRAPPING = frozenset({"contentBody"})
_CAPITAL = re.compile("(?<=[a-z])([A-Z])")


@dataclass(frozen=True)
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
    root = next(_spelled(tree, spelling))
    root.set("xmlns", spelling.namespace)
    return _file(root, f"{spelling.namespace} {spelling.schema}")


def manifest_written(tree: Element, spelling: QtiSpelling) -> bytes:
    """Return a manifest, which is the same in every version."""
    tree.set("xmlns", spelling.manifest)
    return _file(tree, f"{spelling.manifest} {spelling.manifest_schema}")


def _file(root: Element, schemas: str) -> bytes:
    root.set("xmlns:xsi", _XSI)
    root.set("xsi:schemaLocation", schemas)
    text = ET.tostring(root, encoding="unicode", short_empty_elements=True)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()


def _spelled(element: Element, spelling: QtiSpelling) -> Iterator[Element]:
    """Yield the element in a spelling; its content if the spelling has no such element."""
    children = [grandchild for child in element for grandchild in _spelled(child, spelling)]
    if element.tag in _WRAPPING and not spelling.is_kebab:
        yield from children
        return
    copy = Element(_tag(element.tag, spelling), _attributes(element, spelling))
    copy.text, copy.tail = element.text, element.tail
    copy.extend(children)
    yield copy


def _tag(tag: str, spelling: QtiSpelling) -> str:
    space, _, name = tag.rpartition("}")
    return name if space else spelling.tag(name)


def _attributes(element: Element, spelling: QtiSpelling) -> dict[str, str]:
    attributes = {"xml:lang" if name == LANG else name: value for name, value in element.attrib.items()}
    if element.tag.startswith("{"):
        # A formula's root opens its namespace for all below it.
        return {"xmlns": MATHML, **attributes} if element.tag == FORMULA else attributes
    return {
        spelling.attribute(name): value
        for name, value in attributes.items()
        if spelling.is_kebab or not (name in _NEW or "-" in name)
    }


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
