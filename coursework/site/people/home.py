"""First page, shared static files, choice of the language, and choice of a person in a demonstration."""

from __future__ import annotations

from hashlib import sha256
from urllib.parse import quote

from starlette.responses import Response

from coursework.database.people import people, person_by_identifier, put_account, put_person
from coursework.database.permissions import ADMINISTRATOR, Permission
from coursework.site.frame.budgets import PLAIN
from coursework.site.frame.cookies import LANG
from coursework.site.frame.limits import FREE
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import redirect, set_cookie
from coursework.site.frame.settings import Entrance, Site
from coursework.site.people.accounts import signed_in

_YEAR = 365 * 24 * 3600


def first(request: Request) -> Response:
    """Redirect to the first page of the current user."""
    if request.person is None:
        return redirect(door_to(request))
    return redirect("/desk" if request.person.may(Permission.DESK) else "/practice")


def door_to(request: Request) -> str:
    """Return the address of the sign-in page, with the requested page as its target."""
    if request.site.entrance is Entrance.DEMO:
        return "/who"
    return "/sign-in" if request.path == "/" else f"/sign-in?after={quote(request.path, safe='/')}"


def shared_file(request: Request) -> Response:
    """Return a static file, whose address changes with it."""
    static_file = request.site.pages.static(str(request.path_params["name"]))
    if static_file is None:
        raise HTTPException("page", 404)
    media_type, data = static_file
    tag = f'"{sha256(data).hexdigest()[:20]}"'
    headers = {"cache-control": f"public, max-age={_YEAR}, immutable", "etag": tag}
    if tag in request.headers.get("if-none-match", ""):
        return Response(status_code=304, headers=headers)
    return Response(data, headers=headers, media_type=media_type)


def service_worker(request: Request) -> Response:
    """Return the script that opens seen pages without a network; it stands at the root, since it is for all
    pages."""
    static_file = request.site.pages.static("service-worker.js")
    assert static_file is not None
    return Response(static_file[1], media_type=static_file[0])


def offline(request: Request) -> Response:
    """Return the page that stands for one that was not seen before the network went."""
    return request.render("site/offline", title=request.words["offline"]["title"])


def accessibility(request: Request) -> Response:
    """Return the declaration of accessibility."""
    return request.render("site/accessibility", title=request.words["accessibility"]["title"])


def choose_person(request: Request) -> Response:
    """Choose the current user; only in a demonstration."""
    if request.site.entrance is not Entrance.DEMO:
        raise HTTPException("page", 404)
    with request.site.store.reading() as connection:
        persons = people(connection)
    if request.is_post:
        chosen = next((person for person in persons if str(person.id) == request.form.text("person")), None)
        if chosen is None:
            raise HTTPException("own", 404)
        return signed_in(request, "/", chosen.id)
    return request.render("site/who", people=persons)


def choose_language(request: Request) -> Response:
    """Switch to the next language; redirect to the page before."""
    if not request.is_post:
        return redirect("/")
    languages = request.site.languages
    after = languages[(languages.index(request.lang) + 1) % len(languages)]
    response = redirect(request.form.text("back"))
    set_cookie(request, response, LANG, after, _YEAR)
    return response


def owner(site: Site) -> int:
    """Return the owner of a site on their own machine: an administrator who is also a student."""
    with site.store.reading() as connection:
        existing = person_by_identifier(connection, "owner")
    if existing is not None and existing.role:
        return int(existing.id)
    with site.store.begin() as connection:
        person = put_person(connection, identifier="owner", name="", lang="", columns={})
        put_account(connection, person, login="owner", role=ADMINISTRATOR)
    return person


ROUTES = (
    Route("/", first, Permission.PUBLIC),
    Route("/service-worker.js", service_worker, Permission.PUBLIC, limit=FREE),
    Route("/offline", offline, Permission.PUBLIC),
    Route("/accessibility", accessibility, Permission.PUBLIC),
    Route("/static/{name}", shared_file, Permission.PUBLIC, limit=FREE),
    Route("/language", choose_language, Permission.PUBLIC, takes_forms=True, budget=PLAIN),
    Route("/who", choose_person, Permission.PUBLIC, takes_forms=True, budget=PLAIN),
)
