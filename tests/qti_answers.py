"""Answers to the items of a pool, and how what a platform makes of each may differ from our marking."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from coursework.language.numbers import plain, significant
from coursework.platforms._qti_item import choice_name, identifier
from coursework.platforms.items import Item, item
from coursework.platforms.losses import losses
from coursework.platforms.platform import platform_of
from coursework.platforms.posed import CHOICE, CHOICES, NUMBER, Posed, mark_alone

NUMERAL = re.compile(r"\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*")
_NONSENSE = ("abc", "nan", "inf", "1/2", "12 or 13", "--3", "1 234.5", "\u22123", "0x10", "x = 4", "9" * 400)


class Answer(NamedTuple):
    """One answer to one part: what is recorded by a player, and what our marking is handed."""

    recorded: object  #: a text, or a list of letters
    typed: str
    sort: str


def items_of(drawn, lang):
    """The variants of a pool, each with its item."""
    return [
        (variant.in_language(lang), item(variant.in_language(lang), drawn.name))
        for variants in drawn.variants
        for variant in variants
    ]


def answers(variant, posed: Posed, part) -> Iterator[Answer]:
    """Answers to a part: right ones however they are written, on the edge, beside it, errors, nonsense,
    nothing."""
    if posed.kind == NUMBER:
        yield from (Answer(text, text, sort) for sort, text in _numbers(variant, posed, part))
    elif posed.kind == CHOICE:
        for option in posed.options:
            name = choice_name(option, posed)
            yield Answer(name, option.letter or option.case, "choice")
    elif posed.kind == CHOICES:
        letters = [choice_name(option, posed) for option in posed.options]
        for end in range(1, len(letters) + 1):
            yield Answer(letters[:end], ", ".join(letters[:end]), "choices")
            yield Answer(letters[-end:], ", ".join(letters[-end:]), "choices")
    else:
        yield Answer("12.5 ; 3", "12.5 ; 3", "collected")
    yield Answer("" if posed.kind == NUMBER else None, "", "blank")


def _numbers(variant, posed: Posed, part) -> Iterator[tuple[str, str]]:
    right, value = posed.intervals[0], posed.intervals[0].value
    unit = "" if part.unit == "1" else part.unit
    yield (
        "right",
        significant(value, 6) if right.low <= float(significant(value, 6)) <= right.high else repr(value),
    )
    yield "right", repr(value)
    yield "right", f" {value!r} "
    yield "right", f"{value:.12e}"
    yield "edge", plain(right.low)
    yield "edge", plain(right.high)
    yield "beside", repr(right.high + 0.02 * (right.high - right.low) + (0 if right.high > right.low else 1))
    yield "beside", repr(right.low - 0.02 * (right.high - right.low) - (0 if right.high > right.low else 1))
    yield "comma", significant(value, 6).replace(".", ",")
    yield "unit", f"{significant(value, 6)} {unit}".strip()
    yield "unit", f"{significant(value, 6)} kg"
    for turns in (1, -1, 2):
        if part.sort.turn:
            yield "turns", repr(value + turns * part.sort.turn)
    for wrong in posed.intervals[1:]:
        if not wrong.is_right and not wrong.turns:
            yield "error", significant(wrong.value, 6) if not part.is_exact else plain(wrong.value)
            yield "error edge", plain(wrong.low)
            yield "error edge", plain(wrong.high)
    for factor in (-1, 0, 0.5, 2, 1000, 1e-3, 57.29577951308232, 1.7):
        yield "wrong", repr(value * factor)
    yield from (("nonsense", text) for text in _NONSENSE)


def ours(variant, part, answer: Answer):
    """Our mark, of a sheet that is blank but for this answer, and its share of the points."""
    made = mark_alone(variant, part, answer.typed)
    return made, made.points / made.out_of


def lost_of(drawn, platform="qti3"):
    """What the export says is lost, by exercise and part; what is lost of an exercise has no part."""
    chosen = platform_of(platform)
    pool = drawn.pool("en", chosen)
    rows = losses(pool, platform, chosen.losses(pool))
    return {(row.exercise, row.part, row.feature) for row in rows}


def explained(lost, posed: Posed, answer: Answer, mark, share: float, theirs: float) -> str:
    """The feature under which a difference falls; nothing where it falls under none that the platform
    loses."""
    if abs(share - theirs) < 1e-9:
        return "same"
    for feature, holds in (
        ("collected", posed.kind not in (NUMBER, CHOICE, CHOICES)),
        ("comma", "," in answer.typed),
        ("unit_written", answer.sort == "unit"),
        ("unreadable", not NUMERAL.fullmatch(answer.typed)),
        ("turns", answer.sort == "turns" and theirs == 0 and mark.verdict == "correct"),
        ("usual_errors", any(match.startswith("slip:") for match in mark.matches)),
        ("mistakes", any(match.startswith("mistake:") for match in mark.matches)),
    ):
        if holds and feature in lost:
            return feature
    return ""


def recorded(given: Item, chosen) -> dict[str, object]:
    """A sheet of answers by the names of the responses."""
    return {identifier(f"RESPONSE_{one.question.id}"): chosen(one) for one in given.questions}


def sheets(variant, given: Item):
    """Sheets of answers to an item: the k-th answers to all of its parts stand on the k-th; with the answers
    by part."""
    by_part = {
        posed.question.id: list(answers(variant, posed, part))
        for posed, part in zip(given.questions, variant.parts, strict=True)
    }
    made = []
    for place in range(max(map(len, by_part.values()))):
        row = {part: some[place % len(some)] for part, some in by_part.items()}
        made.append((recorded(given, lambda one, row=row: row[one.question.id].recorded), row))
    return made


class Judged(NamedTuple):
    """How one answer fared in both."""

    exercise: str
    part: str
    answer: Answer
    verdict: str
    share: float
    theirs: float
    under: str  #: the feature that a difference falls under; same where there is none


def judged(lost, variant, given: Item, rows, outcomes) -> Iterator[Judged]:
    """Every answer of some sheets once, as the platform's outcomes and our marking have it."""
    parts = {part.id: part for part in variant.parts}
    seen = set()
    for row, outcome in zip(rows, outcomes, strict=True):
        for posed in given.questions:
            answer = row[posed.question.id]
            key = posed.question.id, str(answer.recorded)
            if key in seen:
                continue
            seen.add(key)
            mark, share = ours(variant, parts[posed.question.id], answer)
            theirs = float(outcome[identifier(f"SCORE_{posed.question.id}")]) / posed.points
            exercise, own = given.handout.exercise, posed.question.id
            features = {feature for name, of, feature in lost if (name, of) == (exercise, own)}
            under = explained(features, posed, answer, mark, share, theirs)
            yield Judged(exercise, own, answer, mark.verdict, share, theirs, under)
