"""Base of the kinds whose cases are ticked, on paper that is read back."""

from __future__ import annotations

from collections.abc import Sequence, Set

from coursework.kinds.kind import Asking, Stated, Tick


def lettered_ticks(part: Stated, asking: Asking) -> tuple[Tick, ...]:
    """Return the cases with their letters, in the order printed; by name where the sheet prints no
    letters."""
    letters = asking.letters(part)
    return tuple(Tick(case, letters.get(case, case)) for case in letters or part.choices)


def by_letters(boxes: Sequence[str], part: Stated, asking: Asking) -> str:
    """Ticked cases as students write them: by their letters, or by name where the sheet prints none."""
    letters = asking.letters(part)
    return ", ".join(letters.get(case, case) for case in boxes)


def share_of_named(named: Set[str], right: Set[str], count: int) -> float:
    """Return the share of the points that ``named`` cases earn, of ``count`` cases of which some are
    ``right``.

    Each right case earns its share, each wrong one costs as :func:`cost_of_wrong` says. The share is never
    below 0.
    """
    if not right:
        return 0.0
    cost = cost_of_wrong(len(right), count)
    return max(0.0, len(named & right) / len(right) - cost * len(named - right))


def cost_of_wrong(right: int, count: int) -> float:
    """Return the share that a wrong case costs, of ``count`` cases of which ``right`` are right.

    It is what a right case earns, and so much at least that naming all cases earns nothing.
    """
    return 1 / min(right, max(1, count - right))
