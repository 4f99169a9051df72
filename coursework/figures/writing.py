"""SVG of a laid-out figure: short, deterministic, black on white."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from html import escape
from typing import NamedTuple, TypeAlias

from coursework.figures.ink import BLACK, FONT, Ink, number, pair
from coursework.figures.placing import Label
from coursework.figures.text import SIZE, LabelAccent, LabelText, LetterRun, advance

_FALLBACK = f"{FONT}, Linux Libertine O, Times New Roman, serif"

#: What writes the letters of a text, given the middle of its baseline, mm, y down; accents are drawn in any
#: case.
Lettering: TypeAlias = Callable[[LabelText, complex], str]


class Letters(NamedTuple):
    """Letters of a label to be set over the drawing: the middle of their baseline in mm from the top left
    corner of the figure, y down, and their runs."""

    x: float
    y: float
    runs: tuple[LetterRun, ...]


def pieces(
    ink: Sequence[Ink], labels: Sequence[Label], corner: complex, lettering: Lettering
) -> tuple[list[str], list[str]]:
    """Return each piece of a paper-mm drawing and each label as SVG; ``corner``, the frame's top left,
    becomes (0, 0), y down."""

    lines = [item.svg(lambda z: _from(corner, z)) for item in ink]
    middles = [baseline(label.text, _from(corner, label.center)) for label in labels]
    texts = [
        lettering(label.text, at) + accents(label.text, at) for label, at in zip(labels, middles, strict=True)
    ]
    return lines, texts


def letters(label: Label, corner: complex) -> Letters:
    """Return a label's letters and their position, from the frame's top left ``corner``."""
    at = baseline(label.text, _from(corner, label.center))
    return Letters(at.real, at.imag, label.text.runs)


def _from(corner: complex, z: complex) -> complex:
    """Return a point of the paper from the frame's top left corner, y down."""
    return complex(z.real - corner.real, corner.imag - z.imag)


def baseline(text: LabelText, center: complex) -> complex:
    """Return the middle of the baseline of a text whose box has this centre, y down."""
    return center + 1j * SIZE * (text.top + text.bottom) / 2


def written(
    lines: Sequence[str], texts: Sequence[str], size: tuple[float, float], lettering: Lettering
) -> str:
    """Return a complete SVG from its pieces, from bottom to top."""
    width, height = map(number, size)
    font = f' font-family="{_FALLBACK}" font-size="{number(SIZE)}" text-anchor="middle"'
    style = font if lettering is as_text else ""
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}">',
            f'<rect width="{width}" height="{height}" fill="#fff"/>',
            f'<g fill="none" stroke="{BLACK}" stroke-linecap="round" stroke-linejoin="round">',
            *lines,
            "</g>",
            f'<g fill="{BLACK}" stroke="none"{style}>',
            *texts,
            "</g>",
            "</svg>\n",
        ]
    )


def left_out(text: LabelText, at: complex) -> str:
    """Return no letters: the caller sets them over the drawing."""
    return ""


def as_text(text: LabelText, at: complex) -> str:
    """Return the letters as SVG text, in the reader's font."""
    if len(text.runs) == 1 and text.runs[0].size == 1:
        italic = ' font-style="italic"' if text.runs[0].italic else ""
        body = escape(text.runs[0].text)
    else:
        italic, rise, body = "", 0.0, ""
        for run in text.runs:
            body += _tspan(run, rise)
            rise = run.rise
    return f'<text x="{number(at.real)}" y="{number(at.imag)}"{italic}>{body}</text>'


def _tspan(run: LetterRun, rise: float) -> str:
    style = ' font-style="italic"' if run.italic else ""
    style += f' font-size="{number(run.size * SIZE)}"' if run.size != 1 else ""
    style += f' dx="{number(-run.back * SIZE)}"' if run.back else ""
    style += f' dy="{number((rise - run.rise) * SIZE)}"' if run.rise != rise else ""
    return f"<tspan{style}>{escape(run.text)}</tspan>"


def as_outlines(text: LabelText, at: complex) -> str:
    """Return the letters as outlines, independent of installed fonts."""
    from coursework.figures.typesetting import glyph

    left = at - SIZE * text.width / 2
    paths = []
    for index, run in enumerate(text.runs):
        at = left + SIZE * complex(text.start(index), -run.rise)
        for letter in run.text:
            item = replace(run, text=letter)
            scale = _fine(run.size * SIZE / 100)
            if outline := glyph(letter, run.italic):
                move = f"translate({pair(at)}) scale({scale} -{scale})"
                paths.append(f'<path transform="{move}" d="{outline}"/>')
            at += SIZE * item.width
    return "".join(paths)


def _fine(x: float) -> str:
    """Format a scale, which needs more digits than a length."""
    return f"{x:.5f}".rstrip("0")


def accents(text: LabelText, at: complex) -> str:
    """Return the accents over a text, given the middle of its baseline, without combining characters."""
    left = at - SIZE * text.width / 2
    return "".join(_accent(text, accent, left) for accent in text.accents)


def _accent(text: LabelText, accent: LabelAccent, left: complex) -> str:
    """Return an accent: dots as discs, bars and arrows as lines."""
    runs = text.runs[accent.first : accent.last]
    start = left.real + SIZE * text.start(accent.first)
    width = SIZE * advance(runs)
    # Italic letters lean: what stands above them stands a little to the right.
    lean = 0.08 * SIZE if runs[0].italic else 0.0
    # The head of an arrow hangs below its shaft.
    top = left.imag - SIZE * (max(run.top for run in runs) + (0.22 if accent.kind == "arrow" else 0.13))
    middle = start + width / 2 + lean
    if accent.kind in ("dot", "ddot"):
        shifts = (0.0,) if accent.kind == "dot" else (-0.11 * SIZE, 0.11 * SIZE)
        radius = number(0.065 * SIZE)
        return "".join(f'<circle cx="{number(middle + s)}" cy="{number(top)}" r="{radius}"/>' for s in shifts)
    # An exponent after the letters takes the room above their end.
    after = enumerate(text.runs[accent.last :], accent.last)
    raised = any(run.rise > 0 and text.start(k) <= text.start(accent.last) for k, run in after)
    start, end = (
        (start - 0.04 * SIZE, start + width - 0.04 * SIZE) if raised else (start + lean, start + width + lean)
    )
    a, b = number(start), number(end)
    direction = f"M{a} {number(top)}H{b}"
    if accent.kind == "arrow":
        back = number(end - 0.75)
        direction += f"M{back} {number(top - 0.45)}L{b} {number(top)}L{back} {number(top + 0.45)}"
    return f'<path d="{direction}" fill="none" stroke="{BLACK}" stroke-width="0.2"/>'
