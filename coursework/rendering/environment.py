"""Jinja2 environments: what a template prints is always text of its back end.

Every value that a template prints is escaped for the back end, unless one of the filters made it. A name
with a ``#`` or a ``<`` in it prints as itself, in every template, whoever wrote it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from jinja2 import (
    BytecodeCache,
    Environment,
    FileSystemLoader,
    StrictUndefined,
    TemplateError,
    TemplateNotFound,
    Undefined,
)
from jinja2.bccache import Bucket
from markupsafe import Markup

from coursework.errors import BadCourse, BadStatement
from coursework.language.words import words
from coursework.marking.feedback import localised
from coursework.markup.formulas import after_number
from coursework.rendering import feedback, views

Writer = Callable[[str, str], str]

_FOLDER_WORDS = re.compile("^_?(?:(?:book|desk|feedback|motion|paper|platform|scan|sheet|site)_)*")


class _CompiledTemplates(BytecodeCache):
    """Compiled templates of one back end and language, shared by the courses that read the same files."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[str, Any]] = {}

    def load_bytecode(self, bucket: Bucket) -> None:
        checksum, code = self._known.get(bucket.key, ("", None))
        if checksum == bucket.checksum:
            bucket.code = code

    def dump_bytecode(self, bucket: Bucket) -> None:
        self._known[bucket.key] = bucket.checksum, bucket.code


@lru_cache(maxsize=64)
def _compiled(text: Writer, lang: str) -> _CompiledTemplates:
    return _CompiledTemplates()


def environment(
    folders: Sequence[Path],
    lang: str,
    text: Writer,
    filters: Mapping[str, Callable[..., str]],
    marks: Mapping[str, Any] | None = None,
) -> Environment:
    """Return an environment for one back end and one language.

    ``text`` escapes plain text. ``filters`` make text of the back end; the views' own filters
    (``points``, ``verdict``, ...) make plain text, escaped like any other. ``marks`` are what opens and
    closes an expression, a block and a comment, where the usual ones mean something to the back end.
    """

    def printed(value: object) -> object:
        return value if isinstance(value, (Markup, Undefined)) else escaped(str(value))

    @lru_cache(maxsize=4096)
    def escaped(value: str) -> Markup:
        return Markup(text(value, lang))

    _check_places(folders)
    env = Environment(
        loader=FileSystemLoader([str(folder) for folder in folders]),
        undefined=StrictUndefined,
        autoescape=True,
        finalize=printed,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        bytecode_cache=_compiled(text, lang),
        **(marks or {}),
    )
    env.filters.update({name: _marked(make) for name, make in filters.items()})
    env.filters.update(
        points=lambda points: views.points_text(points, lang),
        points_number=lambda points: views.points_number(points, lang),
        given_formula=views.given_formula,
        given_words=lambda given: views.given_words(given, lang),
        worked=lambda solution, prefix: views.worked(solution, lang, prefix),
        verdict=lambda verdict: feedback.verdict_word(verdict, lang),
        sign=feedback.sign,
        sign_mark=lambda one: words(lang)["feedback"]["sign_marks"][one],
        tally=feedback.tally,
        called=feedback.question_heading,
        right=feedback.right_answer,
        read_otherwise=feedback.read_otherwise,
        reading=lambda read_as: localised(read_as, lang),
        is_brief=lambda line, prefix="": feedback.is_brief(line, lang, prefix),
        is_long=feedback.is_long,
        note=lambda line, prefix="": feedback.note(line, lang, prefix),
        hint=lambda line, prefix="": feedback.hint(line, lang, prefix),
        command=feedback.command,
        lesson=lambda lesson: feedback.lesson_words(lesson, lang),
        value_formula=views.value_formula,
        one_line=views.chain_on_one_line,
        many_lines=views.chain_on_lines,
        chain=views.chain,
        is_short=lambda step: views.is_short(step, lang),
        fits_on_lines=lambda step: views.fits_on_lines(step, lang),
        quantity_words=lambda question: views.quantity_words(question, lang),
        margin_words=lambda answer: views.margin_words(answer, lang),
        summary_row=lambda answer: views.summary_row(answer, lang),
        polygon_row=lambda row: views.polygon_row(row, lang),
        answer_comment=lambda question, prefix="": views.answer_comment(question, lang, prefix),
        offered=views.offered,
        columns=lambda question: views.columns(question, lang),
        column_share=lambda question: views.column_of(question, lang),
        python_name=views.python_name,
        after_number=after_number,
        fill=_filled,
    )
    return env


def _filled(pattern: str, *parts: object) -> str:
    """Return a pattern with its parts; as markup where a part is markup, with the others escaped."""
    is_markup = any(isinstance(part, Markup) for part in parts)
    return (
        Markup(pattern).format(*parts)
        if is_markup and not isinstance(pattern, Markup)
        else pattern.format(*parts)
    )


def _check_places(folders: Sequence[Path]) -> None:
    """Raise for a course's template beside the folders, where templates had names as ``_sheet_body``: no page
    reads it there."""
    for file in (path for folder in folders for path in folder.glob("*.j2")):
        name = _FOLDER_WORDS.sub("", file.name)
        found = {
            path.relative_to(folder).as_posix() for folder in folders for path in folder.glob(f"*/**/*{name}")
        }
        if meant := sorted(place for place in found if place.rpartition("/")[2].lstrip("_") == name):
            raise BadCourse(
                "{file}: templates are in folders, so this one is not read; move it to {places}",
                file=str(file),
                places=" | ".join(meant),
            )


def _marked(make: Callable[..., str]) -> Callable[..., Markup]:
    return lambda *args, **options: Markup(make(*args, **options))


def render(env: Environment, template: str, names: Mapping[str, object]) -> str:
    """One template with these names; what is wrong in it is said with its file."""
    try:
        return env.get_template(template).render(names)
    except TemplateNotFound as missing:
        folders = env.loader.searchpath if isinstance(env.loader, FileSystemLoader) else ()
        raise BadCourse(f"no template {missing.name!r} in {', '.join(folders)}") from None
    except TemplateError as wrong:
        raise BadStatement(f"template {template}: {wrong}") from wrong
