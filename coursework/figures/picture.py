"""External picture, SVG or PNG, shown in place of a figure in every format and never with a script in it."""

from __future__ import annotations

import base64
import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from coursework.errors import BadCourse, nearest
from coursework.figures.printed import Printed

if TYPE_CHECKING:
    from xml.etree import ElementTree

    from coursework.figures.writing import Letters

_SVG, _XLINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"
_XHTML = "http://www.w3.org/1999/xhtml"
_PNG = b"\x89PNG\r\n\x1a\n"
_MM = {"": 25.4 / 96, "px": 25.4 / 96, "mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6}
_PPI = 150  #: of a PNG whose width is not given
_LENGTH = re.compile(r"\s*([0-9.]+(?:e[+-]?\d+)?)\s*([a-z]*)\s*", re.I)
_DOCTYPE = re.compile(rb"<!DOCTYPE[^>\[]*>", re.I)
#: All that draws. What else there is runs, moves, leads elsewhere, or is HTML as soon as it stands in a page.
_DRAWS = frozenset(
    (
        "svg",
        "g",
        "defs",
        "symbol",
        "use",
        "switch",
        "title",
        "desc",
        "metadata",
        "style",
        "path",
        "rect",
        "circle",
        "ellipse",
        "line",
        "polyline",
        "polygon",
        "text",
        "tspan",
        "textPath",
        "image",
        "a",
        "marker",
        "pattern",
        "clipPath",
        "mask",
        "linearGradient",
        "radialGradient",
        "stop",
        "filter",
        "view",
        "flowRoot",
        "flowRegion",
        "flowPara",
        "flowSpan",
        "solidColor",
    )
)
_FETCHES = re.compile(
    r"url\s*\(\s*['\"]?(?!['\"]?\s*(?:#|data:image/))|@import|image-set|\bsrc\s*\(|\\", re.I
)  #: a backslash writes any letter otherwise
_LINKS = (
    "href",
    "src",
    "srcset",
    "action",
    "formaction",
    "poster",
    "background",
    "data",
    "ping",
    "base",
    "content",
)


@dataclass(frozen=True, eq=False)
class Picture(Printed):
    """Picture from a file beside the exercise, or from its bytes; ``width_mm`` on paper, its natural width by
    default.

    Any other format, an SVG that holds a script or fetches something, and a missing file are refused with
    :class:`BadCourse`. A section ``## figure`` of the statement describes it in words.
    """

    source: str | Path | bytes
    width_mm: float | None = None

    def beside(self, folder: Path) -> Picture:
        """Return the picture read from its file; a relative path starts at ``folder``.

        Raises
        ------
        BadCourse
            The file does not exist, or is not a picture that can be shown.
        """
        if not isinstance(self.source, bytes):
            path = folder / self.source
            try:
                data = path.read_bytes()
            except OSError as fault:
                there = [p.name for p in folder.glob("*") if p.suffix.lower() in (".svg", ".png")]
                raise BadCourse(f"no picture {path}: {fault.strerror}{nearest(path.name, there)}") from fault
            picture = replace(self, source=data)
            try:
                picture._drawn  # noqa: B018  what cannot be shown is refused where it is named
            except BadCourse as fault:
                raise BadCourse(f"{path}: {fault}") from None
            return picture
        return self

    @cached_property
    def _drawn(self) -> tuple[str, float, float]:
        """SVG of the drawing with a placeholder for its size, its natural width in mm, and height over
        width."""
        data = self.source
        if not isinstance(data, bytes):
            raise BadCourse(f"the picture {data} has not been read yet")
        if self.width_mm is not None and not 0 < self.width_mm <= 1000:
            raise BadCourse(f"the width of a picture is a number of mm; found {self.width_mm!r}")
        if data.startswith(_PNG) and len(data) > 24:
            return _of_png(data)
        if b"<svg" in data[:4096]:
            return _of_svg(data)
        raise BadCourse(f"a picture is SVG or PNG; this begins with {data[:12]!r}: save it as one of them")

    @property
    def aspect(self) -> float:
        """Width over height."""
        return 1 / self._drawn[2]

    @property
    def size_mm(self) -> tuple[float, float]:
        wide = self.width_mm or self._drawn[1]
        return round(wide, 1), round(wide * self._drawn[2], 1)

    def fitted(self, width: float, height: float) -> Picture:
        """Return the picture, made smaller where it does not fit a room in mm."""
        wide, high = self.size_mm
        ratio = min(1.0, width / wide, height / high)
        return self if ratio == 1 else replace(self, width_mm=wide * ratio)

    def svg(self) -> str:
        """Return the picture as SVG of its size in mm; a PNG is embedded."""
        wide, high = self.size_mm
        return self._drawn[0].replace("SIZE", f'width="{wide}mm" height="{high}mm"', 1)

    outlined_svg = bare_svg = svg

    def letters(self) -> tuple[Letters, ...]:
        """Return no letters: a picture contains its own."""
        return ()

    def _repr_svg_(self) -> str:
        return self.svg()


def _of_png(data: bytes) -> tuple[str, float, float]:
    wide, high = struct.unpack(">II", data[16:24])
    if not wide or not high:
        raise BadCourse("the PNG has no size")
    inside = base64.b64encode(data).decode()
    drawn = (
        f'<svg xmlns="{_SVG}" xmlns:xlink="{_XLINK}" SIZE viewBox="0 0 {wide} {high}">'
        f'<image width="{wide}" height="{high}" xlink:href="data:image/png;base64,{inside}"/></svg>'
    )
    return drawn, wide * 25.4 / _PPI, high / wide


def _of_svg(data: bytes) -> tuple[str, float, float]:
    from xml.etree import ElementTree

    ElementTree.register_namespace("", _SVG)
    ElementTree.register_namespace("xlink", _XLINK)
    try:
        if b"<!ENTITY" in data:
            raise BadCourse("the SVG declares entities, which are not read: save it as plain SVG")
        root = ElementTree.fromstring(_DOCTYPE.sub(b"", data))
    except ElementTree.ParseError as fault:
        raise BadCourse(f"the SVG cannot be read: {fault}") from fault
    for why in _dangers(root):
        raise BadCourse(f"the SVG holds {why}: a sheet runs nothing and fetches nothing; save it without")
    wide, high = (_length(root.get(side, "")) for side in ("width", "height"))
    box = [float(n) for n in re.findall(r"-?[0-9.]+(?:e[+-]?\d+)?", root.get("viewBox", ""))]
    if len(box) != 4 and wide and high:
        root.set("viewBox", f"0 0 {wide / _MM['px']:g} {high / _MM['px']:g}")
        box = [0.0, 0.0, wide, high]
    if len(box) != 4 or not (box[2] > 0 and box[3] > 0):
        raise BadCourse("the SVG says neither its width and height nor its viewBox")
    for side in ("width", "height"):
        root.attrib.pop(side, None)
    text = ElementTree.tostring(root, encoding="unicode")
    natural = wide or (high * box[2] / box[3] if high else box[2] * _MM["px"])
    return text.replace("<svg ", "<svg SIZE ", 1), natural, box[3] / box[2]


def _length(text: str) -> float:
    """Return a length of SVG in mm; 0 where none is given, or a percentage."""
    match = _LENGTH.fullmatch(text)
    return float(match[1]) * _MM[match[2].lower()] if match and match[2].lower() in _MM else 0.0


def _dangers(root: ElementTree.Element) -> Iterator[str]:
    """Yield the elements and attributes of an SVG that would run or fetch something."""
    for element in root.iter():
        space, _, name = str(element.tag).rpartition("}")
        is_drawn = name in _DRAWS or name.startswith("fe")
        if space == f"{{{_XHTML}" or (
            space in ("", f"{{{_SVG}") and not is_drawn
        ):  # those of drawing programs are inert
            yield f"<{name}>"
        for attribute, value in element.attrib.items():
            local_name = attribute.rpartition("}")[2].lower()
            if local_name.startswith("on"):
                yield f"{local_name}=…"
            if local_name in _LINKS and not re.match(r"\s*(?:#|data:image/(?:png|jpe?g|gif);)", value):
                yield f"a link to {value[:40]!r}"
            if "}" not in attribute and _FETCHES.search(value):
                yield f"{local_name}={value[:40]!r}"
        if name == "style" and _FETCHES.search(element.text or ""):
            yield "a style that fetches"
