"""Every deliberate error, each a :class:`CourseworkError` and a builtin as well.

A message says what was asked, what was found and what would do.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from coursework.messages import Message, as_message, localised


class CourseworkError(Exception):
    """Base class of all deliberate errors: an English template and the values that fill it.

    ``raise BadInput("{file} has no column {name!r}", file=path, name=name)``: the text is made in the
    reader's language when it is printed. A text without values is a template without places to fill.
    """

    def __init__(self, *template: object, **values: object) -> None:
        super().__init__(*([Message(str(template[0]), **values)] if values else template))

    def __str__(self) -> str:
        if len(self.args) == 1 and isinstance(self.args[0], str):
            return localised(self.args[0])
        return super().__str__()

    def _render_traceback_(self) -> list[str]:
        """Return the lines that a notebook shows: the message alone, which is all that its reader needs."""
        return [f"{type(self).__name__}: {self}"]


class UnknownName(CourseworkError, LookupError):
    """A name that is not there; the message offers the nearest one."""


class MissingQuantity(CourseworkError, TypeError):
    """A request needs quantities that nothing gives: ``names``; ``needed`` says what needs them."""

    def __init__(self, needed: str, names: tuple[str, ...] = ()):
        super().__init__(needed, names)
        self.needed = needed
        self.names = names

    def __str__(self) -> str:
        values = ", ".join(f"{name}=…" for name in self.names)
        return localised(self.advising(Message("{values} to the request", values=values)))

    def advising(self, subject: str) -> Message:
        """Return the message, with what to add."""
        if not self.names:
            return as_message(self.needed)
        return Message("{needed}; add {subject}", needed=self.needed, subject=subject)


class Cycle(CourseworkError, ValueError):
    """Quantities that need each other."""


class WrongUnit(CourseworkError, ValueError):
    """A value in a unit of another dimension, or in no unit we know."""


class WrongValue(CourseworkError, ValueError):
    """A given value outside its domain: a negative length, a text for a number."""


class CannotAssemble(CourseworkError, ValueError):
    """The linkage does not close; the message says by how much, in the unit of the lengths: ``(gap 3.2)``."""


class Undefined(CourseworkError, ValueError):
    """A quantity that does not exist in this configuration."""


class CannotTell(CourseworkError, ValueError):
    """A rank, or a kind of joint, that hangs on digits which the data do not hold; names the gap."""


class Starved(CourseworkError, RuntimeError):
    """No variant was found within the allowed draws; names the constraint that refuses."""


class NoSolution(CourseworkError, LookupError):
    """An answer was asked of an exercise that has no solution."""


class BadCourse(CourseworkError, ValueError):
    """A course folder, or a file in it, is not what it should be."""


class BrokenFunction(BadCourse):
    """A function of a course fails where it should compute; names the function, its file and line."""


class BadStatement(BadCourse):
    """A statement's text cannot be rendered: unknown variable, refused formula."""


class BadInput(CourseworkError, ValueError):
    """Wrong input of a user, in a file or in the arguments of a call."""


def reason_of(fault: OSError) -> Message:
    """Return what the system says of a file or an address, as a message."""
    return Message(fault.strerror or str(fault))


def counted(number: int, noun: str) -> Message:
    """Return ``1 row``, ``2 rows``."""
    return Message("{number} " + noun + "{number:|s}", number=number)


def closest(name: str, names: Iterable[str]) -> str | None:
    """Return the known name that may have been meant, whatever its case and accents; None where none is near.

    Of a name of several words, in whatever order, each word must be near another one of the other's, so that
    nobody is offered a namesake; a word of one letter or digit says too little.
    """
    import difflib

    plain: dict[str, list[str]] = {}
    for candidate in names:
        plain.setdefault(_in_order(candidate), []).append(candidate)
    sought = _in_order(name)
    near = [sought] if sought in plain else difflib.get_close_matches(sought, plain, n=3, cutoff=_NEAR_SYMBOL)
    match = next((plain[candidate] for candidate in near if _words_are_near(sought, candidate)), [])
    return max(
        match, key=lambda candidate: difflib.SequenceMatcher(None, name, candidate).ratio(), default=None
    )


#: Of two names, twice the letters in common over the letters of both; of symbols, whose letters are few, at
#: least.
_NEAR, _NEAR_SYMBOL = 0.6, 0.5
_SYMBOL = 3  #: letters of a symbol at most


def cut_short(text: str, most: int) -> str:
    """Return a text short enough for a message."""
    return text if len(text) <= most else text[: most - 1] + "…"


def first_few(names: Sequence[str], most: int, *, with_count: bool = False) -> str:
    """Return the first of the names as a list, with an ellipsis in place of the others, and on request the
    number of all."""
    more = f", … ({len(names)})" if with_count else ", …"
    return ", ".join(names[:most]) + (more if len(names) > most else "")


def bare_letters(text: str) -> str:
    """Return a text without case and accents, and with straight apostrophes."""
    import unicodedata

    letters = unicodedata.normalize("NFKD", text).casefold().replace("’", "'")
    return "".join(letter for letter in letters if not unicodedata.combining(letter))


def _in_order(name: str) -> str:
    """Return the words of a name in the order of the alphabet, without case and accents."""
    return " ".join(sorted(bare_letters(name).split()))


def _words_are_near(sought: str, name: str) -> bool:
    import difflib

    words, others = sorted(sought.split(), key=lambda word: word not in name.split()), name.split()
    if min(len(words), len(others)) < 2:
        least = _NEAR_SYMBOL if len(sought) <= _SYMBOL else _NEAR
        return difflib.SequenceMatcher(None, sought, name).ratio() >= least
    for word in words:
        near = difflib.get_close_matches(word, others, n=1, cutoff=_NEAR)
        if not near and len(word) > 1:
            return False
        for wanted in near:
            others.remove(wanted)
    return True


def nearest(name: str, names: Iterable[str]) -> Message:
    """Return ``"; did you mean 'x'?"``, or the whole list when nothing is near."""
    names = list(names)
    if (near := closest(name, names)) is not None:
        return Message("; did you mean {near!r}?", near=near)
    if names:
        return Message("; available: {names}", names=", ".join(sorted(names)))
    return Message("; there is none")


def unknown(kind: str, name: str, names: Iterable[str], where: str = "") -> UnknownName:
    """Return the error for a look-up that failed."""
    location = Message(" in {where}", where=where) if where else ""
    return UnknownName(
        f"no {kind} {{name!r}}{{place}}{{nearest}}", name=name, place=location, nearest=nearest(name, names)
    )
