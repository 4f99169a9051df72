"""Each known mistake of a construction is drawn by a hand that errs once, and named; a hand that does not err
has every point."""

import pytest
from paper_hand import PaperHand, one_mistake_each
from sweeps import sampled

import coursework

DRAWN = [name for name in coursework.open_course().names if coursework.open_course()[name].spec.drawing_mm]

#: Mistakes about what is read off a drawing, computed from it or known before: no line of it is wrong.
NOT_DRAWN = {
    "lengths_exchanged",
    "scale_forgotten",
    "value_sense",
    "sliding_sense",
    "ram_sense",
    "V_B_sense",
    "V_C_sense",
    "a_B_sense",
    "a_C_sense",
    "radii_exchanged",
    "crank_for_rod",
    "crank_for_guide",
    "omega3_of_V_B",
    "omega4_of_A2",
    "alpha3_of_a_B",
    "alpha4_of_a_B",
    "alpha4_of_A4",
    "rate_of_absolute_velocity",
    "nothing_known_of_B",
    "nothing_known_of_BA",
    "nothing_known_of_a_bar",
    "nothing_known_of_a_path",
    "nothing_known_of_sliding",
    "A4_moves_with_the_crank",
    "A1_and_B2_of_one_velocity",
    "no_slip_gives_the_length",
    "normal_part_unknown",
    "tangential_part_unknown",
    "direction_not_used",
    "velocities_not_used",
    "read_backwards",
    "clockwise",
    "bars_exchanged",
    "of_the_other_point",
    "Q_inverse",
    "advance_and_return_exchanged",
    "advantage_inverse",
    "angle_at_C",
    "swing_once",
}


@pytest.mark.parametrize("exercise", sampled(DRAWN))
def test_every_known_mistake_of_a_construction_is_named(exercise):
    variant = coursework.open_course()[exercise].variant(7, "en")
    hand = PaperHand(variant)
    assert {
        part: said for part, said in hand.construct().items() if said != "correct" and part in hand.texts
    } == {}
    wanted = {name for name in variant.exercise.solution.mistakes if name not in NOT_DRAWN}
    if exercise == "two_circles":
        wanted.add("radii_exchanged")
    for mistakes in one_mistake_each(variant):
        if not wanted:
            break
        wanted -= {
            said.removeprefix("mistake:") for said in PaperHand(variant, mistakes).construct().values()
        }
    assert wanted == set()
