"""Messages in the reader's language: an English template, which is the key, and the values that fill it.

The translations of a language are ``coursework/language/messages/LANG.toml``: tables of
``"template" = "translation"``. A template without a translation is printed in English.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from numbers import Real
from pathlib import Path
from typing import Any

CATALOGUES = Path(__file__).parent / "language" / "messages"
#: Ending that agrees with a number: ``{rows:|s}`` is empty for one row and ``s`` for several.
_AGREEMENT = re.compile(r"\{(\w+):(\w*)\|(\w*)\}")
_PLACES = tuple(f"note{number}" for number in range(1, 100))
_ONE_BELOW_TWO = ("fr",)  #: languages whose nouns are singular below two
_NARROW = "\N{NARROW NO-BREAK SPACE}"
#: Place of a number with a format; one in double quotes is for a file, whose numbers have a point.
_NUMBER = re.compile(r'(?<!")\{(\w+):([^{}|]+)\}')
_QUOTED = re.compile(r"\{(\w+)!r\}")
_QUOTES = {"fr": f"«{_NARROW}{{}}{_NARROW}»"}  #: round a text that the template quotes
_SIGNS = {"fr": str.maketrans({",": _NARROW, ".": ","})}  #: between thousands, and before decimals
_language: ContextVar[str] = ContextVar("language of messages", default="en")


def language_of_messages() -> str:
    """Return the language in which messages are printed now."""
    return _language.get()


@contextmanager
def messages_in(lang: str) -> Iterator[None]:
    """Print messages in a language within the block; threads and tasks keep their own."""
    token = _language.set(lang)
    try:
        yield
    finally:
        _language.reset(token)


@cache
def translations(lang: str) -> Mapping[str, str]:
    """Return the translations into a language by their English templates; none for English or a language
    without file."""
    path = CATALOGUES / f"{lang}.toml"
    if not path.is_file():
        return {}
    tables = tomllib.loads(path.read_text("utf-8"))
    return {template: _typeset(text, lang) for table in tables.values() for template, text in table.items()}


def number_form(number: float, lang: str) -> str:
    """Return ``"one"`` if the noun of so many is singular, otherwise ``"many"``: French is singular below
    two, English at one only."""
    return "one" if (number < 2 if lang in _ONE_BELOW_TWO else number == 1) else "many"


def _typeset(text: str, lang: str) -> str:
    """Return a translation with the spaces of its language that do not break."""
    if lang != "fr":
        return text
    return re.sub(r" (?=[;:!?»](?:\s|$))", _NARROW, text).replace("« ", f"«{_NARROW}").replace("'", "’")


class Message(str):
    """English text that knows its template and the values in it, so that it can be printed in another
    language.

    ``Message("{file} has {count} lines", file=path, count=3)``: without values the template is the text,
    braces and all. A value may be a message or an error: it is translated with the whole. ``line{count:|s}``
    agrees with a number, or with a message such as ``3 lines``, by the rule of the language.
    """

    template: str
    values: Mapping[str, Any]

    def __new__(cls, template: str, /, **values: Any) -> Message:
        message = super().__new__(cls, _filled(template, values, "en"))
        message.template, message.values = template, values
        return message

    def in_language(self, lang: str) -> str:
        """Return the text in a language."""
        return _filled(self.template, self.values, lang)

    def replacing(self, old: str, new: str) -> Message:
        """Return the message with a text replaced in all its values, such as the path of a temporary file by
        its name."""
        if not self.values:
            return Message(self.template.replace(old, new))
        return Message(self.template, **{name: _replaced(v, old, new) for name, v in self.values.items()})

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.template, dict(self.values))


def _restored(template: str, values: dict[str, Any]) -> Message:
    return Message(template, **values)


def joined_notes(notes: Iterable[str], separator: str = "; ") -> str:
    """Return notes as one message with a separator between them, each of which is still translated; ""
    without notes."""
    several = dict(zip(_PLACES, filter(None, notes), strict=False))
    if len(several) < 2:
        return next(iter(several.values()), "")
    return Message(separator.join(f"{{{place}}}" for place in several), **several)


def separate_notes(note: str) -> tuple[str, ...]:
    """Return the notes that :func:`joined_notes` put together; one that is alone is itself."""
    if isinstance(note, Message) and {*note.values} & {*_PLACES}:
        return tuple(note.values.values())
    return (note,)


def as_message(text: object) -> Message:
    """Return the message of an error or of a text; one without a template is its own."""
    if isinstance(text, BaseException) and len(text.args) == 1 and isinstance(text.args[0], str):
        text = text.args[0]
    return text if isinstance(text, Message) else Message(str(text))


def localised(text: object, lang: str = "") -> str:
    """Return an error or a message in a language, the current one where none is named; any other value as its
    text."""
    return as_message(text).in_language(lang or language_of_messages())


def _filled(template: str, values: Mapping[str, Any], lang: str) -> str:
    text = translations(lang).get(template, template)
    if not values:
        return text
    text = _AGREEMENT.sub(lambda place: place[2 if _form(values[place[1]], lang) == "one" else 3], text)
    if lang in _SIGNS:
        text = _NUMBER.sub(lambda place: _number(place, values, lang), text)
    translated = {n: localised(v, lang) if _is_translated(v) else v for n, v in values.items()}
    if lang in _QUOTES:
        text = _QUOTED.sub(lambda place: _quoted(place, translated, lang), text)
    return text.format(**translated)


def _quoted(place: re.Match[str], values: Mapping[str, Any], lang: str) -> str:
    """Return the place of a quoted text within the quotes of a language; the place itself for another
    value."""
    value = values[place[1]]
    return _QUOTES[lang].format(_braced(repr(value)[1:-1])) if isinstance(value, str) else place[0]


def _braced(text: str) -> str:
    """Return a text as it stands in a template."""
    return text.replace("{", "{{").replace("}", "}}")


def _number(place: re.Match[str], values: Mapping[str, Any], lang: str) -> str:
    """Return the number of a place with the signs of a language; the place itself for another value."""
    value = values.get(place[1])
    return format(value, place[2]).translate(_SIGNS[lang]) if isinstance(value, Real) else place[0]


def _form(value: Any, lang: str) -> str:
    return number_form(value.values["number"] if isinstance(value, Message) else value, lang)


def _is_translated(value: object) -> bool:
    return isinstance(value, Message | Exception)


def _replaced(value: Any, old: str, new: str) -> Any:
    if _is_translated(value):
        return as_message(value).replacing(old, new)
    text = str(value)
    return text.replace(old, new) if old in text else value
