"""View of a mechanism's file for its page: figure, motion, report and variants, in a process of limited
means."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup, escape

from coursework.api import open_course
from coursework.authoring.linkage_editing import lengths, questions, with_lengths, with_questions, with_titles
from coursework.authoring.linkage_files import mechanism_alone, report
from coursework.course.folder import course_folder
from coursework.errors import CourseworkError
from coursework.language.numbers import localise
from coursework.language.words import languages, words
from coursework.markup.symbols import symbol_of
from coursework.messages import Message, localised, messages_in
from coursework.rendering.displayed import DisplayedAnimation
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.scenes.animation import Animation
from coursework.sheets.answer_sheet import answer_sheet

_DRAWN = "# drawing:"  #: begins the first line of a file that was drawn
_PLACE = re.compile(r"([\w.]+\.toml(?:, (?:line|ligne) \d+)?)\s*: ")
_VARIANTS = 3
_LONGEST = 400  #: characters of a fault


@dataclass(frozen=True)
class CheckedBoxes:
    """Check boxes of the page: lengths that vary, and questions as ``key name``; with the titles beside
    them."""

    varying: tuple[str, ...]
    asked: tuple[str, ...]
    titles: tuple[tuple[str, str], ...] = ()  #: by language


@dataclass(frozen=True)
class MechanismView:
    """Piece of a page about a text; or the fault of the text, with its line."""

    text: str
    html: str = ""
    fault: str = ""
    line: str = ""

    @property
    def is_drawn(self) -> bool:
        return self.text.startswith(_DRAWN)

    @property
    def place(self) -> str:
        """Place of the fault in the file, which somebody who draws does not read first."""
        found = _PLACE.match(self.fault) if self.is_drawn else None
        return found[1] if found else ""

    @property
    def problem(self) -> str:
        """Fault without its place where that stands apart."""
        return _PLACE.sub("", self.fault) if self.place else self.fault


def mechanism_view(text: str, name: str, lang: str, choices: CheckedBoxes | None = None) -> MechanismView:
    """Return what the text of a mechanism's file makes.

    Parameters
    ----------
    text
        TOML.
    name
        Name of the exercise, which decides what its variants draw.
    lang
        Language of the page.
    choices
        Check boxes that change the text before; None to leave it.

    Returns
    -------
    The piece of the page; that of the fault if the text makes no exercise.
    """
    if text.startswith(_DRAWN) and "\n[bodies]" not in text:
        return MechanismView(text, fault=words(lang, "site")["mechanisms"]["drawing"]["nothing"])
    with tempfile.TemporaryDirectory() as place, messages_in(lang), np.errstate(all="ignore"):
        path = Path(place) / f"{name}.toml"
        try:
            path.write_text(text, "utf-8")
            if choices is not None:
                text = _changed(path, text, choices)
                path.write_text(text, "utf-8")
            return MechanismView(text, _html(_found(path, text, lang), lang))
        except CourseworkError as error:
            fault = " ".join(localised(error, lang).replace(str(path), f"{name}.toml").split())[:_LONGEST]
        except (ArithmeticError, TypeError, ValueError, RecursionError) as error:
            fault = f"{name}.toml: {type(error).__name__}"
        return MechanismView(text, fault=fault, line=_line(text, fault))


def _html(found: Mapping[str, Any], lang: str) -> Markup:
    names = {
        "lang": lang,
        "words": words(lang),
        "said": words(lang, "site")["mechanisms"],
        "level": 4,
        **found,
    }
    folders = course_folder(None).template_folders
    return Markup(render(environment_of(folders, lang), "site/instructor/_mechanism_view.html.j2", names))


def _changed(path: Path, text: str, choices: CheckedBoxes) -> str:
    with mechanism_alone(path, open_course) as (_, made):
        text = with_lengths(text, [c.name for c in lengths(text, made)], choices.varying)
        return with_questions(with_titles(text, choices.titles), made, choices.asked)


def _line(text: str, fault: str) -> str:
    """Return the line of the text that a fault names."""
    number = re.search(r"(?:line|ligne) (\d+)", fault)
    lines = text.split("\n")
    return lines[int(number[1]) - 1][:200] if number and 0 < int(number[1]) <= len(lines) else ""


def _found(path: Path, text: str, lang: str) -> dict[str, Any]:
    with mechanism_alone(path, open_course) as (exercise, made):
        variants = [exercise.variant(seed, lang) for seed in range(_VARIANTS)]
        said, moves = words(lang, "site")["mechanisms"], exercise.spec.driver or exercise.film
        sheets = [answer_sheet(variant, polygons=False) for variant in variants]
        asked = questions(made)
        rows = [_row(row["property"], row["value"], lang) for row in report(exercise, made, 0)]
        return {
            "rows": rows,
            "moving": _moving(DisplayedAnimation(variants[0]), said["figure"]) if moves else None,
            "sheets": [(sheet, sheet.handout) for sheet in sheets],
            "titles": [
                (each, made.linkage.title.get(each) or made.linkage.title.get("", ""))
                for each in dict.fromkeys([lang, *languages()])
            ],
            "lengths": lengths(text, made),
            "questions": asked,
            "undrawn": [localised(why, lang) for why in dict.fromkeys(made.undrawn.values())],
            "symbols": {
                n: exercise.symbol(n, lang) if n in made.linkage.given else _symbol(n)
                for n in (*made.linkage.given, *(c.name for able in asked.values() for c in able))
            },
        }


def _row(label: Any, value: Any, lang: str) -> tuple[str, str]:
    """Return what a mechanism is in the reader's language: a quantity by its symbol, a number with the
    language's decimal mark."""
    name = label.values.get("name", "")
    types = words(lang, "site")["explore"]["types"]
    said = types.get(str(value)) or (
        localised(value, lang) if isinstance(value, Message) else localise(str(value), lang)
    )
    return localised(label.replacing(name, f"${_symbol(name)}$") if name else label, lang), said


def _symbol(name: str) -> str:
    """Return a quantity that can be asked in LaTeX."""
    for end, mark in (("_ddot", "ddot"), ("_dot", "dot")):
        if name.endswith(end):
            return rf"\{mark}{{{symbol_of(name.removesuffix(end))}}}"
    return symbol_of(name)


def _moving(animation: Animation, label: str) -> dict[str, Any]:
    """Return the figure and, for a script, where its lines and marks are at each instant."""
    drawing = animation.drawing(())
    lines, moving = [], []
    for track in drawing.tracks:
        more = ""
        if track.moves:
            more = f' data-moves="{"transform" if track.mark else "d"}"'
            moving.append(track)
        lines.append(track.svg(animation.first, more))
    count = len(animation.angles)
    frames = [
        [f"translate({t.value(k)})" if t.mark else str(t.value(k)) for t in moving] for k in range(count)
    ]
    crank = [drawing.on_paper(p) for p in animation.crank] if animation.crank else []
    width, height = (f"{x:.6g}" for x in drawing.size)
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" '
        f'aria-label="{escape(label)}"><g fill="none" stroke="#000" '
        f'stroke-linecap="round" stroke-linejoin="round">{"".join(lines)}</g></svg>'
    )
    pivot, way = (
        ([float(x) for x in crank[0]], [[float(x) for x in p] for p in crank[1]]) if crank else ([], [])
    )
    return {
        "svg": Markup(svg),
        "count": count,
        "first": animation.first,
        "data": json.dumps({"frames": frames, "pivot": pivot, "way": way}),
    }
