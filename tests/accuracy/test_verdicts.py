"""The words of the page follow from the figures, and stay when the figures are measured again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tables import each_row

from coursework.accuracy.measuring import GENERIC, HARD, Measurement
from coursework.accuracy.timing import Times, interleaved, is_busy, overlap
from coursework.accuracy.verdicts import Rows, enough, paid_after
from coursework.language.words import languages, words


def row(family, place, ns, error, *, setting=None, spread=0.04, failed=0, build=None):
    return Measurement(
        "x",
        "position",
        f"{family}-{setting or ''}",
        place,
        ns,
        error,
        20,
        failed,
        family,
        setting,
        ns * (1 - spread / 2),
        ns * (1 + spread / 2),
        9,
        build,
    )


def stored():
    """As they were measured once, of a four-bar linkage: times in ns, errors at generic and at hard
    places."""
    figures = [
        ("single", None, 81, 3.1e-7, 8.5e-6),
        ("table", 64, 21, 5.8e-7, 1.0e-2),
        ("table", 4096, 30, 3.5e-14, 1.6e-4),
        ("stable", None, 68, 4.6e-16, 3.3e-16),
        ("textbook", None, 156, 5.8e-16, 7.4e-9),
        ("newton", 4, 412, 3.3e-16, 2.7e-3),
        ("fsolve", 1e-12, 6e4, 3.3e-16, 9.9e-9),
        ("mpmath", None, 9e5, 1e-50, 1e-40),
    ]
    return [
        row(family, place, ns, error, setting=setting, build=5e6 if family == "table" else None)
        for family, setting, ns, *errors in figures
        for place, error in zip((GENERIC, HARD), errors, strict=True)
    ]


def told(rows, lang="en"):
    def name(r):
        return r.method

    return enough(Rows(rows), words(lang)["accuracy"], name, lambda value: f"{value:g}")


def noisy(rows, seed):
    """The same figures measured again: a machine of another speed, and every time another one.

    What slows the machine slows every way of a round; what is left to each is a few percent.
    """
    rng = np.random.default_rng(seed)
    speed = np.exp(0.3 * rng.standard_normal())
    factors = {r.method: speed * np.exp(0.05 * rng.standard_normal()) for r in rows}
    return [
        replace(
            r,
            ns_per_configuration=r.median * factors[r.method],
            ns_low=r.low * factors[r.method],
            ns_high=r.high * factors[r.method],
        )
        for r in rows
    ]


@each_row("lang", languages())
def test_two_runs_say_the_same(lang):
    once = told(stored(), lang)
    assert once
    assert all(told(noisy(stored(), seed), lang) == once for seed in range(50))


def test_the_verdict_knows_hard_places():
    """A table would do at generic places; everywhere, only what keeps its digits at the hard ones."""
    everywhere = [line for line in told(stored()) if "hard places among it" in line]
    (solver,) = (line for line in everywhere if "*stable-*" in line)
    assert "1e-06 and 1e-12" in solver
    assert "*table-" not in solver
    (table,) = (line for line in everywhere if "*table-" in line)
    assert "0.001" in table
    assert "1e-06" not in table
    generic = [line for line in told(stored()) if "generic places alone" in line]
    assert any("*table-4096*" in line and "1e-12" in line for line in generic)


def test_what_has_no_answer_somewhere_is_not_good_enough():
    rows = [replace(r, failed=1) if (r.family, r.place) == ("stable", HARD) else r for r in stored()]
    assert not any("*stable-*" in line for line in told(rows) if "hard places among it" in line)


def test_ways_whose_spreads_overlap_are_as_good_as_each_other():
    rows = [row("stable", GENERIC, 40, 1e-16, spread=0.2), row("textbook", GENERIC, 45, 1e-16, spread=0.2)]
    assert overlap(*rows)
    (line,) = told(rows)
    assert "as good as each other" in line
    assert "*stable-*" in line
    assert "*textbook-*" in line
    apart = [rows[0], row("textbook", GENERIC, 650, 1e-16)]
    assert "as good as" not in told(apart)[0]


def test_no_winner_is_named_on_a_busy_machine():
    """A fifth of the ways spread widely: no time is to be trusted then, not even one that does not."""
    busy = {"single-", "table-64"}
    rows = [
        replace(r, ns_low=0.7 * r.median, ns_high=1.4 * r.median) if r.method in busy else r for r in stored()
    ]
    assert is_busy(r for r in rows if r.place == GENERIC)
    assert len(told(rows)) == 1
    assert "busy" in told(rows)[0]
    assert not is_busy(r for r in stored() if r.place == GENERIC)


def test_a_table_is_paid_by_what_it_saves():
    table, stable = row("table", GENERIC, 30, 1e-14, setting=64, build=4e6), row("stable", GENERIC, 70, 1e-16)
    assert paid_after(table, stable) == pytest.approx(1e5)
    assert paid_after(replace(table, ns_per_configuration=90, ns_low=89, ns_high=91), stable) is None
    assert paid_after(replace(table, ns_per_configuration=60, ns_low=50, ns_high=72), stable) is None


def test_every_call_has_its_turn_in_every_round():
    turns = []
    calls = [lambda i=i: turns.append(i) for i in range(3)]
    times = interleaved(calls, 0.0, rounds=4)
    assert [t.rounds for t in times] == [4, 4, 4]
    rounds = np.array(turns[6:]).reshape(4, 3)  # after two of each to get ready
    assert all(set(own) == {0, 1, 2} for own in rounds.tolist())
    assert len({own[0] for own in rounds.tolist()}) == 3


def test_a_clock_that_ticks_coarsely_makes_no_round_long(monkeypatch):
    """As that of processor time does while a profiler samples: it says nanoseconds and ticks every four
    milliseconds."""
    done = []
    monkeypatch.setattr("coursework.accuracy.timing.clock", lambda: len(done) * 1e-5 // 4e-3 * 4e-3)
    # A call of 10 microseconds: 2000 of them a round.
    (times,) = interleaved([lambda: done.append(1)], 0.02, rounds=9)
    assert times.median == pytest.approx(1e-5, rel=0.5)
    assert len(done) < 9 * 2000 * 3


def test_a_slow_call_is_timed_more_than_once():
    (times,) = interleaved([lambda: sum(range(1000))], 0.0, budget=0.0, rounds=9)
    assert times.rounds == 3
    assert times.low <= times.median <= times.high


def test_times_are_counted_by_the_configuration():
    times = Times(2e-3, 1e-3, 3e-3, 5)
    assert times.per(1000) == Times(2e-6, 1e-6, 3e-6, 5)
    assert times.spread == pytest.approx(1.0)
