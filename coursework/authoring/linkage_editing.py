"""Changes to the text of a mechanism's file: which given quantities vary, and what is asked."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

from coursework.linkages.compiled import CompiledLinkage
from coursework.linkages.entries import GROUND
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
    """Return the given lengths that a line of the text states by numbers, and whether they vary."""
    found = []
    for name, entry in made.linkage.given.items():
        if entry.unit == "mm":
            is_range = re.search(_RANGE.format(re.escape(name)), text, re.MULTILINE) is not None
            if is_range or re.search(_FIXED.format(re.escape(name)), text, re.MULTILINE):
                found.append(CheckBox(name, is_range))
    return found


def with_lengths(text: str, known: Collection[str], varying: Collection[str]) -> str:
    """Return the text with some lengths in ranges around their values and the other ones fixed in the middle of theirs.

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
    """Return the text with other titles, by language, in place of the line that states them; without any as it is."""
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
    }
    if linkage.speed:
        for key, stem, mark, end in (
            ("velocities", "omega", "V_", "_dot"),
            ("accelerations", "alpha", "a_", "_ddot"),
        ):
            rates = [t.replace("theta", stem, 1) for t in turns]
            able[key] = [*rates, *(f"{s}{end}" for s in slides), *(f"{mark}{p}" for p in points)]
        able["polygon"] = ("velocity", "acceleration") if linkage.drive.kind == "turn" else ()
        bodies = {"1": GROUND, **{b: b for b in linkage.bodies if b.isdigit() and len(b) == 1}}
        centres = [f"I{i}{j}" for i in bodies for j in bodies if i < j and i != "1"]
        able["instant_centres"] = [
            f"I1{j}" for j in bodies if j != "1" and formulas.turns[j].startswith("theta")
        ] + [
            c for c in centres if formulas.turns[c[1]] != formulas.turns[c[2]]
        ]  # of bodies that are turned alike it is at infinity
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
    The text, with a new table ``[ask]``; what a check box does not say there, such as loads and weights, stays.
    """
    lines = ["[ask]"]
    for key, able in questions(made).items():
        names = [c.name for c in able if f"{key} {c.name}" in chosen]
        if key in _LISTS and names:
            listed = ", ".join(f'"{name}"' for name in names)
            lines.append(f"{key} = [{listed}]")
        elif names:
            same = made.linkage.ask.get(key)
            lines.append(f'{key} = "{same}"' if isinstance(same, str) and same else f"{key} = true")
    before, after, kept = _parted(text)
    weights = [line for line in kept if line.lstrip().startswith("torque")]
    if len(lines) + len(weights) == 1:
        lines.append("mobility = true")
    rest = f"\n{after}" if after else ""
    return "\n".join([before.rstrip("\n"), "", *lines, *weights]) + "\n" + rest


def _parted(text: str) -> tuple[str, str, list[str]]:
    """Return the text before the table of questions, the text after it, and the lines of the table."""
    lines = text.split("\n")
    start = next((k for k, line in enumerate(lines) if re.match(r"\s*\[ask\]", line)), len(lines))
    end = next((k for k in range(start + 1, len(lines)) if re.match(r"\s*\[[a-z]", lines[k])), len(lines))
    return "\n".join(lines[:start]), "\n".join(lines[end:]), lines[start + 1 : end]
