"""Sheets to print, for the staff: the papers of a class, or of some of it, a PDF a language, each from an odd page on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sqlalchemy import Connection

from coursework.database.permissions import Permission
from coursework.database.publication import places
from coursework.errors import BadInput
from coursework.making.booklets import parted
from coursework.making.students import file_stems
from coursework.rendering.renderer import renderer_of
from coursework.site.frame.visits import Page, Reply, Visit
from coursework.site.papers.own_paper import OwnPaper, own_paper
from coursework.site.publication.publishing import assignment_here, holders
from coursework.system.zips import zipped


def sheets(visit: Visit) -> Reply:
    """Return the papers of the selected students, or of all, as a PDF; several files are returned in an
    archive.

    Raises
    ------
    BadInput
        Nobody was issued a paper.
    """
    with visit.site.store.reading() as connection:
        one = assignment_here(visit, connection)
        papers = _papers(visit, connection, one.id)
    if not papers:
        raise BadInput(visit.said["publishing"]["print_none"])
    stem = "-".join(file_stems([one.name])) or "class"
    files = dict(_printed(visit, papers, stem))
    if len(files) == 1:
        name, data = next(iter(files.items()))
        return Reply(kind="application/pdf", data=data, file=name)
    return Reply(kind="application/zip", data=zipped(files), file=f"{stem}.zip")


def _papers(visit: Visit, connection: Connection, number: int) -> list[OwnPaper]:
    """In the order in which they were issued, each in the language that it was issued in."""
    ticked = set(visit.form.texts.get("who", ())) if visit.posted else set()
    found = []
    for holder in holders(connection, number):
        if ticked and str(holder.person) not in ticked:
            continue
        [place] = places(connection, holder.person, number)[:1]
        lang = holder.lang or visit.lang
        found.append(own_paper(connection, visit.site.course, place, holder.person, lang))
    return found


def _printed(visit: Visit, papers: Sequence[OwnPaper], stem: str) -> Iterator[tuple[str, bytes]]:
    """Yield the files with their names."""
    renderer = renderer_of(visit.site.course.folder)
    for lang in dict.fromkeys(one.lang for one in papers):
        for name, part in parted(f"{stem}.{lang}", [one for one in papers if one.lang == lang]):
            yield f"{name}.pdf", renderer.papers_pdf([one.paper for one in part])[0]


PAGES = (Page("/desk/assignments/{number:int}/sheets", sheets, Permission.ASSIGNMENTS_READ, posts=True),)
