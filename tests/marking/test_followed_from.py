"""An answer that follows from wrong ones names as few of them as explain it, over all exercises."""

import itertools
import re

from sweeps import at_once

import coursework
from coursework.language.numbers import significant
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.marking.diagnosis import fits_followed

COURSE = coursework.open_course()
TOLD = words("en")["marking"]["follow_through_from"].partition("{earlier}")[0].rpartition(" ")[2]


def _wrong_sheet(variant, parts):
    """Each third answer with an error of its own, the others following from what stands above."""
    own = {}
    for place, part in enumerate(parts):
        followed = variant.key.followed(part, own, set(own)) if own else None
        value = float(variant.key.reference[part.quantity] if followed is None else followed)
        if followed is None or place % 3 == 1:
            value = value * 1.07 + (5 if part.sort.turn else 0)
        own[part.quantity] = float(significant(value, 7))
    return own


@at_once(COURSE.names, COURSE.names[::4])
def test_no_more_questions_are_named_than_an_answer_follows_from(names):
    tried, more = 0, []
    for variant in (COURSE[name].variant(0, "en") for name in names):
        parts = [p for p in variant.parts if p.kind in ("number", "angle") and not p.judge]
        own = _wrong_sheet(variant, parts)
        marking = variant.grade({p.id: repr(own[p.quantity]) for p in parts})
        wrong = [p.quantity for p in parts if marking[p.id].verdict != "correct"]
        for part in (p for p in parts if marking[p.id].verdict == "follow_through"):
            told = re.findall(r"\d+", marking[part.id].feedback.rpartition(TOLD)[2].partition(")")[0])
            reading = read(variant, part, repr(own[part.quantity]))
            above = wrong[: wrong.index(part.quantity)]
            tried += 1
            for some in (s for n in range(1, min(len(told), 3)) for s in itertools.combinations(above, n)):
                left = {q: v for q, v in own.items() if q not in wrong or q in some}
                if fits_followed(variant.key, part, reading, part, left, some) is not None:
                    more.append((variant.exercise.name, part.id, told, some))
                    break
    assert tried > 50 * len(names) / len(COURSE.names)
    assert not more, more
