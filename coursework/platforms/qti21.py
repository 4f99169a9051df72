"""QTI 2.1: the package of QTI 3 in the version that most platforms import."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from coursework.platforms._qti_losses import losses
from coursework.platforms._qti_package import package
from coursework.platforms._qti_tree import QTI_21
from coursework.platforms.items import Pool
from coursework.platforms.losses import Loss
from coursework.platforms.platform import Platform
from coursework.system.writing import File


class Qti21(Platform):
    name = "qti21"

    def files(self, pool: Pool) -> Iterator[File]:
        yield package(pool, self.name, QTI_21)

    def losses(self, pool: Pool) -> Iterable[Loss]:
        return losses(pool)


PLATFORM = Qti21()
