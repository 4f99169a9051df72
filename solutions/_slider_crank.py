"""What slider-cranks have in common: the polygons of a crank OA, a rod AB and a piston on a line along x."""

from coursework.degrees import polar
from coursework.polygons import Polygon, Side, normal, tangential, turning


def _velocities(r2, theta2, omega2, rod, omega3, v, end="B", scale=None):
    """The piston ``end`` goes along its line, and about A as the rod turns; ``rod`` is the rod's vector."""
    image = end.lower()
    return Polygon(
        "velocity",
        (
            turning("p_v", "a", "A", "OA", polar(r2, theta2), omega2, r"r_2 \left|\omega_2\right|"),
            turning("a", image, f"{end}/A", f"A{end}", rod, omega3),
            Side("p_v", image, rf"\vec{{V}}_{end}", v, r"\parallel Ox", way=1),
        ),
        scale,
    )


def _accelerations(r2, theta2, omega2, alpha2, rod, omega3, alpha3, a, scale=None):
    """The same of their accelerations; the crank's tangential term stands only where it does not turn steadily."""
    crank = polar(r2, theta2)
    square = r"r_2\,\omega_2^2"
    steady = (Side("p_a", "a", r"\vec{a}_A", -(omega2**2) * crank, r"\parallel AO", square),)
    driven = (
        normal("p_a", "a'", "A", "AO", crank, omega2, square),
        tangential("a'", "a", "A", "OA", crank, alpha2, r"r_2 \left|\alpha_2\right|"),
    )
    return Polygon(
        "acceleration",
        (
            *(driven if alpha2 else steady),
            normal("a", "b'", "B/A", "BA", rod, omega3, "V_{B/A}^2 / r_3"),
            tangential("b'", "b", "B/A", "AB", rod, alpha3),
            Side("p_a", "b", r"\vec{a}_B", a, r"\parallel Ox", way=1),
        ),
        scale,
    )
