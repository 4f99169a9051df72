"""Packages: archives of the same bytes for the same files, and XML that says anything."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Mapping
from xml.etree import ElementTree as ET

_FIRST_DAY = (1980, 1, 1, 0, 0, 0)  #: of the archive's calendar
#: What XML 1.0 has no way to say.
_UNSAYABLE = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def package(files: Mapping[str, bytes]) -> bytes:
    """An archive of files by their path in it."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        for path, data in files.items():
            entry = zipfile.ZipInfo(path, _FIRST_DAY)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data)
    return made.getvalue()


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
