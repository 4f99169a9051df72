"""Memory that is given back to the system."""

import ctypes

import pytest

from coursework.system import memory


@pytest.mark.parametrize("missing", [OSError, TypeError, AttributeError])
def test_a_system_without_these_functions_is_left_as_it_is(monkeypatch, missing):
    def library(name):
        raise missing

    memory._heap_function.cache_clear()
    monkeypatch.setattr(ctypes, "CDLL", library)
    with memory.little_memory():
        done = True
    memory._heap_function.cache_clear()
    assert done
