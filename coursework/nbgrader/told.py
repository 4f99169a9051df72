"""What a student is told of an answer, in the outputs of nbgrader's cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coursework.course.course import Course
from coursework.gradebook.feedback_sheets import feedback_sheet
from coursework.gradebook.graded import Graded
from coursework.language.words import words
from coursework.markup.markdown import html_text
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.rendering.renderer import renderer_of

Output = dict[str, Any]


def outputs(course: Course, graded: Graded) -> dict[str, list[Output]]:
    """For each part, the outputs of its grade cell but the points: what became of the answer. The right one is not told."""
    sheet = feedback_sheet(course, graded)
    lang = sheet.handout.lang
    env = environment_of(renderer_of(course.folder).template_folders, lang)
    names = {"words": words(lang), "lang": lang}
    return {
        line.question.id: [
            shown(
                render(env, "nbgrader_mark.html.j2", {**names, "line": line}),
                graded.lines[line.question.id].feedback,
            )
        ]
        for line in sheet.lines
    }


def shown(html: str, plain: str) -> Output:
    """What a cell shows, and what stands for it where no page is shown."""
    return {"output_type": "display_data", "metadata": {}, "data": {"text/html": html, "text/plain": plain}}


def points(value: float) -> Output:
    """The points as what a cell computes: nbgrader takes the number as the cell's partial credit."""
    return {
        "output_type": "execute_result",
        "execution_count": None,
        "metadata": {},
        "data": {"text/plain": repr(float(value))},
    }


def said(lang: str, key: str, texts: Sequence[str]) -> list[Output]:
    """A sentence for each of some texts, ``rejected`` or ``note``; what a student wrote in them stays text."""
    sentences = [str(words(lang)["nbgrader"][key]).format(**{_PLACES[key]: text}) for text in texts]
    html = "\n".join(f"<p>{html_text(one, lang)}</p>" for one in sentences)
    return [shown(html, "\n".join(sentences))] if sentences else []


_PLACES = {"rejected": "why", "note": "what"}
