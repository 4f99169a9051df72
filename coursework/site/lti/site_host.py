"""Pages of links on a platform: a paper of an assignment of the site, or of an exercise.

A student answers a paper, which is submitted and marked as on the site; an instructor sees the class, and the
paper as a student sees it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from starlette.responses import HTMLResponse, RedirectResponse, Response

from coursework.database.assignments import issued_of
from coursework.database.drafts import DraftChange, drafts, save
from coursework.database.instructor_queries import listed_assignments
from coursework.database.people import lock_person
from coursework.database.publication import Phase, Publication, published, student_assignments
from coursework.database.submissions import rows_of
from coursework.errors import BadInput
from coursework.gradebook.class_marking import judged
from coursework.gradebook.feedback_sheets import feedback_paper
from coursework.gradebook.placing import placed_sheets
from coursework.gradebook.rows import AnswerRow
from coursework.issuing.assignment import Assignment, text_in
from coursework.issuing.students import folded
from coursework.language.words import words
from coursework.messages import as_message, localised, number_form
from coursework.platforms.lti.class_list import students
from coursework.platforms.lti.launch import Launch
from coursework.platforms.lti.refusal import LTIRefusal
from coursework.platforms.lti.roles import Role
from coursework.platforms.lti.services import SCORE, Member, NotServed
from coursework.platforms.lti.storage import Storage
from coursework.site.desk.class_cache import class_now
from coursework.site.frame.requests import FormData, HTTPException, Person
from coursework.site.frame.requests import Request as SiteRequest
from coursework.site.frame.settings import Site
from coursework.site.frame.times import exact_text, moment_text
from coursework.site.lti import launch_persons
from coursework.site.lti.class_in_frame import LaunchClassRow, class_rows, rules_rows
from coursework.site.lti.launch_request import LTIRequest
from coursework.site.lti.linked_assignment import LinkedAssignment, follow_link, linked_assignment
from coursework.site.lti.pages import LTIPages, SheetForm
from coursework.site.lti.scores import score_of
from coursework.site.papers.assignment_state import AssignmentState, NotStarted, state_and_paper
from coursework.site.papers.assignments import feedback_from
from coursework.site.papers.feedback import feedback_of
from coursework.site.papers.receipts import pending_marking
from coursework.site.papers.starting import record_start, start_names
from coursework.site.papers.student_paper import StudentPaper, read_lines
from coursework.site.papers.submission import mark, rows_for, sheet_of, submit
from coursework.site.publication.publishing import definition_of, preview_paper

FROM_A_PLATFORM = "site: from a platform"
_BEST = "best"
#: Waiting submissions up to which that of an exercise is marked when its page is opened, before the worker
#: does.
_FEW = 4


class SiteHost:
    """Pages of links, with the content of a site."""

    def __init__(self, site: Site, storage: Storage, wake: Callable[[], None]):
        self._site, self._storage, self._wake = site, storage, wake

    @property
    def pages(self) -> LTIPages:
        return LTIPages(self._site.course.folder)

    # ---------------------------------------------------------------------- pages

    def answer(self, request: LTIRequest, form: FormData | None = None) -> Response:
        """Return the page of a link, or the response to a ``form`` of it, which may be sent twice; a refusal
        of the site becomes a page.

        Raises
        ------
        LTIRefusal
            The person may not see it, or there is none.
        """
        role = request.launch.role
        if role is not Role.STUDENT and not role.sees_class:
            raise LTIRefusal("nobody", 403, f"role {role}")
        linked = linked_assignment(self._site, request.launch)
        try:
            if role is not Role.STUDENT and request.path == "sheet":
                return self._preview(request, linked, form)
            if request.path or (form is not None and role is not Role.STUDENT):
                raise LTIRefusal("page", 404, "no such page")
            if role is not Role.STUDENT:
                return self._class(request, linked)
            return (
                self._student_page(request, linked) if form is None else self._submit(request, linked, form)
            )
        except HTTPException as why:
            return self._refused(request, why)
        except BadInput as fault:
            return self._refused(request, HTTPException("mistaken", 422, as_message(fault)))

    def _refused(self, request: LTIRequest, why: HTTPException) -> Response:
        texts = words(request.lang, "site")
        sentence = texts["lti"]["refused"].get(why.sentence) or texts["refused"][why.sentence]
        names = {
            "title": texts["refused"]["title"],
            "message": str(sentence).format(*why.parts),
            "again": "",
            "action": "",
            "targets": "",
            "back": "",
        }
        if why.sentence == "connect":
            names |= {"connect": str(why.parts[0]), "connect_word": texts["connect"]["title"]}
        return HTMLResponse(self.pages.page("platform/lti_message", request.lang, names), why.status_code)

    def _student_page(self, request: LTIRequest, linked: LinkedAssignment) -> Response:
        site_request = self._site_request(request, linked, FormData())
        try:
            state, paper = state_and_paper(site_request)
        except NotStarted as why:
            return self._start_page(request, start_names(site_request, why.assignment))
        if state.done and not ("again" in request.query and state.may_hand_in):
            return self._after_submission(request, site_request, linked, state, paper)
        if not state.may_hand_in:
            raise HTTPException("closed", 409)
        texts = self._handed_in(state, paper) if state.done else {}
        if state.done and paper.drawn:
            with self._site.store.reading() as connection:
                kept = drafts(connection, site_request.user.id, sheet_of(state.assignment, paper))
            texts |= {name: kept[name].text for name in paper.drawn if name in kept}
        return HTMLResponse(self._sheet(request, state, paper, texts))

    def _start_page(self, request: LTIRequest, names: Mapping[str, Any]) -> Response:
        """Return the page that starts the working time of a paper."""
        texts = words(request.lang, "site")
        more = {
            "own": texts["assignments"],
            "start_counts": texts["lti"]["start_counts"],
            "token": request.csrf_token,
        }
        html = self.pages.page("platform/lti_start", request.lang, {**names, **more, "action": request.home})
        return HTMLResponse(html)

    # ------------------------------------------------------------------- a student

    def _site_request(self, request: LTIRequest, linked: LinkedAssignment, form: FormData) -> SiteRequest:
        """Return the site's request of the launch's person, after a paper has been assigned to them. Raises
        HTTPException: the assignment is not published, not open, or cannot be assigned."""
        site, launch = self._site, request.launch
        publication: Publication | None = None
        if linked.number is not None:
            with site.store.reading() as connection:
                publication = published(connection, linked.number)
            if publication is None:
                raise HTTPException("own", 404)
            follow_link(site, linked, publication, launch)
        row = launch_persons.launch_person(site, launch, request.lang)
        number = self._assigned(request, linked, publication, row)
        if self._storage.record(launch, row.id, number):
            self._queue_score(launch, row.id, number)
        person = Person(row.id, row.name, "student", request.lang)
        return SiteRequest.of_person(site, person, request.lang, request.home, {"number": number}, form)

    def _assigned(
        self, request: LTIRequest, linked: LinkedAssignment, publication: Publication | None, person: Any
    ) -> int:
        """Return the assignment's id, after a paper was assigned to the person, if they have none."""
        if linked.number is not None and publication is not None:
            with self._site.store.reading() as connection:
                if student_assignments(connection, person.id, linked.number):
                    return linked.number
            phase = publication.phase(publication.now(self._site.clock()))
            if phase is Phase.TO_COME:
                opens = moment_text(publication.opens, request.lang) if publication.opens else ""
                raise HTTPException("not_yet", 409, opens)
            if not phase.takes:
                raise HTTPException("closed", 409)
        return launch_persons.assign_paper(self._site, linked, person, request.launch, request.lang)

    def _queue_score(self, launch: Launch, person_id: int, number: int) -> None:
        """Queue the person's score for the platform if it has changed."""
        if SCORE not in launch.scopes or not (launch.line or launch.lines):
            return
        score = score_of(self._site, launch, number, person_id)
        if score is not None and self._storage.put_score(launch, person_id, score):
            self._wake()

    def _sheet(
        self,
        request: LTIRequest,
        state: AssignmentState,
        paper: StudentPaper,
        texts: Mapping[str, str],
        *,
        notes: Sequence[str] = (),
        unread: Sequence[str] = (),
    ) -> str:
        more = [(request.home, words(request.lang)["lti"]["see_again"])] if state.done else []
        form = SheetForm(
            request.home,
            request.csrf_token,
            len(state.done) + 1,
            _filled(texts),
            (*notes, *self._rules(request, state)),
            tuple(unread),
            bool(unread),
            tuple(more),
            request.launch.return_url,
        )
        return self.pages.sheet(paper.paper, form)

    def _handed_in(self, state: AssignmentState, paper: StudentPaper) -> dict[str, str]:
        """Return the last submission, by box."""
        with self._site.store.reading() as connection:
            rows = [
                row
                for row in rows_of(connection, state.assignment.id, state.done[-1].id)
                if isinstance(row, AnswerRow)
            ]
        return paper.texts_of({(row.exercise, row.seed, row.part): str(row.answer or "") for row in rows})

    def _rules(self, request: LTIRequest, state: AssignmentState) -> list[str]:
        """Return the rules of the assignment: closing time, remaining attempts, and the attempt that
        counts."""
        texts, site_texts = words(request.lang)["lti"], words(request.lang, "site")["lti"]
        rules = []
        if state.phase is Phase.OPEN and state.assignment.own_publication.closes:
            rules.append(
                str(site_texts["open_until"]).format(
                    moment_text(state.assignment.own_publication.closes, request.lang)
                )
            )
        elif state.phase is Phase.LATE:
            rules.append(str(site_texts["late_now"]))
        left = state.tries_left
        if left is None:
            rules.append(str(texts["tries_free"]))
        elif state.phase.takes:
            rules.append(
                str(texts["tries_left"][number_form(left, request.lang)]).format(left)
                if left
                else texts["no_try_left"]
            )
        if state.assignment.own_publication.tries != 1:
            counts = state.assignment.stated.get("sittings", _BEST)
            rules.append(str(texts["counts_best" if counts == _BEST else "counts_last"]))
        return [" ".join(rules)]

    def _after_submission(
        self,
        request: LTIRequest,
        site_request: SiteRequest,
        linked: LinkedAssignment,
        state: AssignmentState,
        paper: StudentPaper,
    ) -> Response:
        """Return the feedback on the last submission if it is released; otherwise a confirmation."""
        texts, last = words(request.lang)["lti"], state.done[-1]
        arrival = texts["try_number"].format(last.number, exact_text(last.received_at, request.lang))
        receipt = site_request.words["lti"]["receipt"].format(last.receipt)
        more = [(f"{request.home}?again=1", texts["again"])] if state.may_hand_in else []
        waits = pending_marking(site_request, last.id) if state.releases("feedback") else None
        if (
            linked.link and waits and waits.seconds and waits.ahead < _FEW
        ):  # its feedback is what an exercise is for
            mark(self._site, last.id, at_once=True)
            self._queue_score(request.launch, site_request.user.id, state.assignment.id)
            waits = pending_marking(site_request, last.id)
        if state.releases("feedback") and waits is None:
            document, notes = feedback_of(site_request, state, paper, last)
            notes = [f"{arrival}. {receipt}", *notes, *self._rules(request, state), self._sent(request)]
            form = SheetForm("", "", notes=tuple(notes), more=tuple(more), leave=request.launch.return_url)
            return HTMLResponse(self.pages.feedback(document, form))
        notes = [
            f"{arrival}.",
            receipt,
            waits.message if waits else feedback_from(site_request, state),
            *self._rules(request, state),
            self._sent(request, state),
        ]
        names = {
            "title": state.title,
            "notes": [note for note in notes if note],
            "more": more,
            "leave": request.launch.return_url,
            "handed_in": site_request.words["lti"]["handed_in"],
        }
        reloads = {"refresh": str(waits.seconds)} if waits and waits.seconds else None
        html = self.pages.page("platform/lti_handed_in", request.lang, names)
        return HTMLResponse(html, headers=reloads)

    def _sent(self, request: LTIRequest, state: AssignmentState | None = None) -> str:
        """Return the state of the score on its way to the platform."""
        texts, launch = words(request.lang)["lti"], request.launch
        if not (launch.line or launch.lines):
            return str(texts["score_none"])
        waiting = request.scores().get(launch.person)
        if waiting is None and state is not None:
            kept_back = (
                "score_never" if state.assignment.own_publication.feedback == "never" else "score_later"
            )
            return str(words(request.lang, "site")["lti"][kept_back])
        return str(texts["score_sent" if waiting is not None and waiting.due is None else "score_waits"])

    def _submit(self, request: LTIRequest, linked: LinkedAssignment, form: FormData) -> Response:
        """Submit the answers of a form; a repeated form has no effect."""
        site_request = self._site_request(request, linked, form)
        if form.text("_start"):
            record_start(site_request)
            return RedirectResponse(request.home, 303)
        state, paper = state_and_paper(site_request)
        texts, attempt = paper.texts(site_request.form), _number(form)
        if attempt <= len(state.done):
            return RedirectResponse(request.home, 303)  # repeated form
        drawings = paper.drawing_texts(site_request.form)
        back = self._doubts(request, paper, texts, form)
        if back:
            return HTMLResponse(self._sheet(request, state, paper, texts | drawings, **back), 422)
        self._save_drawings(site_request, state, paper, drawings)
        number, person_id = state.assignment.id, site_request.user.id
        received_at = site_request.received_at
        submit(self._site, state.assignment, paper, person_id, texts, attempt, received_at, FROM_A_PLATFORM)
        self._queue_score(request.launch, person_id, number)
        return RedirectResponse(request.home, 303)

    def _save_drawings(
        self, request: SiteRequest, state: AssignmentState, paper: StudentPaper, drawings: Mapping[str, str]
    ) -> None:
        """Store what was drawn as drafts, from which a submission takes it."""
        if not drawings or not state.may_hand_in:
            return
        person_id, sheet = request.user.id, sheet_of(state.assignment, paper)
        with self._site.store.begin() as connection:
            lock_person(connection, person_id)
            stored = drafts(connection, person_id, sheet)
            sent = {
                name: DraftChange(text, stored[name].version if name in stored else 0)
                for name, text in drawings.items()
            }
            save(connection, person_id, sheet, sent, request.received_at, stored)

    def _doubts(
        self, request: LTIRequest, paper: StudentPaper, texts: Mapping[str, str], form: FormData
    ) -> dict[str, list[str]]:
        """Return what to tell instead of accepting a form: that it is empty, or which answers cannot be
        read, unless the person insists."""
        if not any(text.strip() for text in texts.values()):
            return {"notes": [words(request.lang)["lti"]["empty"]]}
        unread = _unread(request, paper, texts)
        return {"unread": unread} if unread and not form.text("_as_it_is") else {}

    # ------------------------------------------------------------------------ staff

    def _class(self, request: LTIRequest, linked: LinkedAssignment) -> Response:
        """Return the class table, read-only; decisions are made on the site, with an account there."""
        lang, stated = request.lang, linked.table
        publication: Publication | None = linked.publication
        rows: list[LaunchClassRow] = []
        members, note = _members(request, lang)
        if linked.number is None:
            title = text_in(stated["title"], lang)
        else:
            now = class_now(self._site, linked.number)
            stated, title = now.about.stated, now.about.title(lang)
            opened = self._storage.opened(linked.number)
            here = {other.person for *_, other in opened if other.course == request.launch.course}
            with self._site.store.reading() as connection:
                publication = published(connection, linked.number)
                rows = class_rows(connection, self._site, now, request, here)
        missing = _not_there(members, {folded(row.name) for row in rows}, {row.person for row in rows})
        names = {
            "title": request.launch.link_title or title,
            "context": request.launch.context_title,
            "home": request.home,
            "desk": "" if linked.number is None else f"{self._site.url}/desk/{linked.number}",
            "rules": rules_rows(request, stated.get("sittings", _BEST), publication),
            "rows": rows,
            "missing": missing,
            "roster_note": note,
            "has_roster": members is not None,
            "own": words(lang, "site")["lti"]["class"],
        }
        return HTMLResponse(self.pages.page("platform/lti_class", lang, names))

    def _preview(self, request: LTIRequest, linked: LinkedAssignment, form: FormData | None) -> Response:
        """Return the paper as a student sees it, with variants that are issued to nobody, or the marks of a
        ``form``, which is not stored."""
        site, texts = self._site, words(request.lang)["lti"]
        paper = preview_paper(site, replace(self._definition(linked), answers="never"), request.lang)
        home, sheet, notes = request.home, f"{request.home}/sheet", (texts["preview"],)
        links = ((home, texts["to_class"]),)
        if form is None:
            form_names = SheetForm(sheet, request.csrf_token, notes=notes, more=links)
            return HTMLResponse(self.pages.sheet(paper.paper, form_names))
        typed = paper.texts(form)
        if back := self._doubts(request, paper, typed, form):
            again = SheetForm(
                sheet,
                request.csrf_token,
                filled=_filled(typed),
                notes=(*notes, *back.get("notes", ())),
                unread=tuple(back.get("unread", ())),
                may_insist="unread" in back,
                more=links,
            )
            return HTMLResponse(self.pages.sheet(paper.paper, again), 422)
        rows = rows_for(paper, typed, 1, site.clock(), FROM_A_PLATFORM)
        sheets = placed_sheets(site.course, paper.issued, rows)
        graded = [
            sheet for _, sheet in judged(site.course, paper.issued, sheets) if not isinstance(sheet, str)
        ]
        document = feedback_paper(site.course, paper.issued, paper.student, graded, request.lang)
        shown = SheetForm("", "", notes=notes, more=((sheet, texts["again"]), *links))
        return HTMLResponse(self.pages.feedback(document, shown))

    def _definition(self, linked: LinkedAssignment) -> Assignment:
        if linked.link:
            return linked.definition(self._site.course)
        assert linked.number is not None
        with self._site.store.reading() as connection:
            (listed,) = listed_assignments(connection, linked.number)
            return definition_of(self._site.course, listed, issued_of(connection, linked.number))


def _filled(texts: Mapping[str, str]) -> dict[str, list[str]]:
    """Return the values of the input fields: each tick of a multiple choice, and the whole text for a text
    field."""
    return {
        name: [text, *text.split(", ")] if ", " in text else [text] for name, text in texts.items() if text
    }


def _unread(request: LTIRequest, paper: StudentPaper, texts: Mapping[str, str]) -> list[str]:
    """Return a sentence for each answer that could not be read."""
    form = str(words(request.lang)["lti"]["unread_line"])
    return [
        form.format(box.number, reading.message)
        for box, _, reading in read_lines(paper, texts)
        if reading.is_in_doubt
    ]


def _number(form: FormData) -> int:
    text = form.text("_number")
    if not text.isdecimal() or not 1 <= len(text) <= 6 or int(text) < 1:
        raise LTIRefusal("answer", 400, "no number of a try")
    return int(text)


def _members(request: LTIRequest, lang: str) -> tuple[Sequence[Member] | None, str]:
    """Return the platform's roster, and the sentence to show if there is none."""
    texts = words(lang)["lti"]["class"]
    if request.roster is None:
        return None, texts["no_roster"].format(texts["roster_off"])
    try:
        return request.roster(), ""
    except NotServed as fault:
        return None, texts["no_roster"].format(localised(fault, lang))


def _not_there(members: Sequence[Member] | None, names: set[str], persons: set[str]) -> list[str]:
    """Return the students of the platform who have no paper yet."""
    return sorted(
        (
            member.name or member.person
            for member in students(members or ())
            if member.person not in persons and folded(member.name) not in names
        ),
        key=folded,
    )
