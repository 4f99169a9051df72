"""Boxes with handwriting in them, as a scanner gives them: what the reader of digits is trained and measured
on.

Everything is drawn at 10 px/mm on a canvas that shows a box of 7 mm by 9 mm and what is around it; the last
step cuts the box out, not quite where it is, and spoils it as printers, pens, scanners and telephones do.
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from skimage.morphology import skeletonize

BLANK, MINUS, OTHER = 10, 11, 12

#: The box on the canvas, pixels: 70 by 90, with 20 around it.
AROUND, BOX_WIDTH, BOX_HEIGHT = 20, 70, 90
SHAPE = (BOX_HEIGHT + 2 * AROUND, BOX_WIDTH + 2 * AROUND)
CENTRE = np.array([SHAPE[1] / 2, SHAPE[0] / 2])
DOWN, RIGHT = np.indices(SHAPE, np.float32)

#: How digits are written that MNIST's writers, North Americans, write otherwise: strokes on a square of side
#: 1, y down. Those of the first table train; those of the second, drawn apart from them, only test.
STROKES = {
    1: (
        (((0.15, 0.55), (0.6, 0.02), (0.6, 1.0)),),
        (((0.05, 0.75), (0.65, 0.0), (0.62, 1.0)),),
        (((0.3, 0.3), (0.6, 0.0), (0.6, 1.0)), ((0.35, 1.0), (0.85, 1.0))),
        (((0.2, 0.4), (0.55, 0.02), (0.5, 1.0)),),
    ),
    7: (
        (((0.1, 0.03), (0.9, 0.03), (0.35, 1.0)), ((0.3, 0.5), (0.8, 0.48))),
        (((0.1, 0.2), (0.12, 0.02), (0.85, 0.05), (0.4, 1.0)), ((0.35, 0.55), (0.85, 0.5))),
        (((0.05, 0.08), (0.4, 0.0), (0.9, 0.06), (0.55, 0.5), (0.4, 1.0)), ((0.25, 0.52), (0.85, 0.55))),
        (((0.1, 0.05), (0.9, 0.02), (0.45, 1.0)),),
    ),
    9: (
        (
            (
                (0.85, 0.15),
                (0.5, 0.0),
                (0.15, 0.22),
                (0.45, 0.45),
                (0.85, 0.2),
                (0.85, 0.8),
                (0.5, 1.0),
                (0.15, 0.88),
            ),
        ),
        (((0.8, 0.1), (0.3, 0.05), (0.2, 0.35), (0.6, 0.42), (0.82, 0.12), (0.78, 0.65), (0.35, 1.0)),),
    ),
    4: (
        (((0.35, 0.0), (0.1, 0.6), (0.9, 0.6)), ((0.65, 0.3), (0.65, 1.0))),
        (((0.15, 0.02), (0.15, 0.5), (0.85, 0.5)), ((0.75, 0.0), (0.75, 1.0))),
        (((0.6, 0.0), (0.05, 0.7), (0.95, 0.7)), ((0.62, 0.4), (0.6, 1.0))),
    ),
    0: (
        (
            (
                (0.5, 0.0),
                (0.12, 0.3),
                (0.15, 0.8),
                (0.5, 1.0),
                (0.88, 0.75),
                (0.85, 0.25),
                (0.5, 0.0),
                (0.35, 0.06),
            ),
        ),
    ),
    6: ((((0.7, 0.0), (0.25, 0.4), (0.15, 0.8), (0.5, 1.0), (0.85, 0.78), (0.5, 0.55), (0.18, 0.75)),),),
    5: (
        (
            ((0.25, 0.02), (0.2, 0.45), (0.6, 0.4), (0.85, 0.7), (0.5, 1.0), (0.1, 0.9)),
            ((0.25, 0.02), (0.85, 0.0)),
        ),
    ),
    3: ((((0.15, 0.05), (0.8, 0.02), (0.4, 0.4), (0.85, 0.7), (0.5, 1.0), (0.1, 0.88)),),),
}
STROKES_APART = {
    1: (
        (((0.0, 0.62), (0.3, 0.35), (0.58, 0.0), (0.55, 0.5), (0.56, 1.0)),),
        (((0.22, 0.33), (0.5, 0.0), (0.5, 1.0)), ((0.25, 0.98), (0.78, 1.0))),
        (((0.1, 0.48), (0.7, 0.03), (0.55, 1.0)),),
    ),
    7: (
        (((0.05, 0.12), (0.5, 0.06), (0.88, 0.0), (0.6, 0.45), (0.5, 1.0)), ((0.22, 0.45), (0.9, 0.42))),
        (((0.15, 0.0), (0.95, 0.0), (0.3, 1.0)), ((0.4, 0.58), (0.75, 0.6))),
    ),
    9: (
        (
            (0.9, 0.08),
            (0.4, 0.0),
            (0.1, 0.28),
            (0.5, 0.5),
            (0.88, 0.1),
            (0.92, 0.7),
            (0.55, 1.0),
            (0.2, 0.95),
        ),
    ),
    4: (
        (((0.45, 0.0), (0.08, 0.55), (0.85, 0.62)), ((0.7, 0.2), (0.6, 1.0))),
        (((0.2, 0.05), (0.1, 0.55), (0.95, 0.52)), ((0.8, 0.08), (0.72, 1.0))),
    ),
}
STROKES_APART[9] = (STROKES_APART[9],)  # type: ignore[assignment]

#: Letters and signs that nobody takes for a digit.
LETTERS = "ACEFHKMNPRUVWXacdefhkmnpuvwx?%&#=+*@"
HERSHEY = (
    cv2.FONT_HERSHEY_SIMPLEX,
    cv2.FONT_HERSHEY_DUPLEX,
    cv2.FONT_HERSHEY_SCRIPT_SIMPLEX,
    cv2.FONT_HERSHEY_COMPLEX_SMALL,
)


class Pen:
    """Draws inks (coverage 0 to 1, float32, of the canvas) with one random generator."""

    def __init__(
        self, rng: np.random.Generator, glyphs: np.ndarray, labels: np.ndarray, strokes: dict = STROKES
    ):
        self.rng, self.glyphs, self.labels, self.strokes = rng, glyphs, labels, strokes
        self.letter: Callable[[], np.ndarray] = self.hershey

    def width(self) -> float:
        """Of a line, pixels: ball pens mostly, felt pens at times."""
        return float(np.clip(self.rng.lognormal(1.6, 0.3), 2.5, 10))

    # -------------------------------------------------------------- digits

    def digit(self, wanted: int | None = None, height: float | None = None) -> tuple[np.ndarray, int]:
        """A digit at its usual size, in the middle of the canvas, and which it is."""
        if wanted is None and self.rng.random() < 0.13:
            wanted = int(self.rng.choice(list(self.strokes), p=self._shares()))
            return self.stroked(self.strokes[wanted], height), wanted
        index = self._index(wanted)
        return self.glyph(self.glyphs[index], height), int(self.labels[index])

    def _shares(self) -> np.ndarray:
        weights = np.array([{1: 5, 7: 5, 9: 3, 4: 2}.get(digit, 1) for digit in self.strokes], float)
        return weights / weights.sum()

    def _index(self, wanted: int | None) -> int:
        if wanted is None:
            return int(self.rng.integers(len(self.labels)))
        return int(self.rng.choice(np.flatnonzero(self.labels == wanted)))

    def height(self) -> float:
        return float(np.clip(self.rng.normal(62, 10), 36, 86))

    def glyph(self, glyph: np.ndarray, height: float | None = None) -> np.ndarray:
        """A grey picture of a digit, light on dark, written with another pen."""
        rows, columns = np.flatnonzero(glyph.max(1) > 40), np.flatnonzero(glyph.max(0) > 40)
        cut = glyph[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].astype(np.float32) / 255
        tall = (height or self.height()) / cut.shape[0]
        wide = min(tall * np.exp(self.rng.normal(0, 0.14)), 64 / cut.shape[1])
        middle = np.array([(cut.shape[1] - 1) / 2, (cut.shape[0] - 1) / 2])
        field = self._warped(cut, middle, np.array([wide, tall]))
        ink = 1 / (1 + np.exp(-(field - self.rng.uniform(0.3, 0.6)) / 0.08))
        return self._redrawn(ink) if self.rng.random() < 0.6 else ink

    def _redrawn(self, ink: np.ndarray) -> np.ndarray:
        """The same line with a pen of another width."""
        line = skeletonize(ink > 0.5).astype(np.uint8)
        return self._thick(line, self.width())

    def _thick(self, line: np.ndarray, width: float) -> np.ndarray:
        distance = cv2.distanceTransform(1 - line, cv2.DIST_L2, 5)
        return np.clip(width / 2 + 0.5 - distance, 0, 1).astype(np.float32)

    def _warped(self, picture: np.ndarray, middle: np.ndarray, scale: np.ndarray) -> np.ndarray:
        """A small picture on the canvas: scaled, slanted, turned, and bent a little."""
        turn, slant = self.rng.normal(0, 0.08), self.rng.normal(0, 0.12)
        turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        forward = turned @ np.array([[1, slant], [0, 1]]) @ np.diag(scale)
        back = np.linalg.inv(forward)
        bend = self._bend(self.rng.uniform(0, 3.5))
        x, y = RIGHT + bend[..., 0] - float(CENTRE[0]), DOWN + bend[..., 1] - float(CENTRE[1])
        (a, b), (c, d) = back.tolist()
        source = (a * x + b * y + float(middle[0]), c * x + d * y + float(middle[1]))
        return cv2.remap(picture, *source, cv2.INTER_CUBIC, borderValue=0)

    def _bend(self, strength: float) -> np.ndarray:
        coarse = self.rng.normal(0, strength, (5, 4, 2)).astype(np.float32)
        return cv2.resize(coarse, SHAPE[::-1], interpolation=cv2.INTER_CUBIC)

    def stroked(self, variants: tuple, height: float | None = None) -> np.ndarray:
        """One of the variants of a digit, its points shaken."""
        strokes = variants[self.rng.integers(len(variants))]
        size = np.array([self.rng.uniform(0.45, 0.75), 1.0]) * (height or self.height())
        shaken = [np.array(stroke) - 0.5 + self.rng.normal(0, 0.035, (len(stroke), 2)) for stroke in strokes]
        return self.lines([points * size for points in shaken], bent=True)

    def lines(
        self, strokes: list[np.ndarray], *, bent: bool = False, width: float | None = None
    ) -> np.ndarray:
        """Lines through points about the middle of the canvas, rounded at their corners more or less."""
        slant = np.array([[1, self.rng.normal(0, 0.1)], [0, 1]]) if bent else np.eye(2)
        canvas = np.zeros(SHAPE, np.uint8)
        for points in strokes:
            smooth = self._rounded(points @ slant.T) + CENTRE
            cv2.polylines(canvas, [np.round(smooth * 16).astype(np.int32)], False, 1, 1, cv2.LINE_8, 4)
        if bent:
            canvas = self._shaken(canvas)
        return self._thick(canvas, width or self.width())

    def _shaken(self, canvas: np.ndarray) -> np.ndarray:
        bend = self._bend(self.rng.uniform(0, 2))
        grown = cv2.dilate(canvas, np.ones((3, 3), np.uint8))
        return cv2.remap(grown, RIGHT + bend[..., 0], DOWN + bend[..., 1], cv2.INTER_NEAREST)

    def _rounded(self, points: np.ndarray) -> np.ndarray:
        for _ in range(int(self.rng.integers(0, 4)) if len(points) < 4 else 3):
            before, after = points[:-1], points[1:]
            between = np.stack([0.8 * before + 0.2 * after, 0.2 * before + 0.8 * after], 1).reshape(-1, 2)
            points = np.vstack([points[:1], between, points[-1:]])
        return points

    # -------------------------------------------------------------- what is no digit

    def hershey(self) -> np.ndarray:
        letter = str(self.rng.choice(list(LETTERS)))
        small = np.zeros((60, 60), np.uint8)
        font = int(HERSHEY[self.rng.integers(len(HERSHEY))])
        cv2.putText(small, letter, (12, 44), font, 1.3, 255, int(self.rng.integers(1, 4)), cv2.LINE_AA)
        return self.glyph(small)

    def scribble(self) -> np.ndarray:
        points = self.rng.normal(0, 1, (self.rng.integers(7, 25), 2)) * self.rng.uniform(8, 22, 2)
        return self.lines([points], bent=True)

    def struck(self) -> np.ndarray:
        """A digit struck out: by lines across it, or by a zigzag."""
        ink, _ = self.digit()
        if self.rng.random() < 0.4:
            xs = np.linspace(-26, 26, self.rng.integers(6, 12))
            zigzag = np.stack([xs, self.rng.uniform(12, 32) * (-1.0) ** np.arange(len(xs))], 1)
            return np.maximum(ink, self.lines([zigzag], bent=True))
        count = int(self.rng.integers(2, 5))
        angle = self.rng.choice([0, -0.7, 0.7, -1.0, 1.0])
        offsets = self.rng.uniform(5, 9) * (np.arange(count) - (count - 1) / 2)
        return np.maximum(ink, self.lines([self._across(angle, offset) for offset in offsets], bent=True))

    def _across(self, angle: float, offset: float) -> np.ndarray:
        angle = angle + self.rng.normal(0, 0.12)
        along, aside = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        return np.array([-along, along]) * self.rng.uniform(28, 48) + aside * (offset + self.rng.normal(0, 2))

    def crossed_out(self) -> np.ndarray:
        """A digit under a cross."""
        ink, _ = self.digit()
        lines = [self._across(angle, self.rng.normal(0, 2)) for angle in (0.8, -0.8)]
        return np.maximum(ink, self.lines(lines, bent=True))

    def two(self) -> np.ndarray:
        """Two digits beside each other."""
        apart = self.rng.uniform(14, 20)
        left, right = (self._narrow(self.digit(height=self.rng.uniform(32, 60))[0]) for _ in range(2))
        return np.maximum(_moved(left, -apart, 0), _moved(right, apart, 0))

    def _narrow(self, ink: np.ndarray) -> np.ndarray:
        by = self.rng.uniform(0.5, 0.7)
        return cv2.warpAffine(ink, np.array([[by, 0, CENTRE[0] * (1 - by)], [0, 1, 0]]), SHAPE[::-1])

    def overwritten(self) -> np.ndarray:
        """A digit written over another one."""
        first, second = self.digit()[0], _moved(self.digit()[0], *self.rng.normal(0, 4, 2))
        both = np.maximum(first, second)
        clear = both.sum() > 1.4 * max(float(first.sum()), float(second.sum()))
        return both if clear else self.scribble()

    def half(self) -> np.ndarray:
        """A digit of which the box shows about a half."""
        ink, label = self.digit(height=self.rng.uniform(50, 85))
        if label == 1:  # half of it is another
            return self.scribble()
        angle = self.rng.uniform(0, 2 * np.pi)
        for far in np.arange(10.0, 80.0, 4):
            moved = _moved(ink, far * np.cos(angle), far * np.sin(angle) * 1.3)
            if 0.2 < inside(moved) / max(inside(ink), 1) < 0.6:
                return moved
        return self.scribble()

    def blot(self) -> np.ndarray:
        ink = np.zeros(SHAPE, np.float32)
        for _ in range(self.rng.integers(1, 4)):
            at = CENTRE + self.rng.normal(0, 8, 2)
            axes = self.rng.uniform(6, 24, 2)
            cv2.ellipse(ink, (tuple(at), tuple(axes * 2), float(self.rng.uniform(0, 180))), 1.0, -1)
        return cv2.GaussianBlur(ink, (0, 0), 1 + self.rng.exponential(1))

    def filled(self) -> np.ndarray:
        rows = np.arange(-40, 41, self.rng.uniform(3, 9))
        zigzag = np.stack([34 * (-1.0) ** np.arange(len(rows)), rows], 1)
        return self.lines([zigzag + self.rng.normal(0, 2, zigzag.shape)], bent=True)

    def dash(self) -> np.ndarray:
        """A minus sign."""
        long, angle = self.rng.uniform(10, 36), np.clip(self.rng.normal(0, 0.15), -0.35, 0.35)
        along = np.array([np.cos(angle), np.sin(angle)]) * long
        return _moved(self.lines([np.array([-along, along])], bent=True), *self.rng.normal(0, 8, 2))

    def cross(self) -> np.ndarray:
        """A cross, a tick or a plus."""
        size = self.rng.uniform(12, 34)
        crosses = (
            ([(-1, -1), (1, 1)], [(1, -1), (-1, 1)]),
            ([(-1, 0), (-0.3, 0.9), (1, -1)],),
            ([(-1, 0), (1, 0)], [(0, -1), (0, 1)]),
        )
        shape = crosses[self.rng.integers(3)]
        return self.lines(
            [np.array(line) * size + self.rng.normal(0, 2, (len(line), 2)) for line in shape], bent=True
        )

    def mark(self) -> np.ndarray:
        """A dot, a comma, a short stroke that is no digit."""
        points = self.rng.normal(0, 4, (3, 2))
        return _moved(self.lines([points], bent=True), *self.rng.normal(0, 14, 2))

    def other(self) -> np.ndarray:
        kinds = {
            self.letter: 5,
            self.scribble: 2,
            self.struck: 4,
            self.crossed_out: 1,
            self.two: 3,
            self.overwritten: 2,
            self.half: 2,
            self.blot: 1,
            self.filled: 1,
            self.cross: 1,
            self.mark: 1,
        }
        weights = np.array(list(kinds.values()), float)
        return list(kinds)[self.rng.choice(len(kinds), p=weights / weights.sum())]()


# ------------------------------------------------------------------- the box and the scanner


class Scanner:
    """A box with its outline, what neighbours leave in it, and what paper and scanner do; one random
    generator."""

    def __init__(self, pen: Pen):
        self.pen, self.rng = pen, pen.rng

    def labelled(self) -> tuple[np.ndarray, int]:
        """A cell as it is cut from a page, (90, 70) uint8, and its class."""
        kind = self.rng.random()
        if kind < 0.70:
            return self.digit()
        if kind < 0.80:
            return self.cell(self.nothing()), BLANK
        if kind < 0.84:
            return self.cell(self.pen.dash()), MINUS
        return self.negative()

    def negative(self) -> tuple[np.ndarray, int]:
        return self.cell(_moved(self.pen.other(), *self.rng.normal(0, 3, 2))), OTHER

    def digit(self, ink: np.ndarray | None = None, label: int = -1) -> tuple[np.ndarray, int]:
        """A digit, nearly whole inside its box."""
        if ink is None:
            ink, label = self.pen.digit()
        for _ in range(20):
            moved = _moved(ink, *self.rng.normal(0, (5, 6)))
            if inside(moved) > 0.93 * ink.sum():
                return self.cell(moved), label
        return self.cell(ink), label

    def nothing(self) -> np.ndarray:
        """No ink, or specks, or a faint print of the other side."""
        ink = np.zeros(SHAPE, np.float32)
        for _ in range(self.rng.poisson(0.7)):
            at = self.rng.uniform(0, 1, 2) * SHAPE[::-1]
            cv2.circle(
                ink,
                (int(at[0]), int(at[1])),
                int(self.rng.integers(0, 2)),
                float(self.rng.uniform(0.3, 1)),
                -1,
            )
        if self.rng.random() < 0.15:
            ink = np.maximum(ink, 0.15 * self.pen.digit()[0])
        return ink

    def cell(self, ink: np.ndarray) -> np.ndarray:
        ink = ink * self._pressure()
        if self.rng.random() < 0.18:
            ink = np.maximum(ink, self._neighbour() * self.rng.uniform(0.4, 0.95))
        dark = np.maximum(ink, self._outline())
        return self._scanned(self._cut(self._paper() * (1 - dark)))

    def _pressure(self) -> np.ndarray | float:
        """How dark the ink is: even, or as pencil leaves it."""
        dark = self.rng.uniform(0.4, 0.97)
        if self.rng.random() < 0.3:
            grain = 0.15 * self.rng.standard_normal(SHAPE, np.float32)
            return np.clip(np.float32(dark) * (1 + cv2.GaussianBlur(grain, (0, 0), 0.8)), 0, 1)
        return dark

    def _neighbour(self) -> np.ndarray:
        """A digit of the box beside, above or below, that reaches into this one."""
        ink = self.pen.digit(height=self.rng.uniform(60, 85))[0]
        side = self.rng.choice([-1, 1])
        if self.rng.random() < 0.7:
            moved = _moved(ink, side * self.rng.uniform(48, 75), self.rng.normal(0, 6))
        else:
            moved = _moved(ink, self.rng.normal(0, 6), side * self.rng.uniform(68, 95))
        return moved if inside(moved) < 0.15 * max(float(ink.sum()), 1) else np.zeros_like(ink)

    def _outline(self) -> np.ndarray:
        dark = self.rng.uniform(0, 0.4) if self.rng.random() < 0.85 else self.rng.uniform(0.4, 1)
        lines = np.zeros(SHAPE, np.float32)
        width = float(self.rng.uniform(0.8, 3))
        gap = BOX_WIDTH + self.rng.choice([0, 5, 10, 20])
        for shift in (-gap, 0, gap):
            _rectangle(lines, AROUND + shift, AROUND, width)
        if self.rng.random() < 0.15:
            lines = lines * (self.rng.random(SHAPE) < self.rng.uniform(0.2, 0.9))
        return dark * lines

    def _paper(self) -> np.ndarray:
        light = self.rng.uniform(0.55, 1)
        paper = self._plane(1, 0.05) * np.float32(light)
        if self.rng.random() < 0.04:  # the edge of a shadow
            shaded = (self._plane(self.rng.normal(0, 1), 3) > 0).astype(np.float32)
            paper = paper * (1 - np.float32(0.35) * cv2.GaussianBlur(shaded, (0, 0), 2))
        return paper

    def _plane(self, middle: float, slope: float) -> np.ndarray:
        """Values that grow evenly in some direction, by about ``slope`` from the middle to a border."""
        x, y = (self.rng.normal(0, slope, 2) / CENTRE).tolist()
        return float(middle) + x * (RIGHT - float(CENTRE[0])) + y * (DOWN - float(CENTRE[1]))

    def _cut(self, canvas: np.ndarray) -> np.ndarray:
        """The box, cut a little beside, turned, and not quite to scale."""
        turn, (wide, tall) = self.rng.normal(0, 0.012), 1 + self.rng.normal(0, 0.012, 2)
        shift = np.clip(self.rng.normal(0, 2.2, 2), -7, 7)
        matrix = np.array([[wide * np.cos(turn), -np.sin(turn)], [np.sin(turn), tall * np.cos(turn)]])
        offset = np.array([BOX_WIDTH / 2, BOX_HEIGHT / 2]) + shift - matrix @ CENTRE
        affine = np.column_stack([matrix, offset])
        return cv2.warpAffine(canvas, affine, (BOX_WIDTH, BOX_HEIGHT), borderMode=cv2.BORDER_REPLICATE)

    def _scanned(self, light: np.ndarray) -> np.ndarray:
        """Blur, resolution, noise, JPEG, black and white."""
        light = cv2.GaussianBlur(light, (0, 0), self.rng.uniform(0.3, 1.5))
        if self.rng.random() < 0.5:
            by = self.rng.choice([0.59, 0.79, 1.18])  # 150, 200, 300 dpi
            small = cv2.resize(light, None, fx=by, fy=by, interpolation=cv2.INTER_AREA)
            light = cv2.resize(small, (BOX_WIDTH, BOX_HEIGHT), interpolation=cv2.INTER_LINEAR)
        noise = self.rng.standard_normal(light.shape, np.float32)
        grey = np.clip((light + float(self.rng.exponential(0.02)) * noise) * 255, 0, 255).astype(np.uint8)
        if self.rng.random() < 0.15:
            cut = self.rng.uniform(0.55, 0.85) * np.percentile(grey, 90)
            grey = np.where(grey > cut, 255, 0).astype(np.uint8)
        if self.rng.random() < 0.35:
            packed = cv2.imencode(".jpg", grey, [cv2.IMWRITE_JPEG_QUALITY, int(self.rng.integers(25, 90))])[1]
            grey = cv2.imdecode(packed, cv2.IMREAD_GRAYSCALE)
        return grey


def inside(ink: np.ndarray) -> float:
    """How much of the ink lies in the box."""
    return float(ink[AROUND : AROUND + BOX_HEIGHT, AROUND : AROUND + BOX_WIDTH].sum())


def _moved(ink: np.ndarray, x: float, y: float) -> np.ndarray:
    return cv2.warpAffine(ink, np.array([[1, 0, x], [0, 1, y]], np.float64), SHAPE[::-1])


def _rectangle(lines: np.ndarray, x: float, y: float, width: float) -> None:
    corner, opposite = (x, y), (x + BOX_WIDTH, y + BOX_HEIGHT)
    rounded = [tuple(round(v * 16) for v in point) for point in (corner, opposite)]
    cv2.rectangle(lines, *rounded, 1.0, max(1, round(width)), cv2.LINE_AA, 4)
