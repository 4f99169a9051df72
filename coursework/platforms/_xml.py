"""XML of the standard library, for any text."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

#: What XML 1.0 has no way to say.
_UNSAYABLE = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def below(parent: ET.Element, tag: str, text: str = "", **attributes: str) -> ET.Element:
    """Add a child element with its text, and return it."""
    element = ET.SubElement(parent, tag, {name: sayable(value) for name, value in attributes.items()})
    element.text = sayable(text) or None
    return element


def sayable(text: str) -> str:
    """Return the text without the characters that XML forbids."""
    return _UNSAYABLE.sub("", text)


def inner_bytes(root: ET.Element) -> bytes:
    """Return what a document of this root holds within the root: those of several, one after the other, are
    the document of all."""
    data, tag = xml_bytes(root), root.tag.encode()
    return data[data.index(b">", data.index(b"<" + tag)) + 1 : data.rindex(b"\n</" + tag)]


def xml_bytes(root: ET.Element) -> bytes:
    """Return a document, with one element per line if that changes no text."""
    ET.indent(root)
    data: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return data + b"\n"
