"""Every page of the site in Chromium, on a telephone and on a desk, in French and English: it fits, it is
read aloud, it is what its title says, a thumb hits what there is, nothing fails behind it, and it prints."""

import pytest
from site_browser import chromium, context_of, cut_in_print, low, serious, served, too_wide, watched
from site_lived import EXERCISE, NO_PAGES, STUDENT, Lived, shown
from site_walk import Forms
from tables import each_row

from coursework.site.application import ROUTES

pytestmark = pytest.mark.e2e

REPORT = "/report"  #: a page of its own, to keep; it is printed as a PDF
WHOLE = {"/lessons/{lesson}": "?whole"}  #: what shows all of a page to a browser without a script
ENDING = ("/sign-out", "/account", "/account/password")  #: forms after which somebody signs in again
FAST = ("/practice", "/assignments/{number:int}", "/desk/{assignment:int}", "/desk/{assignment:int}/queue")
LOOKS = [("fr", "telephone"), ("en", "desk")]  #: the longer words where there is less room
SCHEMES = [(*LOOKS[0], "light"), (*LOOKS[1], "light"), (*LOOKS[1], "dark")]


@pytest.fixture(scope="module")
def lived(tmp_path_factory):
    """The class of twelve behind a server, and a browser."""
    site = Lived(tmp_path_factory.mktemp("lived"))
    with chromium() as browser, served(site) as address:
        yield site, address, browser


#: Toolbars in which the keyboard stops more than once, with their stops.
TOOLBARS = """() => Array.from(document.querySelectorAll("[role=toolbar]"), (bar) =>
  Array.from(bar.querySelectorAll("*")).filter((one) => one.tabIndex >= 0 && one.checkVisibility()).length
).filter((stops) => stops > 1)"""


def faults(page, address, lang, size):
    """What is wrong with a page, in words."""
    behind = watched(page)
    page.goto(address, wait_until="load")
    heading = page.locator("h1").all_inner_texts()
    found = {
        "wider than the screen": too_wide(page),
        "axe": serious(page),
        "headings": heading if len(heading) != 1 else [],
        "title": [] if heading and _begins(page.title(), heading[0]) else [page.title(), *heading],
        "language": []
        if page.get_attribute("html", "lang") == lang
        else [page.get_attribute("html", "lang")],
        "low": low(page) if size == "telephone" else [],
        "toolbars": page.evaluate(TOOLBARS),
        "in print": [one for one in cut_in_print(page) if one] if not address.endswith(REPORT) else [],
        "behind": behind,
    }
    return {what: told for what, told in found.items() if told}


def _begins(title, heading):
    """A title says what a page is before it says of what course."""
    plain = " ".join(heading.split())
    return plain in " ".join(title.split())


def looked_at(lived, lang, size, chosen, scheme="light"):
    site, address, browser = lived
    contexts, found = {}, {}
    for one in shown(site):
        if not chosen(one):
            continue
        if one.name not in contexts:
            contexts[one.name] = context_of(browser, site, address, one.name, lang, size, color_scheme=scheme)
        page = contexts[one.name].new_page()
        if told := faults(page, address + one.address, lang, size):
            found[one.address] = told
        page.close()
    for context in contexts.values():
        context.close()
    return found


def test_every_address_is_looked_at_or_is_no_page(lived):
    seen = {one.path for one in shown(lived[0])}
    assert seen | NO_PAGES == {page.path for page in ROUTES}
    assert not seen & NO_PAGES


@each_row(("lang", "size", "scheme"), SCHEMES)
def test_the_pages_that_most_see_are_without_fault(lived, lang, size, scheme):
    assert looked_at(lived, lang, size, lambda one: one.path in FAST, scheme) == {}


@pytest.mark.slow
@pytest.mark.parametrize(("lang", "size"), LOOKS)
def test_every_page_is_without_fault(lived, lang, size):
    assert looked_at(lived, lang, size, lambda one: one.path not in FAST) == {}


#: What the keyboard stands on: nothing, or where it stood already, or what is wrong with it.
STOP = """() => {
  const one = document.activeElement, box = one.getBoundingClientRect(), wrong = [];
  const look = getComputedStyle(one);
  if (one === document.body || one.walked) return null;
  one.walked = true;
  const acts = one.matches("a, button, input, select, textarea, summary, [role=application]");
  const scrolls = one.scrollWidth > one.clientWidth || one.scrollHeight > one.clientHeight;
  if (!acts && !scrolls) wrong.push("a stop at nothing");
  if (look.outlineStyle === "none") wrong.push("no mark");
  const x = box.left + Math.min(box.width / 2, 30);
  const y = (Math.max(box.top, 0) + Math.min(box.bottom, innerHeight)) / 2;
  const over = document.elementFromPoint(x, y), labels = Array.from(one.labels || []);
  const own = over && [one, ...labels].some((each) => each.contains(over)) || over && over.contains(one);
  if (!own) wrong.push("hidden");
  return wrong.map((what) => `${what}: ${one.outerHTML.slice(0, 90)}`);
}"""


@pytest.mark.parametrize(("lang", "size"), LOOKS)
def test_the_keyboard_stands_at_nothing_hidden_unmarked_or_idle(lived, lang, size):
    site, address, browser = lived
    context, wrong, stops = context_of(browser, site, address, STUDENT, lang, size), {}, 0
    page = context.new_page()
    for one in shown(site):
        if one.name != STUDENT:
            continue
        page.goto(address + one.address, wait_until="load")
        page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        found = []
        for _ in range(150):
            page.keyboard.press("Tab")
            if (stop := page.evaluate(STOP)) is None:
                break
            stops += 1
            found += stop
        if found:
            wrong[one.address] = found
    context.close()
    assert wrong == {}
    assert stops > 300


@pytest.mark.parametrize(("lang", "size"), LOOKS)
def test_a_sheet_is_as_long_before_its_letters_come(lived, lang, size):
    site, address, browser = lived
    lengths = []
    for is_late in (True, False):
        context = context_of(browser, site, address, STUDENT, lang, size, service_workers="block")
        if is_late:
            context.route("**/*.woff2*", lambda one: one.abort())
        page = context.new_page()
        page.goto(f"{address}/practice/{EXERCISE}")
        page.evaluate("document.fonts.ready.then(() => null)")
        lengths.append(page.evaluate("document.querySelector('main').getBoundingClientRect().height"))
        context.close()
    assert lengths[0] == pytest.approx(lengths[1], rel=0.02)


def test_a_page_that_a_student_went_back_to_is_not_sent_again(lived):
    """Without a script a form leads to a page with an address of its own, whichever button sends it."""
    site, _, _ = lived
    tried, wrong = set(), []
    for page in (one for one in shown(site) if one.name == STUDENT):
        browser = site.browser(STUDENT)
        for action, texts, pressed in Forms(browser.get(page.address + WHOLE.get(page.path, "")).text).sent:
            place = action.partition("#")[0] or page.address
            if (page.path, place, *pressed) in tried:
                continue
            tried.add((page.path, place, *pressed))
            reply = browser.post(place, data={**texts, **pressed, "_seal": browser.seal})
            if reply.status_code == 200 and "content-disposition" not in reply.headers:
                wrong.append((page.address, place, pressed))
            if place in ENDING:
                browser = site.browser(STUDENT)
    assert wrong == []
    assert len(tried) > 20
