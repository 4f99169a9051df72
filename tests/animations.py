"""The exercises of the course that move, and their animations, made once each."""

from __future__ import annotations

from html.parser import HTMLParser

import numpy as np

import coursework
from coursework.rendering.displayed import DisplayedAnimation as Animation
from coursework.scenes.scenes import Scene

COURSE = coursework.open_course()
DRIVEN = [n for n in COURSE.names if COURSE[n].spec.driver is not None]
MOVING = [n for n in COURSE.names if COURSE[n].is_animated]
FILMED = [n for n in MOVING if COURSE[n].film is not None]
WITH_POINTS = [n for n in MOVING if COURSE[n].solution.motion or COURSE[n].solution.mechanism]
SVG = "{http://www.w3.org/2000/svg}"
_kept: dict[tuple, Animation] = {}


def animation(name, seed=1, lang="fr", effects=()):
    key = (name, seed, lang, tuple(effects))
    if key not in _kept:
        plain = COURSE[name].variant(seed, lang).animation()
        shown = plain.available if effects == "all" else effects
        _kept[key] = COURSE[name].variant(seed, lang).animation(shown, count=36)
    return _kept[key]


def points_at(exercise, given, angle):
    """The points that a solution moves, or those of its mechanism, the driver at an angle or at many,
    degrees."""
    solution = exercise.solution
    if solution.motion is None:
        return Scene(exercise, given).moving_points(np.atleast_1d(angle))
    given = {**given, **exercise.posed(given, angle)}
    graph = solution.graph.with_functions({"motion": solution.motion})
    known = {n: v for n, v in given.items() if n in graph.leaves or n in graph.quantities}
    return graph.evaluate(("motion",), known, exercise.spec.effects)["motion"]


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.data, self._in_data = [], "", False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self._in_data = dict(attrs).get("id") == "motion-data"

    def handle_data(self, data):
        if self._in_data:
            self.data += data

    def handle_endtag(self, tag):
        self._in_data = False
