"""The promise that nobody earns without knowing: nothing follows from numbers that are written without
work."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from coursework.authoring.check_report import CheckReport
from coursework.course.variant import Variant
from coursework.marking.marking import mark as grade

TRIED = 3  #: variants that such students answer
#: What is written in every box by students who know nothing; two more write the data in turn, and the
#: questions' numbers.
NUMBERS = (
    "0 1 -1 2 -2 3 4 5 6 7 8 9 10 12 20 45 50 90 100 180 -90 270 0.5 -0.5 0.1 1e-9 -1e-9 1e-6 1e-3 1e3 "
    "1e6 1e9 "
    "-1e9 1e12 3.14159 1.5708 57.2958 0.01"
).split()


def without_work(variant: Variant) -> Iterator[tuple[str, Mapping[str, str]]]:
    """Forty sheets and more of students who know nothing, each with what it is called."""
    for number in NUMBERS:
        yield f"{number} everywhere", dict.fromkeys(variant.part_ids, number)
    data = [v for v in variant.given.values() if not isinstance(v, str)] or [1]
    yield "the data", {i: f"{data[n % len(data)]:g}" for n, i in enumerate(variant.part_ids)}
    for name, value in variant.given.items():
        if not isinstance(value, str):
            yield f"{name} everywhere", dict.fromkeys(variant.part_ids, f"{value:g}")
            unit = variant.exercise.units.get(name)
            yield (
                f"{name} in boxes of its unit",
                {p.id: f"{value:g}" for p in variant.parts if p.unit == unit},
            )
    yield "the questions' numbers", {i: str(n) for n, i in enumerate(variant.part_ids, start=1)}


def check_knowledge(drawn: Sequence[Variant], report: CheckReport) -> None:
    """No number of such a sheet is paid for because it follows from another one."""
    for variant in drawn[:TRIED]:
        # Where parts are judged together many answers are right, and one number everywhere may be.
        numbers = [part.id for part in variant.parts if part.sort.is_scalar and not part.judge]
        for method, answers in without_work(variant):
            marking = grade(variant, answers)
            report.counts["sheets without work"] += 1
            for i in numbers:
                mark = marking[i]
                if mark.verdict == "follow_through" and mark.points:
                    report.fail(
                        f"seed {variant.seed}: who writes {method} is paid for {i}, which follows from "
                        "nothing"
                    )
