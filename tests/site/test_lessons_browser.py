"""Lessons in Chromium: step by step by touch to an exercise, back to the place, blanks that are marked, the
whole page without a script."""

import pytest
from site_browser import cut_in_print, low, serious, too_wide, watched
from site_people import MAX
from site_server import until

from coursework.site.lessons.lesson_content import lesson_of

pytestmark = pytest.mark.e2e

LESSON = "mobility_and_groups"  #: one that is short


def shown(page):
    """The steps that stand on the screen when all have come."""
    page.locator(".lesson.stepped, .lesson:not([data-steps])").wait_for()
    steps = page.locator(".step").all()
    return [step.get_attribute("id") for step in steps if step.is_visible()]


def test_a_lesson_is_read_by_touch_to_its_exercise_and_goes_on_where_one_stopped(window, desk):
    page = window("/practice")
    wrong = watched(page)
    page.locator("#chapter-1 summary").tap()
    page.locator(f"a[data-place-of={LESSON}]").tap()
    page.wait_for_url(f"**/lessons/{LESSON}")
    assert shown(page) == ["step-1"]
    count = page.locator(".step").count()
    for number in range(2, 6):
        page.locator("[data-go='1']").tap()
        page.wait_for_url(f"**#step-{number}")
        assert shown(page) == [f"step-{number}"]
        assert (too_wide(page), low(page)) == (0, [])
    page.locator("[data-go='-1']").tap()
    page.wait_for_url("**#step-4")
    page.go_back()
    page.wait_for_url("**#step-5")
    assert serious(page) == []
    page.goto(f"{desk[1]}/practice")
    page.locator("#chapter-1 summary").tap()
    place = page.locator(f"a[data-place-of={LESSON}]")
    assert f"Step 5 of {count}" in place.locator("xpath=..").inner_text()
    place.tap()
    page.wait_for_url(f"**/lessons/{LESSON}#step-5")
    assert shown(page) == ["step-5"]
    page.goto("about:blank")
    page.goto(f"{desk[1]}/lessons/{LESSON}")
    assert shown(page) == ["step-5"]
    page.evaluate("location.hash = 'section-4'")
    page.wait_for_function("document.querySelector('.step.shown #section-4')")
    page.evaluate(f"location.hash = 'step-{count}'")
    page.wait_for_function(f"document.querySelector('#step-{count}.shown')")
    assert serious(page) == []
    page.locator(".lesson-end a[href='/practice/joint_graph']").tap()
    page.wait_for_url("**/practice/joint_graph/*")
    assert wrong == []


def test_another_device_goes_on_where_one_stopped(window):
    page = window(f"/lessons/{LESSON}", name=MAX)
    for _ in range(2):
        page.locator("[data-go='1']").tap()
    place = shown(page)
    with page.expect_response(lambda reply: reply.request.method == "POST") as kept:
        pass
    assert kept.value.status == 204
    assert shown(window(f"/lessons/{LESSON}", name=MAX)) == place != ["step-1"]


def test_a_link_to_a_section_opens_its_step(window):
    page = window("/practice/joint_graph")
    link = page.locator(f"a[href^='/lessons/{LESSON}?whole#section-']").first
    section = link.get_attribute("href").partition("#")[2]
    link.tap()
    page.wait_for_url(f"**/lessons/{LESSON}#{section}")  # its steps are kept
    [step] = shown(page)
    assert page.locator(f"#{step} #{section}").is_visible()
    page = window(f"/lessons/{LESSON}#section-6")
    [step] = shown(page)
    assert page.locator(f"#{step} #section-6").is_visible()


def test_what_moves_can_be_stopped(window):
    page = window("/lessons/plane_mechanisms", size="desk")
    shown(page)
    button = page.locator("figure:has(img[data-still]) button").first
    image = page.locator("figure img[data-still]").first
    moving = image.get_attribute("src")
    button.click()
    assert image.get_attribute("src") == image.get_attribute("data-still") != moving
    assert button.inner_text() == "Let it move"
    button.click()
    assert page.evaluate("path => document.querySelector('img[data-still]').src.endsWith(path)", moving)


def test_a_blank_is_marked_in_its_place(window, desk):
    class_, _, _ = desk
    lesson = lesson_of(class_.site, LESSON, "en")
    number = next(k for k, step in enumerate(lesson.steps, 1) if step.blanks)
    page = window(f"/lessons/{LESSON}#step-{number}")
    assert shown(page) == [f"step-{number}"]
    form = page.locator(f"#step-{number} form.blanks")
    form.locator("button").tap()
    form.locator(".told p").wait_for()
    assert "Write an answer first." in form.locator(".told").inner_text()
    assert page.url.endswith(f"#step-{number}")
    assert serious(page) == []
    page.route("**/lessons/*", lambda route: route.abort())
    form.locator("button").tap()
    page.wait_for_function(
        "t => document.querySelector(t).innerText.includes('Nothing was checked')", arg=f"#checked-{number}"
    )
    page.set_viewport_size({"width": 320, "height": 568})
    assert too_wide(page) == 0


def test_an_example_that_was_checked_stands_as_it_was_left_without_a_network_too(window, desk):
    lesson = lesson_of(desk[0].site, LESSON, "en")
    number = next(k for k, step in enumerate(lesson.steps, 1) if step.blanks)
    page = window(f"/lessons/{LESSON}#step-{number}")
    page.evaluate("navigator.serviceWorker.ready.then(() => 0)")
    page.reload()  # loaded before the worker was there, and with it
    form = page.locator(f"#step-{number} form.blanks")
    form.locator("input[type=text]").first.fill("12 apples")
    form.locator("button").tap()
    form.locator(".told p").wait_for()
    told = form.locator(".told").inner_text()
    kept = (
        "caches.match(location.pathname).then((page) => page && page.text()).then((text) => (text || "
        "'').includes('12 apples'))"
    )
    until(lambda: page.evaluate(kept))
    for is_offline in (False, True):
        page.context.set_offline(is_offline)
        page.reload()
        page.wait_for_selector(f"#step-{number}.shown form.blanks .told p")
        assert form.locator(".told").inner_text() == told
        assert form.locator("input[type=text]").first.input_value() == "12 apples"
    page.context.set_offline(False)
    form.locator("input[type=text]").first.fill("12 pears")
    form.locator("button").tap()
    page.wait_for_function(
        "t => document.querySelector(t).innerText.includes('pears')", arg=f"#checked-{number}"
    )


@pytest.mark.parametrize(("size", "script"), [("telephone", False), ("desk", True)])
def test_without_a_script_and_on_a_desk_a_lesson_is_one_page(window, size, script):
    page = window(f"/lessons/{LESSON}", size=size, script=script)
    assert len(shown(page)) == page.locator(".step").count()
    assert page.locator(".step").count() > 10
    assert not page.locator(".lesson-bar").is_visible()
    if script:
        assert (too_wide(page), serious(page)) == (0, [])
        page.wait_for_function(
            "Array.from(document.querySelectorAll('.lesson img'), (one) => one.naturalWidth).every(Boolean)"
        )  # though most are far below: they are printed
        assert cut_in_print(page)[1] == []


def test_steps_that_do_not_come_are_told_and_come_with_the_whole_lesson(window, desk):
    page = window("/practice", service_workers="block")
    page.route("**/steps/*", lambda route: route.abort())
    page.goto(f"{desk[1]}/lessons/{LESSON}")
    page.locator("[data-missing] a").tap()
    assert len(shown(page)) == 1
    assert page.locator(".step").count() > 10


@pytest.mark.parametrize("size", ["telephone", "desk"])
def test_the_course_page_fits_its_screen(window, size):
    page = window("/practice", size=size, lang="fr")
    page.locator("#chapter-2 summary").click()
    assert (too_wide(page), serious(page), low(page)) == (0, [], [])
