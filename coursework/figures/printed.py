"""Drawings of a size on paper, as PNG and as PDF."""

from __future__ import annotations


class Printed:
    """Drawing of a size on paper."""

    @property
    def size_mm(self) -> tuple[float, float]:
        """Width and height on paper."""
        raise NotImplementedError

    def svg(self) -> str:
        """Return the drawing as SVG of its size in mm, labels as text."""
        raise NotImplementedError

    def png(self, ppi: float = 200) -> bytes:
        """Return the drawing as PNG, ``ppi`` pixels an inch."""
        from coursework.figures.typesetting import converted

        return converted(self.svg(), self.size_mm[0], "png", ppi)

    def pdf(self) -> bytes:
        """Return the drawing as one PDF page of its own size."""
        from coursework.figures.typesetting import converted

        return converted(self.svg(), self.size_mm[0], "pdf")
