"""Tick boxes: empty, ticked, or filled, which withdraws a tick; an unclear box is reported, not guessed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coursework.scanning.pictures import opencv
from coursework.scanning.straightening import SCALE, Straight
from coursework.scanning.strokes import STRONG, darkness, has_dark_outline, is_bare, pieces
from coursework.sheets.answer_pages import Box

EMPTY, TICKED, TAKEN_BACK, UNSURE = "empty", "ticked", "taken back", "unsure"

_INSET = 0.7  #: mm within the outline
#: Shares of a box that ink covers: a tick's least and most, a filled one's least.
_LEAST, _MOST, _FILLED = (0.05, 0.75, 0.7)
#: Distance from ink of a place in a filled box at most, and in a crossed box at least, mm.
_BLANK = (0.35, 0.6)
_STROKE = 2.4  #: mm, a tick is at least so wide and high
_PEN = 88  #: of 255, the darkness of a pen's stroke in its middle; a stain's edge is lighter
_BEYOND = 5.0  #: mm that a tick may run on outside of its box


def tick(page: Straight, box: Box) -> str:
    """Return the state of a box: ``empty``, ``ticked``, ``taken back`` or ``unsure``."""
    if is_bare(page, box, _INSET):
        return EMPTY
    dark = darkness(page, box, _INSET)
    ink = pieces(dark > STRONG)
    mask = (ink.areas[ink.labels] > 0.2 * SCALE**2) & (ink.labels > 0)
    if not mask.any() or np.median(dark[mask]) < _PEN:
        return UNSURE
    return _by_cover(mask) if not _runs_on(page, box) else UNSURE


def _by_cover(mask: np.ndarray) -> str:
    share, blank = float(mask.mean()), _farthest_from(mask)
    if share > _FILLED and blank < _BLANK[0]:
        return TAKEN_BACK
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    is_stroke = min(np.ptp(rows), np.ptp(columns)) > _STROKE * SCALE
    return TICKED if _LEAST < share < _MOST and blank > _BLANK[1] and is_stroke else UNSURE


def _farthest_from(mask: np.ndarray) -> float:
    """Return the greatest distance, mm, of a point in a box from ink: a cross leaves room at the sides,
    hatching none."""
    cv2 = opencv()
    return float(cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 5).max()) / SCALE


def _runs_on(page: Straight, box: Box) -> bool:
    """Return True if the ink of a box is part of a stroke that extends far beyond it."""
    if has_dark_outline(page, box):
        return False
    around = darkness(page, box, -_BEYOND - 1.5) > STRONG
    ink = pieces(around)
    rim = round((_BEYOND + 1.5 + _INSET) * SCALE)
    touching = np.unique(ink.labels[rim:-rim, rim:-rim])
    left, top, width, height = ink.boxes[touching[touching > 0]].T
    edge = round(1.5 * SCALE)
    high, wide = around.shape
    return bool(
        ((left < edge) | (top < edge) | (left + width > wide - edge) | (top + height > high - edge)).any()
    )


def ticks(page: Straight, boxes: Sequence[Box]) -> tuple[str, ...]:
    return tuple(tick(page, box) for box in boxes)
