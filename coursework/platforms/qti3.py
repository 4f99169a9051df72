"""QTI 3: a package for players of that version."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from coursework.platforms._qti_losses import losses
from coursework.platforms._qti_package import package
from coursework.platforms._qti_tree import QTI_3
from coursework.platforms.items import Pool
from coursework.platforms.losses import Loss
from coursework.platforms.platform import Platform
from coursework.system.writing import File


class Qti3(Platform):
    name = "qti3"

    def files(self, pool: Pool) -> Iterator[File]:
        yield package(pool, self.name, QTI_3)

    def losses(self, pool: Pool) -> Iterable[Loss]:
        return losses(pool)


PLATFORM = Qti3()
