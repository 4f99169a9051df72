"""Messages and points for an answer that is not right: hints to correct it, never the value."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence
from functools import partial, reduce
from typing import TYPE_CHECKING, Any

from coursework.course.answer_key import Key
from coursework.course.asked import KeySource
from coursework.language.words import listed, quoted, words
from coursework.marking.diagnosis import EarlierAnswers, Explanation, alternatives, explained, fits_followed
from coursework.marking.feedback import Sentence, echo, questions, say
from coursework.marking.mark import Mark, made_mark
from coursework.marking.usual import NAMED, whys
from coursework.markup.markdown import plain_line
from coursework.model import Part
from coursework.parsing.reading import Reading
from coursework.quantities.usual_errors import ALL_DEGREES

_FAR = 5  #: times a right value from which on the message names the order of magnitude
_TRIED = 3  #: wrong answers, of which fewer are tried for those that an answer follows from
_LISTED = 7  #: given quantities that a sentence lists

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def shown_as(variant: Variant, part: Part, reading: Reading, index: int) -> tuple[str, str]:
    """Return the text that was read: for the tables, and as a sentence quotes it."""
    read_as = reading.read_as[index]
    case = part.sort.words(reading.values[index], partial(variant.label, part.id))
    if not case:
        return read_as, echo(read_as, variant.lang)
    lettered = part.sort.words(reading.values[index], partial(variant.called, part))
    read_as, case = (plain_line(text, variant.lang) for text in (lettered, case))
    return read_as, quoted(echo(case, variant.lang), variant.lang)


def mark_wrong(
    variant: Variant, key: Key, part: Part, reading: Reading, judged_by: Part, before: EarlierAnswers
) -> Mark:
    """Return the mark of an answer that was read and is not right."""
    explanations = explained(key, part, reading, judged_by, before)
    matches = tuple(dict.fromkeys(e.verdict for e in explanations))
    named = _named(explanations, before)
    # The message is about the reading that it explains, else about the text as it stands.
    index = named[0].reading if named else 0
    read_as, read = shown_as(variant, part, reading, index)
    mark_of = partial(made_mark, variant, part, reading)
    paid = next((before.paid[t] for e in named for t in e.traces if t in before.paid), "")
    if paid and before.is_work(part, reading.values[index]):
        message = say(variant, part, "same_error", read=read, first=questions(variant, [paid], "and"))
        return mark_of("follow_through", key.rules.follow_through, read_as, message, matches)
    if named:
        for trace in (trace for e in named for trace in e.traces):
            before.paid.setdefault(trace, part.id)
        least = _right_share(key, part, reading.values[index], judged_by) if part.sort.share_stands else 0.0
        shares = {e.verdict: max(least, _share(key, e, matches)) for e in named}
        verdict = max(shares, key=shares.__getitem__)  # where nothing tells which, the one that costs least
        earlier = _followed_from(key, part, reading, judged_by, before) if _follows(named) else ()
        message = _explained_message(variant, part, judged_by, named, read, earlier)
        return mark_of(verdict, shares[verdict], read_as, message, matches)
    value, reference = reading.values[index], key.reference[judged_by.quantity]
    share = _right_share(key, part, value, judged_by)
    more = [Sentence(*remark) for remark in _remarks(variant, part, value, reference)]
    if share > 0:
        mark = mark_of("partial", share, read_as, say(variant, part, "partial", read=read), matches)
    else:
        mark = mark_of("wrong", 0.0, read_as, _unexplained_message(variant, part, read, before), matches)
        more += _size_remarks(variant, part, value, reference)
    return reduce(lambda marked, sentence: marked.saying(*sentence.texts(variant.lang)), more, mark)


def _remarks(
    variant: Variant, part: Part, value: Any, reference: Any
) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield the remarks of the part's kind on an unexplained answer, with the fillings of each sentence."""
    for sentence, remark in part.sort.remarks(part, value, reference, variant.lang):
        yield sentence, {"list": remark}


def _size_remarks(variant: Variant, part: Part, value: Any, reference: Any) -> Iterator[Sentence]:
    """Yield what the sign and the order of magnitude of a wrong number tell, of one that is not a
    direction."""
    sort = part.sort
    if not sort.is_number or sort.is_exact or sort.turn or not value or not reference:
        return
    table = words(variant.lang)["marking"]["size"]
    if value * reference < 0:
        yield Sentence(table["sign"], {})
    ratio = abs(value / reference)
    if ratio >= _FAR or ratio <= 1 / _FAR:
        yield Sentence(table["large" if ratio > 1 else "small"], {})


def _right_share(key: Key, part: Part, value: Any, judged_by: Part) -> float:
    """Return the share of the points for the components of an answer that are right."""
    return part.sort.share(part, value, key.reference[judged_by.quantity])


def _named(explanations: Sequence[Explanation], before: EarlierAnswers) -> list[Explanation]:
    """Return the explanations to report: one, or several that cannot be distinguished; none if they are too
    many.

    What an earlier answer shows is what this one shows, where it explains it.
    """
    if not explanations or not explanations[0].is_likely:
        return []
    if explanations[0].verdict != "follow_through":
        again = [e for e in explanations if e.is_likely and any(trace in before.paid for trace in e.traces)]
        if again:
            return again[:1]
    named = alternatives(explanations)
    return named if len(named) <= NAMED else []


def _share(key: Key, explanation: Explanation, matches: Collection[str]) -> float:
    kind, _, name = explanation.verdict.partition(":")
    if kind == "follow_through":
        in_other_case = "slip:other_case" in matches
        return min(key.rules.follow_through, key.rules.other_case if in_other_case else 1.0)
    if name == ALL_DEGREES and "slip:radians" in matches:  # the angle itself is right, in radians
        return max(key.rules.share(name), key.rules.share("radians"))
    return key.rules.share(name) if kind == "slip" else key.price(name)


def _explained_message(
    variant: Variant,
    part: Part,
    judged_by: Part,
    named: Sequence[Explanation],
    read: str,
    earlier: Sequence[str],
) -> Sentence:
    kind, _, name = named[0].verdict.partition(":")
    message_of = partial(say, variant, part, read=read)
    if kind == "follow_through":
        if not earlier:
            return message_of("follow_through")
        return message_of("follow_through_from", earlier=questions(variant, earlier, "and"))
    if kind == "mistake":
        hints = dict.fromkeys(variant.mistake_text(e.verdict.partition(":")[2]) for e in named)
        if len(hints) > 1:
            joint = words(variant.lang)["marking"]["one_of_these"]
            return message_of("mistake", says=f"{joint} {' — '.join(hints)}")
        return message_of("mistake", says=variant.mistake_text(name))
    errors = [e.error for e in named if e.error is not None]
    if errors:
        why, is_one = whys(variant, errors, judged_by.quantity)
        return message_of("usual_error" if is_one else "usual_errors", why=why)
    return message_of(f"slip_{name}")


def _follows(named: Sequence[Explanation]) -> bool:
    return named[0].verdict == "follow_through"


def _followed_from(
    key: Key, part: Part, reading: Reading, judged_by: Part, before: EarlierAnswers
) -> list[str]:
    """Return the fewest parts whose wrong answers an answer follows from, the others being right."""
    parts = _asked_above(key.variant, judged_by.quantity, before.wrong)
    nearest = [p.quantity for p in reversed(parts)]
    above = (p.quantity for p in reversed(key.variant.parts) if p.quantity in before.wrong)
    further = [q for q in above if judged_by.quantity in key.solution.depending_on(q) and q not in nearest]
    quantities = [*nearest, *further]
    for count in range(1, min(len(nearest), _TRIED)):
        for some in itertools.combinations(quantities, count):
            own_answers = {q: v for q, v in before.own.items() if q not in before.wrong or q in some}
            if fits_followed(key, part, reading, judged_by, own_answers, some) is not None:
                return [p.id for p in key.variant.parts if p.quantity in some]
    return [p.id for p in parts]


def _unexplained_message(variant: Variant, part: Part, read: str, before: EarlierAnswers) -> Sentence:
    """Return the message for an unexplained answer: the asked quantities that it depends on, and which of
    them are right."""
    table = words(variant.lang)["marking"]
    earlier = variant.parts[: variant.parts.index(part)]
    parts = _asked_above(variant, part.quantity, {p.quantity for p in earlier})
    parts = [p for p in parts if p in earlier and p.sort.is_called_by_symbol and not p.judge]
    if part.sort.wrong == "wrong" and not parts and (given := _given_above(variant, part.quantity)):
        return say(variant, part, "wrong_given", read=read, list=listed(given, variant.lang))
    if part.sort.wrong not in ("wrong", "wrong_place", "wrong_count") or not parts:
        return say(variant, part, part.sort.wrong, read=read)
    to_mend = [p for p in parts if p.quantity not in before.right]
    states: dict[str, list[str]] = {}
    for p in to_mend or parts:
        states.setdefault(before.state(p), []).append(f"${variant.solution_symbol(p.quantity)}$")
    groups = [
        (table["depends_on_many"] if len(symbols) > 1 else table["depends_on"])[state].format(
            listed(symbols, variant.lang)
        )
        for state, symbols in states.items()
    ]
    sentence = "wrong_from" if to_mend else "wrong_from_right"
    return say(variant, part, sentence, read=read, list=listed(groups, variant.lang))


def _given_above(variant: Variant, quantity: str) -> list[str]:
    """Return the symbols of the given quantities that one is computed from; none of so many that a list tells
    nothing."""
    graph = variant.exercise.solution.graph.textbook
    above = graph.ancestors((quantity,)) if quantity in graph.names else frozenset()
    given = [name for name in variant.stated if name in above and name != quantity]
    return [f"${variant.solution_symbol(name)}$" for name in given] if len(given) <= _LISTED else []


def _asked_above(variant: KeySource, quantity: str, among: set[str]) -> list[Part]:
    """Return the nearest parts that a quantity is computed from, of some quantities, in the order of the
    sheet."""
    graph = variant.exercise.solution.graph.textbook
    met: set[str] = set()
    names: set[str] = set()
    waiting = [quantity]
    while waiting:
        name = waiting.pop()
        for argument in graph.node(name).arguments if name in graph.names else ():
            if argument in among and argument != quantity:
                names.add(argument)
            elif argument not in met:
                met.add(argument)
                waiting.append(argument)
    return [part for part in variant.parts if part.quantity in names]
