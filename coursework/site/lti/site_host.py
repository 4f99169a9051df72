"""Host of the LTI service on the site: a link opens a published assignment of the database, or an exercise
for practice.

A student answers a paper, which is submitted and marked as on the site; an instructor sees the class. An
exercise is served by the package's own host, whose papers and attempts are separate from those of the site.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from sqlalchemy import Connection

from coursework.database.assignments import issued_of
from coursework.database.publication import Phase, published, student_assignments
from coursework.database.submissions import rows_of
from coursework.errors import BadInput
from coursework.gradebook.rows import AnswerRow
from coursework.issuing.students import folded
from coursework.language.words import words
from coursework.lti.class_list import students
from coursework.lti.course_host import CourseHost
from coursework.lti.host import Form, LTIRequest, LTIResponse, Offer, OfferGroup
from coursework.lti.launch import Launch
from coursework.lti.link_settings import LinkSettings
from coursework.lti.pages import LTIPages, SheetForm
from coursework.lti.refusal import LTIRefusal
from coursework.lti.roles import Role
from coursework.lti.services import Member, NotServed
from coursework.lti.storage import Score, Storage
from coursework.messages import as_message
from coursework.site.desk.class_cache import assignment_title, class_now
from coursework.site.frame.arrivals import arrived
from coursework.site.frame.requests import FormData, HTTPException, Person
from coursework.site.frame.requests import Request as SiteRequest
from coursework.site.frame.settings import Site
from coursework.site.frame.times import exact_text, moment_text
from coursework.site.lti import launch_persons
from coursework.site.lti.class_in_frame import class_rows, rules_rows
from coursework.site.lti.scores import assignment_number, score_of
from coursework.site.papers.assignment_state import AssignmentState, state_and_paper
from coursework.site.papers.assignments import feedback_from
from coursework.site.papers.feedback import feedback_of
from coursework.site.papers.pending_marking import pending_marking
from coursework.site.papers.student_paper import StudentPaper, read_lines
from coursework.site.papers.submission import submit
from coursework.site.publication.publishing import listed_assignments

FROM_A_PLATFORM = "site: from a platform"
_BEST = "best"


class SiteHost:
    """Host of the LTI service that shows the content of a site."""

    def __init__(self, site: Site, storage: Storage):
        self._site, self._storage = site, storage
        self._practice: CourseHost | None = None

    @property
    def languages(self) -> tuple[str, ...]:
        return self._site.languages

    @property
    def practice(self) -> CourseHost:
        """Host for links that open an exercise."""
        if self._practice is None or self._practice.course is not self._site.course:
            self._practice = CourseHost(
                self._site.course, self._storage, clock=lambda: self._site.clock().timestamp()
            )
        return self._practice

    @property
    def pages(self) -> LTIPages:
        return LTIPages(self._site.course.folder)

    # -------------------------------------------------------------------- offers

    def offer_groups(self, lang: str) -> Sequence[OfferGroup]:
        """Return the published assignments, then the exercises by chapter."""
        with self._site.store.reading() as connection:
            assignments = [
                assignment
                for assignment in listed_assignments(connection)
                if assignment.publication is not None
            ]
            offers = [
                Offer(
                    f"assignment:{assignment.name}", assignment.title(lang), _worth(connection, assignment.id),
                    " ".join([assignment.name, *(assignment.stated.get("title") or {}).values()]),
                )
                for assignment in assignments
            ]  # fmt: skip
        site_groups = [OfferGroup(words(lang, "site")["lti"]["shelf"], tuple(offers))] if offers else []
        return [*site_groups, *self.practice.offer_groups(lang)]

    # ---------------------------------------------------------------------- pages

    def show(self, visit: LTIRequest) -> LTIResponse:
        if not LinkSettings.of(visit.launch.custom).assignment:
            return self.practice.show(visit)
        return self._answered(visit, lambda number: self._student_page(visit, number))

    def take(self, visit: LTIRequest, form: Form) -> LTIResponse:
        if not LinkSettings.of(visit.launch.custom).assignment:
            return self.practice.take(visit, form)
        return self._answered(visit, lambda number: self._submit(visit, number, form))

    def score(self, visit: LTIRequest) -> Score | None:
        try:
            wanted = LinkSettings.of(visit.launch.custom)
        except LTIRefusal:
            return None
        return score_of(self._site, visit.launch) if wanted.assignment else self.practice.score(visit)

    def _answered(self, visit: LTIRequest, work: Callable[[int], LTIResponse]) -> LTIResponse:
        """Return the response for the assignment of a link; a refusal of the site becomes a page."""
        if visit.launch.role is not Role.STUDENT and not visit.launch.role.sees_class:
            raise LTIRefusal("nobody", 403, f"role {visit.launch.role}")
        number = assignment_number(self._site, visit.launch)
        if number is None:
            raise LTIRefusal("unknown_choice", 404, "no such assignment")
        try:
            return work(number)
        except HTTPException as why:
            return self._refused(visit, why)
        except BadInput as fault:
            return self._refused(visit, HTTPException("mistaken", 422, as_message(fault)))

    def _refused(self, visit: LTIRequest, why: HTTPException) -> LTIResponse:
        texts = words(visit.lang, "site")
        sentence = texts["lti"]["refused"].get(why.sentence) or texts["refused"][why.sentence]
        names = {
            "title": texts["refused"]["title"], "message": str(sentence).format(*why.parts), "again": "", "action": "",
            "targets": "", "back": "",
        }  # fmt: skip
        if why.sentence == "connect":
            names |= {"connect": str(why.parts[0]), "connect_word": texts["connect"]["title"]}
        return LTIResponse(self.pages.page("platform/lti_message", visit.lang, names), why.status_code)

    def _student_page(self, visit: LTIRequest, number: int) -> LTIResponse:
        if visit.launch.role is not Role.STUDENT:
            return self._class(visit, number)
        if visit.path:
            raise LTIRefusal("page", 404, "a student")
        site_request = self._site_request(visit, number, FormData())
        state, paper = state_and_paper(site_request)
        if state.done and not ("again" in visit.query and state.may_hand_in):
            return self._after_submission(visit, site_request, state, paper)
        if not state.may_hand_in:
            raise HTTPException("closed", 409)
        texts = self._handed_in(state, paper) if state.done else {}
        return LTIResponse(self._sheet(visit, state, paper, texts))

    # ------------------------------------------------------------------- a student

    def _site_request(self, visit: LTIRequest, number: int, form: FormData) -> SiteRequest:
        """Return the site's request of the launch's person, after a paper has been assigned to them.

        Raises
        ------
        HTTPException
            The assignment is not published, not open, or cannot be assigned.
        """
        site, launch = self._site, visit.launch
        with site.store.reading() as connection:
            if published(connection, number) is None:
                raise HTTPException("own", 404)
        row = launch_persons.launch_person(site, launch, visit.lang)
        self._assign(visit, number, row)
        person = Person(row.id, row.name, "student", visit.lang)
        return SiteRequest(
            site,
            person,
            visit.lang,
            arrived(site.clock),
            visit.home,
            {"number": number},
            form=form,
            is_post=bool(form.texts),
        )

    def _assign(self, visit: LTIRequest, number: int, person: Any) -> None:
        with self._site.store.reading() as connection:
            publication = published(connection, number)
            if publication is None or student_assignments(connection, person.id, number):
                return
        phase = publication.phase(publication.now(self._site.clock()))
        if phase is Phase.TO_COME:
            raise HTTPException(
                "not_yet", 409, moment_text(publication.opens, visit.lang) if publication.opens else ""
            )
        if not phase.takes:
            raise HTTPException("closed", 409)
        launch_persons.assign_paper(self._site, number, person, visit.launch, visit.lang)

    def _sheet(
        self, visit: LTIRequest, state: AssignmentState, paper: StudentPaper, texts: Mapping[str, str], *, notes: Sequence[str] = (),
        unread: Sequence[str] = (),
    ) -> str:  # fmt: skip
        filled = {
            name: [text, *text.split(", ")] if ", " in text else [text]
            for name, text in texts.items()
            if text
        }
        more = [(visit.home, words(visit.lang)["lti"]["see_again"])] if state.done else []
        form = SheetForm(
            visit.home, visit.csrf_token, len(state.done) + 1, filled, (*notes, *self._rules(visit, state)), tuple(unread),
            bool(unread), tuple(more), visit.launch.return_url,
        )  # fmt: skip
        return self.pages.sheet(paper.paper, form, alone=False)

    def _handed_in(self, state: AssignmentState, paper: StudentPaper) -> dict[str, str]:
        """Return the last submission, by box."""
        with self._site.store.reading() as connection:
            rows = [
                row
                for row in rows_of(connection, state.assignment.id, state.done[-1].id)
                if isinstance(row, AnswerRow)
            ]
        answers = {(row.exercise, row.seed, row.part): str(row.answer or "") for row in rows}
        return {
            name: answers.get((box.variant.exercise.name, str(box.variant.seed), box.part.id), "")
            for name, box in paper.boxes.items()
        }

    def _rules(self, visit: LTIRequest, state: AssignmentState) -> list[str]:
        """Return the rules of the assignment: closing time, remaining attempts, and the attempt that
        counts."""
        texts, site_texts = words(visit.lang)["lti"], words(visit.lang, "site")["lti"]
        rules = []
        if state.phase is Phase.OPEN and state.assignment.own_publication.closes:
            rules.append(
                str(site_texts["open_until"]).format(state.moment(state.assignment.own_publication.closes))
            )
        elif state.phase is Phase.LATE:
            rules.append(str(site_texts["late_now"]))
        left = state.tries_left
        if left is None:
            rules.append(str(texts["tries_free"]))
        elif state.phase.takes:
            is_one = left < 2 if words(visit.lang)["numbers"]["one_below_two"] else left == 1
            rules.append(
                str(texts["tries_left"]["one" if is_one else "many"]).format(left)
                if left
                else texts["no_try_left"]
            )
        if state.assignment.own_publication.tries != 1:
            counts = state.assignment.stated.get("sittings", _BEST)
            rules.append(str(texts["counts_best" if counts == _BEST else "counts_last"]))
        return [" ".join(rules)]

    def _after_submission(
        self, visit: LTIRequest, site_request: SiteRequest, state: AssignmentState, paper: StudentPaper
    ) -> LTIResponse:
        """Return the feedback on the last submission if it is released; otherwise a confirmation."""
        texts, last = words(visit.lang)["lti"], state.done[-1]
        arrival = texts["try_number"].format(last.number, exact_text(last.received_at, visit.lang))
        receipt = site_request.words["lti"]["receipt"].format(last.receipt)
        more = [(f"{visit.home}?again=1", texts["again"])] if state.may_hand_in else []
        waits = pending_marking(site_request, last.id) if state.releases("feedback") else None
        if state.releases("feedback") and waits is None:
            document, notes = feedback_of(site_request, state, paper, last)
            notes = [f"{arrival}. {receipt}", *notes, *self._rules(visit, state), self._sent(visit)]
            form = SheetForm("", "", notes=tuple(notes), more=tuple(more), leave=visit.launch.return_url)
            return LTIResponse(self.pages.feedback(document, form, alone=False))
        notes = [
            f"{arrival}.",
            receipt,
            waits.message if waits else feedback_from(site_request, state),
            *self._rules(visit, state),
            self._sent(visit, state),
        ]
        names = {
            "title": state.title, "notes": [note for note in notes if note], "more": more, "leave": visit.launch.return_url,
            "handed_in": site_request.words["lti"]["handed_in"],
        }  # fmt: skip
        return LTIResponse(self.pages.page("platform/lti_site_handed_in", visit.lang, names))

    def _sent(self, visit: LTIRequest, state: AssignmentState | None = None) -> str:
        """Return the state of the score on its way to the platform."""
        texts, launch = words(visit.lang)["lti"], visit.launch
        if not (launch.line or launch.lines):
            return str(texts["score_none"])
        waiting = visit.scores().get(launch.person)
        if waiting is None and state is not None:
            kept_back = (
                "score_never" if state.assignment.own_publication.feedback == "never" else "score_later"
            )
            return str(words(visit.lang, "site")["lti"][kept_back])
        return str(texts["score_sent" if waiting is not None and waiting.due is None else "score_waits"])

    def _submit(self, visit: LTIRequest, number: int, form: Form) -> LTIResponse:
        """Submit the answers of a form; a repeated form has no effect."""
        if visit.launch.role is not Role.STUDENT or visit.path:
            raise LTIRefusal("page", 404, "nothing is handed in there")
        site_request = self._site_request(visit, number, FormData(form))
        state, paper = state_and_paper(site_request)
        texts, attempt = paper.texts(site_request.form), _number(form)
        if attempt <= len(state.done):
            return LTIResponse(goto=visit.home)  # repeated form
        if not any(text.strip() for text in texts.values()):
            empty = words(visit.lang)["lti"]["empty"]
            return LTIResponse(self._sheet(visit, state, paper, texts, notes=[empty]), 422)
        unread = _unread(visit, paper, texts)
        if unread and not form.get("_as_it_is"):
            return LTIResponse(self._sheet(visit, state, paper, texts, unread=unread), 422)
        submit(
            self._site,
            state.assignment,
            paper,
            site_request.user.id,
            texts,
            attempt,
            site_request.received_at,
            FROM_A_PLATFORM,
        )
        return LTIResponse(goto=visit.home)

    # ------------------------------------------------------------------------ class

    def _opened_by_course(self, launch: Launch) -> set[str]:
        """Return the platform identifiers of the people who opened the assignment from the launch's
        course."""
        named = LinkSettings.of(launch.custom).assignment
        opened = (other for other in self._storage.opened() if other.course == launch.course)
        return {other.person for other in opened if other.custom.get("assignment", "").strip() == named}

    def _class(self, visit: LTIRequest, number: int) -> LTIResponse:
        """Return the class table, read-only; decisions are made on the site, with an account there."""
        if visit.path:
            raise LTIRefusal("page", 404, "no such page")
        now, lang = class_now(self._site, number), visit.lang
        members, note = _members(visit, lang)
        with self._site.store.reading() as connection:
            publication = published(connection, number)
            rows = class_rows(connection, self._site, now, visit, self._opened_by_course(visit.launch))
        missing = _not_there(members, {folded(row.name) for row in rows}, {row.person for row in rows})
        names = {
            "title": visit.launch.link_title or assignment_title(now.about, lang), "context": visit.launch.context_title, "home": visit.home,
            "desk": f"{self._site.url}/desk/{number}", "rules": rules_rows(visit, now, publication), "rows": rows, "missing": missing,
            "roster_note": note, "has_roster": members is not None, "own": words(lang, "site")["lti"]["class"],
        }  # fmt: skip
        return LTIResponse(self.pages.page("platform/lti_site_class", lang, names))


def _worth(connection: Connection, number: int) -> float:
    """Return the points of an assignment: those of the first issued paper."""
    issued = issued_of(connection, number)
    student = next(iter(issued.students), "")
    seeds = issued.issued_to(student) if student else {}
    records = [issued.record_of(student, exercise, seed) for exercise, seed in seeds.items()]
    return sum(float(part["points"]) for record in records for part in record["parts"]) or 1.0


def _unread(visit: LTIRequest, paper: StudentPaper, texts: Mapping[str, str]) -> list[str]:
    """Return a sentence for each answer that could not be read."""
    form = str(words(visit.lang)["lti"]["unread_line"])
    return [
        form.format(box.number, reading.message)
        for box, _, reading in read_lines(paper, texts)
        if reading.is_in_doubt
    ]


def _number(form: Form) -> int:
    text = next(iter(form.get("_number", ())), "")
    if not text.isdecimal() or not 1 <= len(text) <= 6 or int(text) < 1:
        raise LTIRefusal("answer", 400, "no number of a try")
    return int(text)


def _members(visit: LTIRequest, lang: str) -> tuple[Sequence[Member] | None, str]:
    """Return the platform's roster, and the sentence to show if there is none."""
    texts = words(lang)["lti"]["class"]
    if visit.roster is None:
        return None, texts["no_roster"].format(texts["roster_off"])
    try:
        return visit.roster(), ""
    except NotServed as fault:
        return None, texts["no_roster"].format(fault)


def _not_there(members: Sequence[Member] | None, names: set[str], persons: set[str]) -> list[str]:
    """Return the students of the platform who have no paper yet."""
    return sorted(
        (member.name or member.person for member in students(members or ()) if member.person not in persons and folded(member.name) not in names),
        key=folded,
    )  # fmt: skip
