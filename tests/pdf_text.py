"""The text of each page of a PDF, read from the file itself: its objects, its fonts' tables, its pages'
streams."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from contextlib import suppress

_OBJECT = re.compile(rb"(?<!\d)(\d+) 0 obj\b(.*?)endobj", re.DOTALL)
_STREAM = re.compile(rb"stream\r?\n(.*?)\r?\nendstream", re.DOTALL)
_TOKEN = re.compile(rb"/(\w+) [\d.]+ Tf|\(((?:[^\\()]|\\.)*)\)|\(|<([0-9A-Fa-f]+)>", re.DOTALL)
_IN_LITERAL = re.compile(rb"\\.|[()]", re.DOTALL)
_ESCAPE = re.compile(rb"\\([0-7]{1,3}|.)", re.DOTALL)
_ESCAPED = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


def page_texts(pdf: bytes) -> list[str]:
    """The text of each page in order, spaces as the typesetter wrote them."""
    objects = _objects(pdf)
    (root,) = [value for value in objects.values() if re.search(rb"/Type\s*/Catalog\b", value)]
    return [_text(page, objects) for page in _pages(objects[_ref(root, b"Pages")], objects)]


def _objects(pdf: bytes) -> dict[int, bytes]:
    found = {int(number): body for number, body in _OBJECT.findall(pdf)}
    for body in list(found.values()):
        if re.search(rb"/Type\s*/ObjStm", body):
            first = int(re.search(rb"/First (\d+)", body)[1])
            data = _stream(body)
            head = [int(word) for word in data[:first].split()]
            ends = [*head[3::2], len(data) - first]
            found |= {
                number: data[first + start : first + end]
                for number, start, end in zip(head[::2], head[1::2], ends, strict=True)
            }
    return found


def _stream(body: bytes) -> bytes:
    data = _STREAM.search(body)[1]
    with suppress(zlib.error):
        return zlib.decompressobj().decompress(data)
    return data


def _ref(body: bytes, name: bytes) -> int:
    return int(re.search(rb"/" + name + rb"\s+(\d+) 0 R", body)[1])


def _pages(node: bytes, objects: dict[int, bytes]) -> list[bytes]:
    if not re.search(rb"/Type\s*/Pages\b", node):
        return [node]
    kids = re.search(rb"/Kids\s*\[(.*?)\]", node, re.DOTALL)[1]
    return [page for kid in re.findall(rb"(\d+) 0 R", kids) for page in _pages(objects[int(kid)], objects)]


def _text(page: bytes, objects: dict[int, bytes]) -> str:
    named = re.search(rb"/Resources\s+(\d+) 0 R", page)
    resources = objects[int(named[1])] if named else page
    fonts = {
        name: _letters(objects[int(number)], objects)
        for name, number in re.findall(rb"/(\w+)\s+(\d+) 0 R", resources)
        if b"ToUnicode" in objects.get(int(number), b"")
    }
    return "".join(_said(_stream(objects[_ref(page, b"Contents")]), fonts))


def _said(content: bytes, fonts: dict[bytes, dict[int, str]]) -> Iterator[str]:
    letters, place = {}, 0
    while found := _TOKEN.search(content, place):
        place = found.end()
        if found[1]:
            letters = fonts.get(found[1], {})
            continue
        if found[3]:
            data = bytes.fromhex(found[3].decode())
        elif found[2] is not None:
            data = _unescaped(found[2])
        else:
            data, place = _literal(content, place)
        # A glyph is two bytes.
        glyphs = (int.from_bytes(data[k : k + 2], "big") for k in range(0, len(data), 2))
        yield "".join([letters.get(glyph, "") for glyph in glyphs])


def _literal(content: bytes, start: int) -> tuple[bytes, int]:
    """A string in round brackets, which may hold pairs of these, and where it ends."""
    depth = 1
    for mark in _IN_LITERAL.finditer(content, start):
        depth += {b"(": 1, b")": -1}.get(mark[0], 0)
        if not depth:
            break
    return _unescaped(content[start : mark.start()]), mark.end()


def _unescaped(data: bytes) -> bytes:
    if b"\\" not in data:
        return data
    return _ESCAPE.sub(lambda e: bytes([int(e[1], 8)]) if e[1].isdigit() else _ESCAPED.get(e[1], e[1]), data)


def _letters(font: bytes, objects: dict[int, bytes]) -> dict[int, str]:
    """A font's letters by glyph."""
    table = _stream(objects[_ref(font, b"ToUnicode")])
    return {
        int(code, 16): bytes.fromhex(text.decode()).decode("utf-16-be")
        for part in re.findall(rb"beginbfchar(.*?)endbfchar", table, re.DOTALL)
        for code, text in re.findall(rb"<([0-9a-fA-F]+)>\s*<([0-9a-fA-F]+)>", part)
    }
