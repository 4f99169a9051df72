"""Feedback on an answer, as outputs of nbgrader's cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coursework.course.course import Course
from coursework.gradebook.feedback_sheets import feedback_sheet
from coursework.gradebook.graded_sheet import Graded
from coursework.language.words import words
from coursework.markup.markdown import html_text
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.rendering.renderer import renderer_of

Output = dict[str, Any]


def outputs(course: Course, graded: Graded) -> dict[str, list[Output]]:
    """Return for each part the outputs of its grade cell without the points. They do not give the right
    answer away."""
    sheet = feedback_sheet(course, graded)
    lang = sheet.handout.lang
    env = environment_of(renderer_of(course.folder).template_folders, lang)
    names = {"words": words(lang), "lang": lang}
    return {
        line.question.id: [
            display_output(
                render(env, "platform/nbgrader_mark.html.j2", {**names, "line": line}),
                graded.lines[line.question.id].feedback,
            )
        ]
        for line in sheet.lines
    }


def display_output(html: str, plain: str) -> Output:
    """Return an output of a cell as HTML, with the plain text for viewers that show no HTML."""
    return {"output_type": "display_data", "metadata": {}, "data": {"text/html": html, "text/plain": plain}}


def points_output(value: float) -> Output:
    """Return the points as the result of a cell; nbgrader takes the number as the cell's partial credit."""
    return {
        "output_type": "execute_result",
        "execution_count": None,
        "metadata": {},
        "data": {"text/plain": repr(float(value))},
    }


def sentences(lang: str, key: str, texts: Sequence[str]) -> list[Output]:
    """Return one sentence per text, by the key ``rejected`` or ``note``. Text that a student wrote is
    escaped."""
    lines = [str(words(lang)["nbgrader"][key]).format(**{_FIELDS[key]: text}) for text in texts]
    html = "\n".join(f"<p>{html_text(line, lang)}</p>" for line in lines)
    return [display_output(html, "\n".join(lines))] if lines else []


_FIELDS = {"rejected": "why", "note": "what"}
