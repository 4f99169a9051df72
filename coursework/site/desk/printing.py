"""Papers to print, for staff: those of a class or of selected students, one PDF per language; each paper
begins on an odd page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sqlalchemy import Connection
from starlette.responses import Response

from coursework.database.assignments import contents_by_person
from coursework.database.instructor_queries import AssignmentOverview
from coursework.database.permissions import Permission
from coursework.database.publication import StudentAssignment
from coursework.errors import BadInput
from coursework.issuing.booklets import parted
from coursework.issuing.students import file_stems
from coursework.rendering.renderer import renderer_of
from coursework.site.frame.requests import Request, Route
from coursework.site.frame.responses import Download
from coursework.site.papers.student_paper import StudentPaper, student_paper
from coursework.site.publication.publishing import assignment_here, holders
from coursework.system.zips import zipped


def sheets(request: Request) -> Response:
    """Return the papers of the selected students, or of all, as a PDF; several files are returned in an
    archive.

    Raises
    ------
    BadInput
        Nobody was issued a paper.
    """
    with request.site.store.reading() as connection:
        assignment = assignment_here(request, connection)
        papers = _papers(request, connection, assignment)
    if not papers:
        raise BadInput(request.words["publishing"]["print_none"])
    stem = "-".join(file_stems([assignment.name])) or "class"
    files = dict(_printed(request, papers, stem))
    if len(files) == 1:
        name, data = next(iter(files.items()))
        return Download(data, "application/pdf", name)
    return Download(zipped(files), "application/zip", f"{stem}.zip")


def _papers(request: Request, connection: Connection, listed: AssignmentOverview) -> list[StudentPaper]:
    """Return the selected papers in order of issue, each in its own language."""
    ticked = set(request.form.texts.get("who", ())) if request.is_post else set()
    contents, papers = contents_by_person(connection, listed.id), []
    for holder in holders(connection, listed.id):
        if ticked and str(holder.person) not in ticked:
            continue
        their_file = listed.stated, holder.student, listed.publication, None, listed.definition or {}
        assignment, content = StudentAssignment(listed.id, listed.name, *their_file), contents[holder.person]
        lang, course = holder.lang or request.lang, request.site.course
        papers.append(student_paper(connection, course, assignment, holder.person, lang, content=content))
    return papers


def _printed(request: Request, papers: Sequence[StudentPaper], stem: str) -> Iterator[tuple[str, bytes]]:
    """Yield the files with their names."""
    renderer = renderer_of(request.site.course.folder)
    for lang in dict.fromkeys(paper.lang for paper in papers):
        for name, part in parted(f"{stem}.{lang}", [paper for paper in papers if paper.lang == lang]):
            yield f"{name}.pdf", renderer.booklet([paper.paper for paper in part])[0]


ROUTES = (
    Route("/desk/assignments/{number:int}/sheets", sheets, Permission.ASSIGNMENTS_READ, takes_forms=True),
)
