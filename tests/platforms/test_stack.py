"""The STACK export, read back by another reader whose trees run in Python, agrees with our marking."""

from __future__ import annotations

import base64
import re
from xml.etree import ElementTree as ET

import pytest
from platforms.stack_reader import questions_of, score
from tables import each_row

from coursework.api import open_course
from coursework.authoring.scaffold import new_course
from coursework.marking.marking import mark
from coursework.platforms._maxima import Unprintable, printed, text
from coursework.platforms.platform import platform_of
from coursework.platforms.pools import of_exercises
from coursework.platforms.posed import mark_alone

LANGS = ("en", "fr")
EXERCISES = ("slotted_mechanism", "four_bar_positions", "vocabulary", "mobility", "slider_crank")
JUDGED = {"algebraic", "radio", "checkbox"}


@pytest.fixture(scope="module")
def drawn(course):
    return of_exercises(course, EXERCISES, 2, 0, LANGS, None)


STACK = platform_of("stack")


def written(pool):
    (file,) = STACK.files(pool)
    return b"".join(file.make())


@pytest.fixture(scope="module")
def read(drawn):
    return {lang: questions_of(written(drawn.pool(lang, STACK))) for lang in LANGS}


def asked(drawn, read, lang):
    """Each question with its variant and the parts that STACK judges, by number."""
    variants = {(i.variant.exercise.name, str(i.variant.seed)): i.variant for i in drawn.issues}
    for name, question in read[lang][0].items():
        exercise, seed, _, of = name[1:-1].split(" · ")
        assert of == lang
        variant = variants[exercise, seed].in_language(lang)
        numbers = (int(tree.removeprefix("prt")) for tree in question["trees"])
        yield question, variant, {place: variant.parts[place - 1] for place in numbers}


@each_row("lang", LANGS)
@pytest.mark.e2e
def test_a_question_a_variant_asks_all_parts_and_is_worth_those_it_judges(drawn, read, lang):
    assert len(read[lang][0]) == 10
    assert len(read[lang][1]) == 5
    for question, variant, judged in asked(drawn, read, lang):
        assert list(question["inputs"]) == [f"ans{i}" for i in range(1, len(variant.parts) + 1)]
        for name, box in question["inputs"].items():
            assert question["text"].count(f"[[input:{name}]]") == 1
            assert question["text"].count(f"[[validation:{name}]]") == 1
            assert (f"prt{name[3:]}" in question["trees"]) == (box["type"] in JUDGED)
        for tree in question["trees"]:
            assert question["text"].count(f"[[feedback:{tree}]]") == 1
        assert question["grade"] == sum(part.points for part in judged.values())
        assert {tree["value"] for tree in question["trees"].values()} <= {p.points for p in judged.values()}
        assert question["decimals"] == {"en": ".", "fr": ","}[lang]
        for name in re.findall(r'src="@@PLUGINFILE@@/([^"]+)"', question["text"]):
            ET.fromstring(base64.b64decode(question["files"][name]))
        # STACK hands a text that has a file to Maxima whole, unless a block divides it.
        assert bool(question["files"]) == (question["text"].count("[[if ") == 1)


def test_numbers_are_judged_as_we_judge_them_with_their_mistakes(drawn, read):
    tried = known = 0
    for question, variant, judged in asked(drawn, read, "en"):
        for place, part in judged.items():
            if part.choices:
                continue
            box, reference, half = (
                f"ans{place}",
                float(variant.key.reference[part.quantity]),
                variant.key.half_width(part),
            )
            turn = part.sort.turn
            for value in {reference + off * (half or 0.6) for off in (0, 0.99, -0.99, 1.01, -1.01)} | {
                reference + 3 * turn,
                -reference,
            }:
                value = value if half else round(value)
                ours = mark_alone(variant, part, repr(value))
                theirs, _ = score(question, f"prt{place}", {box: value})
                assert (theirs == 1) == (ours.verdict == "correct"), (variant.exercise.name, part.id, value)
                tried += 1
            for name, wrong in variant.key.wrong_ways(part.quantity):
                ours = mark_alone(variant, part, repr(wrong)) if isinstance(wrong, (int, float)) else None
                if ours is not None and ours.verdict == f"mistake:{name}":
                    theirs, node = score(question, f"prt{place}", {box: wrong})
                    assert theirs == pytest.approx(ours.points / ours.out_of), (part.id, name)
                    assert node["says"] if node else not ours.points
                    known += bool(node)
    assert tried > 200
    assert known > 60


def test_a_right_method_from_a_wrong_answer_is_followed_as_we_follow_it(drawn, read):
    followed = 0
    for question, variant, judged in asked(drawn, read, "en"):
        numbers = {place: part for place, part in judged.items() if not part.choices}
        for first, part in numbers.items():
            own = {part.quantity: float(variant.key.reference[part.quantity]) * 1.1}
            for later in variant.parts[first:]:
                if later in numbers.values() and later.quantity in variant.key.solution.depending_on(
                    part.quantity
                ):
                    own[later.quantity] = float(variant.key.followed(later, own, {part.quantity}) or 0.0)
            answers = {p.id: repr(own[p.quantity]) for p in variant.parts if p.quantity in own}
            ours = mark(variant, answers)
            typed = {f"ans{i}": own.get(p.quantity) for i, p in numbers.items()}
            typed = {name: value for name, value in typed.items() if value is not None}
            for place, later in numbers.items():
                if place <= first or later.quantity not in own or ours[later.id].verdict != "follow_through":
                    continue
                nodes = question["trees"][f"prt{place}"]["nodes"].values()
                if any(node["note"].endswith("follow_through") for node in nodes):
                    share, node = score(question, f"prt{place}", typed)
                    assert share == 1, (variant.exercise.name, part.id, later.id)
                    followed += node["note"].endswith("follow_through")
    assert followed >= 20


def test_what_stack_cannot_follow_is_listed_as_lost(drawn, read):
    lost = {(loss.exercise, loss.part) for loss in STACK.losses(drawn.pool("en", STACK))}
    found = set()
    for question, variant, judged in asked(drawn, read, "en"):
        for place, part in judged.items():
            notes = [node["note"] for node in question["trees"][f"prt{place}"]["nodes"].values()]
            before = variant.parts[: place - 1]
            may = any(part.quantity in variant.key.solution.depending_on(p.quantity) for p in before)
            if may and not part.choices and not any("follow_through" in note for note in notes):
                found.add((variant.exercise.name, part.id))
    assert lost <= found
    assert ("slider_crank", "r1_dot") in lost


def test_nothing_follows_from_what_was_no_attempt(drawn, read):
    question, variant, judged = next(asked(drawn, read, "en"))
    assert "co_tried(v,r) := is(abs(v)<=100*abs(r) and 100*abs(v)>=abs(r));" in question["variables"]
    at = next(place for place, part in judged.items() if part.id == "a_centripetal")
    r, w = float(variant.key.reference["rA"]), float(variant.key.reference["omega4"])
    boxes = {p.id: f"ans{i}" for i, p in enumerate(variant.parts, start=1)}
    for factor, share in ((1.1, 1), (90, 1), (1e4, 0), (1e-4, 0)):
        typed = {boxes["rA"]: r * factor, boxes["omega4"]: w, boxes["a_centripetal"]: -r * factor * w**2}
        assert score(question, f"prt{at}", typed)[0] == share
    blank = {boxes["omega4"]: w * 1.1, boxes["a_centripetal"]: -r * (w * 1.1) ** 2}
    assert score(question, f"prt{at}", blank)[0] == 1


@each_row("lang", LANGS)
def test_choices_earn_and_say_what_ours_do(drawn, read, lang):
    tried = 0
    for question, variant, judged in asked(drawn, read, lang):
        for place, part in judged.items():
            for case, letter in variant.letters(part).items() if part.choices else ():
                ours = mark_alone(variant, part, case)
                theirs, node = score(question, f"prt{place}", {f"ans{place}": letter})
                assert theirs == pytest.approx(ours.points / ours.out_of)
                assert bool(node and node["says"]) == (ours.verdict != "correct" and bool(ours.says))
                tried += 1
    assert tried > 50


def test_the_trials_that_a_question_carries_hold_here_too(read):
    trials = 0
    for question in read["fr"][0].values():
        for trial in question["trials"]:
            typed = {name: _typed(value) for name, value in trial["answers"].items()}
            for tree, expected in trial["expected"].items():
                assert score(question, tree, typed)[0] == pytest.approx(expected)
                trials += 1
        assert set(question["trials"][0]["expected"].values()) == {1.0}
        assert any(share < 1 for trial in question["trials"] for share in trial["expected"].values())
    assert trials > 200


def _typed(value):
    if value.startswith('"'):
        return value.strip('"')
    return float(value.strip("()")) if value else None


def test_identifiers_are_short_and_those_of_two_languages_differ(read):
    names = [{one["idnumber"] for one in read[lang][0].values()} for lang in LANGS]
    assert not names[0] & names[1]
    assert all(len(name) <= 100 for some in names for name in some)


HOSTILE = '[[input:ans9]] {@quit()@} {#x#} ]]> "\\\\" <b>&'


def test_hostile_words_run_nothing(tmp_path):
    new_course(tmp_path / "c")
    exercises, solutions = tmp_path / "c" / "exercises", tmp_path / "c" / "solutions"
    (exercises / "bolt.py").write_text(
        "from coursework.model import Exercise, Part, drawn\n\n"
        'EXERCISE = Exercise(given={"d": drawn(3, 9, step=0.5, unit="mm")},\n'
        '    parts=(Part("fits", kind="choice", choices=("yes", "no"), points=1),))\n'
    )
    (solutions / "bolt.py").write_text(
        'import numpy as np\n\n\ndef fits(d):\n    return np.where(np.asarray(d) > 2, "yes", "no")\n\n\n'
        'KNOWN = [({"d": 4}, {"fits": "yes"})]\n'
    )
    for lang in LANGS:
        (exercises / f"bolt.{lang}.md.j2").write_text(
            "{% raw %}# A bolt\n\nIt is "
            + HOSTILE
            + ".\n\n## fits\nDoes it?\n- yes: it does "
            + HOSTILE
            + "\n- no: it does not\n{% endraw %}"
        )
    pool = of_exercises(open_course(tmp_path / "c"), ["bolt"], 1, 0, ["en"], None).pool("en", STACK)
    (question,) = questions_of(written(pool))[0].values()
    assert re.findall(r"\[\[[^\]]*\]\]", question["text"]) == [
        "[[input:ans1]]",
        "[[validation:ans1]]",
        "[[feedback:prt1]]",
    ]
    for said in (question["text"], question["variables"]):
        assert "{@" not in said.replace("co_", "")
        assert "{#" not in said
    assert "&#91;&#91;input:ans9]]" in question["variables"]
    assert score(question, "prt1", {"ans1": "a"})[0] + score(question, "prt1", {"ans1": "b"})[0] == 1


def test_texts_and_formulas_as_maxima_reads_them():
    import ast

    from coursework import degrees

    assert text('a"b\\') == '"a\\"b\\\\"'
    tree = ast.parse("2 * cos(x) ** 2 - abs(-y)", mode="eval").body
    space = {"cos": degrees.cos}
    assert printed(tree, {"x": "v1", "y": "v2"}.__getitem__, space) == "((2*(cos(v1*%pi/180)^2))-cabs((-v2)))"
    with pytest.raises(Unprintable):
        printed(ast.parse("x if x else y", mode="eval").body, {"x": "v1", "y": "v2"}.__getitem__, space)
    with pytest.raises(Unprintable):
        printed(ast.parse("open(x)", mode="eval").body, {"x": "v1"}.__getitem__, {"open": open})
