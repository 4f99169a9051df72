"""What every platform says of itself. A platform is a file of this room: its stem is the word by which it is asked for."""

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
    """One platform, or one format that several read. A newcomer has a ``name``, writes files, and has its words in every
    language: ``[platforms.lost.NAME]``, what it does instead of what it does not do, and ``[platforms.steps.NAME]``, how its
    files are imported."""

    name: ClassVar[str] = ""
    deals: ClassVar[bool] = (
        True  #: it gives each student a variant of a pool; else it marks what was handed out by name
    )

    @abstractmethod
    def files(self, pool: Pool) -> Iterator[File]:
        """What the platform imports, of a pool in one language; paths are below the export's folder."""

    def losses(self, pool: Pool) -> Iterable[Loss]:
        """What is lost besides what the words of the platform say of every question: what hangs on a value."""
        return ()


_ROOM = Path(__file__).parent
#: What stands in this room and is no platform.
_ENGINE = ("__init__", "exporting", "items", "losses", "pieces", "platform", "pools", "posed")


def platforms() -> tuple[str, ...]:
    """The names of the platforms there are."""
    return tuple(
        sorted(
            path.stem
            for path in _ROOM.glob("*.py")
            if path.stem not in _ENGINE and not path.stem.startswith("_")
        )
    )


def platform_of(name: str) -> Platform:
    """The platform of a name.

    Raises
    ------
    UnknownName
        There is none; with the nearest name.
    """
    if name not in platforms():
        raise unknown("platform", name, platforms())
    module = import_module(f"coursework.platforms.{name}")
    found: Platform = module.PLATFORM
    return found
