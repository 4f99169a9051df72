"""Figures of mechanisms, to scale: one description, printed as SVG, PNG, PDF or outlined SVG.

A figure is a list of elements in the mechanism's own coordinates: points are complex
numbers in mm, y up; angles are degrees from +x, counter-clockwise::

    from coursework.figures import Figure, angle_mark, ground_pivot, link, pin

    A, B, C = 35 + 60.6j, 205 + 119.9j, 200
    figure = Figure(
        link(0, A, label="r_2"), link(A, B, label="r_3"), link(C, B, label="r_4"),
        ground_pivot(0, "O"), ground_pivot(C, "C"), pin(A, "A"), pin(B, "B"),
        angle_mark(0, 0, 60, r"\\theta_2"),
    )
    figure.svg(), figure.outlined_svg(), figure.png(ppi=200), figure.pdf()
    figure.scale, figure.size_mm, figure.labels()

The drawing is scaled to the largest size whose frame, labels included, fits ``paper_mm`` (by default 110 by
75 mm), with one scale for x and y; a sheet lays it out again for the room it has, ``figure.fitted(112, 62)``.
``Figure(..., scale=1)`` has that scale instead, and ``figure.beginning(n)`` is its first n elements in the
same frame. Symbols (pins, hatching, blocks, arrow heads, letters) keep their size on paper. Mechanism points
are printed to 0.1 mm and directions of symbols to a whole degree: the file says no more than a ruler and a
protractor.

**Joints.** ``ground_pivot(p, label)`` a pin on a hatched support, which turns away from the
links; ``pin(p, label)`` a moving pin; ``point(p, label)`` a dot; ``contact(p, label)`` a larger
dot where two bodies touch. All four take ``toward=`` (degrees), the side of the point on which
the label would rather be; by default it goes where the links leave most room.

**Links.** ``link(p, q, label=)`` a bar; ``link(p, q, r, ..., label=)`` a tinted plate;
``link(p, q, r, weld=True)`` one bent bar, gussets at its corners; ``slot_link(p, q, label)`` a
slotted guide; ``slider(p, direction, label)`` a block (add a ``pin`` on it where a bar
ends); ``rail(p, q)`` the guide of a block whose centre moves from p to q, below the block when
p→q goes to the right, above it when to the left; ``wheel(center, radius, label)`` a wheel, beneath the rest;
``profile(points, label)`` a body of any closed outline, such as a cam.

**Lines.** ``line(p, q, dashed=False, thin=True, label=)``; ``circle(center, radius, dashed=, label=)``;
``arc(center, radius, from_deg, to_deg, dashed=)``; ``centre_line(p, q, label)`` chain-dotted, label
beyond q; ``trace(points, dotted=True)`` a path, or another curve.

**Marks.** ``axes(origin, length, labels=("x", "y"))``; ``vector(p, v, label)`` an arrow from p
to p + v; ``dimension(p, q, label, offset=)``, offset in mm of mechanism, positive on the left of p→q,
by default 7 mm on paper or as far as it must to miss the links; ``angle_mark(center, from_deg, to_deg, label,
radius=)`` and ``rotation_arrow(center, radius, from_deg, to_deg, label)``, whose heads are at
``to_deg``, so clockwise when it is the smaller; ``note(p, words)`` words on a point;
``scale_bar(p, length, label)`` what a length of paper stands for.

**Sections.** ``section(points, label, angle=45)`` a cut body, hatched, its label in a gap of the
hatching (use ``angle=-45`` for its neighbour); ``ball(center, radius, label)`` a tinted circle.

**Drawn machines.** ``shape(points, shade, closed=True, thin=False)`` a part of any outline and
  ``disc(center, radius, shade)`` a round one, each on those before it; shades are ``none``, ``white``,
  ``light``, ``mid``, ``dark``, ``black`` and ``glass``.

**Labels** are symbols in a small LaTeX (``r_1``, ``O_4``, ``\\theta_2``, ``\\dot{\\psi}``, ``R+r``), set
in italics, or plain words (anything with a space, or three letters and more), set upright.
Each is placed by itself near what it names, on no line and on no other label; one that finds
room only farther away gets a thin leader. The same figure always gives the same bytes.

Errors: WrongValue names the element whose point is not finite or whose length is not positive, and refuses a
figure without extent and a label that is not a formula of letters, indices and accents.
"""

from coursework.figures.base import Element
from coursework.figures.elements import (
    ball,
    bar,
    contact,
    disc,
    ground_pivot,
    link,
    pin,
    point,
    profile,
    rail,
    section,
    shape,
    slider,
    slot_link,
    wheel,
)
from coursework.figures.figure import Beginning, Figure, LabelBox
from coursework.figures.marks import (
    angle_mark,
    arc,
    axes,
    centre_line,
    circle,
    dimension,
    line,
    note,
    rotation_arrow,
    scale_bar,
    trace,
    vector,
)
from coursework.figures.picture import Picture

__all__ = [
    "Beginning",
    "Element",
    "Figure",
    "LabelBox",
    "Picture",
    "angle_mark",
    "arc",
    "axes",
    "ball",
    "bar",
    "centre_line",
    "circle",
    "contact",
    "dimension",
    "disc",
    "ground_pivot",
    "line",
    "link",
    "note",
    "pin",
    "point",
    "profile",
    "rail",
    "rotation_arrow",
    "scale_bar",
    "section",
    "shape",
    "slider",
    "slot_link",
    "trace",
    "vector",
    "wheel",
]
