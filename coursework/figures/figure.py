"""Figure: elements, scaled to a paper box, with their labels placed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from coursework.errors import WrongValue
from coursework.figures.base import Element
from coursework.figures.ink import MARKS, THIN, Ink, Path
from coursework.figures.printed import Printed
from coursework.language.numbers import rounded, settled

if TYPE_CHECKING:
    from coursework.figures.paper import FigurePaper
    from coursework.figures.placing import Label
    from coursework.figures.writing import Lettering, Letters

_PAPER_MM = (110.0, 75.0)  #: largest size of a drawing, by default
_MARGIN = 1.0  #: white round the drawing, mm
_DIGITS = 10  #: of the coordinates of what is drawn
_TRIES = 40
_GROWTHS, _WORTH_GROWING = 4, 1.05  #: so often a drawing is laid out once more that could be so much larger


class LabelBox(NamedTuple):
    """Box of a printed label: mm on paper from the top left corner of the figure, y down."""

    label: str
    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class _Layout:
    """Drawing at one scale: paper mm, y up; ``low`` and ``high`` are the corners of the frame."""

    scale: float
    ink: tuple[Ink, ...]
    labels: tuple[Label, ...]
    low: complex
    high: complex
    drew: tuple[int, ...]  #: the element, by its place, that each piece of ink comes from
    named: tuple[int, ...]  #: the same for labels

    @property
    def size_mm(self) -> tuple[float, float]:
        size = self.high - self.low
        return rounded(size.real, 1), rounded(size.imag, 1)

    @property
    def corner(self) -> complex:
        return complex(self.low.real, self.high.imag)

    @cached_property
    def _written(self) -> dict[Lettering, tuple[list[tuple[int, str]], list[tuple[int, str]]]]:
        return {}

    def svg(self, count: int | None, lettering: Lettering) -> str:
        """Return the first ``count`` elements as SVG, in the frame of all."""
        from coursework.figures.writing import pieces, written

        if lettering not in self._written:
            # Every piece is written once, however many times a part of the drawing is shown.
            lines, texts = pieces(self.ink, self.labels, self.corner, lettering)
            pile = sorted(range(len(lines)), key=lambda k: self.ink[k].layer)
            self._written[lettering] = (
                [(self.drew[k], lines[k]) for k in pile],
                list(zip(self.named, texts, strict=True)),
            )
        lines, texts = (
            [text for element, text in pieces_ if count is None or element < count]
            for pieces_ in self._written[lettering]
        )
        return written(lines, texts, self.size_mm, lettering)

    def letters(self, count: int | None) -> tuple[Letters, ...]:
        """Return the letters of the labels of the first elements."""
        return tuple(item for element, item in self._letters if count is None or element < count)

    @cached_property
    def _letters(self) -> list[tuple[int, Letters]]:
        from coursework.figures.writing import letters

        return [(k, letters(label, self.corner)) for k, label in zip(self.named, self.labels, strict=True)]


class _Drawn(Printed):
    """Elements of a layout: the first ones, or all."""

    count: int | None = None

    @property
    def _layout(self) -> _Layout:
        raise NotImplementedError

    @property
    def size_mm(self) -> tuple[float, float]:
        return self._layout.size_mm

    def svg(self) -> str:
        from coursework.figures.writing import as_text

        return self._layout.svg(self.count, as_text)

    def outlined_svg(self) -> str:
        """Return the drawing as SVG with labels as outlines, independent of installed fonts."""
        from coursework.figures.writing import as_outlines

        return self._layout.svg(self.count, as_outlines)

    def bare_svg(self) -> str:
        """Return the drawing as SVG without the letters of its labels, which the caller sets over it: see
        :meth:`letters`."""
        from coursework.figures.writing import left_out

        return self._layout.svg(self.count, left_out)

    def letters(self) -> tuple[Letters, ...]:
        """Return the letters of the labels with their positions on the drawing."""
        return self._layout.letters(self.count)

    def _repr_svg_(self) -> str:
        """Return the SVG that a notebook shows."""
        return self.outlined_svg()


@dataclass(frozen=True, init=False)
class Figure(_Drawn):
    """Elements in mechanism coordinates (complex, mm, y up), drawn to one scale in a paper box.

    ``paper_mm`` is the largest width and height the drawing may take, labels included, by default
    110 by 75; the aspect is kept, so one of the two is usually not used up. A sheet lays the figure out
    again for the room that it has (see :meth:`fitted`). With ``scale``, mm on paper for one of mechanism,
    the drawing has that scale and whatever size comes of it.

    Raises WrongValue if an element is not one of this package's, if the drawing has no
    extent, or if the box is too small for the symbols and labels.
    """

    elements: tuple[Element, ...]
    paper_mm: tuple[float, float]
    fixed_scale: float | None
    bounded: bool  #: whether the author gave ``paper_mm``

    def __init__(
        self, *elements: Element, paper_mm: tuple[float, float] | None = None, scale: float | None = None
    ) -> None:
        for element in elements:
            if not isinstance(element, Element):
                raise WrongValue(
                    "a figure is made of elements such as pin(0, 'A'); found {element!r}", element=element
                )
        object.__setattr__(self, "elements", elements)
        wide, high = paper_mm or _PAPER_MM
        object.__setattr__(self, "paper_mm", (float(wide), float(high)))
        object.__setattr__(self, "bounded", paper_mm is not None)
        if scale is not None and not 0 < scale < float("inf"):
            raise WrongValue("the scale of a figure is a positive number; found {scale!r}", scale=scale)
        object.__setattr__(self, "fixed_scale", scale)
        self._extent  # noqa: B018  a figure without extent is refused where it is written

    @cached_property
    def _settled(self) -> tuple[Element, ...]:
        """Elements rounded to ten digits of the drawing's extent, so that the layout depends on no last
        bit."""
        points = [z for element in self.elements for z in element.reach()]
        size = max((max(abs(z.real), abs(z.imag)) for z in points), default=0.0)
        if not size > 0:
            return self.elements
        decimals = _DIGITS - 1 - math.floor(math.log10(size))
        return tuple(element.settled(decimals) for element in self.elements)

    @cached_property
    def _extent(self) -> tuple[complex, complex]:
        """Corners of the mechanism, without symbols and labels."""
        points = [z for element in self._settled for z in element.reach()]
        low, high = _corners(points) if points else (0j, 0j)
        if not abs(high - low) > 0:
            names = ", ".join(type(element).__name__ for element in self.elements) or "no element"
            raise WrongValue("the figure has no extent, so no scale: it is made of {names}", names=names)
        return low, high

    @property
    def aspect(self) -> float:
        """Width of the mechanism over its height, without symbols and labels; infinite for a level line."""
        low, high = self._extent
        size = high - low
        return size.real / size.imag if size.imag else float("inf")

    @cached_property
    def _layout(self) -> _Layout:
        if self.fixed_scale is not None:
            return self._laid_out(self.fixed_scale)
        low, high = self._extent
        size = high - low
        # The paper that symbols and labels take: guessed, then as if each label had its best place, then as
        # laid out.
        scale = self._fitting(size, complex(14, 12))
        paper = self._drawn(scale)[0]
        low, high = _bounds(paper.ink, [z for wish in paper.wishes for z in wish.hoped()])
        symbols = high - low - scale * size
        scale, refused = 0.985 * self._fitting(size, symbols), float("inf")
        for _ in range(_TRIES):
            scale = 0.985 * min(scale, self._fitting(size, symbols))
            layout = self._laid_out(scale)
            symbols = layout.high - layout.low - scale * size
            if self._fits(layout):
                return self._grown(layout, size, refused)
            refused = scale
        raise WrongValue(
            "a paper box of {paper_mm} mm is too small for this figure's labels", paper_mm=self.paper_mm
        )

    def _grown(self, layout: _Layout, size: complex, refused: float) -> _Layout:
        """Return a larger layout that fits, using the room that the labels leave, below a ``refused``
        scale."""
        for _ in range(_GROWTHS):
            symbols = layout.high - layout.low - layout.scale * size
            wider = min(self._fitting(size, symbols), (layout.scale + refused) / 2)
            if wider <= _WORTH_GROWING * layout.scale:
                break
            grown = self._laid_out(wider)
            if self._fits(grown):
                layout = grown
            else:
                refused = wider
        return layout

    def _fits(self, layout: _Layout) -> bool:
        paper = layout.high - layout.low
        return paper.real <= self.paper_mm[0] and paper.imag <= self.paper_mm[1]

    def _fitting(self, size: complex, symbols: complex) -> float:
        room = complex(*self.paper_mm) - symbols
        scales = [r / s for r, s in ((room.real, size.real), (room.imag, size.imag)) if s > 0]
        if min(scales) <= 0:
            raise WrongValue(
                "a paper box of {paper_mm} mm is too small for this figure's labels", paper_mm=self.paper_mm
            )
        return settled(min(scales))

    def _drawn(self, scale: float) -> tuple[FigurePaper, list[int], list[int]]:
        """Return the ink and the label requests at a scale, and for each the index of its element."""
        from coursework.figures.paper import FigurePaper

        low, high = self._extent
        bars = [bar for element in self._settled for bar in element.bars()]
        paper = FigurePaper(scale, bars, (low + high) / 2)
        drew: list[int] = []
        wished: list[int] = []
        for number, element in enumerate(self._settled):
            element.draw(paper)
            drew += [number] * (len(paper.ink) - len(drew))
            wished += [number] * (len(paper.wishes) - len(wished))
        return paper, drew, wished

    def _laid_out(self, scale: float) -> _Layout:
        from coursework.figures.placing import place

        paper, drew, wished = self._drawn(scale)
        labels, order = place(paper.wishes, paper.ink)
        named = [wished[k] for k in order]
        led = [(label.leader, k) for label, k in zip(labels, named, strict=True) if label.leader]
        ink = (*paper.ink, *(Path(leader, THIN, layer=MARKS) for leader, _ in led))
        drew += [k for _, k in led]
        corners = _bounds(ink, [z for label in labels for z in label.corners])
        return _Layout(scale, ink, labels, *corners, tuple(drew), tuple(named))

    def fitted(self, width: float, height: float) -> Figure:
        """Return the figure laid out for a room in mm: the bars scale, the letters keep their size.

        A box given by the author is not exceeded, and a figure with a fixed scale is unchanged. So is one
        whose symbols and labels alone exceed the room: the printer then scales it as a whole. Each room is
        laid out once.
        """
        if self.fixed_scale is not None:
            return self
        if self.bounded:
            width, height = min(width, self.paper_mm[0]), min(height, self.paper_mm[1])
        room = (float(width), float(height))
        if room == self.paper_mm:
            return self
        if room not in self._fitted:
            figure = Figure(*self.elements, paper_mm=room)
            try:
                figure._layout  # noqa: B018  a room that is too small shows in laying out
            except WrongValue:
                figure = self
            self._fitted[room] = figure
        return self._fitted[room]

    @cached_property
    def _fitted(self) -> dict[tuple[float, float], Figure]:
        return {}

    def labelled(self, write: Callable[[str], str]) -> Figure:
        """Return the figure with each label as ``write`` gives it: itself where none changes."""
        elements = tuple(element.labelled(write) for element in self.elements)
        if elements == self.elements:
            return self
        paper_mm = self.paper_mm if self.bounded else None
        return Figure(*elements, paper_mm=paper_mm, scale=self.fixed_scale)

    def beginning(self, count: int) -> Beginning:
        """Return the first elements of the figure, placed as in the whole and in the same frame.

        The steps of a construction use it, laid out once.
        """
        return Beginning(self, count)

    @property
    def scale(self) -> float:
        """Millimetres on paper for one millimetre of mechanism."""
        return self._layout.scale

    def labels(self) -> tuple[LabelBox, ...]:
        """Return the boxes of the labels as placed."""
        corner = self._layout.corner
        return tuple(
            LabelBox(
                it.label,
                it.corners[0].real - corner.real,
                corner.imag - it.corners[1].imag,
                it.width,
                it.height,
            )
            for it in self._layout.labels
        )


@dataclass(frozen=True)
class Beginning(_Drawn):
    """First elements of a figure, in the frame of the whole: a step of a construction."""

    whole: Figure
    count: int

    @property
    def _layout(self) -> _Layout:
        return self.whole._layout


def _bounds(ink: Sequence[Ink], points: Sequence[complex]) -> tuple[complex, complex]:
    """Return the corners of the frame round ink and points, with its margin, on tenths of a mm.

    Rounded points thus stay rounded in the file.
    """
    corners = list(points)
    for item in ink:
        half = complex(item.width, item.width) / 2
        low, high = _corners(item.outline())
        corners += [low - half, high + half]
    low, high = _corners(corners)
    margin = complex(_MARGIN, _MARGIN)
    return _tenths(low - margin), _tenths(high + margin)


def _corners(points: Sequence[complex]) -> tuple[complex, complex]:
    xs, ys = [z.real for z in points], [z.imag for z in points]
    return complex(min(xs), min(ys)), complex(max(xs), max(ys))


def _tenths(z: complex) -> complex:
    return complex(rounded(z.real, 1), rounded(z.imag, 1))
