"""What is said of an answer that is not right, and what it earns: where to mend it, and never the value."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from coursework.course.answer_key import Key
from coursework.course.asked import Asked
from coursework.language.words import listed, quoted, words
from coursework.marking.explaining import Before, Explanation, alternatives, explained, fits_followed
from coursework.marking.feedback import Said, echo, questions, say, symbol
from coursework.marking.mark import Mark, made_mark
from coursework.marking.usual import NAMED, whys
from coursework.markup.markdown import plain_line
from coursework.model import Part
from coursework.quantities.usual_errors import ALL_DEGREES
from coursework.reading.reading import Reading

_FAR = 5  #: times a right value from which on the order of magnitude is told
_LISTED = 7  #: given quantities that a sentence lists

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def shown_as(variant: Variant, part: Part, reading: Reading, index: int) -> tuple[str, str]:
    """What was read, for the tables, and as a sentence quotes it."""
    read_as = reading.read_as[index]
    case = part.sort.words(reading.values[index], partial(variant.label, part.id))
    if not case:
        return read_as, echo(read_as, variant.lang)
    lettered = part.sort.words(reading.values[index], partial(variant.called, part))
    read_as, case = (plain_line(said, variant.lang) for said in (lettered, case))
    return read_as, quoted(echo(case, variant.lang), variant.lang)


def mark_wrong(
    variant: Variant, key: Key, part: Part, reading: Reading, judged_by: Part, before: Before
) -> Mark:
    """The mark of an answer that was read and is not right."""
    found = explained(key, part, reading, judged_by, before)
    matches = tuple(dict.fromkeys(e.verdict for e in found))
    named = _named(found, before)
    # What is told is told of the reading that it explains, else of the text as it stands.
    index = named[0].reading if named else 0
    read_as, read = shown_as(variant, part, reading, index)
    made = partial(made_mark, variant, part, reading)
    paid = next((before.paid[t] for e in named for t in e.traces if t in before.paid), "")
    if paid and before.is_work(part, reading.values[index]):
        said = say(variant, part, "same_error", read=read, first=questions(variant, [paid], "and"))
        return made("follow_through", key.rules.follow_through, read_as, said, matches)
    if named:
        for trace in (trace for e in named for trace in e.traces):
            before.paid.setdefault(trace, part.id)
        least = _right_share(key, part, reading.values[index], judged_by) if part.sort.share_stands else 0.0
        shares = {e.verdict: max(least, _share(key, e, matches)) for e in named}
        verdict = max(shares, key=shares.__getitem__)  # where nothing tells which, the one that costs least
        earlier = _followed_from(key, part, reading, judged_by, before) if _follows(named) else ()
        said = _told(variant, part, judged_by, named, read, earlier)
        return made(verdict, shares[verdict], read_as, said, matches)
    value, reference = reading.values[index], key.reference[judged_by.quantity]
    share = _right_share(key, part, value, judged_by)
    more = [Said(*remark) for remark in _remarks(variant, part, value, reference)]
    if share > 0:
        mark = made("partial", share, read_as, say(variant, part, "partial", read=read), matches)
    else:
        mark = made("wrong", 0.0, read_as, _told_wrong(variant, part, read, before), matches)
        more += _size_remarks(variant, part, value, reference)
    return mark._replace(told=(*mark.told, *more))


def _remarks(
    variant: Variant, part: Part, value: Any, reference: Any
) -> Iterator[tuple[str, dict[str, str]]]:
    """What its kind tells of an answer that nothing explains, with what fills each sentence."""
    for sentence, told in part.sort.remarks(part, value, reference, variant.lang):
        yield sentence, {"list": told}


def _size_remarks(variant: Variant, part: Part, value: Any, reference: Any) -> Iterator[Said]:
    """Yield what the sign and the order of magnitude of a wrong number tell, of one that is no direction."""
    sort = part.sort
    if not sort.is_number or sort.is_exact or sort.turn or not value or not reference:
        return
    table = words(variant.lang)["marking"]["size"]
    if value * reference < 0:
        yield Said(table["sign"], {})
    ratio = abs(value / reference)
    if ratio >= _FAR or ratio <= 1 / _FAR:
        yield Said(table["large" if ratio > 1 else "small"], {})


def _right_share(key: Key, part: Part, value: Any, judged_by: Part) -> float:
    """What an answer earns for what is right of it."""
    return part.sort.share(part, value, key.reference[judged_by.quantity])


def _named(found: Sequence[Explanation], before: Before) -> list[Explanation]:
    """What is told as the explanation: one, or several of which nothing tells which it was; none of too many.

    What an earlier answer shows is what this one shows, where it explains it.
    """
    if not found or not found[0].is_likely:
        return []
    if found[0].verdict != "follow_through":
        again = [e for e in found if e.is_likely and any(trace in before.paid for trace in e.traces)]
        if again:
            return again[:1]
    named = alternatives(found)
    return named if len(named) <= NAMED else []


def _share(key: Key, explanation: Explanation, matches: Collection[str]) -> float:
    kind, _, name = explanation.verdict.partition(":")
    if kind == "follow_through":
        in_other_case = "slip:other_case" in matches
        return min(key.rules.follow_through, key.rules.other_case if in_other_case else 1.0)
    if name == ALL_DEGREES and "slip:radians" in matches:  # the angle itself is right, in radians
        return max(key.rules.share(name), key.rules.share("radians"))
    return key.rules.share(name) if kind == "slip" else key.price(name)


def _told(
    variant: Variant,
    part: Part,
    judged_by: Part,
    named: Sequence[Explanation],
    read: str,
    earlier: Sequence[str],
) -> Said:
    kind, _, name = named[0].verdict.partition(":")
    tell = partial(say, variant, part, read=read)
    if kind == "follow_through":
        if not earlier:
            return tell("follow_through")
        return tell("follow_through_from", earlier=questions(variant, earlier, "and"))
    if kind == "mistake":
        hints = dict.fromkeys(variant.told(e.verdict.partition(":")[2]) for e in named)
        if len(hints) > 1:
            joint = words(variant.lang)["marking"]["one_of_these"]
            return tell("mistake", says=f"{joint} {' — '.join(hints)}")
        return tell("mistake", says=variant.told(name))
    errors = [e.error for e in named if e.error is not None]
    if errors:
        why, is_one = whys(variant, errors, judged_by.quantity)
        return tell("usual_error" if is_one else "usual_errors", why=why)
    return tell(f"slip_{name}")


def _follows(named: Sequence[Explanation]) -> bool:
    return named[0].verdict == "follow_through"


def _followed_from(key: Key, part: Part, reading: Reading, judged_by: Part, before: Before) -> list[str]:
    """The parts whose wrong answers an answer follows from: without one of them it would be another."""
    asked = _asked_above(key.variant, judged_by.quantity, before.wrong)
    quantities = [p.quantity for p in asked]
    left = list(before.wrong)
    for quantity in quantities if len(quantities) > 1 else ():
        others = [q for q in left if q != quantity]
        own = {q: v for q, v in before.own.items() if q not in before.wrong or q in others}
        if fits_followed(key, part, reading, judged_by, own, others) is not None:
            left = others
    return [p.id for p in asked if p.quantity in left]


def _told_wrong(variant: Variant, part: Part, read: str, before: Before) -> Said:
    """What an answer that nothing explains is computed from, of what was asked, and which of that is right."""
    table = words(variant.lang)["marking"]
    earlier = variant.parts[: variant.parts.index(part)]
    asked = _asked_above(variant, part.quantity, {p.quantity for p in earlier})
    asked = [p for p in asked if p in earlier and p.sort.is_called_by_symbol and not p.judge]
    if part.sort.wrong == "wrong" and not asked and (given := _given_above(variant, part.quantity)):
        return say(variant, part, "wrong_given", read=read, list=listed(given, variant.lang))
    if part.sort.wrong not in ("wrong", "wrong_place", "wrong_count") or not asked:
        return say(variant, part, part.sort.wrong, read=read)
    to_mend = [p for p in asked if p.quantity not in before.right]
    told = [
        table["depends_on"][before.state(p)].format(f"${symbol(variant, p.quantity)}$")
        for p in to_mend or asked
    ]
    sentence = "wrong_from" if to_mend else "wrong_from_right"
    return say(variant, part, sentence, read=read, list=listed(told, variant.lang))


def _given_above(variant: Variant, quantity: str) -> list[str]:
    """Return the symbols of the given quantities that one is computed from; none of so many that a list tells nothing."""
    graph = variant.exercise.solution.graph.textbook
    above = graph.ancestors((quantity,)) if quantity in graph.names else frozenset()
    given = [
        name
        for name, value in variant.given.items()
        if name in above and name != quantity and not isinstance(value, str)
    ]
    return [f"${symbol(variant, name)}$" for name in given] if len(given) <= _LISTED else []


def _asked_above(variant: Asked, quantity: str, among: set[str]) -> list[Part]:
    """The nearest parts that a quantity is computed from, of some quantities, in the order of the sheet."""
    graph = variant.exercise.solution.graph.textbook
    met: set[str] = set()
    found: set[str] = set()
    waiting = [quantity]
    while waiting:
        name = waiting.pop()
        for argument in graph.node(name).arguments if name in graph.names else ():
            if argument in among and argument != quantity:
                found.add(argument)
            elif argument not in met:
                met.add(argument)
                waiting.append(argument)
    return [part for part in variant.parts if part.quantity in found]
