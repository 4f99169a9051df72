"""A mechanism in motion as one web page: the drawing, its numbers at every instant, one short script."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from coursework.figures.moving import COLOURS, MotionTrack, MovingDrawing
from coursework.language.numbers import localise, rounded, significant
from coursework.language.words import words
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.rendering.keeping import in_script
from coursework.scenes.animation import Animation


def page(
    folders: Sequence[Path], animation: Animation, paper: str = "a4", *, is_answered: bool = True
) -> str:
    """Return the whole page, in the variant's language; the figure alone before the questions are
    answered."""
    variant = animation.variant
    names = {
        "lang": variant.lang,
        "paper": paper,
        "title": animation.title,
        "variant": f"{variant.exercise.name} {variant.seed}",
        "sheet": {"course": variant.exercise.folder.title(variant.lang), "title": animation.title},
        **context(animation, is_answered=is_answered),
    }
    return render(environment_of(tuple(folders), variant.lang), "motion/motion.html.j2", names)


def context(animation: Animation, *, is_answered: bool = True) -> dict[str, Any]:
    """Return the names that ``motion/_body.html.j2`` sees.

    Before its questions are answered, a variant moves as its figure does and nothing more: no paths, vectors
    and values, no driving angle that is an answer, and places to the tenth of a millimetre on paper, as one
    measures them.
    """
    variant = animation.variant
    lang = variant.lang
    available = animation.available if is_answered else ()
    drawing = animation.drawing(available)
    first = animation.first
    film = animation.film is not None
    is_told = is_answered or animation.driver in variant.given
    degrees = animation.angles if is_told else np.round(animation.angles - animation.angles[first])
    turned = degrees if film or not is_told else degrees % 360.0
    angles = [f"{localise(significant(a, 5), lang)}°" for a in turned]
    readings = animation.readings if is_answered else ()
    decimals = 2 if is_answered else 1
    data = {
        "tracks": [_numbers(track, decimals) for track in drawing.tracks if track.moves],
        "crank": _crank(animation, drawing, decimals),
        "order": list(animation.order),
        "times": [rounded(float(t), 6) for t in animation.times],
        "seconds": animation.seconds,
        "first": first,
        "angles": angles,
        "film": film,
        "closed": animation.closed,
        "degrees": [rounded(float(a), 4) for a in degrees],
        "readings": [list(reading.values) for reading in readings],
    }
    texts = words(lang)
    return {
        "words": texts,
        "said": texts["motion"],
        "drawing": Markup(_svg(drawing.tracks, drawing.size, first, animation)),
        "effects": [(e, e in animation.effects, COLOURS[e]) for e in available],
        "points": list(animation.points) if is_answered else [],
        "is_answered": is_answered,
        "is_told": is_told,
        "readings": readings,
        "driver": variant.symbol(animation.driver),
        "count": len(animation.angles),
        "first": first,
        "angle": angles[first],
        "start": texts["motion"]["film" if film else "statement"],
        "swings": not animation.turns,
        "turns": localise(significant(float(np.ptp(animation.angles)) / 360.0, 3), lang) if film else "",
        "has_vectors": is_answered and bool(animation.scales),
        "data": in_script(data),
    }


def _crank(animation: Animation, drawing: MovingDrawing, decimals: int) -> dict[str, Any] | None:
    """Return pivot and handle of the driver on paper, by which a figure is dragged."""
    if animation.crank is None:
        return None
    pivot, way = (drawing.on_paper(p) for p in animation.crank)
    return {"pivot": _rounded(pivot, decimals), "rows": [_rounded(row, decimals) for row in way]}


def _rounded(row: np.ndarray, decimals: int) -> list[float]:
    return [rounded(float(x), decimals) for x in row]


def _numbers(track: MotionTrack, decimals: int) -> dict[str, Any]:
    rows = [_rounded(row, decimals) for row in track.numbers]
    return {"mark": bool(track.mark), "closed": track.closed, "rows": rows}


def _svg(tracks: Sequence[MotionTrack], size: tuple[float, float], first: int, animation: Animation) -> str:
    """Return the first instant; what moves is numbered in order, and says what switches it on."""
    width, height = (f"{x:.6g}" for x in size)
    lines, moving = [], 0
    for track in tracks:
        more = ""
        if track.moves:
            more, moving = f' data-track="{moving}"', moving + 1
        on = track.effect in animation.effects
        if track.key:
            more += f' data-key="{track.effect}"' + ("" if on else ' style="opacity:.3"')
        elif track.effect:
            more += f' data-effect="{track.effect}"' + ("" if on else ' style="display:none"')
        if track.is_label:
            more += " data-label"
        if track.point:
            more += f' data-point="{escape(track.point)}"'
        lines.append(track.svg(first, more))
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" '
            f'aria-label="{escape(animation.words)}">',
            f'<rect width="{width}" height="{height}" fill="#fff"/>',
            '<g fill="none" stroke="#000" stroke-linecap="round" stroke-linejoin="round">',
            *lines,
            "</g>",
            "</svg>",
        ]
    )
