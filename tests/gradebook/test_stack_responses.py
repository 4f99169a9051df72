"""Responses of STACK in Moodle's report, and labels that name a unit."""

from tables import each_row

from coursework.gradebook.item_label import ItemLabel, label_in
from coursework.gradebook.stack_responses import stack_answers

#: As STACK 4.11 summed up an attempt in a Moodle 4.5, of `four_bar_positions`, in French.
RECORDED = (
    'Seed: 1; ans1: "b" [score]; ans2: 12,5 mm [invalid]; ans3: 1,2.3 [invalid]; ans4: 1 [score]; '
    'ans5: "2" [score]; '
    'ans6: "104,6°; \\"x\\" ans7: 3 [score]; ans8: 2" [score]; ans7: "L\'angle [1] & <b>" [score]; '
    'ans8: "1" [score]; '
    "ans9: 2 [score]; prt1: # = 0 | prt1-1-F | prt1-2-F | ATLogic_True. | prt1-3-case b; prt2: !; prt3: !; "
    "prt4: # = 0 | prt4-1-F; prt9: # = 0 | prt9-1-F"
)


def test_what_was_typed_in_each_box_comes_back_as_it_was():
    assert stack_answers(RECORDED) == {
        1: "b",
        2: "12,5 mm",
        3: "1,2.3",
        4: "1",
        5: "2",
        6: '104,6°; "x" ans7: 3 [score]; ans8: 2',
        7: "L'angle [1] & <b>",
        8: "1",
        9: "2",
    }


@each_row(
    ("text", "answers"),
    [
        ("Seed: 1; ans1: EMPTYANSWER [score]; ans3: 2.3 rad [score]; prt1: !", {1: "", 3: "2.3 rad"}),
        ('Seed: 1; ans1: ["a","c"] [valid]', {1: "a, c"}),
        ("Seed: 1; ans2: -2.09028e4 [score]", {2: "-2.09028e4"}),
        ("Seed: 1", {}),
        ("part 1: 238.4 mm; part 2: a", None),
        ("Seed: 1; ans1: 1 [score]; ans2: 5 [invalid]; ans2: 3 [score]; prt1: !", None),
        ("Seed: 1; ans1: 1 [score]; something else", None),
    ],
)
def test_responses_of_stack(text, answers):
    assert stack_answers(text) == answers


@each_row(
    ("text", "label"),
    [
        ("x [bolt · 3 · v1 · en · radius · mm]", ItemLabel("bolt", "3", "1", "en", "radius", "mm")),
        ("[bolt · 3 · v1 · en · moment · mN·m]", ItemLabel("bolt", "3", "1", "en", "moment", "mN·m")),
        ("[bolt · 3 · v1 · en · mass · 10⁻⁶ kg]", ItemLabel("bolt", "3", "1", "en", "mass", "10⁻⁶ kg")),
        ("[bolt · 3 · v1 · en · mass]", ItemLabel("bolt", "3", "1", "en", "mass")),
        ("[bolt · 3 · v1 · en]", ItemLabel("bolt", "3", "1", "en")),
    ],
)
def test_a_label_may_name_the_unit_that_was_asked(text, label):
    assert label_in(text) == label
