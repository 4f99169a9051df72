"""Pages in the frames of platforms, rendered with the templates of a course."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from coursework.language.words import words
from coursework.rendering import papers
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of, script_digest
from coursework.rendering.surface import kinds_of_surfaces
from coursework.sheets.paper import FeedbackPaper, Paper
from coursework.site.frame.pages import SitePages

Filled = Mapping[str, Sequence[str]]


@dataclass(frozen=True)
class SheetForm:
    """Surroundings of a sheet that is to be submitted, or of its feedback."""

    action: str
    csrf_token: str
    number: int = 1
    filled: Filled = field(default_factory=dict)  #: values of the input fields, by their names
    notes: tuple[str, ...] = ()  #: sentences above the sheet, Markdown
    unread: tuple[str, ...] = ()  #: of answers that could not be read
    may_insist: bool = False
    more: tuple[tuple[str, str], ...] = ()  #: further links: address and text
    leave: str = ""  #: address of the course, opened outside the frame


class LTIPages(SitePages):
    """Renderer of the pages of one course."""

    def page(self, template: str, lang: str, names: Mapping[str, Any]) -> str:
        """Return the page of a template such as ``lti_pick``."""
        texts = words(lang)
        usual = {"lang": lang, "words": texts, "said": texts["lti"], "paper": "a4", "title": ""}
        return self.rendered(template, lang, {**usual, **names})

    def digest(self, script: str) -> str:
        """Return the digest by which a policy allows a script among the templates, ``sha256-…``."""
        return script_digest(environment_of(self._folder.template_folders, "en"), script)

    def sheet(self, paper: Paper, form: SheetForm) -> str:
        """Return a paper with input fields for the answers."""
        return self._page("platform/lti_paper", paper, form)

    def feedback(self, paper: FeedbackPaper, form: SheetForm) -> str:
        """Return the feedback page of a submission."""
        return self._page("platform/lti_paper_feedback", paper, form)

    def _page(self, template: str, paper: Paper | FeedbackPaper, form: SheetForm) -> str:
        env = environment_of(self._folder.template_folders, paper.heading.lang)
        draws = kinds_of_surfaces(paper.handouts) if isinstance(paper, Paper) else ()
        files = [{"filled": form.filled, "draws": draws}] * len(papers.sheets_of(paper))
        names = papers.context(paper, "html.j2", partial(render, env), files)
        more = {
            "image": papers.image,
            "form": form,
            "filled": form.filled,
            "keeping": "",
            "draws": draws,
            "file": self.file,
        }
        return self.page(template, paper.heading.lang, {**names, **more})
