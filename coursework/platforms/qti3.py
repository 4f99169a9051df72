"""QTI 3: a package for players of that version."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from coursework.platforms._qti_losses import losses
from coursework.platforms._qti_package import Files, item_content, package
from coursework.platforms._qti_tree import QTI_3
from coursework.platforms.items import Item, Loss, Pool
from coursework.platforms.pieces import PagePieces
from coursework.platforms.platform import Platform
from coursework.system.writing import File


class Qti3(Platform):
    name = "qti3"

    def content(self, item: Item, pieces: PagePieces) -> Files:
        return item_content(item, pieces, QTI_3)

    def files(self, pool: Pool) -> Iterator[File]:
        yield package(pool, self.name, QTI_3)

    def item_losses(self, item: Item) -> Iterable[Loss]:
        return losses(item)


PLATFORM = Qti3()
