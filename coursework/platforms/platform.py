"""Interface of the platforms. Each platform is a file of this folder, and its stem is its name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path
from typing import ClassVar

from coursework.errors import unknown
from coursework.platforms.items import Pool
from coursework.platforms.losses import Loss
from coursework.system.writing import File


class Platform(ABC):
    """Platform, or a format that several platforms read.

    A new one has a ``name``, writes files, and has its texts in every language: ``[platforms.lost.NAME]``,
    its behaviour where it lacks a feature, and ``[platforms.steps.NAME]``, the steps of the import.
    """

    name: ClassVar[str] = ""
    draws_variants: ClassVar[bool] = (
        True  #: it draws a variant of a pool for each student; else it marks variants issued by name
    )

    @abstractmethod
    def files(self, pool: Pool) -> Iterator[File]:
        """Yield the files to import, for a pool in one language; paths are below the export's folder."""

    def losses(self, pool: Pool) -> Iterable[Loss]:
        """Return further losses that depend on the pool's values."""
        return ()


_ROOM = Path(__file__).parent
#: What stands in this room and is no platform.
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
