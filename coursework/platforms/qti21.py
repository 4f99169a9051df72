"""QTI 2.1: the package of QTI 3 in the version that most platforms import."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from coursework.platforms._qti_losses import losses
from coursework.platforms._qti_package import Files, item_content, package
from coursework.platforms._qti_tree import QTI_21
from coursework.platforms.items import Item, Loss, Pool
from coursework.platforms.pieces import PagePieces
from coursework.platforms.platform import Platform
from coursework.system.writing import File


class Qti21(Platform):
    name = "qti21"

    def content(self, item: Item, pieces: PagePieces) -> Files:
        return item_content(item, pieces, QTI_21)

    def files(self, pool: Pool) -> Iterator[File]:
        yield package(pool, self.name, QTI_21)

    def item_losses(self, item: Item) -> Iterable[Loss]:
        return losses(item)


PLATFORM = Qti21()
