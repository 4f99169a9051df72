r"""Parts of polygons: a driven crank, two bars that meet, a rod and its slider, a slotted guide.

Each gives the sides of a velocity polygon (``_v``) or of an acceleration polygon (``_a``) in order of construction.
Image points have the small letters of their points. Vectors are complex numbers in mm; what a bar's length
and rate are called is told as LaTeX.
"""

from __future__ import annotations

from itertools import chain
from typing import TypeAlias

from coursework.polygons.polygon import Polygon, Side, normal, tangential, turning

Sides: TypeAlias = tuple[Side, ...]


def polygon_of_velocities(*pieces: Sides, scale: float | None = None) -> Polygon:
    return Polygon("velocity", tuple(chain.from_iterable(pieces)), scale)


def polygon_of_accelerations(*pieces: Sides, scale: float | None = None) -> Polygon:
    return Polygon("acceleration", tuple(chain.from_iterable(pieces)), scale)


def crank_v(
    A: str, line: str, vector: complex, omega: float, number: str = "2", length: str = "r_2"
) -> Sides:
    """Return the velocity of a crank of known rate about a fixed point."""
    return (turning("p_v", A.lower(), A, line, vector, omega, rf"{length} \left|\omega_{number}\right|"),)


def crank_a(
    A: str, line: str, vector: complex, omega: float, alpha: float = 0.0, length: str = "r_2"
) -> Sides:
    """Return the acceleration of a crank about a fixed point; a steady one has no tangential part."""
    a = A.lower()
    square, growth = rf"{length}\,\omega_2^2", rf"{length} \left|\alpha_2\right|"
    if not alpha:
        return (Side("p_a", a, rf"\vec{{a}}_{{{A}}}", -(omega**2) * vector, rf"\parallel {line}", square),)
    return (
        normal("p_a", f"{a}'", A, line, vector, omega, square),
        tangential(f"{a}'", a, A, line, vector, alpha, growth),
    )


def two_bars_v(B: str, A: str, C: str, AB: complex, omega: float, CB: complex, omega_C: float) -> Sides:
    """Return the velocities where the bar AB, whose end A is known, meets at B a bar about the fixed point C."""
    a, b = A.lower(), B.lower()
    return (
        turning(a, b, f"{B}/{A}", A + B, AB, omega),
        turning("p_v", b, B, C + B, CB, omega_C),
    )


def two_bars_a(
    B: str, A: str, C: str,
    AB: complex, omega: float, alpha: float, length: str,
    CB: complex, omega_C: float, alpha_C: float, length_C: str,
) -> Sides:  # fmt: skip
    """Return the accelerations of two bars that meet; the velocities give the normal parts."""
    a, b = A.lower(), B.lower()
    return (
        normal(a, f"{b}'", f"{B}/{A}", A + B, AB, omega, rf"V_{{{B}/{A}}}^2 / {length}"),
        normal("p_a", f"{b}''", B, C + B, CB, omega_C, rf"V_{B}^2 / {length_C}"),
        tangential(f"{b}'", b, f"{B}/{A}", A + B, AB, alpha),
        tangential(f"{b}''", b, B, C + B, CB, alpha_C),
        Side("p_a", b, rf"\vec{{a}}_{B}", (1j * alpha_C - omega_C**2) * CB),
    )


def slider_v(B: str, A: str, AB: complex, omega: float, v: complex) -> Sides:
    """Return the velocities of a rod AB, whose end A is known, with a slider at B that moves along x."""
    a, b = A.lower(), B.lower()
    return (
        turning(a, b, f"{B}/{A}", A + B, AB, omega),
        Side("p_v", b, rf"\vec{{V}}_{B}", v, r"\parallel Ox", way=1),
    )


def slider_a(
    B: str, A: str, AB: complex, omega: float, alpha: float, length: str, acceleration: complex
) -> Sides:
    a, b = A.lower(), B.lower()
    return (
        normal(a, f"{b}'", f"{B}/{A}", A + B, AB, omega, rf"V_{{{B}/{A}}}^2 / {length}"),
        tangential(f"{b}'", b, f"{B}/{A}", A + B, AB, alpha),
        Side("p_a", b, rf"\vec{{a}}_{B}", acceleration, r"\parallel Ox", way=1),
    )


def guide_v(A: str, of_guide: str, line: str, vector: complex, omega: float, sliding: float) -> Sides:
    """Return the velocities of a guide about a fixed point, and of the block A that slides on it.

    ``vector`` leads from the guide's pivot to A; ``sliding`` is positive away from it. ``of_guide`` is the
    guide's own point at A.
    """
    a, names = A.lower(), of_guide.lower()
    along = vector / abs(vector)
    return (
        turning("p_v", names, of_guide, line, vector, omega),
        Side(names, a, rf"\vec{{V}}_{{{A}/{of_guide}}}", sliding * along, rf"\parallel {line}", way=along),
    )


def guide_a(
    A: str, of_guide: str, line: str,
    vector: complex, omega: float, alpha: float, sliding: float, gain: float,
    length: str, rate: str,
) -> Sides:  # fmt: skip
    """Return the accelerations of a guide and its block. The Coriolis term is laid off back from the image of
    A; ``gain`` is the rate of ``sliding``."""
    a, names = A.lower(), of_guide.lower()
    along = vector / abs(vector)
    slide = f"{A}/{of_guide}"
    return (
        Side(
            "k", a, rf"\vec{{a}}^c_{{{slide}}}", 2j * omega * sliding * along, rf"\perp {line}",
            rf"2 \left|{rate}\right| V_{{{slide}}}", 1j * along,
        ),
        normal("p_a", f"{names}'", of_guide, line, vector, omega, rf"V_{{{of_guide}}}^2 / {length}"),
        tangential(f"{names}'", names, of_guide, line, vector, alpha),
        Side(names, "k", rf"\vec{{a}}^s_{{{slide}}}", gain * along, rf"\parallel {line}", way=along),
    )  # fmt: skip
