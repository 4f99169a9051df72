"""What pivots of a linkage are worth whose coupler is to pass through given positions."""

import numpy as np

from coursework.solution import Judged

PIVOTS = ("x_O", "y_O", "x_C", "y_C")
MARGIN_MM = 1.0
FARTHEST_MM = 10_000.0  #: of a pivot: from afar all places look equally far


def on_circle(pivot, ends):
    """Whether a pivot is as far from all places of an end."""
    distances = np.stack(np.broadcast_arrays(*(abs(end - pivot) for end in ends)))
    return (distances.max(axis=0) <= FARTHEST_MM) & (np.ptp(distances, axis=0) <= MARGIN_MM)


def of_placement(O, C, positions):
    """Names of mistakes about where the pivots are, and whether each is made; ``positions`` are pairs A,
    B."""
    ends_A, ends_B = zip(*positions, strict=True)
    off = ~(on_circle(O, ends_A) & on_circle(C, ends_B))
    return {"pivots_exchanged": off & on_circle(C, ends_A) & on_circle(O, ends_B), "off_the_bisectors": off}


def judged_lengths(answers, O, C, positions, is_wrong):
    """A verdict for each length, from the student's own pivots."""
    ends_A, ends_B = zip(*positions, strict=True)
    said = {}
    for length, pivot, ends in (("r2", O, ends_A), ("r4", C, ends_B)):
        if length in answers:
            right = any(abs(float(answers[length]) - abs(end - pivot)) <= MARGIN_MM for end in ends)
            said[length] = Judged(follows=is_wrong) if right else Judged(0.0, "length_elsewhere")
    return said


def pivots_of(answers):
    """O and C as answered, or none."""
    if not all(name in answers for name in PIVOTS):
        return None
    x_O, y_O, x_C, y_C = (float(answers[name]) for name in PIVOTS)
    return complex(x_O, y_O), complex(x_C, y_C)
