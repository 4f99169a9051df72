"""Changes to the text of a mechanism's file: which given quantities vary, and what is asked."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

from coursework.linkages.compiled import CompiledLinkage
from coursework.linkages.entries import GROUND
from coursework.linkages.vectors import POLYGONS
from coursework.system.toml_files import toml_value

SPREAD, STEP = 0.2, 5.0  #: of a length that varies: its share to both sides, and its step in mm
_LISTS = ("positions", "velocities", "accelerations", "polygon", "instant_centres")
_FIXED = r'^(\s*{}\s*=\s*)"([\d.]+) mm"'
_RANGE = r'^(\s*{}\s*=\s*)\{{\s*from\s*=\s*"([\d.]+) mm",\s*to\s*=\s*"([\d.]+) mm"[^}}]*\}}'


class CheckBox(NamedTuple):
    """Question or length that can be chosen: its name, and whether it is."""

    name: str
    is_chosen: bool


def lengths(text: str, made: CompiledLinkage) -> list[CheckBox]:
    """Return the given lengths that a line of the text states by numbers, and whether they vary; one that
    drives is none of them."""
    found = []
    for name, entry in made.linkage.given.items():
        if entry.unit == "mm" and name != made.linkage.moved:
            is_range = re.search(_RANGE.format(re.escape(name)), text, re.MULTILINE) is not None
            if is_range or re.search(_FIXED.format(re.escape(name)), text, re.MULTILINE):
                found.append(CheckBox(name, is_range))
    return found


def with_lengths(text: str, known: Collection[str], varying: Collection[str]) -> str:
    """Return the text with some lengths in ranges around their values and the other ones fixed in the middle
    of theirs.

    Parameters
    ----------
    text
        The file.
    known
        Names of the lengths that may be changed.
    varying
        Those that vary from now on.

    Returns
    -------
    The text; a range that stands already stays as it is.
    """
    for name in known:
        if name in varying:
            text = re.sub(_FIXED.format(re.escape(name)), _range, text, count=1, flags=re.MULTILINE)
        else:
            text = re.sub(_RANGE.format(re.escape(name)), _middle, text, count=1, flags=re.MULTILINE)
    return text


def _range(match: re.Match[str]) -> str:
    value = float(match[2])
    reach = max(STEP, round(SPREAD * value / STEP) * STEP)
    middle = max(round(value / STEP), 2) * STEP
    low = max(STEP, middle - reach)
    return f'{match[1]}{{ from = "{low:g} mm", to = "{middle + reach:g} mm", step = "{STEP:g} mm" }}'


def _middle(match: re.Match[str]) -> str:
    middle = round((float(match[2]) + float(match[3])) / 2 / STEP) * STEP
    return f'{match[1]}"{middle or STEP:g} mm"'


def with_titles(text: str, titles: Sequence[tuple[str, str]]) -> str:
    """Return the text with other titles, by language, in place of the line that states them; without any as
    it is."""
    stated = {lang: title for lang, title in titles if title}
    if not stated:
        return text
    line = f"title = {toml_value(stated)}"
    changed, count = re.subn(r"^title\s*=.*$", lambda _: line, text, count=1, flags=re.MULTILINE)
    return changed if count else f"{line}\n{text}"


def questions(made: CompiledLinkage) -> dict[str, list[CheckBox]]:
    """Return what can be asked of a mechanism, by key of ``[ask]``, and what is."""
    linkage, formulas = made.linkage, made.formulas
    turns = [*formulas.followed_turns]
    points = [p for p in linkage.points if p not in linkage.ground]
    slides = [s.distance for s in linkage.followed_slides]
    able: dict[str, Sequence[str]] = {
        "mobility": ("mobility",),
        "class": () if linkage.gears else ("class",),
        "positions": [*turns, *slides, *points],
        "equations": ("equations",) if any(formulas.closure(g) for g in formulas.groups) else (),
    }
    if linkage.speed:
        for key, stem, mark, end in (
            ("velocities", "omega", "V_", "_dot"),
            ("accelerations", "alpha", "a_", "_ddot"),
        ):
            rates = [t.replace("theta", stem, 1) for t in turns]
            # A rate that follows from nothing is an easy question; one that comes out as zero, none.
            still = made.equal_in_all([(rate, "0") for rate in rates if formulas.quantities[rate].needs])
            rates = [rate for rate in rates if (rate, "0") not in still]
            able[key] = [*rates, *(f"{s}{end}" for s in slides), *(f"{mark}{p}" for p in points)]
        able["polygon"] = [kind for kind in POLYGONS if kind not in made.undrawn]
        bodies = {"1": GROUND, **{b: b for b in linkage.bodies if b.isdigit() and len(b) == 1}}
        centres = [f"I{i}{j}" for i in bodies for j in bodies if i < j and i != "1"]
        # Of bodies that are turned alike it is at infinity.
        apart = {f"I1{j}": (formulas.omega(j), "0") for j in bodies if j != "1"}
        apart |= {c: (formulas.omega(c[1]), formulas.omega(c[2])) for c in centres}
        alike = made.equal_in_all([*apart.values()])
        able["instant_centres"] = [c for c, (i, j) in apart.items() if i != j and (i, j) not in alike]
        turning = [b for b in linkage.bodies if formulas.turns[b] in turns]
        slid = [s for s in linkage.followed_slides if s.on == GROUND]
        able["advantage"] = ("advantage",) if turning or slid else ()
    return {
        key: [CheckBox(name, _is_asked(linkage.ask, key, name)) for name in names]
        for key, names in able.items()
        if names
    }


def _is_asked(ask: Mapping[str, Any], key: str, name: str) -> bool:
    return name in ask.get(key, ()) if key in _LISTS else bool(ask.get(key, False))


def with_questions(text: str, made: CompiledLinkage, chosen: Collection[str]) -> str:
    """Return the text with other questions.

    Parameters
    ----------
    text
        The file.
    made
        The mechanism that it states.
    chosen
        Questions as ``key name``: those of :func:`questions`.

    Returns
    -------
    The text, with a new table ``[ask]`` in the order of the one before; what no check box says, such as
    loads, weights and single coordinates, stays.
    """
    asked = made.linkage.ask
    able = {key: [box.name for box in boxes] for key, boxes in questions(made).items()}
    table: dict[str, Any] = {}
    for key in dict.fromkeys([*asked, *able]):
        names = able.get(key, ())
        if key in _LISTS:
            listed = dict.fromkeys([*asked.get(key, ()), *names])
            table[key] = [name for name in listed if name not in names or f"{key} {name}" in chosen]
        elif not names or f"{key} {names[0]}" in chosen:
            table[key] = asked.get(key) or True
    weights = asked.get("points", {})
    table["points"] = {name: weights[name] for name in weights if _box(made, name, able) in ("", *chosen)}
    lines = [f"{key} = {toml_value(value)}" for key, value in table.items() if value]
    before, after = _parted(text)
    if not any(value for key, value in table.items() if key != "points"):
        lines.append("mobility = true")
    rest = f"\n{after}" if after else ""
    return "\n".join([before.rstrip("\n"), "", "[ask]", *lines]) + "\n" + rest


def _box(made: CompiledLinkage, question: str, able: Mapping[str, Sequence[str]]) -> str:
    """Return the check box of a question, as ``key name``; '' if it has none."""
    drawn = {part: each.kind for each in made.questions.polygons for part in (each.scale, *each.parts)}
    name = drawn.get(
        question, "equations" if question.startswith("loop_") else question.removeprefix("mechanism_")
    )
    return next((f"{key} {name}" for key, names in able.items() if name in names), "")


def _parted(text: str) -> tuple[str, str]:
    """Return the text before the table of questions and the text after it, with the comments that stand above
    what follows."""
    lines, headings = text.split("\n"), []
    for number, line in enumerate(lines):
        if heading := re.match(r"\s*\[\[?\s*([\w.-]+)\s*\]", line):
            headings.append((number, heading[1].split(".")[0] == "ask"))
    start = next((number for number, is_ask in headings if is_ask), len(lines))
    end = next((number for number, is_ask in headings if number > start and not is_ask), len(lines))
    while end < len(lines) and lines[end - 1].startswith("#"):
        end -= 1
    return "\n".join(lines[:start]), "\n".join(lines[end:])
