"""Attempt of one student at one variant: answers, marking, hints one after another.

It contains no words of its own; notebooks and the site add them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coursework.course.variant import Variant
from coursework.errors import cut_short
from coursework.language.numbers import unit_text
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.marking.error_messages import shown_as
from coursework.marking.feedback import part_name, say_not_read
from coursework.marking.mark import Mark, SheetMarks, made_mark
from coursework.marking.marking import mark
from coursework.parsing.vocabulary import Unreadable
from coursework.quantities.formula_latex import number_latex
from coursework.selfstudy import hints, predictions
from coursework.selfstudy.mastery import marked_answers
from coursework.selfstudy.predictions import Prediction, PredictionOutcome
from coursework.selfstudy.progress import EXAMPLE, HINT, REVEAL, ExerciseStore, is_blank

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.marking.mark import SheetMarks
    from coursework.model import Part
    from coursework.parsing.reading import Reading

_DIGITS = 7  #: of a component that was read


class CheckedAnswers(NamedTuple):
    """Marked answers."""

    marking: SheetMarks
    #: That were marked: those that were given, and the kept ones where these are blank.
    answers: Mapping[str, Any]
    copied: int | None = None  #: the seed of another variant that these very answers were for
    changed: tuple[str, ...] = ()  #: the parts of which something is new: an answer, or what becomes of it

    @property
    def right(self) -> tuple[str, ...]:
        """Parts that are right."""
        return tuple(name for name, item in self.marking.items() if item.verdict == "correct")

    @property
    def first_missed(self) -> str:
        """First part with a wrong answer; empty where there is none."""
        passed = ("correct", "missing", "to_mark")
        return next((name for name, item in self.marking.items() if item.verdict not in passed), "")


class StudyAttempt:
    """Variant with the stored answers to it."""

    def __init__(self, variant: Variant, store: ExerciseStore):
        self.variant, self.store = variant, store

    @property
    def answers(self) -> dict[str, Any]:
        """Last answer to each question that is not blank; a file may hold answers to other questions."""
        mine = self.store.of(self.variant.seed, "answers")
        return {name: answer for name, answer in mine.items() if name in self.variant.part_ids}

    @property
    def predictions(self) -> dict[str, Any]:
        """Stored predictions."""
        return self.store.of(self.variant.seed, "predictions")

    def marked(self) -> CheckedAnswers:
        """Mark the stored answers, without storing anything."""
        return CheckedAnswers(mark(self.variant, self.answers), self.answers)

    def check(self, given: Mapping[str, Any]) -> CheckedAnswers:
        """Mark answers by part, with stored ones in place of blanks, and store them with the results.

        Answers that are wrong here and were given to another variant are not stored.
        """
        now = {**self.answers, **{n: a for n, a in given.items() if not is_blank(a)}}
        try:
            marking = mark(self.variant, now)
        except Exception:
            # Nothing is lost by a fault of the course.
            self.store.add(self.variant.seed, "answers", dict(given))
            raise
        copied, theirs = same_as_another(self.variant, self.store, given, marking)
        seed = self.variant.seed
        mine = {n: a for n, a in now.items() if n not in theirs}
        new = marked_answers(self.variant, mine, marking, self.store.happened(seed))
        self.store.note(seed, new)
        return CheckedAnswers(marking, now, copied, tuple(item["part"] for item in new))

    # ---------------------------------------------------------------- right answers

    def own(self, checked: CheckedAnswers) -> dict[str, OwnAnswer]:
        """Return the right answers as the student wrote them, by quantity."""
        return right_ones(self.variant, checked.answers, checked.right)

    def compared(
        self, requested: Iterable[Prediction], own_answers: Mapping[str, OwnAnswer]
    ) -> list[PredictionOutcome]:
        """Return the predictions with their outcomes; predictions that were not made are left out."""
        text, result = self.predictions, []
        for item in requested:
            mine = own_answers.get(item.quantity)
            value = None if mine is None or mine.is_usual else mine.value
            result.append(predictions.compared(self.variant, item, text.get(item.id), value))
        return [item for item in result if item is not None]

    # ------------------------------------------------------------ hints, solutions

    def hints(self, name: str, call: Callable[[str], str]) -> tuple[str, ...]:
        """Return all hints for a question or an intermediate step, as Markdown; ``call`` gives the call for
        hints on another one."""
        # Of what is right in another way the reference is not the student's: it stays a symbol.
        own_answers = self.own(self.marked())
        results = {
            q: item.value for q, item in own_answers.items() if item.is_usual and item.value is not None
        }
        return hints.steps(self.variant, name, results, call)

    def hints_seen(self, name: str) -> int:
        """Return the number of hints shown."""
        steps = [int(e.get("step", 1)) for e in self._happened(HINT) if e["part"] == name]
        return max(steps, default=0)

    def is_revealed(self, part: Part) -> bool:
        """Return whether the solution of a question has been shown."""
        return not {e["part"] for e in self._happened(REVEAL)}.isdisjoint((part.id, part.quantity))

    @property
    def open_parts(self) -> dict[str, int]:
        """Numbers of the questions that are neither answered nor given up, by part; of questions that are
        judged."""
        if self.is_example:
            return {}
        right = self.marked().right
        return {
            part.id: number
            for number, part in enumerate(self.variant.parts, 1)
            if not (part.id in right or part.sort.is_open or self.is_revealed(part))
        }

    @property
    def is_example(self) -> bool:
        """True if the variant was shown with its solution, so that it no longer counts."""
        return any(self._happened(EXAMPLE))

    def reveal(self) -> None:
        """Record that the whole solution is shown: questions not yet right were not solved alone, and the
        variant no longer counts."""
        right = self.marked().right
        for part in self.variant.parts:
            if part.id not in right:
                self.note(REVEAL, part.id)
        self.note(EXAMPLE, "", step=0)

    def note(self, event: str, part: str, **more: Any) -> None:
        """Record that something was shown, once."""
        entries = {"part": part, "what": event, **more}
        if not any(entries.items() <= item.items() for item in self.store.happened(self.variant.seed)):
            self.store.note(self.variant.seed, [entries])

    def _happened(self, event: str) -> Collection[Mapping[str, Any]]:
        return [e for e in self.store.happened(self.variant.seed) if e["what"] == event]


_NEAR = 0.1  #: of the reference; the marks decide what is right, this which choice it belongs to
_NEAR_ANGLE = 10.0  #: degrees


@dataclass(frozen=True)
class OwnAnswer:
    """Right answer with its number, if it has one; ``is_usual`` if it equals the reference up to rounding.

    An answer may be right without that: the other assembly first, another scale of the drawing.
    """

    value: float | None
    is_usual: bool


def right_ones(variant: Variant, answers: Mapping[str, Any], right: Collection[str]) -> dict[str, OwnAnswer]:
    """Return the student's own answers to the right parts, by quantity."""
    return {p.quantity: _own_answer(variant, p, answers.get(p.id)) for p in variant.parts if p.id in right}


def _own_answer(variant: Variant, part: Part, answer: Any) -> OwnAnswer:
    walk = variant.walk
    reading = read(variant, part, answer)
    if not part.sort.is_scalar or reading.status != "read":
        return OwnAnswer(None, True)
    reference = float(walk[part.quantity])
    gaps = {float(v): _gap(part, float(v), reference) for v in reading.values}
    value = min(gaps, key=gaps.__getitem__)
    limit = _NEAR_ANGLE if part.sort.turn else _NEAR * abs(reference) + 1e-9
    return OwnAnswer(value, gaps[value] <= max(limit, variant.key.half_width(part)))


def _gap(part: Part, value: float, reference: float) -> float:
    if turn := part.sort.turn:
        return abs((value - reference + turn / 2) % turn - turn / 2)
    return abs(value - reference)


def sign_of(mark: Mark) -> str:
    """Return the symbol of a verdict at the head of a line, distinct without colour."""
    if mark.verdict == "correct":
        return "✓"
    if mark.verdict == "to_mark":
        return "…"
    if mark.verdict in ("unreadable", "missing_unit", "wrong_unit"):
        return "?"
    return "≈" if mark.points else "✗"


def sentence_of(variant: Variant, mark: Mark, reveal: str) -> str:
    """Return the message about an answer; for an answer that nobody will mark, it says what to write instead.

    ``reveal`` is the call that shows the value of an open question.
    """
    if mark.verdict == "to_mark":
        part = next(p for p in variant.parts if p.id == mark.part)
        name, sentence = part_name(variant, part), words(variant.lang)["marking"]["open"]
        return sentence.format(name=name[:1].upper() + name[1:], call=reveal)
    if mark.verdict != "unreadable":
        return mark.says
    table = words(variant.lang)["marking"]["unreadable"]
    part = next(p for p in variant.parts if p.id == mark.part)
    family = part.sort.family
    general = [table["otherwise"]] if family == "number" else [table["otherwise"], table["not_a_number"]]
    if not part.choices and not any(mark.says.endswith(s.rpartition("{found}")[2]) for s in general):
        return mark.says
    colon = words(variant.lang)["sheet"]["colon"]
    name = part_name(variant, part)
    choices = predictions.choices(variant, part)
    return f"{name[:1].upper()}{name[1:]}{colon} " + words(variant.lang)["study"]["not_read"][family].format(
        found=quoted(mark.answer), choices=choices
    )


def same_as_another(
    variant: Variant, stored: ExerciseStore, given: Mapping[str, Any], marking: SheetMarks
) -> tuple[int | None, list[str]]:
    """Return the seed of another variant for which these answers are right, and the parts that are wrong
    here.

    A copy needs at least two numbers that are wrong here and would differ there: an answer that is right in
    both, or a small whole number, may well be the same.
    """
    written = {n: a for n, a in given.items() if not is_blank(a)}
    wrong = [p for p in variant.parts if p.id in written and marking[p.id].verdict != "correct"]
    wrong = [p for p in wrong if not p.is_exact]
    for seed in stored.seeds if len(wrong) > 1 else ():
        theirs = stored.of(seed, "answers")
        if seed == variant.seed or any(theirs.get(n) != a for n, a in written.items()):
            continue
        other = variant.exercise.variant(seed, variant.lang).walk
        here = variant.walk
        differ = [p.id for p in wrong if not _are_same(other.get(p.quantity), here.get(p.quantity))]
        if len(differ) > 1:
            return seed, differ
    return None, []


def _are_same(first: Any, other: Any) -> bool:
    if first is None or other is None:
        return first is other
    return bool(np.array_equal(np.asarray(first), np.asarray(other)))


def is_open(variant: Variant, mark: Mark) -> bool:
    return next(p for p in variant.parts if p.id == mark.part).sort.is_open


def judged_out_of(variant: Variant, marking: SheetMarks) -> float:
    """Return the total points of the parts that are marked here."""
    return sum(m.out_of for m in marking.values() if not is_open(variant, m))


def quoted(text: Any) -> str:
    """Return an answer, shortened, without characters that Markdown takes for markup."""
    wording = "".join(c for c in str(text) if c.isprintable() and c not in "$`*_\\<>[]#|{}")
    return cut_short(wording, 60)


def read_back(variant: Variant, part: Part, text: str) -> tuple[bool, tuple[str, ...]]:
    """Return whether an answer can be read, and its readings as Markdown, or else the reason.

    A blank answer, or one that a person marks, has no readings. Nothing of the variant is computed.
    """
    reading = read(variant, part, text)
    if reading.status == "missing" or part.sort.is_open:
        return True, ()
    if reading.status == "read":
        displayed = (
            _typeset(variant, part, reading, k) or shown_as(variant, part, reading, k)[1]
            for k in range(len(reading.values))
        )
        bare = part.sort.is_scalar and part.unit != "1" and not (reading.unit_given or part.asks_unit)
        unit = unit_text(part.unit, variant.lang) if bare else ""
        return True, tuple(dict.fromkeys(_with(unit, item) for item in displayed))
    mark = made_mark(variant, part, reading, reading.status, 0.0, "", say_not_read(variant, part, reading))
    return False, (sentence_of(variant, mark, ""),)


def _typeset(variant: Variant, part: Part, reading: Reading, index: int) -> str:
    """Return what was read as a formula; empty where the text says as much."""
    value, latex = reading.values[index], ""
    if isinstance(value, np.ndarray) and value.size > 3:
        latex = part.sort.formula(value, lambda number: number_latex(number, "1", _DIGITS))
    elif part.sort.is_text:
        symbols = {name: variant.symbol(name) for name in part.variables}
        with suppress(Unreadable):  # behind words, or before a unit: the text stands as it is
            latex = part.sort.latex(reading.read_as[index], symbols)
    return f"${latex}$" if latex else ""


def _with(unit: str, text: str) -> str:
    return f"{text}{'' if unit == '°' or not unit else chr(0xA0)}{unit}"
