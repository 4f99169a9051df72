"""The order of choices is the variant's: its seed's for ever, the record's where one was issued."""

import json
from collections import Counter

import pytest
from tables import each_row

import coursework
from coursework.course.lettering import printed_order
from coursework.errors import BadCourse, BadInput
from coursework.marking.marking import mark
from coursework.model import Part

GUIDE = "slotted_mechanism"


def guide(course):
    variants = course[GUIDE].variants(range(20), "en", ["guide"])
    return next(v for v in variants if v.parts), course[GUIDE].spec.part("guide")


def test_the_order_of_a_seed_is_the_same_for_ever():
    """Frozen: another order would give the sheets that were issued another key, were it not for their
    records."""
    part = Part("nature", kind="choice", choices=("rotation", "translation", "general"))
    found = ["".join(case[0] for case in printed_order("x", seed, part)) for seed in range(8)]
    assert found == FROZEN
    stated_otherwise = Part("nature", kind="choice", choices=("general", "rotation", "translation"))
    assert printed_order("x", 3, stated_otherwise) == printed_order("x", 3, part)


FROZEN = ["rgt", "trg", "gtr", "tgr", "rgt", "grt", "tgr", "grt"]


def test_every_order_is_as_frequent():
    part = Part("nature", kind="choice", choices=("rotation", "translation", "general"))
    found = Counter(printed_order("x", seed, part) for seed in range(6000))
    assert len(found) == 6
    assert all(850 < count < 1150 for count in found.values())


@each_row(
    ("stated", "printed"),
    [
        (("IV", "II", "none", "III"), ("II", "III", "IV", "none")),
        (("one", "minus_one", "zero"), ("minus_one", "zero", "one")),
        (("no", "yes"), ("yes", "no")),
        (("C", "A", "B"), ("A", "B", "C")),
    ],
)
def test_numbers_classes_letters_yes_and_no_keep_their_order(stated, printed):
    part = Part("q", kind="choice", choices=stated)
    assert {printed_order("x", seed, part) for seed in range(20)} == {printed}


def test_a_stated_order_is_kept_and_what_denies_the_rest_is_last():
    cases = ("both", "direction", "length", "neither")
    assert {
        printed_order("x", s, Part("q", kind="choice", choices=cases, ordered=True)) for s in range(20)
    } == {cases}
    shuffled = {printed_order("x", s, Part("q", kind="choice", choices=cases)) for s in range(60)}
    assert len(shuffled) == 6
    assert {order[-1] for order in shuffled} == {"neither"}


def test_parts_that_offer_the_same_offer_it_in_one_order(course):
    for variant in course["ball_reducer"].variants(range(20), "fr", ["all"]):
        orders = {
            variant.cases(p)
            for p in variant.parts
            if set(p.choices) == {"rotation", "translation", "helical"}
        }
        assert len(orders) == 1


def test_a_record_says_the_order_and_is_marked_by_it(course):
    variant, part = guide(course)
    record = json.loads(json.dumps(variant.record))
    assert record["parts"][0]["choices"] == list(variant.cases(part))
    right = variant.reference("guide")
    letter = variant.letters(part)[right]
    turned = json.loads(json.dumps(record))
    turned["parts"][0]["choices"].reverse()
    other = "b" if letter == "a" else "a"
    for told, answer in ((record, letter), (turned, other)):
        issued = course[GUIDE].from_record(told)
        assert mark(issued, {"guide": answer})["guide"].verdict == "correct"
        assert issued.record == told
        assert issued.in_language("fr").letters(part) == issued.letters(part)
        assert mark(issued, {"guide": other if answer == letter else letter})["guide"].verdict != "correct"


def test_a_record_without_an_order_has_no_letters_and_is_read_as_before(course):
    variant, part = guide(course)
    record = json.loads(json.dumps(variant.record))
    del record["parts"][0]["choices"]
    issued = course[GUIDE].from_record(record)
    assert issued.record == record
    assert not issued.letters(part)
    assert mark(issued, {"guide": variant.reference("guide")})["guide"].verdict == "correct"
    assert mark(issued, {"guide": "a"})["guide"].verdict == "unreadable"
    (question,) = issued.handout().questions
    assert (question.letters, [key for key, _ in question.choices]) == ((), list(part.choices))


def test_a_variant_in_another_process_keeps_its_order(course):
    import pickle

    variant, part = guide(course)
    record = json.loads(json.dumps(variant.record))
    record["parts"][0]["choices"].reverse()
    issued = course[GUIDE].from_record(record)
    assert pickle.loads(pickle.dumps(issued)).cases(part) == issued.cases(part) != variant.cases(part)


@each_row("order", [["oscillates", "oscilates"], ["rotates", "rotates"]])
def test_a_record_that_offers_what_is_none_is_refused(course, order):
    record = json.loads(json.dumps(guide(course)[0].record))
    record["parts"][0]["choices"] = order
    with pytest.raises(BadInput, match="guide"):
        course[GUIDE].from_record(record)


def test_there_are_letters_for_no_more_than_the_alphabet():
    with pytest.raises(BadCourse, match="27 choices"):
        Part("q", kind="choice", choices=tuple(f"case_{n}" for n in range(27)))
    with pytest.raises(BadCourse, match="'ordered'"):
        Part("q", ordered=True)


def test_the_letter_of_the_right_choice_tells_nothing(course):
    """Over many variants every letter is right about as often as another, where the order is the seed's."""
    part = course[GUIDE].spec.part("guide")
    variants = course[GUIDE].variants(range(120), "en", ["guide"])
    found = Counter(v.letters(part)[v.reference("guide")] for v in variants if v.parts)
    assert min(found["a"], found["b"]) > 0.35 * found.total()
    assert coursework.Variant is type(variants[0])
