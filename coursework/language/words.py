"""Languages: how numbers are written, and the engine's own words.

The words of a language are one file, ``coursework/language/LANG.toml``; a language exists
when its file does.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache, partial
from pathlib import Path
from typing import Any

from coursework.errors import BadCourse, UnknownName, first_few
from coursework.system.cache import cached_result

_FOLDER = Path(__file__).parent
_FAULTS = 5  #: of a words file that are reported at once
_PLACE = re.compile(r"\{\{|\}\}|\{[^{}]*\}|[{}]")


@cache
def languages() -> tuple[str, ...]:
    """Return the languages the engine speaks, in alphabetical order."""
    return tuple(sorted(f.name.removesuffix(".toml") for f in _FOLDER.iterdir() if f.name.endswith(".toml")))


@cache
def words(lang: str, of: str = "") -> Mapping[str, Any]:
    """Return the engine's words in one language, as nested tables of texts; ``of`` names those that a part of
    it has to itself, ``site``.

    Raises
    ------
    UnknownName
        No such language.
    BadCourse
        Its file cannot be read, lacks texts that English has, or has one of another kind or with other places
        to fill.
    """
    if lang not in languages():
        raise no_language(lang)
    files = [file_of(code, of) for code in dict.fromkeys((lang, "en"))]
    tables: Mapping[str, Any] = cached_result(
        [*files, Path(__file__)], f"words-{of}-{lang}.json", partial(_compared, lang, of)
    )
    return tables


def _compared(lang: str, of: str) -> Mapping[str, Any]:
    texts = _read(file_of(lang, of))
    if lang != "en":
        _compare(dict(texts_of(texts)), dict(texts_of(words("en", of))), file_of(lang, of))
    return texts


def file_of(lang: str, of: str = "") -> Path:
    """Return the path of the words of a language, whether it exists or not."""
    return Path(str(_FOLDER / of / f"{lang}.toml"))


def no_language(lang: str) -> UnknownName:
    """Return the error for a language that the engine does not speak."""
    return UnknownName(
        "no language {lang!r}; available: {languages}; the words of another would be in {file}",
        lang=lang,
        languages=", ".join(languages()),
        file=file_of(lang),
    )


def _read(file: Path) -> dict[str, Any]:
    import tomllib

    try:
        return tomllib.loads(file.read_text("utf-8-sig"))
    except FileNotFoundError:
        raise BadCourse(f"{file} is not there: copy the one beside it and translate") from None
    except tomllib.TOMLDecodeError as fault:
        raise BadCourse(f"{file}: {fault}") from fault
    except UnicodeDecodeError as fault:
        line = fault.object.count(b"\n", 0, fault.start) + 1
        raise BadCourse(f"{file}, line {line}, is not UTF-8: save it in that encoding") from fault


def _compare(texts: Mapping[str, object], english: Mapping[str, object], file: Path) -> None:
    """Refuse words that the engine could not use in the place of the English ones."""
    if missing := sorted(english.keys() - texts.keys()):
        raise BadCourse(
            f"{file} lacks {first_few(missing, _FAULTS)}: copy from en.toml beside it and translate"
        )
    faults = [
        *(
            f"{name} is to be like the English {text!r}; found {texts[name]!r}"
            for name, text in english.items()
            if type(texts[name]) is not type(text)
        ),
        *(
            f"{name} has {_braces_text(places)} where the English text has {_braces_text(wanted)}"
            for name, text in english.items()
            if (places := _places(texts[name])) != (wanted := _places(text))
        ),
    ]
    if faults:
        more = f"; and {len(faults) - _FAULTS} more" if len(faults) > _FAULTS else ""
        raise BadCourse(
            f"{file}: {'; '.join(faults[:_FAULTS])}{more}; what stands in braces is filled in, not translated"
        )


def _places(text: object) -> frozenset[str]:
    """Return the fields of a text: ``{names}``, ``{0}``; a brace that is not closed counts as a field of its
    own."""
    return frozenset(_PLACE.findall(text)) if isinstance(text, str) else frozenset()


def _braces_text(places: Iterable[str]) -> str:
    return ", ".join(sorted(places)) or "no braces"


def texts_of(table: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the texts of a table by name, ``study.refused.near`` for one in a table in a table."""
    for name, text in table.items():
        if isinstance(text, dict):
            yield from texts_of(text, f"{above}{name}.")
        else:
            yield above + name, text


def listed(items: Iterable[str], lang: str, joint: str = "and") -> str:
    """Return ``a, b and c``; ``joint`` is ``and`` or ``or``."""
    *first, last = items
    return f"{', '.join(first)} {words(lang)['marking'][joint]} {last}" if first else last


def is_whole(text: str) -> bool:
    """Return whether a text ends with a sentence, or is empty; else something is to follow: ``Here the
    guide``."""
    end = text.rstrip(' \n*_)»”"')
    return not end or end[-1] in ".!?…"


def quoted(text: str, lang: str) -> str:
    """Words within the quotation marks of a language."""
    return words(lang)["marking"]["quoted"].format(text)
