"""Drawing surface of a sheet: which boxes a drawing fills, which links give directions, and the settings of
its script."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from coursework.errors import BadInput
from coursework.figures import Figure, pin, rail, slot_link
from coursework.figures.elements import bar, contact, ground_pivot, point, slider
from coursework.figures.student_drawing import MOST_CHARACTERS, StudentDrawing
from coursework.figures.text import LabelText, read
from coursework.language.words import words
from coursework.model import Exercise
from coursework.rendering.keeping import in_script
from coursework.sheets.sheet import Handout, Question

#: Name of the text area in which the drawing is stored, after the prefix of the sheet's boxes.
FIELD = "drawing"
_GRAPHS = ("graph", "unnamed_graph")
_GRAPH_MM = (100, 70)  #: of the surface of a joint graph, whose lengths mean nothing
_INSET = 90.0  #: size of the small figure of the links, px
_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_NAMED = (pin, ground_pivot, point, contact, slider)  #: elements whose label names a point


@dataclass(frozen=True)
class DirectionOfLink:
    """Link of the statement's figure, to whose direction lines are drawn."""

    name: str  #: LaTeX, ``OA``
    degrees: float  #: to the tenth, as the statement gives it
    start: complex  #: px of the small figure, y downwards
    end: complex

    @property
    def label(self) -> str:
        """Name in plain letters, ``O₄A``."""
        runs = read(self.name).runs
        return "".join(run.text.translate(_BELOW) if run.rise < 0 else run.text for run in runs)

    @property
    def middle(self) -> complex:
        """Place of the label in the small figure, px."""
        return (self.start + self.end) / 2


@dataclass(frozen=True)
class DrawingSurface:
    """Content of a drawing surface, for its template."""

    kind: str  #: ``paper`` or ``graph``
    size_mm: tuple[int, int]
    points: tuple[Question, ...] = ()
    arrows: tuple[Question, ...] = ()  #: asked by their components
    scales: tuple[tuple[Question, str], ...] = ()  #: each with the unit of a length in the drawing
    numbers: tuple[Question, ...] = ()  #: that may be measured
    links: tuple[DirectionOfLink, ...] = ()
    inset_px: tuple[float, float] = (0.0, 0.0)
    graph: str = ""  #: box of the joint graph
    kinds: tuple[tuple[str, str], ...] = ()  #: of joints, with their names
    most: int = MOST_CHARACTERS
    _lang: str = "en"

    def settings(self, own: str) -> Markup:
        """JSON for the script; ``own`` is the prefix of the names of the sheet's boxes."""
        table = words(self._lang)
        settings = {
            "kind": self.kind,
            "lang": self._lang,
            "own": own,
            "mm": self.size_mm,
            "points": [question.id for question in self.points],
            "arrows": [question.id for question in self.arrows],
            "scales": [question.id for question, _ in self.scales],
            "labels": {q.id: _runs(read(q.symbol)) for q in (*self.points, *self.arrows)},
            "box": self.graph,
            "kinds": {
                kind: [names[0], *(name.lower() for name in names), _letter(kind)]
                for kind, names in (table["graph"]["kinds"].items() if self.graph else ())
            },
            "words": table["drawing"]["script"],
        }
        return in_script(settings)


def kind_of_surface(exercise: Exercise, record: Mapping[str, Any]) -> str | None:
    """Return the kind of surface that sheets of a variant's record have, if any; without the sheet."""
    if exercise.drawing_mm or exercise.surface_mm:
        return "paper"
    return "graph" if any(part["kind"] in _GRAPHS for part in record["parts"]) else None


def kinds_of_surfaces(handouts: Iterable[Handout]) -> tuple[str, ...]:
    """Return the kinds of surfaces on a page of some sheets, each of which has a script; empty if it has
    none."""
    return tuple(sorted({drawn.kind for drawn in map(surface, handouts) if drawn}))


def scripts_of(kinds: Iterable[str]) -> tuple[str, ...]:
    """Return the scripts among the templates that make surfaces work, in their order."""
    return ("parts/toolbar.js", *(f"parts/surface_{kind}.js" for kind in kinds), "parts/surface.js")


def drawn_figure(texts: Mapping[tuple[int, str], str], attempt: int, handout: Handout) -> Figure | None:
    """Return what a student drew on the surface of a sheet, with the names of the questions; None where
    nothing can be shown.

    Parameters
    ----------
    texts
        Drawings of the student by attempt and exercise.
    attempt
        Number of the attempt.
    handout
        The sheet.
    """
    try:
        return StudentDrawing.parse(texts.get((attempt, handout.exercise), "")).figure(
            {q.id: q.symbol for q in handout.questions if q.symbol}
        )
    except BadInput:
        return None


def surface(handout: Handout) -> DrawingSurface | None:
    """Return the drawing surface of a sheet: of paper to draw on, else of a joint graph; none without
    either."""
    if size_mm := handout.drawing_mm or handout.surface_mm:
        return _paper(handout, size_mm)
    graph = next((question for question in handout.questions if question.kind in _GRAPHS), None)
    if graph is None:
        return None
    kinds = tuple((kind, names[0]) for kind, names in words(handout.lang)["graph"]["kinds"].items())
    return DrawingSurface("graph", _GRAPH_MM, graph=graph.id, kinds=kinds, _lang=handout.lang)


def _paper(handout: Handout, size_mm: tuple[int, int]) -> DrawingSurface:
    drawn = [question for question in handout.questions if question.kind == "point"]
    scales = tuple(
        (question, question.unit.removesuffix("/mm"))
        for question in handout.questions
        if question.unit.endswith("/mm")
    )
    units = {"mm", "°", *(unit for _, unit in scales)}
    # Where nothing is printed to draw on, the statement does not give the directions of the links: they may
    # be asked.
    figure = handout.figure if handout.drawing_mm else None
    links = tuple(_links(figure)) if isinstance(figure, Figure) else ()
    return DrawingSurface(
        "paper",
        size_mm,
        points=tuple(question for question in drawn if not _is_arrow(question)),
        arrows=tuple(filter(_is_arrow, drawn)),
        scales=scales,
        numbers=tuple(q for q in handout.questions if q.kind in ("number", "angle") and q.unit in units),
        links=_in_small(links),
        inset_px=_extent(links),
        _lang=handout.lang,
    )


def _is_arrow(question: Question) -> bool:
    return question.symbol.startswith(r"\vec")


def _letter(kind: str) -> str:
    from coursework.parsing.graphs import LETTER_OF

    return LETTER_OF.get(kind, "").lower()


def _runs(label: LabelText) -> list[tuple[str, bool, float, float]]:
    """Return the letters of a label as the script prints them; an arrow over letters as a combining sign."""
    arrows = {accent.first for accent in label.accents if accent.kind == "arrow"}
    return [
        (run.text + "\N{COMBINING RIGHT ARROW ABOVE}" * (k in arrows), run.italic, run.size, run.rise)
        for k, run in enumerate(label.runs)
    ]


# --------------------------------------------------------------------------------- links


def _links(figure: Figure) -> Iterator[DirectionOfLink]:
    """Yield the straight links of a figure whose ends have names, mm of mechanism, and the guides."""
    names = [
        (element.p, element.label)
        for element in figure.elements
        if isinstance(element, _NAMED) and element.label
    ]
    seen = set()
    for element in figure.elements:
        ends: Sequence[tuple[complex, complex]] = ()
        if isinstance(element, bar):
            ends = element.bars()
        elif isinstance(element, (slot_link, rail)):
            ends = ((element.p, element.q),)
        for start, end in ends:
            name = _name(start, end, names, is_guide=isinstance(element, slot_link))
            if name and name not in seen:
                seen.add(name)
                degrees = round(math.degrees(cmath.phase(end - start)), 1)
                yield DirectionOfLink(name, degrees, complex(start), complex(end))


def _name(start: complex, end: complex, names: Sequence[tuple[complex, str]], *, is_guide: bool) -> str:
    """Return the names of the ends of a link together; of a guide those of its start and of the first point
    on it."""
    size = abs(end - start)
    first = next((name for at, name in names if abs(at - start) < 1e-6 * size), "")
    second = next((name for at, name in names if abs(at - end) < 1e-6 * size), "")
    if is_guide and not second:
        on = (
            (at, name)
            for at, name in names
            if name != first and abs(((at - start) * (end - start).conjugate()).imag) < 1e-6 * size**2
        )
        second = next((name for _, name in on), "")
    return first + second if first and second else ""


def _extent(links: Sequence[DirectionOfLink]) -> tuple[float, float]:
    low, high, scale = _frame(links)
    size = scale * (high - low)
    return round(size.real + 48, 1), round(size.imag + 24, 1)


def _frame(links: Sequence[DirectionOfLink]) -> tuple[complex, complex, float]:
    points = [z for link in links for z in (link.start, link.end)] or [0j]
    low = complex(min(z.real for z in points), min(z.imag for z in points))
    high = complex(max(z.real for z in points), max(z.imag for z in points))
    return low, high, _INSET / (max((high - low).real, (high - low).imag) or 1.0)


def _in_small(links: Sequence[DirectionOfLink]) -> tuple[DirectionOfLink, ...]:
    low, high, scale = _frame(links)

    def small(z: complex) -> complex:
        return complex(
            round(12 + scale * (z.real - low.real), 1), round(12 + scale * (high.imag - z.imag), 1)
        )

    return tuple(DirectionOfLink(k.name, k.degrees, small(k.start), small(k.end)) for k in links)
