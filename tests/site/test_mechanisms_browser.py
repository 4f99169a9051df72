"""A teacher who does not program draws a linkage in Chromium, by touch or with a keyboard alone, and has an
exercise."""

import math
import re
import time

import pytest
from site_browser import chromium, low, serious, served, too_wide, watched, windows
from site_own_course import OwnCourse
from site_people import TEACHER, ZOE
from sqlalchemy import select

from coursework.database.tables import issue, variant

pytestmark = pytest.mark.e2e


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    class_ = OwnCourse(tmp_path_factory.mktemp("site"))
    with served(class_) as address, chromium() as browser:
        yield class_, address, browser


@pytest.fixture
def window(desk):
    with windows(desk, TEACHER) as open_:
        yield open_


#: A slider-crank: crank of 50 mm, bar of about 180 mm, the slide 20 mm above the pivot; tools with the places
#: that are tapped, mm.
SLIDER_CRANK = (
    ("ground", (120, 100)),
    ("bar", (120, 100), (150, 140), (150, 140), (325, 120)),
    ("slide", (325, 120), (440, 120)),
)


#: What drives otherwise, loads, wheels, and a group that closes all together, with a line of each one's file.
DRAWN = {
    "jack": (
        ("ground", (100, 100), (220, 60)),
        ("bar", (100, 100), (300, 140)),
        ("jack", (220, 60), (300, 140)),
        ("load", (200, 120)),
    ),
    "moved_slide": (
        ("ground", (120, 100)),
        ("bar", (120, 100), (150, 140), (150, 140), (325, 100)),
        ("slide", (325, 100), (440, 100)),
        ("driver", (325, 100)),
        ("load", (150, 140), (150, 40)),
    ),
    "wheels": (
        ("ground", (100, 100), (220, 100)),
        ("bar", (100, 100), (140, 160), (220, 100), (260, 160)),
        ("bar", (140, 160), (200, 260), (200, 260), (260, 160)),
        ("gear", (120, 130), (240, 130)),
    ),
    "three_rods": (
        ("ground", (100, 60), (260, 60), (400, 120)),
        ("bar", (100, 60), (130, 100)),
        ("plate", (170, 140), (250, 130), (210, 180), (170, 140)),
        ("bar", (130, 100), (170, 140), (260, 60), (250, 130), (400, 120), (210, 180)),
    ),
}
SAYS = {
    "jack": "105 mm … 125 mm",
    "moved_slide": "165 mm …",
    "wheels": "3; 4, 5 (RRR)",
    "three_rods": "3, 4, 5, 6 (III)",
}


def tapped(page, x, y):
    surface = page.locator(".draw svg")
    surface.scroll_into_view_if_needed()
    scale = surface.bounding_box()["width"] / 480
    surface.tap(position={"x": x * scale, "y": (320 - y) * scale})


def typed(page, x, y):
    for box, value in (("x", x), ("y", y)):
        page.fill(f"[data-{box}]", str(value))
    page.press("[data-y]", "Enter")


def drawn(page, put, steps):
    page.locator("[data-do=clear]").press("Enter")
    for tool, *places in steps:
        page.locator(f"[data-tool={tool}]").press("Enter")
        for place in places:
            put(page, *place)


def text_of(page):
    return page.input_value("#mechanism-text")


def shown(page, piece):
    """Wait until the view says something; a page allows no other way of waiting."""
    until = time.monotonic() + 90
    while piece not in " ".join(page.inner_text("#mechanism-now").split()):
        assert time.monotonic() < until, page.inner_text("#mechanism-now")
        time.sleep(0.1)


def written(page, piece):
    """Wait until the boxes have written something into the file."""
    until = time.monotonic() + 90
    while piece not in text_of(page):
        assert time.monotonic() < until, text_of(page)
        time.sleep(0.1)


@pytest.mark.parametrize("put", [tapped, typed])
def test_a_drawn_slider_crank_is_an_exercise_with_the_right_answers(desk, window, put):
    page = window("/mechanisms/new", lang="fr", is_mobile=True)
    faults = watched(page)
    drawn(page, put, SLIDER_CRANK)
    shown(page, "(RRP)")
    page.fill("[name=name]", f"bielle_{put.__name__}")
    page.click("button[value=save]")
    page.wait_for_url("**saved=1")
    assert page.locator(".draw svg circle").count() == 3  # what was drawn is there again
    variant = desk[0].site.variant(f"bielle_{put.__name__}", 4, "fr")
    crank, bar = variant.given["r2"], variant.given["r3"]
    assert (crank, bar) == (50, round(math.hypot(175, 20) / 5) * 5)
    x, y = (crank * f(math.radians(variant.given["theta2"])) for f in (math.cos, math.sin))
    assert variant.solution()["s_B"] == pytest.approx(x + math.sqrt(bar**2 - (20 - y) ** 2))
    assert (serious(page), too_wide(page), low(page), faults) == ([], 0, [], [])


def test_from_nothing_to_a_mark_by_touch(desk, window):
    """The whole road: drawn, seen to move, chosen, saved, given, answered, marked."""
    page = window("/desk", lang="fr", is_mobile=True)
    faults = watched(page)
    page.tap("a[href='/mechanisms']")
    page.tap("a[href='/mechanisms/new']")
    page.wait_for_load_state("load")
    page.wait_for_selector(".draw:not([hidden])")
    drawn(page, tapped, SLIDER_CRANK)
    shown(page, "123,4 mm")
    before = page.locator(".moving .handle").get_attribute("cy")
    page.tap(".turn button")
    until = time.monotonic() + 30
    while page.locator(".moving .handle").get_attribute("cy") == before:
        assert time.monotonic() < until
    page.tap(".turn button")
    page.tap("input[name=varies][value=r3]")
    written(page, 'r3 = { from = "140 mm"')
    page.fill("[name=title_fr]", "Pompe à piston")
    page.press("[name=title_fr]", "Tab")
    shown(page, "Pompe à piston")
    assert page.locator(".mechanism-view section details").count() == 3
    page.tap("button[value=save]")
    page.tap(".acts .main")
    page.tap("[name=accounts]")
    page.tap(".fields button.main")
    page.wait_for_url(re.compile(r"/desk/assignments/\d+$"))
    number = page.url.rpartition("/")[2]
    page.tap("form[action$='/publish'] [name=feedback][value=at_once]")
    with page.expect_navigation():
        page.tap("form[action$='/publish'] button.main")
    student = window(f"/assignments/{number}", name=ZOE, lang="fr", is_mobile=True)
    whose = select(variant.c.record).join(issue).where(issue.c.person_id == desk[0].ids[ZOE])
    with desk[0].site.store.reading() as connection:
        record = connection.execute(whose).scalar()
    answers = desk[0].site.course["pompe_a_piston"].from_record(record).solution()
    for name, value in answers.items():
        student.fill(f"[name=e1-{name}]", f"{value:.6g}".replace(".", ","))
    for _ in range(2):  # read back, then confirmed
        with student.expect_navigation():
            student.tap(".bar .main")
    student.goto(student.url.partition("/assignments")[0] + f"/assignments/{number}/feedback")
    assert f"{len(answers)} / {len(answers)}" in student.inner_text("main")
    assert faults == []


def test_jacks_wheels_loads_and_groups_of_three_are_drawn(desk, window):
    """Answers against the law of cosines, and thrusts against the work of the load between two positions near
    each other."""
    page = window("/mechanisms/new")
    for name, steps in DRAWN.items():
        drawn(page, typed, steps)
        shown(page, SAYS[name])
        page.fill("[name=name]", name)
        page.click("button[value=save]")
        page.wait_for_url("**saved=1")
        page.goto(page.url.replace(f"{name}?saved=1", "new"))
    jack, slide = (desk[0].site.course[name].variant(2, "en") for name in ("jack", "moved_slide"))
    apart, arm = math.hypot(120, 40), jack.given["r2"]

    def lifted(length):
        inner = (arm**2 + apart**2 - length**2) / (2 * arm * apart)
        return math.atan2(-40, 120) + math.acos(inner)

    length, step, work = jack.given["L"], 1e-4, 20_000  # N mm a radian
    assert jack.solution()["theta2"] == pytest.approx(math.degrees(lifted(length)))
    turned = lifted(length + step) - lifted(length - step)
    assert abs(jack.solution()["thrust"]) == pytest.approx(work * turned / (2 * step), rel=1e-5)

    def high(reach):
        crank, rod = slide.given["r2"], slide.given["r3"]
        return crank * math.sin(math.acos((crank**2 + reach**2 - rod**2) / (2 * crank * reach)))

    reach = slide.given["s_B"]
    risen = (high(reach + step) - high(reach - step)) / (2 * step)
    assert abs(slide.solution()["thrust"]) == pytest.approx(100 * abs(risen), rel=1e-5)


def test_undo_moves_and_boxes_keep_what_the_drawing_does_not_change(window):
    page = window("/mechanisms/new")
    before = text_of(page)
    page.click("[data-tool=move]")
    typed(page, 290, 220)
    typed(page, 300, 250)
    moved = text_of(page)
    assert '"B":{"x":300,"y":250}' in moved
    page.click("[data-do=undo]")
    assert text_of(page).split() == before.split()
    shown(page, "over the motion")
    page.check("input[name=varies][value=r2]")
    written(page, 'r2 = { from = "50 mm"')
    page.click("[data-tool=move]")
    typed(page, 290, 220)
    typed(page, 300, 250)
    assert 'r2 = { from = "50 mm"' in text_of(page)


def test_the_figure_turns_with_its_slider_and_its_crank(window):
    page = window("/mechanisms/new")
    shown(page, "over the motion")

    def places():
        lines = page.locator(".moving [data-moves]")
        return lines.evaluate_all("all => all.map((n) => n.getAttribute(n.dataset.moves))")

    before = places()
    page.locator(".turn input").press("ArrowRight")
    turned = places()
    assert turned != before
    handle = page.locator(".moving .handle").bounding_box()
    page.mouse.move(handle["x"] + handle["width"] / 2, handle["y"] + handle["height"] / 2)
    page.mouse.down()
    page.mouse.move(handle["x"] + 40, handle["y"] + 60, steps=4)
    page.mouse.up()
    assert places() != turned
    page.click("[data-tool=move]")
    typed(page, 290, 220)
    typed(page, 300, 260)
    shown(page, "135.5")  # the greatest angle of the output bar, which is another one now
    assert page.locator(".turn").is_visible()
    assert page.locator(".moving .handle").count() == 1
