"""Explore: what one movement of a slider costs the site, by exercise.

python benchmarks/explore.py

Processor time of all that is computed and drawn for new numbers: 360 steps of a turn, figure, paths and
plots.
"""

from __future__ import annotations

import statistics
import time

from timing import machine, print_table

import coursework
from coursework.scenes.exploration import parameters
from coursework.site.practice.explore_page import SEED, is_explored, shown_mechanism, usual

COURSE = coursework.open_course()
ROUNDS = 15


def costs(name: str) -> list[float]:
    """Return the milliseconds of each round; each has numbers of its own."""
    variant = COURSE[name].variant(SEED, "en")
    choices = parameters(variant.exercise, variant.given)
    first = usual(variant, choices)
    driver, found = choices[-1], []
    for k in range(ROUNDS + 1):
        share = (k + 0.5) / (ROUNDS + 1)
        values = {**first, driver.name: driver.low + share * (driver.high - driver.low)}
        begun = time.process_time()
        shown_mechanism("en", variant, choices, values)
        found.append(1000 * (time.process_time() - begun))
    return found[1:]


def main() -> None:
    rows = []
    for name in COURSE.names:
        if is_explored(COURSE[name]):
            found = costs(name)
            rows.append((name, f"{min(found):.0f}", f"{statistics.median(found):.0f}"))
    print(machine())
    print_table(("exercise", "least, ms", "median, ms"), rows)


if __name__ == "__main__":
    main()
