"""Which variants are worth issuing: those on which an honest student and a known mistake can be told apart.

A variant is *ill-conditioned* where rounding alone may cost a student an answer, and *murky* where a known
mistake moves an answer too little to be told from a right one and too much to be let pass. A seed draws the
same variant for everybody; who issues variants passes such seeds over.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from functools import lru_cache

from coursework.comparing import distance
from coursework.course import CourseExercise, Variant
from coursework.errors import CourseworkError
from coursework.expressions import parse_equation
from coursework.key import Key, exists, ill_limit, keys_of
from coursework.model import Part

SHOWN = 2.0  #: half-widths beyond which a mistake must be recognised
HIDDEN = 0.25  #: half-widths within which nothing can tell it

ILL, MURKY, UNSOLVED = "ill-conditioned", "murky", "unsolved"


def visibility(key: Key, mistake: str) -> Iterator[tuple[Part, str]]:
    """For each part that a mistake reaches: ``shown``, ``murky`` or ``hidden``."""
    values = key.wrong[mistake]
    for part in key.variant.parts:
        wrong = values.get(part.quantity)
        if wrong is None or not exists(wrong):
            continue
        along, width = key.reference.get(part.along), key.envelope.get(part.quantity, 0.0)
        reference = key.reference[part.quantity]
        if part.kind == "equation":
            gap = _equation_gap(part, wrong, reference)
        else:
            gap = distance(part, wrong, reference, along, width)
        yield part, "shown" if gap > SHOWN else "hidden" if gap <= HIDDEN else "murky"


@lru_cache(maxsize=1024)
def _equation_gap(part: Part, wrong: str, reference: str) -> float:
    """Equations are the same for every variant, and dear to compare."""
    return distance(part, parse_equation(wrong, part.variables), reference)


def conditioning(key: Key) -> float:
    """The widest envelope of a variant's answers, in what a variant may have at most."""
    shares = [
        key.envelope.get(part.quantity, 0.0) / limit
        for part in key.variant.parts
        if not part.is_exact and (limit := ill_limit(part, key.reference[part.quantity])) > 0
    ]
    return max(shares, default=0.0)


def flaws(key: Key) -> Iterator[str]:
    """Why a variant is not worth issuing: ``ill-conditioned: PART``, ``murky: MISTAKE on PART``."""
    try:
        reference = key.reference
    except CourseworkError as fault:
        yield f"{UNSOLVED}: {fault}"
        return
    for part in key.variant.parts:
        if not part.is_exact and key.envelope.get(part.quantity, 0.0) > ill_limit(
            part, reference[part.quantity]
        ):
            yield f"{ILL}: {part.id}"
    for name, mistake in key.solution.mistakes.items():
        if not mistake.approximation:
            for part, seen in visibility(key, name):
                if seen == "murky":
                    yield f"{MURKY}: {name} on {part.id}"


def worthy(
    exercise: CourseExercise, variants: Sequence[Variant], refused: Counter[str] | None = None
) -> list[Variant]:
    """Those of the variants that are worth issuing; ``refused`` counts the others by their first flaw."""
    keys_of(exercise, variants)
    found = []
    for variant in variants:
        flaw = next(flaws(variant.key), None)
        if flaw is None:
            found.append(variant)
        elif refused is not None:
            refused[flaw] += 1
    return found
