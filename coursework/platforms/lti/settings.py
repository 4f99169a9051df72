"""Settings of the service and its platforms, read from ``platforms.toml``."""

from __future__ import annotations

import ipaddress
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from coursework.errors import BadInput
from coursework.messages import Message, as_message
from coursework.system.headers import origin
from coursework.system.toml_files import TomlReader, source_of, table_of, toml_value

FILE = "platforms.toml"
_HOUR = 3600.0


@dataclass(frozen=True)
class LTIPlatform:
    """Platform where the tool is registered."""

    name: str  #: name in commands and logs
    issuer: str
    client_id: str
    deployments: tuple[str, ...]
    auth_url: str  #: address of logins
    token_url: str  #: address of tokens for grades and rosters
    jwks_url: str  #: its public keys
    #: Whose pages may hold ours in a frame, and which have gradebook and roster, besides ``issuer`` and
    #: ``auth_url``.
    origins: tuple[str, ...] = ()
    audience: str = ""  #: of a request for a token; ``token_url`` by default
    emails_verified: bool = False  #: it verifies e-mails, so that nobody can use another person's

    @property
    def services(self) -> tuple[str, ...]:
        """Return the origins that may be asked for tokens, gradebook columns and rosters; a launch cannot add
        any."""
        return tuple(dict.fromkeys([*self.frames, origin(self.token_url), origin(self.jwks_url)]))

    @property
    def frames(self) -> tuple[str, ...]:
        """Return the origins whose pages may embed this service in a frame."""
        return tuple(dict.fromkeys([origin(self.auth_url), origin(self.issuer), *self.origins]))


@dataclass(frozen=True)
class Settings:
    """Settings of the service: its address, its platforms, and its time limits."""

    folder: Path  #: of the keys and the data
    url: str = ""  #: its address in browsers, without a slash at the end
    platforms: tuple[LTIPlatform, ...] = ()
    session_seconds: float = 12 * _HOUR
    login_seconds: float = 600.0

    def platform(self, issuer: str, client_id: str = "") -> LTIPlatform | None:
        """Return the platform of an issuer; if the issuer has several clients, the one with the given client
        identifier."""
        matching = [p for p in self.platforms if p.issuer == issuer and client_id in ("", p.client_id)]
        return matching[0] if len(matching) == 1 else None

    @property
    def frames(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(frame for p in self.platforms for frame in p.frames))


def is_loopback(host: str) -> bool:
    """Return True if a host name or address denotes this machine."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost" or host.endswith(".localhost")


def checked_url(url: str, label: str) -> str:
    """Check an address; return it, without slashes at its end.

    Raises
    ------
    BadInput
        It is no web address, or plain http to another machine.
    """
    try:
        parts = urlsplit(url)
        host = parts.hostname or ""
    except ValueError:
        parts, host = urlsplit(""), ""
    if (
        parts.scheme not in ("https", "http")
        or not host
        or parts.username
        or any(c.isspace() or c in "\"'<>;," for c in url)
    ):
        raise BadInput(
            "{label} is an address such as https://moodle.example.org; found {url!r}",
            label=Message(label),
            url=url,
        )
    if parts.scheme == "http" and not is_loopback(host):
        raise BadInput(
            "{label} is plain http: {url}; keys and launches would be unprotected: give its https address",
            label=Message(label),
            url=url,
        )
    return url.rstrip("/")


# ------------------------------------------------------------------------ kinds


def moodle(site: str, **options: Any) -> dict[str, Any]:
    """Return the addresses of a Moodle platform."""
    lti = f"{site}/mod/lti"
    return {
        "issuer": site,
        "auth_url": f"{lti}/auth.php",
        "token_url": f"{lti}/token.php",
        "jwks_url": f"{lti}/certs.php",
    }


def canvas(site: str, **options: Any) -> dict[str, Any]:
    """Return the addresses of a Canvas platform hosted by Instructure; all of them share one issuer."""
    security = "https://sso.canvaslms.com/api/lti"
    return {
        "issuer": "https://canvas.instructure.com",
        "auth_url": f"{security}/authorize_redirect",
        "token_url": f"{site}/login/oauth2/token",
        "jwks_url": f"{security}/security/jwks",
        "origins": [site],
    }


KINDS = {"moodle": moodle, "canvas": canvas}

# ---------------------------------------------------------------------- reading

_KEYS = (
    "name",
    "issuer",
    "client_id",
    "deployments",
    "auth_url",
    "token_url",
    "jwks_url",
    "origins",
    "audience",
    "emails_verified",
)
_SERVICE = ("url", "session_hours")


def read_settings(folder: Path) -> Settings:
    """Return the settings in a folder's ``platforms.toml``; without the file, there are no platforms.

    Raises
    ------
    BadInput
        It cannot be read, or a key or value is wrong; the message has the line.
    """
    path = folder / FILE
    if not path.exists():
        return Settings(folder)
    source = source_of(path)
    return _SettingsReader(path, source).settings(table_of(source, str(path)))


class _SettingsReader(TomlReader):
    """Reader of ``platforms.toml``."""

    def settings(self, table: Mapping[str, Any]) -> Settings:
        self.only(table, ("service", "platforms"))
        service, listed = table.get("service", {}), table.get("platforms", [])
        if not isinstance(service, Mapping) or not isinstance(listed, list):
            raise self.refused(["service"], "write [service] with url = …, then [[platforms]]")
        self.only(service, _SERVICE, ["service"], "[service]")
        platforms = tuple(self.platform(number, entry) for number, entry in enumerate(listed))
        self._check_twice(platforms)
        hours = service.get("session_hours", 12)
        if isinstance(hours, bool) or not isinstance(hours, (int, float)) or not 0 < hours <= 168:
            raise self.refused(
                ["service", "session_hours"],
                "session_hours is a number up to 168; found {hours!r}",
                hours=hours,
            )
        return Settings(
            self.path.parent,
            self._url(["service", "url"], service["url"]) if "url" in service else "",
            platforms,
            session_seconds=hours * _HOUR,
        )

    def platform(self, number: int, table: Any) -> LTIPlatform:
        key_path: list[str | int] = ["platforms", number]
        if not isinstance(table, Mapping):
            raise self.refused(key_path, "platforms are tables: [[platforms]], then issuer = …")
        self.only(table, _KEYS, key_path, "[[platforms]]")
        for key in ("issuer", "client_id", "deployments", "auth_url", "token_url", "jwks_url"):
            if not table.get(key):
                raise self.refused(
                    key_path, "a platform needs {key}; 'coursework lti platform' writes one", key=key
                )
        urls = {key: self._url([*key_path, key], table[key]) for key in ("auth_url", "token_url", "jwks_url")}
        # The issuer is compared literally, including a slash at its end.
        self._url([*key_path, "issuer"], table["issuer"])
        return LTIPlatform(
            name=str(table.get("name") or urlsplit(table["issuer"]).hostname),
            issuer=table["issuer"],
            client_id=str(table["client_id"]),
            deployments=self._texts([*key_path, "deployments"], table["deployments"]),
            origins=tuple(
                origin(self._url([*key_path, "origins"], address))
                for address in self._texts([*key_path, "origins"], table.get("origins", []))
            ),
            audience=str(table.get("audience", "")),
            emails_verified=self._truth([*key_path, "emails_verified"], table.get("emails_verified", False)),
            **urls,
        )

    def _truth(self, key_path: Sequence[str | int], value: Any) -> bool:
        if not isinstance(value, bool):
            raise self.refused(
                key_path, "{key} is true or false; found {value!r}", key=key_path[-1], value=value
            )
        return value

    def _texts(self, key_path: Sequence[str | int], value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(
            isinstance(text, (str, int)) and str(text).strip() for text in value
        ):
            raise self.refused(
                key_path, '{key} is a list: ["1"]; found {value!r}', key=key_path[-1], value=value
            )
        return tuple(str(text) for text in value)

    def _url(self, key_path: Sequence[str | int], value: Any) -> str:
        try:
            return checked_url(str(value), str(key_path[-1]))
        except BadInput as fault:
            raise self.refused(key_path, as_message(fault)) from None

    def _check_twice(self, platforms: Sequence[LTIPlatform]) -> None:
        seen: set[tuple[str, str]] = set()
        for number, platform in enumerate(platforms):
            if (platform.issuer, platform.client_id) in seen:
                raise self.refused(
                    ["platforms", number],
                    "{issuer} with client_id {client_id} appears twice; keep one",
                    issuer=platform.issuer,
                    client_id=platform.client_id,
                )
            seen.add((platform.issuer, platform.client_id))


# ---------------------------------------------------------------------- writing


def with_platform(settings: Settings, added: LTIPlatform) -> Settings:
    """Return the settings with one more platform, which replaces another of the same issuer and client."""
    others = [p for p in settings.platforms if (p.issuer, p.client_id) != (added.issuer, added.client_id)]
    return replace(settings, platforms=(*others, added))


def as_toml(settings: Settings) -> str:
    """Return the content of ``platforms.toml``."""
    lines = [
        "# Platforms where this tool is registered: https://www.imsglobal.org/spec/lti/v1p3",
        "[service]",
    ]
    lines += [f"url = {toml_value(settings.url)}  # where browsers find this service"] if settings.url else []
    if settings.session_seconds != 12 * _HOUR:
        lines.append(f"session_hours = {settings.session_seconds / _HOUR:g}")
    for entry in settings.platforms:
        always = ("name", "issuer", "client_id", "deployments", "auth_url", "token_url", "jwks_url")
        stated = [*always, *(k for k in ("origins", "audience", "emails_verified") if getattr(entry, k))]
        lines += ["", "[[platforms]]", *(f"{key} = {toml_value(getattr(entry, key))}" for key in stated)]
    return "\n".join(lines) + "\n"
