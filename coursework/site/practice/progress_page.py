"""Where one stands: exercises, skills, what comes again when; the file of it to take away, and one to bring."""

from __future__ import annotations

import json

from markupsafe import Markup

from coursework.database.progress import PersonProgress
from coursework.errors import BadInput
from coursework.markup import markdown
from coursework.selfstudy.advice import told_skills
from coursework.selfstudy.progress import LaterVersion, NotProgress, Progress
from coursework.selfstudy.store import FILE
from coursework.site.frame.visits import Page, Reply, Visit, Who
from coursework.site.practice.contents import called, contents, next_of

_LARGEST = 4 * 1024 * 1024  #: bytes of a file that is brought
_MOST = 50_000  #: entries of one


def progress(visit: Visit) -> Reply:
    """Where one stands; a form brings a file, whose entries are added to what is here."""
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
    """Add what a file holds; gives how many entries are new. None is marked: that would try answers to a class's variants.

    Raises
    ------
    BadInput
        It is none of progress, of a later version, or far too long.
    """
    said = visit.said["progress"]
    found = next(iter(visit.form.files.get("file", ())), None)
    if found is None:
        raise BadInput(said["no_file"])
    try:
        theirs = Progress.read(found.data.decode("utf-8-sig"))
        json.dumps([dict(one) for one in theirs], allow_nan=False)
    except (NotProgress, ValueError):  # no UTF-8, or a number that no database of JSON takes
        raise BadInput(said["not_progress"].format(found.name)) from None
    except LaterVersion:
        raise BadInput(said["later"].format(found.name)) from None
    if len(theirs) > _MOST:
        raise BadInput(said["too_long"].format(found.name, _MOST))
    before = len(kept.progress)
    kept.add(theirs)
    kept.refresh()
    return len(kept.progress) - before


def file(visit: Visit) -> Reply:
    """All of it, as notebooks keep it."""
    kept = PersonProgress(visit.site.store, visit.who.id, visit.site.clock).progress
    return Reply(kind="application/json", data=kept.text().encode(), file=FILE)


PAGES = (
    Page("/progress", progress, Who.SOMEBODY, posts=True, largest=_LARGEST),
    Page(f"/progress/{FILE}", file, Who.SOMEBODY),
)
