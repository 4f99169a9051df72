"""Items: a variant in a language, as a platform poses it, and the pool of them that it draws from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from coursework.course.variant import Variant
from coursework.making.assignment import Assignment
from coursework.making.issuing import Issue
from coursework.platforms.posed import Posed, posed
from coursework.rendering.views import variant_code
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Handout

SEPARATOR = " · "


@dataclass(frozen=True)
class Item:
    """One variant in one language."""

    handout: Handout
    questions: tuple[Posed, ...]
    pool: str  #: name of the pool that it is of; identifiers hang on it

    @property
    def label(self) -> str:
        """What the platform's reports tell the variant by: it stands in the text that students read."""
        return f"[{variant_code(self.handout)}{SEPARATOR}{self.handout.lang}]"

    def label_of(self, part: str) -> str:
        """The same of one part, where a platform asks each part as a question of its own."""
        return f"{self.label[:-1]}{SEPARATOR}{part}]"

    @property
    def identifier(self) -> str:
        """The same for the same variant in the same pool, however often it is exported: letters, digits, ``-``, ``_``, ``.``."""
        sheet = self.handout
        return f"{self.pool}.{sheet.exercise}.v{sheet.version}.{sheet.seed}.{sheet.lang}"

    @property
    def points(self) -> float:
        return self.handout.points


@dataclass(frozen=True)
class Section:
    """The variants of one exercise, of which each student gets one: they ask the same parts."""

    exercise: str
    title: str  #: plain text
    items: tuple[Item, ...]

    @property
    def points(self) -> float:
        return self.items[0].points


@dataclass(frozen=True)
class Pool:
    """What a platform is handed, in one language."""

    name: str  #: letters, digits, ``-`` and ``_``
    title: str  #: plain text
    lang: str
    sections: tuple[Section, ...]
    issues: tuple[Issue, ...]  #: the variants, which belong to nobody
    folders: tuple[Path, ...]  #: of templates
    course: Path  #: the course's folder
    assignment: Assignment | None = None

    @property
    def items(self) -> tuple[Item, ...]:
        return tuple(item for section in self.sections for item in section.items)

    @property
    def points(self) -> float:
        return sum(section.points for section in self.sections)


def item(variant: Variant, pool: str) -> Item:
    """A variant as a platform poses it."""
    sheet = handout(variant)
    asked = zip(sheet.questions, variant.parts, strict=True)
    return Item(sheet, tuple(posed(variant, question, part) for question, part in asked), pool)


def section(variants: Sequence[Variant], pool: str) -> Section:
    """The section of the variants of an exercise, all in one language."""
    items = tuple(item(variant, pool) for variant in variants)
    return Section(items[0].handout.exercise, items[0].handout.title, items)
