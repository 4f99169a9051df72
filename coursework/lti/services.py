"""Services of a platform: scores for its gradebook, and its roster."""

from __future__ import annotations

import datetime
import secrets
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode, urlsplit, urlunsplit

import httpx
import jwt

from coursework.errors import CourseworkError
from coursework.lti.keys import KeyFolder
from coursework.lti.roles import Role, role_of
from coursework.lti.settings import Platform, origin
from coursework.lti.storage import Waiting

_GRADES = "https://purl.imsglobal.org/spec/lti-ags/scope/"
SCORE, LINE, LINE_READ = f"{_GRADES}score", f"{_GRADES}lineitem", f"{_GRADES}lineitem.readonly"
ROSTER = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly"
_SCORE_TYPE = "application/vnd.ims.lis.v1.score+json"
_LINE_TYPE = "application/vnd.ims.lis.v2.lineitem+json"
_LINES_TYPE = "application/vnd.ims.lis.v2.lineitemcontainer+json"
_ROSTER_TYPE = "application/vnd.ims.lti-nrps.v2.membershipcontainer+json"
_PAGES = 200  #: of a roster at most


class NotServed(CourseworkError, ConnectionError):
    """A platform did not do what it was asked; ``status`` is what it answered, 0 where it did not."""

    def __init__(self, said: str, status: int = 0):
        super().__init__(said)
        self.status = status


@dataclass(frozen=True)
class Member:
    """A line of a platform's roster."""

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

    def send(self, platform: Platform, waiting: Waiting) -> None:
        """Tell a platform a score.

        Raises
        ------
        NotServed
            It did not take it.
        """
        line = waiting.line or self._line(platform, waiting)
        score = waiting.score
        at = datetime.datetime.fromtimestamp(waiting.stamp, datetime.UTC).isoformat(timespec="milliseconds")
        told: dict[str, Any] = {
            "userId": waiting.person,
            "scoreGiven": score.given,
            "scoreMaximum": score.maximum,
            "timestamp": at.replace("+00:00", "Z"),
            "activityProgress": "Completed",
            "gradingProgress": "PendingManual" if score.waits else "FullyGraded",
        }
        if score.comment:
            told["comment"] = score.comment
        self._asked(platform, [SCORE], "POST", _below(line, "scores"), json=told, kind=_SCORE_TYPE)

    def _line(self, platform: Platform, waiting: Waiting) -> str:
        """Return the address of a gradebook column for a link without one: an existing column of the link, or
        else a new one."""
        link = waiting.link
        if not waiting.lines or LINE not in waiting.scopes:
            raise NotServed("the link has no column in the gradebook", 404)
        url = _with(waiting.lines, resource_link_id=link)
        found = self._asked(platform, [LINE], "GET", url, accept=_LINES_TYPE).json()
        for one in found if isinstance(found, list) else []:
            if isinstance(one, Mapping) and str(one.get("resourceLinkId")) == link and one.get("id"):
                return str(one["id"])
        wanted = {
            "label": waiting.title or link,
            "scoreMaximum": waiting.score.maximum,
            "resourceLinkId": link,
        }
        made = self._asked(
            platform, [LINE], "POST", waiting.lines, json=wanted, kind=_LINE_TYPE, accept=_LINE_TYPE
        ).json()
        return str(made["id"])

    # ------------------------------------------------------------------ roster

    def roster(self, platform: Platform, url: str) -> list[Member]:
        """Return the members of a course.

        Raises
        ------
        NotServed
            The platform does not say.
        """
        found: list[Member] = []
        seen: set[str] = set()
        page = url
        while page and page not in seen and len(seen) < _PAGES:
            seen.add(page)
            answer = self._asked(platform, [ROSTER], "GET", page, accept=_ROSTER_TYPE)
            try:
                found += [_member(one) for one in answer.json().get("members", [])]
            except (ValueError, AttributeError, TypeError, KeyError) as fault:
                raise NotServed(f"{platform.name} answers with no roster") from fault
            page = answer.links.get("next", {}).get("url", "")
            if page and origin(page) != origin(url):
                raise NotServed(f"{platform.name} sends us elsewhere for the rest of its roster")
        return found

    # ------------------------------------------------------------------ asking

    def _asked(
        self, platform: Platform, scopes: Sequence[str], method: str, url: str, *, accept: str = "", kind: str = "", json: Any = None
    ) -> httpx.Response:  # fmt: skip
        """Return the response of the platform; retry once with a new token if it rejects the cached one."""
        if origin(url) not in platform.services:
            raise NotServed(
                f"{platform.name} names an address at {origin(url)[:100]!r}, which is not among its own: add it to its 'origins' in "
                "platforms.toml where it is",
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
            raise NotServed(f"{platform.name} answers {answer.status_code}", answer.status_code)
        return answer

    def token(self, platform: Platform, scopes: Sequence[str], fresh: bool = False) -> str:
        """Return an access token for these scopes; request a new one if ``fresh``.

        Raises
        ------
        NotServed
            It gives none.
        """
        name = platform.issuer, platform.client_id, " ".join(sorted(scopes))
        with self._lock:
            kept, until = self._tokens.get(name, ("", 0.0))
            if kept and not fresh and time.monotonic() < until:
                return kept
        told = {
            "grant_type": "client_credentials",
            "client_assertion_type": "urn:ietf:params:oauth:client-assertion-type:jwt-bearer",
            "client_assertion": self._assertion(platform),
            "scope": name[2],
        }
        answer = self._sent(platform, "POST", platform.token_url, data=told)
        if not answer.is_success:
            raise NotServed(
                f"{platform.name} gives no token: it answers {answer.status_code}", answer.status_code
            )
        try:
            had = answer.json()
            token, seconds = str(had["access_token"]), float(had.get("expires_in", 3600))
        except (ValueError, KeyError, TypeError) as fault:
            raise NotServed(f"{platform.name} gives no token") from fault
        with self._lock:
            self._tokens[name] = token, time.monotonic() + max(0.0, seconds - 30)
        return token

    def _assertion(self, platform: Platform) -> str:
        """By which a platform knows us: signed by the key that it finds among ours."""
        key, now = self._keys.signing, int(time.time())
        told = {
            "iss": platform.client_id, "sub": platform.client_id, "aud": platform.audience or platform.token_url,
            "iat": now, "exp": now + 60, "jti": secrets.token_urlsafe(24),
        }  # fmt: skip
        return jwt.encode(told, key.private, "RS256", headers={"kid": key.kid})

    def _sent(self, platform: Platform, method: str, url: str, **told: Any) -> httpx.Response:
        try:
            return self._client.request(method, url, **told)
        except (httpx.HTTPError, httpx.InvalidURL) as fault:
            raise NotServed(f"{platform.name} does not answer: {type(fault).__name__}") from None


def _below(line: str, name: str) -> str:
    """Return an address below a column's, with its query preserved: ``…/lineitem?type_id=1`` becomes
    ``…/lineitem/scores?type_id=1``."""
    parts = urlsplit(line)
    return urlunsplit(parts._replace(path=f"{parts.path.rstrip('/')}/{name}"))


def _with(url: str, **told: str) -> str:
    parts = urlsplit(url)
    return urlunsplit(parts._replace(query="&".join(filter(None, (parts.query, urlencode(told))))))


def _member(told: Mapping[str, Any]) -> Member:
    whole = " ".join(filter(None, (str(told.get(part) or "") for part in ("given_name", "family_name"))))
    roles = told.get("roles") or []
    return Member(
        str(told["user_id"]),
        " ".join((str(told.get("name") or "") or whole).split()),
        str(told.get("email") or ""),
        str(told.get("lis_person_sourcedid") or ""),
        role_of(str(one) for one in roles),
        str(told.get("status", "Active")) == "Active",
    )
