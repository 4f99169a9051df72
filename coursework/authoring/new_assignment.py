"""A new assignment's file, which works as it is."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.errors import BadInput
from coursework.language.words import words
from coursework.system.writing import write_whole


def new_assignment(path: Path, course: Course[Any], names: Sequence[str], langs: Sequence[str]) -> Path:
    """Write an assignment of some exercises; gives the file.

    Raises
    ------
    BadInput
        There is such a file, or no exercise is named.
    UnknownName
        An exercise that the course does not have.
    """
    if not names:
        some = " ".join(course.names[:3])
        raise BadInput(f"an assignment asks exercises: coursework new assignment {path} {some}")
    if path.exists():
        raise BadInput(f"{path} exists already; choose another name")
    asked = "".join(_asked(course, name) for name in names)
    write_whole(path, (_head(path.stem, course, langs) + asked).encode("utf-8"))
    return path


def _head(stem: str, course: Course[Any], langs: Sequence[str]) -> str:
    said = {lang: words(lang)["assignment"] for lang in langs}
    title = _texts({lang: f"{s['title']} ({stem})" for lang, s in said.items()})
    return "\n".join([
        f"title = {title}",
        f"course = {_texts({lang: course.folder.title(lang) for lang in langs})}",
        "# date = 2026-12-04",
        '# duration = "1 h 30"',
        f"# instructions = {_texts({lang: s['instructions'] for lang, s in said.items()})}",
        "# cover = true",
        "mark = { of = 20, step = 0.5 }",
        'versions = "each"      # 4: versions A to D, dealt out; 1: the same for all',
        '# identity = ["number", "group"]      # columns of the roster',
        '# roster = "class.csv"',
        f'lang = "{",".join(langs[:1])}"',
        f'out = "{stem}"',
        *(f"# {said[lang]['secret_line']}" for lang in langs),
        f'secret = "{Secret.new().text}"',
        "",
    ])  # fmt: skip


def _texts(texts: dict[str, str]) -> str:
    """A text, or one a language, as TOML."""
    if len(set(texts.values())) == 1:
        return json.dumps(next(iter(texts.values())), ensure_ascii=False)
    return (
        "{ " + ", ".join(f"{lang} = {json.dumps(t, ensure_ascii=False)}" for lang, t in texts.items()) + " }"
    )


def _asked(course: Course[Any], name: str) -> str:
    parts = ", ".join(f'"{p.id}"' for p in course[name].spec.parts if not p.by_request)
    return f'\n[[exercises]]\nname = "{name}"\n# parts = [{parts}]\n# points = 6\n'
