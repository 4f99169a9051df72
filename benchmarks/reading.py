"""How long the readers take: many plain answers at once, one at a time, and what needs more than digits.

python benchmarks/reading.py
"""

from __future__ import annotations

import numpy as np
from timing import best_in_turn, machine, print_table

from coursework.parsing.equations import parse_equation, read_equation
from coursework.parsing.equivalence import same_equation
from coursework.parsing.numbers import read_number, read_numbers
from coursework.parsing.points import read_point

COUNT = 100_000
ROUNDS = 7
ONE_BY_ONE = {
    "plain digits": ("319.8", "mm"),
    "two readings": ("1,234", "mm"),
    "groups of thousands": ("1 234,5", "mm"),
    "number and unit": ("319,8 mm", "mm"),
    "another unit": ("0.3198 m", "mm"),
    "power of ten": ("3,198·10² mm", "mm"),
    "mixed number": ("1 1/2", "mm"),
    "degrees, minutes": ("104°38'", "deg"),
    "formula": ("sqrt(2)/2", "1"),
    "angle in radians": ("2π/3", "deg"),
    "no number": ("I do not know", "mm"),
    "formula bomb": ("9**9**9", "mm"),
}
NAMES = ("r4", "r5", "theta4", "theta5")
REFERENCE = "r4*sin(theta4) = r5*sin(theta5)"
EQUATIONS = {
    "rearranged": "r5 sinθ5 - r4 sinθ4 = 0",
    "solved for one side": "sin(θ5) = r4/r5 sin(θ4)",
    "a quotient": "sinθ4/sinθ5 = r5/r4",
    "wrong": "r4 cosθ4 = r5 cosθ5",
}


def plain_answers(count: int) -> list[str]:
    """Answers of five kinds in turn: ``319.8``, ``104,6``, ``-12``, ``3.2e2``, nothing."""
    values = np.random.default_rng(0).uniform(1, 1000, count)
    ways = ("{:.1f}".format, lambda v: f"{v:.1f}".replace(".", ","), "-{:.0f}".format, "{:.1e}".format)
    return ["" if k % 5 == 4 else ways[k % 5](v) for k, v in enumerate(values)]


def main() -> None:
    print(f"{machine()}; best of {ROUNDS} rounds, all rows in turn\n")
    answers = plain_answers(COUNT)
    times = best_in_turn(
        {
            "read_numbers, one call": lambda: read_numbers(answers, "mm"),
            "read_number, each": lambda: [read_number(answer, "mm") for answer in answers],
        },
        ROUNDS,
    )
    rows = [(n, f"{t:.3f}", f"{t / COUNT * 1e6:.2f}") for n, t in times.items()]
    print_table((f"{COUNT:,} plain answers", "s", "µs an answer"), rows)

    calls = {
        n: (lambda a=a, u=u: [read_number(a, u) for _ in range(200)]) for n, (a, u) in ONE_BY_ONE.items()
    }
    calls["point"] = lambda: [read_point("(12,3 ; 4,5) mm", "mm", 2) for _ in range(200)]
    calls["equation"] = lambda: [read_equation(EQUATIONS["rearranged"], NAMES) for _ in range(200)]
    times = best_in_turn(calls, ROUNDS)
    texts = {n: a for n, (a, _) in ONE_BY_ONE.items()} | {
        "point": "(12,3 ; 4,5) mm",
        "equation": EQUATIONS["rearranged"],
    }
    print_table(
        ("one answer", "as written", "µs"),
        [(n, f"`{texts[n]}`", f"{t / 200 * 1e6:.1f}") for n, t in times.items()],
    )

    reference = parse_equation(REFERENCE, NAMES)
    read = {n: parse_equation(text, NAMES) for n, text in EQUATIONS.items()}
    times = best_in_turn(
        {n: (lambda e=e: same_equation(e, reference, parameters=("r4", "r5"))) for n, e in read.items()},
        ROUNDS,
    )
    rows = [
        (
            n,
            f"`{EQUATIONS[n]}`",
            str(same_equation(read[n], reference, parameters=("r4", "r5"))),
            f"{t * 1e3:.2f}",
        )
        for n, t in times.items()
    ]
    print_table((f"beside `{REFERENCE}`", "as written", "the same", "ms"), rows)


if __name__ == "__main__":
    main()
