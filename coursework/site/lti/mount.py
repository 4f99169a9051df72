"""The LTI service within the site, under ``/lti``: its own cookies, headers and refusals, beside those of the site."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coursework.errors import BadInput
from coursework.lti.pages import LTIPages
from coursework.lti.service import service
from coursework.lti.settings import Settings, checked_url, read_settings
from coursework.lti.storage import Storage
from coursework.site.frame.settings import Site
from coursework.site.lti.scores import ScoreWatch
from coursework.site.lti.site_host import SiteHost

if TYPE_CHECKING:
    from starlette.applications import Starlette

PATH = "/lti"


def settings_of(folder: Path, url: str) -> Settings:
    """Return the settings of the platforms in a folder, for a site at an address.

    Raises
    ------
    BadInput
        The file cannot be read, or was written for a service at another address.
    """
    settings, due = read_settings(folder), checked_url(url, "the site's --url") + PATH
    if settings.url not in ("", due):
        raise BadInput(
            "{folder}: platforms.toml is for a service at {found}, and the site has it at {due}: "
            "coursework lti platform --in {folder} --url {due}, and register that address on the platform",
            folder=folder,
            found=settings.url,
            due=due,
        )
    return replace(settings, url=due)


def mounted(site: Site, folder: Path, client: Any = None, settings: Settings | None = None) -> Starlette:
    """Return the service with the site as its host; ``state.watch`` is the thread that looks for changed
    scores."""
    storage = Storage(folder)
    app = service(
        settings or settings_of(folder, site.url), SiteHost(site, storage), LTIPages(site.course.folder), storage=storage,
        client=client,
    )  # fmt: skip
    app.state.watch = ScoreWatch(site, storage, app.state.sender.wake)
    app.router.lifespan_context = _with_watch(app.router.lifespan_context)
    return app


def _with_watch(running: Callable[[Any], Any]) -> Callable[[Any], Any]:
    @asynccontextmanager
    async def both(app: Any) -> AsyncIterator[None]:
        async with running(app):
            app.state.watch.start()
            yield
            app.state.watch.stop()

    return both
