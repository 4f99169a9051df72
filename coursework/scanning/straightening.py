"""A page laid flat: from its corner marks and its code to a picture of 10 pixels a millimetre, evenly lit.

Marks give a perspective; what it leaves (a curved page of a photograph, a fold) is measured where outlines of
boxes are seen, and the boxes are looked for there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from coursework.scanning.codes import PageCode
from coursework.scanning.outlines import Shifts, outline_shifts
from coursework.scanning.pictures import opencv
from coursework.sheets.answer_pages import AnswerPage, Box

SCALE = 10  #: pixels a millimetre
MARK = 6.0  #: mm, the side of a corner mark
_BENT = 0.4  #: mm, a page with larger shifts is bent straight
_WORK = 4.0  #: pixels a millimetre at which marks are looked for
_NEAREST = 5  #: candidates tried for a mark
_REACH = 45.0  #: mm that the code alone may misplace a mark by
_CODE_OFF = 1.6  #: mm by which four marks may misplace the code: a curved page
_CODE_OFF_OF_THREE = 0.9  #: mm, three marks and the code together


class NotStraight(Exception):
    """The marks of a page are not found, or do not agree with its code; the word says which."""


@dataclass(frozen=True)
class Straight:
    """A page laid flat.

    ``paper`` is grey as scanned; ``ink`` is the same beside the paper around: 255 paper, 0 black. Both have
    10 pixels a millimetre. ``shifts`` say how far off its place, in mm, what is printed lies. ``marks`` is
    how many of the four were found; ``noise`` the spread of bare paper in ``ink``, of 255.
    """

    paper: np.ndarray
    ink: np.ndarray
    shifts: Shifts
    marks: int
    noise: float

    def placed(self, box: Box) -> Box:
        """Return the position of a box of the layout on this picture, mm."""
        dx, dy = self.shifts.at(box.x + box.width / 2, box.y + box.height / 2)
        return replace(box, x=box.x + dx, y=box.y + dy)

    def cut(self, box: Box, inset: float = 0.0, *, of: np.ndarray | None = None) -> np.ndarray:
        """Return the picture of a box of the layout, ``inset`` mm within its outline, from ``ink`` by
        default."""
        source = self.ink if of is None else of
        at = self.placed(box)
        top, bottom = (_pixel(v, source.shape[0]) for v in (at.y + inset, at.y + at.height - inset))
        left, right = (_pixel(v, source.shape[1]) for v in (at.x + inset, at.x + at.width - inset))
        return source[top:bottom, left:right]


def _pixel(mm: float, most: int) -> int:
    return int(np.clip(round(mm * SCALE), 0, most))


def straightened(grey: np.ndarray, code: PageCode, page: AnswerPage) -> Straight:
    """Return the flattened page.

    Raises
    ------
    NotStraight
        Fewer than three marks are found, or they contradict the code, or the boxes are not where three say.
    """
    matrix, marks = _homography(grey, code, page)
    paper = _flat(grey, matrix, page)
    ink, noise = _evenly_lit(paper)
    shifts = outline_shifts(ink, page, SCALE)
    if shifts.most > _BENT:
        paper = shifts.bent(paper, page.marks, SCALE)
        ink, noise = _evenly_lit(paper)
        shifts = outline_shifts(ink, page, SCALE)
    if marks < 4 and shifts.seen < 0.5:
        raise NotStraight("marks")
    return Straight(paper, ink, shifts, marks, noise)


def _homography(grey: np.ndarray, code: PageCode, page: AnswerPage) -> tuple[np.ndarray, int]:
    """From pixels of the picture to millimetres of the page, and how many marks it stands on."""
    cv2 = opencv()
    printed = _corners(page.code)
    across = _similarity(code.corners, printed)
    spots = _dark_squares(grey, across[2])
    candidates = _candidates(spots, across[:2], page)
    best = _four_marks(cv2, candidates, code, page)
    if best is not None:
        return best, 4
    best = _three_marks(cv2, candidates, code, page)
    if best is None:
        raise NotStraight("marks")
    return best, 3


def _corners(box: Box) -> np.ndarray:
    x, y, w, h = box.x, box.y, box.width, box.height
    return np.array([(x, y), (x + w, y), (x + w, y + h), (x, y + h)])


def _similarity(pixels: np.ndarray, mm: np.ndarray) -> tuple[complex, complex, float]:
    """Return the rotation and scale ``a``, the displacement ``b`` of ``mm = a pixel + b`` as complex numbers,
    and pixels per mm."""
    p, q = pixels @ (1, 1j), mm @ (1, 1j)
    centred = p - p.mean()
    a = np.vdot(centred, q - q.mean()) / np.vdot(centred, centred).real
    return a, q.mean() - a * p.mean(), float(1 / abs(a))


def _dark_squares(grey: np.ndarray, per_mm: float) -> np.ndarray:
    """Centres, in pixels, of solid dark squares about as large as a mark; shape ``(n, 2)``."""
    cv2 = opencv()
    scale = min(1.0, _WORK / per_mm)
    small = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), 1.0)
    side = MARK * per_mm * scale
    kernel = int(side * 1.8) | 1
    around = cv2.morphologyEx(small, cv2.MORPH_CLOSE, np.ones((kernel, kernel), np.uint8))
    dark = (small < 0.62 * around.astype(np.float32)).astype(np.uint8)
    squares = []
    for outline in cv2.findContours(dark, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]:
        centre = _centre_of_square(cv2, outline, side, dark.shape)
        if centre is not None:
            squares.append((np.array(centre) + 0.5) / scale - 0.5)
    return np.array(squares).reshape(-1, 2)


def _centre_of_square(
    cv2: Any, outline: np.ndarray, side: float, shape: tuple[int, ...]
) -> tuple[float, float] | None:
    """Return the centre of an outline that is a solid square in perspective and inside the picture; None for
    any other."""
    x, y, w, h = cv2.boundingRect(outline)
    if x == 0 or y == 0 or x + w == shape[1] or y + h == shape[0]:
        return None
    (_, (a, b), _) = cv2.minAreaRect(outline)
    a, b = a + 1, b + 1  # an outline runs through the middles of its pixels
    area = cv2.contourArea(outline) + len(outline) / 2
    if (
        not 0.45 * side < min(a, b) <= max(a, b) < 1.8 * side
        or area < 0.8 * a * b
        or max(a, b) > 1.6 * min(a, b)
    ):
        return None
    m = cv2.moments(outline)
    return m["m10"] / m["m00"], m["m01"] / m["m00"]


def _candidates(spots: np.ndarray, across: tuple[complex, complex], page: AnswerPage) -> list[np.ndarray]:
    """For each mark the spots near where the code places it, the nearest first."""
    a, b = across
    mm = a * (spots @ (1, 1j)) + b
    candidates = []
    for x, y in page.marks:
        off = np.abs(mm - (x + 1j * y))
        order = np.argsort(off, kind="stable")[:_NEAREST]
        candidates.append(spots[order[off[order] < _REACH]])
    return candidates


def _four_marks(
    cv2: Any, candidates: list[np.ndarray], code: PageCode, page: AnswerPage
) -> np.ndarray | None:
    """Return the perspective of the four candidates that places the code best; None if none places it
    well."""
    best, least = None, _CODE_OFF
    for four in product(*candidates):
        spots = np.array(four, np.float32)
        if not _turns_right(spots):
            continue
        matrix = cv2.getPerspectiveTransform(spots, np.array(page.marks, np.float32))
        off = _code_off(matrix, code, page)
        if off < least:
            best, least = matrix, off
    return best


def _turns_right(spots: np.ndarray) -> bool:
    """Return True if the points run in their printed direction and form a convex polygon."""
    along = np.roll(spots, -1, axis=0) - spots
    after = np.roll(along, -1, axis=0)
    return bool((along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0] > 0).all())


def _code_off(matrix: np.ndarray, code: PageCode, page: AnswerPage) -> float:
    """Return the greatest distance, mm, between the corners of the code under a perspective and their printed
    places."""
    return float(np.abs(_mapped(matrix, code.corners) - _corners(page.code)).max())


def _mapped(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    with np.errstate(all="ignore"):
        h = np.column_stack([points, np.ones(len(points))]) @ matrix.T
        return np.nan_to_num(h[:, :2] / h[:, 2:], nan=1e9, posinf=1e9, neginf=-1e9)


def _three_marks(
    cv2: Any, candidates: list[np.ndarray], code: PageCode, page: AnswerPage
) -> np.ndarray | None:
    """Return the perspective of three marks and the corners of the code with the least error; None if it is
    large."""
    best, least = None, _CODE_OFF_OF_THREE
    for missing in range(4):
        indices = [k for k in range(4) if k != missing]
        for three in product(*(candidates[k] for k in indices)):
            spots = np.vstack([np.array(three), code.corners])
            mm = np.vstack([np.array(page.marks)[indices], _corners(page.code)])
            matrix, _ = cv2.findHomography(spots, mm, 0)
            if matrix is None:
                continue
            off = float(np.abs(_mapped(matrix, spots) - mm).max())
            if off < least:
                best, least = matrix, off
    return best


def _flat(grey: np.ndarray, matrix: np.ndarray, page: AnswerPage) -> np.ndarray:
    """Return the picture under a perspective, 10 pixels per mm, padded with white."""
    cv2 = opencv()
    centre = np.linalg.inv(matrix) @ (page.width / 2, page.height / 2, 1)
    per_mm = _pixels_a_mm(matrix, centre[:2] / centre[2])
    shrunk = min(1.0, 1.1 * SCALE / per_mm)
    if shrunk < 1:
        grey = cv2.resize(grey, None, fx=shrunk, fy=shrunk, interpolation=cv2.INTER_AREA)
    # centres of pixels lie half a pixel in, in the picture and on the page
    to_full = np.array([[1 / shrunk, 0, 0.5 / shrunk - 0.5], [0, 1 / shrunk, 0.5 / shrunk - 0.5], [0, 0, 1]])
    to_pixels = np.array([[SCALE, 0, -0.5], [0, SCALE, -0.5], [0, 0, 1]])
    size = (round(page.width * SCALE), round(page.height * SCALE))
    return np.asarray(
        cv2.warpPerspective(grey, to_pixels @ matrix @ to_full, size, flags=cv2.INTER_LINEAR, borderValue=255)
    )


def _pixels_a_mm(matrix: np.ndarray, at: np.ndarray) -> float:
    here, right, below = _mapped(matrix, at + np.array([(0, 0), (1, 0), (0, 1)]))
    (a, b), (c, d) = right - here, below - here
    return float(1 / np.sqrt(max(abs(a * d - b * c), 1e-9)))


def _evenly_lit(paper: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the page relative to the brightness of the surrounding paper, 255 for bare paper, and the spread
    of bare paper."""
    cv2 = opencv()
    height, width = paper.shape
    small = cv2.resize(paper, (width // 5, height // 5), interpolation=cv2.INTER_AREA)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (25, 25))  # 12.5 mm: wider than a filled box
    around = cv2.morphologyEx(cv2.medianBlur(small, 3), cv2.MORPH_CLOSE, kernel)
    around = cv2.resize(cv2.blur(around, (5, 5)), (width, height), interpolation=cv2.INTER_LINEAR)
    soft = cv2.GaussianBlur(paper, (0, 0), 1.0)
    ink = cv2.divide(soft, np.maximum(around, 24), scale=255)
    bare = ink[::3, ::3][ink[::3, ::3] > 200].astype(np.float32)
    if not bare.size:
        return ink, 255.0
    middle = float(np.median(bare))
    noise = float(np.percentile(np.abs(bare - middle), 80)) / 1.28  # of a normal spread, one deviation
    return cv2.convertScaleAbs(ink, alpha=255 / middle), noise
