"""Answer pages: paper of a fixed layout that is filled in by hand and read back by a scanner.

The layout is a function of what the records ask, and of the paper: it is the same whatever the answers, the
student and the language, so that nothing of it is stored. Lengths are mm from the upper left corner of the
paper, y downwards.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Protocol

from coursework.course.asked import KeySource
from coursework.errors import BadCourse, unknown
from coursework.kinds.kind import Asking
from coursework.sheets.units import units_text

if TYPE_CHECKING:
    from coursework.kinds.kind import Tick
    from coursework.model import Part

SIZES = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}  #: of paper, by its name

MARK = 6.0  #: side of a corner mark
FRAME = 8.0  #: from the paper's edge, which no printer cuts
CELL = (7.0, 9.0)  #: a box for one digit or sign
TICK = 5.0  #: side of a box to tick
WHOLE_DIGITS, DECIMALS, POWER_DIGITS = 5, 4, 2

LEFT = FRAME + 4.0  #: where the page's content begins
_TOP, _TOP_BARE, _FOOT = 47.0, 31.0, FRAME + MARK + 2.5
_QR = 20.0
_CORNER = FRAME + MARK + 3.5  #: from the edge, free of marks and of their rim
_CODE_CHARACTERS = 13  #: 65 bits

#: Of a row, from the left of the page's content: what stands before the boxes, and where each group of them
#: begins.
_NUMBER, _SYMBOL, _BOXES = 0.0, 10.0, 29.5
_DIGITS = _BOXES + CELL[0] + 1.0
_DECIMALS = _DIGITS + WHOLE_DIGITS * CELL[0] + 3.0
_POWER_SIGN = _DECIMALS + DECIMALS * CELL[0] + 8.0
_POWER = _POWER_SIGN + CELL[0] + 0.5
_UNIT = _POWER + POWER_DIGITS * CELL[0] + 2.0
_FREE = _UNIT + TICK + 14.5
_ROW, _PAD = 11.5, 1.25  #: height of a row of boxes, and its blank above and below them
_TICKS_ROW, _PITCH, _PER_ROW = 8.5, 12.0, 10
_LINE, _WRITTEN = 8.0, 5.0  #: a line to write on, and what a box has besides its lines
_LABEL, _SIDES = 6.0, 5.0  #: above a drawing, and below its numbered sides
_HEAD = 9.0  #: of an exercise
_CAPTIONS = 3.4  #: above the first row of numbers on a page


class Answerable(KeySource, Asking, Protocol):
    """A variant, as far as its answer pages hang on it."""

    @property
    def seed(self) -> int: ...


@dataclass(frozen=True)
class Box:
    """A rectangle on paper."""

    x: float
    y: float
    width: float
    height: float

    @property
    def right(self) -> float:
        return self.x + self.width

    @property
    def bottom(self) -> float:
        return self.y + self.height

    def lower(self, by: float) -> Box:
        return replace(self, y=self.y + by)


@dataclass(frozen=True)
class AnswerField:
    """The place of one answer, or of one coordinate of it."""

    place: int  #: of the exercise on the paper, from 0 on
    exercise: str
    seed: int
    part: str  #: empty for the paper to draw on that belongs to the exercise
    coordinate: int  #: 0 of 1 for a plain number; entries of vectors, matrices and torsors in order
    coordinates: int
    what: str  #: ticks, number, written or drawing
    whole: Box  #: what a person is shown; of a drawing the box itself, of numbers and ticks the row
    ticks: tuple[tuple[str, Box], ...] = ()  #: the boxes of the cases, in printed order
    sign: Box | None = None
    digits: tuple[Box, ...] = ()  #: before the printed point; boxes that are not needed stay empty
    decimals: tuple[Box, ...] = ()
    power_sign: Box | None = None  #: of a power of ten
    power: tuple[Box, ...] = ()
    unit: Box | None = None  #: to tick: the unit is the printed one; of all coordinates, beside the first
    unit_text: str = ""
    free: Box | None = None  #: to write in instead: goes to a person
    asks_unit: bool = False  #: the unit is the student's to write, in the free box
    several: bool = False  #: whether more than one box may be ticked
    number: str = ""  #: of the question, as the sheet has it: 3, or 2.3
    symbol: str = ""  #: LaTeX of what is asked
    axis: str = ""  #: LaTeX of the coordinate, where there are several
    printed: tuple[str, ...] = ()  #: beside each box to tick, Markdown; nothing beside the one for none
    lines: int = 0  #: to write on, where words are asked
    is_millimetre: bool = False  #: a drawing on millimetre paper

    @property
    def none(self) -> str:
        """The case to tick where none of the others is right; empty where that is none."""
        pairs = zip(self.ticks, self.printed, strict=True)
        return next((case for (case, _), printed in pairs if not printed), "")


@dataclass(frozen=True)
class PageHead:
    """The heading of an exercise, where a paper has several."""

    place: int  #: of the exercise, from 0 on
    box: Box


@dataclass(frozen=True)
class AnswerPage:
    """One page to fill in, and to find again on a scan."""

    number: int  #: from 1 on
    pages: int
    code_text: str  #: what the QR code says
    width: float
    height: float
    #: Centres of the black squares: upper left, upper right, lower right, lower left.
    marks: tuple[tuple[float, float], ...]
    code: Box  #: of the QR code, without its rim
    fields: tuple[AnswerField, ...]
    title: Box
    name: Box  #: where the student's name is printed, or written
    rules: Box | None  #: none on a page that is one large drawing
    guide: tuple[Box, ...] = ()  #: boxes with the digits 0 to 9 as they are to be written
    heads: tuple[PageHead, ...] = ()
    #: A strip for what the columns of boxes are called, above the first row of numbers.
    captions: Box | None = None


def paper_code(
    assignment: str, student: str, sitting: int, records: Sequence[Mapping[str, Any]], paper: str = "a4"
) -> str:
    """Return the code of a paper, of 13 letters and digits: the same from ``issued.json`` as when it was
    built.

    ``assignment`` is its name, empty where exercises are handed out by themselves; ``records`` are the
    paper's. The code tells nothing of who and what, and is another on another size of paper.
    """
    content = json.dumps([assignment, student, sitting, paper, *records], sort_keys=True, ensure_ascii=True)
    digest = hashlib.sha256(f"coursework/paper/{content}".encode()).digest()
    return base64.b32encode(digest).decode()[:_CODE_CHARACTERS]


def code_text(code: str, number: int, pages: int) -> str:
    """Return the text of a page's QR code; the pages of the statement have number 0."""
    return f"CW1 {code} {number}/{pages}"


def answer_pages(
    variants: Sequence[Answerable],
    lang: str = "en",
    paper: str = "a4",
    code: str = "",
    *,
    alone: bool = False,
) -> tuple[AnswerPage, ...]:
    """Return the answer pages of one paper, whose exercises are these variants in order.

    ``lang`` is that of the units that are printed; it moves nothing. ``code`` is the paper's:
    :func:`paper_code`. The questions of an exercise that is handed out ``alone`` have no number before their
    own.

    Raises
    ------
    UnknownName
        No such paper.
    BadCourse
        A part does not fit on a page.
    NoSolution
        A part has as many coordinates as its reference, and the course has no solutions.
    """
    if paper not in SIZES:
        raise unknown("paper", paper, tuple(SIZES))
    sheets = _PageLayout(*SIZES[paper])
    for index, variant in enumerate(variants):
        if len(variants) > 1:
            sheets.head(index)
        for block in _blocks(variant, index, lang, sheets.width, alone=alone):
            sheets.add(block)
    return sheets.pages(code)


# ------------------------------------------------------------------- one part


@dataclass(frozen=True)
class _Block:
    """Rows that stay on one page, from y = 0 down; where a page ends inside, it ends between two rows."""

    rows: tuple[tuple[AnswerField, float], ...]  #: each with its height

    @property
    def height(self) -> float:
        return sum(height for _, height in self.rows)


def _blocks(variant: Answerable, index: int, lang: str, width: float, *, alone: bool) -> Iterator[_Block]:
    if variant.exercise.spec.drawing_mm:
        yield _exercise_drawing(variant, index, width)
    for number, part in enumerate(variant.parts, start=1):
        label = str(number) if alone else f"{index + 1}.{number}"
        yield _block(variant, index, part, label, lang, width)


def _block(variant: Answerable, index: int, part: Part, number: str, lang: str, width: float) -> _Block:
    symbol = variant.exercise.symbol(part.quantity, lang) if part.sort.has_symbol else ""
    blank = AnswerField(
        index,
        variant.exercise.name,
        variant.seed,
        part.id,
        0,
        1,
        part.sort.field,
        Box(0, 0, 0, 0),
        number=number,
        symbol=symbol,
    )
    if part.sort.field == "ticks":
        return _ticks(blank, part.sort.ticks(part, variant), width, several=part.sort.has_several_ticks)
    if part.sort.field == "written":
        return _written(blank, part.room if isinstance(part.room, int) else part.sort.lines, width)
    if part.sort.field == "drawing":
        return _drawing(replace(blank, is_millimetre=part.millimetre), part.room, width)
    if part.sort.field == "number":
        unit = "" if part.asks_unit else units_text(part, lang, variant)
        blank = replace(blank, asks_unit=part.asks_unit)
        return _numbers(blank, part.sort.coordinates(part, variant), unit, width, part.sort.has_decimals)
    raise BadCourse(
        f"kind {part.kind!r}: a field is ticks, number, written or drawing; found {part.sort.field!r}"
    )


def _numbers(blank: AnswerField, names: Sequence[str], unit: str, width: float, has_decimals: bool) -> _Block:
    rows = []
    for coordinate, name in enumerate(names):
        first = coordinate == 0
        row = replace(
            _row_of_boxes(blank, width, has_decimals),
            coordinate=coordinate,
            coordinates=len(names),
            number=blank.number if first else "",
            axis=name,
            asks_unit=blank.asks_unit and first,
        )
        if unit and first:
            middle = _PAD + (CELL[1] - TICK) / 2
            row = replace(row, unit=Box(LEFT + _UNIT, middle, TICK, TICK), unit_text=unit)
        rows.append((row, _ROW))
    return _Block(tuple(rows))


def _row_of_boxes(blank: AnswerField, width: float, has_decimals: bool) -> AnswerField:
    row = replace(
        blank,
        whole=_row_box(width, _ROW),
        sign=_cell(_BOXES),
        digits=_cells(_DIGITS, WHOLE_DIGITS),
        free=_free(width, _PAD),
    )
    if not has_decimals:
        return row
    return replace(
        row,
        decimals=_cells(_DECIMALS, DECIMALS),
        power_sign=_cell(_POWER_SIGN),
        power=_cells(_POWER, POWER_DIGITS),
    )


def _row_box(width: float, height: float) -> Box:
    """Return a row as wide as the page's content, a little less high than its room: neighbours do not
    touch."""
    return Box(LEFT, 0.25, width - 2 * LEFT, height - 0.5)


def _cell(x: float) -> Box:
    return Box(LEFT + x, _PAD, *CELL)


def _cells(x: float, count: int) -> tuple[Box, ...]:
    return tuple(_cell(x + index * CELL[0]) for index in range(count))


def _free(width: float, y: float) -> Box:
    return Box(LEFT + _FREE, y, width - 2 * LEFT - _FREE, CELL[1])


def _ticks(blank: AnswerField, ticks: Sequence[Tick], width: float, *, several: bool) -> _Block:
    boxes = []
    for index, tick in enumerate(ticks):
        row, column = divmod(index, _PER_ROW)
        y = _PAD + (CELL[1] - TICK) / 2 + row * _TICKS_ROW
        boxes.append((tick.case, Box(LEFT + _BOXES + column * _PITCH, y, TICK, TICK)))
    height = _ROW + (len(ticks) - 1) // _PER_ROW * _TICKS_ROW
    ticked_field = replace(
        blank,
        whole=_row_box(width, height),
        ticks=tuple(boxes),
        printed=tuple(tick.printed for tick in ticks),
        several=several,
        free=_free(width, _PAD),
    )
    return _Block(((ticked_field, height),))


def _written(blank: AnswerField, lines: int, width: float) -> _Block:
    x, height = LEFT + _SYMBOL + 4.0, lines * _LINE + _WRITTEN
    box = Box(x, _PAD, width - LEFT - x, height)
    return _Block(((replace(blank, whole=box, free=box, lines=lines), height + 2 * _PAD),))


def _exercise_drawing(variant: Answerable, index: int, width: float) -> _Block:
    blank = AnswerField(
        index, variant.exercise.name, variant.seed, "", 0, 1, "drawing", Box(0, 0, 0, 0), is_millimetre=True
    )
    return _drawing(blank, variant.exercise.spec.drawing_mm or (0, 0), width)


def _drawing(blank: AnswerField, room: tuple[int, int], width: float) -> _Block:
    wide, high = room
    box = Box((width - wide) / 2, _LABEL, float(wide), float(high))
    below = _SIDES if not blank.part else 2 * _PAD
    return _Block(((replace(blank, whole=box), _LABEL + high + below),))


# ----------------------------------------------------------------------- pages


@dataclass
class _Page:
    """A page that is being filled."""

    is_bare: bool  #: without rules and guides, for one large drawing
    y: float
    fields: list[AnswerField] = field(default_factory=list)
    heads: list[PageHead] = field(default_factory=list)
    captions: float | None = None  #: their height on the page, once they stand

    def strip(self, row: AnswerField) -> float:
        """Return the room for captions that a row still needs above it."""
        return _CAPTIONS if row.what == "number" and self.captions is None else 0.0

    def put(self, row: AnswerField, height: float) -> None:
        if strip := self.strip(row):
            self.captions = self.y
            self.y += strip
        self.fields.append(_lowered(row, self.y))
        self.y += height


class _PageLayout:
    """Rows laid on page after page."""

    def __init__(self, width: float, height: float):
        self.width, self.height = width, height
        self._end = height - _FOOT
        self._made: list[_Page] = []
        self._waiting: int | None = None  #: the exercise whose heading stands before the next row

    def head(self, index: int) -> None:
        """Add the heading of an exercise, which stands with its first row."""
        self._waiting = index

    def add(self, block: _Block) -> None:
        """Add a block to this page, or to the next where it does not fit; a long one is cut between rows."""
        above = 0.0 if self._waiting is None else _HEAD
        (first, height), room = block.rows[0], self._end - _TOP - above - _CAPTIONS
        if len(block.rows) == 1 and height > room:
            self._alone(first, height, above)
            return
        needed = block.height if block.height <= room else height
        if not self._made or self._made[-1].y + above + self._made[-1].strip(first) + needed > self._end:
            self._open()
        self._put_head()
        for row, height in block.rows:
            if self._made[-1].y + self._made[-1].strip(row) + height > self._end:
                self._open()
            self._made[-1].put(row, height)

    def _alone(self, row: AnswerField, height: float, above: float) -> None:
        """Place a row that is higher than a usual page on a page of its own, without rules and guides."""
        left = self.height - FRAME - _TOP_BARE - above
        if height > left:
            raise BadCourse(
                f"{row.exercise}: {row.part or 'its paper to draw on'} is {row.whole.height:.0f} mm "
                "high, and an answer page of "
                f"{self.width:g} mm by {self.height:g} mm leaves "
                f"{left - height + row.whole.height:.0f} mm; make its room smaller"
            )
        self._open(bare=True)
        self._put_head()
        self._made[-1].put(row, height)
        self._made[-1].y = self._end

    def _open(self, *, bare: bool = False) -> None:
        self._made.append(_Page(bare, _TOP_BARE if bare else _TOP))

    def _put_head(self) -> None:
        if self._waiting is not None:
            page = self._made[-1]
            page.heads.append(
                PageHead(self._waiting, Box(LEFT, page.y + 1.0, self.width - 2 * LEFT, _HEAD - 2.0))
            )
            page.y += _HEAD
        self._waiting = None

    def pages(self, code: str) -> tuple[AnswerPage, ...]:
        return tuple(self._page(page, number, code) for number, page in enumerate(self._made, start=1))

    def _page(self, page: _Page, number: int, code: str) -> AnswerPage:
        wide, high, middle = self.width, self.height, FRAME + MARK / 2
        right, count = wide - _CORNER - _QR, len(self._made)
        rules = Box(LEFT, _TOP_BARE - 0.5, wide - 2 * LEFT - 10 * CELL[0] - 4.0, 14.5)
        guide = (Box(wide - LEFT - (10 - digit) * CELL[0], rules.y, *CELL) for digit in range(10))
        return AnswerPage(
            number,
            count,
            code_text(code, number, count),
            wide,
            high,
            marks=tuple(
                (x, y)
                for x, y in (
                    (middle, middle),
                    (wide - middle, middle),
                    (wide - middle, high - middle),
                    (middle, high - middle),
                )
            ),
            code=Box(right, FRAME, _QR, _QR),
            fields=tuple(page.fields),
            title=Box(_CORNER, FRAME, right - _CORNER - 4.0, 8.0),
            name=Box(_CORNER, FRAME + 8.5, right - _CORNER - 4.0, 7.5),
            rules=None if page.is_bare else rules,
            guide=() if page.is_bare else tuple(guide),
            heads=tuple(page.heads),
            captions=None if page.captions is None else Box(LEFT, page.captions, wide - 2 * LEFT, _CAPTIONS),
        )


def _lowered(row: AnswerField, by: float) -> AnswerField:
    """Return a row, and all its boxes, farther down the page."""

    def one(box: Box | None) -> Box | None:
        return None if box is None else box.lower(by)

    return replace(
        row,
        whole=row.whole.lower(by),
        ticks=tuple((case, box.lower(by)) for case, box in row.ticks),
        sign=one(row.sign),
        digits=tuple(box.lower(by) for box in row.digits),
        decimals=tuple(box.lower(by) for box in row.decimals),
        power_sign=one(row.power_sign),
        power=tuple(box.lower(by) for box in row.power),
        unit=one(row.unit),
        free=one(row.free),
    )
