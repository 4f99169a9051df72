"""Mastery of a student, computed from the recorded events: outings, repetitions, skills.

An *outing* is a question of one variant. It is clean if the first readable answer is right, without a hint
and without the solution. A question that was not clean returns after 1 day, and after each clean outing that
was due, after 3, 7 and 16 days; then it rests, and an unclean outing starts the series again. A *skill* is a
named error, or a kind of answer. Making an error loses the skill; a right answer where the error would have
given another shows it. A skill shown in two variants since its last loss is held.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import date, timedelta
from typing import Any

from coursework.selfstudy.progress import ANSWER, EXAMPLE, HINT, REVEAL, Entry, Progress, date_of

AFTER_DAYS = (1, 3, 7, 16)  #: when what was missed comes again
HELD = 2  #: variants in which a skill is shown since it was last lost

RIGHT = ("correct",)
#: Verdicts that say nothing of who answers: what cannot be read, and what follows rightly from an earlier wrong answer.
_NO_ATTEMPT = ("missing", "unreadable", "missing_unit", "wrong_unit", "to_mark", "follow_through")


@dataclass
class Outing:
    """Question of one variant."""

    exercise: str
    seed: int
    part: str
    first: date
    last: date
    verdicts: list[str] = field(default_factory=list)  #: of the answers that could be read, in order
    hints: int = 0  #: steps seen before it was right
    was_revealed: bool = False  #: before it was right

    @property
    def is_right(self) -> bool:
        return any(v in RIGHT for v in self.verdicts)

    @property
    def is_clean(self) -> bool:
        """True if the first answer was right, without help."""
        return bool(self.verdicts) and self.verdicts[0] in RIGHT and not self.hints and not self.was_revealed

    @property
    def counts(self) -> bool:
        """True if the outing carries information: an answer was given, or the solution was requested."""
        return bool(self.verdicts) or self.was_revealed


@dataclass(frozen=True)
class RepeatedQuestion:
    """Question over all its variants."""

    exercise: str
    part: str
    outings: tuple[Outing, ...]
    due: date | None  #: when it comes again; none where it is at rest
    missed: date | None  #: when it last was not clean


@dataclass(frozen=True)
class Skill:
    """Named error, ``mistake:no_coriolis``, or kind of answer, ``kind:rad/s``."""

    id: str
    exercise: str  #: where it was last lost, or else shown
    lost: int  #: how often
    last_lost: date | None
    shown: int  #: in how many variants since then

    @property
    def is_open(self) -> bool:
        """True if the skill was lost and not held since."""
        return bool(self.lost) and self.shown < HELD


def outings(progress: Progress) -> tuple[Outing, ...]:
    """Return the outings that carry information, the earliest first; none of a variant shown as an example
    before."""
    results: dict[tuple[str, int, str], Outing] = {}
    examples = set()
    for item in progress:
        variant, day = (item["exercise"], item["seed"]), date_of(item).date()
        if item["what"] == EXAMPLE:
            examples.add(variant)
        if item["what"] not in (ANSWER, HINT, REVEAL) or variant in examples:
            continue
        key = (*variant, item["part"])
        outing = results.setdefault(key, Outing(*key, first=day, last=day))
        _follow(outing, item, day)
    return tuple(o for o in results.values() if o.counts)


def _follow(outing: Outing, item: Entry, day: date) -> None:
    if outing.is_right:
        return
    outing.last = day
    if item["what"] == HINT:
        outing.hints = max(outing.hints, int(item.get("step", 1)))
    elif item["what"] == REVEAL:
        outing.was_revealed = True
    elif (verdict := str(item.get("verdict", ""))) and verdict not in _NO_ATTEMPT:
        outing.verdicts.append(verdict)


def questions(progress: Progress) -> tuple[RepeatedQuestion, ...]:
    """Return the attempted questions, each with the day of its repetition."""
    by_question: dict[tuple[str, str], list[Outing]] = {}
    for outing in outings(progress):
        by_question.setdefault((outing.exercise, outing.part), []).append(outing)
    return tuple(_question(*key, tuple(met)) for key, met in by_question.items())


def _question(exercise: str, part: str, met: tuple[Outing, ...]) -> RepeatedQuestion:
    box, due, missed = -1, None, None
    for outing in met:
        if not outing.is_clean:
            box, missed = 0, outing.last
        elif due is None or outing.first < due:
            continue
        else:
            box += 1
        due = outing.last + timedelta(days=AFTER_DAYS[box]) if box < len(AFTER_DAYS) else None
    return RepeatedQuestion(exercise, part, met, due, missed)


def skills(progress: Progress) -> tuple[Skill, ...]:
    """Return the tested skills, those of errors and those of kinds, in order of their first test."""
    lost: dict[str, list[tuple[str, date]]] = {}
    displayed: dict[str, dict[tuple[str, int], str]] = {}
    lost_in: dict[str, tuple[str, int]] = {}  # where a skill was lost, other answers show nothing of it
    clean = {(o.exercise, o.seed, o.part): o.is_clean for o in outings(progress)}
    for item in progress:
        position, verdict = (item["exercise"], item["seed"]), str(item.get("verdict", ""))
        if (
            item["what"] != ANSWER
            or not verdict
            or verdict in _NO_ATTEMPT
            or (*position, item["part"]) not in clean
        ):
            continue
        kind = f"kind:{item['kind']}" if item.get("kind") else ""
        day = date_of(item).date()
        if verdict in RIGHT and clean[*position, item["part"]]:
            for name in (*_texts(item.get("shown")), *filter(None, (kind,))):
                if lost_in.get(name) != position:
                    displayed.setdefault(name, {})[position] = item["exercise"]
        elif verdict not in RIGHT:
            for name in filter(None, (kind, verdict if ":" in verdict else "")):
                lost.setdefault(name, []).append((item["exercise"], day))
                lost_in[name] = position
                displayed.pop(name, None)
    names = dict.fromkeys((*lost, *displayed))
    return tuple(_skill(name, lost.get(name, []), displayed.get(name, {})) for name in names)


def _skill(name: str, lost: list[tuple[str, date]], displayed: Mapping[tuple[str, int], str]) -> Skill:
    exercise, day = lost[-1] if lost else (next(iter(displayed.values())), None)
    return Skill(name, exercise, len(lost), day, len(displayed))


def _texts(text: Any) -> Iterable[str]:
    return [str(name) for name in text] if isinstance(text, (list, tuple)) else ()


@dataclass(frozen=True)
class ExerciseProgress:
    """Progress of a student in one exercise."""

    exercise: str
    variants: int  #: begun
    tried: int  #: questions, each of a variant
    right: int
    clean: int  #: right first time, alone
    due: date | None  #: when the first of what was missed comes again


def standings(progress: Progress) -> tuple[ExerciseProgress, ...]:
    """Return the progress of a student by exercise, the earliest begun first."""
    results = []
    met, requested = outings(progress), questions(progress)
    for exercise in progress.exercises:
        mine = [o for o in met if o.exercise == exercise]
        dates = [q.due for q in requested if q.exercise == exercise and q.due is not None]
        seeds = {e["seed"] for e in progress if e["exercise"] == exercise and e["what"] != EXAMPLE}
        counts = (len(mine), sum(o.is_right for o in mine), sum(o.is_clean for o in mine))
        results.append(ExerciseProgress(exercise, len(seeds), *counts, min(dates, default=None)))
    return tuple(results)


@dataclass(frozen=True)
class Advice:
    """Recommendation with its reason: ``due``, ``skill``, ``new`` or ``later``."""

    exercise: str
    why: str
    parts: tuple[str, ...] = ()  #: the questions that come again
    day: date | None = None  #: when they were missed, or come again
    skill: str = ""


def advised(
    progress: Progress, on: date, exercises: Iterable[str], errors: Mapping[str, Iterable[str]]
) -> Advice | None:
    """Return the recommended exercise of a course for a day; None for a course without exercises.

    In this order: the exercise with the most due questions; a new exercise that tests a skill lost and not
    held since; the next new exercise; the question that returns first. ``errors`` are the skills that each
    exercise tests, by exercise.
    """
    known_names = tuple(exercises)
    waiting: dict[str, list[RepeatedQuestion]] = {}
    for question in questions(progress):
        if question.due is not None and question.exercise in known_names:
            waiting.setdefault(question.exercise, []).append(question)
    due = {e: [q for q in met if q.due is not None and q.due <= on] for e, met in waiting.items()}
    if any(due.values()):
        exercise = max(
            due, key=lambda e: (len(due[e]), -min((q.due.toordinal() for q in due[e] if q.due), default=0))
        )
        missed = [q.missed for q in due[exercise] if q.missed]
        return Advice(exercise, "due", tuple(q.part for q in due[exercise]), max(missed, default=None))
    begun = progress.exercises
    new = [e for e in known_names if e not in begun]
    for skill in sorted((s for s in skills(progress) if s.is_open), key=lambda s: -s.lost):
        tries = next((e for e in new if skill.id in errors.get(e, ())), None)
        if tries:
            return Advice(tries, "skill", day=skill.last_lost, skill=skill.id)
    if new:
        return Advice(new[0], "new")
    if waiting:
        first = min((q for met in waiting.values() for q in met), key=lambda q: (q.due or on, q.exercise))
        return Advice(first.exercise, "later", (first.part,), first.due)
    return Advice(known_names[0], "again") if known_names else None
