"""A student's assignments: the list, one's own paper, what is read of it, handing it in, and what became of it."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Mapping, Sequence
from datetime import timedelta
from pathlib import Path

from markupsafe import Markup

from coursework.database.deliveries import Delivery
from coursework.database.drafts import Box, drafts
from coursework.database.people import hold
from coursework.database.permissions import Permission
from coursework.database.prepared import prepared_pieces
from coursework.database.publication import Phase, places
from coursework.errors import BadInput
from coursework.gradebook.by_student import as_students, for_student
from coursework.gradebook.placing import placed
from coursework.gradebook.rows import Row
from coursework.gradebook.submissions import read_rows
from coursework.making.students import file_stems, folded
from coursework.rendering.renderer import renderer_of
from coursework.site.frame.budgets import ANSWER_FILE, BOXES, HAND_IN, MOST_ROWS, read_apart
from coursework.site.frame.keeping import keep_form, keeper, kept
from coursework.site.frame.moments import exact_text, length_text, zone_name
from coursework.site.frame.visits import Page, Refused, Reply, Upload, Visit
from coursework.site.papers import handing_in, receipts
from coursework.site.papers.being_marked import being_marked
from coursework.site.papers.feedback import charged_text, feedback_of
from coursework.site.papers.handing_in import IN_A_FILE, ON_THE_PAGE, pass_dates, sheet_of
from coursework.site.papers.opening import filled_in, made
from coursework.site.papers.own_assignment import State, own_assignment, own_sheet, state_of
from coursework.site.papers.own_paper import OwnPaper, counts, read_lines

_FILES = (".ipynb", ".json", ".csv")
_ORDER = (Phase.OPEN, Phase.LATE, Phase.TO_COME, Phase.CLOSED)


# ------------------------------------------------------------------------- list


def listed(visit: Visit) -> Reply:
    """Return the page of the person's assignments, by phase."""
    with visit.site.store.reading() as connection:
        numbers = [one.id for one in places(connection, visit.who.id) if one.publication is not None]
    for number in numbers:
        pass_dates(visit.site, number, visit.at)
    with visit.site.store.reading() as connection:
        found = [one for one in places(connection, visit.who.id) if one.publication is not None]
        states = [state_of(visit, one, connection) for one in found]
    groups = [(phase.value, [one for one in states if one.phase is phase]) for phase in _ORDER]
    return visit.page("site_assignments", groups=[g for g in groups if g[1]], zone=zone_name(visit.at))


# ------------------------------------------------------------------------ paper


def paper(visit: Visit) -> Reply:
    """Return the person's paper to fill in; a submitted form returns with its reading."""
    state, own = own_assignment(visit)
    if visit.posted:
        return _read_back(visit, state, own)
    if not state.may_hand_in and state.done:
        return Reply(goto=f"{state.address}/receipts/{state.done[-1].receipt}")
    return _shown(visit, state, own)


def _shown(
    visit: Visit,
    state: State,
    own: OwnPaper,
    boxes: Mapping[str, Box] | None = None,
    problem: str = "",
    status: int = 200,
) -> Reply:
    """Return the page of the paper, with the drafts in its boxes, or with the given ``boxes``."""
    number, who, sheet = state.place.id, visit.who.id, sheet_of(state.place, own)
    with visit.site.store.reading() as connection:
        stands = drafts(connection, who, sheet) if boxes is None else boxes
        found = prepared_pieces(connection, number, who, own.lang, own.state)
    pieces = found or made(visit.site, number, who, own, keeps=state.phase.takes)
    form = keeper(visit, f"{state.address}/keep", sheet, stands)
    texts = {name: box.text for name, box in stands.items() if name in own.fields}
    return visit.page(
        "site_assignment", status, state=state, form=form, versions=form["data-keep-versions"], problem=problem,
        look="", back="", zone=zone_name(visit.at), paper_head=Markup(pieces.head),
        paper_body=Markup(filled_in(pieces.body, texts)),
    )  # fmt: skip


def keep(visit: Visit) -> Reply:
    """Store drafts while the assignment can be submitted."""
    if not visit.posted:
        raise Refused("method", 405)
    state, own = own_assignment(visit)
    sheet = sheet_of(state.place, own)
    return kept(visit, sheet, own.fields, lambda name, text: own.read(name, text).says, state.may_hand_in)


def _read_back(visit: Visit, state: State, own: OwnPaper) -> Reply:
    texts = own.texts(visit.form)
    said = visit.said["assignments"]
    if not state.may_hand_in:
        return _too_late(visit, state)
    boxes = _kept_too(visit, state, own, texts)
    if not any(text.strip() for text in texts.values()):
        return _shown(visit, state, own, boxes, said["nothing_typed"], 422)
    return _confirming(visit, state, own, texts, ON_THE_PAGE)


def _kept_too(visit: Visit, state: State, own: OwnPaper, texts: Mapping[str, str]) -> dict[str, Box]:
    """Store the drafts of a form without a script as well; return the boxes for this page."""
    now, _ = keep_form(visit, sheet_of(state.place, own), texts, {}, visit.form.text("_versions"))
    return {name: Box(text, now[name].version if name in now else 0) for name, text in texts.items()}


def _too_late(visit: Visit, state: State) -> Reply:
    """Refuse a submission that is no longer accepted."""
    if state.done:
        raise Refused("no_try_left" if state.phase.takes else "not_open", 409)
    raise Refused("not_open", 409)


def _confirming(
    visit: Visit,
    state: State,
    own: OwnPaper,
    texts: Mapping[str, str],
    source: str,
    notes: Sequence[str] = (),
) -> Reply:
    """Return the reading of each answer, for confirmation."""
    lines = read_lines(own, texts)
    late = state.place.own.late_seconds(state.now)
    charged = state.place.own.charged(late)
    return visit.page(
        "site_assignment_read_back", state=state, lines=lines, counts=counts(lines), source=source, notes=notes,
        number=len(state.done) + 1, texts={name: text for name, text in texts.items() if text},
        late=length_text(timedelta(seconds=late), visit.lang) if late else "",
        charged=charged_text(charged, visit.lang) if charged else "", heading=own.heading,
    )  # fmt: skip


# ------------------------------------------------------------------------ files


def files(visit: Visit) -> Reply:
    """Return the paper as a PDF or as a notebook."""
    state, own = own_assignment(visit)
    renderer, stem = renderer_of(visit.site.course.folder), _stem(state, own)
    if visit.path["file"] == "paper.pdf":
        return Reply(kind="application/pdf", data=renderer.paper_pdf(own.paper), file=f"{stem}.pdf")
    if visit.path["file"] == "notebook.ipynb":
        data = renderer.paper_notebook(own.paper).encode()
        return Reply(kind="application/x-ipynb+json", data=data, file=f"{stem}.ipynb")
    raise Refused("page", 404)


def _stem(state: State, own: OwnPaper) -> str:
    return "-".join(filter(None, file_stems([state.place.name, own.student]))) or "paper"


def take_file(visit: Visit) -> Reply:
    """Read a completed notebook or file of answers, without running it, and return its reading."""
    if not visit.posted:
        raise Refused("method", 405)
    state, own = own_assignment(visit)
    said = visit.said["assignments"]
    if not state.may_hand_in:
        return _too_late(visit, state)
    sent = next(iter(visit.form.files.get("file", ())), None)
    if sent is None or _ending(sent) not in _FILES:
        return _shown(visit, state, own, None, said["which_file"].format(", ".join(_FILES)), 422)
    try:
        texts, notes = _of_file(visit, own, sent)
    except BadInput as fault:
        return _shown(visit, state, own, None, str(fault), 422)
    if not any(text.strip() for text in texts.values()):
        return _shown(visit, state, own, None, " ".join([said["file_empty"], *notes]), 422)
    return _confirming(visit, state, own, texts, IN_A_FILE, notes)


def _ending(sent: Upload) -> str:
    found = re.search(r"\.[a-z]{1,8}$", sent.name.lower())
    return found[0] if found else ""


def _of_file(visit: Visit, own: OwnPaper, sent: Upload) -> tuple[dict[str, str], list[str]]:
    """Return the answers of a file to the person's own paper, by box, and messages about the file.

    Raises
    ------
    BadInput
        The file takes more to be read than it may, or holds more rows than a paper has.
    """
    said, told = visit.said["assignments"], []
    with tempfile.TemporaryDirectory(prefix="coursework-") as folder:
        path = Path(folder) / f"answers{_ending(sent)}"  # nothing of the name that it came by
        path.write_bytes(sent.data)
        rows = read_apart(ANSWER_FILE, visit.said["refused"]["too_much"], read_rows, path, MOST_ROWS)
    if rows is None:
        raise BadInput(said["file_too_long"].format(MOST_ROWS))
    names = {row.student for row in rows if isinstance(row, Row) and row.student}
    if others := sorted(one for one in names if folded(one) != folded(own.student)):
        told.append(said["file_named"].format(", ".join(one[:60] for one in others[:3])))
    sheets = placed(visit.site.course, own.issued, as_students(own.issued, own.student, rows, []))
    texts = dict.fromkeys(own.boxes, "")
    for name, box in own.boxes.items():
        row = sheets.sheets.get((own.student, box.variant.exercise.name, box.variant.seed, 0), {}).get(
            box.part.id
        )
        texts[name] = "" if row is None or row.answer is None else str(row.answer)[:4000]
    if sheets.rejected:
        told.append(said["file_rejected"].format(len(sheets.rejected)))
        told += [for_student(one.reason) for one in sheets.rejected[:5]]
    return texts, told


# -------------------------------------------------------------------- handing in


def confirm(visit: Visit) -> Reply:
    """Hand in what was read back, once."""
    if not visit.posted:
        raise Refused("method", 405)
    site, who, number = visit.site, visit.who.id, visit.form.text("_number")
    source = IN_A_FILE if visit.form.text("_source") == IN_A_FILE else ON_THE_PAGE
    pass_dates(site, int(visit.path["number"]), visit.at)
    with site.store.begin() as connection:
        hold(connection, who)
        place, own = own_sheet(visit, connection)
        if not re.fullmatch("[1-9][0-9]{0,5}", number):
            raise Refused("bad_request", 400)
        texts = own.texts(visit.form)
        made = handing_in.store(connection, site, place, own, who, texts, int(number), visit.at, source)
    if made.is_new:
        handing_in.mark(site, made.delivery.id)
    again = "" if made.is_new else "?again=other" if made.differs else "?again=same"
    return Reply(goto=f"/assignments/{place.id}/receipts/{made.delivery.receipt}{again}")


def receipt(visit: Visit) -> Reply:
    """Return the receipt of a submission, with the next steps."""
    pass_dates(visit.site, int(visit.path["number"]), visit.at)
    with visit.site.store.reading() as connection:
        place, own = own_sheet(visit, connection)
        state = state_of(visit, place, connection)
        row = receipts.find(state.done, str(visit.path["code"]))
        told = receipts.told_of(connection, row, place.name, visit.who.name)
    again = visit.query.get("again", "")
    shown = {(e, s, p): a for e, s, p, a in told["answers"]}
    texts = {
        name: shown.get((box.variant.exercise.name, str(box.variant.seed), box.part.id), "")
        for name, box in own.boxes.items()
    }
    return visit.page(
        "site_assignment_receipt", state=state, row=row, told=told, lines=read_lines(own, texts),
        came=exact_text(row.came, visit.lang), zone=zone_name(row.came), again=again if again in ("same", "other") else "",
        late=length_text(timedelta(seconds=row.late), visit.lang) if row.late else "",
        charged=charged_text(state.place.own.charged(row.late), visit.lang) if state.place.own.charged(row.late) else "",
        saved=row.source == handing_in.AS_SAVED, feedback_from=feedback_from(visit, state),
        marking=being_marked(visit, row.id) if state.tells("feedback") else None,
    )  # fmt: skip


def feedback_from(visit: Visit, state: State) -> str:
    """Return the time of the feedback, as a sentence."""
    said, own = visit.said["assignments"]["feedback_when"], state.place.own
    if own.feedback == "date":
        return str(said["date"]).format(state.moment(own.feedback_on))
    if own.feedback == "closed":
        ends = state.closed_for_both
        return str(said["closed"]).format(state.moment(ends)) if ends else ""
    return str(said[own.feedback])


def feedback(visit: Visit) -> Reply:
    """Return the feedback on a submission, as far as it is released."""
    state, own = own_assignment(visit)
    if not state.tells("feedback"):
        raise Refused("feedback_later", 409)
    if not state.done:
        raise Refused("nothing_handed_in", 404)
    chosen = _chosen(visit, state)
    if being_marked(visit, chosen.id) is not None:
        return Reply(goto=f"{state.address}/receipts/{chosen.receipt}")
    told, notes = feedback_of(visit, state, own, chosen)
    return visit.page(
        "site_assignment_feedback", state=state, notes=notes, delivery=chosen, **own.shown(told)
    )


def _chosen(visit: Visit, state: State) -> Delivery:
    asked = visit.query.get("number", "")
    return next((one for one in state.done if str(one.number) == asked), state.done[-1])


PAGES = (
    Page("/assignments", listed, Permission.OWN, limit="paper"),
    Page("/assignments/{number:int}", paper, Permission.OWN, posts=True, limit="paper", budget=BOXES),
    Page(
        "/assignments/{number:int}/keep",
        keep,
        Permission.OWN,
        posts=True,
        limit="paper",
        budget=BOXES,
        is_short=True,
    ),
    Page(
        "/assignments/{number:int}/hand-in",
        confirm,
        Permission.OWN,
        posts=True,
        limit="hand_in",
        budget=HAND_IN,
        is_short=True,
    ),
    Page(
        "/assignments/{number:int}/file",
        take_file,
        Permission.OWN,
        posts=True,
        limit="upload",
        budget=ANSWER_FILE,
    ),
    Page("/assignments/{number:int}/feedback", feedback, Permission.OWN, limit="paper"),
    *receipts.PAGES,
    Page("/assignments/{number:int}/receipts/{code}", receipt, Permission.OWN, limit="paper"),
    Page("/assignments/{number:int}/{file}", files, Permission.OWN, limit="upload"),
)
