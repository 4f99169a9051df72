"""Publication, for staff: assignments, their students and dates, extensions, and previews as a student."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Any, NamedTuple

from markupsafe import Markup
from sqlalchemy import Connection, func, select
from starlette.responses import Response

from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.database.assignments import issued_content, issued_of, put_issued
from coursework.database.instructor_queries import AssignmentOverview, listed_assignments, people_counts
from coursework.database.permissions import Permission
from coursework.database.prepared import drop_prepared
from coursework.database.publication import (
    ANSWERS,
    FEEDBACK,
    LATE,
    MOST_MINUTES,
    MOST_TRIES,
    Extension,
    Fault,
    Phase,
    Publication,
    StudentAssignment,
    extend,
    extensions,
    publish,
    publish_anew,
    set_counting_attempt,
    starts,
    student_assignments,
)
from coursework.database.tables import audit, issue, submission, variant
from coursework.errors import BadInput, CourseworkError
from coursework.issuing.assignment import (
    MOST_VERSIONS,
    SITTINGS,
    AskedExercise,
    Assignment,
    assignment_of,
    text_in,
)
from coursework.issuing.exam_columns import minutes_of
from coursework.issuing.issued import Issued
from coursework.issuing.issued import issued_content as content_of
from coursework.issuing.roster import Student
from coursework.issuing.variant_assignment import assign_variants
from coursework.language.numbers import localise
from coursework.language.words import words
from coursework.rendering.renderer import renderer_of
from coursework.site.frame.budgets import DESK_FILE
from coursework.site.frame.jobs import DONE
from coursework.site.frame.paging import page_of
from coursework.site.frame.requests import FormData, HTTPException, Request, Route
from coursework.site.frame.responses import Download, redirect
from coursework.site.frame.settings import Site
from coursework.site.frame.times import (
    exact_text,
    field_text,
    from_field,
    length_text,
    moment_text,
    zone_name,
)
from coursework.site.papers.assignment_state import AssignmentState, state_of
from coursework.site.papers.opening import prepare_soon
from coursework.site.papers.student_paper import StudentPaper, student_paper
from coursework.site.people.extra_time import extra_time_text
from coursework.site.publication import assigning, new_assignment
from coursework.site.publication.assigning import AssignmentRequest

_NOTED = 30  #: audit lines on a page
_MOST_PAGES = 16  #: of a preview


def assignment_here(request: Request, connection: Connection) -> AssignmentOverview:
    matches = listed_assignments(connection, int(request.path_params["number"]))
    if not matches:
        raise HTTPException("page", 404)
    return matches[0]


# ------------------------------------------------------------------------- lists


def list_page(request: Request) -> Response:
    with request.site.store.reading() as connection:
        assignments, (students, handed_in) = listed_assignments(connection), people_counts(connection)
    phases = {item.id: _phase(item.publication, request.received_at) for item in assignments}
    return request.render(
        "site/instructor/publish_list",
        found=assignments,
        phases=phases,
        students=students,
        handed_in=handed_in,
    )


def _phase(publication: Publication | None, clock: datetime) -> str:
    return "hidden" if publication is None else publication.phase(publication.now(clock)).value


def new(request: Request) -> Response:
    """Create an assignment, from its file or chosen exercises and a roster, or from variants that ``build``
    issued."""
    if not request.is_post:
        request.form = new_assignment.proposed(request)
        return _new_page(request)
    if request.form.text("do") == "look":
        return _looked_at(request)
    try:
        form = new_assignment.read(request)
    except BadInput as fault:
        return _new_page(request, str(fault), 422)
    if form.issued is not None:
        return redirect(f"/desk/assignments/{_take_in(request, form)}")
    assert form.wanted is not None
    token = assigning.begin(request.site, form.wanted, request.user.name, "assignment dealt")
    return redirect(f"/desk/assignments/dealing/{token}")


class PagesPreview(NamedTuple):
    """Pages of an assignment that is not issued yet, with its file."""

    stated: new_assignment.StatedAssignment
    pages: tuple[str, ...]  #: as data URLs of images
    more: int  #: pages that are not shown
    points: str
    file: str  #: data URL of the file


def _looked_at(request: Request) -> Response:
    """Return the form with the parts of the chosen exercises, and the pages of the paper with variants that
    belong to nobody."""
    try:
        stated = new_assignment.stated_assignment(request)
        paper = preview_paper(request.site, stated.definition, request.lang)
        images = renderer_of(request.site.course.folder).images(paper.paper)
    except CourseworkError as fault:
        if isinstance(fault, HTTPException):
            raise
        return _new_page(request, str(fault), 422)
    pages = tuple(_data_url("image/png", image) for image in images[:_MOST_PAGES])
    points = sum(part.points for variant in paper.variants for part in variant.parts)
    look = PagesPreview(
        stated,
        pages,
        len(images) - len(pages),
        localise(f"{points:g}", request.lang),
        _data_url("application/toml", stated.source.encode("utf-8", "backslashreplace")),
    )
    return _new_page(request, look=look)


def _data_url(kind: str, data: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"


def _new_page(
    request: Request, problem: str = "", status: int = 200, look: PagesPreview | None = None
) -> Response:
    exercise_groups = new_assignment.exercise_groups(request.site.course, request.lang)
    return request.render(
        "site/instructor/publish_new",
        status,
        exercise_groups=exercise_groups,
        problem=problem,
        sent=request.form,
        most_versions=MOST_VERSIONS,
        accounts=len(new_assignment.students_with_accounts(request)),
        look=look,
        chosen=new_assignment.chosen_exercises(request),
    )


def _take_in(request: Request, new_one: new_assignment.NewAssignment) -> int:
    """Store an assignment that was issued elsewhere; return its id."""
    assert new_one.issued is not None
    with request.site.store.begin() as connection:
        number = put_issued(connection, new_one.issued, new_one.name)
        request.note(connection, "assignment taken in", assignment=new_one.name)
    return number


def assigning_page(request: Request) -> Response:
    """Return the state of a job; redirect to the assignment when it is done, unless there is a message."""
    job = assigning.assigning_job(request.site, str(request.path_params["token"]))
    if job is None:
        raise HTTPException("page", 404)
    if job.state == DONE and not job.messages:
        return redirect(f"/desk/assignments/{job.result}")
    return request.render("site/instructor/publish_dealing", dealing=job)


# ------------------------------------------------------------------- one assignment


def assignment_page(request: Request) -> Response:
    with request.site.store.reading() as connection:
        listed = assignment_here(request, connection)
    return _page(request, listed, listed.publication or _usual_publication(listed))


def _usual_publication(listed: AssignmentOverview) -> Publication:
    """Return the publication that the form proposes first: with the working time that the assignment
    states."""
    minutes = minutes_of(text_in(listed.stated.get("duration") or {}, ""))
    return Publication(minutes=minutes, takes_saved=minutes is not None)


def _page(
    request: Request,
    listed: AssignmentOverview,
    publication: Publication,
    faults: Sequence[Fault] = (),
    problem: str = "",
) -> Response:
    with request.site.store.reading() as connection:
        people = holders(connection, listed.id)
        more = extensions(connection, listed.id)
        times = _working_times(request, listed, more, starts(connection, listed.id))
        noted = _noted(connection, listed.name)
        students, handed_in = people_counts(connection)
    page = page_of(request, people, lambda holder: holder.student)
    return request.render(
        "site/instructor/publish",
        422 if faults or problem else 200,
        one=listed,
        students=students[listed.id],
        handed_in=handed_in[listed.id],
        said_now=publication,
        faults=faults,
        problem=problem,
        page=page,
        people=page.rows,
        has_versions=any(holder.letter for holder in people),
        is_issued=bool(people),
        extensions=more,
        noted=noted,
        phase=_phase(listed.publication, request.received_at),
        zone=zone_name(request.received_at),
        field=field_text,
        moment=lambda at: "" if at is None else moment_text(at, request.lang),
        exact=lambda at: exact_text(at, request.lang),
        late_rules=LATE,
        feedback_rules=FEEDBACK,
        answer_rules=ANSWERS,
        sittings=SITTINGS,
        sittings_now=listed.stated.get("sittings", SITTINGS[0]),
        most_tries=MOST_TRIES,
        most_minutes=MOST_MINUTES,
        times=times,
    )


class WorkingTime(NamedTuple):
    """Working time of a person, as the list shows it."""

    extra: str  #: share of extra time; empty for none
    allowed: str  #: empty if the assignment has no working time
    started: str
    ends: str


def _working_times(
    request: Request,
    listed: AssignmentOverview,
    more: Mapping[int, Extension],
    times: Mapping[int, tuple[float, datetime | None]],
) -> dict[int, WorkingTime]:
    """Return the working time of each person with extra time, or of everybody if the assignment has one."""
    publication, lang, found = listed.publication or Publication(), request.lang, {}
    for person, (extra, started) in times.items():
        own = publication.personal(more.get(person), extra, started)
        if not extra and own.minutes is None:
            continue
        found[person] = WorkingTime(
            extra_time_text(extra, lang),
            "" if own.minutes is None else length_text(timedelta(minutes=own.minutes), lang),
            exact_text(started, lang) if started else "",
            exact_text(own.closes, lang) if started and own.closes else "",
        )
    return found


class PaperHolder(NamedTuple):
    """Student to whom a paper was issued."""

    person: int
    student: str
    letter: str
    sittings: int
    lang: str  #: of the paper
    done: int  #: submissions on the site


def holders(connection: Connection, number: int) -> list[PaperHolder]:
    """Return the students with a paper, in the order of issue."""
    query = (
        select(
            issue.c.person_id,
            issue.c.student,
            func.max(variant.c.letter),
            func.max(issue.c.sitting),
            func.max(issue.c.lang),
            func.min(issue.c.place),
        )
        .select_from(issue.join(variant))
        .where(variant.c.assignment_id == number, issue.c.person_id.is_not(None))
        .group_by(issue.c.person_id, issue.c.student)
        .order_by(func.min(issue.c.place))
    )
    submitted = select(submission.c.person_id, func.count()).where(submission.c.assignment_id == number)
    done: dict[int, int] = dict(connection.execute(submitted.group_by(submission.c.person_id)).all())
    return [
        PaperHolder(row[0], row[1], row[2], row[3], row[4], done.get(row[0], 0))
        for row in connection.execute(query)
    ]


def _noted(connection: Connection, name: str) -> list[Any]:
    """Return the audit entries of an assignment, the latest first."""
    query = select(audit).order_by(audit.c.id.desc()).limit(500)
    entries = [row for row in connection.execute(query) if row.about.get("assignment") == name]
    return entries[:_NOTED]


def _note(
    request: Request, connection: Connection, listed: AssignmentOverview, event: str, **about: Any
) -> None:
    request.note(connection, event, assignment=listed.name, **about)


def _redirect(listed: AssignmentOverview) -> Response:
    return redirect(f"/desk/assignments/{listed.id}")


# --------------------------------------------------------------------- publishing


def publish_assignment(request: Request) -> Response:
    """Publish the assignment with the dates and rules of the form, or return the form with its faults."""
    with request.site.store.reading() as connection:
        listed = assignment_here(request, connection)
    publication, faults = publication_of(request.form)
    faults += publication.faults()
    sittings = request.form.text("sittings", SITTINGS[0])
    if sittings not in SITTINGS:
        faults.append(Fault("sittings", "choice"))
    if faults:
        return _page(request, listed, publication, faults)
    with request.site.store.begin() as connection:
        publish_anew(connection, listed.id, publication)
        set_counting_attempt(connection, listed.id, sittings)
        prepare_soon(request.site, connection, listed.id)
        _note(request, connection, listed, "assignment published", **publication.as_json(), sittings=sittings)
    return _redirect(listed)


def publication_of(form: FormData) -> tuple[Publication, list[Fault]]:
    """Return the publication that a form states, and the fields without a valid date, number or choice."""
    faults: list[Fault] = []

    def moment(name: str) -> datetime | None:
        try:
            return from_field(form.text(name))
        except (ValueError, OverflowError):
            faults.append(Fault(name, "moment"))
            return None

    def number(name: str, kind: Any, usual: Any) -> Any:
        text = form.text(name).strip().replace(",", ".")
        try:
            publication = kind(text) if text else usual
            if publication is not None and not math.isfinite(publication):
                raise ValueError(text)
            return publication
        except (ValueError, OverflowError):
            faults.append(Fault(name, "number"))
            return usual

    def choice(name: str, choices: Sequence[str], usual: str) -> str:
        chosen = form.text(name, usual)
        if chosen not in choices:
            faults.append(Fault(name, "choice"))
        return chosen if chosen in choices else usual

    usual, minutes = Publication(), number("minutes", int, None)
    publication = Publication(
        opens=moment("opens"),
        closes=moment("closes"),
        tries=number("tries", int, None),
        minutes=minutes,
        late=choice("late", LATE, usual.late),
        late_until=moment("late_until"),
        late_percent=number("late_percent", float, 0.0),
        feedback=choice("feedback", FEEDBACK, usual.feedback),
        feedback_on=moment("feedback_on"),
        answers=choice("answers", ANSWERS, usual.answers),
        answers_on=moment("answers_on"),
        takes_saved=bool(form.text("takes_saved")) or minutes is not None,
    )
    return publication, faults


def unpublish(request: Request) -> Response:
    """Unpublish the assignment: no student sees it any more; submissions remain."""
    with request.site.store.begin() as connection:
        listed = assignment_here(request, connection)
        publish(connection, listed.id, None)
        drop_prepared(connection, listed.id)
        _note(request, connection, listed, "assignment unpublished")
    return _redirect(listed)


def extend_assignment(request: Request) -> Response:
    """Give people an extension, with its reason."""
    with request.site.store.reading() as connection:
        listed = assignment_here(request, connection)
        chosen = request.form.texts.get("person", ())
        chosen_holders = [h for h in holders(connection, listed.id) if str(h.person) in chosen]
    texts = request.words["publishing"]["faults"]
    reason = request.form.text("reason").strip()[:500]
    stated, faults = publication_of(
        FormData({name: [request.form.text(name)] for name in ("closes", "tries", "minutes")})
    )
    if not chosen_holders:
        return _page(request, listed, listed.publication or Publication(), problem=texts["who"])
    faults += [fault for fault in stated.faults() if fault.field in ("tries", "minutes")]
    if faults:
        return _page(request, listed, listed.publication or Publication(), problem=texts["extension"])
    if not reason:
        return _page(request, listed, listed.publication or Publication(), problem=texts["reason"])
    by, at = request.user.name, request.received_at
    more = Extension(stated.closes, stated.tries, reason, by, at, stated.minutes)
    about = {
        "closes": stated.closes.isoformat() if stated.closes else "",
        "tries": stated.tries,
        "minutes": stated.minutes,
    }
    with request.site.store.begin() as connection:
        for holder in chosen_holders:
            extend(connection, listed.id, holder.person, more)
            prepare_soon(request.site, connection, listed.id, holder.person)
            _note(request, connection, listed, "extension", student=holder.student, **about)
    return _redirect(listed)


# ------------------------------------------------------------------- late students


def add_late(request: Request) -> Response:
    """Assign variants to the new students of a longer roster; all other papers remain as they are."""
    return _issue_more(request, new_assignment.students_of(request), (), "late ones added")


def make_up(request: Request) -> Response:
    """Assign another variant to one person, for a second sitting."""
    return _issue_more(request, [], (request.form.text("student"),), "make-up dealt")


def _issue_more(request: Request, students: Sequence[Student], names: Sequence[str], event: str) -> Response:
    with request.site.store.reading() as connection:
        listed = assignment_here(request, connection)
        content = issued_content(connection, listed.id, secret=True)
    if listed.definition is None:
        return _page(
            request,
            listed,
            listed.publication or Publication(),
            problem=request.words["publishing"]["no_file"],
        )
    issued = assigning.holders(content)
    known_students = {student.draw_key for student in issued}
    everybody = [*issued, *(student for student in students if student.draw_key not in known_students)]
    wanted = AssignmentRequest(
        listed.name, listed.definition, everybody, request.site.languages[0], content, tuple(names)
    )
    return redirect(
        f"/desk/assignments/dealing/{assigning.begin(request.site, wanted, request.user.name, event)}"
    )


# ------------------------------------------------------------------ as a student sees it


def preview(request: Request) -> Response:
    """Return the page as students will see it, with a variant that is issued to nobody."""
    with request.site.store.reading() as connection:
        listed = assignment_here(request, connection)
        issued = issued_of(connection, listed.id)
    definition = definition_of(request.site.course, listed, issued)
    paper = preview_paper(request.site, definition, request.lang)
    publication = listed.publication or Publication()
    state = AssignmentState(
        StudentAssignment(listed.id, listed.name, definition.stated(), paper.student, publication, None),
        request.lang,
        publication.now(request.received_at),
        (),
        None,
    )
    return _seen(request, listed, state, paper, request.words["publishing"]["look_preview"])


def preview_paper(site: Site, definition: Assignment, lang: str) -> StudentPaper:
    """Return a paper with variants that are issued to nobody."""
    student = Student(words(lang, "site")["publishing"]["nobody"])
    langs = [new_assignment.spoken(site, definition, lang)]
    secret = Secret(site.secret[:16]).under("preview")
    assigned = assign_variants(site.course, definition, [student], langs, secret=secret)
    content = content_of(assigned.issues, definition)
    return StudentPaper(site.course, content, student.name, lang, definition.instructions)


def definition_of(course: Course[Any], listed: AssignmentOverview, issued: Issued) -> Assignment:
    """Return the assignment as its file states it; for one issued elsewhere, as its records state it."""
    if listed.definition is not None:
        return assignment_of(listed.name, listed.definition, course)
    exercises = []
    for exercise in issued.exercises:
        record = next(record for (name, _), record in issued.records.items() if name == exercise)
        points = {str(part["id"]): float(part["points"]) for part in record["parts"]}
        exercises.append(AskedExercise(exercise, tuple(points), points))
    return Assignment(listed.name, tuple(exercises), title=dict(listed.stated.get("title") or {}))


def as_somebody(request: Request) -> Response:
    """Return the page as a student sees it, read-only; without the student's drafts."""
    with request.site.store.begin() as connection:
        listed = assignment_here(request, connection)
        person_id = int(request.path_params["person"])
        matches = student_assignments(connection, person_id, listed.id)
        if not matches:
            raise HTTPException("page", 404)
        _note(request, connection, listed, "seen as a student", student=matches[0].student)
        personal = matches[0]._replace(publication=matches[0].publication or Publication())
        paper = student_paper(connection, request.site.course, personal, person_id, request.lang)
        theirs = state_of(request, personal, connection, person_id)
    look = request.words["publishing"]["look_as"].format(personal.student)
    if theirs.phase is Phase.TO_COME or listed.publication is None:
        look += " " + request.words["publishing"]["look_hidden"]
    return _seen(request, listed, theirs, paper, look)


def _seen(
    request: Request, listed: AssignmentOverview, state: AssignmentState, paper: StudentPaper, look: str
) -> Response:
    pieces = paper.pieces()
    return request.render(
        "site/student/assignment",
        state=state,
        form={},
        versions="{}",
        problem="",
        draws=paper.draws,
        look=look,
        zone=zone_name(request.received_at),
        back=f"/desk/assignments/{listed.id}",
        paper_head=Markup(pieces.head),
        paper_body=Markup(pieces.body),
    )


def issued_file(request: Request) -> Response:
    """Return the content of ``issued.json``, as ``grade`` reads it."""
    with request.site.store.reading() as connection:
        number = assignment_here(request, connection).id
        # The secret would reveal future papers, so only a publisher receives it.
        may_draw = request.user.may(Permission.ASSIGNMENTS_PUBLISH, number, "")
        content = issued_content(connection, number, secret=may_draw)
    data = json.dumps(content, ensure_ascii=False, indent=1).encode("utf-8", "backslashreplace")
    return Download(data, "application/json", "issued.json")


ROUTES = (
    Route("/desk/assignments", list_page, Permission.ASSIGNMENTS_READ),
    Route(
        "/desk/assignments/new",
        new,
        Permission.ASSIGNMENTS_PUBLISH,
        takes_forms=True,
        limit="upload",
        budget=DESK_FILE,
    ),
    Route("/desk/assignments/dealing/{token}", assigning_page, Permission.ASSIGNMENTS_PUBLISH),
    Route("/desk/assignments/{number:int}", assignment_page, Permission.ASSIGNMENTS_READ),
    Route(
        "/desk/assignments/{number:int}/publish",
        publish_assignment,
        Permission.ASSIGNMENTS_PUBLISH,
        takes_forms=True,
        has_page=False,
    ),
    Route(
        "/desk/assignments/{number:int}/unpublish",
        unpublish,
        Permission.ASSIGNMENTS_PUBLISH,
        takes_forms=True,
        has_page=False,
    ),
    Route(
        "/desk/assignments/{number:int}/extend",
        extend_assignment,
        Permission.ASSIGNMENTS_PUBLISH,
        takes_forms=True,
        has_page=False,
    ),
    Route(
        "/desk/assignments/{number:int}/roster",
        add_late,
        Permission.ASSIGNMENTS_PUBLISH,
        takes_forms=True,
        has_page=False,
        limit="upload",
        budget=DESK_FILE,
    ),
    Route(
        "/desk/assignments/{number:int}/make-up",
        make_up,
        Permission.ASSIGNMENTS_PUBLISH,
        takes_forms=True,
        has_page=False,
    ),
    Route("/desk/assignments/{number:int}/preview", preview, Permission.ASSIGNMENTS_READ),
    Route("/desk/assignments/{number:int}/as/{person:int}", as_somebody, Permission.ASSIGNMENTS_READ),
    Route("/desk/assignments/{number:int}/issued.json", issued_file, Permission.ASSIGNMENTS_READ),
)
