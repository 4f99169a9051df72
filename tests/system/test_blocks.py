"""Long arrays in pieces: the same result however many threads share them, each place once."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from coursework.system import blocks


@pytest.mark.parametrize("processors", [1, 2, 3])
@pytest.mark.parametrize("pays", [0.0, float("inf")], ids=["never", "always"])
@pytest.mark.parametrize("count", [1, 2, 5, 8, 40])
def test_each_place_is_computed_once_with_or_without_threads(processors, pays, count, monkeypatch):
    monkeypatch.setattr(blocks, "processors", lambda: processors)
    monkeypatch.setattr(blocks, "_PAYS", pays)
    monkeypatch.setattr(blocks, "_NOTICED", 0.0)
    given, seen = np.arange(3.0 * count), []

    def compute(place):
        seen.append((place.start, threading.get_ident()))
        return {"square": given[place] ** 2, "one": 1.0}

    places = [slice(start, start + 3) for start in range(0, 3 * count, 3)]
    found = blocks.joined(compute, places, len(given))
    assert found["square"].tolist() == (given**2).tolist()
    assert found["one"] == 1.0
    assert sorted(start for start, _ in seen) == [place.start for place in places]
    if processors == 1:
        assert {thread for _, thread in seen} == {threading.get_ident()}
    elif count == 40:
        others = sum(thread != threading.get_ident() for _, thread in seen)
        assert others == (39 if pays else 2 * processors)


def test_an_error_in_a_thread_is_raised(monkeypatch):
    monkeypatch.setattr(blocks, "processors", lambda: 2)
    monkeypatch.setattr(blocks, "_PAYS", float("inf"))
    monkeypatch.setattr(blocks, "_NOTICED", 0.0)

    def compute(place):
        if place.start == 30:
            raise ValueError("at 30")
        return {"x": np.zeros(1)}

    with pytest.raises(ValueError, match="at 30"):
        blocks.joined(compute, [slice(i, i + 1) for i in range(40)], 40)


def test_short_work_starts_no_thread(monkeypatch):
    monkeypatch.setattr(blocks, "processors", lambda: 2)
    seen = set()

    def compute(place):
        seen.add(threading.get_ident())
        return {"x": np.zeros(1)}

    monkeypatch.setattr(blocks, "_NOTICED", float("inf"))
    blocks.joined(compute, [slice(i, i + 1) for i in range(40)], 40)
    assert seen == {threading.get_ident()}
