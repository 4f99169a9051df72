"""Progress of a person: exercises, skills, and repetitions; a file of it to download, and one to upload."""

from __future__ import annotations

from markupsafe import Markup

from coursework.database.permissions import Permission
from coursework.database.progress import PersonProgress
from coursework.errors import BadInput
from coursework.markup import markdown
from coursework.selfstudy.advice import told_skills
from coursework.selfstudy.progress import LaterVersion, TooLong, read_brought
from coursework.selfstudy.store import FILE
from coursework.site.frame.budgets import PROGRESS_FILE, read_apart
from coursework.site.frame.visits import Page, Reply, Visit
from coursework.site.practice.contents import called, contents, next_of

_MOST = 6_000  #: entries of a file that is brought
_MOST_KEPT = 30_000  #: entries of a person, with those that are brought


def progress(visit: Visit) -> Reply:
    """Return the page of the person's progress; a form uploads a file, whose entries are added."""
    kept = PersonProgress(visit.site.store, visit.who.id, visit.site.clock)
    brought = _brought(visit, kept) if visit.posted else None
    skills = told_skills(visit.site.course, kept.progress, visit.lang, called)
    begun = [c for c in contents(visit, kept.progress) if c.begun]
    return visit.page(
        "site_progress",
        title=visit.said["progress"]["title"],
        chapters=begun,
        entries=len(kept.progress),
        skills=Markup(markdown.to_html(skills, visit.lang)) if skills else "",
        next=next_of(visit, kept.progress),
        brought=brought,
        file_name=FILE,
    )


def _brought(visit: Visit, kept: PersonProgress) -> int:
    """Add the entries of a file; return the number of new ones. Their answers are not marked, since that
    would test answers to a class's variants.

    Raises
    ------
    BadInput
        It is none of progress, of a later version, or far too long.
    """
    said = visit.said["progress"]
    found = next(iter(visit.form.files.get("file", ())), None)
    if found is None:
        raise BadInput(said["no_file"])
    fault, theirs = read_apart(
        PROGRESS_FILE, visit.said["refused"]["too_much"], read_brought, found.data, _MOST
    )
    if fault is LaterVersion:
        raise BadInput(said["later"].format(found.name))
    if fault is TooLong:
        raise BadInput(said["too_long"].format(found.name, _MOST))
    if fault is not None:
        raise BadInput(said["not_progress"].format(found.name))
    before = len(kept.progress)
    if before + len(theirs) > _MOST_KEPT:
        raise BadInput(said["too_long"].format(found.name, max(0, _MOST_KEPT - before)))
    kept.add(theirs)
    kept.refresh()
    return len(kept.progress) - before


def file(visit: Visit) -> Reply:
    """Return the whole progress, in the format of notebooks."""
    kept = PersonProgress(visit.site.store, visit.who.id, visit.site.clock).progress
    return Reply(kind="application/json", data=kept.text().encode(), file=FILE)


PAGES = (
    Page("/progress", progress, Permission.OWN, posts=True, budget=PROGRESS_FILE),
    Page(f"/progress/{FILE}", file, Permission.OWN),
)
