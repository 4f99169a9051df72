"""Times of calls that are compared: taken in turn, so that what slows the machine slows them all."""

from __future__ import annotations

import platform
import statistics
import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

Calls = Mapping[str, Callable[[], Any]]


def times_in_turn(
    calls: Calls, rounds: int = 15, clock: Callable[[], float] = time.perf_counter
) -> dict[str, list[float]]:
    """Seconds of each call, a round an item; every round runs all of them once, after one that does not
    count."""
    found: dict[str, list[float]] = {name: [] for name in calls}
    for call in calls.values():
        call()
    for _ in range(rounds):
        for name, call in calls.items():
            start = clock()
            call()
            found[name].append(clock() - start)
    return found


def best_in_turn(calls: Calls, rounds: int = 15) -> dict[str, float]:
    """The least seconds of each call; every round runs all of them once."""
    return {name: min(times) for name, times in times_in_turn(calls, rounds).items()}


def median_ratio(times: list[float], others: list[float]) -> float:
    """How many times as long one call takes as another: the median over rounds that ran both."""
    return statistics.median(a / b for a, b in zip(times, others, strict=True))


class Rounds(NamedTuple):
    """Of one call, over rounds that each run all calls once: seconds by the clock, and of the processor's own
    time.

    Where other processes take the processor too, its own time says more.
    """

    clock: np.ndarray
    processor: np.ndarray


def rounds_in_turn(calls: Mapping[str, Callable[[], Any]], rounds: int = 25) -> dict[str, Rounds]:
    """Every round of every call, after one that does not count."""
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in calls}
    for call in calls.values():
        call()
    for _ in range(rounds):
        for name, call in calls.items():
            start, own = time.perf_counter(), time.process_time()
            call()
            found[name].append((time.perf_counter() - start, time.process_time() - own))
    return {name: Rounds(*np.transpose(times)) for name, times in found.items()}


def machine() -> str:
    """What ran it, without saying whose it is."""
    try:
        from numpy._core._multiarray_umath import __cpu_features__ as features
    except ImportError:
        from numpy.core._multiarray_umath import __cpu_features__ as features
    vectors = "with" if features.get("AVX512_SKX") else "without"
    return (
        f"{platform.machine()} {vectors} AVX-512, Python {platform.python_version()}, numpy {np.__version__}"
    )


def print_table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    """A Markdown table."""
    print("| " + " | ".join(heads) + " |")
    print("|" + "|".join("---" if i == 0 else "--:" for i in range(len(heads))) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()
