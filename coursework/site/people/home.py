"""The first page, the files that all pages share, the choice of a language, and of who to be in a demonstration."""

from __future__ import annotations

from urllib.parse import quote

from coursework.database.people import people, person_by_who, put_account, put_person
from coursework.database.permissions import ADMINISTRATOR, Permission
from coursework.site.frame.budgets import PLAIN
from coursework.site.frame.limits import FREE
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.visits import Page, Refused, Reply, Visit, local

_YEAR = 365 * 24 * 3600


def first(visit: Visit) -> Reply:
    """Redirect to the first page of the current user."""
    if visit.person is None:
        return Reply(goto=door_to(visit))
    return Reply(goto="/desk" if visit.person.may(Permission.DESK) else "/practice")


def door_to(visit: Visit) -> str:
    """Return the address of the sign-in page, with the requested page as its target."""
    if visit.site.entrance is Entrance.DEMO:
        return "/who"
    return "/sign-in" if visit.address == "/" else f"/sign-in?after={quote(visit.address, safe='/')}"


def shared_file(visit: Visit) -> Reply:
    found = visit.site.pages.static(str(visit.path["name"]))
    if found is None:
        raise Refused("page", 404)
    return Reply(kind=found[0], data=found[1], keep=_YEAR)


def choose_person(visit: Visit) -> Reply:
    """Choose the current user, in a demonstration alone."""
    if visit.site.entrance is not Entrance.DEMO:
        raise Refused("page", 404)
    with visit.site.store.reading() as connection:
        known = people(connection)
    if visit.posted:
        chosen = next((one for one in known if str(one.id) == visit.form.text("person")), None)
        if chosen is None:
            raise Refused("own", 404)
        return Reply(goto="/", signed_in=chosen.id)
    return visit.page("site_who", people=known)


def choose_language(visit: Visit) -> Reply:
    """Switch to the next language; redirect to the page before."""
    if not visit.posted:
        return Reply(goto="/")
    known = visit.site.languages
    after = known[(known.index(visit.lang) + 1) % len(known)]
    return Reply(goto=local(visit.form.text("back")), lang=after)


def owner(site: Site) -> int:
    """Return the owner of a site on their own machine: an administrator who is also a student."""
    with site.store.reading() as connection:
        known = person_by_who(connection, "owner")
    if known is not None and known.role:
        return int(known.id)
    with site.store.begin() as connection:
        person = put_person(connection, who="owner", name="", lang="", columns={})
        put_account(connection, person, login="owner", role=ADMINISTRATOR)
    return person


PAGES = (
    Page("/", first, Permission.PUBLIC),
    Page("/static/{name}", shared_file, Permission.PUBLIC, limit=FREE),
    Page("/language", choose_language, Permission.PUBLIC, posts=True, budget=PLAIN),
    Page("/who", choose_person, Permission.PUBLIC, posts=True, budget=PLAIN),
)
