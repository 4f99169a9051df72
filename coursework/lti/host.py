"""Interface between the LTI service and its content: the page of a link, the offers for a new link, and the
score.

The service knows platforms, launches and sessions; a host knows exercises. The package brings one,
:class:`coursework.lti.course_host.CourseHost`; a site of its own is another.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from coursework.lti.launch import Launch
from coursework.lti.services import Member
from coursework.lti.storage import Score, Waiting

Form = Mapping[str, Sequence[str]]  #: the values of each field, as they came


@dataclass(frozen=True)
class Visit:
    """Request within the session of a launch."""

    launch: Launch
    lang: str
    home: str  #: address of the session's pages, ``/at/NAME``
    path: str = ""  #: what stands behind it
    query: Mapping[str, str] = field(default_factory=dict)
    seal: str = ""  #: what a form of the session holds in its field ``_seal``
    roster: Callable[[], Sequence[Member]] | None = None  #: none where the platform offers none
    scores: Callable[[], Mapping[str, Waiting]] = dict  #: on their way and arrived, by person


@dataclass(frozen=True)
class Reply:
    """Response: a page, a redirect, or a file."""

    html: str = ""
    status: int = 200
    goto: str = ""
    file: str = ""  #: its name
    kind: str = "text/html; charset=utf-8"
    data: bytes = b""


@dataclass(frozen=True)
class Offer:
    """Exercise or assignment that a link may open."""

    key: str  #: ``exercise:slotted_mechanism``
    title: str
    points: float
    words: str = ""  #: what it is found by besides its title: its title in other languages


@dataclass(frozen=True)
class Shelf:
    """Offers that stand together, under a title."""

    title: str
    offers: tuple[Offer, ...]


class Host(Protocol):
    """Interface that the service requires of the provider of its content."""

    @property
    def languages(self) -> tuple[str, ...]:
        """Languages of the pages, the default one first."""
        ...

    def shelves(self, lang: str) -> Sequence[Shelf]:
        """Return the groups of offers that an instructor may choose from."""
        ...

    def show(self, visit: Visit) -> Reply:
        """Return the requested page.

        Raises
        ------
        Refused
            The person may not see it, or there is none.
        """
        ...

    def take(self, visit: Visit, form: Form) -> Reply:
        """Process a submitted form; the same form may be submitted twice."""
        ...

    def score(self, visit: Visit) -> Score | None:
        """Return the person's score for the platform; None if there is no score to report yet."""
        ...
