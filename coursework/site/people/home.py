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
    """Where who comes goes on."""
    if visit.person is None:
        return Reply(goto=door_to(visit))
    return Reply(goto="/desk" if visit.person.may(Permission.DESK) else "/practice")


def door_to(visit: Visit) -> str:
    """Where one comes in, to go on to the page that was asked for."""
    if visit.site.entrance is Entrance.DEMO:
        return "/who"
    return "/sign-in" if visit.address == "/" else f"/sign-in?after={quote(visit.address, safe='/')}"


def shared_file(visit: Visit) -> Reply:
    found = visit.site.pages.static(str(visit.path["name"]))
    if found is None:
        raise Refused("page", 404)
    return Reply(kind=found[0], data=found[1], keep=_YEAR)


def choose_person(visit: Visit) -> Reply:
    """Who to be: in a demonstration alone."""
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
    """The other languages in turn; back to the page that asked."""
    if not visit.posted:
        return Reply(goto="/")
    known = visit.site.languages
    after = known[(known.index(visit.lang) + 1) % len(known)]
    return Reply(goto=local(visit.form.text("back")), lang=after)


def owner(site: Site) -> int:
    """Who opens the site on their own machine: staff, and their own student."""
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
