"""Crossings of drawn lines, counted without the package's own geometry."""

from itertools import combinations

import numpy as np


def crossings(lines, least=1e-6):
    """How many pairs of lines cross, of those whose ends are not nearer to each other than ``least``, mm."""
    return sum(
        _cross(one, other)
        for one, other in combinations(lines, 2)
        if min(abs(p - q) for p in one for q in other) > least
    )


def _cross(one, other):
    """Whether they meet between their ends: where ``p + s (q - p) = r + t (u - r)``."""
    (p, q), (r, u) = one, other
    ways = np.array([[(q - p).real, (r - u).real], [(q - p).imag, (r - u).imag]])
    if abs(np.linalg.det(ways)) < 1e-9:
        return False
    return all(1e-6 < along < 1 - 1e-6 for along in np.linalg.solve(ways, [(r - p).real, (r - p).imag]))
