"""A new assignment's file, which works as it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.errors import BadInput
from coursework.language.words import words
from coursework.messages import language_of_messages
from coursework.system.toml_files import toml_value
from coursework.system.writing import write_whole


def new_assignment(
    path: Path,
    course: Course[Any],
    names: Sequence[str],
    langs: Sequence[str] | None = None,
    around: str = "",
) -> Path:
    """Write an assignment of some exercises; gives the file.

    Its sheets are in ``langs``; by default in the language ``around`` where all its exercises speak it,
    else in the course's own. Its titles stand in every language of the exercises, for students whose line of
    the roster says another.

    Raises
    ------
    BadInput
        There is such a file, no exercise is named, or one does not have a given language.
    UnknownName
        An exercise that the course does not have.
    """
    if not names:
        some = " ".join(course.names[:3])
        raise BadInput(
            "an assignment needs exercises: coursework new assignment {path} {some}", path=path, some=some
        )
    if path.exists():
        raise BadInput("{path} exists already; choose another name", path=path)
    exercises = "".join(_exercise_entry(course, name) for name in names)
    for lang in langs or ():
        if silent := [name for name in names if lang not in course[name].languages]:
            speaks = ", ".join(course[silent[0]].languages)
            raise BadInput(
                "{silent} is not available in {lang!r}, only in {speaks}",
                silent=silent[0],
                lang=lang,
                speaks=speaks,
            )
    common = [code for code in course.folder.languages if all(code in course[n].languages for n in names)]
    chosen = tuple(
        langs or [code for code in (around, course.folder.language) if code in common][:1] or common[:1]
    )
    head = _head(path.stem, course, chosen, tuple(dict.fromkeys((*chosen, *common))))
    write_whole(path, (head + exercises).encode("utf-8"))
    return path


def _head(stem: str, course: Course[Any], sheets: Sequence[str], langs: Sequence[str]) -> str:
    texts = {lang: words(lang)["assignment"] for lang in langs}
    comments = words(language_of_messages())["assignment"]["comments"]
    title = _texts({lang: f"{s['title']} ({stem})" for lang, s in texts.items()})
    return "\n".join(
        [
            f"title = {title}",
            f"course = {_texts({lang: course.folder.title(lang) for lang in langs})}",
            "# date = 2026-12-04",
            '# duration = "1 h 30"',
            f"# instructions = {_texts({lang: s['instructions'] for lang, s in texts.items()})}",
            "# cover = true",
            f"# rules = true         # {comments['rules']}",
            f"# work = 60            # {comments['work']}",
            f"# anonymous = true     # {comments['anonymous']}",
            f"# attendance = true    # {comments['attendance']}",
            "mark = { of = 20, step = 0.5 }",
            f'versions = "each"      # {comments["versions"]}',
            f'# identity = ["number", "group"]      # {comments["identity"]}',
            '# roster = "class.csv"',
            f'lang = "{",".join(sheets)}"',
            f'out = "{stem}"',
            *(f"# {texts[lang]['secret_line']}" for lang in langs),
            f'secret = "{Secret.new().text}"',
            "",
        ]
    )


def toml_of(table: Mapping[str, Any]) -> str:
    """Return the table of an assignment as the text of its file, which reads back as the same table."""
    own = [f"{key} = {toml_value(value)}" for key, value in table.items() if key != "exercises"]
    entries = [
        "\n".join(["", "[[exercises]]", *(f"{key} = {toml_value(value)}" for key, value in exercise.items())])
        for exercise in table["exercises"]
    ]
    return "\n".join([*own, *entries, ""])


def _texts(texts: dict[str, str]) -> str:
    """Return a text, or one a language, as TOML."""
    return toml_value(next(iter(texts.values())) if len(set(texts.values())) == 1 else texts)


def _exercise_entry(course: Course[Any], name: str) -> str:
    parts = ", ".join(f'"{p.id}"' for p in course[name].spec.parts if not p.by_request)
    return f'\n[[exercises]]\nname = "{name}"\n# parts = [{parts}]\n# points = 6\n'
