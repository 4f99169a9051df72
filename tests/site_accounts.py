"""Signing in with a password, as browsers without a browser do it."""

from site_people import HOME

from coursework.site.people import accounts

PASSWORD = "a lamp by the window"


def invite(a_class, name, role="student"):
    """Where somebody chooses a password."""
    with a_class.site.store.begin() as connection:
        login = f"{name.split()[0].lower()}@example.org"
        return accounts.invited(a_class.site, connection, a_class.ids[name], login, role).removeprefix(HOME)


def join(a_class, name, password=PASSWORD):
    """A browser of somebody who has just chosen a password."""
    browser = a_class.browser()
    reply = browser.fill(invite(a_class, name), {"password": password, "again": password})
    assert reply.status_code == 303, reply.text
    return browser


def sign_in(a_class, login, password, browser=None):
    browser = browser or a_class.browser()
    return browser, browser.fill("/sign-in", {"login": login, "password": password})


def is_in(browser):
    return browser.get("/account").status_code == 200
