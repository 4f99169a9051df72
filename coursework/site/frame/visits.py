"""What a page is asked, and what it answers: who comes, with what; and what is sent back."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any, NamedTuple

from coursework.errors import CourseworkError
from coursework.language.words import words

if TYPE_CHECKING:
    from datetime import datetime

    from coursework.site.frame.settings import Site


def local(address: str, usual: str = "/") -> str:
    """An address of this site; the first page in the place of any other, however it is written."""
    seen = "".join(letter for letter in address if ord(letter) >= 32)  # browsers take no notice of the others
    leads_away = seen.startswith("//") or "\\" in seen.partition("?")[0]
    return seen if seen.startswith("/") and not leads_away else usual


class Who(Enum):
    """Who may ask for a page."""

    NOBODY = "nobody"  #: whoever comes, signed in or not
    SOMEBODY = "somebody"  #: who is signed in
    STAFF = "staff"


class Refused(CourseworkError):
    """A page that is not shown: the name of a sentence of ``[refused]``, and the status that goes with it."""

    def __init__(self, sentence: str, status: int, *parts: object):
        self.sentence, self.status, self.parts = sentence, status, parts
        super().__init__(sentence)


class Person(NamedTuple):
    """Who is signed in."""

    id: int
    name: str
    role: str  #: ``student`` or ``instructor``
    lang: str = ""

    @property
    def is_staff(self) -> bool:
        return self.role == "instructor"


class Upload(NamedTuple):
    """A file that was sent."""

    name: str
    data: bytes


@dataclass(frozen=True)
class Form:
    """What a form brings: texts and files by the names of its fields, each as often as it came."""

    texts: Mapping[str, Sequence[str]] = field(default_factory=dict)
    files: Mapping[str, Sequence[Upload]] = field(default_factory=dict)

    def text(self, name: str, usual: str = "") -> str:
        return next(iter(self.texts.get(name, ())), usual)


@dataclass(frozen=True)
class Visit:
    """A page that is asked for."""

    site: Site
    person: Person | None
    lang: str
    at: datetime  #: UTC
    address: str  #: path, as the browser sees it
    path: Mapping[str, Any] = field(default_factory=dict)  #: what the path's places hold
    query: Mapping[str, str] = field(default_factory=dict)
    form: Form = field(default_factory=Form)
    posted: bool = False
    seal: str = ""  #: what a form holds in its field ``_seal``
    is_piece: bool = False  #: a script asks for a piece of the page alone
    came_from: str = ""  #: the address of the machine that asks

    @property
    def who(self) -> Person:
        """Who is signed in.

        Raises
        ------
        Refused
            Nobody is.
        """
        if self.person is None:
            raise Refused("sign_in", 401)
        return self.person

    @property
    def said(self) -> Mapping[str, Any]:
        """The site's words."""
        return words(self.lang, "site")

    def page(self, template: str, status: int = 200, **names: Any) -> Reply:
        """A page of a template, ``site_practice``, with the surroundings of all pages."""
        own = {"visit": self, "person": self.person, "seal": self.seal}
        return Reply(self.site.pages.page(template, self.lang, {**own, **names}), status)


@dataclass(frozen=True)
class Reply:
    """What is sent back: a page or a piece of one, another address, or a file."""

    html: str = ""
    status: int = 200
    goto: str = ""
    kind: str = "text/html; charset=utf-8"
    data: bytes = b""
    file: str = ""  #: its name, where it is to be kept
    keep: int = 0  #: seconds for which a browser may keep it; nothing is kept unless told
    signed_in: int | None = None  #: who is from now on; 0 for nobody
    lang: str = ""  #: which the browser is to remember


class Page(NamedTuple):
    """An address: who may ask for it, and what answers."""

    path: str
    answer: Callable[[Visit], Reply]
    who: Who
    posts: bool = False  #: it takes forms
    limit: str = "usual"  #: which of the limits it falls under (:mod:`coursework.site.frame.limits`)
    largest: int = 256 * 1024  #: bytes of a form that is sent to it
