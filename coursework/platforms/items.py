"""Items: variants in a language as a platform presents them, and the pool from which it draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from coursework.course.variant import Variant
from coursework.issuing.assignment import Assignment
from coursework.platforms.posed import Posed, posed
from coursework.rendering.views import variant_code
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Handout

SEPARATOR = " · "


@dataclass(frozen=True)
class Item:
    """Variant in one language."""

    handout: Handout
    questions: tuple[Posed, ...]
    pool: str  #: name of the pool that it is of; identifiers hang on it
    variant: Variant

    @property
    def label(self) -> str:
        """Return the label of the variant in the platform's reports, printed in the text for students."""
        return f"[{variant_code(self.handout)}{SEPARATOR}{self.handout.lang}]"

    def label_of(self, part: str) -> str:
        """Return the label of one part, for platforms that present each part as a question."""
        return f"{self.label[:-1]}{SEPARATOR}{part}]"

    @property
    def identifier(self) -> str:
        """Return the identifier of the variant in its pool, the same at every export: letters, digits, ``-``,
        ``_``, ``.``."""
        sheet = self.handout
        return f"{self.pool}.{sheet.exercise}.v{sheet.version}.{sheet.seed}.{sheet.lang}"

    @property
    def points(self) -> float:
        return self.handout.points


class Loss(NamedTuple):
    """Loss of a part, or of an exercise if the part is empty."""

    exercise: str
    part: str
    feature: str  #: a key of ``[platforms.features]``
    instead: str  #: the platform's behaviour, in words


class MadeItem(NamedTuple):
    """Item as a platform's files hold it: plain data, which any process may make."""

    identifier: str
    exercise: str
    title: str  #: of the exercise, plain text
    points: float
    features: tuple[tuple[str, str], ...]  #: of our marking: the part, or none, and the feature
    losses: tuple[Loss, ...]  #: that the platform itself finds
    content: Any  #: as the platform makes it


@dataclass(frozen=True)
class PoolSection:
    """Variants of one exercise with the same parts, of which each student gets one."""

    exercise: str
    title: str  #: plain text
    items: tuple[MadeItem, ...]

    @property
    def points(self) -> float:
        return self.items[0].points


@dataclass(frozen=True)
class Pool:
    """Content for a platform, in one language."""

    name: str  #: letters, digits, ``-`` and ``_``
    title: str  #: plain text
    lang: str
    sections: tuple[PoolSection, ...]
    folders: tuple[Path, ...]  #: of templates
    course: Path  #: the course's folder
    assignment: Assignment | None = None

    @property
    def items(self) -> tuple[MadeItem, ...]:
        return tuple(item for section in self.sections for item in section.items)

    @property
    def points(self) -> float:
        return sum(section.points for section in self.sections)


def item(variant: Variant, pool: str) -> Item:
    """Return a variant as a platform presents it."""
    sheet = handout(variant)
    pairs = zip(sheet.questions, variant.parts, strict=True)
    return Item(sheet, tuple(posed(variant, question, part) for question, part in pairs), pool, variant)


def section(items: Sequence[MadeItem]) -> PoolSection:
    """Return the section of the variants of an exercise, in one language."""
    return PoolSection(items[0].exercise, items[0].title, tuple(items))
