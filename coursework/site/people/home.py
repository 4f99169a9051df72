"""First page, shared static files, choice of the language, and choice of a person in a demonstration."""

from __future__ import annotations

from urllib.parse import quote

from coursework.database.people import people, person_by_identifier, put_account, put_person
from coursework.database.permissions import ADMINISTRATOR, Permission
from coursework.site.frame.budgets import PLAIN
from coursework.site.frame.limits import FREE
from coursework.site.frame.requests import HTTPException, Request, Response, Route, local
from coursework.site.frame.settings import Entrance, Site

_YEAR = 365 * 24 * 3600


def first(request: Request) -> Response:
    """Redirect to the first page of the current user."""
    if request.person is None:
        return Response(redirect=door_to(request))
    return Response(redirect="/desk" if request.person.may(Permission.DESK) else "/practice")


def door_to(request: Request) -> str:
    """Return the address of the sign-in page, with the requested page as its target."""
    if request.site.entrance is Entrance.DEMO:
        return "/who"
    return "/sign-in" if request.path == "/" else f"/sign-in?after={quote(request.path, safe='/')}"


def shared_file(request: Request) -> Response:
    static_file = request.site.pages.static(str(request.path_params["name"]))
    if static_file is None:
        raise HTTPException("page", 404)
    return Response(media_type=static_file[0], content=static_file[1], max_age=_YEAR)


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
        return Response(redirect="/", signed_in=chosen.id)
    return request.render("site/who", people=persons)


def choose_language(request: Request) -> Response:
    """Switch to the next language; redirect to the page before."""
    if not request.is_post:
        return Response(redirect="/")
    languages = request.site.languages
    after = languages[(languages.index(request.lang) + 1) % len(languages)]
    return Response(redirect=local(request.form.text("back")), lang=after)


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
    Route("/static/{name}", shared_file, Permission.PUBLIC, limit=FREE),
    Route("/language", choose_language, Permission.PUBLIC, takes_forms=True, budget=PLAIN),
    Route("/who", choose_person, Permission.PUBLIC, takes_forms=True, budget=PLAIN),
)
