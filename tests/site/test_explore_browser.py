"""A finger on the crank, and on the sliders of Explore, in Chromium."""

import cmath
import math

import pytest
from site_browser import serious, too_wide

pytestmark = pytest.mark.e2e


def drag(page, start, steps):
    """A finger that goes from a place by steps, each (x, y)."""
    finger = page.context.new_cdp_session(page)

    def touch(kind, *points):
        finger.send(
            "Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in points]}
        )

    touch("touchStart", start)
    for x, y in steps:
        touch("touchMove", (start[0] + x, start[1] + y))
    touch("touchEnd")


def test_a_finger_drags_the_crank_and_the_page_stays(window):
    page = window("/practice/four_bar_motion", is_mobile=True)
    page.click("button[value=motion]")
    handle = page.locator("#motion .handle")
    handle.scroll_into_view_if_needed()
    box = handle.bounding_box()
    assert min(box["width"], box["height"]) >= 44
    lines = "#motion [data-track]"
    before, scrolled = (
        page.locator(lines).evaluate_all("all => all.map((n) => n.getAttribute('d'))"),
        page.evaluate("scrollY"),
    )
    angle = page.inner_text("#angle-shown")
    assert page.locator("#motion .ghost").evaluate("g => getComputedStyle(g).display") == "none"
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    drag(page, middle, [(9 * k, 14 * k) for k in range(1, 8)])
    after = page.locator(lines).evaluate_all("all => all.map((n) => n.getAttribute('d'))")
    assert sum(one != other for one, other in zip(before, after, strict=True)) >= 3
    assert page.inner_text("#angle-shown") != angle
    assert page.evaluate("scrollY") == scrolled
    assert page.locator("#motion .ghost").evaluate("g => getComputedStyle(g).display") != "none"
    page.focus("#angle")
    page.keyboard.press("ArrowRight")
    moved = page.locator(lines).evaluate_all("all => all.map((n) => n.getAttribute('d'))")
    assert moved != after
    assert serious(page) == []


@pytest.mark.parametrize(("size", "lang"), [("telephone", "fr"), ("desk", "en")])
def test_a_slider_changes_figure_and_plots_in_place(window, size, lang):
    page = window("/explore/four_bar_motion", size=size, lang=lang)
    assert (too_wide(page), serious(page)) == (0, [])
    figure = page.inner_html("#explored figure")
    page.focus("#explore input[data-of=of-r2]")
    with page.expect_response(lambda reply: "r2=" in reply.url):
        page.keyboard.press("ArrowLeft")
    page.wait_for_function(
        "before => document.querySelector('#explored figure').innerHTML !== before", arg=figure
    )
    value = page.input_value("#of-r2")
    assert f"r2={value}" in page.url
    page.fill("#of-r3", "40")
    page.wait_for_selector(".explored-told .gap")
    assert page.locator("#explored svg").count() == 1
    bounds = page.locator("#explore [data-of=of-r2]")
    page.fill("#of-r2", "4000")
    told = f".explored-told :text('{'va ici de' if lang == 'fr' else 'goes from'}')"
    page.wait_for_selector(told)
    assert bounds.input_value() == bounds.get_attribute("max")
    value = "60,5" if lang == "fr" else "60.5"
    page.fill("#of-r2", value)
    page.wait_for_selector(told, state="detached")
    assert f"r2={value.replace(',', '%2C')}" in page.url
    assert abs(float(bounds.input_value()) - 60.5) <= float(bounds.get_attribute("step"))
    value = page.input_value("#of-r2")
    assert (too_wide(page), serious(page)) == (0, [])
    page.reload()
    assert page.input_value("#of-r2") == value


def test_without_script_a_button_shows_the_numbers(window):
    page = window("/explore/slider_crank", script=False)
    assert page.locator("#explore input[type=range]:visible").count() == 0
    page.fill("#of-e", "10")
    page.click("#explore button.main")
    assert "e=10" in page.url
    assert page.input_value("#of-e") == "10"


def test_a_finger_drags_the_crank_of_explore(window):
    page = window("/explore/four_bar_motion?theta2=40", is_mobile=True)
    handle = page.locator("#explored .handle")
    box = handle.bounding_box()
    assert min(box["width"], box["height"]) >= 44
    pivot, pin, scrolled = (page.evaluate(what) for what in (_PIVOT, _PIN, "scrollY"))
    # A quarter of a turn about the pivot, upwards and to the left: y of the screen points down.
    arm = complex(pin[0] - pivot[0], pin[1] - pivot[1])
    way = [arm * cmath.exp(-1j * math.radians(15 * k)) - arm for k in range(1, 7)]
    with page.expect_response(lambda reply: "theta2=" in reply.url):
        drag(page, pin, [(z.real, z.imag) for z in way])
    page.wait_for_function("() => location.search.includes('theta2=1')")
    assert float(page.input_value("#of-theta2")) == pytest.approx(130, abs=3)
    assert page.evaluate("scrollY") == scrolled
    page.wait_for_function(
        f"([x, y]) => {{ const [u, v] = ({_PIN}); return Math.hypot(u - x, v - y) > 20; }}", arg=pin
    )


#: Where pivot and pin of the crank are on the screen, px.
_PLACE = """(() => { const n = document.querySelector("#explored svg");
  const c = n.dataset.crank.split(" ").map(Number);
  const at = new DOMPoint(c[%d], c[%d]).matrixTransform(n.getScreenCTM()); return [at.x, at.y]; })()"""
_PIVOT, _PIN = _PLACE % (0, 1), _PLACE % (2, 3)
