"""Progress of a person: exercises, skills, and repetitions; a file of it to download, and one to upload."""

from __future__ import annotations

from markupsafe import Markup
from starlette.responses import Response

from coursework.database.permissions import Permission
from coursework.database.progress import PersonProgress
from coursework.errors import BadInput
from coursework.markup import markdown
from coursework.selfstudy.mastery import skills_text
from coursework.selfstudy.progress import FILE, LaterVersion, TooLong, read_brought
from coursework.site.frame.budgets import PROGRESS_FILE, read_apart
from coursework.site.frame.requests import Request, Route
from coursework.site.frame.responses import Download
from coursework.site.practice.contents import contents, exercise_title, next_of

_MOST = 6_000  #: entries of an uploaded file
_MOST_STORED = 30_000  #: entries of a person, uploaded ones included


def progress(request: Request) -> Response:
    """Return the page of the person's progress; a form uploads a file, whose entries are added."""
    store = PersonProgress(request.site.store, request.user.id, request.site.clock)
    brought = _brought(request, store) if request.is_post else None
    skills = skills_text(request.site.course, store.progress, request.lang, exercise_title)
    begun = [c for c in contents(request, store.progress) if c.begun]
    return request.render(
        "site/student/progress",
        title=request.words["progress"]["title"],
        chapters=begun,
        entries=len(store.progress),
        skills=Markup(markdown.to_html(skills, request.lang)) if skills else "",
        next=next_of(request, store.progress),
        brought=brought,
        file_name=FILE,
    )


def _brought(request: Request, store: PersonProgress) -> int:
    """Add the entries of a file; return the number of new ones. Their answers are not marked, since that
    would test answers to a class's variants. Raises BadInput: the file is not one of progress, is of a
    later version, or is too long."""
    texts = request.words["progress"]
    upload = next(iter(request.form.files.get("file", ())), None)
    if upload is None:
        raise BadInput(texts["no_file"])
    fault, theirs = read_apart(
        PROGRESS_FILE, request.words["refused"]["too_much"], read_brought, upload.data, _MOST
    )
    if fault is LaterVersion:
        raise BadInput(texts["later"].format(upload.name))
    if fault is TooLong:
        raise BadInput(texts["too_long"].format(upload.name, _MOST))
    if fault is not None:
        raise BadInput(texts["not_progress"].format(upload.name))
    before = len(store.progress)
    if before + len(theirs) > _MOST_STORED:
        raise BadInput(texts["too_long"].format(upload.name, max(0, _MOST_STORED - before)))
    store.add(theirs)
    store.refresh()
    return len(store.progress) - before


def file(request: Request) -> Response:
    """Return all the progress, in the format of notebooks."""
    entries = PersonProgress(request.site.store, request.user.id, request.site.clock).progress
    return Download(entries.text().encode(), "application/json", FILE)


ROUTES = (
    Route("/progress", progress, Permission.OWN, takes_forms=True, budget=PROGRESS_FILE),
    Route(f"/progress/{FILE}", file, Permission.OWN),
)
