"""Request within the session of a launch."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from coursework.platforms.lti.launch import Launch
from coursework.platforms.lti.services import Member
from coursework.platforms.lti.storage import Waiting


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
    scores: Callable[[], Mapping[str, Waiting]] = dict  #: queued and arrived scores of the link, by person
