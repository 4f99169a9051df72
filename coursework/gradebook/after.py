"""The evening after an exam: what is left before marks may go out, and what a change makes of them.

One class, whether the marks are those of a folder or of a database: :class:`Exam`.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from datetime import UTC, date, datetime
from functools import cached_property
from typing import Any, NamedTuple

from coursework.course.course import Course
from coursework.course.marking_rules import Rules
from coursework.errors import BadInput, nearest
from coursework.gradebook.adjustments import (
    DIGITS,
    FOLLOWS_IN_OTHER_CASE,
    NEUTRAL,
    PRICE,
    SPARED,
    STEP,
    WEIGHT,
    Adjustments,
    Question,
)
from coursework.gradebook.book import Gradebook, Result, Sitting, results
from coursework.gradebook.class_marking import rules_of
from coursework.gradebook.decision import new_id
from coursework.gradebook.decisions import ACCEPTED, GIVEN, WITHDRAWN, Decision, Decisions, check_steps
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.presence import ABSENT, AWAY, EXCUSED, PRESENT
from coursework.gradebook.rows import Rejected
from coursework.gradebook.scale import USUAL_SCALE, mark_on
from coursework.gradebook.statistics.alike import alike_lines
from coursework.gradebook.statistics.measures import ENOUGH, WEAK, PartStatistics, measure
from coursework.gradebook.statistics.of_class import marks_of_class
from coursework.gradebook.waiting import (
    SCANNED,
    SHOWN_ON_REQUEST,
    AnswerGroup,
    AnswerToReview,
    Measure,
    OpenGroup,
    SheetOfStudent,
    groups,
    margins_of,
    measures,
    sheet_of_student,
    undecided,
    written,
)
from coursework.issuing.assignment import Assignment
from coursework.issuing.issued import Issued
from coursework.issuing.questions import PaperQuestions
from coursework.issuing.students import folded
from coursework.issuing.variant_assignment import with_points
from coursework.language.words import languages, words
from coursework.marking.mark import WAITING, Mark
from coursework.messages import Message
from coursework.parsing.spoken import refers_elsewhere, says_nothing
from coursework.quantities.error_kinds import PENALTIES

_SLASH = re.compile(r"[^/]*[0-9][^/]*/[^/]*[0-9][^/]*")
_SHARED = 0.5  #: of the answers to a question, from which one wrong answer may be right after all
_BEYOND_CHANCE = 1.64  #: standard errors of a correlation, beyond which one time in twenty is chance
_ALMOST_ALL = 0.9  #: mean from which a question can tell few apart
_NOBODY = 0.02  #: mean share of the points up to which nobody got a question
BINS = 10  #: of the distribution of marks

#: Patterns that are named for a person, in the order in which they are shown.
PATTERNS = ("exchanged", "radians", "slash", "alike", "blank")


class SuspiciousPattern(NamedTuple):
    """Suspicious pattern, and the sheets that show it."""

    kind: str
    #: Student, and the questions or whose papers it is like; an empty text for the whole of a sheet.
    sheets: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class ExamQuestion:
    """Question as the class answered it, what it counts, and what is proposed."""

    exercise: str
    part: str
    number: str
    issued: float  #: points as issued
    weight: float  #: points now
    status: str  #: how it counts; empty as usual
    tolerance: float  #: accepted half-widths
    statistics: PartStatistics | None  #: without what was adjusted
    why: str = ""  #: reason for a look: reversed, nobody, shared, weak
    proposal: Decision | None = None

    @property
    def question(self) -> Question:
        return self.exercise, self.part


class MarkChange(NamedTuple):
    """Mark of a student before and after a change."""

    student: str
    before: float
    now: float


@dataclass(frozen=True)
class Distribution:
    """Marks of those who handed something in."""

    of: float
    marks: Mapping[str, float] = field(repr=False)

    @property
    def mean(self) -> float:
        return sum(self.marks.values()) / len(self.marks) if self.marks else 0.0

    @property
    def counts(self) -> list[int]:
        """Number of students in each tenth of the scale; the best mark is in the last."""
        counts = [0] * BINS
        for mark in self.marks.values():
            counts[min(int(mark * BINS / self.of + 1e-9), BINS - 1)] += 1
        return counts

    @property
    def passed(self) -> int:
        """Number of students with at least half of the best mark."""
        return sum(mark >= self.of / 2 for mark in self.marks.values())


@dataclass(frozen=True)
class Preview:
    """Marks before and after some steps."""

    before: Distribution
    now: Distribution

    @cached_property
    def changes(self) -> list[MarkChange]:
        """Marks that change, those that fall first, then those that rise most."""
        changes = [
            MarkChange(student, self.before.marks[student], mark)
            for student, mark in self.now.marks.items()
            if student in self.before.marks and mark != self.before.marks[student]
        ]
        return sorted(changes, key=lambda c: (c.now > c.before, -abs(c.now - c.before), folded(c.student)))

    @property
    def rise(self) -> int:
        return sum(change.now > change.before for change in self.changes)

    @property
    def fall(self) -> int:
        return sum(change.now < change.before for change in self.changes)


@dataclass
class Exam:
    """Marked exam with the decisions on it."""

    course: Course
    issued: Issued
    machine: Sequence[Graded]  #: as the marking gave them
    decisions: Decisions
    rejected: Sequence[Rejected] = ()
    charged: Mapping[Sitting, float] = field(default_factory=dict)
    measured: Mapping[SheetOfStudent, Measure] | None = None
    presence: Mapping[str, str] = field(default_factory=dict)  #: by student, where somebody stated it
    shown: Callable[[str], str] = str  #: name or code by which a student is named in messages

    # -------------------------------------------------------------------- marks

    @cached_property
    def decided(self) -> list[Graded]:
        """Sheets with the decisions on answers, and without adjustments."""
        return [self.decisions.apply(graded) for graded in self.machine]

    @cached_property
    def adjusted(self) -> list[Graded]:
        """Sheets with the decisions and adjustments."""
        return self._adjusted(self.decisions, self.decided)

    def _adjusted(self, decisions: Decisions, sheets: Sequence[Graded]) -> list[Graded]:
        return decisions.adjustments.applied(sheets, self.issued, margins_of(self.course, self.issued))

    def _results(self, sheets: Iterable[Graded], adjustments: Adjustments) -> dict[str, Result]:
        book = Gradebook(adjustments.on(self.issued), rejected=list(self.rejected), charged=self.charged)
        for graded in sheets:
            book.add(graded)
        return dict(results(book))

    def results(self, decisions: Decisions | None = None) -> dict[str, Result]:
        """Return the result of each student with these decisions, by default with those that stand."""
        if decisions is None:
            return self._standing_results
        sheets = self._adjusted(decisions, [decisions.apply(graded) for graded in self.machine])
        return self._results(sheets, decisions.adjustments)

    @cached_property
    def _standing_results(self) -> dict[str, Result]:
        return self._results(self.adjusted, self.decisions.adjustments)

    @cached_property
    def present(self) -> frozenset[str]:
        """Students who handed something in or were present. Of whoever is away, blank lines are nothing."""
        stated = {student for student, presence in self.presence.items() if presence == PRESENT}
        away = {student for student, presence in self.presence.items() if presence in AWAY}
        handed_in = {graded.student for graded in self.decided}
        return frozenset(stated | (handed_in - (self._blank & away)))

    @cached_property
    def _blank(self) -> frozenset[str]:
        """Students of whose sheets every line is blank."""
        answered = {graded.student for graded in self.decided if graded.has_answer}
        return frozenset(graded.student for graded in self.decided) - answered

    def distribution(self, decisions: Decisions | None = None) -> Distribution:
        """Return the marks of those who handed something in or were present, by the scale with these
        decisions."""
        adjustments = (decisions or self.decisions).adjustments
        stated = (adjustments.on(self.issued).assignment or {}).get("mark")
        scale = stated or {**USUAL_SCALE, "step": 0.01}
        marks = {
            self.shown(student): float(mark_on(scale, result.counts, result.out_of) or 0)
            for student, result in self.results(decisions).items()
            if student in self.present
        }
        return Distribution(scale["of"], marks)

    def preview(self, steps: Sequence[Decision]) -> Preview:
        """Return the marks before and after some more steps, or decisions on answers.

        Raises
        ------
        BadInput
            A step makes no sense.
        """
        check_steps((step for step in steps if not step.student and step.kind != WITHDRAWN), self.issued)
        own = [step for step in steps if step.student]
        after = self.decisions.with_steps((*own, *(step for step in steps if not step.student)))
        return Preview(self.distribution(), self.distribution(after))

    @cached_property
    def provisional(self) -> dict[str, int]:
        """Number of open answers of each student who has some, as named."""
        waits = {
            self.shown(student): result.open for student, result in self.results().items() if result.open
        }
        return dict(sorted(waits.items()))

    @property
    def missing(self) -> tuple[int, int]:
        """Number of students who are absent, and excused, where somebody stated it, and who handed nothing
        in."""
        counts = Counter(its for student, its in self.presence.items() if student not in self.present)
        return counts[ABSENT], counts[EXCUSED]

    # --------------------------------------------------------------------- left

    @cached_property
    def measures(self) -> Mapping[SheetOfStudent, Measure]:
        """Measures by which sheets are compared."""
        if self.measured is not None:
            return self.measured
        keys = map(sheet_of_student, self.machine)
        return dict(zip(keys, measures(self.course, self.issued, self.machine), strict=True))

    @cached_property
    def questions(self) -> PaperQuestions:
        """Questions of the papers, with their numbers."""
        return PaperQuestions.of(self.course, self.issued, on_papers=True)

    @cached_property
    def kinds(self) -> dict[str, list[Question]]:
        """Questions of each kind of part."""
        kinds: dict[str, list[Question]] = {}
        for exercise, part in self.questions:
            if (asked := self.course[exercise].spec.part(part)) is not None:
                kinds.setdefault(asked.kind, []).append((exercise, part))
        return kinds

    def called(self, name: str, lang: str = "en") -> list[Question]:
        """Return the questions of a name: a number on the papers, such as ``2.3``, which may be that of
        different questions, or ``exercise/part``; an exercise, by its number or its name; or a kind of part,
        such as ``angle``, as itself or in words.

        Raises
        ------
        BadInput
            There are none.
        """
        asked, kind_names = name.strip(), words(lang)["after"]["sorts"]
        if found := [one for one in self.questions if asked == "/".join(one)] or self.questions.called(asked):
            return found
        places = {name: self.questions.exercise_number(name) for name, _ in self.questions}
        found = [one for one in self.questions if asked in (one[0], places[one[0]])]
        for kind, questions in self.kinds.items():
            if folded(asked) in (folded(kind), folded(kind_names.get(kind, kind))):
                found = questions
        if not found:
            raise BadInput(
                "no question {name!r}: the papers have {first} to {last}, and the kinds {kinds}",
                name=name[:40],
                first=next(iter(self.questions.values()), ""),
                last=next(reversed(self.questions.values()), ""),
                kinds=", ".join(kind_names.get(kind, kind).lower() for kind in self.kinds) or "–",
            )
        return found

    @cached_property
    def last_sitting(self) -> dict[str, int]:
        """Last attempt of each student."""
        last: dict[str, int] = {}
        for graded in self.machine:
            last[graded.student] = max(last.get(graded.student, 0), graded.sitting)
        return last

    @cached_property
    def one_sitting(self) -> bool:
        """True if no student has several attempts."""
        return all(graded.sitting == self.last_sitting[graded.student] for graded in self.machine)

    def _matters(self, graded: Graded) -> bool:
        """Return True if a sheet belongs to the attempt that counts, or to the last one."""
        student = graded.student
        return graded.sitting in (self.results()[student].sitting, self.last_sitting[student])

    @cached_property
    def groups(self) -> list[AnswerGroup]:
        """Groups of answers that a person may review, decided or not."""
        sheets = self.machine if self.one_sitting else filter(self._matters, self.machine)
        return groups(sheets, self.measures, self.questions, self.course)

    @cached_property
    def undecided(self) -> list[OpenGroup]:
        """Groups of answers to review, each with those of its answers on which nobody has decided."""
        current = {sheet_of_student(graded): graded for graded in self.adjusted}
        return [*undecided(self.groups, self.decisions, current)]

    @cached_property
    def open(self) -> list[OpenGroup]:
        """Groups with undecided answers that wait, without those that are shown only on request."""
        return [one for one in self.undecided if one.why not in SHOWN_ON_REQUEST]

    @cached_property
    def cards(self) -> dict[str, tuple[int, int]]:
        """Number of cards and of answers by the reason for which they wait."""
        cards: dict[str, tuple[int, int]] = {}
        for group, members in self.open:
            count, answers = cards.get(group.why, (0, 0))
            cards[group.why] = count + 1, answers + len(members)
        return cards

    @cached_property
    def non_answers(self) -> list[AnswerToReview]:
        """Answers that wait for a person and say nothing: a dash, "I do not know"."""
        return [
            one
            for _, members in self.open
            for one in members
            if one.mark.verdict in WAITING
            and is_non_answer(
                one.mark.answer, is_number=self._asks_a_number(one.sheet.exercise, one.mark.part)
            )
        ]

    def _asks_a_number(self, exercise: str, part: str) -> bool:
        asked = self.course[exercise].spec.part(part)
        return asked is not None and asked.sort.is_number

    def count_of(self, wanted: Decision) -> int:
        """Return the number of answers to the question of a step that are written as it says."""
        lines = (g.lines.get(wanted.part) for g in self.machine if g.exercise == wanted.exercise)
        return sum(line is not None and wanted.is_on(line) for line in lines)

    def put_away(self, by: str, reason: str) -> list[Decision]:
        """Return the decisions that give no points to all non-answers, as one batch."""
        return as_one(
            step(GIVEN, one.sheet.exercise, one.mark.part, 0.0, one.mark.answer, reason, by)._replace(
                student=one.student, seed=str(one.sheet.seed)
            )
            for one in self.non_answers
        )

    def refusals(self, questions: Collection[Question]) -> list[Decision]:
        """Return the steps that give no points to every answer that waits in some questions, as one batch;
        not to those on scans that nobody has read yet."""
        answers = dict.fromkeys(
            (group.exercise, group.part, one.mark.answer)
            for group, members in self.open
            for one in members
            if (group.exercise, group.part) in questions and one.mark.verdict in WAITING
            if group.why != SCANNED
        )
        return as_one(step(GIVEN, exercise, part, 0.0, answer) for exercise, part, answer in answers)

    @cached_property
    def put_aside(self) -> list[Decision]:
        """Decisions that put non-answers away, and stand."""
        return self.decisions.put_aside(words(lang)["after"]["put_away_why"] for lang in languages())

    def undoable(self, ids: Iterable[str]) -> list[Decision]:
        """Return the standing decisions of some ids, in their order.

        Raises
        ------
        BadInput
            One of them does not stand.
        """
        found = {id(one) for name in ids for one in self.decisions.called(name)}
        return [one for one in (*self.decisions.standing_steps, *self.decisions.own) if id(one) in found]

    @cached_property
    def patterns(self) -> list[SuspiciousPattern]:
        """Patterns of sheets that a person should look at."""
        by_kind: dict[str, dict[str, list[str]]] = {kind: {} for kind in PATTERNS}
        for graded in self.machine:
            numbers = self.questions.on_paper(graded.exercise, graded.lines)
            for part, line in graded.lines.items():
                if kind := _pattern(line):
                    places = by_kind[kind].setdefault(graded.student, [])
                    places.append(numbers[part])
        lines = (
            (graded.student, graded.exercise, str(graded.seed), part, line.read_as, line.verdict)
            for graded in self.decided
            for part, line in graded.lines.items()
        )
        for sheet in alike_lines(lines):
            by_kind["alike"].setdefault(sheet.student, []).extend(map(self.shown, sheet.owners[:2]))
        by_kind["blank"] = {student: [] for student in self._blank if student not in self.presence}
        return [
            SuspiciousPattern(
                kind,
                tuple(sorted((self.shown(student), ", ".join(places)) for student, places in found.items())),
            )
            for kind, found in by_kind.items()
            if found
        ]

    # ---------------------------------------------------------------- questions

    @cached_property
    def table(self) -> list[ExamQuestion]:
        """Questions in the order of the sheets, as the class answered them without adjustments."""
        adjustments = self.decisions.adjustments
        plain = self._results(self.decided, Adjustments())
        marks = marks_of_class(self.decided, plain, len(self.rejected), self.presence)
        by_question = {(p.exercise, p.part): p for p in measure(marks).parts}
        worth = {
            (name, str(part["id"])): part
            for (name, _), record in self.issued.records.items()
            for part in record["parts"]
        }
        return [
            self._question(question, worth[question], adjustments, by_question.get(question))
            for question in self.questions
        ]

    def _question(
        self,
        question: Question,
        part: Mapping[str, Any],
        adjustments: Adjustments,
        statistics: PartStatistics | None,
    ) -> ExamQuestion:
        status = adjustments.statuses.get(question, "")
        why, proposal = ("", None) if status or statistics is None else self._proposal(question, statistics)
        return ExamQuestion(
            *question,
            self.questions[question],
            float(part["points"]),
            adjustments.worth(question[0], part),
            status,
            adjustments.tolerances.get(question, 1.0),
            statistics,
            why,
            proposal,
        )

    def _proposal(self, question: Question, statistics: PartStatistics) -> tuple[str, Decision | None]:
        """Return why a question needs a look, and the step that fits."""
        if statistics.marked >= ENOUGH and statistics.mean <= _NOBODY:
            if shared := self._shared_answer(question):
                return "shared", step(ACCEPTED, *question, answer=shared)
            return "nobody", step(NEUTRAL, *question)
        discrimination, enough = statistics.discrimination, max(statistics.marked, 1) ** 0.5
        if discrimination is not None and discrimination * enough < -_BEYOND_CHANCE:
            return "reversed", step(SPARED, *question)
        if discrimination is not None and discrimination < WEAK and statistics.mean < _ALMOST_ALL:
            return "weak", None
        return "", None

    def _shared_answer(self, question: Question) -> str:
        """Return the wrong answer that most of those who answered share; empty without one."""
        exercise, part = question
        lines = [g.lines[part] for g in self.machine if g.exercise == exercise and part in g.lines]
        counts = Counter(written(line) for line in lines if line.verdict not in ("missing", *WAITING))
        text, count = next(iter(counts.most_common(1)), ("", 0))
        if count < max(3, _SHARED * counts.total()):
            return ""
        return next(line.answer for line in lines if written(line) == text)


def _pattern(line: Mark) -> str:
    """Return the pattern that an answer shows; empty for none."""
    if line.verdict == "slip:exchanged":
        return "exchanged"
    if line.verdict == "slip:all_degrees" or "slip:all_degrees" in line.matches:
        return "radians"
    return "slash" if line.verdict == "unreadable" and _SLASH.fullmatch(line.answer) else ""


def is_non_answer(text: str, *, is_number: bool) -> bool:
    """Return True for a text that says nothing: words such as "no time", and, where a number is asked, a text
    without one."""
    plain = " ".join(text.split())
    if not any(c.isalnum() for c in plain) or says_nothing(plain):
        return True
    if refers_elsewhere(plain):
        return False
    return is_number and not re.search(r"[0-9π∞²³½√]|pi\b|inf", plain, re.IGNORECASE)


# ------------------------------------------------------------------------- steps


def step(
    kind: str,
    exercise: str = "",
    part: str = "",
    points: float | None = None,
    answer: str | None = None,
    reason: str = "",
    by: str = "",
) -> Decision:
    """Return a step: a decision on no single student, as of now."""
    now = datetime.now(UTC)
    return Decision("", exercise, "", part, kind, points, reason, answer, by, now, id=new_id())


def steps_on(
    exam: Exam,
    kind: str,
    place: str = "",
    points: float | None = None,
    answer: str | None = None,
    reason: str = "",
    by: str = "",
    *,
    lang: str = "en",
) -> list[Decision]:
    """Return a change of what a place names (:meth:`Exam.called`), one batch whatever the number of its
    questions; without a place of everything.

    Raises
    ------
    BadInput
        The place names no question, or several where a single answer is meant; or an error has no such name.
    """
    questions = exam.called(place, lang) if place else [("", "")]
    if kind in (ACCEPTED, GIVEN) and len(questions) > 1:
        raise BadInput(
            "an answer is of one question; {name} names {count}", name=place[:40], count=len(questions)
        )
    if kind == PRICE:
        _check_error(exam, {exercise for exercise, _ in questions if exercise}, answer or "")
    return as_one(step(kind, *question, points, answer, reason, by) for question in questions)


def _check_error(exam: Exam, exercises: Set[str], verdict: str) -> None:
    """Refuse a named error that no answer can have; the mistakes are those that the exercises declare, by
    default all of them."""
    known = {FOLLOWS_IN_OTHER_CASE, *(f"slip:{name}" for name in PENALTIES if name != "mistake")}
    for exercise in exercises or exam.issued.exercises:
        known |= {f"mistake:{name}" for name in exam.course[exercise].solution.mistakes}
    known |= {
        line.verdict for graded in exam.machine for line in graded.lines.values() if ":" in line.verdict
    }
    if ":" in verdict and verdict not in known:
        raise BadInput("no error {verdict!r}{nearest}", verdict=verdict[:40], nearest=nearest(verdict, known))


def as_one(steps: Iterable[Decision]) -> list[Decision]:
    """Return steps as one batch: one decision, which is printed and taken back as a whole."""
    batch = new_id()
    return [one._replace(id=batch) for one in steps]


def undoing(steps: Sequence[Decision], by: str, reason: str = "") -> list[Decision]:
    """Return what takes decisions back, the last first."""
    more = {"by": by, "made": datetime.now(UTC), "line": 0, "location": "", "reason": reason}
    return [one.withdrawn(**more) for one in reversed(steps)]


def steps_since(steps: Sequence[Decision], day: date) -> Sequence[Decision]:
    """Return the steps from the first one that was made on a day, of this machine's zone, or after it."""
    days = (one.made.astimezone().date() if one.made else date.min for one in steps)
    return steps[next((k for k, made in enumerate(days) if made >= day), len(steps)) :]


class Restated(NamedTuple):
    """Difference between an assignment's file and what was issued."""

    steps: tuple[Decision, ...]  #: one batch: new weights, margins and prices, and the new step of the mark
    notes: tuple[Message, ...]  #: differences that no step applies


def restated(assignment: Assignment, exam: Exam) -> Restated:
    """Return what an assignment's file states now and did not when it was issued, unless a step has applied
    it."""
    adjustments, steps, notes = exam.decisions.adjustments, [], []
    stated = exam.issued.assignment or {}
    name = f"{assignment.name}.toml"
    for asked in assignment.exercises:
        record = next((r for (e, _), r in exam.issued.records.items() if e == asked.name), None)
        if record is None:
            notes.append(
                Message("{file} names {exercise}, which was not issued", file=name, exercise=asked.name)
            )
            continue
        exercise = exam.course[asked.name]
        issued = {str(part["id"]): float(part["points"]) for part in record["parts"]}
        variant = exercise.from_record(record)
        own = [part for part in exercise.spec.parts if part.id in issued]
        for part in with_points(variant.asking(own), asked).parts:
            points = float(part.points)
            now = adjustments.worth(asked.name, {"id": part.id, "points": issued[part.id]})
            if points not in (issued[part.id], now):
                steps.append(step(WEIGHT, asked.name, part.id, points))
    before = stated.get("mark") or {}
    if assignment.mark is not None:
        if assignment.mark.step not in (before.get("step"), adjustments.scale(exam.issued)["step"]):
            steps.append(step(STEP, points=assignment.mark.step))
        if before and assignment.mark.of != before.get("of"):
            notes.append(
                Message(
                    "{file} states a mark out of {now:g}, and the papers one out of {before:g}, which stays",
                    file=name,
                    now=assignment.mark.of,
                    before=before.get("of"),
                )
            )
    rules = Rules.of(assignment.marking, name, exam.course.folder.rules)
    issued_rules = rules_of(exam.course, exam.issued) or exam.course.folder.rules
    steps += _restated_prices(exam, issued_rules, rules)
    if rules.digits < issued_rules.digits and adjustments.digits != rules.digits:
        steps.append(step(DIGITS, points=rules.digits))
    elif rules.digits > issued_rules.digits:
        notes.append(
            Message(
                "{file} states digits = {now:g} in [marking], and the papers {before:g}, which stays: "
                "margins would become narrower, and what was right stays right",
                file=name,
                now=rules.digits,
                before=issued_rules.digits,
            )
        )
    return Restated(tuple(as_one(steps)), tuple(notes))


def _restated_prices(exam: Exam, before: Rules, now: Rules) -> Iterator[Decision]:
    """Yield the prices that rules of marking state now and did not before, unless a step has applied them."""
    kinds = [kind for kind in PENALTIES if now.share(kind) != before.share(kind)]
    shares = {("", f"slip:{kind}"): now.share(kind) for kind in kinds if kind != "mistake"}
    if now.follow_through != before.follow_through:
        shares["", "follow_through"] = now.follow_through
    if (now.follow_through, now.other_case) != (before.follow_through, before.other_case):
        shares["", FOLLOWS_IN_OTHER_CASE] = min(now.follow_through, now.other_case)
    for name in exam.issued.exercises if kinds else ():
        for mistake in exam.course[name].solution.mistakes.values():
            if mistake.share is None and mistake.kind in kinds:
                shares[name, f"mistake:{mistake.name}"] = now.share(mistake.kind)
    for (exercise, verdict), share in shares.items():
        if exam.decisions.adjustments.prices.get((exercise, "", verdict)) != share:
            yield step(PRICE, exercise, points=share, answer=verdict)
