"""Launch: the person, the course and the link, and the services that the platform offers."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Self
from urllib.parse import urlsplit

from coursework.platforms.lti.refusal import LTIRefusal
from coursework.platforms.lti.roles import Role, role_of

_LTI = "https://purl.imsglobal.org/spec/lti/claim/"
_DEEP = "https://purl.imsglobal.org/spec/lti-dl/claim/"
_GRADES = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"
_PERSON = "https://purl.imsglobal.org/spec/lti/claim/lis"
_ROSTER = "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice"

RESOURCE, PICKING = "LtiResourceLinkRequest", "LtiDeepLinkingRequest"
_LONGEST = 4000  #: characters of any stored claim


@dataclass(frozen=True)
class Picking:
    """Deep-linking request: the platform's rules for the choice of a link's content."""

    return_url: str
    data: str | None = None  #: to be returned unchanged
    several: bool = False
    with_line: bool = True  #: whether a gradebook column may be requested
    links: bool = True  #: whether it accepts links


@dataclass(frozen=True)
class Launch:
    """Verified launch: the content of its claims."""

    issuer: str
    client_id: str
    deployment: str
    person: str  #: the platform's own identifier, ``sub``
    name: str
    role: Role
    kind: str
    link: str = ""  #: identifier of the link, empty while one is picked
    link_title: str = ""
    context: str = ""
    context_title: str = ""
    custom: Mapping[str, str] = field(default_factory=dict)
    locale: str = ""
    return_url: str = ""
    line: str = ""  #: address of the gradebook's column
    lines: str = ""  #: address of all columns
    scopes: tuple[str, ...] = ()
    memberships: str = ""  #: address of the roster
    picking: Picking | None = None
    email: str = ""  #: if the platform provides it
    number: str = ""  #: identifier of the person at the institution, if the platform provides it

    @property
    def link_key(self) -> str:
        """Return the key of the link, unique over all platforms."""
        return json.dumps([self.issuer, self.client_id, self.deployment, self.link])

    @property
    def course(self) -> str:
        """Return the key of the course, unique over all platforms."""
        return json.dumps([self.issuer, self.client_id, self.deployment, self.context])

    @property
    def platform(self) -> str:
        """Name of the platform on pages and in the audit."""
        return urlsplit(self.issuer).hostname or self.issuer

    def as_plain(self) -> dict[str, Any]:
        """Return the fields as JSON stores them."""
        return {**asdict(self), "role": str(self.role), "scopes": list(self.scopes)}

    @classmethod
    def of_plain(cls, fields: Mapping[str, Any]) -> Self:
        picking = fields["picking"] and Picking(**fields["picking"])
        return cls(
            **{**fields, "role": Role(fields["role"]), "scopes": tuple(fields["scopes"]), "picking": picking}
        )


def launch_of(claims: Mapping[str, Any]) -> Launch:
    """Return the launch that verified claims describe.

    Raises
    ------
    LTIRefusal
        A required claim is missing or malformed.
    """
    kind = _text(claims, f"{_LTI}message_type", needed=True)
    if kind not in (RESOURCE, PICKING):
        raise LTIRefusal("message", 400, f"message type {kind[:60]!r}")
    if _text(claims, f"{_LTI}version", needed=True) != "1.3.0":
        raise LTIRefusal("message", 400, "not version 1.3.0")
    roles = claims.get(f"{_LTI}roles")
    if not isinstance(roles, list):
        raise LTIRefusal("claim", 400, "roles missing")
    link = _table(claims, f"{_LTI}resource_link")
    context, presentation = _table(claims, f"{_LTI}context"), _table(claims, f"{_LTI}launch_presentation")
    grades, roster = _table(claims, _GRADES), _table(claims, _ROSTER)
    custom = {
        _storable(k): _storable(str(v))
        for k, v in _table(claims, f"{_LTI}custom").items()
        if isinstance(v, (str, float)) or (isinstance(v, int) and _written(v))
    }
    full_name = " ".join(filter(None, (_text(claims, "given_name"), _text(claims, "family_name"))))
    scopes = grades.get("scope")
    return Launch(
        issuer=_text(claims, "iss", needed=True),
        client_id=_text(claims, "client_id", needed=True),
        deployment=_text(claims, f"{_LTI}deployment_id", needed=True),
        person=_text(claims, "sub", needed=True),
        name=_text(claims, "name") or full_name,
        role=role_of(text for text in roles if isinstance(text, str)),
        kind=kind,
        link=_text(link, "id", needed=kind == RESOURCE, label="resource_link"),
        link_title=_text(link, "title"),
        context=_text(context, "id"),
        context_title=_text(context, "title") or _text(context, "label"),
        custom=custom,
        locale=_text(presentation, "locale"),
        return_url=_address(presentation, "return_url"),
        line=_address(grades, "lineitem"),
        lines=_address(grades, "lineitems"),
        scopes=tuple(_storable(str(text)) for text in scopes if isinstance(text, str))
        if isinstance(scopes, list)
        else (),
        memberships=_address(roster, "context_memberships_url"),
        picking=_picking(_table(claims, f"{_DEEP}deep_linking_settings")) if kind == PICKING else None,
        email=_text(claims, "email"),
        number=_text(_table(claims, _PERSON), "person_sourcedid"),
    )


def _picking(fields: Mapping[str, Any]) -> Picking:
    url = _address(fields, "deep_link_return_url")
    if not url:
        raise LTIRefusal("claim", 400, "deep_link_return_url missing")
    data, kinds = fields.get("data"), fields.get("accept_types", ["ltiResourceLink"])
    return Picking(
        url,
        data if isinstance(data, str) else None,
        _truth(fields.get("accept_multiple", False)),
        _truth(fields.get("accept_lineitem", True)),
        not isinstance(kinds, list) or "ltiResourceLink" in kinds,
    )


def _truth(value: Any) -> bool:
    """Return True for ``true`` and ``"true"``, since platforms write both."""
    return value is True or str(value).lower() == "true"


def _table(claims: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = claims.get(name)
    return value if isinstance(value, Mapping) else {}


def _text(claims: Mapping[str, Any], name: str, *, needed: bool = False, label: str = "") -> str:
    """Return the text of a claim. A ``needed`` claim, such as an identifier, is refused if it is too long:
    cut short, two of them could become equal."""
    value = claims.get(name)
    text = value if isinstance(value, str) else _written(value) if type(value) is int else ""
    stored = _storable(text)
    if needed and (not text.strip() or stored != text):
        raise LTIRefusal(
            "claim", 400, f"{label or name.rpartition('/')[2]} {'missing' if not text.strip() else 'too odd'}"
        )
    return stored


def _storable(text: str) -> str:
    """Return a text without the characters that some databases cannot store."""
    return text[:_LONGEST].replace("\0", "").encode("utf-8", "replace").decode()


def _written(number: int) -> str:
    return str(number) if number.bit_length() <= 256 else ""


def _address(claims: Mapping[str, Any], name: str) -> str:
    """Return a web address; empty for any other scheme."""
    address = _text(claims, name)
    return address if address.startswith(("https://", "http://")) else ""
