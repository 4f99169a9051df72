"""Mastery of a student, computed from the recorded events: outings, repetitions, skills.

An *outing* is a question of one variant. It is clean if the first readable answer is right, without a hint
and without the solution. A question that was not clean returns after 1 day, and after each clean outing that
was due, after 3, 7 and 16 days; then it rests, and an unclean outing starts the series again. A *skill* is a
named error, or a kind of answer. Making an error loses the skill; a right answer where the error would have
given another shows it. A skill shown in two variants since its last loss is mastered.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date, timedelta
from functools import partial
from typing import TYPE_CHECKING, Any

from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.marking.marking import mark
from coursework.selfstudy.progress import (
    ANSWER,
    EXAMPLE,
    HINT,
    REVEAL,
    Entry,
    Progress,
    ProgressStore,
    date_of,
    entry,
    is_blank,
)

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant
    from coursework.marking.mark import SheetMarks
    from coursework.model import Part


AFTER_DAYS = (1, 3, 7, 16)  #: when what was missed comes again
HELD = 2  #: variants in which a skill is shown since it was last lost

RIGHT = ("correct",)
#: Verdicts that say nothing of who answers: what cannot be read, and what follows rightly from an earlier
#: wrong answer.
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
        """True if the skill was lost and not mastered since."""
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
    progress: Progress, on: date, exercises: Iterable[str], errors: Callable[[str], Collection[str]]
) -> Advice | None:
    """Return the recommended exercise of a course for a day; None for a course without exercises.

    In this order: the exercise with the most due questions; a new exercise that tests a skill lost and not
    mastered since; the next new exercise; the question that returns first. ``errors`` returns the skills
    that an exercise tests.
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
        tries = next((e for e in new if skill.id in errors(e)), None)
        if tries:
            return Advice(tries, "skill", day=skill.last_lost, skill=skill.id)
    if new:
        return Advice(new[0], "new")
    if waiting:
        first = min((q for met in waiting.values() for q in met), key=lambda q: (q.due or on, q.exercise))
        return Advice(first.exercise, "later", (first.part,), first.due)
    return Advice(known_names[0], "again") if known_names else None


def marked_answers(
    variant: Variant, answers: Mapping[str, Any], marking: SheetMarks, before: Sequence[Entry]
) -> list[dict[str, Any]]:
    """Return the records of a marking, for answers that are new or marked differently from ``before``."""
    last = {e["part"]: (e.get("answer"), e.get("verdict")) for e in before if e["what"] == ANSWER}
    results = []
    for part in variant.parts:
        answer, mark = answers.get(part.id), marking[part.id]
        if is_blank(answer) or last.get(part.id) == (answer, mark.verdict):
            continue
        entries: dict[str, Any] = {"part": part.id, "what": ANSWER, "answer": answer, "verdict": mark.verdict}
        entries["kind"] = skill_of_kind(part)
        if mark.verdict in RIGHT:
            entries["shown"] = sorted(set(errors_shown(variant, part)))
        results.append(entries)
    return results


def mark_what_came_unmarked(course: Course[Any], file: ProgressStore) -> None:
    """Mark the stored answers without a verdict, with the date of the answer: a fault of the course left them
    so."""
    last = {(e["exercise"], e["seed"], e["part"]): e for e in file.progress if e["what"] == ANSWER}
    unmarked: dict[tuple[str, int], list[Entry]] = {}
    for (exercise, seed, _), item in last.items():
        if "verdict" not in item and exercise in course:
            unmarked.setdefault((exercise, seed), []).append(item)
    for (exercise, seed), result in unmarked.items():
        variant = course[exercise].variant(seed)
        answers = {e["part"]: e.get("answer") for e in result if e["part"] in variant.part_ids}
        try:
            marking = mark(variant, answers)
        except CourseworkError:
            continue
        at = max(map(date_of, result)) + timedelta(microseconds=1)
        text = marked_answers(variant, answers, marking, ())
        file.add([entry(at, exercise, seed, **each) for each in text])


def skill_of_kind(part: Part) -> str:
    """Return the kind of an answer: its unit if it has one, else its kind."""
    return part.unit if part.unit != "1" else part.kind


def errors_shown(variant: Variant, part: Part) -> Iterator[str]:
    """Yield the named errors that would have given another answer to a part of this variant."""
    key, sort = variant.key, part.sort
    if sort.is_open or not sort.disproves:
        return
    reference, width = key.reference[part.quantity], key.envelope.get(part.quantity, 0.0)
    along = key.reference.get(part.along)
    for name, value in key.wrong_ways(part.quantity):
        if value is not None and sort.apart(part, value, reference, along, width) > 1:
            yield f"mistake:{name}"
    for kind, value in key.slip_values(part):
        if sort.apart(part, value, reference, along, width) > 1:
            yield f"slip:{kind}"


Called = Callable[["CourseExercise[Any]", str], str]  #: how an exercise is called in a language

_SKILLS = 6  #: that are listed, the last lost first


def next_step(
    course: Course[Any], progress: Progress, on: date, order: Sequence[str] | None = None
) -> Advice | None:
    """Return the recommendation for a day; None for a course without exercises. ``order`` is the study order,
    by default the course's."""
    order_known = course.folder.study_order if order is None else order
    return advised(progress, on, order_known, partial(_errors, course))


def _errors(course: Course[Any], exercise: str) -> Collection[str]:
    """Return the named errors that an exercise tests; its solution is loaded for that."""
    try:
        return [f"mistake:{name}" for name in course[exercise].solution.mistakes]
    except CourseworkError:
        return ()


def standings_text(course: Course[Any], progress: Progress, on: date, lang: str) -> str:
    """Return a line for each exercise begun, as a Markdown list; empty where there is none."""
    texts = words(lang)["study"]["progress"]
    return "\n".join(
        _line(course, s, on, lang, texts) for s in standings(progress) if s.tried and s.exercise in course
    )


def _line(course: Course[Any], item: ExerciseProgress, on: date, lang: str, text: Mapping[str, Any]) -> str:
    line = text["line"].format(
        title=title(course[item.exercise], lang),
        variants=item.variants,
        right=item.right,
        of=item.tried,
        clean=item.clean,
    )
    if item.due is None:
        return f"- {line}"
    again = text["due"] if item.due <= on else text["again"].format(day=date_text(item.due, lang))
    return f"- {line} {again}"


def skills_text(course: Course[Any], progress: Progress, lang: str, label: Called | None = None) -> str:
    """Return the skills lost since and those recovered, as Markdown lists; ``label`` as for
    :func:`advice_text`."""
    texts = words(lang)["study"]["progress"]
    lost = sorted(
        (s for s in skills(progress) if s.last_lost), key=lambda s: s.last_lost or date.min, reverse=True
    )
    named = [(s, text) for s in lost if (text := skill_text(course, s.id, s.exercise, lang))]
    pieces = []
    for head, chosen in (
        ("open", [(s, t) for s, t in named if s.is_open]),
        ("held", [(s, t) for s, t in named if not s.is_open]),
    ):
        if chosen:
            pieces.append(
                f"**{texts[head]}**\n\n"
                + "\n".join(_skill_line(course, s, t, lang, label or title) for s, t in chosen[:_SKILLS])
            )
    return "\n\n".join(pieces)


def _skill_line(course: Course[Any], skill: Skill, text: str, lang: str, label: Called) -> str:
    texts = words(lang)["study"]["progress"]
    displayed = texts["shown"].format(count=skill.shown, of=HELD) if skill.shown and skill.is_open else ""
    position = "" if skill.id.startswith("kind:") else label(course[skill.exercise], lang)
    heading = texts["separator"].join(filter(None, (position, displayed)))
    return f"- {' '.join(text.split())}{f' ({heading})' if heading else ''}"


def skill_text(course: Course[Any], skill: str, exercise: str, lang: str) -> str:
    """Return the words for a skill; empty where it has no name here."""
    family, _, name = skill.partition(":")
    texts = words(lang)["study"]["skills"]
    if family == "kind":
        return texts["kinds"].get(name, "")
    if family == "slip":
        return texts["slips"].get(name, "")
    if family != "mistake" or exercise not in course:
        return ""
    try:
        return course[exercise].variant(0, lang).mistake_text(name)
    except (CourseworkError, KeyError):
        return ""


def advice_text(course: Course[Any], advice: Advice, lang: str, label: Called | None = None) -> str:
    """Return the reason for the recommended exercise, in a sentence or two; ``label`` names an exercise, by
    default by title and name."""
    texts = words(lang)["study"]["next"]
    skill = skill_text(course, advice.skill, advice.exercise, lang) if advice.skill else ""
    why = "new" if advice.why == "skill" and not skill else advice.why
    return texts[why].format(
        title=(label or title)(course[advice.exercise], lang),
        day=date_text(advice.day, lang) if advice.day else "",
        skill=" ".join(skill.split()),
        count=len(advice.parts),
    )


def title(exercise: CourseExercise[Any], lang: str) -> str:
    """Return the title of an exercise with its name."""
    return f"{exercise.title(lang)} (`{exercise.name}`)"


def date_text(day: date, lang: str) -> str:
    return str(words(lang)["study"]["progress"]["date"]).format(day=day.day, month=day.month, year=day.year)
