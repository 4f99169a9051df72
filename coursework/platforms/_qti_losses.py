"""What of a pool is lost in QTI that hangs on its values and choices."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from coursework.language.words import words
from coursework.platforms.items import Pool
from coursework.platforms.losses import Loss
from coursework.platforms.posed import CHOICES, Posed


def losses(pool: Pool) -> Iterator[Loss]:
    """Known errors that a player cannot price as we do."""
    said = words(pool.lang)["platforms"]["qti"]
    for section in pool.sections:
        for item in section.items:
            for posed in item.questions:
                if posed.kind == CHOICES and "mistakes" in posed.features:
                    yield Loss(section.exercise, posed.question.id, "mistakes", said["by_share"])
                elif _near(posed):
                    yield Loss(section.exercise, posed.question.id, "mistakes", said["near"])


def _near(posed: Posed) -> bool:
    """Whether two known errors of a question, no turns of one another, have numbers in common."""
    wrong = [one for one in posed.intervals if not one.is_right]
    return any(
        one.value != other.value and one.low <= other.high and other.low <= one.high
        for one, other in combinations(wrong, 2)
    )
