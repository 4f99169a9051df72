"""Handouts, worked solutions, feedback and reports as PDF, web page, notebook and text."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from coursework.course.builtin import builtin_root
from coursework.course.folder import Folder
from coursework.errors import unknown

if TYPE_CHECKING:
    from coursework.figures.polygons.construction import Construction
    from coursework.rendering.papers import AnyPaper
    from coursework.scenes.animation import Animation
    from coursework.sheets.attendance import ExamLists
    from coursework.sheets.book import Book
    from coursework.sheets.paper import FeedbackPaper, Paper, SolutionPaper
    from coursework.sheets.report import ReportContent
    from coursework.sheets.sheet import AnswerSheet, FeedbackSheet, Handout, StudySheet

    AnySheet: TypeAlias = Handout | AnswerSheet | FeedbackSheet
    Pages: TypeAlias = tuple[tuple[int, int], ...]  # the first and the last page of each, from 1 on

PAPERS = ("a4", "letter")
_SCREEN = 96  #: pixels an inch of a page on a screen


class Renderer:
    """Renders sheets, and papers of several sheets, through the templates of these folders, the first that
    has one.

    The same sheet gives the same bytes. Safe to share between threads; not to be carried into a
    forked process. ``paper`` is ``a4`` or ``letter``; another raises :class:`UnknownName`.
    """

    def __init__(self, template_folders: Sequence[Path], paper: str = "a4") -> None:
        if paper not in PAPERS:
            raise unknown("paper", paper, PAPERS)
        self.template_folders = tuple(Path(folder) for folder in template_folders)
        self.paper = paper

    def on(self, paper: str) -> Renderer:
        """Return the same renderer for another paper."""
        return Renderer(self.template_folders, paper)

    def typst(self, sheet: AnySheet | AnyPaper) -> str:
        """Return the Typst source of a sheet or a paper; it stands alone."""
        from coursework.rendering import pdf

        return pdf.drawn(self._source([sheet]), self.template_folders)

    def _source(self, sheets: Sequence[AnySheet | AnyPaper]) -> str:
        from coursework.rendering import papers, pdf

        source: Callable[..., str] = papers.typst_source if _is_paper(sheets[0]) else pdf.source
        return source(self.template_folders, sheets, self.paper)

    def pdf(self, *sheets: AnySheet | AnyPaper) -> bytes:
        """Return sheets, or papers, as one tagged PDF."""
        from coursework.rendering import pdf

        return pdf.compile_pdf(self._source(sheets), self.template_folders)

    def booklet(self, sheets: Sequence[AnySheet | AnyPaper]) -> tuple[bytes, Pages]:
        """Return the PDF of many sheets or papers, and the pages of each in it."""
        from coursework.rendering import pdf

        return pdf.compile_booklet(self._source(sheets), self.template_folders)

    def images(self, sheet: AnySheet | AnyPaper, ppi: float = _SCREEN) -> list[bytes]:
        """Return each page of a sheet or a paper as a PNG."""
        from coursework.rendering import pdf

        return pdf.compile_pictures(self._source([sheet]), self.template_folders, ppi)

    def undrawn(self, text: str) -> list[str]:
        """Return the characters of a text that no font of a PDF draws: they are printed as squares."""
        from coursework.rendering import pdf

        return pdf.undrawn(text, self.template_folders)

    def html(self, sheet: AnySheet | AnyPaper) -> str:
        """Return a sheet or a paper as one web page that fetches nothing. A student's own runs one script,
        which keeps the answers typed in it and hands them in as a file; any other runs none."""
        from coursework.rendering import html, papers

        page: Callable[..., str] = papers.page if _is_paper(sheet) else html.page
        return page(self.template_folders, sheet, self.paper)

    def tex(
        self,
        sheet: Handout | AnswerSheet | Paper | SolutionPaper,
        figures: Sequence[str],
        polygons: Sequence[str] = (),
    ) -> str:
        """Return a sheet or a paper as LaTeX source for pdflatex.

        ``figures`` name the PDF files beside it that hold each exercise's figure, that of :meth:`figure_pdf`,
        if any, and ``polygons`` those of :meth:`polygons_pdf`.
        """
        from coursework.rendering import latex, papers

        source: Callable[..., str] = papers.tex if _is_paper(sheet) else latex.source
        return source(
            self.template_folders, sheet, self.paper, figures, polygons or ["polygons.pdf"] * len(figures)
        )

    def figure_pdf(self, sheet: Handout | AnswerSheet) -> bytes | None:
        """Return the figure that a sheet shows, as a PDF of its own, several on a page each; nothing when it
        shows none."""
        from coursework.rendering import views

        figure, more = views.figure_of(sheet), [drawing for drawing, _ in views.more_figures(sheet)]
        if figure is None:
            return None
        if not more:
            return figure.pdf()
        from coursework.figures.typesetting import pages

        return pages([(drawing.svg(), drawing.size_mm[0]) for drawing in (figure, *more)])

    def polygons_pdf(self, sheet: Handout | AnswerSheet) -> bytes | None:
        """Return the drawings of a solution's polygons, one a page of its own size; nothing when it has
        none."""
        from coursework.rendering import views

        drawings = views.polygon_drawings(sheet)
        if not drawings:
            return None
        from coursework.figures.typesetting import pages

        return pages([(figure.svg(), figure.size_mm[0]) for figure in drawings])

    def white_shares(self, sheet: Handout | Paper) -> list[float]:
        """Return for each page of a sheet or a paper, as printed, the largest share of its height that is
        white."""
        from coursework.rendering.white_space import PPI, white_share

        return [white_share(png) for png in self.images(sheet, PPI)]

    def attendance_pdf(self, lists: ExamLists, *, public: bool = False) -> bytes:
        """Return the attendance lists of an exam as a tagged PDF, each room from an odd page on; if
        ``public``, the list of rooms and seats for the door."""
        from coursework.rendering import attendance, pdf

        source = attendance.source(self.template_folders, lists, self.paper, public=public)
        return pdf.compile_pdf(source, self.template_folders)

    def book_pdf(self, book: Book, *, apart: bool = False) -> bytes:
        """Return a book as a tagged PDF with contents and index; ``apart``: its solutions alone."""
        from coursework.rendering import books, pdf

        source = books.typst_source(self.template_folders, book, self.paper, apart=apart)
        return pdf.compile_settled(source, self.template_folders)

    def book_pages(self, book: Book, *, solutions: bool = True) -> Mapping[str, Callable[[], str]]:
        """Return a book as pages by their files, each a function that makes it; they fetch nothing and lead
        to one another."""
        from coursework.rendering import books

        return books.pages(self.template_folders, book, self.paper, solutions=solutions)

    def feedback_notebook(self, sheet: FeedbackSheet | FeedbackPaper) -> str:
        """Feedback as a notebook to read (JSON, nbformat 4.5), with cells to try another variant where one is
        offered."""
        from coursework.rendering import notebook

        return notebook.feedback(self.template_folders, sheet)

    def construction_html(self, construction: Construction) -> str:
        """Return a polygon, its equations, table and steps, as a piece of a web page."""
        from coursework.rendering import html

        return html.construction(self.template_folders, construction)

    def notebook(self, sheet: Handout | Paper, *, collected: bool = False) -> str:
        """Return a handout or a paper as a notebook to hand in (JSON, nbformat 4.5): an answers cell an
        exercise, and nothing that checks an answer; ``collected`` by a platform that knows whose it is."""
        from coursework.rendering import notebook

        made: Callable[..., str] = notebook.paper if _is_paper(sheet) else notebook.notebook
        return made(self.template_folders, sheet, collected=collected)

    def study(self, sheet: StudySheet) -> str:
        """Return a self-study notebook (JSON, nbformat 4.5)."""
        from coursework.rendering import notebook

        return notebook.study(self.template_folders, sheet)

    def lesson(
        self, name: str, text: str, lang: str, install: str, pictures: Mapping[str, Mapping[str, str]]
    ) -> str:
        """Return a lesson's Markdown as a notebook (JSON, nbformat 4.5); ``install`` is the command that
        installs what it runs, ``pictures`` are attached to the cells that show them."""
        from coursework.rendering import notebook

        return notebook.lesson(self.template_folders, name, text, lang, install, pictures)

    def report_html(self, report: ReportContent) -> str:
        """Return a report as one web page that fetches nothing and runs no script."""
        from coursework.rendering import reports

        return reports.page(self.template_folders, report, self.paper)

    def report_pdf(self, report: ReportContent) -> bytes:
        """Return a report as a tagged PDF."""
        from coursework.rendering import pdf, reports

        return pdf.compile_pdf(
            reports.source(self.template_folders, report, self.paper), self.template_folders
        )

    def motion_html(self, animation: Animation, *, is_answered: bool = True) -> str:
        """Return a mechanism in motion as one web page that fetches nothing; its one script is in the
        page."""
        from coursework.rendering import motion_page

        return motion_page.page(self.template_folders, animation, self.paper, is_answered=is_answered)

    def terminal(self, handout: Handout) -> str:
        """Return a handout as plain text."""
        from coursework.rendering import terminal

        return terminal.statement(handout)


def _is_paper(sheet: Any) -> bool:
    from coursework.sheets.paper import FeedbackPaper, Paper, SolutionPaper

    return isinstance(sheet, (Paper, SolutionPaper, FeedbackPaper))


def renderer_of(folder: Folder) -> Renderer:
    """Return the renderer of a course's sheets."""
    return _renderer(folder.template_folders)


def builtin_renderer() -> Renderer:
    """Return a renderer with the templates of the package."""
    return _renderer((builtin_root() / "templates",))


@cache
def _renderer(template_folders: tuple[Path, ...]) -> Renderer:
    return Renderer(template_folders)
