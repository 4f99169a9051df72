"""Content of a report: sections of text, charts and tables. Texts are Markdown with formulas."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Chart:
    """A chart as SVG, and what it shows in words."""

    svg: str
    alt: str


@dataclass(frozen=True)
class ReportTable:
    """Rows of inline Markdown under their heads; a column of ``numbers`` is set to the right."""

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: tuple[bool, ...]
    caption: str = ""


@dataclass(frozen=True)
class ReportSection:
    """A titled part; what is in it follows in this order."""

    title: str
    text: str = ""
    charts: tuple[Chart, ...] = ()
    tables: tuple[ReportTable, ...] = ()


@dataclass(frozen=True)
class ReportContent:
    """One document in one language; ``source`` stands beside the title's line and in the footer."""

    lang: str
    course: str
    title: str
    source: str
    opening: str
    sections: tuple[ReportSection, ...]
