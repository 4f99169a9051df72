"""The host that the package brings: a link opens an exercise or an assignment of a course.

A student has variants of their own, answers on the page, and is told what became of the answers. Marks are those of
:mod:`coursework.marking`; an answer is read, and never run.
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
from coursework.gradebook.graded import Graded
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.lti.class_page import class_rows, issued_json, settings_rows, taken_csv
from coursework.lti.host import Form, Offer, Reply, Shelf, Visit
from coursework.lti.pages import Form as Surrounding
from coursework.lti.pages import Pages
from coursework.lti.refusal import Refused
from coursework.lti.roles import Role
from coursework.lti.services import NotServed
from coursework.lti.single_assignment import own_records, variants
from coursework.lti.storage import Paper, Score, Storage, Try
from coursework.lti.wanted import BEST, Wanted
from coursework.making.assignment import AskedExercise, Assignment, read_assignment, text_in
from coursework.making.papers import date_text
from coursework.making.variant_assignment import keyed
from coursework.marking.marking import mark
from coursework.rendering.feedback import verdict_word
from coursework.sheets.handout import handout
from coursework.sheets.paper import FeedbackPaper, Heading
from coursework.sheets.paper import Paper as Sheets

_LONGEST = 4000  #: characters of one answer
_COMMENT = 900  #: characters of a comment in the gradebook


class CourseHost:
    """A course behind the service."""

    def __init__(
        self,
        course: Course[Any],
        storage: Storage,
        assignments: Sequence[Path] = (),
        clock: Callable[[], float] = time.time,
    ):
        self.course, self._storage, self._clock = course, storage, clock
        self.pages = Pages(course.folder)
        self._assignments = {path.stem: read_assignment(path, course) for path in assignments}
        self._offers: dict[str, list[Shelf]] = {}

    # -------------------------------------------------------------- what there is

    @property
    def languages(self) -> tuple[str, ...]:
        own = self.course.folder.language
        return (own, *(one for one in self.course.folder.languages if one != own))

    def shelves(self, lang: str) -> Sequence[Shelf]:
        """Assignments, then the exercises by chapter."""
        if lang not in self._offers:
            self._offers[lang] = [shelf for shelf in self._shelved(lang) if shelf.offers]
        return self._offers[lang]

    def _shelved(self, lang: str) -> list[Shelf]:
        said, folder = words(lang)["lti"]["pick"], self.course.folder
        set_out = [self._set_out(name, one, lang) for name, one in self._assignments.items()]
        found = [Shelf(said["assignments"], tuple(set_out))]
        placed: set[str] = set()
        for chapter in folder.chapters:
            placed |= set(chapter.exercises)
            found.append(
                Shelf(
                    f"{chapter.number}. {chapter.title(lang)}",
                    tuple(self._offered(name, lang) for name in chapter.exercises),
                )
            )
        others = tuple(self._offered(name, lang) for name in folder.names if name not in placed)
        return [*found, Shelf(said["others"] if placed else folder.title(lang), others)]

    def _set_out(self, name: str, assignment: Assignment, lang: str) -> Offer:
        points = sum(self._points(asked, assignment) for asked in assignment.exercises)
        return Offer(
            f"assignment:{name}",
            text_in(assignment.title, lang) or name,
            points,
            f"{name} {' '.join(assignment.title.values())}",
        )

    def _offered(self, name: str, lang: str) -> Offer:
        exercise = self.course[name]
        spoken = lang if lang in exercise.languages else exercise.languages[0]
        known = " ".join([name, *(exercise.title(one) for one in exercise.languages)])
        return Offer(f"exercise:{name}", exercise.title(spoken), self._points(AskedExercise(name)), known)

    def _points(self, asked: AskedExercise, assignment: Assignment | None = None) -> float:
        """Return the points of an exercise, of an assignment or alone."""
        if isinstance(asked.points, float):
            return asked.points
        # Which parts are asked may hang on the given values; one variant stands for them all.
        exercise = self.course[asked.name]
        key = None
        if assignment is not None and asked.seed is not None:
            key = keyed(assignment.secret or self._storage.secret(), assignment)
        parts = exercise.variant(asked.seed or 0, exercise.languages[0], asked.parts, key).parts
        own = asked.points if isinstance(asked.points, Mapping) else {}
        return float(sum(own.get(part.id, part.points) for part in parts))

    # ---------------------------------------------------------------------- pages

    def show(self, visit: Visit) -> Reply:
        role, wanted = visit.launch.role, self._wanted(visit)
        if role is Role.STUDENT:
            if visit.path:
                raise Refused(
                    "role" if visit.path in _OF_CLASS else "page",
                    403 if visit.path in _OF_CLASS else 404,
                    "a student",
                )
            return self._own_page(visit, wanted)
        if not role.sees_class:
            raise Refused("nobody", 403, f"role {role}")
        if visit.path == "sheet":
            return Reply(
                self._sheet(
                    visit, wanted, self._paper(visit, wanted), 1, notes=[words(visit.lang)["lti"]["preview"]]
                )
            )
        if visit.path in _OF_CLASS:
            return self._of_class(visit, wanted)
        raise Refused("page", 404, "no such page")

    def _own_page(self, visit: Visit, wanted: Wanted) -> Reply:
        paper, tries = self._paper(visit, wanted), self._tries(visit, wanted)
        left = wanted.tries is None or len(tries) < wanted.tries
        if tries and not ("again" in visit.query and left):
            return Reply(self._feedback(visit, wanted, paper, tries))
        held = _filled(tries[-1].answers, self._is_alone(wanted)) if tries else {}
        return Reply(
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
        self, visit: Visit, wanted: Wanted, paper: Paper, number: int, *, filled: Mapping[str, Sequence[str]] | None = None,
        notes: Sequence[str] = (), unread: Sequence[str] = (),
    ) -> str:  # fmt: skip
        shown = Sheets(
            self._heading(visit, wanted),
            tuple(handout(v, visit.launch.name) for v in self._variants(visit, paper)),
        )
        preview = visit.launch.role is not Role.STUDENT
        said = words(visit.lang)["lti"]
        more = (
            [(visit.home, said["to_class"])]
            if preview
            else [(visit.home, said["see_again"])]
            if number > 1
            else []
        )
        form = Surrounding(
            f"{visit.home}/sheet" if preview else visit.home, visit.seal, number, filled or {}, tuple(notes), tuple(unread), bool(unread),
            tuple(more),
        )  # fmt: skip
        return self.pages.sheet(shown, form, alone=self._is_alone(wanted))

    def _feedback(self, visit: Visit, wanted: Wanted, paper: Paper, tries: Sequence[Try]) -> str:
        said, last, preview = words(visit.lang)["lti"], tries[-1], visit.launch.role is not Role.STUDENT
        over = wanted.tries is not None and len(tries) >= wanted.tries
        graded = self._marked(visit, wanted, paper, last.answers)
        answers = wanted.shows_answers and over and not preview
        sheets = tuple(feedback_sheet(self.course, one, answers=answers) for one in graded)
        told = FeedbackPaper(
            self._heading(visit, wanted),
            sheets,
            sum(s.points for s in sheets),
            sum(s.out_of for s in sheets),
            answers=answers,
        )
        more = [(f"{visit.home}/sheet", said["again"]), (visit.home, said["to_class"])] if preview else []
        if not preview and not over:
            more.append((f"{visit.home}?again=1", said["again"]))
        notes = (
            [said["preview"]]
            if preview
            else [self._tried(visit, last), *self._rules(visit, wanted, len(tries)), self._sent(visit)]
        )
        return self.pages.feedback(
            told,
            Surrounding("", "", notes=tuple(notes), more=tuple(more), leave=visit.launch.return_url),
            alone=self._is_alone(wanted),
        )

    def _tried(self, visit: Visit, last: Try) -> str:
        at = datetime.datetime.fromtimestamp(last.at)
        return str(words(visit.lang)["lti"]["try_number"]).format(
            last.number, f"{date_text(at.date(), visit.lang)}, {at:%H:%M}"
        )

    def _rules(self, visit: Visit, wanted: Wanted, done: int) -> list[str]:
        """Return the sentences that state how many attempts are left and which of them counts."""
        said = words(visit.lang)["lti"]
        counts = str(said["counts_best" if wanted.counts == BEST else "counts_last"])
        if wanted.tries is None:
            return [f"{said['tries_free']} {counts}"]
        left = wanted.tries - done
        if left <= 0:
            return [said["no_try_left"]]
        singular = left < 2 if words(visit.lang)["numbers"]["one_below_two"] else left == 1
        told = str(said["tries_left"]["one" if singular else "many"]).format(left)
        return [f"{told} {counts}" if wanted.tries > 1 else told]

    def _sent(self, visit: Visit) -> str:
        said, waiting = words(visit.lang)["lti"], visit.scores().get(visit.launch.person)
        if waiting is None:
            return str(said["score_none"])
        return str(said["score_sent" if waiting.due is None else "score_waits"])

    # -------------------------------------------------------------------- handing in

    def take(self, visit: Visit, form: Form) -> Reply:
        role, wanted = visit.launch.role, self._wanted(visit)
        if role is not Role.STUDENT and not role.sees_class:
            raise Refused("nobody", 403, f"role {role}")
        preview = role is not Role.STUDENT
        if visit.path != ("sheet" if preview else ""):
            raise Refused("page", 404, "nothing is handed in there")
        paper = self._paper(visit, wanted)
        answers = self._answers(visit, wanted, paper, form)
        tries = [] if preview else self._tries(visit, wanted)
        number = _number(form)
        if number <= len(tries):
            return Reply(goto=visit.home)  # the same form once more
        if wanted.tries is not None and len(tries) >= wanted.tries:
            raise Refused("tries_over", 409, "no try is left")
        graded = self._marked(visit, wanted, paper, answers)
        said = words(visit.lang)["lti"]
        back: dict[str, Any] = {
            "filled": _filled(answers, self._is_alone(wanted)),
            "notes": self._rules(visit, wanted, len(tries)),
        }
        if not any(text.strip() for one in answers for text in one.values()):
            return Reply(
                self._sheet(visit, wanted, paper, len(tries) + 1, **{**back, "notes": [said["empty"]]}), 422
            )
        unread = self._unread(visit, wanted, graded)
        if unread and not form.get("_as_it_is"):
            return Reply(self._sheet(visit, wanted, paper, len(tries) + 1, unread=unread, **back), 422)
        made = self._try(visit, len(tries) + 1, answers, graded)
        if preview:
            return Reply(self._feedback(visit, wanted, paper, [made]))
        self._storage.hand_in(self._place(visit, wanted), made)
        return Reply(goto=visit.home)

    def _answers(self, visit: Visit, wanted: Wanted, paper: Paper, form: Form) -> list[dict[str, str]]:
        """Return the submitted answers by part, one mapping per exercise.

        Raises
        ------
        Refused
            A field is no box of the sheet, or holds more than anybody types.
        """
        alone, found, boxes = self._is_alone(wanted), [], set()
        for place, record in enumerate(paper.records, 1):
            names = {str(part["id"]): _box(str(part["id"]), place, alone) for part in record["parts"]}
            boxes |= set(names.values())
            found.append({part: ", ".join(form.get(box, ())) for part, box in names.items()})
        if strange := [name for name in form if name not in boxes and not name.startswith("_")]:
            raise Refused("answer", 400, f"{len(strange)} fields that are no box of the sheet")
        if any(len(text) > _LONGEST for one in found for text in one.values()):
            raise Refused("too_large", 413, "an answer")
        return found

    def _unread(self, visit: Visit, wanted: Wanted, graded: Sequence[Graded]) -> list[str]:
        """Return a sentence for each answer that could not be read."""
        form, found = str(words(visit.lang)["lti"]["unread_line"]), []
        for place, one in enumerate(graded, 1):
            for number, line in enumerate(one.lines.values(), 1):
                if line.verdict == "unreadable":
                    called = f"{number}" if self._is_alone(wanted) else f"{place}.{number}"
                    found.append(form.format(called, line.says))
        return found

    def _try(
        self, visit: Visit, number: int, answers: Sequence[Mapping[str, str]], graded: Sequence[Graded]
    ) -> Try:
        lang, waits = (
            visit.lang,
            any(line.verdict in ("to_mark", "unreadable") for one in graded for line in one.lines.values()),
        )
        points, out_of = sum(one.points for one in graded), sum(one.out_of for one in graded)
        said, several = words(lang)["lti"], len(graded) > 1
        lines = [
            said["comment_line"].format(f"{place}.{k}" if several else k, verdict_word(line.verdict, lang))
            for place, one in enumerate(graded, 1)
            for k, line in enumerate(one.lines.values(), 1)
        ]
        told = {"points": _number_text(points, lang), "out_of": _number_text(out_of, lang), "number": number}
        comment = said["comment"].format(**told, verdicts="; ".join(lines))
        if len(comment) > _COMMENT:
            comment = comment[:_COMMENT].rpartition(";")[0] + "; …"
        return Try(visit.launch.person, number, self._clock(), answers, points, out_of, waits, comment)

    def score(self, visit: Visit) -> Score | None:
        try:
            wanted = self._wanted(visit)
        except Refused:
            return None
        counted = counted_try(self._tries(visit, wanted), wanted)
        if counted is None:
            return None
        return Score(counted.points, counted.out_of, counted.comment, counted.waits)

    # ----------------------------------------------------------------------- class

    def _of_class(self, visit: Visit, wanted: Wanted) -> Reply:
        place, lang = self._place(visit, wanted), visit.lang
        papers, tries = self._storage.papers(place), self._storage.tries(place)
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
        said = words(lang)["lti"]["class"]
        files = [("answers.csv", said["answers_file"]), ("issued.json", said["issued_file"])]
        if members is not None:
            files.insert(0, ("roster.csv", said["roster_file"]))
        return Reply(
            self.pages.page(
                "lti_class",
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

    def _wanted(self, visit: Visit) -> Wanted:
        """Return the settings of the link, after a check that their assignment or exercise exists.

        Raises
        ------
        Refused
            It names nothing, or what there is not.
        """
        wanted = Wanted.of(visit.launch.custom)
        self._assignment(wanted)
        return wanted

    def _assignment(self, wanted: Wanted) -> Assignment:
        if wanted.assignment:
            if wanted.assignment not in self._assignments:
                raise Refused("unknown_choice", 404, f"no assignment {wanted.assignment[:60]!r}")
            return self._assignments[wanted.assignment]
        try:
            self.course[wanted.exercise].parts_worth(dict.fromkeys(wanted.parts, 1.0))
        except (UnknownName, KeyError):
            raise Refused(
                "unknown_choice", 404, f"no exercise {wanted.exercise[:60]!r} with such parts"
            ) from None
        return Assignment(wanted.exercise, (AskedExercise(wanted.exercise, wanted.parts or None),))

    def _is_alone(self, wanted: Wanted) -> bool:
        return not wanted.assignment

    def _title(self, wanted: Wanted, lang: str) -> str:
        assignment = self._assignment(wanted)
        if wanted.assignment:
            return text_in(assignment.title, lang) or assignment.name
        exercise = self.course[wanted.exercise]
        return exercise.title(lang if lang in exercise.languages else exercise.languages[0])

    def _heading(self, visit: Visit, wanted: Wanted) -> Heading:
        assignment, lang = self._assignment(wanted), visit.lang
        return Heading(
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

    def _place(self, visit: Visit, wanted: Wanted) -> str:
        """Return the key under which papers and attempts are stored: the link and its content, since a
        teacher may change the content."""
        return f"{visit.launch.place} {wanted.key}"

    def _paper(self, visit: Visit, wanted: Wanted) -> Paper:
        """Return the paper issued to the person; issue one if there is none. Nothing is issued to somebody
        who sees the class."""
        place, launch = self._place(visit, wanted), visit.launch
        found = self._storage.paper(place, launch.person)
        if found is not None:
            return found
        assignment = self._assignment(wanted)
        student = launch.role is Role.STUDENT
        issued = [one.records for one in self._storage.papers(place)] if student else []
        records = own_records(self.course, assignment, launch, visit.lang, self._storage.secret(), issued)
        paper = Paper(launch.person, launch.name or launch.person, wanted.as_plain(), records)
        return self._storage.issue(place, paper) if student else paper

    def _tries(self, visit: Visit, wanted: Wanted) -> list[Try]:
        return self._storage.tries(self._place(visit, wanted), visit.launch.person)

    def _variants(self, visit: Visit, paper: Paper) -> list[Variant]:
        return variants(self.course, paper.records, visit.lang)

    def _marked(
        self, visit: Visit, wanted: Wanted, paper: Paper, answers: Sequence[Mapping[str, str]]
    ) -> list[Graded]:
        """Return the marked answers, one sheet per exercise, by the rules of the assignment."""
        stated = self._assignment(wanted).marking
        rules = Rules.of(stated, "the assignment", self.course.folder.rules) if stated else None
        found = []
        for variant, texts in zip(self._variants(visit, paper), answers, strict=True):
            if rules is not None:
                variant.key = Key(variant, rules)
            lines = mark(variant, texts)
            record = {**variant.record, "lang": variant.lang}
            written = tuple(part for part, text in texts.items() if text.strip())
            found.append(
                Graded(visit.launch.name, variant.exercise.name, variant.seed, dict(lines), written, record)
            )
        return found


#: Pages of who sees the class.
_OF_CLASS = ("", "answers.csv", "issued.json")


def counted_try(tries: Sequence[Try], wanted: Wanted) -> Try | None:
    """Return the attempt of one person that counts: the best, the latest of equal ones, or the last."""
    if not tries:
        return None
    return max(tries, key=lambda one: (one.points, one.number)) if wanted.counts == BEST else tries[-1]


def _members(visit: Visit, lang: str) -> tuple[Any, str]:
    """Return the roster, and the sentence to show if there is none."""
    said = words(lang)["lti"]["class"]
    if visit.roster is None:
        return None, said["no_roster"].format(said["roster_off"])
    try:
        return visit.roster(), ""
    except NotServed as fault:
        return None, said["no_roster"].format(fault)


def _box(part: str, place: int, alone: bool) -> str:
    """Return the name of a part's input field on the page."""
    return part if alone else f"e{place}-{part}"


def _filled(answers: Sequence[Mapping[str, str]], alone: bool) -> dict[str, list[str]]:
    """Return the values of the input fields: each tick of a multiple choice, and the whole text for a text
    field."""
    return {
        _box(part, place, alone): [text, *text.split(", ")] if ", " in text else [text]
        for place, one in enumerate(answers, 1)
        for part, text in one.items()
        if text
    }


def _number(form: Form) -> int:
    text = next(iter(form.get("_number", ())), "")
    if not text.isdecimal() or len(text) > 6:
        raise Refused("answer", 400, "no number of a try")
    return int(text)


def _number_text(number: float, lang: str) -> str:
    return localise(plain(round(number, 3)), lang)


def _file(name: str, kind: str, data: bytes) -> Reply:
    return Reply(file=name, kind=kind, data=data)
