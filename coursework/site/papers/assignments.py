"""Assignments of a student: list, paper, reading of the answers, submission, receipt, and feedback."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from datetime import timedelta

from markupsafe import Markup
from starlette.responses import Response

from coursework.database.drafts import DraftBox, drafts
from coursework.database.people import lock_person
from coursework.database.permissions import Permission
from coursework.database.prepared import prepared_pieces
from coursework.database.publication import Phase
from coursework.database.submissions import Submission
from coursework.errors import BadInput
from coursework.gradebook.by_student import as_students, for_student
from coursework.gradebook.placing import placed_sheets
from coursework.gradebook.rows import AnswerRow
from coursework.gradebook.submissions import read_rows
from coursework.issuing.students import file_stems, folded
from coursework.rendering.renderer import renderer_of
from coursework.site.frame.budgets import ANSWER_FILE, BOXES, HAND_IN, MOST_ROWS, PLAIN
from coursework.site.frame.drafts import draft_attributes, save_drafts, save_form_drafts, versions_of
from coursework.site.frame.forms import read_upload
from coursework.site.frame.requests import HTTPException, Request, Route, Upload
from coursework.site.frame.responses import Download, opens_offline, redirect
from coursework.site.frame.times import length_text, time_element, zone_name
from coursework.site.lessons.lesson_content import linked_lessons
from coursework.site.papers import receipts, submission
from coursework.site.papers.assignment_state import (
    AssignmentState,
    NotStarted,
    assignment_and_paper,
    published_states,
    state_and_paper,
    state_of,
)
from coursework.site.papers.feedback import charged_text, drawings_in, feedback_of
from coursework.site.papers.opening import filled_in, make_pieces
from coursework.site.papers.receipts import pending_marking
from coursework.site.papers.starting import record_start, start_names
from coursework.site.papers.student_paper import StudentPaper, counts, read_lines
from coursework.site.papers.submission import IN_A_FILE, ON_THE_PAGE, pass_dates, sheet_of

_FILES = (".ipynb", ".json", ".csv")
_ORDER = (Phase.OPEN, Phase.LATE, Phase.TO_COME, Phase.CLOSED)


# ------------------------------------------------------------------------- list


def list_page(request: Request) -> Response:
    """Return the page of the person's assignments, by phase."""
    with request.site.store.reading() as connection:
        states = published_states(request, connection)
    if pass_dates(request.site, request.received_at, *(item.assignment.id for item in states)):
        with request.site.store.reading() as connection:
            states = published_states(request, connection)
    groups = [(phase.value, [item for item in states if item.phase is phase]) for phase in _ORDER]
    return request.render(
        "site/student/assignments",
        groups=[g for g in groups if g[1]],
        has_times=any(item.has_times for item in states),
        zone=zone_name(request.received_at),
    )


# ------------------------------------------------------------------------ paper


def paper_page(request: Request) -> Response:
    """Return the person's paper to fill in, or the page that starts it; a submitted form returns with its
    reading."""
    try:
        state, paper = state_and_paper(request)
    except NotStarted as why:
        names = start_names(request, why.assignment)
        return request.render("site/student/assignment_start", zone=zone_name(request.received_at), **names)
    if request.is_post:
        return _read_back(request, state, paper)
    if not state.may_hand_in and state.done:
        return redirect(f"{state.address}/receipts/{state.done[-1].receipt}")
    page = _paper_response(request, state, paper)
    rules = state.assignment.own_publication
    closes = rules.closes if state.phase is Phase.OPEN else rules.ends
    if not state.may_hand_in:
        return page
    return opens_offline(page, None if closes is None else closes - state.now)


def start_paper(request: Request) -> Response:
    """Start the working time of a paper; a repeated form leads to the paper."""
    record_start(request)
    return redirect(f"/assignments/{request.path_params['number']}")


def _paper_response(
    request: Request,
    state: AssignmentState,
    paper: StudentPaper,
    boxes: Mapping[str, DraftBox] | None = None,
    problem: str = "",
    status: int = 200,
) -> Response:
    """Return the page of the paper, with the drafts in its boxes, or with the given ``boxes``."""
    number, person_id, sheet = state.assignment.id, request.user.id, sheet_of(state.assignment, paper)
    with request.site.store.reading() as connection:
        contents = drafts(connection, person_id, sheet) if boxes is None else boxes
        prepared = prepared_pieces(connection, number, person_id, paper.lang, paper.state)
    pieces = prepared or make_pieces(request.site, number, person_id, paper, stores=state.phase.takes)
    form = draft_attributes(request, f"{state.address}/keep", sheet, contents)
    boxes_shown = {*paper.fields, *paper.drawn}
    texts = {name: box.text for name, box in contents.items() if name in boxes_shown}
    return request.render(
        "site/student/assignment",
        status,
        state=state,
        form=form,
        versions=form["data-keep-versions"],
        problem=problem,
        draws=paper.draws,
        look="",
        back="",
        zone=zone_name(request.received_at),
        paper_head=Markup(pieces.head),
        paper_body=Markup(filled_in(pieces.body, texts)),
    )


def save_draft(request: Request) -> Response:
    """Store drafts while the assignment can be submitted."""
    state, paper = state_and_paper(request)
    sheet = sheet_of(state.assignment, paper)
    return save_drafts(
        request,
        sheet,
        {*paper.fields, *paper.drawn},
        lambda name, text: str(paper.read(name, text).html),
        state.may_hand_in,
    )


def _read_back(request: Request, state: AssignmentState, paper: StudentPaper) -> Response:
    texts = paper.texts(request.form)
    messages = request.words["assignments"]
    if not state.may_hand_in:
        return _too_late(request, state)
    boxes = _save_form(request, state, paper, texts | paper.drawing_texts(request.form))
    if not any(text.strip() for text in texts.values()):
        return _paper_response(request, state, paper, boxes, messages["nothing_typed"], 422)
    if _stored_texts(request, state, paper) == texts and not _is_submitted(request, state, paper, texts):
        return redirect(f"{state.address}/read-back")
    return _confirming(request, state, paper, texts, ON_THE_PAGE)  # or another page holds other drafts


def read_back_page(request: Request) -> Response:
    """Return the reading of the drafts, for confirmation; of what is submitted already, its receipt."""
    state, paper = state_and_paper(request)
    texts = _stored_texts(request, state, paper)
    is_blank = not any(text.strip() for text in texts.values())
    if state.done and (is_blank or not state.may_hand_in or _is_submitted(request, state, paper, texts)):
        return redirect(f"{state.address}/receipts/{state.done[-1].receipt}")
    if is_blank or not state.may_hand_in:
        return redirect(state.address)
    return _confirming(request, state, paper, texts, ON_THE_PAGE)


def _is_submitted(
    request: Request, state: AssignmentState, paper: StudentPaper, texts: Mapping[str, str]
) -> bool:
    with request.site.store.reading() as connection:
        return bool(state.done) and submission.holds(connection, state.done[-1], paper, texts)


def _stored_texts(request: Request, state: AssignmentState, paper: StudentPaper) -> dict[str, str]:
    """Return the drafts by box; empty for a box without one."""
    with request.site.store.reading() as connection:
        stored = drafts(connection, request.user.id, sheet_of(state.assignment, paper))
    return {name: stored[name].text if name in stored else "" for name in paper.fields}


def _save_form(
    request: Request, state: AssignmentState, paper: StudentPaper, texts: Mapping[str, str]
) -> dict[str, DraftBox]:
    """Store the drafts of a form without a script as well; return the boxes for this page."""
    versions = versions_of(request.form.text("_versions"))
    with request.site.store.begin() as connection:
        sheet = sheet_of(state.assignment, paper)
        now, _ = save_form_drafts(connection, request, sheet, texts, lambda stored: {}, versions)
    return {name: DraftBox(text, now[name].version if name in now else 0) for name, text in texts.items()}


def _too_late(request: Request, state: AssignmentState) -> Response:
    """Refuse a submission that is no longer accepted."""
    if state.done:
        raise HTTPException("no_try_left" if state.phase.takes else "not_open", 409)
    raise HTTPException("not_open", 409)


def _confirming(
    request: Request,
    state: AssignmentState,
    paper: StudentPaper,
    texts: Mapping[str, str],
    source: str,
    notes: Sequence[str] = (),
) -> Response:
    """Return the reading of each answer, for confirmation."""
    lines = read_lines(paper, texts)
    late = state.assignment.own_publication.late_seconds(state.now)
    charged = state.assignment.own_publication.charged(late)
    return request.render(
        "site/student/assignment_read_back",
        state=state,
        lines=lines,
        counts=counts(lines),
        source=source,
        notes=notes,
        number=len(state.done) + 1,
        texts={name: text for name, text in texts.items() if text},
        late=length_text(timedelta(seconds=late), request.lang) if late else "",
        charged=charged_text(charged, request.lang) if charged else "",
        heading=paper.heading,
    )


# ------------------------------------------------------------------------ files


def files(request: Request) -> Response:
    """Return the paper as a PDF or as a notebook."""
    state, paper = state_and_paper(request)
    renderer, stem = renderer_of(request.site.course.folder), _stem(state, paper)
    if request.path_params["file"] == "paper.pdf":
        return Download(renderer.pdf(paper.paper), "application/pdf", f"{stem}.pdf")
    if request.path_params["file"] == "notebook.ipynb":
        data = renderer.notebook(paper.paper).encode()
        return Download(data, "application/x-ipynb+json", f"{stem}.ipynb")
    raise HTTPException("page", 404)


def _stem(state: AssignmentState, paper: StudentPaper) -> str:
    return "-".join(filter(None, file_stems([state.assignment.name, paper.student]))) or "paper"


def take_file(request: Request) -> Response:
    """Read a completed notebook or file of answers, without running it, and return its reading."""
    state, paper = state_and_paper(request)
    messages = request.words["assignments"]
    if not state.may_hand_in:
        return _too_late(request, state)
    sent = next(iter(request.form.files.get("file", ())), None)
    if sent is None or _ending(sent) not in _FILES:
        return _paper_response(
            request, state, paper, None, messages["which_file"].format(", ".join(_FILES)), 422
        )
    try:
        texts, notes = _of_file(request, paper, sent)
    except BadInput as fault:
        return _paper_response(request, state, paper, None, str(fault), 422)
    if not any(text.strip() for text in texts.values()):
        return _paper_response(request, state, paper, None, " ".join([messages["file_empty"], *notes]), 422)
    return _confirming(request, state, paper, texts, IN_A_FILE, notes)


def _ending(sent: Upload) -> str:
    match = re.search(r"\.[a-z]{1,8}$", sent.name.lower())
    return match[0] if match else ""


def _of_file(request: Request, paper: StudentPaper, sent: Upload) -> tuple[dict[str, str], list[str]]:
    """Return the answers of a file to the person's own paper, by box, and messages about the file. Raises
    BadInput: the file needs too many resources, or has more rows than a paper."""
    messages, warnings = request.words["assignments"], []
    name = f"answers{_ending(sent)}"  # not the uploaded name, which is untrusted
    rows = read_upload(request, ANSWER_FILE, read_rows, name, sent.data, MOST_ROWS)
    if rows is None:
        raise BadInput(messages["file_too_long"].format(MOST_ROWS))
    names = {row.student for row in rows if isinstance(row, AnswerRow) and row.student}
    if others := sorted(item for item in names if folded(item) != folded(paper.student)):
        warnings.append(messages["file_named"].format(", ".join(item[:60] for item in others[:3])))
    sheets = placed_sheets(
        request.site.course, paper.issued, as_students(paper.issued, paper.student, rows, [])
    )
    texts = dict.fromkeys(paper.boxes, "")
    for name, box in paper.boxes.items():
        row = sheets.sheets.get((paper.student, box.variant.exercise.name, box.variant.seed, 0), {}).get(
            box.part.id
        )
        texts[name] = "" if row is None or row.answer is None else str(row.answer)[:4000]
    if sheets.rejected:
        warnings.append(messages["file_rejected"].format(len(sheets.rejected)))
        warnings += [for_student(item.reason) for item in sheets.rejected[:5]]
    return texts, warnings


# -------------------------------------------------------------------- submission


def confirm(request: Request) -> Response:
    """Submit the confirmed answers, once."""
    site, person_id, number = request.site, request.user.id, request.form.text("_number")
    source = IN_A_FILE if request.form.text("_source") == IN_A_FILE else ON_THE_PAGE
    pass_dates(site, request.received_at, int(request.path_params["number"]))
    with site.store.begin() as connection:
        lock_person(connection, person_id)
        assignment, paper = assignment_and_paper(request, connection)
        if not re.fullmatch("[1-9][0-9]{0,5}", number):
            raise HTTPException("bad_request", 400)
        texts = paper.texts(request.form)
        result = submission.store_submission(
            connection, site, assignment, paper, person_id, texts, int(number), request.received_at, source
        )
    if result.is_new:
        submission.mark(site, result.submission.id)
    again = "" if result.is_new else "?again=other" if result.differs else "?again=same"
    return redirect(f"/assignments/{assignment.id}/receipts/{result.submission.receipt}{again}")


def receipt(request: Request) -> Response:
    """Return the receipt of a submission, with the next steps."""
    pass_dates(request.site, request.received_at, int(request.path_params["number"]))
    with request.site.store.reading() as connection:
        assignment, paper = assignment_and_paper(request, connection)
        state = state_of(request, assignment, connection)
        row = receipts.find(state.done, str(request.path_params["code"]))
        content = receipts.receipt_content(connection, row, assignment.name, request.user.name)
    again = request.query_params.get("again", "")
    texts = paper.texts_of({(e, s, p): a for e, s, p, a in content["answers"]})
    return request.render(
        "site/student/assignment_receipt",
        state=state,
        row=row,
        content=content,
        lines=read_lines(paper, texts),
        came=time_element(row.received_at, request.lang, exact=True),
        again=again if again in ("same", "other") else "",
        late=length_text(timedelta(seconds=row.late), request.lang) if row.late else "",
        charged=charged_text(state.assignment.own_publication.charged(row.late), request.lang)
        if state.assignment.own_publication.charged(row.late)
        else "",
        saved=row.source == submission.AS_SAVED,
        feedback_from=feedback_from(request, state),
        marking=pending_marking(request, row.id) if state.releases("feedback") else None,
    )


def feedback_from(request: Request, state: AssignmentState) -> str:
    """Return the time of the feedback, as a sentence."""
    messages, rules = request.words["assignments"]["feedback_when"], state.assignment.own_publication
    if rules.feedback == "date":
        return Markup(messages["date"]).format(state.moment(rules.feedback_on))
    if rules.feedback == "closed":
        ends = state.closed_for_both
        return Markup(messages["closed"]).format(state.moment(ends)) if ends else ""
    return str(messages[rules.feedback])


def feedback(request: Request) -> Response:
    """Return the feedback on a submission, as far as it is released."""
    state, paper = state_and_paper(request)
    if not state.releases("feedback"):
        raise HTTPException("feedback_later", 409)
    if not state.done:
        raise HTTPException("nothing_handed_in", 404)
    chosen = _chosen(request, state)
    if pending_marking(request, chosen.id) is not None:
        return redirect(f"{state.address}/receipts/{chosen.receipt}")
    document, notes = feedback_of(request, state, paper, chosen)
    return request.render(
        "site/student/assignment_feedback",
        state=state,
        notes=notes,
        submission=chosen,
        drawings=drawings_in(request, state, paper, chosen),
        lessons={name: linked_lessons(request.site, name, request.lang) for name in paper.issued.exercises},
        **paper.template_names(document),
    )


def _chosen(request: Request, state: AssignmentState) -> Submission:
    number = request.query_params.get("number", "")
    return next((handed_in for handed_in in state.done if str(handed_in.number) == number), state.done[-1])


ROUTES = (
    Route("/assignments", list_page, Permission.OWN, limit="paper"),
    Route(
        "/assignments/{number:int}", paper_page, Permission.OWN, takes_forms=True, limit="paper", budget=BOXES
    ),
    Route(
        "/assignments/{number:int}/keep",
        save_draft,
        Permission.OWN,
        takes_forms=True,
        has_page=False,
        limit="paper",
        budget=BOXES,
        is_short=True,
    ),
    Route(
        "/assignments/{number:int}/start",
        start_paper,
        Permission.OWN,
        takes_forms=True,
        has_page=False,
        limit="paper",
        budget=PLAIN,
        is_short=True,
    ),
    Route("/assignments/{number:int}/read-back", read_back_page, Permission.OWN, limit="paper"),
    Route(
        "/assignments/{number:int}/hand-in",
        confirm,
        Permission.OWN,
        takes_forms=True,
        has_page=False,
        limit="hand_in",
        budget=HAND_IN,
        is_short=True,
    ),
    Route(
        "/assignments/{number:int}/file",
        take_file,
        Permission.OWN,
        takes_forms=True,
        has_page=False,
        limit="upload",
        budget=ANSWER_FILE,
    ),
    Route("/assignments/{number:int}/feedback", feedback, Permission.OWN, limit="paper"),
    *receipts.ROUTES,
    Route("/assignments/{number:int}/receipts/{code}", receipt, Permission.OWN, limit="paper"),
    Route("/assignments/{number:int}/{file}", files, Permission.OWN, limit="upload"),
)
