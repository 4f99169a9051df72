"""Positions of the printed boxes on a flattened page: their light outlines are searched some millimetres
around.

A perspective by four marks leaves what a curved or folded page adds. Boxes near each other move together, and
so do the lines at a corner of a large one: each group is looked for on its own, a smooth surface goes through
what was found, and a group that was not seen takes the surface.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from coursework.scanning.pictures import opencv
from coursework.sheets.answer_pages import AnswerField, AnswerPage, Box

#: How far a group is looked for to the sides, up and down, mm: less than half the pitch of boxes.
_REACH = (3.2, 5.2)
_NEAR = (1.6, 1.6)  #: mm, around where the groups beside it say that it lies
_OFF = 0.7  #: mm that a group may lie off a smooth surface through all
_WIDEST = 36.0  #: mm, the boxes of a group
_ARM = 16.0  #: mm, the lines at a corner of a large box
_THIN = 6  #: pixels to either side of a line where there must be paper
_MOST = 60  #: of 255: a line of the outline is no darker; strokes of a pen count no more
_SEEN = 0.45  #: the share of its outline by which a group is seen
_LINE = 8  #: of 255, by how much an outline is darker than what is beside it


#: Lines that move together, each from (x0, y0) to (x1, y1), mm: upright or level.
Group: TypeAlias = tuple[tuple[float, float, float, float], ...]


@dataclass(frozen=True)
class Shifts:
    """Displacements of the print from its place: ``centres`` (n, 2) and ``offs`` (n, 2), mm; ``seen`` is the
    share of groups whose outlines were found."""

    centres: np.ndarray
    offs: np.ndarray
    seen: float

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Return the displacement at a point of the page, mm: that of the nearest group."""
        if not len(self.centres):
            return 0.0, 0.0
        nearest = int(np.argmin(np.hypot(*(self.centres - (x, y)).T)))
        dx, dy = self.offs[nearest]
        return float(dx), float(dy)

    @property
    def most(self) -> float:
        """The largest shift, mm."""
        return float(np.abs(self.offs).max(initial=0.0))

    def bent(self, picture: np.ndarray, anchors: Sequence[tuple[float, float]], scale: int) -> np.ndarray:
        """Return a flattened page corrected by the displacements, interpolated as a thin plate; ``anchors``,
        mm, do not move."""
        from scipy.interpolate import RBFInterpolator

        cv2 = opencv()
        high, wide = picture.shape
        at = np.vstack([self.centres, np.array(anchors)])
        offs = np.vstack([self.offs, np.zeros((len(anchors), 2))])
        plate = RBFInterpolator(at / 100, offs, smoothing=1e-3)
        x, y = np.meshgrid(np.arange(0, wide + 50, 50), np.arange(0, high + 50, 50))
        coarse = plate(np.column_stack([x.ravel(), y.ravel()]) / scale / 100).reshape(*x.shape, 2)
        grid = np.stack(np.meshgrid(np.arange(wide), np.arange(high)), axis=-1).astype(np.float32)
        fine = [
            cv2.remap(
                coarse[..., k].astype(np.float32), grid[..., 0] / 50, grid[..., 1] / 50, cv2.INTER_LINEAR
            )
            for k in (0, 1)
        ]
        along, down = (grid[..., k] + scale * np.clip(fine[k], -8, 8) for k in (0, 1))
        return np.asarray(cv2.remap(picture, along, down, cv2.INTER_LINEAR, borderValue=255))


def outline_shifts(ink: np.ndarray, page: AnswerPage, scale: int) -> Shifts:
    """Return the displacements of a page whose ``ink`` (255 paper) has ``scale`` pixels per millimetre."""
    groups = [group for field in page.fields for group in _groups(field)]
    groups += _pieces(page.guide)
    if not groups:
        return Shifts(np.empty((0, 2)), np.empty((0, 2)), 0.0)
    lines = _lines(ink)
    centres = np.array([_centre(group) for group in groups])
    offs, shares = _each(_displacement(lines, group, scale, (0.0, 0.0), _REACH) for group in groups)
    surface, smooth = _smooth(centres, offs, shares > _SEEN)
    again = [_displacement(lines, groups[k], scale, surface[k], _NEAR) for k in np.flatnonzero(~smooth)]
    if again:
        offs[~smooth], shares[~smooth] = _each(again)
        surface, smooth = _smooth(centres, offs, shares > _SEEN)
    return Shifts(centres, np.where(smooth[:, None], offs, surface), float(smooth.mean()))


def _each(measurements: Iterable[tuple[np.ndarray, float]]) -> tuple[np.ndarray, np.ndarray]:
    offs, shares = zip(*measurements, strict=True)
    return np.array(offs), np.array(shares)


def _groups(field: AnswerField) -> Iterator[Group]:
    """Yield the groups of outlines of a field that move together: adjacent boxes, and the corners of large
    boxes."""
    row = [box for box in (field.sign, *field.digits, *field.decimals, field.power_sign, *field.power) if box]
    row += [box for _, box in field.ticks] + [box for box in (field.unit,) if box]
    large = {
        box for box in (field.free, field.whole if field.what in ("written", "drawing") else None) if box
    }
    for box in sorted(large, key=lambda b: (b.y, b.x)):
        yield from _corners(box) if box.width > _WIDEST else [_sides(box)]
    yield from _pieces(row)


def _pieces(row: Sequence[Box]) -> Iterator[Group]:
    """Yield the outlines of boxes in a row, divided where they extend too far."""
    piece: list[Box] = []
    for box in row:
        if piece and max(span_of([*piece, box]).width, span_of([*piece, box]).height) > _WIDEST:
            yield sum(map(_sides, piece), ())
            piece = []
        piece.append(box)
    if piece:
        yield sum(map(_sides, piece), ())


def _sides(box: Box) -> Group:
    x0, y0, x1, y1 = box.x, box.y, box.x + box.width, box.y + box.height
    return (x0, y0, x1, y0), (x0, y1, x1, y1), (x0, y0, x0, y1), (x1, y0, x1, y1)


def _corners(box: Box) -> Iterator[Group]:
    """Yield the lines that meet at each corner of a large box, as far as they move together."""
    x0, y0, x1, y1 = box.x, box.y, box.x + box.width, box.y + box.height
    wide, high = min(_ARM, box.width / 2), min(_ARM, box.height / 2)
    for x, left in ((x0, x0), (x1, x1 - wide)):
        for y, top in ((y0, y0), (y1, y1 - high)):
            yield (left, y, left + wide, y), (x, top, x, top + high)


def span_of(boxes: Sequence[Box], around: float = 0.0) -> Box:
    """Return the smallest box around boxes, enlarged by ``around`` mm."""
    left, top = min(b.x for b in boxes) - around, min(b.y for b in boxes) - around
    right, bottom = max(b.x + b.width for b in boxes), max(b.y + b.height for b in boxes)
    return Box(left, top, right + around - left, bottom + around - top)


def _centre(group: Group) -> np.ndarray:
    ends = np.array(group).reshape(-1, 2)
    return (ends.min(axis=0) + ends.max(axis=0)) / 2


def _lines(ink: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """By how much each pixel is darker than what lies on both its sides: across upright lines, and across
    level ones."""
    cv2 = opencv()
    upright, level = (
        cv2.subtract(np.minimum(np.roll(ink, _THIN, axis), np.roll(ink, -_THIN, axis)), ink)
        for axis in (1, 0)
    )
    return np.minimum(upright, _MOST), np.minimum(level, _MOST)


def _displacement(
    lines: tuple[np.ndarray, np.ndarray],
    group: Group,
    scale: int,
    about: Sequence[float],
    reach: Sequence[float],
) -> tuple[np.ndarray, float]:
    """Return the displacement near ``about``, mm, at which the most of a group's outlines is visible, and
    their visible share."""
    cv2 = opencv()
    x, y = round(reach[0] * scale), round(reach[1] * scale)
    left, top = np.array(group).reshape(-1, 2).min(axis=0)
    at = round((left + about[0]) * scale) - x, round((top + about[1]) * scale) - y
    masks = _masks(group, left, top, scale)
    total: Any = 0
    for line, mask in zip(lines, masks, strict=True):
        window = _window(line, *at, mask.shape, (x, y)).astype(np.float32)
        total = total + cv2.matchTemplate(window, mask.astype(np.float32), cv2.TM_CCORR)
    total = cv2.GaussianBlur(total, (0, 0), 1.0)
    row, column = (int(v) for v in np.unravel_index(int(total.argmax()), total.shape))
    peak = at[0] + column, at[1] + row
    off = np.array([peak[0] - round(left * scale), peak[1] - round(top * scale)]) / scale
    return off, _share(lines, masks, *peak)


def _masks(group: Group, left: float, top: float, scale: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the masks of the upright and the level lines of a group, 3 pixels wide, without their
    intersections."""
    ends = np.round((np.array(group) - (left, top, left, top)) * scale).astype(int)
    high, wide = ends[:, 3].max() + 3, ends[:, 2].max() + 3
    upright, level = np.zeros((high, wide), np.uint8), np.zeros((high, wide), np.uint8)
    for x0, y0, x1, y1 in ends:
        if x0 == x1:
            upright[y0 + 3 : y1 - 2, max(x0 - 1, 0) : x0 + 2] = 1
        else:
            level[max(y0 - 1, 0) : y0 + 2, x0 + 3 : x1 - 2] = 1
    return upright, level


def _window(
    line: np.ndarray, left: int, top: int, shape: tuple[int, ...], reach: tuple[int, int] = (0, 0)
) -> np.ndarray:
    """Return a part of a picture, larger than a mask by ``reach`` on each side; it is padded beyond the
    picture."""
    high, wide = shape[0] + 2 * reach[1], shape[1] + 2 * reach[0]
    padded = np.zeros((high, wide), line.dtype)
    t, l = max(top, 0), max(left, 0)
    piece = line[t : max(top + high, 0), l : max(left + wide, 0)]
    padded[t - top : t - top + piece.shape[0], l - left : l - left + piece.shape[1]] = piece
    return padded


def _share(lines: Sequence[np.ndarray], masks: Sequence[np.ndarray], left: int, top: int) -> float:
    """Return the share of the outlines' length that is darker than its surroundings."""
    seen = total = 0
    for line, mask in zip(lines, masks, strict=True):
        piece = _window(line, left, top, mask.shape)
        seen += int((piece[mask > 0] >= _LINE).sum())
        total += int(mask.sum())
    return seen / max(total, 1)


def _smooth(centres: np.ndarray, offs: np.ndarray, seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a smooth surface through the found displacements, at all centres, and the groups that agree with
    it."""
    smoothed, surface = seen, np.zeros_like(offs)
    for _ in range(4):
        if not smoothed.any():
            break
        surface = _surface(centres, centres[smoothed], offs[smoothed])
        away = np.abs(offs - surface).max(axis=1)
        smoothed = seen & (away < max(_OFF, 1.5 * float(np.median(away[seen]))))
    return surface, seen & (np.abs(offs - surface).max(axis=1) < _OFF)


def _surface(at: np.ndarray, measured: np.ndarray, offs: np.ndarray) -> np.ndarray:
    """Return a smooth surface through the known points, at ``at``: of the second degree at most, of a lower
    one for few points."""
    degree = 2 if len(measured) >= 9 else 1 if len(measured) >= 4 else 0

    def terms(points: np.ndarray) -> np.ndarray:
        x, y = (points / 100 - 1).T
        return np.column_stack([x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i)])

    # towards no shift, where the points leave a direction open
    a = np.vstack([terms(measured), 0.1 * np.eye(terms(measured).shape[1])])
    b = np.vstack([offs, np.zeros((a.shape[0] - len(offs), 2))])
    solved = np.linalg.lstsq(a, b, rcond=None)[0]
    return terms(at) @ solved
