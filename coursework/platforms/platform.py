"""Interface of the platforms. Each platform is a file of this folder, and its stem is its name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar

from coursework.course.key_batch import keys_of
from coursework.course.variant import Variant
from coursework.errors import unknown
from coursework.platforms.items import Item, Loss, MadeItem, Pool, item
from coursework.platforms.losses import features_of
from coursework.platforms.pieces import PagePieces
from coursework.rendering.renderer import renderer_of
from coursework.system.writing import File


class Platform(ABC):
    """Platform, or a format that several platforms read.

    A new one has a ``name``, writes files, and has its texts in every language: ``[platforms.lost.NAME]``,
    its behaviour where it lacks a feature, and ``[platforms.steps.NAME]``, the steps of the import.
    """

    name: ClassVar[str] = ""
    #: It draws a variant of a pool for each student; else it marks variants issued by name.
    draws_variants: ClassVar[bool] = True

    def content(self, item: Item, pieces: PagePieces) -> Any:
        """Return what the files hold of a variant that the platform draws: plain data."""
        raise NotImplementedError

    @abstractmethod
    def files(self, pool: Pool) -> Iterator[File]:
        """Yield the files to import, for a pool in one language; paths are below the export's folder."""

    def files_of(self, pools: Sequence[Pool]) -> Iterator[File]:
        """Yield the files to import, for a pool in several languages: those of each language."""
        return (file for pool in pools for file in self.files(pool))

    def item_losses(self, item: Item) -> Iterable[Loss]:
        """Return further losses that depend on a variant's values."""
        return ()

    def losses(self, pool: Pool) -> Iterable[Loss]:
        """Return further losses that depend on the pool's values."""
        return (loss for made in pool.items for loss in made.losses)

    def made(self, item: Item, pieces: PagePieces) -> MadeItem:
        """Return a variant as the files hold it."""
        sheet = item.handout
        return MadeItem(
            item.identifier,
            sheet.exercise,
            sheet.title,
            item.points,
            tuple(features_of(item)),
            tuple(self.item_losses(item)),
            self.content(item, pieces),
        )


def made_items(name: str, variants: Sequence[Variant], pool: str) -> list[MadeItem]:
    """Return variants of one exercise and language as the files of the platform of a name hold them."""
    platform, first = platform_of(name), variants[0]
    keys_of(first.exercise, variants)
    pieces = PagePieces(renderer_of(first.exercise.folder).template_folders, first.lang)
    return [platform.made(item(variant, pool), pieces) for variant in variants]


_ROOM = Path(__file__).parent
#: What stands in this room and is not a platform.
_ENGINE = ("__init__", "exporting", "items", "losses", "pieces", "platform", "pools", "posed")


def platforms() -> tuple[str, ...]:
    """Return the names of the platforms."""
    return tuple(
        sorted(
            path.stem
            for path in _ROOM.glob("*.py")
            if path.stem not in _ENGINE and not path.stem.startswith("_")
        )
    )


def platform_of(name: str) -> Platform:
    """Return the platform of a name.

    Raises
    ------
    UnknownName
        There is none; with the nearest name.
    """
    if name not in platforms():
        raise unknown("platform", name, platforms())
    module = import_module(f"coursework.platforms.{name}")
    platform: Platform = module.PLATFORM
    return platform
