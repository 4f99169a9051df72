"""What kinds whose cases are ticked have in common, on paper that is read back."""

from __future__ import annotations

from collections.abc import Sequence

from coursework.kinds.kind import Asking, Stated, Tick


def lettered_ticks(part: Stated, asking: Asking) -> tuple[Tick, ...]:
    """The cases with their letters, in the order printed; by name where the sheet prints no letters."""
    letters = asking.letters(part)
    return tuple(Tick(case, letters.get(case, case)) for case in letters or part.choices)


def by_letters(found: Sequence[str], part: Stated, asking: Asking) -> str:
    """Ticked cases as students write them: by their letters, or by name where the sheet prints none."""
    letters = asking.letters(part)
    return ", ".join(letters.get(case, case) for case in found)
