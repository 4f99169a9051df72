"""Marks of parts that are judged together: drawings, demands that many answers meet, equations of a loop."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any

from coursework.course.answer_key import Key
from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.marking.diagnosis import EarlierAnswers, mistakes_that_fit
from coursework.marking.feedback import Sentence, amount, echo, either_symbol, questions, say
from coursework.marking.judges import Verdict, is_scale, judged
from coursework.marking.mark import Mark, made_mark
from coursework.model import Part
from coursework.parsing.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def shares_remark(earlier: Part, part: Part, together: Mapping[str, Verdict]) -> bool:
    """Return whether the message for a judged part already stands with an earlier part of its group."""
    same_group = part.judge and earlier.judge == part.judge and earlier.id in together
    return bool(same_group) and together[earlier.id][1:] == together[part.id][1:]


def mark_judged(
    variant: Variant,
    key: Key,
    part: Part,
    reading: Reading,
    judgement: Verdict,
    remark_at: Part | None,
    missed: Callable[[], str],
    before: EarlierAnswers,
) -> Mark:
    """Return the mark of a part that is judged together with others; ``remark_at`` bears the same remark
    already."""
    read_as, verdict = reading.read_as[judgement.reading], judgement.said
    mark_of = partial(made_mark, variant, part, reading)
    if verdict is None:
        read = echo(read_as, variant.lang)
        return mark_of("wrong", 0.0, read_as, say(variant, part, "incomplete", read=read, missing=missed()))
    share = min(1.0, max(0.0, float(verdict.share)))

    def sentence_of(sentence: str, **pieces: str) -> Sentence:
        """Return a sentence, then what follows from the student's own answers."""
        message = say(variant, part, sentence, read=echo(read_as, variant.lang), **pieces)
        amounts = {} if remark_at else verdict.found
        amount_words = {f"found{n}": amount(variant, q, v) for n, (q, v) in enumerate(amounts.items())}
        if not amount_words:
            return message
        listed = ", ".join("{" + name + "}" for name in amount_words)
        follows = words(variant.lang)["marking"]["found"].format(listed)
        return Sentence(f"{message.sentence} {follows}", {**message.pieces, **amount_words})

    if verdict.slip:
        slip = f"slip:{verdict.slip}"
        sentence = f"slip_{verdict.slip}"
        if verdict.slip == "not_drawn" and (is_scale(part) or verdict.follows):
            sentence = "scale_alone" if is_scale(part) else "drawn_so"
        return mark_of(slip, key.rules.share(verdict.slip), read_as, sentence_of(sentence), (slip,))
    is_followed = judgement.followed or verdict.follows
    if (
        share == 1.0
        and is_followed
        and part.sort.is_scalar
        and not _has_work(part, key, reading.values[judgement.reading], before)
    ):
        return mark_of("wrong", 0.0, read_as, sentence_of(_unexplained(variant, part)))
    if share == 1.0:
        kind, share = ("follow_through", key.rules.follow_through) if is_followed else ("correct", 1.0)
        return mark_of(kind, share, read_as, sentence_of(kind))
    mistakes = [verdict.mistake, *verdict.also] if verdict.mistake else mistakes_that_fit(key, part, reading)
    matches = tuple(f"mistake:{name}" for name in mistakes) + (
        (f"slip:{judgement.slip}",) if judgement.slip else ()
    )
    if mistakes:
        share = share if verdict.mistake and share else key.price(mistakes[0])

        if remark_at and verdict.mistake:
            message = sentence_of("remark_at", first=questions(variant, [remark_at.id], "and"))
        else:
            message = sentence_of("mistake", says=variant.mistake_text(mistakes[0]))
        return mark_of(matches[0], share, read_as, message, matches)
    if judgement.slip:
        error = judgement.trace or "/".join(judgement.about and (judgement.slip, *judgement.about))
        if error in before.paid and before.sheet.has_work:
            return mark_of(
                "follow_through",
                judgement.left * key.rules.follow_through,
                read_as,
                sentence_of("same_error", first=questions(variant, [before.paid[error]], "and")),
                matches,
            )
        if error:
            before.paid[error] = part.id
        about = either_symbol(variant, judgement.about, both=judgement.slip == "frame_missing")
        message = sentence_of(f"slip_{judgement.slip}", about=about)
        return mark_of(
            matches[0], judgement.left * key.rules.share(judgement.slip), read_as, message, matches
        )
    return mark_of("wrong", share, read_as, sentence_of(_unexplained(variant, part)))


def _unexplained(variant: Variant, part: Part) -> str:
    """Return the key of the sentence for an answer that nothing explains: one that is drawn has no relation
    to start from."""
    is_drawn = any(p.kind == "point" and p.judge == part.judge for p in variant.parts)
    return "wrong_drawn" if is_drawn and part.sort.wrong == "wrong" else part.sort.wrong


def _has_work(part: Part, key: Key, value: Any, before: EarlierAnswers) -> bool:
    """Return whether a number that follows from others is more than one that is written everywhere."""
    reference = key.reference.get(part.quantity)
    is_right = reference is not None and part.sort.distance(part, value, reference) <= 1
    return is_right or before.is_work(part, value)


def waits_for(
    variant: Variant,
    part: Part,
    readings: Mapping[str, Reading],
    waiting: dict[str, dict[str, frozenset[str]]],
) -> str:
    """Return the questions that must be answered before an answer can be judged: any one of those that
    suffice alone, else all of its group.

    ``waiting`` remembers by judge what could be judged with each missing answer.
    """
    group = {p.id: p.quantity for p in variant.parts if p.judge == part.judge}
    read = {i: readings[i].values[0] for i in group if readings[i].status == "read"}
    unread = [i for i in group if i not in read]
    if part.judge not in waiting:
        waiting[part.judge] = {}
        for i in unread:
            with suppress(CourseworkError):
                right = variant.key.reference[group[i]]
                waiting[part.judge][i] = frozenset(judged(variant, part.judge, {**read, i: right}))
    enough = [i for i, would_be in waiting[part.judge].items() if part.id in would_be]
    return questions(variant, enough, "or") if enough else questions(variant, unread, "and")
