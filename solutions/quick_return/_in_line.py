"""An offset slider-crank in the two positions where its piston turns back."""

from coursework.degrees import atan2, polar
from coursework.figures import (
    Figure,
    centre_line,
    circle,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rotation_arrow,
)


def _in_line(r2, e, x1, x2, anticlockwise):
    """The two positions in line, at the abscissas x1 (folded) and x2 (stretched), and the crank's longer
    arc."""
    C1, C2 = complex(x1, e), complex(x2, e)
    folded, stretched = atan2(e, x1) + 180, atan2(e, x2)
    A1, A2 = polar(r2, folded), polar(r2, stretched)
    longer = (stretched, folded) if e >= 0 else (folded, stretched + 360)
    start, end = longer if anticlockwise else longer[::-1]
    return Figure(
        circle(0j, r2, dashed=True),
        line(C1, C2, dashed=True),
        centre_line(0j, x2, label="x"),
        link(A1, C1),
        link(0j, A2),
        link(A2, C2),
        rotation_arrow(0j, 0.6 * r2, start, end, label=r"\theta_a"),
        ground_pivot(0j, "O"),
        pin(A1, "A_1"),
        pin(A2, "A_2"),
        point(C1, "C_1"),
        point(C2, "C_2"),
    )
