"""Display of a notebook cell: Markdown and pictures in a notebook, plain text elsewhere."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from html import escape
from typing import Any

from coursework.language.words import words
from coursework.markup.markdown import to_notebook_markdown, to_text


@dataclass(frozen=True)
class SvgPicture:
    """SVG drawing with its description for readers who cannot see it.

    ``page``: a web page that shows the same and more, under a line ``opens``; front ends that trust no
    notebook leave it out. ``caption``: what stands below it, in the Markdown of statements.
    """

    svg: str
    said: str
    page: str = ""
    opens: str = ""
    caption: str = ""

    @property
    def html(self) -> str:
        """HTML image of the drawing, which front ends show in untrusted notebooks too."""
        data = base64.b64encode(self.svg.encode()).decode()
        image = f'<img src="data:image/svg+xml;base64,{data}" alt="{escape(self.said)}">'
        if not self.page:
            return image
        frame = (
            f'<iframe srcdoc="{escape(self.page)}" title="{escape(self.said)}" loading="lazy" width="100%" '
            'height="640"></iframe>'
        )
        return f"{image}<details><summary>{escape(self.opens)}</summary>{frame}</details>"


class NotebookDisplay:
    """Pieces of an answer in order: texts in the Markdown of statements, and pictures.

    The last line of a notebook cell displays it piece by piece, since some front ends set no formulas inside
    HTML. ``str()`` gives plain text.
    """

    def __init__(self, lang: str, *pieces: str | SvgPicture):
        self.lang = lang
        self.pieces = tuple(p for p in pieces if p)

    @property
    def markdown(self) -> str:
        """Markdown of the texts for a notebook, without the pictures."""
        texts = (p for p in self.pieces if isinstance(p, str))
        return "\n\n".join(to_notebook_markdown(text, self.lang) for text in texts)

    def __str__(self) -> str:
        return "\n\n".join(self._plain(piece) for piece in self.pieces)

    __repr__ = __str__

    def _plain(self, piece: str | SvgPicture) -> str:
        if isinstance(piece, str):
            return to_text(piece, self.lang)
        texts = words(self.lang)["sheet"]
        return f"[{texts['figure']}{texts['colon']} {piece.said}]"

    def bundles(self) -> list[dict[str, str]]:
        """Return each piece by MIME type."""
        out = []
        for piece in self.pieces:
            bundle = {"text/plain": self._plain(piece)}
            if isinstance(piece, str):
                bundle["text/markdown"] = to_notebook_markdown(piece, self.lang)
            else:
                bundle["text/html"] = piece.html
            out.append(bundle)
            if isinstance(piece, SvgPicture) and piece.caption:
                out += NotebookDisplay(self.lang, f"*{piece.caption}*").bundles()
        return out

    def _ipython_display_(self) -> None:
        from IPython.display import display

        for bundle in self.bundles():
            display(bundle, raw=True)

    def _repr_markdown_(self) -> str:
        return self.markdown

    def __add__(self, other: Any) -> NotebookDisplay:
        if not isinstance(other, NotebookDisplay):
            return NotImplemented
        return NotebookDisplay(self.lang, *self.pieces, *other.pieces)
