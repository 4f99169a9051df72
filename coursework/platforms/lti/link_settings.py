"""Settings of a link, from its custom parameters: the exercise or assignment, the number of attempts, and the
attempt that counts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

from coursework.platforms.lti.refusal import LTIRefusal

BEST, LAST = "best", "last"
NEVER, AFTER = "never", "after"
_MOST_TRIES = 1000


@dataclass(frozen=True)
class LinkSettings:
    """Content of a link and its rules."""

    exercise: str = ""
    assignment: str = ""
    parts: tuple[str, ...] = ()  #: of the exercise; empty: the usual ones
    tries: int | None = None  #: None: unlimited
    counts: str = BEST
    answers: str = NEVER  #: whether right answers are shown after the last attempt

    @property
    def key(self) -> str:
        """Key of the link's content, which separates papers issued before a change of content from those
        issued after it."""
        return " ".join(
            filter(
                None,
                (
                    f"assignment:{self.assignment}" if self.assignment else f"exercise:{self.exercise}",
                    *self.parts,
                ),
            )
        )

    @property
    def shows_answers(self) -> bool:
        return self.answers == AFTER and self.tries is not None

    def custom(self) -> dict[str, str]:
        """Return the custom parameters that state these settings, without those at their defaults."""
        parameters = {
            "exercise": self.exercise,
            "assignment": self.assignment,
            "parts": ",".join(self.parts),
            "tries": "" if self.tries is None else str(self.tries),
            "counts": "" if self.counts == BEST else self.counts,
            "answers": "" if self.answers == NEVER else self.answers,
        }
        return {name: text for name, text in parameters.items() if text}

    @classmethod
    def of(cls, custom: Mapping[str, str]) -> Self:
        """Return the settings that custom parameters state.

        Raises
        ------
        LTIRefusal
            They name no content, or an unknown rule.
        """
        parameters = {str(name).strip().casefold(): text.strip() for name, text in custom.items()}
        exercise, assignment = parameters.get("exercise", ""), parameters.get("assignment", "")
        if not exercise and not assignment:
            raise LTIRefusal(
                "nothing_chosen", 404, "neither exercise nor assignment in the custom parameters"
            )
        counts, answers = parameters.get("counts") or BEST, parameters.get("answers") or NEVER
        if counts not in (BEST, LAST) or answers not in (NEVER, AFTER):
            raise LTIRefusal("unknown_choice", 404, f"counts {counts[:20]!r}, answers {answers[:20]!r}")
        parts = tuple(filter(None, (part.strip() for part in parameters.get("parts", "").split(","))))
        return cls(
            exercise,
            "" if exercise else assignment,
            parts,
            tries_of(parameters.get("tries", "")),
            counts,
            answers,
        )


def tries_of(text: str) -> int | None:
    """Return a number of attempts; None if it is unlimited."""
    if not text.strip():
        return None
    if not text.strip().isdecimal() or len(text) > 20 or not 1 <= int(text) <= _MOST_TRIES:
        raise LTIRefusal("no_question", 400, "tries are not a whole number")
    return int(text)
