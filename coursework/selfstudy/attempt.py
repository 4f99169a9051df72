"""One variant worked on alone: what was answered, what becomes of it, hints one after another. It says nothing in words of its own:
notebooks and the site do."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from coursework.marking.marking import mark
from coursework.selfstudy import hints, predictions
from coursework.selfstudy.answers import same_as_another
from coursework.selfstudy.predictions import Compared, Prediction
from coursework.selfstudy.progress import EXAMPLE, HINT, REVEAL
from coursework.selfstudy.recording import marked_answers
from coursework.selfstudy.right_answers import Own, right_ones
from coursework.selfstudy.store import Kept, is_blank

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.marking.mark import Marking
    from coursework.model import Part


class Checked(NamedTuple):
    """What became of answers."""

    marking: Marking
    answers: Mapping[
        str, Any
    ]  #: that were marked: those that were given, and the kept ones where these are blank
    copied: int | None = None  #: the seed of another variant that these very answers were for
    changed: tuple[str, ...] = ()  #: the parts of which something is new: an answer, or what becomes of it

    @property
    def right(self) -> tuple[str, ...]:
        """The parts that are right."""
        return tuple(name for name, one in self.marking.items() if one.verdict == "correct")

    @property
    def first_missed(self) -> str:
        """The first part whose answer is not right, of those that were answered; empty where there is none."""
        passed = ("correct", "missing", "to_mark")
        return next((name for name, one in self.marking.items() if one.verdict not in passed), "")


class Attempt:
    """A variant, and what is kept of it."""

    def __init__(self, variant: Variant, kept: Kept):
        self.variant, self.kept = variant, kept

    @property
    def answers(self) -> dict[str, Any]:
        """The last answer to each question that was not blank; a file may hold those to others."""
        mine = self.kept.of(self.variant.seed, "answers")
        return {name: answer for name, answer in mine.items() if name in self.variant.part_ids}

    @property
    def predictions(self) -> dict[str, Any]:
        """What was predicted."""
        return self.kept.of(self.variant.seed, "predictions")

    def marked(self) -> Checked:
        """What becomes of the kept answers; nothing is kept anew."""
        return Checked(mark(self.variant, self.answers), self.answers)

    def check(self, given: Mapping[str, Any]) -> Checked:
        """Mark answers by part, kept ones in the place of blank ones, and keep them with what becomes of them.

        Those that are wrong here and were given to another variant are not kept.
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
        return Checked(marking, now, copied, tuple(one["part"] for one in new))

    # ---------------------------------------------------------------- right answers

    def own(self, checked: Checked) -> dict[str, Own]:
        """What is right, as it was written, by quantity."""
        return right_ones(self.variant, checked.answers, checked.right)

    def compared(self, asked: Iterable[Prediction], own: Mapping[str, Own]) -> list[Compared]:
        """Return the predictions beside what came out; those that were not made are left out."""
        said, found = self.predictions, []
        for one in asked:
            mine = own.get(one.quantity)
            value = None if mine is None or mine.is_usual else mine.value
            found.append(predictions.compared(self.variant, one, said.get(one.id), value))
        return [one for one in found if one is not None]

    # ------------------------------------------------------------ hints, solutions

    def hints(self, name: str, call: Callable[[str], str]) -> tuple[str, ...]:
        """Return all hints for a question or a step on the way to one, as Markdown; ``call`` says how to ask
        for those of another."""
        # Of what is right in another way the reference is not the student's: it stays a symbol.
        own = self.own(self.marked())
        found = {q: one.value for q, one in own.items() if one.is_usual and one.value is not None}
        return hints.steps(self.variant, name, found, call)

    def hints_seen(self, name: str) -> int:
        """How many of them were shown."""
        steps = [int(e.get("step", 1)) for e in self._happened(HINT) if e["part"] == name]
        return max(steps, default=0)

    def is_revealed(self, part: Part) -> bool:
        """Return whether the solution of a question has been shown."""
        return not {e["part"] for e in self._happened(REVEAL)}.isdisjoint((part.id, part.quantity))

    @property
    def is_example(self) -> bool:
        """True if the variant was shown with its solution: it counts no more."""
        return any(self._happened(EXAMPLE))

    def reveal(self) -> None:
        """Keep that the whole solution is shown: what was not right yet was not found alone, and the variant counts no more."""
        right = self.marked().right
        for part in self.variant.parts:
            if part.id not in right:
                self.note(REVEAL, part.id)
        self.note(EXAMPLE, "", step=0)

    def note(self, what: str, part: str, **more: Any) -> None:
        """Keep that something was shown; once."""
        told = {"part": part, "what": what, **more}
        if not any(told.items() <= one.items() for one in self.kept.happened(self.variant.seed)):
            self.kept.note(self.variant.seed, [told])

    def _happened(self, what: str) -> Collection[Mapping[str, Any]]:
        return [e for e in self.kept.happened(self.variant.seed) if e["what"] == what]
