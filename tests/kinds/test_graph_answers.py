"""Joint graphs as answers: read as people write them, judged joint by joint, and up to names where bodies
have none."""

from __future__ import annotations

import itertools
import random

import pytest
from sweeps import seeds
from tables import each_row

import coursework
from coursework.cli.demo import HABITS
from coursework.errors import BadCourse
from coursework.kinds.kind import kind_of
from coursework.model import Part
from coursework.parsing.graph_likeness import compare, names_that_fit
from coursework.parsing.graphs import edge, graph_of, in_order, read_graph, renamed
from coursework.structure.joints import JointGraph
from coursework.structure.numbered import to_count

#: A crank, its rod, a rocker and a second rod on one pin, a piston.
REFERENCE = "1-2 revolute, 2-3 revolute, 3-4-5 revolute, 1-4 revolute, 5-6 revolute, 1-6 prismatic"
GRAPH = graph_of(REFERENCE)
NAMED, UNNAMED = kind_of("graph"), kind_of("unnamed_graph")


def read(answer, *, named=True, reference=GRAPH):
    return read_graph(answer, reference, named=named)


@each_row(
    "answer",
    [
        REFERENCE,
        "1-2 pivot, 2-3 pivot, 3-4-5 pivot, 1-4 pivot, 5-6 pivot, 1-6 glissière",
        "2/1 R; 3/2 R; 3-4 R; 4-5 R; 1/4 R; 5/6 R; P 1/6",
        "1–2 R, 2−3 R, 3—5 R, 4-5 R, 1-4 R, 5-6 R, 1-6 P",
        "pivots : 1-2, 2-3, 3-4, 3-5, 1-4, 5-6 ; glissière : 1-6",
        "Pivots :\n1-2\n2-3\n3-4-5\n1-4\n5-6\nGlissière :\n1-6",
        "1-2, 2-3, 3-4-5, 1-4, 5-6 pivots, 1-6 slide",
        "R12 R23 R345 R14 R56 P16",
        "12 R, 23 R, 345 R, 14R, 56R, 16 P",
        "L12 pivot, L23 pivot, L345 pivot, L14 pivot, L56 pivot, L16 glissière",
        "L1/2 = pivot d'axe (O,z), L2/3 = pivot d'axe (A,z), L3/4/5 pivot, L1/4 pivot, L5/6 pivot, "
        "L1/6 = glissière d'axe x",
        "S1-S2 pivot, S2–S3 pivot, S3-S4 pivot S3-S5 pivot S1-S4 pivot S5-S6 pivot S1-S6 prismatic",
        "S_1/S_2 : pivot en O\nS_2/S_3 : pivot en A\nS_{3}/S_{4}/S_{5} : pivot en B\nS₁/S₄ : pivot en "
        "D\n S5/S6 : pivot C\n①/⑥ : glissière",
        "pivot entre 1 et 2, pivot entre 2 et 3, pivot commun à 3, 4 et 5, pivot entre 1 et 4, pivot "
        "entre 5 et 6, glissière entre 1 et 6",
        "liaison pivot 1/2\nliaison pivot 2/3\nliaison pivot 3/4\nliaison pivot 4/5\nliaison pivot "
        "1/4\nliaison pivot 5/6\nliaison glissière 1/6",
        "1 2 pivot, 2 3 pivot, 3 4 5 pivot, 1 4 pivot, 5 6 pivot, 1 6 slide",
        "1 -R- 2 -R- 3 -R- 4 -R- 1, 3 -R- 5 -R- 6 -P- 1",
        "1 pivot 2, 2 pivot 3, 3-4-5 pivot, 1 pivot 4, 5 pivot 6, 1 glissière 6",
        "bâti-2 pivot, 2-3 pivot, 3-4 et 4-5 pivots, 4-frame pivot, 5-6 pivot, 6-bâti glissière",
        "0-2 pivot, 2-3 pivot, 3-4-5 pivot, 0-4 pivot, 5-6 pivot, 0-6 glissière",
        "(1,2) R, (2,3) R, (3,4,5) R, (1,4) R, (5,6) R, (1,6) P",
        "[(1, 2, 'R'), (2, 3, 'R'), (3, 4, 'R'), (3, 5, 'R'), (1, 4, 'R'), (5, 6, 'R'), (1, 6, 'P')]",
        "| joint | \n| 1-2 | pivot |\n| 2-3 | pivot |\n| 3-4-5 | pivot |\n| 1-4 | pivot |\n| 5-6 | "
        "pivot |\n| 1-6 | glissiere |",
        "1) 1-2 pivot\n2) 2-3 pivot\n3) 3-4-5 pivot\n4) 1-4 pivot\n5) 5-6 pivot\n6) 1-6 slide",
        "L1: 1-2 pivot; L2: 2-3 pivot; L3: 3-4-5 pivot; L4: 1-4 pivot; L5: 5-6 pivot; L6: 1-6 slide",
        "A: 2-3 pivot; B: 3-4-5 pivot; O: 1-2 pivot; D: 1-4 pivot; P: 5-6 pivot; P: 1-6 slide",
        "1-2 pivot P, 2-3 pivot R, 3-4-5 pivot, 1-4 pivot, 5-6 pivot, 1-6 slide",
        "$1-2$ pivot, $2-3$ pivot, $3-4-5$ pivot, $1-4$ pivot, $5-6$ pivot, $1-6$ glissière",
        "1↔2 pivto, 2->3 pivot, 3↔4↔5 pivot, 1↔4 pivot, 5<->6 pivot, 1--6 glissiére",
        "1-2 hinge, 2-3 REVOLUTE JOINT, 3-4-5 pin joint, 1-4 Revolute, 5-6 rotoïde, 1-6 sliding",
        [[1, 2, "R"], [2, 3, "R"], [3, 4, 5, "R"], [1, 4, "R"], [5, 6, "R"], [1, 6, "P"]],
        [
            ((1, 2), "pivot"),
            ((2, 3), "pivot"),
            ((3, 4, 5), "pivot"),
            ((1, 4), "pivot"),
            ((5, 6), "pivot"),
            ((1, 6), "slide"),
        ],
        JointGraph.of(
            [{"between": list(map(int, joint.bodies)), "kind": joint.kind} for joint in GRAPH]
        ).records(),
        "1-2 P, 2-3 P, 3-4-5 P, 1-4 P, 5-6 P, 1-6 G",
    ],
)
def test_one_graph_in_the_ways_people_write_it(answer):
    reading = read(answer)
    assert reading.status == "read", reading
    assert any(NAMED.distance(None, value, REFERENCE) == 0 for value in reading.values), reading.read_as


def test_P_is_a_slide_unless_a_G_is_one_or_no_pivot_is_said_otherwise():
    assert [NAMED.share(None, v, REFERENCE) for v in read("1-6 P, 1-2 R").values] == [2 / 7]
    both = read("1-2 P").values
    assert [joint.kind for (joint,) in both] == ["prismatic", "revolute"]
    assert len(read("1-2 P, 1-6 G").values) == 1


@each_row(
    ("answer", "code", "found"),
    [
        ("1-2 pivot, 2-3 zorglub", "unknown_joint", "zorglub"),
        ("2-2 pivot", "one_body", "2-2"),
        ("pivot 4", "lone_body", "4"),
        ("pivot", "no_joint", "pivot"),
        ("-", "no_joint", "-"),
        ("∞ ≠ 3", "no_joint", None),
        ("1-2 pivot, " * 70, "too_long", None),
        ("x" * 5000, "too_long", None),
    ],
)
def test_what_is_no_list_of_joints_says_where_it_stops(answer, code, found):
    reading = read(answer)
    assert (reading.status, reading.code) == ("unreadable", code)
    assert found is None or reading.found == found


@each_row("answer", ["", "   \n", None])
def test_no_answer_is_missing(answer):
    assert read(answer).status == "missing"


@each_row(
    ("answer", "share", "told"),
    [
        ("1-2 R, 2-3 R, 3-4 R, 3-5 R, 1-4 R, 5-6 R", 6 / 7, {"missing": 1}),
        ("1-2 R, 2-3 R, 3-4 R, 3-5 R, 1-4 R, 5-6 R, 1-6 R", 6.5 / 7, {"kind": ["1–6"]}),
        ("1-2 R, 2-3 R, 3-4 R, 3-5 R, 1-4 R, 5-6 R\n1-6", 6.5 / 7, {"no_kind": ["1–6"]}),
        (REFERENCE + ", 2-4 R", 6 / 7, {"none": ["2–4"]}),
        (REFERENCE + ", 1-2 R", 6 / 7, {"double": ["1–2"]}),
        (REFERENCE + ", 1-9 R", 6 / 7, {"unknown": ["1–9"]}),
        (REFERENCE + ", 1-a R", 6 / 7, {"unknown": ["1–a"]}),
        (REFERENCE + ", 1-piston R", 6 / 7, {"unknown": ["1–piston"]}),
        ("1-2 R, 2-3 R, 3-4 R, 4-5 R, 3-5 R, 1-4 R, 5-6 R, 1-6 P", 6 / 7, {"shared": ["4–5"]}),
        ("1-2-3 R, 3-4-5 R, 1-4 R, 5-6 R, 1-6 P", 3 / 7, {"not_shared": ["1–2–3"], "missing": 2}),
        ("2-4 R, 2-5 R, 2-6 R", 0, {"none": ["2–4", "2–5", "2–6"], "missing": 7}),
    ],
)
def test_each_joint_gives_its_share_and_what_is_not_right_is_told(answer, share, told):
    (value,) = read(answer).values
    found = NAMED.compared(value, REFERENCE)
    assert found.share == pytest.approx(share)
    assert NAMED.share(None, value, REFERENCE) == pytest.approx(share)
    lists = ("kind", "no_kind", "none", "double", "shared", "not_shared", "unknown")
    assert {n: [str(joint) for joint in getattr(found, n)] for n in lists if getattr(found, n)} | (
        {"missing": found.missing} if found.missing else {}
    ) == told


def test_any_contact_is_a_higher_pair_and_a_ball_touches_at_a_point():
    cam = "1-2 revolute, 1-3 prismatic, 2-3 higher"
    for kind in (
        "contact",
        "came",
        "engrenage",
        "ponctuelle",
        "point contact",
        "roulement sans glissement",
        "H",
    ):
        (value,) = read(f"1-2 R, 1-3 P, 2-3 {kind}", reference=graph_of(cam)).values
        assert NAMED.distance(None, value, cam) == 0, kind
    ball = "0-3 point_contact, 0-1 revolute, 1-3 point_contact"
    (value,) = read("0-3 linéaire rectiligne, 0-1 R, 1-3 RSG", reference=graph_of(ball)).values
    assert [str(joint) for joint in NAMED.compared(value, ball).kind] == ["0–3"]


def test_two_joints_of_the_same_bodies_are_two():
    twice = "0-1 revolute, 0-3 point_contact, 0-3 point_contact, 1-3 point_contact"
    for answer in (
        "0-1 pivot, 0-3 ponctuelle ×2, 1-3 ponctuelle",
        "0-1 R, 2 x 0-3 contact, 3/1 contact",
        "0-3 contact en A, 0-3 contact en B, 0-1 pivot, 1-3 contact en C",
    ):
        (value,) = read(answer, reference=graph_of(twice)).values
        assert NAMED.distance(None, value, twice) == 0, answer
    (value,) = read("0-1 pivot, 0-3 contact, 1-3 contact", reference=graph_of(twice)).values
    assert NAMED.compared(value, twice).missing == 1


# ------------------------------------------------------------------------------ names


def shuffled(graph, seed):
    """The graph under other names, its shared pivots written as some pairs that span them."""
    rng = random.Random(seed)
    bodies = sorted({b for joint in graph for b in joint.bodies})
    others = [f"b{n}" for n in range(len(bodies))]
    rng.shuffle(others)
    spanned = []
    for joint in graph:
        order = rng.sample(joint.bodies, len(joint.bodies))
        if rng.random() < 0.5:
            spanned.append(joint)
            continue
        spanned += [edge((order[rng.randrange(n)], body), joint.kind) for n, body in enumerate(order) if n]
    return renamed(in_order(spanned), dict(zip(bodies, others, strict=True)))


@seeds(12, 40)
def test_a_graph_is_right_up_to_names_where_there_are_none(seeds):
    for number in (1000 + seed for seed in seeds):
        reference = JointGraph.of(to_count(number)).text
        other = shuffled(graph_of(reference), number)
        assert UNNAMED.distance(None, other, reference) == 0
        assert NAMED.share(None, other, reference) == 0.5, "right, but for the names"
        assert next(NAMED.remarks(None, other, reference, "en"))[0].startswith(
            "It is the graph of the mechanism"
        )
        # One joint of another kind, or between other bodies, is told from it.
        first = other[0]
        turned = (first._replace(kind="prismatic" if first.kind == "revolute" else "revolute"), *other[1:])
        assert UNNAMED.distance(None, turned, reference) > 1
        assert 0 < UNNAMED.share(None, turned, reference) < 1


def test_the_search_of_names_agrees_with_trying_them_all():
    rng = random.Random(7)
    met = set()
    for _ in range(300):
        pairs = [edge(rng.sample("1234", 2), rng.choice(("revolute", "prismatic"))) for _ in range(4)]
        mine = in_order(
            [edge(rng.sample("1234", 2), rng.choice(("revolute", "prismatic"))) for _ in range(4)]
        )
        reference = in_order(pairs)
        if rng.random() < 0.5:
            mine = renamed(reference, dict(zip("1234", rng.sample("1234", 4), strict=True)))
        bodies, others = ({b for joint in g for b in joint.bodies} for g in (mine, reference))
        ways = itertools.permutations(sorted(others))
        alike = len(bodies) == len(others) and any(
            compare(renamed(mine, dict(zip(sorted(bodies), way, strict=True))), reference).is_right
            for way in ways
        )
        assert (names_that_fit(mine, reference, {}) is not None) == alike
        met.add(alike)
    assert met == {True, False}


@each_row(
    ("answer", "is_right"),
    [
        ("a-b pivot, b-c pivot, c-d-e pivot, a-d pivot, e-f pivot, a-f glissière", True),
        (
            "frame-crank R, crank-rod R, rod-rocker-link R, frame-rocker R, link-piston R, frame-piston P",
            True,
        ),
        (
            "bâti-manivelle R, manivelle-bielle R, bielle-balancier R, bielle-tige R, balancier-bâti "
            "R, tige-piston R, "
            "piston-bâti P",
            True,
        ),
        ("0-1 R, 1-2 R, 2-3-4 R, 0-3 R, 4-5 R, 0-5 P", True),
        ("a-frame R, frame-c R, c-d-e R, a-d R, e-f R, a-f P", False),  # another body is the frame
        ("a-b R, b-c R, c-d R, d-e R, a-d R, e-f P, a-f R", False),
    ],
)
def test_bodies_without_names_are_called_as_one_likes_but_for_the_frame(answer, is_right):
    (value,) = read(answer, named=False).values
    assert (UNNAMED.distance(None, value, REFERENCE) == 0) == is_right
    assert UNNAMED.share(None, value, REFERENCE) > 0.5


def test_a_hostile_answer_is_not_searched_for_ever():
    reference = ", ".join(f"{n}-{n % 12 + 1} revolute" for n in range(1, 13))
    answer = in_order(edge((f"x{i}", f"x{j}"), "revolute") for i in range(12) for j in range(i))
    assert UNNAMED.distance(None, answer, reference) > 1
    assert names_that_fit(answer[:12], graph_of(reference), {}) is None


# ------------------------------------------------------------------------------- a part


@each_row("room", [0, "4", True, 50])
def test_its_room_is_a_number_of_lines(room):
    with pytest.raises(BadCourse, match="number of lines"):
        Part("g", kind="graph", room=room)


def test_every_name_of_a_kind_of_joint_means_one_kind():
    from coursework.language.words import languages, words
    from coursework.parsing.graph_tokens import kind_named

    for lang in languages():
        for kind, names in words(lang)["graph"]["kinds"].items():
            for name in names:
                assert kind_named(name) == kind, (lang, name)


def test_the_sheets_say_the_form_and_the_rule(tmp_path):
    from coursework.cli import run

    build = ["build", "joint_graph", "--variants", "1", "--formats", "html,ipynb,tex", "--lang", "fr,en"]
    assert run([*build, "--out", str(tmp_path)]) == 0
    pages = tmp_path / "handouts" / "joint_graph"
    page = next(pages.glob("*.en.html")).read_text("utf-8")
    assert 'autocorrect="off"' in page.partition("<textarea")[2].partition(">")[0], "P12 is no word to mend"
    assert "half of it where only its kind is wrong" in page
    assert "comme 1-2 pivot, 1-4 glissière" in next(pages.glob("*.fr.ipynb")).read_text("utf-8")
    assert "la moitié si seule sa nature" in next(pages.glob("*.fr.tex")).read_text("utf-8").replace(
        "\n", " "
    )


def test_a_student_alone_is_told_the_form(tmp_path):
    session = coursework.study("joint_graph", lang="en", folder=tmp_path)
    assert "write the two bodies of each" in str(session.check({"graph": "zz zz"}))
    assert "✓" in str(session.check({"graph": session.variant.solution()["graph"]}))


@pytest.mark.parametrize("name", ["joint_graph", "ball_reducer"])
def test_the_class_of_the_demonstration_answers_it(name):
    """Careful students write it in the words of their language."""
    variant = coursework.open_course()[name].variant(3, "fr")
    answers = [habit(variant, variant.key, variant.exercise.spec.part("graph"), 0) for habit in HABITS]
    assert "pivot" in answers[0]
    assert variant.grade({"graph": answers[0]})["graph"].verdict == "correct"
    for answer in answers:
        assert variant.grade({"graph": answer})["graph"].verdict != "unreadable"
