"""Host of the package: a link opens an exercise or an assignment of a course.

A student has personal variants, answers on the page, and gets feedback. Marks are those of
:mod:`coursework.marking`; answers are read as data and never run.
"""

from __future__ import annotations

import datetime
import json
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from coursework.course.answer_key import Key
from coursework.course.course import Course
from coursework.course.marking_rules import Rules
from coursework.course.variant import Variant
from coursework.errors import UnknownName
from coursework.gradebook.feedback_sheets import feedback_sheet
from coursework.gradebook.graded_sheet import Graded
from coursework.issuing.assignment import AskedExercise, Assignment, read_assignment, text_in
from coursework.issuing.papers import date_text
from coursework.issuing.variant_assignment import keyed
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.lti.class_page import class_rows, issued_json, settings_rows, taken_csv
from coursework.lti.host import Form, LTIRequest, LTIResponse, Offer, OfferGroup
from coursework.lti.link_settings import BEST, LinkSettings
from coursework.lti.pages import LTIPages, SheetForm
from coursework.lti.refusal import LTIRefusal
from coursework.lti.roles import Role
from coursework.lti.services import NotServed
from coursework.lti.single_assignment import own_records, variants
from coursework.lti.storage import LTIAttempt, LTIPaper, Score, Storage
from coursework.marking.marking import mark
from coursework.messages import localised
from coursework.rendering.feedback import verdict_word
from coursework.sheets.handout import handout
from coursework.sheets.paper import FeedbackPaper, Paper, PaperHeading

_LONGEST = 4000  #: characters of one answer
_COMMENT = 900  #: characters of a comment in the gradebook


class CourseHost:
    """Provider of a course's exercises for the service."""

    def __init__(
        self,
        course: Course[Any],
        storage: Storage,
        assignments: Sequence[Path] = (),
        clock: Callable[[], float] = time.time,
    ):
        self.course, self._storage, self._clock = course, storage, clock
        self.pages = LTIPages(course.folder)
        self._assignments = {path.stem: read_assignment(path, course) for path in assignments}
        self._offers: dict[str, list[OfferGroup]] = {}

    # -------------------------------------------------------------- offers

    @property
    def languages(self) -> tuple[str, ...]:
        default = self.course.folder.language
        return (default, *(lang for lang in self.course.folder.languages if lang != default))

    def offer_groups(self, lang: str) -> Sequence[OfferGroup]:
        """Return the assignments, then the exercises by chapter."""
        if lang not in self._offers:
            self._offers[lang] = [group for group in self._grouped_offers(lang) if group.offers]
        return self._offers[lang]

    def _grouped_offers(self, lang: str) -> list[OfferGroup]:
        texts, folder = words(lang)["lti"]["pick"], self.course.folder
        assignment_offers = [
            self._assignment_offer(name, assignment, lang) for name, assignment in self._assignments.items()
        ]
        groups = [OfferGroup(texts["assignments"], tuple(assignment_offers))]
        placed: set[str] = set()
        for chapter in folder.chapters:
            placed |= set(chapter.exercises)
            groups.append(
                OfferGroup(
                    f"{chapter.number}. {chapter.title(lang)}",
                    tuple(self._exercise_offer(name, lang) for name in chapter.exercises),
                )
            )
        others = tuple(self._exercise_offer(name, lang) for name in folder.names if name not in placed)
        return [*groups, OfferGroup(texts["others"] if placed else folder.title(lang), others)]

    def _assignment_offer(self, name: str, assignment: Assignment, lang: str) -> Offer:
        points = sum(self._points(exercise, assignment) for exercise in assignment.exercises)
        return Offer(
            f"assignment:{name}",
            text_in(assignment.title, lang) or name,
            points,
            f"{name} {' '.join(assignment.title.values())}",
        )

    def _exercise_offer(self, name: str, lang: str) -> Offer:
        exercise = self.course[name]
        spoken = lang if lang in exercise.languages else exercise.languages[0]
        search_text = " ".join([name, *(exercise.title(language) for language in exercise.languages)])
        return Offer(
            f"exercise:{name}", exercise.title(spoken), self._points(AskedExercise(name)), search_text
        )

    def _points(self, asked_exercise: AskedExercise, assignment: Assignment | None = None) -> float:
        """Return the points of an exercise, of an assignment or alone."""
        if isinstance(asked_exercise.points, float):
            return asked_exercise.points
        # The parts asked may depend on the given values; one variant represents them all.
        exercise = self.course[asked_exercise.name]
        key = None
        if assignment is not None and asked_exercise.seed is not None:
            key = keyed(assignment.secret or self._storage.secret(), assignment)
        parts = exercise.variant(
            asked_exercise.seed or 0, exercise.languages[0], asked_exercise.parts, key
        ).parts
        points_of = asked_exercise.points if isinstance(asked_exercise.points, Mapping) else {}
        return float(sum(points_of.get(part.id, part.points) for part in parts))

    # ---------------------------------------------------------------------- pages

    def show(self, visit: LTIRequest) -> LTIResponse:
        role, wanted = visit.launch.role, self._wanted(visit)
        if role is Role.STUDENT:
            if visit.path:
                raise LTIRefusal(
                    "role" if visit.path in _OF_CLASS else "page",
                    403 if visit.path in _OF_CLASS else 404,
                    "a student",
                )
            return self._student_page(visit, wanted)
        if not role.sees_class:
            raise LTIRefusal("nobody", 403, f"role {role}")
        if visit.path == "sheet":
            return LTIResponse(
                self._sheet(
                    visit, wanted, self._paper(visit, wanted), 1, notes=[words(visit.lang)["lti"]["preview"]]
                )
            )
        if visit.path in _OF_CLASS:
            return self._of_class(visit, wanted)
        raise LTIRefusal("page", 404, "no such page")

    def _student_page(self, visit: LTIRequest, wanted: LinkSettings) -> LTIResponse:
        paper, tries = self._paper(visit, wanted), self._tries(visit, wanted)
        left = wanted.tries is None or len(tries) < wanted.tries
        if tries and not ("again" in visit.query and left):
            return LTIResponse(self._feedback(visit, wanted, paper, tries))
        held = _filled(tries[-1].answers, self._is_alone(wanted)) if tries else {}
        return LTIResponse(
            self._sheet(
                visit,
                wanted,
                paper,
                len(tries) + 1,
                filled=held,
                notes=self._rules(visit, wanted, len(tries)),
            )
        )

    def _sheet(
        self, visit: LTIRequest, wanted: LinkSettings, paper: LTIPaper, number: int, *, filled: Mapping[str, Sequence[str]] | None = None,
        notes: Sequence[str] = (), unread: Sequence[str] = (),
    ) -> str:  # fmt: skip
        sheets = Paper(
            self._heading(visit, wanted),
            tuple(handout(v, visit.launch.name) for v in self._variants(visit, paper)),
        )
        preview = visit.launch.role is not Role.STUDENT
        texts = words(visit.lang)["lti"]
        more = (
            [(visit.home, texts["to_class"])]
            if preview
            else [(visit.home, texts["see_again"])]
            if number > 1
            else []
        )
        form = SheetForm(
            f"{visit.home}/sheet" if preview else visit.home, visit.csrf_token, number, filled or {}, tuple(notes), tuple(unread), bool(unread),
            tuple(more),
        )  # fmt: skip
        return self.pages.sheet(sheets, form, alone=self._is_alone(wanted))

    def _feedback(
        self, visit: LTIRequest, wanted: LinkSettings, paper: LTIPaper, tries: Sequence[LTIAttempt]
    ) -> str:
        texts, last, preview = words(visit.lang)["lti"], tries[-1], visit.launch.role is not Role.STUDENT
        over = wanted.tries is not None and len(tries) >= wanted.tries
        graded = self._marked(visit, wanted, paper, last.answers)
        answers = wanted.shows_answers and over and not preview
        sheets = tuple(
            feedback_sheet(self.course, graded_exercise, answers=answers) for graded_exercise in graded
        )
        feedback_paper = FeedbackPaper(
            self._heading(visit, wanted),
            sheets,
            sum(s.points for s in sheets),
            sum(s.out_of for s in sheets),
            answers=answers,
        )
        more = [(f"{visit.home}/sheet", texts["again"]), (visit.home, texts["to_class"])] if preview else []
        if not preview and not over:
            more.append((f"{visit.home}?again=1", texts["again"]))
        notes = (
            [texts["preview"]]
            if preview
            else [self._tried(visit, last), *self._rules(visit, wanted, len(tries)), self._sent(visit)]
        )
        return self.pages.feedback(
            feedback_paper,
            SheetForm("", "", notes=tuple(notes), more=tuple(more), leave=visit.launch.return_url),
            alone=self._is_alone(wanted),
        )

    def _tried(self, visit: LTIRequest, last: LTIAttempt) -> str:
        at = datetime.datetime.fromtimestamp(last.at)
        return str(words(visit.lang)["lti"]["try_number"]).format(
            last.number, f"{date_text(at.date(), visit.lang)}, {at:%H:%M}"
        )

    def _rules(self, visit: LTIRequest, wanted: LinkSettings, done: int) -> list[str]:
        """Return the sentences that state how many attempts are left and which of them counts."""
        texts = words(visit.lang)["lti"]
        counts = str(texts["counts_best" if wanted.counts == BEST else "counts_last"])
        if wanted.tries is None:
            return [f"{texts['tries_free']} {counts}"]
        left = wanted.tries - done
        if left <= 0:
            return [texts["no_try_left"]]
        singular = left < 2 if words(visit.lang)["numbers"]["one_below_two"] else left == 1
        sentence = str(texts["tries_left"]["one" if singular else "many"]).format(left)
        return [f"{sentence} {counts}" if wanted.tries > 1 else sentence]

    def _sent(self, visit: LTIRequest) -> str:
        texts, waiting = words(visit.lang)["lti"], visit.scores().get(visit.launch.person)
        if waiting is None:
            return str(texts["score_none"])
        return str(texts["score_sent" if waiting.due is None else "score_waits"])

    # -------------------------------------------------------------------- submissions

    def take(self, visit: LTIRequest, form: Form) -> LTIResponse:
        role, wanted = visit.launch.role, self._wanted(visit)
        if role is not Role.STUDENT and not role.sees_class:
            raise LTIRefusal("nobody", 403, f"role {role}")
        preview = role is not Role.STUDENT
        if visit.path != ("sheet" if preview else ""):
            raise LTIRefusal("page", 404, "nothing is handed in there")
        paper = self._paper(visit, wanted)
        answers = self._answers(visit, wanted, paper, form)
        tries = [] if preview else self._tries(visit, wanted)
        number = _number(form)
        if number <= len(tries):
            return LTIResponse(goto=visit.home)  # the same form sent again
        if wanted.tries is not None and len(tries) >= wanted.tries:
            raise LTIRefusal("tries_over", 409, "no try is left")
        graded = self._marked(visit, wanted, paper, answers)
        texts = words(visit.lang)["lti"]
        back: dict[str, Any] = {
            "filled": _filled(answers, self._is_alone(wanted)),
            "notes": self._rules(visit, wanted, len(tries)),
        }
        if not any(text.strip() for exercise_answers in answers for text in exercise_answers.values()):
            return LTIResponse(
                self._sheet(visit, wanted, paper, len(tries) + 1, **{**back, "notes": [texts["empty"]]}), 422
            )
        unread = self._unread(visit, wanted, graded)
        if unread and not form.get("_as_it_is"):
            return LTIResponse(self._sheet(visit, wanted, paper, len(tries) + 1, unread=unread, **back), 422)
        attempt = self._try(visit, len(tries) + 1, answers, graded)
        if preview:
            return LTIResponse(self._feedback(visit, wanted, paper, [attempt]))
        self._storage.submit(self._storage_key(visit, wanted), attempt)
        return LTIResponse(goto=visit.home)

    def _answers(
        self, visit: LTIRequest, wanted: LinkSettings, paper: LTIPaper, form: Form
    ) -> list[dict[str, str]]:
        """Return the submitted answers by part, one mapping per exercise.

        Raises
        ------
        LTIRefusal
            A field does not belong to the sheet, or is too long.
        """
        alone, answers, boxes = self._is_alone(wanted), [], set()
        for number, record in enumerate(paper.records, 1):
            names = {str(part["id"]): _box(str(part["id"]), number, alone) for part in record["parts"]}
            boxes |= set(names.values())
            answers.append({part: ", ".join(form.get(box, ())) for part, box in names.items()})
        if strange := [name for name in form if name not in boxes and not name.startswith("_")]:
            raise LTIRefusal("answer", 400, f"{len(strange)} fields that are no box of the sheet")
        if any(len(text) > _LONGEST for exercise_answers in answers for text in exercise_answers.values()):
            raise LTIRefusal("too_large", 413, "an answer")
        return answers

    def _unread(self, visit: LTIRequest, wanted: LinkSettings, graded: Sequence[Graded]) -> list[str]:
        """Return a sentence for each answer that could not be read."""
        form, sentences = str(words(visit.lang)["lti"]["unread_line"]), []
        for exercise_number, graded_exercise in enumerate(graded, 1):
            for number, line in enumerate(graded_exercise.lines.values(), 1):
                if line.verdict == "unreadable":
                    label = f"{number}" if self._is_alone(wanted) else f"{exercise_number}.{number}"
                    sentences.append(form.format(label, line.says))
        return sentences

    def _try(
        self, visit: LTIRequest, number: int, answers: Sequence[Mapping[str, str]], graded: Sequence[Graded]
    ) -> LTIAttempt:
        lang, waits = (
            visit.lang,
            any(
                line.verdict in ("to_mark", "unreadable")
                for graded_exercise in graded
                for line in graded_exercise.lines.values()
            ),
        )
        points, out_of = (
            sum(graded_exercise.points for graded_exercise in graded),
            sum(graded_exercise.out_of for graded_exercise in graded),
        )
        texts, several = words(lang)["lti"], len(graded) > 1
        lines = [
            texts["comment_line"].format(
                f"{exercise_number}.{k}" if several else k, verdict_word(line.verdict, lang)
            )
            for exercise_number, graded_exercise in enumerate(graded, 1)
            for k, line in enumerate(graded_exercise.lines.values(), 1)
        ]
        values = {
            "points": _number_text(points, lang),
            "out_of": _number_text(out_of, lang),
            "number": number,
        }
        comment = texts["comment"].format(**values, verdicts="; ".join(lines))
        if len(comment) > _COMMENT:
            comment = comment[:_COMMENT].rpartition(";")[0] + "; …"
        return LTIAttempt(visit.launch.person, number, self._clock(), answers, points, out_of, waits, comment)

    def score(self, visit: LTIRequest) -> Score | None:
        try:
            wanted = self._wanted(visit)
        except LTIRefusal:
            return None
        counted = counted_try(self._tries(visit, wanted), wanted)
        if counted is None:
            return None
        return Score(counted.points, counted.out_of, counted.comment, counted.waits)

    # ----------------------------------------------------------------------- class

    def _of_class(self, visit: LTIRequest, wanted: LinkSettings) -> LTIResponse:
        key, lang = self._storage_key(visit, wanted), visit.lang
        papers, tries = self._storage.papers(key), self._storage.tries(key)
        counted = {p.person: counted_try([t for t in tries if t.person == p.person], wanted) for p in papers}
        if visit.path == "answers.csv":
            return _file("answers.csv", "text/csv; charset=utf-8", taken_csv(papers, counted))
        if visit.path == "issued.json":
            content = issued_json(papers, None if self._is_alone(wanted) else self._assignment(wanted))
            return _file(
                "issued.json", "application/json", json.dumps(content, ensure_ascii=False, indent=1).encode()
            )
        members, note = _members(visit, lang)
        rows = class_rows(papers, tries, counted, visit.scores(), members, lang)
        texts = words(lang)["lti"]["class"]
        files = [("answers.csv", texts["answers_file"]), ("issued.json", texts["issued_file"])]
        if members is not None:
            files.insert(0, ("roster.csv", texts["roster_file"]))
        return LTIResponse(
            self.pages.page(
                "platform/lti_class",
                lang,
                {
                    "title": visit.launch.link_title or self._title(wanted, lang),
                    "context": visit.launch.context_title,
                    "home": visit.home,
                    "settings": settings_rows(
                        visit, wanted, self._title(wanted, lang), self._assignment(wanted).versions
                    ),
                    "rows": rows,
                    "roster_note": note,
                    "files": files,
                },
            )
        )

    # --------------------------------------------------------------------- pieces

    def _wanted(self, visit: LTIRequest) -> LinkSettings:
        """Return the settings of the link, after a check that their assignment or exercise exists.

        Raises
        ------
        LTIRefusal
            It names no content, or unknown content.
        """
        wanted = LinkSettings.of(visit.launch.custom)
        self._assignment(wanted)
        return wanted

    def _assignment(self, wanted: LinkSettings) -> Assignment:
        if wanted.assignment:
            if wanted.assignment not in self._assignments:
                raise LTIRefusal("unknown_choice", 404, f"no assignment {wanted.assignment[:60]!r}")
            return self._assignments[wanted.assignment]
        try:
            self.course[wanted.exercise].parts_worth(dict.fromkeys(wanted.parts, 1.0))
        except (UnknownName, KeyError):
            raise LTIRefusal(
                "unknown_choice", 404, f"no exercise {wanted.exercise[:60]!r} with such parts"
            ) from None
        return Assignment(wanted.exercise, (AskedExercise(wanted.exercise, wanted.parts or None),))

    def _is_alone(self, wanted: LinkSettings) -> bool:
        return not wanted.assignment

    def _title(self, wanted: LinkSettings, lang: str) -> str:
        assignment = self._assignment(wanted)
        if wanted.assignment:
            return text_in(assignment.title, lang) or assignment.name
        exercise = self.course[wanted.exercise]
        return exercise.title(lang if lang in exercise.languages else exercise.languages[0])

    def _heading(self, visit: LTIRequest, wanted: LinkSettings) -> PaperHeading:
        assignment, lang = self._assignment(wanted), visit.lang
        return PaperHeading(
            lang=lang,
            title=self._title(wanted, lang),
            course=text_in(assignment.course, lang)
            or visit.launch.context_title
            or self.course.folder.title(lang),
            student=visit.launch.name,
            date=date_text(assignment.date, lang),
            duration=text_in(assignment.duration, lang),
            instructions=text_in(assignment.instructions, lang),
            logo=assignment.picture(lang),
        )

    def _storage_key(self, visit: LTIRequest, wanted: LinkSettings) -> str:
        """Return the key under which papers and attempts are stored: the link and its content, since a
        teacher may change the content."""
        return f"{visit.launch.link_key} {wanted.key}"

    def _paper(self, visit: LTIRequest, wanted: LinkSettings) -> LTIPaper:
        """Return the paper issued to the person; issue one if there is none. Nothing is issued to somebody
        who sees the class."""
        key, launch = self._storage_key(visit, wanted), visit.launch
        stored = self._storage.paper(key, launch.person)
        if stored is not None:
            return stored
        assignment = self._assignment(wanted)
        student = launch.role is Role.STUDENT
        issued = [paper_of_link.records for paper_of_link in self._storage.papers(key)] if student else []
        records = own_records(self.course, assignment, launch, visit.lang, self._storage.secret(), issued)
        paper = LTIPaper(launch.person, launch.name or launch.person, wanted.as_plain(), records)
        return self._storage.issue(key, paper) if student else paper

    def _tries(self, visit: LTIRequest, wanted: LinkSettings) -> list[LTIAttempt]:
        return self._storage.tries(self._storage_key(visit, wanted), visit.launch.person)

    def _variants(self, visit: LTIRequest, paper: LTIPaper) -> list[Variant]:
        return variants(self.course, paper.records, visit.lang)

    def _marked(
        self, visit: LTIRequest, wanted: LinkSettings, paper: LTIPaper, answers: Sequence[Mapping[str, str]]
    ) -> list[Graded]:
        """Return the marked answers, one sheet per exercise, by the rules of the assignment."""
        stated = self._assignment(wanted).marking
        rules = Rules.of(stated, "the assignment", self.course.folder.rules) if stated else None
        graded = []
        for variant, texts in zip(self._variants(visit, paper), answers, strict=True):
            if rules is not None:
                variant.key = Key(variant, rules)
            lines = mark(variant, texts)
            record = {**variant.record, "lang": variant.lang}
            written = tuple(part for part, text in texts.items() if text.strip())
            graded.append(
                Graded(visit.launch.name, variant.exercise.name, variant.seed, dict(lines), written, record)
            )
        return graded


#: Pages for staff.
_OF_CLASS = ("", "answers.csv", "issued.json")


def counted_try(tries: Sequence[LTIAttempt], wanted: LinkSettings) -> LTIAttempt | None:
    """Return the attempt of one person that counts: the best, the latest of equal ones, or the last."""
    if not tries:
        return None
    return (
        max(tries, key=lambda attempt: (attempt.points, attempt.number))
        if wanted.counts == BEST
        else tries[-1]
    )


def _members(visit: LTIRequest, lang: str) -> tuple[Any, str]:
    """Return the roster, and the sentence to show if there is none."""
    texts = words(lang)["lti"]["class"]
    if visit.roster is None:
        return None, texts["no_roster"].format(texts["roster_off"])
    try:
        return visit.roster(), ""
    except NotServed as fault:
        return None, texts["no_roster"].format(localised(fault, lang))


def _box(part: str, number: int, alone: bool) -> str:
    """Return the name of a part's input field on the page."""
    return part if alone else f"e{number}-{part}"


def _filled(answers: Sequence[Mapping[str, str]], alone: bool) -> dict[str, list[str]]:
    """Return the values of the input fields: each tick of a multiple choice, and the whole text for a text
    field."""
    return {
        _box(part, number, alone): [text, *text.split(", ")] if ", " in text else [text]
        for number, exercise_answers in enumerate(answers, 1)
        for part, text in exercise_answers.items()
        if text
    }


def _number(form: Form) -> int:
    text = next(iter(form.get("_number", ())), "")
    if not text.isdecimal() or len(text) > 6:
        raise LTIRefusal("answer", 400, "no number of a try")
    return int(text)


def _number_text(number: float, lang: str) -> str:
    return localise(plain(round(number, 3)), lang)


def _file(name: str, kind: str, data: bytes) -> LTIResponse:
    return LTIResponse(file=name, kind=kind, data=data)
