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

Form = Mapping[str, Sequence[str]]  #: values of each field


@dataclass(frozen=True)
class LTIRequest:
    """Request within the session of a launch."""

    launch: Launch
    lang: str
    home: str  #: address of the session's pages, ``/at/NAME``
    path: str = ""  #: path below it
    query: Mapping[str, str] = field(default_factory=dict)
    csrf_token: str = ""  #: value of the forms' field ``_seal``
    roster: Callable[[], Sequence[Member]] | None = None  #: None if the platform offers none
    scores: Callable[[], Mapping[str, Waiting]] = dict  #: queued and arrived scores, by person


@dataclass(frozen=True)
class LTIResponse:
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
    words: str = ""  #: further search text: its title in other languages


@dataclass(frozen=True)
class OfferGroup:
    """Offers that stand together, under a title."""

    title: str
    offers: tuple[Offer, ...]


class Host(Protocol):
    """Interface that the service requires of the provider of its content."""

    @property
    def languages(self) -> tuple[str, ...]:
        """Languages of the pages, the default one first."""
        ...

    def offer_groups(self, lang: str) -> Sequence[OfferGroup]:
        """Return the groups of offers that an instructor may choose from."""
        ...

    def show(self, visit: LTIRequest) -> LTIResponse:
        """Return the requested page.

        Raises
        ------
        LTIRefusal
            The person may not see it, or there is none.
        """
        ...

    def take(self, visit: LTIRequest, form: Form) -> LTIResponse:
        """Process a submitted form; the same form may be submitted twice."""
        ...

    def score(self, visit: LTIRequest) -> Score | None:
        """Return the person's score for the platform; None if there is no score to report yet."""
        ...
