"""The site in the system's Chromium: a server on the loopback interface, pages of a telephone and of a
desk."""

import os
import re
import shutil
import threading
import time
from contextlib import contextmanager
from urllib.parse import urlsplit

import pytest
from site_people import Class

WIDTHS = {"telephone": (390, 844), "desk": (1280, 900)}


def chromium_path():
    """Where Chromium is; the test is skipped where it is not."""
    named = os.environ.get("COURSEWORK_CHROMIUM")
    found = named or next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )
    if not found:
        pytest.skip("no Chromium here; COURSEWORK_CHROMIUM names one")
    return found


@contextmanager
def served(class_, port=0):
    """The site of a class behind a server of its own, in a thread; gives its address."""
    import uvicorn

    config = uvicorn.Config(class_.app, host="127.0.0.1", port=port, log_level="warning")
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    until = time.monotonic() + 60
    while not server.started:
        assert time.monotonic() < until, "the server did not start"
        time.sleep(0.02)
    number = server.servers[0].sockets[0].getsockname()[1]
    try:
        yield f"http://127.0.0.1:{number}"
    finally:
        server.should_exit = True
        thread.join(20)


@contextmanager
def windows(desk, name):
    """Makes windows of somebody, each opened at an address; ``desk`` is a class, the address of its site, and
    a browser."""
    class_, address, browser = desk
    opened = []

    def open_(place, **how):
        context = context_of(browser, class_, address, how.pop("name", name), **how)
        opened.append(context)
        page = context.new_page()
        page.goto(f"{address}{place}")
        return page

    yield open_
    for context in opened:
        context.close()


@contextmanager
def desk_at(folder):
    """A class whose site stands behind a server, its address, and a browser."""
    class_ = Class(f"sqlite:///{folder}/site.db")
    with served(class_) as address, chromium() as browser:
        yield class_, address, browser


@contextmanager
def chromium():
    """A browser, for all tests of a process; the test is skipped where the extra is not installed."""
    playwright = pytest.importorskip("playwright.sync_api", reason="browsers need pip install -e '.[e2e]'")

    with playwright.sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium_path(), args=["--no-sandbox", "--disable-gpu"]
        )
        yield browser
        browser.close()


def context_of(browser, class_, address, name=None, lang="en", size="telephone", script=True, **more):
    """A browser's window of somebody: their session, language and screen."""
    from site_people import signed_in

    from coursework.site.frame.cookies import COOKIE

    width, height = WIDTHS[size]
    context = browser.new_context(
        locale=lang,
        viewport={"width": width, "height": height},
        has_touch=size == "telephone",
        java_script_enabled=script,
        **more,
    )
    context.set_default_timeout(90_000)  # a busy machine is no fault
    if name is not None:
        cookie = signed_in(class_.site.store, class_.ids[name])
        host = urlsplit(address).hostname
        context.add_cookies([{"name": COOKIE, "value": cookie, "domain": host, "path": "/"}])
    return context


def told(page, words):
    """Wait until the page tells so of saving."""
    from playwright.sync_api import expect

    expect(page.locator("[data-kept], [data-kept-left]")).to_contain_text(re.compile(words), timeout=30_000)


def serious(page):
    """What axe finds serious or critical on a page: id, and where."""
    from axe_core_python.sync_playwright import Axe

    found = Axe().run(page)["violations"]
    return [
        (one["id"], [node["target"] for node in one["nodes"]][:3])
        for one in found
        if one["impact"] in ("serious", "critical")
    ]


def too_wide(page):
    """By how many pixels a page is wider than its screen."""
    return page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")


#: Texts and controls that a screen cuts at its side, where nothing can be scrolled to see them.
_CUT = """() => {
  const wide = document.documentElement.clientWidth, found = new Set();
  const scrolls = (one) => one && one !== document.documentElement &&
    (["auto", "scroll"].includes(getComputedStyle(one).overflowX) || scrolls(one.parentElement));
  const look = (one, box) => {
    const is_out = box.right > wide + 1 || box.left < -1;
    if (box.width && box.height && is_out && one.checkVisibility({ visibilityProperty: true })
        && !one.closest(".visually-hidden, .skip, svg, script, style, noscript") && !scrolls(one))
      found.add(`${one.outerHTML.slice(0, 90)} ${Math.round(box.left)} to ${Math.round(box.right)} px`);
  };
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const range = document.createRange();
    range.selectNodeContents(texts.currentNode);
    if (!texts.currentNode.data.trim()) continue;
    for (const box of range.getClientRects()) look(texts.currentNode.parentElement, box);
  }
  for (const one of document.querySelectorAll("button, input, select, textarea, img, summary, a[href]"))
    look(one, one.getBoundingClientRect());
  return Array.from(found).slice(0, 5);
}"""


def cut_at_side(page):
    """What of a page sticks out of its screen, where no scrolling shows it."""
    return page.evaluate(_CUT)


def enlarge_letters(page, percent=200):
    """Set the size of letters as somebody does in the settings of a browser, before a page is opened."""
    sizes = {"standard": 16 * percent // 100, "fixed": 13 * percent // 100}
    page.context.new_cdp_session(page).send("Page.setFontSizes", {"fontSizes": sizes})


#: Controls that a thumb does not hit; links within a text are none.
_LOW = """() => {
  const inText = (one) => one.tagName === "A" && getComputedStyle(one).display === "inline"
    && one.closest("p, td, dd, li, h2, h3, summary");
  const room = (one) =>
    (["checkbox", "radio"].includes(one.type) ? one.closest("label") || one : one).getBoundingClientRect();
  const all = "button, input:not([type=hidden]), select, textarea, summary, a[href]";
  return Array.from(document.querySelectorAll(all))
    .filter((one) => one.checkVisibility({ visibilityProperty: true }))
    .filter((one) => !one.closest(".visually-hidden, .skip") && !inText(one))
    .filter((one) => room(one).height > 0 && room(one).height < 43.5)
    .map((one) => `${one.outerHTML.slice(0, 90)} ${room(one).height.toFixed(0)} px`);
}"""


def low(page):
    """The controls of a page that are lower than a thumb needs."""
    return page.evaluate(_LOW)


def watched(page):
    """What goes wrong behind a page, as it happens: its console's errors, requests that fail, scripts that
    stop."""
    found = []
    page.on("console", lambda one: found.append(one.text) if one.type in ("error", "warning") else None)
    page.on("pageerror", lambda fault: found.append(str(fault)))
    page.on("requestfailed", lambda one: None if _ended(one) else found.append(f"failed: {one.url}"))
    page.on("response", lambda one: found.append(f"{one.status}: {one.url}") if one.status >= 400 else None)
    return found


def _ended(request):
    """A request that the browser itself ended: it became a file to keep, or the page was left."""
    return "ERR_ABORTED" in (request.failure or "")


def cut_in_print(page):
    """By how many pixels a page is wider than a sheet of A4 when it is printed, and what still sticks to the
    screen."""
    page.emulate_media(media="print")
    size = page.viewport_size
    page.set_viewport_size({"width": 660, "height": 1000})  # 174 mm at 96 px an inch
    stuck = page.evaluate(
        """() => Array.from(document.querySelectorAll("main *"))
        .filter((one) => ["sticky", "fixed"].includes(getComputedStyle(one).position))
        .filter((one) => one.checkVisibility() && one.tagName !== "TH")
        .map((one) => one.className)"""
    )
    found = (too_wide(page), stuck)
    page.emulate_media(media="screen")
    page.set_viewport_size(size)
    return found
