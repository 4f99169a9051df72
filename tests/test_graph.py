"""The quantity graph: exactly what is asked, in order, once; one clear error for each misuse."""

from __future__ import annotations

import numpy as np
import pytest

from coursework.errors import CannotAssemble, Cycle, MissingQuantity, Undefined, UnknownName
from coursework.graph import Graph, Replacement


def area(width, height):
    return width * height


def volume(area, depth):
    return area * depth


def mass(volume, density=2.0):
    return volume * density


def cost(mass, friction=0.0):
    return mass + friction


def friction(mass, slope):
    return mass * slope


GRAPH = Graph({f.__name__: f for f in (area, volume, mass, cost, friction)})
BOX = {"width": 2.0, "height": 3.0, "depth": 4.0}


def test_a_request_evaluates_its_ancestors_in_order_and_nothing_else():
    assert GRAPH.plan(("volume",), BOX) == ("area", "volume")
    assert GRAPH.plan(("area",), BOX) == ("area",)


def test_each_function_is_called_once():
    calls = []

    def base(x):
        calls.append(x)
        return x

    def left(base):
        return base + 1

    def right(base):
        return base + 2

    def total(left, right):
        return left * right

    graph = Graph({"base": base, "left": left, "right": right, "total": total})
    assert graph.evaluate(("total", "base"), {"x": 1.0}) == {"total": 6.0, "base": 1.0}
    assert calls == [1.0]


def test_a_given_value_replaces_the_function_and_its_ancestors():
    assert GRAPH.evaluate(("volume",), {"area": 10.0, "depth": 4.0}) == {"volume": 40.0}
    assert GRAPH.plan(("volume",), ("area", "depth")) == ("volume",)


def test_an_optional_effect_is_absent_unless_called():
    assert "friction" not in GRAPH.plan(("cost",), BOX)
    assert GRAPH.plan(("cost",), {**BOX, "slope": 1.0}, ("friction",)) == (
        "area",
        "volume",
        "mass",
        "friction",
        "cost",
    )
    assert GRAPH.evaluate(("cost",), BOX) == {"cost": 48.0}
    assert GRAPH.evaluate(("cost",), {**BOX, "slope": 0.5}, ("friction",)) == {"cost": 72.0}
    assert GRAPH.effects() == ("friction",)


def test_a_default_yields_to_a_given_value():
    assert GRAPH.evaluate(("mass",), {**BOX, "density": 3.0}) == {"mass": 72.0}


def test_arrays_broadcast():
    found = GRAPH.evaluate(("volume",), {"width": np.arange(3.0), "height": np.ones((2, 1)), "depth": 2.0})
    assert found["volume"].shape == (2, 3)
    np.testing.assert_array_equal(found["volume"], 2 * np.arange(3.0) * np.ones((2, 1)))


def test_a_mistake_flows_into_what_depends_on_it():
    wrong = GRAPH.replacing(Replacement(("area",), lambda width, height: width + height))
    assert wrong.evaluate(("mass",), BOX) == {"mass": 40.0}
    assert GRAPH.evaluate(("mass",), BOX) == {"mass": 48.0}


def test_a_mistake_may_use_the_right_value_of_its_target():
    wrong = GRAPH.replacing(Replacement(("area",), lambda area: -area))
    assert wrong.evaluate(("volume",), BOX) == {"volume": -24.0}


def test_a_mistake_may_exchange_two_quantities():
    wrong = GRAPH.replacing(Replacement(("area", "volume"), lambda area, volume: (volume, area)))
    assert wrong.evaluate(("area", "volume", "mass"), BOX) == {"area": 24.0, "volume": 6.0, "mass": 12.0}


def test_a_mistake_may_misread_a_given_value():
    wrong = GRAPH.replacing(Replacement(("width",), lambda width: 10 * width))
    assert wrong.evaluate(("volume",), BOX) == {"volume": 240.0}


def test_descendants_are_what_a_quantity_reaches():
    assert GRAPH.descendants(("volume",)) == {"volume", "mass", "cost", "friction"}


def test_a_cycle_is_named_whole():
    graph = Graph({"a": lambda b: b, "b": lambda c: c, "c": lambda a: a})
    with pytest.raises(Cycle, match="b -> c -> a -> b"):
        graph.evaluate(("b",), {})


def test_a_given_value_opens_a_cycle():
    graph = Graph({"a": lambda b: b, "b": lambda a: a})
    assert graph.evaluate(("a",), {"b": 3.0}) == {"a": 3.0}


def test_a_missing_quantity_is_named_with_what_needs_it():
    with pytest.raises(MissingQuantity, match=r"volume needs depth.*add depth="):
        GRAPH.evaluate(("volume",), {"width": 1.0, "height": 1.0})


def test_an_unknown_name_brings_the_nearest():
    with pytest.raises(UnknownName, match="did you mean 'volume'"):
        GRAPH.evaluate(("volum",), BOX)
    with pytest.raises(UnknownName, match="did you mean 'width'"):
        GRAPH.evaluate(("area",), {**BOX, "widht": 2.0})
    with pytest.raises(UnknownName, match="friction"):
        GRAPH.plan(("cost",), BOX, ("frction",))


def test_a_scalar_outside_a_functions_domain_is_told_with_its_values():
    graph = Graph({"ratio": lambda a, b: a / b})
    with pytest.raises(Undefined, match=r"ratio does not exist for a = 1.0, b = 0.0"):
        graph.evaluate(("ratio",), {"a": 1.0, "b": 0.0})


def test_deliberate_errors_pass_through():
    def closes(a):
        raise CannotAssemble("gap 3")

    with pytest.raises(CannotAssemble, match="gap 3"):
        Graph({"closes": closes}).evaluate(("closes",), {"a": 1.0})


def test_the_right_value_keeps_the_effects_that_are_called():
    wrong = GRAPH.replacing(Replacement(("cost", "volume"), lambda cost, volume: (cost + 1, volume)))
    given = {**BOX, "slope": 0.5}
    assert wrong.evaluate(("cost",), given, ("friction",)) == {"cost": 73.0}
    assert wrong.evaluate(("cost",), given) == {"cost": 49.0}
