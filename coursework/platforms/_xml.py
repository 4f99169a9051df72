"""XML of the standard library that says anything."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

#: What XML 1.0 has no way to say.
_UNSAYABLE = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def below(parent: ET.Element, tag: str, text: str = "", **attributes: str) -> ET.Element:
    """A new element at a parent's end, with its text."""
    found = ET.SubElement(parent, tag, {name: sayable(value) for name, value in attributes.items()})
    found.text = sayable(text) or None
    return found


def sayable(text: str) -> str:
    """The same without the characters that no XML may hold."""
    return _UNSAYABLE.sub("", text)


def xml_bytes(root: ET.Element) -> bytes:
    """A document, a line an element where that changes no text."""
    ET.indent(root)
    made: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return made + b"\n"
