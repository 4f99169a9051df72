"""ASGI application of the site, with the table of its routes."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, nullcontext
from functools import partial

from anyio.to_thread import current_default_thread_limiter
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware as StarletteMiddleware
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES, GZipMiddleware
from starlette.routing import BaseRoute, Mount
from starlette.routing import Route as StarletteRoute

from coursework.site import health
from coursework.site.desk import (
    after_exam,
    class_page,
    files,
    overview,
    printing,
    question_page,
    queue,
    regrading,
    rejected_rows,
    scans,
    semester_page,
    student_page,
)
from coursework.site.frame.arrivals import Arrivals
from coursework.site.frame.middleware import Middleware
from coursework.site.frame.requests import Route
from coursework.site.frame.settings import Site
from coursework.site.frame.threads import PAGES_AT_ONCE
from coursework.site.lessons import lessons_page
from coursework.site.lti import connecting, links_page
from coursework.site.mechanisms import mechanisms_page
from coursework.site.papers import assignments
from coursework.site.people import accounts, extra_time, home, people_page, privacy, scrubbing
from coursework.site.practice import explore_page, practice_page, progress_page
from coursework.site.publication import publishing
from coursework.site.warming import begin_warming
from coursework.system.headers import Guarded

#: Routes of the site, module by module.
ROUTES: tuple[Route, ...] = (
    *home.ROUTES,
    *practice_page.ROUTES,
    *lessons_page.ROUTES,
    *explore_page.ROUTES,
    *progress_page.ROUTES,
    *accounts.ROUTES,
    *extra_time.ROUTES,
    *people_page.ROUTES,
    *privacy.ROUTES,
    *overview.ROUTES,
    *semester_page.ROUTES,
    *links_page.ROUTES,
    *connecting.ROUTES,
    *queue.ROUTES,
    *after_exam.ROUTES,
    *assignments.ROUTES,
    *publishing.ROUTES,
    *mechanisms_page.ROUTES,
    *printing.ROUTES,
    *class_page.ROUTES,
    *student_page.ROUTES,
    *question_page.ROUTES,
    *files.ROUTES,
    *rejected_rows.ROUTES,
    *scans.ROUTES,
    *regrading.ROUTES,
)


#: A CSRF token is masked anew on each page, so that its compressed length reveals nothing. PDF is compressed
#: already.
_COMPRESSION = StarletteMiddleware(
    GZipMiddleware,
    minimum_size=1000,
    compresslevel=6,
    exclude_content_types=(*DEFAULT_EXCLUDED_CONTENT_TYPES, "application/pdf"),
)


def application(site: Site, lti: Starlette | None = None) -> Starlette:
    """Return the ASGI application of the site; ``lti`` is the service for learning platforms, by default that
    of the site's folder."""
    middleware = Middleware(site)
    lti = lti or _lti(site)
    routes: list[BaseRoute] = [
        StarletteRoute(
            route.path,
            partial(middleware.answer, asked=route),
            methods=["GET", "POST"] if route.takes_forms else ["GET"],
            name=route.path,
            middleware=[_COMPRESSION],
        )
        for route in ROUTES
    ]
    routes.append(StarletteRoute(health.PATH, health.Health(site).answer, methods=["GET"]))
    if lti is not None:
        routes.append(Mount("/lti", app=lti))
    app = Starlette(
        routes=routes,
        exception_handlers={HTTPException: middleware.answer},
        lifespan=lambda app: _background_work(site, lti),
    )
    app.add_middleware(Guarded, is_secure=lambda: site.is_secure)
    app.router.redirect_slashes = False  # such a redirect would lead to any host that a request names
    app.add_middleware(Arrivals, clock=lambda: site.clock())
    return app


def _lti(site: Site) -> Starlette | None:
    """Return the service for learning platforms; None if the site has none."""
    if site.lti is None:
        return None
    from coursework.site.lti.service import mounted

    return mounted(site, site.lti)


@asynccontextmanager
async def _background_work(site: Site, lti: Starlette | None) -> AsyncIterator[None]:
    """Run the background work of the site while it is served."""
    current_default_thread_limiter().total_tokens = PAGES_AT_ONCE
    stop = begin_warming(site)
    if scrubbing.is_left(site):
        scrubbing.scrub_until_done(site, stop)
    async with lti.router.lifespan_context(lti) if lti else nullcontext():
        yield
    stop.set()
