"""Assour groups as an exercise: joints and driver given by hand, the driver's part, variants."""

import pytest

import coursework
from coursework.errors import Undefined, WrongValue
from coursework.structure import LIBRARY, decompose

EXERCISE = coursework.open_course()["assour"]


def solve(figure, driver, **more):
    return EXERCISE.solve(joints=list(LIBRARY[figure].records()), driver=driver, **more)


def test_groups_are_sets_of_bodies_with_their_class():
    found = solve("figure_14", [1, 5], only=("groups", "assour_class"))
    assert found == {
        "groups": ({"bodies": [7, 8], "class": "II"}, {"bodies": [2, 3, 4, 6], "class": "III"}),
        "assour_class": "III",
    }


def test_the_driver_of_figure_14_changes_its_class():
    classes = {body: solve("figure_14", [1, body], only="assour_class")["assour_class"] for body in (2, 4, 5)}
    assert classes == {2: "II", 4: "II", 5: "III"}


def test_a_driver_alone_is_of_class_one():
    found = solve("figure_8a_motor", [1, 2])
    assert found == {"group_count": 0, "group_size": 1, "group_class": "I", "assour_class": "I"}


def test_what_has_no_groups_or_no_such_driver_says_so():
    with pytest.raises(Undefined, match="lower pairs"):
        solve("figure_6_cam", [1, 2])
    with pytest.raises(WrongValue, match="bodies that have one: 2, 4"):
        solve("figure_3", [1, 3])


def test_variants_ask_about_the_group_of_a_body_that_moves():
    for variant in EXERCISE.variants(range(60)):
        printed, found = variant.printed, variant.solution()
        parts = decompose(printed["joints"], printed["driver"])
        group = next(group for group in parts.groups if printed["body"] in group.bodies)
        assert found == {
            "group_count": len(parts.groups),
            "group_size": len(group.bodies),
            "group_class": group.class_name,
            "assour_class": parts.class_name,
        }


def test_the_other_driver_is_a_mistake_only_where_there_is_one():
    graph = EXERCISE.solution.mistaken("other_driver")
    moved = 0
    for variant in EXERCISE.variants(range(60)):
        found = graph.evaluate(("driver", "assour_class"), variant.used)
        joints, driver = variant.printed["joints"], variant.printed["driver"]
        assert found["assour_class"] == decompose(joints, found["driver"]).class_name
        moved += found["driver"] != driver
    assert moved > 30
    mistake = EXERCISE.solution.mistakes["other_driver"].replacement.function
    assert mistake(LIBRARY["figure_8a_motor"], (1, 2)) == (1, 2)


def test_a_shared_pivot_taken_for_a_ternary_body_raises_the_class():
    graph = EXERCISE.solution.mistaken("multiple_pivot_as_ternary")
    given = {"joints": LIBRARY["figure_27"].records(), "driver": (1, 2)}
    assert graph.evaluate(("assour_class",), given) == {"assour_class": "III"}


def test_the_worked_solution_lists_the_groups():
    for lang, word in (("en", "bodies"), ("fr", "pièces")):
        for variant in EXERCISE.variants(range(5), lang):
            parts = decompose(variant.printed["joints"], variant.printed["driver"])
            for group in parts.groups:
                listed = f"{word} {', '.join(map(str, group.bodies))}"
                assert listed in variant.solution_text.section("groups").text


def test_labels_need_no_variant_though_the_statement_lists_joints():
    assert EXERCISE.texts.constants("exercises", "fr").labels["assour_class", "II"] == "classe II"
