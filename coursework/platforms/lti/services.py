"""Services of a platform: scores for its gradebook, and its roster."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import urlencode, urlsplit, urlunsplit

import httpx
import jwt

from coursework.errors import CourseworkError
from coursework.messages import Message
from coursework.platforms.lti.keys import KeyFolder
from coursework.platforms.lti.roles import Role, role_of
from coursework.platforms.lti.settings import LTIPlatform
from coursework.system.headers import origin

if TYPE_CHECKING:
    from coursework.platforms.lti.storage import Waiting

_GRADES = "https://purl.imsglobal.org/spec/lti-ags/scope/"
SCORE, LINE, LINE_READ = f"{_GRADES}score", f"{_GRADES}lineitem", f"{_GRADES}lineitem.readonly"
ROSTER = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly"
_SCORE_TYPE = "application/vnd.ims.lis.v1.score+json"
_LINE_TYPE = "application/vnd.ims.lis.v2.lineitem+json"
_LINES_TYPE = "application/vnd.ims.lis.v2.lineitemcontainer+json"
_ROSTER_TYPE = "application/vnd.ims.lti-nrps.v2.membershipcontainer+json"
_PAGES = 200  #: of a roster at most


class NotServed(CourseworkError, ConnectionError):
    """Error of a platform's service; ``status`` is that of its response, 0 if there was none."""

    def __init__(self, message: str, status: int = 0):
        super().__init__(message)
        self.status = status


@dataclass(frozen=True)
class Member:
    """Entry of a platform's roster."""

    person: str
    name: str
    email: str
    number: str
    role: Role
    active: bool


class Services:
    """Client of the platforms' services, with access tokens cached until they expire."""

    def __init__(self, client: httpx.Client, keys: KeyFolder):
        self._client, self._keys = client, keys
        self._tokens: dict[tuple[str, str, str], tuple[str, float]] = {}
        self._lock = threading.Lock()

    # ------------------------------------------------------------------ scores

    def send(self, platform: LTIPlatform, waiting: Waiting) -> None:
        """Send a score to a platform.

        Raises
        ------
        NotServed
            The platform did not accept it.
        """
        line = waiting.line or self._line(platform, waiting)
        score = waiting.score
        at = waiting.stamp.isoformat(timespec="milliseconds")
        body: dict[str, Any] = {
            "userId": waiting.launch.person,
            "scoreGiven": score.given,
            "scoreMaximum": score.maximum,
            "timestamp": at.replace("+00:00", "Z"),
            "activityProgress": "Completed",
            "gradingProgress": "PendingManual" if score.waits else "FullyGraded",
        }
        if score.comment:
            body["comment"] = score.comment
        self._request(platform, [SCORE], "POST", _below(line, "scores"), json=body, kind=_SCORE_TYPE)

    def _line(self, platform: LTIPlatform, waiting: Waiting) -> str:
        """Return the address of a gradebook column for a link without one: an existing column of the link, or
        else a new one."""
        link, lines = waiting.launch.link, waiting.launch.lines
        if not lines or LINE not in waiting.launch.scopes:
            raise NotServed(Message("the link has no column in the gradebook"), 404)
        url = _with(lines, resource_link_id=link)
        columns = self._request(platform, [LINE], "GET", url, accept=_LINES_TYPE).json()
        for column in columns if isinstance(columns, list) else []:
            if isinstance(column, Mapping) and str(column.get("resourceLinkId")) == link and column.get("id"):
                return str(column["id"])
        wanted = {
            "label": waiting.launch.link_title or link,
            "scoreMaximum": waiting.score.maximum,
            "resourceLinkId": link,
        }
        created = self._request(
            platform, [LINE], "POST", lines, json=wanted, kind=_LINE_TYPE, accept=_LINE_TYPE
        ).json()
        return str(created["id"])

    # ------------------------------------------------------------------ roster

    def roster(self, platform: LTIPlatform, url: str) -> list[Member]:
        """Return the members of a course.

        Raises
        ------
        NotServed
            The platform gives no roster.
        """
        members: list[Member] = []
        seen: set[str] = set()
        page = url
        while page and page not in seen and len(seen) < _PAGES:
            seen.add(page)
            answer = self._request(platform, [ROSTER], "GET", page, accept=_ROSTER_TYPE)
            try:
                members += [_member(member) for member in answer.json().get("members", [])]
            except (ValueError, AttributeError, TypeError, KeyError) as fault:
                raise NotServed(Message("{platform} sends no roster", platform=platform.name)) from fault
            page = answer.links.get("next", {}).get("url", "")
            if page and origin(page) != origin(url):
                raise NotServed(
                    Message(
                        "{platform} refers to another server for the rest of its roster",
                        platform=platform.name,
                    )
                )
        return members

    # ------------------------------------------------------------------ requests

    def _request(
        self,
        platform: LTIPlatform,
        scopes: Sequence[str],
        method: str,
        url: str,
        *,
        accept: str = "",
        kind: str = "",
        json: Any = None,
    ) -> httpx.Response:
        """Return the response of the platform; retry once with a new token if it rejects the cached one."""
        if origin(url) not in platform.services:
            raise NotServed(
                Message(
                    (
                        "{platform} names an address at {origin!r}, which is not one of its own: if it "
                        "is, add it to its "
                        "'origins' in platforms.toml"
                    ),
                    platform=platform.name,
                    origin=origin(url)[:100],
                ),
                403,
            )
        for fresh in (False, True):
            headers = {"Authorization": f"Bearer {self.token(platform, scopes, fresh)}"}
            headers |= {"Accept": accept} if accept else {}
            headers |= {"Content-Type": kind} if kind else {}
            answer = self._sent(platform, method, url, headers=headers, json=json)
            if answer.status_code != 401:
                break
        if not answer.is_success:
            raise NotServed(
                Message("{platform} answers {status}", platform=platform.name, status=answer.status_code),
                answer.status_code,
            )
        return answer

    def token(self, platform: LTIPlatform, scopes: Sequence[str], fresh: bool = False) -> str:
        """Return an access token for these scopes; request a new one if ``fresh``.

        Raises
        ------
        NotServed
            The platform gives no token.
        """
        name = platform.issuer, platform.client_id, " ".join(sorted(scopes))
        with self._lock:
            cached, until = self._tokens.get(name, ("", 0.0))
            if cached and not fresh and time.monotonic() < until:
                return cached
        request = {
            "grant_type": "client_credentials",
            "client_assertion_type": "urn:ietf:params:oauth:client-assertion-type:jwt-bearer",
            "client_assertion": self._assertion(platform),
            "scope": name[2],
        }
        answer = self._sent(platform, "POST", platform.token_url, data=request)
        if not answer.is_success:
            raise NotServed(
                Message(
                    "{platform} sends no token: it answers {status}",
                    platform=platform.name,
                    status=answer.status_code,
                ),
                answer.status_code,
            )
        try:
            had = answer.json()
            token, seconds = str(had["access_token"]), float(had.get("expires_in", 3600))
        except (ValueError, KeyError, TypeError) as fault:
            raise NotServed(Message("{platform} sends no token", platform=platform.name)) from fault
        with self._lock:
            self._tokens[name] = token, time.monotonic() + max(0.0, seconds - 30)
        return token

    def _assertion(self, platform: LTIPlatform) -> str:
        """Return the assertion that identifies this tool to a platform, signed with one of its keys."""
        key, now = self._keys.signing, int(time.time())
        claims = {
            "iss": platform.client_id,
            "sub": platform.client_id,
            "aud": platform.audience or platform.token_url,
            "iat": now,
            "exp": now + 60,
            "jti": secrets.token_urlsafe(24),
        }
        return jwt.encode(claims, key.private, "RS256", headers={"kid": key.kid})

    def _sent(self, platform: LTIPlatform, method: str, url: str, **options: Any) -> httpx.Response:
        try:
            return self._client.request(method, url, **options)
        except (httpx.HTTPError, httpx.InvalidURL) as fault:
            raise NotServed(
                Message(
                    "{platform} does not answer: {error}", platform=platform.name, error=type(fault).__name__
                )
            ) from None


def _below(line: str, name: str) -> str:
    """Return an address below a column's, with its query preserved: ``…/lineitem?type_id=1`` becomes
    ``…/lineitem/scores?type_id=1``."""
    parts = urlsplit(line)
    return urlunsplit(parts._replace(path=f"{parts.path.rstrip('/')}/{name}"))


def _with(url: str, **parameters: str) -> str:
    parts = urlsplit(url)
    return urlunsplit(parts._replace(query="&".join(filter(None, (parts.query, urlencode(parameters))))))


def _member(fields: Mapping[str, Any]) -> Member:
    full_name = " ".join(
        filter(None, (str(fields.get(part) or "") for part in ("given_name", "family_name")))
    )
    roles = fields.get("roles") or []
    return Member(
        str(fields["user_id"]),
        " ".join((str(fields.get("name") or "") or full_name).split()),
        str(fields.get("email") or ""),
        str(fields.get("lis_person_sourcedid") or ""),
        role_of(str(role) for role in roles),
        str(fields.get("status", "Active")) == "Active",
    )
