"""The quantity graph: exactly what is asked, in order, once; one clear error for each misuse."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from tables import each_row

from coursework.errors import CannotAssemble, Cycle, MissingQuantity, Undefined, UnknownName
from coursework.quantities.graph import Graph, Replacement
from coursework.system.blocks import joined


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


@each_row(
    "replacement",
    [
        Replacement(("area",), lambda width, height: width + height),
        Replacement(("area",), lambda area: -area),
        Replacement(("volume", "area"), lambda area, volume: (area, volume)),
        Replacement(("width",), lambda width: 10 * width),
        Replacement(("mass",), lambda volume: volume),
    ],
)
def test_what_was_found_without_the_mistake_is_taken_where_it_still_holds(replacement):
    wrong = GRAPH.replacing(replacement)
    wanted = ("area", "volume", "cost")
    found = GRAPH.everything(wanted, BOX)
    assert wrong.evaluate(wanted, BOX, (), found) == wrong.evaluate(wanted, BOX)


def test_what_was_found_is_not_computed_again():
    calls = []
    graph = GRAPH.observed(lambda name, value: calls.append(name) or value)
    found = graph.everything(("mass",), BOX)
    calls.clear()
    wrong = graph.replacing(Replacement(("volume",), lambda volume: 2 * volume))
    assert wrong.evaluate(("mass", "area"), BOX, (), found) == {"mass": 96.0, "area": 6.0}
    assert calls == ["mass"]


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


def test_all_that_is_missing_is_named_at_once():
    with pytest.raises(
        MissingQuantity, match=r"the request needs width, height and depth, which are not given"
    ) as caught:
        GRAPH.evaluate(("volume",), {})
    assert caught.value.names == ("width", "height", "depth")
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


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


def _chord(radius, turn):
    return radius * turn


def stable_slope(_chord, radius):
    return _chord / radius


def slope(rise, run):
    return rise / run


def rise(radius, turn):
    return radius * turn + 1e9 - 1e9


def run(radius):
    return radius


def grade(slope):
    return 100 * slope


slope.__stable__ = stable_slope
HIDDEN = Graph({"_chord": _chord, **{f.__name__: f for f in (slope, rise, run, grade)}})
ARC = {"radius": 2.0, "turn": 1e-9}


def test_the_stable_way_is_taken_where_nothing_given_lies_on_the_other():
    assert HIDDEN.plan(("grade",), ARC) == ("_chord", "slope", "grade")
    assert HIDDEN.evaluate(("grade",), ARC) == {"grade": 100 * 1e-9}
    assert HIDDEN.textbook.evaluate(("slope",), ARC)["slope"] != 1e-9


def test_what_a_request_gives_counts_even_where_the_stable_way_passes_over_it():
    assert HIDDEN.evaluate(("grade",), {**ARC, "rise": 3.0}) == {"grade": 150.0}
    assert HIDDEN.evaluate(("grade",), {**ARC, "run": 4.0, "rise": 1.0}) == {"grade": 25.0}


def test_a_mistake_counts_even_where_the_stable_way_passes_over_it():
    wrong = HIDDEN.replacing(Replacement(("rise",), lambda rise: rise + 4.0))
    assert wrong.evaluate(("slope",), ARC)["slope"] == pytest.approx(2.0)
    right = HIDDEN.replacing(Replacement(("grade",), lambda slope: slope))
    assert right.evaluate(("grade",), ARC) == {"grade": 1e-9}
    earlier = HIDDEN.replacing(Replacement(("turn",), lambda turn: 2 * turn))
    assert earlier.evaluate(("slope",), ARC) == {"slope": 2e-9}


def test_the_walk_shows_the_textbook_way_with_the_stable_values():
    met = HIDDEN.walk(("grade",), ARC)
    assert met == ("rise", "run", "slope", "grade")
    walk = HIDDEN.evaluate(met, ARC)
    assert walk["slope"] == 1e-9


def test_the_walk_meets_what_a_formula_is_stated_with_before_it():
    def span(length, height):
        return (length**2 - height**2) ** 0.5

    def tilt(height, length):
        return np.arcsin(height / length)

    span.__formula__ = r"<length> \cos <tilt>"
    # Each is stated with the other: the first asked comes last.
    tilt.__formula__ = r"\arccos \frac{<span>}{<length>}"
    graph, rod = Graph({f.__name__: f for f in (span, tilt)}), {"length": 5.0, "height": 3.0}
    assert graph.walk(("span",), rod) == ("tilt", "span")
    assert graph.plan(("span",), rod) == ("span",)
    assert graph.walk(("tilt",), rod) == ("tilt",)


def test_hidden_quantities_may_be_wanted_of_everything():
    assert HIDDEN.everything(("_chord",), ARC)["_chord"] == HIDDEN.everything(("grade",), ARC)["_chord"]


def test_hidden_quantities_cannot_be_named_by_a_request():
    assert "_chord" not in HIDDEN.quantities
    for request in (
        lambda: HIDDEN.evaluate(("_chord",), ARC),
        lambda: HIDDEN.plan(("grade",), {"_chord": 1.0}),
    ):
        with pytest.raises((UnknownName, MissingQuantity)):
            request()
    with pytest.raises(UnknownName):
        HIDDEN.evaluate(("grade",), {**ARC, "_chord": 1.0})


@each_row("shapes", [((400_000,), ()), ((8, 1), (50_000,)), ((150_000, 1), (3,)), ((1, 90_000), (1, 1))])
def test_long_arrays_give_what_their_places_give_alone(shapes):
    calls = []

    def whole(depth):
        calls.append(depth)
        return depth + 1

    def pair(area, whole):
        return np.stack([area, whole * np.ones_like(area)], axis=-1)

    def case(area):
        return (
            np.where(area > 2, "large", "small") if np.max(area) > 2.01 else np.where(area > 2, "l", "small")
        )

    graph = GRAPH.with_functions({"whole": whole, "pair": pair, "case": case})
    rng = np.random.default_rng(0)
    given = {"width": rng.uniform(1, 2, shapes[0]), "height": rng.uniform(1, 2, shapes[1]), "depth": 3.0}
    found = graph.evaluate(("volume", "whole", "pair", "case"), given)
    area = given["width"] * given["height"]
    assert np.array_equal(found["volume"], area * 3.0)
    assert np.array_equal(found["pair"], np.stack([area, np.full_like(area, 4.0)], axis=-1))
    assert np.array_equal(found["case"], np.where(area > 2, "large", "small"))
    # What does not vary is computed once and stays a number.
    assert found["whole"] == 4.0
    assert calls == [3.0]


def test_pieces_of_texts_of_any_length_are_put_together():
    texts = [np.array(["a", "bb"]), np.array(["cccc"] * 2), np.array(["d", "e"]), np.array(["fffffff", ""])]
    places = [slice(i, i + 2) for i in range(0, 8, 2)]
    found = joined(lambda place: {"text": texts[place.start // 2], "one": 5.0}, places, 8)
    assert found["text"].tolist() == ["a", "bb", "cccc", "cccc", "d", "e", "fffffff", ""]
    assert found["one"] == 5.0


def test_rounding_moves_each_entry_of_a_matrix_alone():
    from coursework.quantities.columns import matrix
    from coursework.quantities.rounding import envelope, half_step

    graph = Graph({"p": lambda x: x / 3, "M": lambda p: matrix([p, 0 * p], [7 * p, 2 * p])})

    def by_hand(x):
        p = x / 3
        entries = [p, 7 * p, 2 * p]
        return 1.1 * (np.linalg.norm([1, 7, 2]) * half_step(p, 3) + sum(half_step(e, 3) for e in entries))

    alone = [float(envelope(graph, ("M",), {"x": x}, (), 3)["M"][0]) for x in (10.0, 47.0, 95.0)]
    together = envelope(graph, ("M",), {"x": np.array([10.0, 47.0, 95.0])}, (), 3)["M"]
    assert alone == pytest.approx([by_hand(x) for x in (10.0, 47.0, 95.0)])
    assert together == pytest.approx(alone)


def test_a_matrix_that_never_changes_is_whole_for_each_variant_and_not_moved():
    from coursework.course.key_batch import _rows
    from coursework.quantities.rounding import envelope

    graph = Graph({"E": lambda: np.array([[1.5, 2.0], [0.0, 1.0]]), "y": lambda x: x + 1})
    given = {"x": np.array([1.0, 2.0])}
    found = graph.evaluate(("E", "y"), given)
    assert all(np.array_equal(one, found["E"]) for one in _rows(found, 2, {"E": 2})["E"])
    assert envelope(graph, ("E",), given, (), 3)["E"].tolist() == [0, 0]
