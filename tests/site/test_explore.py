"""Explore: numbers of the address, bounded; nothing of a running assignment; links that tell nothing before
it is answered."""

import re
from dataclasses import replace
from datetime import timedelta
from html import unescape
from urllib.parse import quote

import pytest
from animations import DRIVEN
from site_people import MAX, TEACHER, ZOE
from site_practising import Practising, right_answer, words_of
from site_walk import EXERCISE, SEEDS, Filled
from sweeps import at_once
from tables import each_row

from coursework.database.publication import publish
from coursework.site.frame.limits import ADDRESS, PERSON
from coursework.site.practice.explore_page import ROUTES, SEED


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return Filled(f"sqlite:///{tmp_path_factory.mktemp('site')}/site.db")


def box(page, name):
    return unescape(re.search(rf'<input type="text" id="of-{name}"[^>]* value="([^"]*)"', page)[1])


@at_once([name for name in DRIVEN if name != EXERCISE], DRIVEN[::5])
def test_every_driven_exercise_is_explored(site, browser_of, names):
    for name in names:
        page = browser_of(ZOE).get(f"/explore/{name}")
        assert page.status_code == 200, name
        assert page.text.count("<svg") >= 2, name
        assert "nan" not in re.sub(r"<[^>]*>", "", page.text).split(), name
    for name in ("grashof", "ball_reducer", "no_such_exercise"):
        assert browser_of(ZOE).get(f"/explore/{name}").status_code == 404


def test_an_address_holds_the_numbers_and_a_script_gets_the_same_figure(browser_of):
    address = "/explore/four_bar_motion?r1=210&r2=55&r3=180&r4=140&theta2=77&omega2=3&mode=open"
    page = browser_of(ZOE).get(address).text
    assert [box(page, n) for n in ("r1", "r2", "r3", "r4", "theta2", "omega2")] == [
        "210",
        "55",
        "180",
        "140",
        "77",
        "3",
    ]
    assert '<option value="open" selected>' in page
    piece = browser_of(ZOE).get(address, headers={"hx-request": "true"}).text
    figure = re.search(r"<figure><svg.*?</svg>", piece, re.DOTALL)[0]
    assert figure in page
    assert "<form" not in piece
    assert len(piece) < 250_000
    assert browser_of(MAX).get(address).text.count(figure) == 1  # who opens the address sees the same


def test_what_does_not_close_is_a_page_that_says_by_how_much(browser_of):
    page = browser_of(ZOE).get("/explore/four_bar_motion?r1=200&r2=100&r3=90&r4=80&theta2=150")
    assert page.status_code == 200
    # (200^2 + 100^2 + 2 200 100 cos 30 degrees)^(1/2) - 90 - 80
    assert "121 mm" in words_of(page.text)
    assert "Triple-rocker" in words_of(page.text)
    nowhere = browser_of(ZOE).get("/explore/quick_return?r1=590&r2=20&r3=60&r4=50")
    assert nowhere.status_code == 200
    assert "closes at no angle" in words_of(nowhere.text)


def test_what_is_typed_is_read_in_either_language_and_its_bounds_are_told(browser_of):
    for lang, typed, shown, told in (
        ("en", "60.5", "60.5", "r 2 goes from 20 to 190 mm here."),
        ("fr", "60,5", "60,5", "r 2 va ici de 20 à 190 mm."),
    ):
        found = {}
        for text in (typed, "190", "400", "−5"):
            address = f"/explore/four_bar_motion?r2={quote(text)}"
            page = browser_of(ZOE).get(address, headers={"accept-language": lang}).text
            found[text] = box(page, "r2"), told in words_of(page)
        assert found == {
            typed: (shown, False),
            "190": ("190", False),
            "400": ("190", True),
            "−5": ("20", True),
        }


HOSTILE = [
    "r1=nan",
    "r1=inf",
    "r1=-1e308",
    "r1=1e999",
    "r1=" + "9" * 6000,
    "r1=0",
    "r1=",
    "r1",
    "r1=1&r1=2",
    "r1[]=3",
    "mode=evil",
    "theta2=" + quote("<script>alert(1)</script>"),
    "r2=" + quote("' or 1=1 --"),
    "r3=%00",
    "r4=%ff%fe",
    "r1=" + quote("7０"),
    "r1=__import__('os')",
    "lang=xx",
    "&".join(f"x{k}=1" for k in range(500)),
    "theta2=1e-320",
    "theta2=-0",
    "alpha2=45e",
    "r1=1,5",
]


@each_row("query", HOSTILE)
def test_whatever_an_address_says_is_bounded(query, browser_of):
    reply = browser_of(ZOE).get(f"/explore/four_bar_motion?{query}")
    assert reply.status_code == 200
    assert "alert(1)" not in reply.text
    numbers = re.findall(r'type="range"[^>]* min="([^"]+)" max="([^"]+)"[^>]* value="([^"]+)"', reply.text)
    assert len(numbers) == 7
    assert all(float(low) <= float(value) <= float(high) for low, high, value in numbers)


def test_what_is_computed_is_limited(site, browser_of, monkeypatch):
    assert ROUTES[0].limit in PERSON.keys() & ADDRESS.keys()
    explored = site.site.explored
    assert explored._most <= 100
    monkeypatch.setattr(explored, "_most", 4)
    for k in range(6):
        browser_of(ZOE).get(f"/explore/slider_crank?theta2={k}")
    assert len(explored._items) == 4


# ------------------------------------------------------------------------ assignments


def test_a_mechanism_of_an_assignment_is_explored_only_after_it(site, browser_of):
    address = f"/explore/{EXERCISE}"
    query = "&".join(f"{n}={v}" for n, v in site.variants[ZOE].given.items())
    for way in (address, f"{address}?{query}"):
        refused = browser_of(ZOE).get(way)
        assert refused.status_code == 409
        assert not [found for found in site.answers(ZOE) if found.search(refused.text)]
    assert browser_of(ZOE).get(address, headers={"hx-request": "true"}).status_code == 409
    assert browser_of(TEACHER).get(address).status_code == 200
    with site.site.store.begin() as connection:
        publish(connection, site.number, replace(site.published, closes=site.at - timedelta(minutes=1)))
    assert browser_of(ZOE).get(address).status_code == 200


def test_the_first_numbers_are_of_no_variant_that_anybody_has(site):
    for name in ("four_bar_motion", EXERCISE):
        assert SEED not in site.site.pool.seeds(name)
    assert SEED not in SEEDS.values()


# ----------------------------------------------------------------------------- links


def test_a_sheet_links_to_its_own_numbers_once_it_is_answered(site, browser_of):
    zoe = Practising(site, browser_of(ZOE), "four_bar_motion")
    links = re.findall(r'href="(/explore/[^"]*)"', zoe.page())
    assert links == ["/explore/four_bar_motion"]
    zoe.send({p.id: right_answer(zoe.variant, p) for p in zoe.variant.parts}, check="")
    own = [unescape(link) for link in re.findall(r'href="(/explore/[^"]*)"', zoe.page()) if "?" in link]
    page = browser_of(ZOE).get(own[0]).text
    assert float(box(page, "r1")) == zoe.variant.given["r1"]
    assert float(box(page, "theta2")) == zoe.variant.given["theta2"] % 360
    theta4 = zoe.variant.solution()["theta4"]
    shown = re.search(r"θ 4 (-?[\d.]+)", words_of(page).replace("−", "-"))
    assert shown is None or float(shown[1]) == pytest.approx(theta4, rel=1e-3)


@pytest.fixture(scope="module")
def browser_of(site):
    browsers = {name: site.browser(name) for name in (ZOE, MAX, TEACHER)}
    return browsers.__getitem__
