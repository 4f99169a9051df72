"""Strokes of a pen in and around a box: strong and faint ink, in connected components."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from coursework.scanning.outlines import span_of
from coursework.scanning.pictures import opencv
from coursework.scanning.straightening import SCALE, Straight
from coursework.sheets.answer_pages import Box

STRONG = 70  #: of 255, by how much a stroke of a pen is darker than paper
FAINT = 16  #: of 255, by how much anything is, on paper without noise
_SPOT = 0.4  #: mm2, strong ink no larger is dust
_FAINT_SPOT = 0.9  #: mm2, the same of what is faint, as the rim of dust is
_SPOTS = 0.025  #: share of an empty box that is faint in spots, at most
#: Strip above and below a box, mm: outside of its outline, and short of what is printed there.
_BEYOND = (0.35, 1.15)
_THIN_STROKE = 0.15  #: mm2, the least of a short stroke of a thin pen
_OUTLINE = 0.45  #: mm to either side of an outline that is dark itself
_RIM = 1.3  #: mm from a box's outline within which ink of a neighbour ends


@dataclass(frozen=True)
class InkPieces:
    """Ink that hangs together: ``labels`` numbers it pixel by pixel, 0 where there is none; for each piece
    its ``boxes``: left, top, width, height in pixels, and ``areas`` in pixels (row 0 is the paper)."""

    labels: np.ndarray
    boxes: np.ndarray
    areas: np.ndarray

    def inside(self, part: np.ndarray) -> np.ndarray:
        """Of each piece, the pixels that lie in a part of the picture, given by its labels."""
        return np.bincount(part.ravel(), minlength=len(self.areas))


def pieces(mask: np.ndarray) -> InkPieces:
    cv2 = opencv()
    _, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    return InkPieces(labels, stats[:, :4], stats[:, 4])


def darkness(page: Straight, box: Box, inset: float = 0.0) -> np.ndarray:
    """By how much what lies in a box is darker than paper, 0 to 255."""
    return 255 - page.cut(box, inset)


def faint_limit(page: Straight) -> float:
    """Return the darkness above which something may be ink on this page: above the noise of its paper."""
    return max(FAINT, 6 * page.noise)


def is_bare(page: Straight, box: Box, inset: float = 0.9) -> bool:
    """Return True if a box is certainly empty: it contains only dust, and nothing faint."""
    dark = darkness(page, box, inset)
    if not dark.size:
        return False
    strong = pieces(dark > STRONG).areas[1:]
    faint = pieces(dark > faint_limit(page)).areas[1:]
    unit = SCALE**2
    return bool(
        strong.max(initial=0) < _SPOT * unit
        and faint[faint > 0.06 * unit].sum() < _SPOTS * dark.size
        and faint.max(initial=0) < _FAINT_SPOT * unit
    )


def has_stroke(page: Straight, box: Box, length: float) -> bool:
    """Return True if something in a box is as long or high as ``length``, mm: a thin or pale stroke, since
    dust is round."""
    dark = darkness(page, box, 0.9)
    for limit in (STRONG, faint_limit(page)):
        connected = pieces(dark > limit)
        long = connected.boxes[1:, 2:].max(axis=1, initial=0) >= length * SCALE
        if bool((long & (connected.areas[1:] >= _THIN_STROKE * SCALE**2)).any()):
            return True
    return False


def runs_through(page: Straight, box: Box) -> bool:
    """Return True if something runs through a box from above it to below, like the edge of a shadow or of a
    stain, and unlike a digit."""
    near, far = _BEYOND
    least = _THIN_STROKE * SCALE**2
    tops = (box.y - far, box.bottom + near)
    strips = (replace(box, x=box.x - near, y=y, width=box.width + 2 * near, height=far - near) for y in tops)
    return all(int((darkness(page, strip) > faint_limit(page)).sum()) >= least for strip in strips)


def cuts_a_corner(page: Straight, box: Box) -> bool:
    """Return True if ink in a box extends above or below it and beyond a side, like such an edge; a digit
    that touches its neighbour may do so too."""
    near, far = _BEYOND
    least, rim = _THIN_STROKE * SCALE**2, round((far - near) / 2 * SCALE)  # a dark outline is broad
    connected = pieces(darkness(page, box, -far) > faint_limit(page))
    within = slice(4 * rim, -4 * rim)  # where no outline runs, of this box or of those beside it
    inside, above, below, left, right = (
        connected.inside(connected.labels[part]) >= limit
        for part, limit in (
            ((within, within), least),
            (np.s_[:rim], least / 3),
            (np.s_[-rim:], least / 3),
            ((within, np.s_[:rim]), least / 3),
            ((within, np.s_[-rim:]), least / 3),
        )
    )
    return bool((inside & (above | below) & (left | right))[1:].any())


def has_dark_outline(page: Straight, box: Box) -> bool:
    """Return True if the outline of a box is dark itself, as in some black-and-white scans."""
    dark = darkness(page, box, -0.25)
    if min(dark.shape, default=0) < 12:
        return False
    sides = (dark[:, :5].max(axis=1), dark[:, -5:].max(axis=1), dark[:5].max(axis=0), dark[-5:].max(axis=0))
    return sum(float(np.mean(side > STRONG)) > 0.6 for side in sides) >= 3


def row_ink(page: Straight, boxes: Sequence[Box], within: Box | None = None) -> tuple[np.ndarray, Box]:
    """Return the ink (255 paper) of the boxes in a row, and their span: 1.5 mm more, or the given
    area; dark outlines are erased."""
    span = within or span_of(boxes, 1.5)
    ink = page.cut(span).copy()
    for box in boxes:
        if has_dark_outline(page, box):
            _wipe(ink, box, span)
    return ink, span


def _wipe(ink: np.ndarray, box: Box, span: Box) -> None:
    """Paper where the outline of a box runs."""
    outer = part_of(ink, box, span, -_OUTLINE)
    inner = part_of(ink, box, span, _OUTLINE).copy()
    outer[:] = 255
    part_of(ink, box, span, _OUTLINE)[:] = inner


def part_of(picture: np.ndarray, box: Box, span: Box, inset: float = 0.0) -> np.ndarray:
    """Return the view of a box on the picture of a span of boxes."""
    left, top = box.x - span.x + inset, box.y - span.y + inset
    right, bottom = left + box.width - 2 * inset, top + box.height - 2 * inset
    x0, y0, x1, y1 = (max(round(v * SCALE), 0) for v in (left, top, right, bottom))
    return picture[y0:y1, x0:x1]


def cells(page: Straight, boxes: Sequence[Box]) -> tuple[list[np.ndarray], str]:
    """Return pictures of the boxes of a row, each with its own ink alone, 255 paper; and the fault of ink
    that lies in several boxes.

    A stroke that leaves its box is cut off at the outline, and erased from the box in which it ends. The
    fault is ``struck`` if ink runs across several boxes, ``joined`` if it joins two of them.
    """
    ink, span = row_ink(page, boxes)
    connected = pieces(255 - ink > STRONG)
    shares = np.array([connected.inside(part_of(connected.labels, box, span)) for box in boxes])
    shares[:, 0] = 0
    assigned = _across(connected, shares, boxes)
    owner = shares.argmax(axis=0)
    views = []
    for k, box in enumerate(boxes):
        view = part_of(ink, box, span).copy()
        labels = part_of(connected.labels, box, span)
        foreign = np.isin(labels, np.flatnonzero((owner != k) & (shares[k] > 0)))
        view[_grown(foreign)] = 255
        views.append(view)
    return views, assigned


def _across(connected: InkPieces, shares: np.ndarray, boxes: Sequence[Box]) -> str:
    """Return the fault of ink in several boxes: more than a millimetre of a stroke in a second one."""
    unit = SCALE**2
    pitch = min((b.x - a.x for a, b in pairwise(boxes)), default=boxes[0].width)
    wide = connected.boxes[1:, 2] > 1.9 * pitch * SCALE
    if len(boxes) > 1 and bool((wide & (connected.areas[1:] > unit)).any()):
        return "struck"
    second = np.sort(shares, axis=0)[-2] if len(boxes) > 1 else np.zeros(len(connected.areas))
    return "joined" if bool((second[1:] > 1.1 * unit).any()) else ""


def _grown(mask: np.ndarray) -> Any:
    cv2 = opencv()
    return cv2.dilate(mask.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)
