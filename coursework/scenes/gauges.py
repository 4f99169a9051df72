"""Numbers beside a moving picture: a quantity or a vector's length at every instant, as printed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from coursework.language.numbers import localise, significant, unit_text
from coursework.model import Driver
from coursework.scenes.effects import KINEMATIC, of_exercise
from coursework.scenes.reel import Reel

EFFECTS = KINEMATIC
UNIT = {"velocity": "mm/s", "acceleration": "mm/s^2", "coriolis": "mm/s^2"}

#: Of a point: its name, the effect, complex over the instants.
Vectors: TypeAlias = tuple[str, str, np.ndarray]


@dataclass(frozen=True)
class Gauge:
    """Quantity over the instants, as printed; empty where it does not exist."""

    symbol: str
    unit: str
    effects: tuple[str, ...]
    point: str  #: the point whose vector it measures, if any
    values: tuple[str, ...]


def gauges(reel: Reel, vectors: Sequence[Vectors]) -> tuple[Gauge, ...]:
    """Return the quantities of the effects over the instants.

    ``vectors`` are those of the points, each with its name and effect.
    """
    variant, exercise = reel.variant, reel.variant.exercise
    effects_of: dict[str, list[str]] = {}
    for effect in EFFECTS:
        for name in _measured(reel, effect):
            effects_of.setdefault(name, []).append(effect)
    results = {}
    if effects_of:
        posed = {} if reel.film is not None else exercise.posed(reel.variant.given, reel.angles)
        given = {**reel.variant.used, **posed}
        results = exercise.solve(**given, only=tuple(effects_of), effects=())
    text = [
        _gauge(reel, variant.solution_symbol(name), exercise.units.get(name, "1"), effects_of[name], value)
        for name, value in results.items()
    ]
    known_values = {gauge.symbol for gauge in text}
    if any("coriolis" in gauge.effects for gauge in text):
        known_values |= {_symbol("coriolis", name) for name, _, _ in vectors}
    return (*text, *(gauge for gauge in _norms(reel, vectors) if gauge.symbol not in known_values))


def _measured(reel: Reel, effect: str) -> Sequence[str]:
    """Return the quantities of an effect; in a film, only those that change."""
    exercise = reel.variant.exercise
    film = reel.film
    driver = exercise.spec.driver if film is None else Driver(film.angle, film.speed)
    return () if driver is None else of_exercise(exercise, driver).get(effect, ())


def _norms(reel: Reel, vectors: Sequence[Vectors]) -> list[Gauge]:
    """Return the length of every vector, under its name in the course."""
    return [
        _gauge(reel, _symbol(effect, name), UNIT[effect], (effect,), np.abs(v), name)
        for name, effect, v in vectors
    ]


def _gauge(reel: Reel, symbol: str, unit: str, effects: Sequence[str], value: Any, point: str = "") -> Gauge:
    values = np.broadcast_to(value, reel.angles.shape).astype(float)
    unit = unit_text(unit, reel.variant.lang)
    # Rounding noise where a quantity vanishes is not worth its digits.
    noise = 1e-12 * float(np.nanmax(np.abs(values), initial=0.0))
    return Gauge(
        symbol,
        unit,
        tuple(effects),
        point,
        tuple(number(0.0 if abs(v) < noise else v, reel.variant.lang) for v in values),
    )


def number(value: float, lang: str) -> str:
    """Format a value in the language; empty where it does not exist."""
    return localise(significant(value), lang) if math.isfinite(value) else ""


def _symbol(effect: str, point: str) -> str:
    """Return LaTeX of a vector's length in the course's notation: ``v_B``, ``a_{A,c}``."""
    index = f"{point},c" if effect == "coriolis" else point
    letter = "v" if effect == "velocity" else "a"
    return f"{letter}_" + (index if len(index) == 1 else f"{{{index}}}")
