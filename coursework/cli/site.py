"""Commands of the site: serve, preview."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from coursework.cli.options import (
    EXISTING_FOLDER,
    SITE_DATABASE,
    NeedingExtra,
    WholeNumber,
    exercise_argument,
    lang_option,
    needing_extra,
    print_notes,
    zone_option,
)
from coursework.cli.printing import say, warn
from coursework.errors import BadInput, unknown
from coursework.system.extras import libraries
from coursework.system.limits import MOST_PORT, MOST_VARIANTS, MOST_WORKERS

if TYPE_CHECKING:
    import socket

    from coursework.site.frame.settings import Entrance

_LIBRARIES = ("argon2", "itsdangerous", "psycopg", "python_multipart", "sqlalchemy", "starlette", "uvicorn")
_LOOPBACK = "127.0.0.1"
#: What is said of a site that runs.
_SITE_RUNS = "coursework: {url}/ (kept in {where}; Ctrl-C ends it)"
_PREVIEW_RUNS = "coursework: {url}/ (follows {where}; Ctrl-C ends it)"

open_option = click.option("--open/--no-open", "opens", help="Open the page in the browser.")


def _ready() -> None:
    libraries(_LIBRARIES, "the site needs", "site")


def _lti_ready() -> None:
    libraries(("cryptography", "httpx", "jwt"), "LTI needs", "lti")


# ------------------------------------------------------------------------ serve


@click.command(cls=NeedingExtra, ready=_ready)
@click.option(
    "--db",
    metavar="URL",
    help=f"Database of the site: a file of SQLite, or postgresql+psycopg://…; by default {SITE_DATABASE} in "
    "the current folder.",
)
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    help="Address to listen on; 0.0.0.0 for every address of the machine.",
)
@click.option(
    "--port",
    type=WholeNumber(0, MOST_PORT),
    default=8000,
    show_default=True,
    help="Port to listen on; 0 for any free one.",
)
@click.option("--url", help="Address for browsers, behind a proxy: https://mechanics.example.org.")
@click.option(
    "--workers",
    type=WholeNumber(1, MOST_WORKERS),
    default=1,
    show_default=True,
    help="Number of server processes.",
)
@click.option(
    "--demo",
    is_flag=False,
    flag_value="",
    metavar="[FOLDER]",
    help=(
        "Serve a demonstration, a class of twelve with its assignment, from a folder or from a temporary one."
    ),
)
@click.option(
    "--administrator",
    metavar="LOGIN",
    help="Print a link with which an administrator chooses a password, and stop.",
)
@click.option(
    "--instructor",
    metavar="LOGIN",
    help="The same for an instructor; the first one of a site is its administrator.",
)
@click.option(
    "--lti",
    is_eager=True,
    callback=needing_extra(_lti_ready),
    type=EXISTING_FOLDER,
    metavar="FOLDER",
    help=("Serve the learning platforms of this folder's platforms.toml under /lti (see 'coursework lti')."),
)
@zone_option
@open_option
@click.pass_context
def serve(
    context: click.Context,
    db: str | None,
    host: str,
    port: int,
    url: str | None,
    workers: int,
    demo: str | None,
    administrator: str | None,
    instructor: str | None,
    lti: Path | None,
    opens: bool,
) -> None:
    """Serve the site: practice for students, a desk for instructors.

    Without --url it is for this machine only and opens without an account. Ctrl-C stops it.
    """
    from coursework.site import server
    from coursework.site.frame.settings import Entrance

    if demo is not None and db is not None:
        raise BadInput("--demo has its own database: omit --db, or name a folder, --demo FOLDER")
    for role, login in (("administrator", administrator), ("instructor", instructor)):
        if login is not None:
            _invite(context.obj, db, login, role, _checked_url(url) if url else f"http://{host}:{port}")
            return
    with _database_of(context.obj, db, demo) as database, server.listening(host, port) as at:
        public_url = _checked_url(url) if url else _address(host, at)
        if lti is not None:
            _check_lti(lti, public_url)
        entrance = _entrance(host, public_url, demo, is_stated=url is not None)
        serving = server.ServerSettings(
            context.obj, database, entrance, public_url, lti, server.worker_name()
        )
        report = serving.check()
        if entrance is Entrance.ACCOUNTS:
            _check_private(database)
        with server.filling(serving), server.working(serving):
            server.serve(serving, at, workers, partial(_tell, _SITE_RUNS, public_url, report, opens))


def _check_private(db: str) -> None:
    """Say where other users of this machine can read the database."""
    from coursework.database.store import file_of, is_shared

    file = file_of(db)
    if is_shared(file):
        warn(
            "note: other users of this machine can read {file}, with all answers and the signing key: "
            "chmod 600 {file}",
            file=file,
        )


def _check_lti(folder: Path, url: str) -> None:
    """Say what is missing before anything is served; a key is made where there is none. Raises BadInput: the
    folder's file is for another address, or cannot be read."""
    from coursework.platforms.lti.keys import KeyFolder
    from coursework.site.lti.service import settings_of

    if not settings_of(folder, url).platforms:
        warn(
            "note: no platform in {folder}: 'coursework lti platform moodle https://… --in {folder}' "
            "adds one",
            folder=folder,
        )
    if not (key_folder := KeyFolder(folder / "keys")).keys:
        print_notes([f"a key was made: {key_folder.new().kid}"])


def _invite(course: str | None, db: str | None, login: str, role: str, url: str) -> None:
    """Print where somebody of the staff chooses a password."""
    from coursework.site.frame.settings import Entrance
    from coursework.site.people.accounts import invited_by_command
    from coursework.site.server import ServerSettings

    site = ServerSettings(course, db or _usual(), Entrance.ACCOUNTS, url).site()
    click.echo(invited_by_command(site, login, role))
    site.store.close()


def _usual() -> str:
    return str(Path(SITE_DATABASE).resolve())


@contextmanager
def _database_of(course: str | None, db: str | None, demo: str | None) -> Iterator[str]:
    """Provide the database's address."""
    if demo is None:
        yield db or _usual()
        return
    from coursework.cli.demo_site import demo_database

    if demo:
        yield demo_database(course, Path(demo))
        return
    with tempfile.TemporaryDirectory(prefix="coursework-", ignore_cleanup_errors=True) as folder:
        yield demo_database(course, Path(folder))


def _address(host: str, at: socket.socket) -> str:
    """Return the URL at which browsers reach a listening socket. Raises BadInput: it listens at every address
    of the machine, and none is given."""
    if host in ("0.0.0.0", "::"):
        raise BadInput(
            "--host {host} needs the address for browsers: --url https://mechanics.example.org", host=host
        )
    return f"http://{f'[{host}]' if ':' in host else host}:{at.getsockname()[1]}"


def _checked_url(url: str) -> str:
    """Return the address that somebody tells. Raises BadInput: it is none, or not that of a whole host."""
    from urllib.parse import urlsplit

    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not parts.hostname or parts.path.strip("/"):
        raise BadInput(
            "--url is the address of a host, https://mechanics.example.org, with no path behind it; "
            "found {url!r}",
            url=url,
        )
    return url.rstrip("/")


def _entrance(host: str, url: str, demo: str | None, *, is_stated: bool) -> Entrance:
    """Return the way of signing in: without an account on this machine alone, unless an address is stated.
    Raises BadInput: a demonstration, where anybody may be anybody, is open to other machines."""
    from urllib.parse import urlsplit

    from coursework.platforms.lti.settings import is_loopback
    from coursework.site.frame.settings import Entrance

    is_own = is_loopback(host) and is_loopback(urlsplit(url).hostname or "")
    if is_own and not (is_stated and demo is None):
        return Entrance.LOCAL if demo is None else Entrance.DEMO
    if demo is not None:
        raise BadInput(
            "in --demo everybody can sign in as anybody: it is for this machine only, without --host "
            "and --url"
        )
    if url.startswith("http:") and not is_own:
        warn(
            "note: {url} is plain http: everybody on the network can read passwords and answers; put a "
            "proxy with https before it",
            url=url,
        )
    return Entrance.ACCOUNTS


def _tell(words: str, url: str, where: str, opens: bool) -> None:
    """Say the address, and open the browser there, where there is a screen."""
    import webbrowser

    say(words, url=url, where=where)
    has_screen = (
        sys.platform in ("win32", "darwin") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )
    if opens and has_screen:
        webbrowser.open(url)
    elif opens:
        warn("note: no screen here: open {url} in a browser", url=url)


# ---------------------------------------------------------------------- preview


@click.command(cls=NeedingExtra, ready=_ready)
@exercise_argument
@click.option(
    "--port", type=WholeNumber(0, MOST_PORT), default=0, help="Port to listen on; by default any free one."
)
@click.option(
    "--variants",
    type=WholeNumber(1, MOST_VARIANTS),
    default=50,
    show_default=True,
    help="Number of variants that each check tries.",
)
@lang_option
@open_option
@click.pass_context
def preview(context: click.Context, exercise: str, port: int, variants: int, lang: str, opens: bool) -> None:
    """Show an exercise while its files are edited: sheet, solution, key and checks, updated at each save.

    The page is for this machine only. Ctrl-C stops it.
    """
    from coursework.course.folder import course_folder
    from coursework.site import server
    from coursework.site.preview.preview_page import preview as pages
    from coursework.site.preview.under_work import EditedExercise

    folder = course_folder(context.obj)
    if exercise not in folder.names:
        raise unknown("exercise", exercise, folder.names, folder.label)
    with server.listening(_LOOPBACK, port) as at:
        work = EditedExercise(context.obj, exercise, variants)
        try:
            announce = partial(_tell, _PREVIEW_RUNS, _address(_LOOPBACK, at), str(folder.root), opens)
            server.run(lambda: pages(work, lang), at, ready=announce)
        finally:
            work.end()
