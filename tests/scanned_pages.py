"""Answer pages filled in by hand, printed and scanned, in simulation: what is written is known, all from a
seed.

A page is drawn (from its PDF, or plainly from its layout), answers are written into its fields with strokes
of pens and with digits of a bank of handwriting, and the sheet is scanned or photographed with the
disturbances of its kind.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import cv2
import numpy as np

from coursework.sheets.answer_pages import AnswerField, AnswerPage, Box

DOTS = 300 / 25.4  #: pixels a mm of a sheet before it is scanned

#: A digit and a random generator to its ink, (h, w), 0 to 1, cut to what is inked.
Bank = Callable[[int, np.random.Generator], np.ndarray]

#: Pens, by how light their ink is to a grey scan, of 255.
PENS = {"blue": 54, "black": 32, "red": 86, "pencil": 105, "green": 77}


# ------------------------------------------------------------------ the sheet


def sheet_of_pdf(data: bytes, number: int = 0) -> np.ndarray:
    """A page of a PDF as it is printed, grey; -1 is the last."""
    import pypdfium2

    document = pypdfium2.PdfDocument(data)
    try:
        picture = document[number % len(document)].render(scale=300 / 72, grayscale=True).to_numpy()
        return np.array(picture).reshape(picture.shape[:2])
    finally:
        document.close()


def plain_sheet(page: AnswerPage) -> np.ndarray:
    """A page drawn from its layout alone: marks, code, outlines of boxes, guide digits."""
    high, wide = round(page.height * DOTS), round(page.width * DOTS)
    sheet = np.full((high, wide), 255, np.uint8)
    for x, y in page.marks:
        _fill(sheet, Box(x - 3, y - 3, 6, 6), 0)
    _code(sheet, page)
    for digit, box in enumerate(page.guide):
        _outline(sheet, box)
        at = (round((box.x + 2) * DOTS), round((box.y + 7) * DOTS))
        cv2.putText(sheet, str(digit), at, cv2.FONT_HERSHEY_SIMPLEX, 2.0, 90, 3, cv2.LINE_AA)
    for one in page.fields:
        for box in boxes_of(one):
            _outline(sheet, box)
        for letter, (_, box) in zip("abcdefghijklm", one.ticks, strict=False):
            at = (round((box.x + box.width + 1) * DOTS), round((box.y + 4) * DOTS))
            cv2.putText(sheet, letter, at, cv2.FONT_HERSHEY_SIMPLEX, 1.2, 0, 3, cv2.LINE_AA)
    return sheet


def boxes_of(one: AnswerField) -> list[Box]:
    """All the boxes of a field that are printed."""
    boxes = [one.sign, *one.digits, *one.decimals, one.power_sign, *one.power, one.unit, one.free]
    boxes += [box for _, box in one.ticks] + ([one.whole] if one.what in ("written", "drawing") else [])
    return [box for box in boxes if box is not None]


def _fill(sheet: np.ndarray, box: Box, value: int) -> None:
    x0, y0, x1, y1 = (round(v * DOTS) for v in (box.x, box.y, box.x + box.width, box.y + box.height))
    sheet[y0:y1, x0:x1] = value


def _outline(sheet: np.ndarray, box: Box, grey: int = 185) -> None:
    x0, y0, x1, y1 = (round(v * DOTS) for v in (box.x, box.y, box.x + box.width, box.y + box.height))
    cv2.rectangle(sheet, (x0, y0), (x1, y1), grey, 2)


def _code(sheet: np.ndarray, page: AnswerPage) -> None:
    import zxingcpp

    code = zxingcpp.create_barcode(page.code_text, zxingcpp.BarcodeFormat.QRCode, ec_level="Q")
    modules = np.array(code.to_image(scale=1))
    inked = np.argwhere(modules < 128)
    (top, left), (bottom, right) = inked.min(axis=0), inked.max(axis=0) + 1
    x0, y0 = round(page.code.x * DOTS), round(page.code.y * DOTS)
    size = round(page.code.width * DOTS)
    symbol = cv2.resize(modules[top:bottom, left:right], (size, size), interpolation=cv2.INTER_NEAREST)
    sheet[y0 : y0 + size, x0 : x0 + size] = symbol


# -------------------------------------------------------------------- writing


@dataclass(frozen=True)
class Wrote:
    """What was written into a field, and what a reader that makes no mistake says of it: its ``text`` (ticks:
    the cases; numbers: as typed); or that it ``waits``."""

    text: str = ""
    cases: tuple[str, ...] = ()
    waits: bool = False
    how: str = "plain"


@dataclass
class Hand:
    """Somebody who writes: a pen, its width in mm, and a way of writing."""

    pen: str = "blue"
    width: float = 0.5
    size: float = 6.0  #: mm, height of digits
    jitter: float = 0.5  #: mm, about the middle of a box
    slant: float = 0.0
    bank: Bank | None = None
    answers: Callable[[AnswerField], str] | None = None  #: a number for a field; empty for any number
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(0))
    ink: np.ndarray = field(init=False)

    def begin(self, sheet: np.ndarray) -> None:
        self.ink = np.zeros(sheet.shape, np.float32)

    def finish(self, sheet: np.ndarray) -> np.ndarray:
        """The sheet with what was written."""
        alpha = 0.95 * self.ink
        if self.pen == "pencil":
            grain = cv2.GaussianBlur(self.rng.normal(0, 1, (600, 600)).astype(np.float32), (0, 0), 1.2)
            tiled = np.tile(grain, [-(-n // 600) for n in alpha.shape])[: alpha.shape[0], : alpha.shape[1]]
            alpha = self.ink * np.clip(0.85 + 0.25 * tiled, 0.35, 1)
        return (sheet - alpha * (sheet - np.float32(PENS[self.pen]))).astype(np.uint8)

    def stroke(self, points: Sequence[tuple[float, float]], width: float = 0.0) -> None:
        """A line of the pen through points, mm, as shaky as a hand is."""
        at = np.array(points, float) * DOTS
        dense = [at[0]]
        for a, b in pairwise(at):
            steps = max(2, int(np.hypot(*(b - a)) / 12))
            bend = self.rng.normal(0, 0.02 * np.hypot(*(b - a)) + 0.5, 2)
            t = np.linspace(0, 1, steps + 1)[1:, None]
            dense.extend(a + (b - a) * t + 4 * t * (1 - t) * bend)
        path = (np.array(dense) * 16).round().astype(np.int32).reshape(-1, 1, 2)
        thick = max(1, round((width or self.width) * DOTS * self.rng.uniform(0.85, 1.15)))
        x, y, w, h = _around(np.array(dense), thick + 3, self.ink.shape)
        piece = np.zeros((h, w), np.uint8)
        cv2.polylines(piece, [path - np.array([x * 16, y * 16])], False, 255, thick, cv2.LINE_AA, 4)
        self.ink[y : y + h, x : x + w] = np.maximum(self.ink[y : y + h, x : x + w], piece / 255.0)

    def digit(self, box: Box, digit: int) -> None:
        """A digit in about the middle of a box."""
        ink = (self.bank or font_digits())(digit, self.rng)
        high = self.size * self.rng.uniform(0.88, 1.12)
        wide = min(high * ink.shape[1] / ink.shape[0], 0.86 * box.width)
        size = (max(3, round(wide * DOTS)), round(high * DOTS))
        ink = cv2.resize(
            ink.astype(np.float32),
            size,
            interpolation=cv2.INTER_AREA if ink.shape[0] > size[1] else cv2.INTER_CUBIC,
        )
        ink = np.clip(ink, 0, 1)
        dx, dy = np.clip(self.rng.normal(0, self.jitter, 2), -1.6 * self.jitter, 1.6 * self.jitter)
        x = round((box.x + box.width / 2 + dx) * DOTS - size[0] / 2)
        y = round((box.y + box.height / 2 + dy) * DOTS - size[1] / 2)
        view = self.ink[y : y + size[1], x : x + size[0]]
        np.maximum(view, ink[: view.shape[0], : view.shape[1]], out=view)

    def cross(self, box: Box) -> None:
        """A cross or a tick in a box, now and then a little beyond it."""
        out = self.rng.uniform(-0.25, 0.12) * box.width
        x0, y0, x1, y1 = box.x - out, box.y - out, box.x + box.width + out, box.y + box.height + out
        if self.rng.random() < 0.15:
            self.stroke([(x0, (y0 + y1) / 2), ((x0 + x1) / 2, y1), (x1, y0)])
            return
        wobble = self.rng.normal(0, 0.25, 8)
        self.stroke([(x0 + wobble[0], y0 + wobble[1]), (x1 + wobble[2], y1 + wobble[3])])
        self.stroke([(x1 + wobble[4], y0 + wobble[5]), (x0 + wobble[6], y1 + wobble[7])])

    def fill(self, box: Box) -> None:
        """A box filled wholly."""
        step = 0.75 * self.width
        rows = np.arange(box.y + 0.2, box.y + box.height - 0.1, step)
        points = []
        for k, y in enumerate(rows):
            ends = (box.x + self.rng.uniform(0, 0.3), box.x + box.width - self.rng.uniform(0, 0.3))
            points += [(e, y) for e in (ends if k % 2 == 0 else ends[::-1])]
        for a, b in pairwise(points):
            self.stroke([a, b])

    def minus(self, box: Box) -> None:
        y = box.y + box.height / 2 + self.rng.normal(0, 0.4)
        half = self.rng.uniform(1.4, 2.4)
        middle = box.x + box.width / 2 + self.rng.normal(0, 0.4)
        self.stroke([(middle - half, y + self.rng.normal(0, 0.2)), (middle + half, y)])

    def strike(self, boxes: Sequence[Box]) -> None:
        """A stroke through boxes in a row."""
        first, last = boxes[0], boxes[-1]
        y = first.y + first.height / 2
        self.stroke(
            [(first.x - 1, y + self.rng.normal(0, 1)), (last.x + last.width + 1, y + self.rng.normal(0, 1))]
        )

    def scribble(self, box: Box, letters: int = 6) -> None:
        """Some words."""
        x, y = box.x + 1.5, box.y + min(box.height / 2, 5) + 1
        points = []
        for _ in range(letters * 3):
            points.append((x, y + self.rng.uniform(-2, 1.5)))
            x += self.rng.uniform(0.4, 1.2)
            if x > box.x + box.width - 1.5:
                break
        self.stroke(points or [(x, y), (x + 1, y)])


def _around(points: np.ndarray, rim: int, shape: Sequence[int]) -> tuple[int, int, int, int]:
    low = np.maximum(np.floor(points.min(axis=0)).astype(int) - rim, 0)
    high = np.minimum(np.ceil(points.max(axis=0)).astype(int) + rim, (shape[1], shape[0]))
    return low[0], low[1], max(high[0] - low[0], 1), max(high[1] - low[1], 1)


_FONTS = (
    cv2.FONT_HERSHEY_SIMPLEX,
    cv2.FONT_HERSHEY_DUPLEX,
    cv2.FONT_HERSHEY_COMPLEX,
    cv2.FONT_HERSHEY_SCRIPT_SIMPLEX,
)


def font_digits() -> Bank:
    """Digits of several fonts, slanted, stretched and bent: no handwriting, but as many shapes."""

    def drawn(digit: int, rng: np.random.Generator) -> np.ndarray:
        canvas = np.zeros((160, 160), np.uint8)
        font = _FONTS[int(rng.integers(len(_FONTS)))]
        cv2.putText(canvas, str(digit), (45, 115), font, 3.2, 255, int(rng.integers(7, 12)), cv2.LINE_AA)
        slant, turn = rng.uniform(-0.25, 0.1), rng.uniform(-0.12, 0.12)
        turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ np.array(
            [[1, slant], [0, 1]]
        )
        middle = np.array([80, 80])
        bent = cv2.warpAffine(canvas, np.column_stack([turned, middle - turned @ middle]), (160, 160))
        rows, columns = np.flatnonzero(bent.any(axis=1)), np.flatnonzero(bent.any(axis=0))
        return bent[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] / 255.0

    return drawn


def plain_digits(digit: int, rng: np.random.Generator) -> np.ndarray:
    """Digits of one font, always alike."""
    canvas = np.zeros((160, 160), np.uint8)
    cv2.putText(canvas, str(digit), (45, 115), cv2.FONT_HERSHEY_SIMPLEX, 3.2, 255, 9, cv2.LINE_AA)
    rows, columns = np.flatnonzero(canvas.any(axis=1)), np.flatnonzero(canvas.any(axis=0))
    return canvas[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] / 255.0


def handwriting(images: np.ndarray, labels: np.ndarray) -> Bank:
    """Digits of people: pictures (n, h, w), white on black, of which one is drawn, slanted a little, and
    written sharp."""

    def drawn(digit: int, rng: np.random.Generator) -> np.ndarray:
        image = images[rng.choice(np.flatnonzero(labels == digit))].astype(np.float32)
        large = cv2.resize(image / image.max(), None, fx=4, fy=4, interpolation=cv2.INTER_CUBIC)
        slant = rng.uniform(-0.15, 0.15)
        high, wide = large.shape
        sheared = np.array([[1, slant, wide / 2 - slant * high / 2], [0, 1, 6]], np.float32)
        sharp = np.clip((cv2.warpAffine(large, sheared, (2 * wide, high + 12)) - 0.45) * 5 + 0.5, 0, 1)
        rows, columns = np.flatnonzero((sharp > 0.5).any(axis=1)), np.flatnonzero((sharp > 0.5).any(axis=0))
        return sharp[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]

    return drawn


def template_reader(
    bank: Bank | None = None, each: int = 60
) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Stands for the reader of handwriting beside a bank of digits: the nearest of many samples."""
    rng = np.random.default_rng(1)
    bank = bank or font_digits()
    labels = np.repeat(np.arange(10), each)
    samples = np.stack([_normal(bank(int(d), rng)) for d in labels])

    def read(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = [_nearest(cell, samples, labels) for cell in cells]
        return np.array([d for d, _ in found]), np.array([c for _, c in found])

    return read


def _nearest(cell: np.ndarray, samples: np.ndarray, labels: np.ndarray) -> tuple[int, float]:
    dark = np.clip((255.0 - cell[6:-6, 6:-6]) / 160, 0, 1)  # without the outline
    if (dark > 0.4).sum() < 30:
        return -1, 1.0
    rows, columns = np.flatnonzero((dark > 0.4).any(axis=1)), np.flatnonzero((dark > 0.4).any(axis=0))
    seen = _normal(dark[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1])
    likeness = samples @ seen
    best = np.array([likeness[labels == d].max() for d in range(10)])
    order = np.argsort(best)
    return int(order[-1]), 1.0 if best[order[-1]] > 0.75 and best[order[-1]] - best[order[-2]] > 0.02 else 0.5


def _normal(ink: np.ndarray) -> np.ndarray:
    high = 20
    wide = int(np.clip(round(ink.shape[1] * high / ink.shape[0]), 2, 20))
    small = cv2.resize(ink.astype(np.float32), (wide, high), interpolation=cv2.INTER_AREA)
    framed = np.zeros((high, 20), np.float32)
    left = (20 - wide) // 2
    framed[:, left : left + wide] = small
    soft = cv2.GaussianBlur(framed, (0, 0), 1.0).ravel()
    return soft / (np.linalg.norm(soft) + 1e-9)


# -------------------------------------------------------------------- answers


def written(hand: Hand, page: AnswerPage, *, odd: float = 0.15) -> tuple[Wrote, ...]:
    """Every field of a page answered somehow; ``odd`` is the share that a reader must leave to a person."""
    return tuple(_answered(hand, one, odd) for one in page.fields)


def _answered(hand: Hand, one: AnswerField, odd: float) -> Wrote:
    rng = hand.rng
    if one.what == "ticks":
        return _ticked(hand, one, odd)
    if one.what == "number":
        return _numbered(hand, one, odd)
    if rng.random() < 0.3:
        return Wrote(how="blank")
    if one.what == "drawing":
        corners = rng.uniform(0.1, 0.9, (4, 2))
        at = [(one.whole.x + u * one.whole.width, one.whole.y + v * one.whole.height) for u, v in corners]
        hand.stroke([*at, at[0]])
    else:
        hand.scribble(one.whole, 14)
    return Wrote(waits=True, how=one.what)


def _ticked(hand: Hand, one: AnswerField, odd: float) -> Wrote:
    rng = hand.rng
    cases, boxes = zip(*one.ticks, strict=True)
    draw = rng.random()
    if draw < 0.1:
        return Wrote(how="blank")
    if draw < 0.1 + odd / 2 and one.free is not None:
        hand.scribble(one.free, 3)
        return Wrote(waits=True, how="free")
    count = int(rng.integers(1, len(boxes) + 1)) if one.several else 1
    if not one.several and draw > 1 - odd / 2 and len(boxes) > 1:
        count = 2
    chosen = sorted(rng.choice(len(boxes), count, replace=False).tolist())
    for k in chosen:
        hand.cross(boxes[k])
    rest = [k for k in range(len(boxes)) if k not in chosen]
    if rest and rng.random() < 0.2:
        back = int(rng.choice(rest))
        hand.cross(boxes[back])
        hand.fill(boxes[back])
    said = tuple(cases[k] for k in chosen)
    if count == 2 and not one.several:
        return Wrote(cases=said, waits=True, how="two ticks")
    if one.several and one.none in said and count > 1:
        return Wrote(cases=said, waits=True, how="none and more")
    return Wrote(", ".join(said), cases=said)


def _numbered(hand: Hand, one: AnswerField, odd: float) -> Wrote:
    rng = hand.rng
    draw = rng.random()
    if draw < 0.08:
        return Wrote(how="blank")
    if draw < 0.08 + odd / 3 and one.free is not None:
        if rng.random() < 0.5:
            _digits(hand, one.digits[-2:], "17")
            hand.strike(one.digits)
        hand.scribble(one.free, 3)
        return Wrote(waits=True, how="free")
    whole = str(int(rng.integers(0, 10 ** int(rng.integers(1, len(one.digits) + 1)))))
    behind = "".join(str(d) for d in rng.integers(0, 10, int(rng.integers(0, len(one.decimals) + 1))))
    if draw < 0.08 + 2 * odd / 3:
        return _broken(hand, one, whole, behind)
    sign = "-" if rng.random() < 0.35 else ""
    if hand.answers and (text := hand.answers(one)):
        sign, (whole, _, behind) = "-" * text.startswith("-"), text.lstrip("-").partition(".")
        return _plainly(hand, one, sign, whole, behind, with_power=False)
    return _plainly(hand, one, sign, whole, behind)


def _plainly(
    hand: Hand, one: AnswerField, sign: str, whole: str, behind: str, *, with_power: bool = True
) -> Wrote:
    rng = hand.rng
    if sign and one.sign is not None:
        hand.minus(one.sign)
    at = 0 if rng.random() < 0.2 else len(one.digits) - len(whole)
    _digits(hand, one.digits[at:], whole)
    _digits(hand, one.decimals, behind)
    text = f"{sign}{whole}" + (f".{behind}" if behind else "")
    if with_power and one.power and rng.random() < 0.12:
        power, negative = str(int(rng.integers(1, 13))), rng.random() < 0.4
        if negative and one.power_sign is not None:
            hand.minus(one.power_sign)
        _digits(hand, one.power[len(one.power) - len(power) :], power)
        text += f"e{'-' if negative else ''}{power}"
    if one.unit is not None and rng.random() < 0.7:
        hand.cross(one.unit)
        text += f" {one.unit_text}"
    return Wrote(text)


def _broken(hand: Hand, one: AnswerField, whole: str, behind: str) -> Wrote:
    """A row that breaks a rule."""
    ways = [w for w in ("struck", "gap", "two signs", "comma", "scratched") if w != "comma" or one.decimals]
    how = str(hand.rng.choice(ways))
    if how == "struck":
        _digits(hand, one.digits[-len(whole) :], whole)
        hand.strike(one.digits[-max(len(whole), 2) :])
    elif how == "gap":
        _digits(hand, one.digits[-3:-2], whole[:1])
        _digits(hand, one.digits[-1:], whole[-1:])
    elif how == "two signs" and one.sign is not None:
        hand.minus(one.sign)
        hand.minus(one.digits[0])
        _digits(hand, one.digits[-1:], whole[:1])
    elif how == "comma":
        _digits(hand, one.decimals, behind or "5")
    else:
        _digits(hand, one.digits[-1:], whole[:1])
        _digits(hand, one.digits[-1:], str((int(whole[0]) + 3) % 10))
        hand.fill(one.digits[-1])
    return Wrote(waits=True, how=how)


def _digits(hand: Hand, boxes: Sequence[Box], text: str) -> None:
    for box, digit in zip(boxes, text, strict=False):
        hand.digit(box, int(digit))


# ------------------------------------------------------------------- scanning


@dataclass(frozen=True)
class Scan:
    """How a sheet was scanned or photographed; lengths are mm on the sheet, angles degrees."""

    dpi: float = 200
    turn: int = 0  #: quarter turns
    skew: float = 0.0
    shear: float = 0.0
    blur: float = 0.12  #: mm
    noise: float = 2.0  #: of 255
    gamma: float = 1.0
    light: float = 1.0  #: of the paper
    perspective: float = 0.0  #: share of the side by which corners are moved
    table: bool = False  #: the table around is seen
    curve: float = 0.0  #: mm, how high the page's middle stands
    shadow: float = 0.0  #: share of light lost at one side
    edge: float = 0.0  #: share of light lost behind the edge of a shadow
    stains: int = 0
    dust: int = 0
    fold: float = 0.0  #: share of light lost in the line of a fold; it bends the page by a millimetre
    cut_corner: int = -1  #: which mark is lost
    jpeg: int = 0  #: quality, 0 for none
    bilevel: str = ""  #: threshold, otsu, dither
    streaks: int = 0  #: lines down the page from dirt on the glass


def scanned(sheet: np.ndarray, scan: Scan, rng: np.random.Generator) -> np.ndarray:
    """The picture of a sheet, grey, uint8."""
    sheet = _dirtied(sheet, scan, rng)
    picture = _seen(sheet, scan, rng)
    picture = _lit(picture, scan, rng)
    if scan.turn % 4:
        picture = np.ascontiguousarray(np.rot90(picture, scan.turn % 4))
    return _stored(picture, scan)


def _dirtied(sheet: np.ndarray, scan: Scan, rng: np.random.Generator) -> np.ndarray:
    sheet = sheet.copy()
    high, wide = sheet.shape[:2]
    for _ in range(scan.stains):
        _stain(sheet, rng)
    for _ in range(scan.dust):
        at = (int(rng.integers(wide)), int(rng.integers(high)))
        cv2.circle(sheet, at, int(rng.integers(1, 4)), 60, -1, cv2.LINE_AA)
    if 0 <= scan.cut_corner < 4:
        _cut(sheet, scan.cut_corner)
    return sheet


def _stain(sheet: np.ndarray, rng: np.random.Generator) -> None:
    """Coffee: a light round with a darker edge, here and there a blot."""
    high, wide = sheet.shape[:2]
    radius = rng.uniform(12, 40) * DOTS
    middle = rng.uniform(0.15, 0.85, 2) * (wide, high)
    x0, y0, w, h = _around(middle[None], round(1.2 * radius + 6 * DOTS), sheet.shape)
    near = sheet[y0 : y0 + h, x0 : x0 + w]
    y, x = np.ogrid[y0 : y0 + h, x0 : x0 + w]
    angle = np.arctan2(y - middle[1], x - middle[0])
    wobble = 1 + 0.04 * np.sin(3 * angle + rng.uniform(0, 6)) + 0.02 * np.sin(7 * angle + rng.uniform(0, 6))
    far = np.hypot(x - middle[0], y - middle[1]) / wobble / DOTS - radius / DOTS
    inner = rng.uniform(0.02, 0.14) / (1 + np.exp(np.clip(far * 4, -30, 30)))
    ring = rng.uniform(0.08, 0.3) * np.exp(-(((far + 0.6) / rng.uniform(0.4, 1.2)) ** 2))
    near[:] = (near * (1 - np.clip(inner + ring, 0, 0.6))).astype(np.uint8)


def _cut(sheet: np.ndarray, corner: int) -> None:
    high, wide = sheet.shape[:2]
    size = round(24 * DOTS)
    x, y = (0, wide, wide, 0)[corner], (0, 0, high, high)[corner]
    sx, sy = (1, -1, -1, 1)[corner], (1, 1, -1, -1)[corner]
    cv2.fillPoly(sheet, [np.array([(x, y), (x + sx * size, y), (x, y + sy * size)])], 150)


def _seen(sheet: np.ndarray, scan: Scan, rng: np.random.Generator) -> np.ndarray:
    """The sheet through the glass or the lens: one resampling."""
    per_mm = scan.dpi / 25.4
    ratio = per_mm / DOTS
    sigma = np.hypot(scan.blur * DOTS, 0.35 / ratio if ratio < 1 else 0)
    grey = cv2.GaussianBlur(sheet, (0, 0), max(sigma, 0.3))
    matrix, size = _placing(grey.shape, ratio, scan, rng)
    ground = 90.0 if scan.table else 255.0
    if not scan.curve and not scan.fold:
        return cv2.warpPerspective(grey, matrix, size, borderValue=ground).astype(np.float32)
    columns, rows = np.meshgrid(np.arange(size[0], dtype=np.float32), np.arange(size[1], dtype=np.float32))
    h = np.linalg.inv(matrix).astype(np.float32)
    w = h[2, 0] * columns + h[2, 1] * rows + h[2, 2]
    x = (h[0, 0] * columns + h[0, 1] * rows + h[0, 2]) / w
    y = (h[1, 0] * columns + h[1, 1] * rows + h[1, 2]) / w
    x, y = _bent(x, y, grey.shape, scan)
    bent = cv2.remap(grey, np.float32(x), np.float32(y), cv2.INTER_LINEAR, borderValue=ground)
    return bent.astype(np.float32)


def _placing(
    shape: Sequence[int], ratio: float, scan: Scan, rng: np.random.Generator
) -> tuple[np.ndarray, tuple[int, int]]:
    high, wide = shape[0], shape[1]
    a, s = np.radians(scan.skew), np.tan(np.radians(scan.shear))
    turned = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]) @ np.array([[1, s], [0, 1]]) * ratio
    corners = np.array([(0, 0), (wide, 0), (wide, high), (0, high)], float) @ turned.T
    if scan.perspective:
        corners += rng.uniform(-scan.perspective, scan.perspective, (4, 2)) * ratio * wide
    rim = 0.04 * wide * ratio if scan.table or scan.perspective or abs(scan.skew) > 3 else 0
    low, top = corners.min(axis=0) - rim, corners.max(axis=0) + rim
    matrix = cv2.getPerspectiveTransform(
        np.array([(0, 0), (wide, 0), (wide, high), (0, high)], np.float32), (corners - low).astype(np.float32)
    )
    return matrix, (round(top[0] - low[0]), round(top[1] - low[1]))


def _bent(x: np.ndarray, y: np.ndarray, shape: Sequence[int], scan: Scan) -> tuple[np.ndarray, np.ndarray]:
    """Where on the flat sheet what is seen lies, of a curved or folded page."""
    high, wide = shape[0], shape[1]
    if scan.curve:
        u, v = x / wide - 0.5, y / high - 0.5
        lift = scan.curve * DOTS * (0.25 - u * u) * 4
        x, y = x + lift * u, y + lift * (0.6 + v)
    if scan.fold:
        y = y + 0.8 * DOTS * np.maximum(0, 1 - np.abs(y / high - 0.5) * 8)
    return x, y


def _lit(picture: np.ndarray, scan: Scan, rng: np.random.Generator) -> np.ndarray:
    """The picture with its light, and with the camera's noise."""
    high, wide = picture.shape
    v, u = np.linspace(0, 1, high, dtype=np.float32)[:, None], np.linspace(0, 1, wide, dtype=np.float32)
    light = np.full((1, 1), scan.light, np.float32)
    if scan.shadow:
        angle = rng.uniform(0, 2 * np.pi)
        light = light * (
            1 - scan.shadow * np.clip(0.5 + (u - 0.5) * np.cos(angle) + (v - 0.5) * np.sin(angle), 0, 1)
        )
    if scan.edge:
        angle, off = rng.uniform(0, 2 * np.pi), rng.uniform(-0.25, 0.25)
        side = (u - 0.5) * np.cos(angle) + (v - 0.5) * np.sin(angle) - off
        light = light * (1 - scan.edge / (1 + np.exp(-side * np.float32(rng.uniform(30, 150)))))
    if scan.fold:
        light = light * (1 - scan.fold * np.exp(-(((v - 0.5) / 0.004) ** 2)))
    picture = picture * light
    if scan.gamma != 1:
        picture = 255 * (picture / 255) ** np.float32(scan.gamma)
    for _ in range(scan.streaks):
        column = int(rng.integers(wide))
        picture[:, column : column + 1 + int(rng.integers(2))] -= rng.uniform(20, 110)
    return picture + scan.noise * rng.standard_normal(picture.shape, dtype=np.float32)


def _stored(picture: np.ndarray, scan: Scan) -> np.ndarray:
    picture = np.clip(picture, 0, 255).astype(np.uint8)
    if scan.bilevel == "threshold":
        picture = np.where(picture > 150, 255, 0).astype(np.uint8)
    elif scan.bilevel == "light":
        picture = np.where(picture > 205, 255, 0).astype(np.uint8)
    elif scan.bilevel == "otsu":
        picture = cv2.threshold(picture, 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU)[1]
    elif scan.bilevel == "dither":
        picture = _dithered(picture)
    if scan.jpeg:
        picture = cv2.imdecode(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, scan.jpeg])[1], 0)
    return picture


def _dithered(picture: np.ndarray) -> np.ndarray:
    """By an ordered pattern of 4 by 4, as fax machines do."""
    pattern = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]]) * 16 + 8
    high, wide = picture.shape
    tiled = np.tile(pattern, (high // 4 + 1, wide // 4 + 1))[:high, :wide]
    return np.where(picture > tiled, 255, 0).astype(np.uint8)


#: Kinds of disturbance; each draws how a page was scanned.
KINDS: Mapping[str, Callable[[np.random.Generator], Scan]] = {
    "office scanner": lambda r: Scan(
        dpi=float(r.choice([200, 300])), turn=int(r.integers(4)), skew=r.uniform(-2, 2), noise=2.5, jpeg=85
    ),
    "150 dpi": lambda r: Scan(
        dpi=150, turn=int(r.integers(4)), skew=r.uniform(-3, 3), noise=4, blur=0.15, jpeg=60
    ),
    "600 dpi": lambda r: Scan(dpi=600, turn=int(r.integers(4)), skew=r.uniform(-2, 2), noise=5, jpeg=90),
    "skew to 10 degrees": lambda r: Scan(
        dpi=200,
        skew=r.uniform(5, 10) * r.choice([-1, 1]),
        shear=r.uniform(-1, 1),
        turn=int(r.integers(4)),
        noise=3,
    ),
    "black and white": lambda r: Scan(
        dpi=float(r.choice([200, 300])),
        bilevel=str(r.choice(["threshold", "otsu", "light"])),
        noise=4,
        skew=r.uniform(-2, 2),
        turn=2 * int(r.integers(2)),
        dust=int(r.integers(30)),
    ),
    "dithered": lambda r: Scan(
        dpi=float(r.choice([200, 300])), bilevel="dither", noise=3, skew=r.uniform(-2, 2)
    ),
    "photograph": lambda r: Scan(
        dpi=r.uniform(190, 300),
        perspective=0.05,
        table=True,
        shadow=r.uniform(0, 0.5),
        noise=5,
        blur=r.uniform(0.1, 0.2),
        skew=r.uniform(-8, 8),
        turn=int(r.integers(4)),
        gamma=r.uniform(0.8, 1.3),
        light=r.uniform(0.75, 1),
        jpeg=75,
    ),
    "curved photograph": lambda r: Scan(
        dpi=r.uniform(200, 300),
        perspective=0.04,
        table=True,
        shadow=r.uniform(0.1, 0.5),
        curve=r.uniform(1, 4) * r.choice([-1, 1]),
        noise=5,
        blur=0.15,
        skew=r.uniform(-5, 5),
        jpeg=80,
    ),
    "edge of a shadow": lambda r: Scan(
        dpi=220, perspective=0.03, table=True, edge=r.uniform(0.2, 0.5), noise=5, blur=0.15, jpeg=80
    ),
    "coffee": lambda r: Scan(
        dpi=float(r.choice([200, 300])), stains=int(r.integers(1, 4)), skew=r.uniform(-2, 2), noise=3, jpeg=80
    ),
    "folded": lambda r: Scan(dpi=200, fold=r.uniform(0.1, 0.4), skew=r.uniform(-2, 2), noise=3, dust=10),
    "corner cut": lambda r: Scan(
        dpi=200, cut_corner=int(r.choice([0, 2, 3])), skew=r.uniform(-3, 3), noise=3
    ),
    "dust and streaks": lambda r: Scan(
        dpi=200, dust=int(r.integers(50, 300)), streaks=int(r.integers(4)), noise=4, skew=r.uniform(-2, 2)
    ),
    "dark copy": lambda r: Scan(
        dpi=200, gamma=r.uniform(1.4, 2.2), light=r.uniform(0.8, 0.95), noise=6, blur=0.2
    ),
    "light copy": lambda r: Scan(dpi=200, gamma=r.uniform(0.4, 0.7), noise=4, blur=0.2),
}


def a_hand(rng: np.random.Generator, bank: Bank | None = None) -> Hand:
    """Somebody."""
    return Hand(
        pen=str(rng.choice(["blue", "black", "black", "blue", "red", "pencil", "green"])),
        width=rng.uniform(0.35, 0.75),
        size=rng.uniform(4.8, 7.2),
        jitter=rng.uniform(0.2, 0.55),
        bank=bank,
        rng=rng,
    )


def filled_in(
    sheet: np.ndarray, page: AnswerPage, hand: Hand, odd: float = 0.15
) -> tuple[np.ndarray, tuple[Wrote, ...]]:
    """A sheet on which somebody answered, and what."""
    hand.begin(sheet)
    wrote = written(hand, page, odd=odd)
    return hand.finish(sheet), wrote


# ------------------------------------------------------------ a page of its own


def example_page(code: str = "ABCDEFGHIJKLM", *, rows: int = 4) -> AnswerPage:
    """Half a page with fields of every sort, of no exercise."""
    blank = AnswerField(0, "example", 1, "x", 0, 1, "number", Box(0, 0, 0, 0))
    wide, high = 210.0, 172.0
    y, fields = 44.0, []
    for k in range(rows):
        fields.append(_row(replace(blank, part=f"n{k}"), y))
        y += 11.5
    for k, several in enumerate((False, True)):
        fields.append(_cases(replace(blank, part=f"t{k}", what="ticks", several=several), y, 4 + k))
        y += 11.5
    fields.append(replace(blank, part="w", what="written", whole=Box(28, y, 80, 21), free=Box(28, y, 80, 21)))
    fields.append(replace(blank, part="d", what="drawing", whole=Box(120, y, 60, 30)))
    marks = ((11.0, 11.0), (wide - 11, 11.0), (wide - 11, high - 11), (11.0, high - 11))
    guide = tuple(Box(wide - 12 - (10 - d) * 7, 30.5, 7, 9) for d in range(10))
    return AnswerPage(
        1,
        1,
        f"CW1 {code} 1/1",
        wide,
        high,
        marks,
        Box(wide - 37.5, 8, 20, 20),
        tuple(fields),
        title=Box(20, 8, 100, 8),
        name=Box(20, 17, 100, 8),
        rules=None,
        guide=guide,
    )


def _row(blank: AnswerField, y: float) -> AnswerField:
    def cells(x: float, count: int) -> tuple[Box, ...]:
        return tuple(Box(12 + x + 7 * k, y + 1.25, 7, 9) for k in range(count))

    return replace(
        blank,
        whole=Box(12, y + 0.25, 186, 11),
        sign=cells(29.5, 1)[0],
        digits=cells(37.5, 5),
        decimals=cells(75.5, 4),
        power_sign=cells(111.5, 1)[0],
        power=cells(119, 2),
        unit=Box(147, y + 3.25, 5, 5),
        unit_text="mm",
        free=Box(166.5, y + 1.25, 31.5, 9),
    )


def _cases(blank: AnswerField, y: float, count: int) -> AnswerField:
    cases = [f"case{k}" for k in range(count - 1)] + ["none" if blank.several else "last"]
    boxes = tuple((case, Box(41.5 + 12 * k, y + 3.25, 5, 5)) for k, case in enumerate(cases))
    printed = tuple("" if case == "none" else "abcdef"[k] for k, case in enumerate(cases))
    return replace(
        blank,
        whole=Box(12, y + 0.25, 186, 11),
        ticks=boxes,
        printed=printed,
        free=Box(166.5, y + 1.25, 31.5, 9),
    )
