"""Numerical ranks: a rank is right, or an error is raised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coursework.errors import CannotTell
from coursework.messages import Message

ZERO = 1e-11  #: what rounding leaves of a zero, relative to the largest; with it, what is smaller
DISTINCT = 1e-7  #: what surely is not zero; two axes 1e-4 apart stay well above it


@dataclass(frozen=True)
class Rank:
    """Rank with its evidence: the singular values on either side of the cut, relative to the largest."""

    value: int
    smallest_kept: float  #: 1 where there is nothing to keep
    largest_dropped: float  #: 0 where nothing was dropped

    @property
    def gap(self) -> float:
        """Ratio of the smallest singular value kept to the largest dropped; infinite where the dropped one is
        exactly zero."""
        return self.smallest_kept / self.largest_dropped if self.largest_dropped else float("inf")


def is_zero(value: float, subject: str) -> bool:
    """Return whether a number that is either 0 or of order 1 is 0.

    Parameters
    ----------
    value
        The number, without unit.
    subject
        The statement that holds for 0, for the message.

    Returns
    -------
    True or False.

    Raises
    ------
    CannotTell
        It lies between what rounding leaves and what is surely meant.
    """
    size = abs(value)
    if ZERO < size < DISTINCT:
        raise CannotTell(
            "cannot tell whether {subject}: it is off by {size:.2g} of the whole, less than "
            "{distinct:g}, which would be meant, and more than {zero:g}, which would be rounding",
            subject=Message(subject),
            size=size,
            distinct=DISTINCT,
            zero=ZERO,
        )
    return size <= ZERO


def decompose(
    rows: np.ndarray, subject: str, scale: float | None = None
) -> tuple[Rank, np.ndarray, np.ndarray]:
    """Return the rank of some rows, and orthonormal bases of what they span and of what is perpendicular to
    it.

    Parameters
    ----------
    rows
        Rows in one unit, shape ``(k, d)``.
    subject
        What the rows are, for the message.
    scale
        Number in the unit of the rows by which singular values are counted; by default the largest of them.

    Returns
    -------
    The rank, and the bases of shapes ``(rank, d)`` and ``(d - rank, d)``.

    Raises
    ------
    CannotTell
        Some singular value is neither zero nor distinct from it; the message gives it.
    """
    count, width = rows.shape
    if not count or not width:
        return Rank(0, 1.0, 0.0), np.zeros((0, width)), np.eye(width)
    _, sizes, directions = np.linalg.svd(rows)
    full = (float(sizes[0]) or 1.0) if scale is None else scale
    relative = sizes / full
    doubtful = relative[(relative > ZERO) & (relative < DISTINCT)]
    if len(doubtful):
        raise CannotTell(
            "cannot tell the rank of {subject}: a singular value is {size:.2g} of the largest, neither "
            "a zero (below {zero:g}) nor distinct from it (above {distinct:g}); are two axes meant to "
            "be parallel, or two points to coincide?",
            subject=Message(subject),
            size=doubtful[0],
            zero=ZERO,
            distinct=DISTINCT,
        )
    rank = int((relative > ZERO).sum())
    stored = float(relative[rank - 1]) if rank else 1.0
    dropped = float(relative[rank]) if rank < len(relative) else 0.0
    return Rank(rank, stored, dropped), directions[:rank], directions[rank:]


def rank_of(matrix: np.ndarray, subject: str = "the system") -> Rank:
    """Return the rank of a matrix whose columns are scaled to the same length first.

    Parameters
    ----------
    matrix
        Two-dimensional array, each column in a unit of its own.
    subject
        What the matrix is, for the message.

    Returns
    -------
    The rank with its evidence; 0 for an empty matrix.

    Raises
    ------
    CannotTell
        As :func:`decompose`.
    """
    matrix = np.asarray(matrix, dtype=float)
    if not matrix.size:
        return Rank(0, 1.0, 0.0)
    sizes = np.linalg.norm(matrix, axis=0)
    return decompose((matrix / np.where(sizes > 0, sizes, 1.0)).T, subject)[0]
