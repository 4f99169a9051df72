"""Losses of a variant in QTI that depend on its values and choices."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from coursework.language.words import words
from coursework.platforms.items import Item, Loss
from coursework.platforms.posed import CHOICES, Posed


def losses(item: Item) -> Iterator[Loss]:
    """Yield the known errors to which a player cannot give our points."""
    sheet = item.handout
    texts = words(sheet.lang)["platforms"]["qti"]
    for posed in item.questions:
        if posed.kind == CHOICES and "mistakes" in posed.features:
            yield Loss(sheet.exercise, posed.question.id, "mistakes", texts["by_share"])
        elif _near(posed):
            yield Loss(sheet.exercise, posed.question.id, "mistakes", texts["near"])


def _near(posed: Posed) -> bool:
    """Return whether the intervals of two known errors overlap, apart from whole turns."""
    wrong = [interval for interval in posed.intervals if not interval.is_right]
    return any(
        interval.value != other.value and interval.low <= other.high and other.low <= interval.high
        for interval, other in combinations(wrong, 2)
    )
