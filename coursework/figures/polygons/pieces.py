r"""Parts of polygons: a driven crank, two bars that meet, a rod and its slider, a slotted guide.

Each gives the sides of a velocity polygon (``_v``) or of an acceleration polygon (``_a``) in order of
construction. Image points have the small letters of their points. Vectors are complex numbers in mm; what a
bar's length and rate are called is given as LaTeX.
"""

from __future__ import annotations

from itertools import chain
from typing import TypeAlias

from coursework.figures.polygons.polygon import Polygon, Side, normal, tangential, turning

Sides: TypeAlias = tuple[Side, ...]


def polygon_of_velocities(*pieces: Sides, scale: float | None = None) -> Polygon:
    """Return the velocity polygon of some pieces.

    Parameters
    ----------
    pieces
        Sides of each, in the order of the construction.
    scale
        mm/s for a mm on paper, where the exercise gives it.

    Returns
    -------
    The polygon.

    Raises
    ------
    BadCourse
        The sides make no polygon: see :class:`~coursework.figures.polygons.polygon.Polygon`.
    """
    return Polygon("velocity", tuple(chain.from_iterable(pieces)), scale)


def polygon_of_accelerations(*pieces: Sides, scale: float | None = None) -> Polygon:
    """Return the acceleration polygon of some pieces.

    Parameters
    ----------
    pieces
        Sides of each, in the order of the construction.
    scale
        mm/s^2 for a mm on paper, where the exercise gives it.

    Returns
    -------
    The polygon.

    Raises
    ------
    BadCourse
        The sides make no polygon: see :class:`~coursework.figures.polygons.polygon.Polygon`.
    """
    return Polygon("acceleration", tuple(chain.from_iterable(pieces)), scale)


def crank_v(
    A: str, line: str, vector: complex, omega: float, number: str = "2", length: str = "r_2"
) -> Sides:
    """Return the velocity of a crank of known rate about a fixed point.

    Parameters
    ----------
    A
        Name of the crank's end.
    line
        Name of the crank, such as ``OA``.
    vector
        Vector from the fixed point to A, complex, mm.
    omega
        Rate of the crank, rad/s.
    number
        Index of the rate in the printed length.
    length
        LaTeX of the crank's length.

    Returns
    -------
    One side, mm/s.

    Source
    ------
    ``i omega vector``.
    """
    return (turning("p_v", A.lower(), A, line, vector, omega, rf"{length} \left|\omega_{number}\right|"),)


def crank_a(
    A: str, line: str, vector: complex, omega: float, alpha: float = 0.0, length: str = "r_2"
) -> Sides:
    """Return the acceleration of a crank about a fixed point; a steady one has no tangential part.

    Parameters
    ----------
    A
        Name of the crank's end.
    line
        Name of the crank, such as ``OA``.
    vector
        Vector from the fixed point to A, complex, mm.
    omega, alpha
        Rate, rad/s, and angular acceleration, rad/s^2, of the crank.
    length
        LaTeX of the crank's length.

    Returns
    -------
    One side of a steady crank, otherwise the normal and the tangential one, mm/s^2.

    Source
    ------
    ``-omega^2 vector`` and ``i alpha vector``.
    """
    a = A.lower()
    square, growth = rf"{length}\,\omega_2^2", rf"{length} \left|\alpha_2\right|"
    if not alpha:
        return (Side("p_a", a, rf"\vec{{a}}_{{{A}}}", -(omega**2) * vector, rf"\parallel {line}", square),)
    return (
        normal("p_a", f"{a}'", A, line, vector, omega, square),
        tangential(f"{a}'", a, A, line, vector, alpha, growth),
    )


def two_bars_v(B: str, A: str, C: str, AB: complex, omega: float, CB: complex, omega_C: float) -> Sides:
    """Return the velocities where the bar AB, whose end A is known, meets at B a bar about the fixed point C.

    Parameters
    ----------
    B, A, C
        Names of the joint, of the known end and of the fixed point.
    AB, CB
        Vectors of the bars, to B, complex, mm.
    omega, omega_C
        Rates of the bars AB and CB, rad/s.

    Returns
    -------
    Two sides, mm/s: the velocity of B relative to A, and that of B.

    Source
    ------
    ``i omega AB`` and ``i omega_C CB``.
    """
    a, b = A.lower(), B.lower()
    return (turning(a, b, f"{B}/{A}", A + B, AB, omega), turning("p_v", b, B, C + B, CB, omega_C))


def two_bars_a(
    B: str,
    A: str,
    C: str,
    AB: complex,
    omega: float,
    alpha: float,
    length: str,
    CB: complex,
    omega_C: float,
    alpha_C: float,
    length_C: str,
) -> Sides:
    """Return the accelerations of two bars that meet; the velocities give the normal parts.

    Parameters
    ----------
    B, A, C
        Names of the joint, of the known end and of the fixed point.
    AB, CB
        Vectors of the bars, to B, complex, mm.
    omega, omega_C
        Rates of the bars AB and CB, rad/s.
    alpha, alpha_C
        Their angular accelerations, rad/s^2.
    length, length_C
        LaTeX of their lengths.

    Returns
    -------
    Five sides, mm/s^2: the normal parts, the tangential parts, and the acceleration of B.

    Source
    ------
    ``(i alpha - omega^2) AB`` and ``(i alpha_C - omega_C^2) CB``, normal and tangential parts apart.
    """
    a, b = A.lower(), B.lower()
    return (
        normal(a, f"{b}'", f"{B}/{A}", A + B, AB, omega, rf"V_{{{B}/{A}}}^2 / {length}"),
        normal("p_a", f"{b}''", B, C + B, CB, omega_C, rf"V_{B}^2 / {length_C}"),
        tangential(f"{b}'", b, f"{B}/{A}", A + B, AB, alpha),
        tangential(f"{b}''", b, B, C + B, CB, alpha_C),
        Side("p_a", b, rf"\vec{{a}}_{B}", (1j * alpha_C - omega_C**2) * CB),
    )


def slider_v(B: str, A: str, AB: complex, omega: float, v: complex) -> Sides:
    """Return the velocities of a rod AB, whose end A is known, with a slider at B that moves along x.

    Parameters
    ----------
    B, A
        Names of the slider and of the known end.
    AB
        Vector of the rod, complex, mm.
    omega
        Rate of the rod, rad/s.
    v
        Velocity of the slider, mm/s.

    Returns
    -------
    Two sides, mm/s: the velocity of B relative to A, and that of B.

    Source
    ------
    ``i omega AB``.
    """
    a, b = A.lower(), B.lower()
    return (
        turning(a, b, f"{B}/{A}", A + B, AB, omega),
        Side("p_v", b, rf"\vec{{V}}_{B}", v, r"\parallel Ox", way=1),
    )


def slider_a(
    B: str, A: str, AB: complex, omega: float, alpha: float, length: str, acceleration: complex
) -> Sides:
    """Return the accelerations of a rod AB, whose end A is known, with a slider at B that moves along x.

    Parameters
    ----------
    B, A
        Names of the slider and of the known end.
    AB
        Vector of the rod, complex, mm.
    omega, alpha
        Rate, rad/s, and angular acceleration, rad/s^2, of the rod.
    length
        LaTeX of its length.
    acceleration
        Acceleration of the slider, mm/s^2.

    Returns
    -------
    Three sides, mm/s^2: the normal and the tangential part of B relative to A, and the acceleration of B.

    Source
    ------
    ``-omega^2 AB`` and ``i alpha AB``.
    """
    a, b = A.lower(), B.lower()
    return (
        normal(a, f"{b}'", f"{B}/{A}", A + B, AB, omega, rf"V_{{{B}/{A}}}^2 / {length}"),
        tangential(f"{b}'", b, f"{B}/{A}", A + B, AB, alpha),
        Side("p_a", b, rf"\vec{{a}}_{B}", acceleration, r"\parallel Ox", way=1),
    )


def guide_v(A: str, of_guide: str, line: str, vector: complex, omega: float, sliding: float) -> Sides:
    """Return the velocities of a guide about a fixed point, and of the block A that slides on it.

    Parameters
    ----------
    A, of_guide
        Names of the block, and of the guide's own point there.
    line
        Name of the guide.
    vector
        Vector from the guide's pivot to A, complex, mm.
    omega
        Rate of the guide, rad/s.
    sliding
        Velocity of the block along the guide, mm/s, positive away from the pivot.

    Returns
    -------
    Two sides, mm/s: the velocity of the guide's point, and that of A relative to it.

    Source
    ------
    ``i omega vector`` and ``sliding u``, with u the unit vector of ``vector``.
    """
    a, names = A.lower(), of_guide.lower()
    along = vector / abs(vector)
    return (
        turning("p_v", names, of_guide, line, vector, omega),
        Side(names, a, rf"\vec{{V}}_{{{A}/{of_guide}}}", sliding * along, rf"\parallel {line}", way=along),
    )


def guide_a(
    A: str,
    of_guide: str,
    line: str,
    vector: complex,
    omega: float,
    alpha: float,
    sliding: float,
    gain: float,
    length: str,
    rate: str,
) -> Sides:
    """Return the accelerations of a guide and its block. The Coriolis term is laid off back from the image of
    A.

    Parameters
    ----------
    A, of_guide
        Names of the block, and of the guide's own point there.
    line
        Name of the guide.
    vector
        Vector from the guide's pivot to A, complex, mm.
    omega, alpha
        Rate, rad/s, and angular acceleration, rad/s^2, of the guide.
    sliding, gain
        Velocity of the block along the guide, mm/s, positive away from the pivot, and its rate, mm/s^2.
    length, rate
        LaTeX of the length of ``vector``, and of the guide's rate.

    Returns
    -------
    Four sides, mm/s^2: the Coriolis term, the normal and the tangential part of the guide's point, and the
    sliding part.

    Source
    ------
    ``2 i omega sliding u``, ``-omega^2 vector``, ``i alpha vector`` and ``gain u``, with u the unit vector of
    ``vector``.
    """
    a, names = A.lower(), of_guide.lower()
    along = vector / abs(vector)
    slide = f"{A}/{of_guide}"
    return (
        Side(
            "k",
            a,
            rf"\vec{{a}}^c_{{{slide}}}",
            2j * omega * sliding * along,
            rf"\perp {line}",
            rf"2 \left|{rate}\right| V_{{{slide}}}",
            1j * along,
        ),
        normal("p_a", f"{names}'", of_guide, line, vector, omega, rf"V_{{{of_guide}}}^2 / {length}"),
        tangential(f"{names}'", names, of_guide, line, vector, alpha),
        Side(names, "k", rf"\vec{{a}}^s_{{{slide}}}", gain * along, rf"\parallel {line}", way=along),
    )
