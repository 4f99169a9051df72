"""Explore: a driven mechanism with freely chosen lengths and speeds, computed again with each change.

Its numbers come from the address, or from a variant that is drawn for this page alone; never from what was
issued.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any
from urllib.parse import urlencode

import numpy as np
from markupsafe import Markup
from starlette.responses import Response

from coursework.database.permissions import Permission
from coursework.errors import CannotAssemble, CourseworkError
from coursework.figures.plot import Axis, Plot
from coursework.language.numbers import localise, plain, significant, unit_text
from coursework.language.words import words
from coursework.scenes.exploration import Curve, Exploration, Parameter, parameters
from coursework.site.frame.pool import FIRST_SEED
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.mechanisms.mechanisms_page import address_of
from coursework.site.papers.assignment_state import published_states

#: Of the variant whose numbers the page begins with: one of no class and of no practice.
SEED = FIRST_SEED - 1
_PLOT_MM = 62.0  #: width of a plot: its numbers can be read on a telephone
_EVERY = 2  #: steps of a turn between two points of a plot
_NOTHING: Mapping[str, Any] = {"closes": False, "figure": "", "plots": (), "numbers": (), "is_jack": False}
EFFECTS = ("position", "velocity", "acceleration", "forces")


def explore(request: Request) -> Response:
    """Return the page of a mechanism with the numbers of the address; to a script only what changes."""
    name, site = str(request.path_params["exercise"]), request.site
    if name not in site.course or not is_explored(site.course[name]):
        raise HTTPException("page", 404)
    if not request.user.may(Permission.PRACTICE_ANY):
        _refuse_in_assignment(request, name)
    typical = site.variant(name, SEED, request.lang)
    choices = parameters(typical.exercise, typical.given)
    texts = {p.name: request.query_params.get(p.name, "") for p in choices}
    read = {p.name: p.value(texts[p.name]) for p in choices if texts[p.name]}
    values = {**usual(typical, choices), **{n: v for n, v in read.items() if v is not None}}
    key = (name, typical.exercise.version, request.lang, tuple(values.values()))
    shown = site.explored.get(key, lambda: shown_mechanism(request.lang, typical, choices, values))
    names = {
        "exercise": name,
        "explore_title": typical.text.title,
        "explored": shown,
        "is_piece": request.is_fragment,
        "rows": [_row(request, typical, p, values[p.name]) for p in choices],
        "beyond": [_bounds(request, typical, p) for p in choices if p.is_beyond(texts[p.name])],
        "refused": [typical.symbol(n) for n, value in read.items() if value is None],
        "address": f"/explore/{name}",
        "mechanism": address_of(request, name),
    }
    return request.render("site/student/explore", **names)


def is_explored(exercise: Any) -> bool:
    """Return True if the page can show an exercise: it states a driver, a figure, and how its points move."""
    return exercise.spec.driver is not None and exercise.spec.figure is not None and exercise.film is None


def address(variant: Any) -> str:
    """Return the address of the page with the numbers of a variant; with its usual ones if the variant's do
    not tell the assembly, since the statement places the crank by another quantity."""
    exercise = variant.exercise
    if exercise.spec.driver.poses is not None and exercise.spec.driver.jack is None:
        return f"/explore/{exercise.name}"
    values = usual(variant, parameters(exercise, variant.given))
    return f"/explore/{exercise.name}?{urlencode({n: plain(v) for n, v in values.items()})}"


def usual(variant: Any, choices: tuple[Parameter, ...]) -> dict[str, Any]:
    """Return the values of a variant, the driver's as well."""
    values, driver = {p.name: variant.given.get(p.name) for p in choices}, choices[-1]
    if driver.name not in variant.given:
        values[driver.name] = variant.exercise.driver_angle(variant.given)
    if driver.unit == "deg":
        values[driver.name] %= 360.0
    return values


def _refuse_in_assignment(request: Request, name: str) -> None:
    """Refuse the mechanism of an exercise while the person may hand in an assignment that asks it."""
    with request.site.store.reading() as connection:
        states = published_states(request, connection)
    if any(s.may_hand_in and name in (s.assignment.stated.get("exercises") or ()) for s in states):
        raise HTTPException("explored_later", 409)


# ------------------------------------------------------------------ what is shown


def shown_mechanism(
    lang: str, typical: Any, choices: tuple[Parameter, ...], values: Mapping[str, Any]
) -> dict[str, Any]:
    """Return figure, sentences, numbers and plots for the values of the parameters."""
    said, driver = words(lang, "site")["explore"], choices[-1]
    try:
        found = Exploration(typical.exercise, typical.given, values, lang)
        drawing = found.drawing()
        sentences, curves = _sentences(said, found, driver, lang), {e: found.curves(e) for e in EFFECTS}
        now = found.values_now()
    except CannotAssemble as fault:
        return {**_NOTHING, "sentences": [said["nowhere"], *_gap(said, Exploration.gap_of(fault), lang)]}
    except CourseworkError:
        return {**_NOTHING, "sentences": [said["undefined"]]}
    exercise = typical.exercise
    symbol, unit = typical.symbol(driver.name), unit_text(driver.unit, lang)
    axis = Axis(symbol, unit, found.steps[::_EVERY])

    def symbol_of(name: str) -> str:
        is_known = name in exercise.quantity_names
        return str(typical.solution_symbol(name) if is_known else said["torque"])

    plots = []
    for effect, rows in curves.items():
        panels = [
            Axis(symbol_of(c.name), unit_text(c.unit, lang), c.values[::_EVERY])
            for c in rows
            if np.isfinite(c.values[::_EVERY]).any()
        ]
        if panels:
            plot = Plot(axis, panels, lang, at=found.at, width=_PLOT_MM).svg()
            plots.append(
                (
                    said[effect],
                    Markup(
                        plot.replace(
                            'role="img"', f'role="img" aria-label="{_heard(said[effect], rows, lang)}"', 1
                        )
                    ),
                )
            )
    numbers = [
        (symbol_of(c.name), unit_text(c.unit, lang), localise(significant(now[c.name], 4), lang))
        for rows in curves.values()
        for c in rows
        if np.isfinite(now[c.name])
    ]
    return {
        **_NOTHING,
        "sentences": sentences,
        "closes": not found.is_open,
        "figure": Markup(_svg(drawing, sentences, found.crank)) if drawing is not None else "",
        "plots": plots,
        "numbers": numbers,
        "driver": symbol,
        "is_jack": driver.unit == "mm",
        "at": f"{localise(significant(found.at, 5), lang)}{'' if driver.unit == 'deg' else ' '}{unit}",
    }


def _heard(title: str, rows: Sequence[Curve], lang: str) -> str:
    """Return what is said of a plot to who does not see it: the range of each quantity."""
    ranges = [
        f"{c.name} {localise(significant(float(np.nanmin(c.values)), 3), lang)} … "
        f"{localise(significant(float(np.nanmax(c.values)), 3), lang)} {unit_text(c.unit, lang)}"
        for c in rows
        if np.isfinite(c.values).any()
    ]
    return escape(f"{title}: {'; '.join(ranges)}")


def _sentences(said: Mapping[str, Any], found: Exploration, driver: Parameter, lang: str) -> list[str]:
    """Return what is said of the mechanism: its type, where it closes, and by how much it does not."""
    unit = unit_text(driver.unit, lang)
    unit = unit if driver.unit == "deg" else f" {unit}"
    ranges = [
        said["range"].format(*(f"{localise(significant(v, 5), lang)}{unit}" for v in ends))
        for ends in found.ranges
    ]
    sentences = [said["types"][found.type]] if found.type else []
    if not ranges:
        sentences.append(said["nowhere"])
    elif found.closes.all():
        sentences.append(said["jack_travels" if driver.unit == "mm" else "turns"])
    else:
        sentences.append(said["closes"].format(said["or"].join(ranges)))
    if found.is_open:
        sentences += _gap(said, found.gap, lang)
    return sentences


def _gap(said: Mapping[str, Any], gap: float | None, lang: str) -> list[str]:
    return [said["gap"].format(localise(significant(gap, 3), lang))] if gap is not None else [said["open"]]


def _svg(drawing: Any, sentences: list[str], crank: tuple[complex, complex] | None) -> str:
    """Return the figure; for the script, the places of the crank's pivot and pin in it, mm."""
    places = " ".join(f"{x:.2f}" for p in crank or () for x in drawing.on_paper(p))
    width, height = (f"{x:.6g}" for x in drawing.size)
    label = escape(" ".join(sentences))
    lines = "".join(
        track.svg(0) for track in drawing.tracks if not (track.effect == "position" and track.mark)
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" '
        f'aria-label="{label}" '
        f'data-crank="{places}"><g fill="none" stroke="#000" stroke-linecap="round" '
        f'stroke-linejoin="round">{lines}</g></svg>'
    )


def _row(request: Request, typical: Any, parameter: Parameter, value: Any) -> dict[str, Any]:
    """Return a row of the form: a slider with its number, or a choice."""
    unit = unit_text(parameter.unit, request.lang) if parameter.unit != "1" else ""
    row = {"name": parameter.name, "symbol": typical.symbol(parameter.name), "unit": unit}
    if parameter.choices:
        cases = [(case, typical.label(parameter.name, case)) for case in parameter.choices]
        return {**row, "value": value, "cases": cases}
    bounds = {n: plain(getattr(parameter, n)) for n in ("low", "high", "step")}
    number = plain(round(float(value), 6))
    return {**row, "value": number, "shown": localise(number, request.lang), **bounds, "cases": ()}


def _bounds(request: Request, typical: Any, parameter: Parameter) -> tuple[str, str, str]:
    """Return the symbol of a parameter and its bounds as they are read, the upper one with its unit."""
    low, high = (localise(plain(bound), request.lang) for bound in (parameter.low, parameter.high))
    unit = unit_text(parameter.unit, request.lang)
    return typical.symbol(parameter.name), low, f"{high}{'' if unit == '°' else ' '}{unit}".strip()


ROUTES = (Route("/explore/{exercise}", explore, Permission.OWN, limit="explore"),)
