"""SVG of a moving figure, without scripts: in motion, or still at one instant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from coursework.figures.moving import MotionTrack, MovingDrawing


def moving_svg(
    displayed: MovingDrawing,
    *,
    order: Sequence[int],
    first: int,
    seconds: float,
    title: str,
    words: str,
    lang: str,
    times: str = "",
) -> str:
    """Return the drawing in motion as SVG; it stands still for readers who prefer reduced motion.

    Parameters
    ----------
    shown
        The drawing at every instant.
    order
        The instants in the order in which they are shown; the last is the first again where the motion goes
        round.
    first
        The instant shown where nothing moves.
    seconds
        How long one round lasts.
    title, words, lang
        What it is called, what it shows, and the language of both, for who does not see it.
    times
        ``keyTimes`` of the order, where instants are not evenly spread.
    """
    lines = []
    for track in displayed.tracks:
        if not track.moves:
            lines.append(track.svg(first))
            continue
        moved = _animate(track, order, times, seconds)
        lines.append(track.svg(first, ' class="coursework-still"'))
        lines.append(track.svg(first, ' class="coursework-moving"', moved))
    style = (
        "<style>.coursework-still{display:none}@media (prefers-reduced-motion:reduce)"
        "{.coursework-still{display:inline}.coursework-moving{display:none}}</style>"
    )
    return _document(displayed, lines, title, words, lang, style)


_FEW_LABELS = 5  #: of a still that has room for them


def still_svgs(displayed: MovingDrawing, *, title: str, words: str, lang: str) -> tuple[str, ...]:
    """Return the drawing at each of its few instants as SVG; only the first has the legend and, where labels
    would crowd, the labels."""
    everything = displayed.tracks
    drawn = [track for track in everything if not track.key]
    bare = [track for track in drawn if not track.is_label]
    others = drawn if len(drawn) - len(bare) <= _FEW_LABELS else bare
    return tuple(
        _document(displayed, (t.svg(k) for t in (others if k else everything)), title, words, lang)
        for k in range(len(everything[0].numbers))
    )


def _document(
    displayed: MovingDrawing, lines: Iterable[str], title: str, words: str, lang: str, style: str = ""
) -> str:
    width, height = (f"{x:.6g}" for x in displayed.size)
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}" role="img" lang="{lang}">',
            f"<title>{escape(title)}</title>",
            f"<desc>{escape(words)}</desc>",
            *filter(None, [style]),
            f'<rect width="{width}" height="{height}" fill="#fff"/>',
            '<g fill="none" stroke="#000" stroke-linecap="round" stroke-linejoin="round">',
            *lines,
            "</g>",
            "</svg>\n",
        ]
    )


def _animate(track: MotionTrack, order: Sequence[int], times: str, seconds: float) -> str:
    values = ";".join(track.value(k) for k in order)
    timing = f' keyTimes="{times}"' if times else ""
    loop = f'dur="{seconds:g}s" repeatCount="indefinite"{timing} values="{values}"'
    if track.mark:
        return f'<animateTransform attributeName="transform" type="translate" {loop}/>'
    return f'<animate attributeName="d" {loop}/>'
