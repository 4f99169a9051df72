"""Attempt of one student at one variant: answers, marking, hints one after another.

It contains no words of its own; notebooks and the site add them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from coursework.marking.marking import mark
from coursework.selfstudy import hints, predictions
from coursework.selfstudy.answers import same_as_another
from coursework.selfstudy.predictions import Prediction, PredictionOutcome
from coursework.selfstudy.progress import EXAMPLE, HINT, REVEAL
from coursework.selfstudy.recording import marked_answers
from coursework.selfstudy.right_answers import OwnAnswer, right_ones
from coursework.selfstudy.store import ExerciseStore, is_blank

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.marking.mark import SheetMarks
    from coursework.model import Part


class CheckedAnswers(NamedTuple):
    """Marked answers."""

    marking: SheetMarks
    answers: Mapping[
        str, Any
    ]  #: that were marked: those that were given, and the kept ones where these are blank
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
        self.variant, self.kept = variant, store

    @property
    def answers(self) -> dict[str, Any]:
        """Last answer to each question that is not blank; a file may hold answers to other questions."""
        mine = self.kept.of(self.variant.seed, "answers")
        return {name: answer for name, answer in mine.items() if name in self.variant.part_ids}

    @property
    def predictions(self) -> dict[str, Any]:
        """Stored predictions."""
        return self.kept.of(self.variant.seed, "predictions")

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
            self.kept.add(
                self.variant.seed, "answers", dict(given)
            )  # nothing is lost by a fault of the course
            raise
        copied, theirs = same_as_another(self.variant, self.kept, given, marking)
        seed = self.variant.seed
        mine = {n: a for n, a in now.items() if n not in theirs}
        new = marked_answers(self.variant, mine, marking, self.kept.happened(seed))
        self.kept.note(seed, new)
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
        if not any(entries.items() <= item.items() for item in self.kept.happened(self.variant.seed)):
            self.kept.note(self.variant.seed, [entries])

    def _happened(self, event: str) -> Collection[Mapping[str, Any]]:
        return [e for e in self.kept.happened(self.variant.seed) if e["what"] == event]
