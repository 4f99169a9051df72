"""Warm-up of a process: it prepares solutions, the course's contents and templates, and where a worker marks
also the lessons, so that the first request is not slow."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from functools import partial
from threading import Event, Thread

from coursework.errors import CourseworkError
from coursework.rendering.html import environment_of
from coursework.selfstudy.worked import theory
from coursework.site.frame.settings import Site
from coursework.site.lessons.lesson_content import lesson_lang, lesson_of
from coursework.site.practice.contents import titles

LOG = logging.getLogger("coursework.site")
_PAUSE = 0.01  #: seconds between two steps, left to requests


def begin_warming(site: Site) -> Event:
    """Start the warm-up in the background, which takes a few seconds; return the event that stops it."""
    stop = Event()
    Thread(target=warm, args=(site, stop), name="warming", daemon=True).start()
    return stop


def warm(site: Site, stop: Event) -> None:
    """Prepare everything until stopped; a fault is logged and reported again at the request that meets it."""
    for piece in _pieces(site):
        if stop.wait(_PAUSE):
            return
        try:
            piece()
        except CourseworkError as fault:
            if stop.is_set():  # the process that makes lessons ended with the site
                return
            LOG.error("not ready ahead: %s", type(fault).__name__)


def _pieces(site: Site) -> Iterator[Callable[[], object]]:
    for lang in site.languages:
        env = environment_of(site.course.folder.template_folders, lang)
        yield partial(titles, site, lang)
        for name in env.list_templates(filter_func=_is_of_pages):
            yield partial(env.get_template, name)
    for exercise in site.course.folder.study_order:
        yield partial(_solved, site, exercise)
    if site.has_worker:
        for lang in site.languages:
            for lesson in site.course.folder.lessons:
                yield partial(lesson_of, site, lesson, lesson_lang(site, lesson, lang))


def _is_of_pages(name: str) -> bool:
    return name.endswith(".html.j2")


def _solved(site: Site, exercise: str) -> None:
    theory(site.course[exercise])
