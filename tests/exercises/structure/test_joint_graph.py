"""The joint graph of a scheme: the list of its edges against the records, and the mistakes in drawing it."""

import re

import pytest
from tables import each_row

import coursework
from coursework.structure import LIBRARY, JointGraph

EXERCISE = coursework.open_course()["joint_graph"]
SOLUTION = EXERCISE.solution


@each_row("figure", LIBRARY)
def test_the_edges_are_those_of_the_records_counted_by_hand(figure):
    records = LIBRARY[figure].records()
    pairs = sum(len(r["between"]) - 1 for r in records)
    bodies = len({b for r in records for b in r["between"]})
    found = EXERCISE.solve(joints=records)
    assert (found["N"], found["L"], found["gamma"]) == (bodies, pairs, pairs - bodies + 1)
    listed = {(tuple(map(int, w.split()[0].split("-"))), w.split()[1]) for w in found["graph"].split(", ")}
    assert listed == {(tuple(sorted(r["between"])), r["kind"]) for r in records}


def test_the_order_of_the_list_is_of_no_account():
    records = LIBRARY["figure_27"].records()
    turned = [{**r, "between": r["between"][::-1]} for r in reversed(records)]
    assert EXERCISE.solve(joints=turned) == EXERCISE.solve(joints=records)


def mistaken(name, figure):
    given = {"joints": LIBRARY[figure].records()}
    return SOLUTION.mistaken(name).evaluate(("graph", "N", "L", "gamma"), given)


def test_three_bodies_on_one_pivot_are_two_edges():
    wrong = mistaken("every_pair_of_a_shared_pivot", "figure_27")
    assert "3-4 revolute, 3-5 revolute, 4-5 revolute" in wrong["graph"]
    assert (wrong["L"], wrong["gamma"]) == (8, 3)
    assert mistaken("shared_pivot_once", "figure_27")["L"] == 6


def test_the_frame_is_a_vertex():
    wrong = mistaken("frame_left_out", "figure_13")
    assert (wrong["N"], wrong["L"]) == (5, 4)
    assert "1-" not in wrong["graph"]
    assert mistaken("notes_N_without_frame", "figure_13")["gamma"] == 3, "as the notes print it"


def variant_with(condition):
    return next(v for v in EXERCISE.variants(range(200), "en") if condition(v.printed["joints"]))


def test_a_mistake_is_named_and_its_joints_count_all_the_same():
    slide = variant_with(lambda joints: sum(j["kind"] == "prismatic" for j in joints) == 1)
    right = slide.solution()
    mark = slide.grade({"graph": right["graph"].replace("prismatic", "revolute")})["graph"]
    assert mark.verdict == "mistake:slides_as_pivots"
    assert mark.points == pytest.approx(mark.out_of * (right["L"] - 0.5) / right["L"])


def test_what_is_not_joined_is_named_and_what_is_missing_is_only_counted():
    variant = variant_with(lambda joints: len(joints) == 7 and all(len(j["between"]) == 2 for j in joints))
    first, *rest = variant.solution()["graph"].split(", ")
    mark = variant.grade({"graph": ", ".join(rest) + ", 1-77 pivot"})["graph"]
    assert mark.verdict == "partial"
    assert mark.points == pytest.approx(mark.out_of * 5 / 7)
    assert "does not have: 1–77" in mark.feedback
    assert "still missing: 1." in mark.feedback
    pair = first.split()[0].replace("-", "–")
    assert pair not in mark.feedback


def test_the_graph_of_the_records_is_right_in_every_variant():
    for variant in EXERCISE.variants(range(40), "fr"):
        graph = JointGraph.of(variant.printed["joints"])
        french = {"revolute": "pivot", "prismatic": "glissière", "higher": "contact"}
        answer = "\n".join(f"{french[j.kind]} {'/'.join(map(str, reversed(j.bodies)))}" for j in graph.joints)
        assert variant.grade({"graph": answer})["graph"].verdict == "correct"


def test_the_words_of_the_figure_give_every_joint_by_its_bodies_and_do_not_list_the_graph():
    """Who does not see the scheme puts the graph together from what each body carries."""
    for variant in EXERCISE.variants(range(20), "en"):
        said = variant.text.section("figure").text
        joints = variant.printed["joints"]
        carried = {}
        for body, letters in re.findall(r"(The frame|body \d+) has: ([a-z](?:, [a-z])*)[.;]", said):
            for letter in letters.split(", "):
                carried.setdefault(letter, set()).add(1 if body == "The frame" else int(body.split()[1]))
        assert [carried[letter] for letter in sorted(carried)] == [set(j["between"]) for j in joints]
        assert " between " not in said
