"""Timing of calls in alternating rounds, so that other load affects all of them alike."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

WIDE = 0.25  #: a spread, in parts of the median, that an idle machine hardly makes
MANY = 0.2  #: the share of wide spreads from which on no time of a page is compared
ALIKE = 1.75  #: times whose ratio is smaller are alike, whatever their spreads
#: Processor time where its resolution is fine, so that what else the machine does counts little; else the
#: time that passes.
clock = time.process_time if time.get_clock_info("process_time").resolution <= 1e-6 else time.perf_counter
_ROUNDS = 9
_LEAST_ROUNDS = 3


@dataclass(frozen=True)
class Times:
    """Seconds of a call: the median of the rounds, and the quartiles."""

    median: float
    low: float
    high: float
    rounds: int

    @property
    def spread(self) -> float:
        return (self.high - self.low) / self.median

    def per(self, count: int) -> Times:
        return Times(self.median / count, self.low / count, self.high / count, self.rounds)


def is_busy(times: Iterable[Any]) -> bool:
    """Return whether the times spread so widely that other load makes them incomparable."""
    spreads = [(t.high - t.low) / t.median for t in times if t.median]
    return bool(spreads) and sum(spread > WIDE for spread in spreads) >= MANY * len(spreads)


def overlap(a: Any, b: Any) -> bool:
    """Return whether two times are indistinguishable: their quartiles overlap, or they are nearly equal."""
    fast, slow = sorted((a, b), key=lambda t: t.median)
    return slow.low <= fast.high or slow.median < ALIKE * fast.median


def interleaved(
    calls: Sequence[Callable[[], Any]], at_least: float, budget: float = math.inf, rounds: int = _ROUNDS
) -> list[Times]:
    """Time some calls, each repeated within a round for at least ``at_least`` seconds.

    Every call has at least three rounds; one that takes longer than ``budget`` in all has no more than these.
    """
    once = [_seconds_once(call, at_least) for call in calls]
    repeats = [max(1, math.ceil(at_least / seconds)) for seconds in once]
    samples: list[list[float]] = [[] for _ in calls]
    for n in range(rounds):
        # Each round begins with another call.
        for i in (*range(n % len(calls), len(calls)), *range(n % len(calls))):
            if n >= _LEAST_ROUNDS and once[i] * rounds > budget:
                continue
            start = clock()
            for _ in range(repeats[i]):
                calls[i]()
            samples[i].append((clock() - start) / repeats[i])
    return [times_of(times) for times in samples]


def _seconds_once(call: Callable[[], Any], at_least: float) -> float:
    """Return about the seconds of one call: of twice as many calls each time, until the clock sees a quarter
    of ``at_least``.

    A clock may tick more coarsely than it says, as that of processor time does while a profiler samples.
    """
    call()  # what is made at the first call is not timed
    count, taken = 1, 0.0
    while taken <= 0 or taken < at_least / 4:
        start = clock()
        for _ in range(count):
            call()
        taken = clock() - start
        count *= 2
    return 2 * taken / count


def times_of(samples: Sequence[float]) -> Times:
    """Return the median and quartiles of some measurements, seconds."""
    low, median, high = (float(np.quantile(samples, part)) for part in (0.25, 0.5, 0.75))
    return Times(median, low, high, len(samples))
