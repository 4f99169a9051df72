"""Commands of learning platforms by LTI 1.3: lti platform, keys, scores, roster."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import click

from coursework.cli.help_pages import HelpfulGroup
from coursework.cli.options import (
    DONE,
    FILE,
    FOLDER,
    FOUND,
    SITE_DATABASE,
    NeedingExtra,
    database_ready,
    json_option,
)
from coursework.cli.printing import print_json, print_table, say, warn
from coursework.errors import BadInput, counted, nearest
from coursework.messages import Message, localised
from coursework.system.extras import libraries

if TYPE_CHECKING:
    from coursework.platforms.lti.settings import LTIPlatform, Settings
    from coursework.platforms.lti.storage import Storage

_LIBRARIES = ("cryptography", "httpx", "jwt")
KINDS = ("moodle", "canvas", "other")

folder_option = click.option(
    "--in",
    "folder",
    type=FOLDER,
    default="lti",
    show_default=True,
    help="Folder of the platforms and the keys.",
)
db_option = click.option(
    "--db",
    metavar="URL",
    default=SITE_DATABASE,
    show_default=True,
    help="Database of the site, as for 'serve'.",
)


def _ready() -> None:
    libraries(_LIBRARIES, "LTI needs", "lti")


def _stored_ready() -> None:
    _ready()
    database_ready()


@click.group(cls=HelpfulGroup)
def lti() -> None:
    """Open exercises from a learning platform and send points back, by LTI 1.3.

    Begin with 'lti keys new', 'lti platform moodle https://…' and 'serve --lti lti'.
    """


# --------------------------------------------------------------------- platform


@lti.command(cls=NeedingExtra, ready=_ready)
@click.argument("kind", required=False, metavar="[moodle|canvas|other]")
@click.argument("site", required=False)
@folder_option
@click.option("--client-id", help="ID of this tool on the platform.")
@click.option(
    "--deployment", "deployments", multiple=True, help="A deployment ID; the option may be repeated."
)
@click.option("--url", help="Address of the links for browsers: https://exercises.example.org/lti.")
@click.option("--name", default="", help="Name of the platform in logs.")
@click.option("--issuer", help="Needed if it does not follow from the kind of platform.")
@click.option("--auth-url", help="Needed if it does not follow from the kind of platform.")
@click.option("--token-url", help="Needed if it does not follow from the kind of platform.")
@click.option("--jwks-url", help="Needed if it does not follow from the kind of platform.")
@click.option("--check", is_flag=True, help="Ask each platform for its keys and for a token.")
@json_option
def platform(
    kind: str | None,
    site: str | None,
    folder: Path,
    client_id: str | None,
    deployments: Sequence[str],
    url: str | None,
    name: str,
    check: bool,
    as_json: bool,
    **addresses: str | None,
) -> int:
    """Register a platform, or list the registered ones.

    First, without --client-id, the command prints the values for the platform's registration page; the
    platform then shows the client ID and the deployment ID.
    """
    from dataclasses import replace

    from coursework.platforms.lti.settings import checked_url, read_settings

    settings = read_settings(folder)
    settings = replace(settings, url=checked_url(url, "--url")) if url else settings
    if kind is None:
        if url:
            _write(settings)
        return _list(settings, check, as_json)
    added = _platform(kind, site, client_id, deployments, name, addresses)
    if added is None:
        _write(settings)
        _tell_registration(settings, kind)
        return DONE
    from coursework.platforms.lti.settings import with_platform

    settings = with_platform(settings, added)
    _write(settings)
    click.echo(
        f"{settings.folder / 'platforms.toml'} knows {added.name} ({added.issuer}, client {added.client_id})"
    )
    return _list(settings, check, as_json) if check else DONE


def _platform(
    kind: str,
    site: str | None,
    client_id: str | None,
    deployments: Sequence[str],
    name: str,
    addresses: dict[str, str | None],
) -> LTIPlatform | None:
    """Return the named platform; none as long as its client ID is unknown."""
    from coursework.platforms.lti.settings import KINDS as known
    from coursework.platforms.lti.settings import LTIPlatform, checked_url
    from coursework.system.headers import origin

    if kind not in KINDS:
        raise BadInput("no kind of platform {kind!r}{nearest}", kind=kind, nearest=nearest(kind, KINDS))
    if site is None:
        raise BadInput(
            "state its address: coursework lti platform {kind} https://{kind}.example.org", kind=kind
        )
    base = checked_url(site, "the site")
    endpoints: dict[str, Any] = known[kind](base) if kind in known else {"issuer": base}
    endpoints |= {key: text for key, text in addresses.items() if text}
    if client_id is None and not deployments:
        return None
    if not client_id or not deployments:
        raise BadInput("a platform has a --client-id and a --deployment; its registration page shows both")
    for key in ("auth_url", "token_url", "jwks_url"):
        if not endpoints.get(key):
            raise BadInput(
                "--{replace} is missing: it does not follow from {kind}",
                replace=key.replace("_", "-"),
                kind=kind,
            )
        endpoints[key] = checked_url(str(endpoints[key]), f"--{key.replace('_', '-')}")
    origins = tuple(origin(checked_url(address, "the site")) for address in endpoints.pop("origins", ()))
    host = urlsplit(base).hostname or base
    return LTIPlatform(
        name=name or host, client_id=client_id, deployments=tuple(deployments), origins=origins, **endpoints
    )


def _write(settings: Settings) -> None:
    from coursework.platforms.lti.settings import FILE, as_toml
    from coursework.system.writing import writing

    with writing(settings.folder):
        settings.folder.mkdir(parents=True, exist_ok=True)
        part = settings.folder / f"{FILE}.part"
        part.write_text(as_toml(settings), "utf-8")
        part.replace(settings.folder / FILE)


def _tell_registration(settings: Settings, kind: str) -> None:
    """Print the values to fill in on the page where a platform registers a tool."""
    url = settings.url or "https://WHERE-THE-SITE-IS/lti"
    say("On the platform, register an LTI 1.3 tool with:")
    rows = [
        ("tool URL", f"{url}/launch"),
        ("initiate login URL", f"{url}/login"),
        ("redirection URI", f"{url}/launch"),
        ("public keyset URL", f"{url}/jwks"),
        ("content selection (deep linking) URL", f"{url}/launch"),
        (Message("services"), Message("grades (with columns), names and roles")),
        (Message("privacy"), Message("share the name, and the e-mail address if the roster is to have it")),
    ]
    for label, value in rows:
        click.echo(f"  {localised(label):<38}{localised(value)}")
    say(
        "It then shows a client ID and a deployment ID: coursework lti platform {kind} … --client-id "
        "ID --deployment ID",
        kind=kind,
    )
    if not settings.url:
        warn(
            "note: state its address with --url https://exercises.example.org/lti: that of the site, "
            "with /lti behind it"
        )


def _list(settings: Settings, check: bool, as_json: bool) -> int:
    from dataclasses import asdict

    faults = {
        registered: _checked(settings, registered) if check else "" for registered in settings.platforms
    }
    if as_json:
        print_json(
            [
                {**asdict(registered), **({"answers": not why, "said": why} if check else {})}
                for registered, why in faults.items()
            ]
        )
    elif not faults:
        say(
            "no platform in {folder}: coursework lti platform moodle https://moodle.example.org",
            folder=settings.folder,
        )
    else:
        rows = [
            {
                "platform": registered.name,
                "issuer": registered.issuer,
                "client": registered.client_id,
                "deployments": ", ".join(registered.deployments),
                **({"answers": why or "yes"} if check else {}),
            }
            for registered, why in faults.items()
        ]
        print_table(rows, settings.url)
    return FOUND if any(faults.values()) else DONE


def _checked(settings: Settings, registered: LTIPlatform) -> str:
    """Return the fault of a platform; an empty text where it gives its keys, and a token for ours."""
    import httpx

    from coursework.errors import CourseworkError
    from coursework.platforms.lti.keys import KeyFolder
    from coursework.platforms.lti.services import SCORE, Services

    with httpx.Client(timeout=8.0, trust_env=False) as client:
        try:
            answer = client.get(registered.jwks_url)
            if not answer.is_success or not answer.json().get("keys"):
                return f"no keys at {registered.jwks_url}: it answers {answer.status_code}"
            Services(client, KeyFolder(settings.folder / "keys")).token(registered, [SCORE])
        except (httpx.HTTPError, ValueError, AttributeError) as fault:
            return f"{registered.jwks_url}: {type(fault).__name__}"
        except CourseworkError as fault:
            return f"{fault}; can it read {settings.url}/jwks?"
    return ""


# ------------------------------------------------------------------------- keys


@lti.command(cls=NeedingExtra, ready=_ready)
@click.argument("action", default="list", metavar="[list|new|rotate|retire]")
@click.argument("kid", required=False)
@folder_option
@json_option
def keys(action: str, kid: str | None, folder: Path, as_json: bool) -> None:
    """Create, list, rotate or retire the keys of the tool.

    'rotate' creates a key that signs from now on. The one before stays public, since platforms cache keys,
    until 'retire KID' removes it.
    """
    from coursework.platforms.lti.keys import KeyFolder

    key_folder = KeyFolder(folder / "keys")
    if action not in ("list", "new", "rotate", "retire"):
        raise BadInput(
            "keys takes list, new, rotate or retire; found {action!r}{nearest}",
            action=action,
            nearest=nearest(action, ("list", "new", "rotate", "retire")),
        )
    if (kid is None) == (action == "retire"):
        if action == "retire":
            raise BadInput("state the key: coursework lti keys retire KID")
        raise BadInput("'keys {action}' takes no key", action=action)
    if action == "new" and key_folder.keys:
        raise BadInput(
            "{folder} has a key already; 'coursework lti keys rotate' makes another", folder=key_folder.folder
        )
    if action in ("new", "rotate"):
        say("{key} signs from now on", key=key_folder.new().kid)
    elif action == "retire":
        say("{key} is removed: what it signed is refused from now on", key=key_folder.retire(kid or "").kid)
    else:
        rows = [
            {"key": key.kid, "made": key.made, "signs": "yes" if key == key_folder.keys[-1] else ""}
            for key in key_folder.keys
        ]
        if as_json:
            print_json(rows)
        elif rows:
            print_table(rows, "")
        else:
            say("no key in {folder}: coursework lti keys new", folder=key_folder.folder)


# --------------------------------------------------------------- scores, roster


@lti.command(cls=NeedingExtra, ready=_stored_ready)
@folder_option
@db_option
@click.option("--send", is_flag=True, help="Try now to send the points that wait.")
@json_option
@click.pass_context
def scores(context: click.Context, folder: Path, db: str, send: bool, as_json: bool) -> int:
    """List the points that have not reached their gradebook, and why; the exit status is 1 if some wait."""
    storage = _storage(context, db)
    if send:
        _send(folder, storage)
    every = storage.scores()
    rows = [
        {
            "link": entry.launch.link_title or entry.launch.link,
            "person": entry.name,
            "points": f"{entry.score.given:g}/{entry.score.maximum:g}",
            "tries": entry.failures,
            "why": entry.problem,
        }
        for entry in every
        if entry.due is not None
    ]
    if as_json:
        print_json(rows)
    elif rows:
        print_table(rows, "")
    click.echo(f"{counted(len(every) - len(rows), 'score')} arrived, {len(rows)} waiting", err=True)
    return FOUND if rows else DONE


def _storage(context: click.Context, db: str) -> Storage:
    from coursework.cli.database import store_at
    from coursework.platforms.lti.storage import Storage

    return Storage(store_at(context, db))


def _send(folder: Path, storage: Storage) -> None:
    import httpx

    from coursework.platforms.lti.keys import KeyFolder
    from coursework.platforms.lti.sending import Sender
    from coursework.platforms.lti.services import Services
    from coursework.platforms.lti.settings import read_settings

    storage.hurry()
    with httpx.Client(timeout=8.0, trust_env=False) as client:
        sender = Sender(read_settings(folder), storage, Services(client, KeyFolder(folder / "keys")))
        while sum(sender.send_due()):
            pass


@lti.command(cls=NeedingExtra, ready=_stored_ready)
@click.argument("course_title", required=False, metavar="[COURSE]")
@folder_option
@db_option
@click.option("--out", type=FILE, help="CSV to write; by default the list is printed.")
@click.pass_context
def roster(context: click.Context, course_title: str | None, folder: Path, db: str, out: Path | None) -> None:
    """Write the class list of a platform as a CSV for 'build --roster'.

    COURSE is the title of the course, or its beginning; without it, the courses that were opened from a
    platform are listed.
    """
    import httpx

    from coursework.platforms.lti.class_list import as_csv
    from coursework.platforms.lti.keys import KeyFolder
    from coursework.platforms.lti.services import Services
    from coursework.platforms.lti.settings import read_settings

    courses = _storage(context, db).courses()
    if course_title is None:
        for course in courses:
            click.echo(f"{course.title}  ({course.issuer})")
        if not courses:
            say("no course yet: open a link of this tool from one, as its teacher")
        return
    matches = [course for course in courses if course.title.casefold().startswith(course_title.casefold())]
    if len(matches) != 1:
        titles = [course.title for course in courses]
        raise BadInput(
            "{count} courses begin with {title!r}{nearest}",
            count=len(matches),
            title=course_title,
            nearest="" if matches else nearest(course_title, titles),
        )
    (course,) = matches
    registered = read_settings(folder).platform(course.issuer, course.client)
    if registered is None:
        raise BadInput("{issuer} is no longer in {folder}", issuer=course.issuer, folder=folder)
    with httpx.Client(timeout=8.0, trust_env=False) as client:
        text = as_csv(Services(client, KeyFolder(folder / "keys")).roster(registered, course.memberships))
    if out is None:
        click.echo(text, nl=False)
    else:
        out.write_text(text, "utf-8-sig", newline="")
        click.echo(f"{out}: {counted(text.count(chr(10)) - 1, 'student')}")
