"""The drawing surface in Chromium: by touch, mouse and keys; what is drawn is kept, and what is typed is
drawn."""

import cmath
import json
import math
from dataclasses import replace

import constructions
import pytest
from site_assignments import ASSIGNMENT, dealt
from site_browser import WIDTHS, context_of, desk_at, low, serious, told, too_wide, watched
from site_pencil import Draughtsman, Typist
from site_people import MAX, ZOE
from site_practising import right_answer
from site_server import until

import coursework
from coursework.figures.student_drawing import StudentDrawing
from coursework.issuing.assignment import AskedExercise
from coursework.marking.marking import mark
from coursework.rendering import html
from coursework.sheets.handout import handout

pytestmark = pytest.mark.e2e

PLACES = [("telephone", "fr"), ("desk", "en")]


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    with desk_at(tmp_path_factory.mktemp("site")) as desk:
        yield desk


@pytest.fixture
def pencil(desk):
    made = []

    def new(exercise, size="telephone", lang="en"):
        made.append(Draughtsman(desk, exercise, size, lang))
        return made[-1]

    yield new
    for one in made:
        one.context.close()


def test_a_coupler_curve_is_traced_by_stepping_the_crank(pencil):
    """With compass and lines at true size: the coupler's direction at the instant shown, and P at other
    angles of the crank."""
    hand = pencil("coupler_curve", "desk")
    given = hand.variant.given
    O, side = 200 + 150j, 1 if given["mode"] == "open" else -1
    C = O + given["r1"]
    hand.tool("point")
    for z in (O, C):
        hand.tap(z)
    curve = []
    for step in (0, 40):
        crank = cmath.rect(given["r2"], math.radians(given["theta2"] + step))
        A, BC = O + crank, abs(C - O - crank)
        corner = math.acos((BC**2 + given["r3"] ** 2 - given["r4"] ** 2) / (2 * BC * given["r3"]))
        AB = cmath.rect(given["r3"], cmath.phase(C - A) + side * corner)
        hand.line("parallel", O, degrees=given["theta2"] + step)
        hand.circle(O, f"{given['r2']:g}")
        hand.crossing(A)
        hand.circle(A, f"{given['r3']:g}")
        hand.circle(C, f"{given['r4']:g}")
        hand.crossing(A + AB)
        if not step:
            hand.measure(A, A + AB, "theta3")
        hand.line("parallel", A, degrees=math.degrees(cmath.phase(AB)) + given["beta"])
        curve.append(A + AB / given["r3"] * cmath.rect(given["AP"], math.radians(given["beta"])))
        hand.circle(A, f"{given['AP']:g}")
        hand.crossing(curve[-1])
    drawn = [item.at for item in StudentDrawing.parse(hand.text()).items.values() if item.kind == "point"]
    assert [min(abs(z - P) for z in drawn) < 0.5 for P in curve] == [True, True]
    assert hand.marks()["theta3"].verdict == "correct"
    hand.close()


def test_a_joint_graph_is_tapped_together(pencil):
    for size, lang in PLACES:
        hand = pencil("joint_graph", size, lang)
        joints = [j.split() for j in str(hand.variant.key.reference["graph"]).split(",")]
        bodies = sorted({b for of, _ in joints for b in of.split("-")}, key=int)
        place = {b: 50 + 35j + cmath.rect(28, 2 * math.pi * k / len(bodies)) for k, b in enumerate(bodies)}
        hand.tool("body")
        for body in bodies:
            hand.tap(place[body])
        hand.tool("joint")
        for of, kind in joints:
            for body in of.split("-"):
                hand.tap(place[body])
            hand.press(f"[data-joint={kind}]")
        answer = hand.answers()
        verdict = {m.part: m.verdict for m in mark(hand.variant, {"graph": answer["graph"]}).values()}
        assert verdict["graph"] == "correct", answer
        hand.close()


def cells(page, name):
    """What stands in the boxes of the components of a part."""
    return [page.input_value(f"[name={name}-{index}]") for index in (1, 2)]


def type_cells(page, name, *texts):
    """Type components as a student does, key by key over what stands there."""
    for index, text in enumerate(texts, 1):
        page.click(f"[name={name}-{index}]", click_count=3)
        page.keyboard.press("Delete")
        page.keyboard.type(text)


def type_line(page, name, text):
    """Type a whole answer into the line below the boxes of its components."""
    page.locator(f"details:has([name={name}]) summary").click()
    page.fill(f"[name={name}]", text)


def draw_at(page, name, z):
    """Draw the point of a part with the mouse."""
    page.evaluate("document.querySelector('[data-tool=point]').click()")
    svg = page.locator("[data-surface]").first
    svg.scroll_into_view_if_needed()
    room, view = svg.bounding_box(), [float(one) for one in svg.get_attribute("viewBox").split()]
    x, y = (z.real - view[0]) * room["width"] / view[2], (-z.imag - view[1]) * room["height"] / view[3]
    svg.click(position={"x": x, "y": y})
    page.evaluate("n => document.querySelector(`[data-name='${n}']`).click()", name.split("-")[-1])


def drawn_items(page, name):
    return json.loads(page.input_value(f"[name={name}]"))["items"]


def test_what_is_drawn_is_kept_and_what_is_typed_is_drawn(desk, pencil):
    hand = pencil("two_circles")
    hand.dot(30 + 20j, "p")
    assert cells(hand.page, "a-p") == ["30", "20"]
    assert hand.page.locator("[data-name=p] math").bounding_box()["width"] > 5  # beside its tick
    type_cells(hand.page, "a-a", "50,5", "40")
    assert StudentDrawing.parse(hand.text()).points == {"p": 30 + 20j, "a": 50.5 + 40j}
    type_cells(hand.page, "a-p", "31.5")  # moves the point, and makes no other
    assert [one["k"] for one in drawn_items(hand.page, "a-drawing")] == ["point", "point"]
    assert hand.page.input_value("[name=a-p]") == "(31.5 ; 20)"
    type_line(hand.page, "a-c", "(60 ; 10)")
    points = {"p": 31.5 + 20j, "a": 50.5 + 40j, "c": 60 + 10j}
    assert StudentDrawing.parse(hand.text()).points == points
    told(hand.page, "is kept|Saved")
    hand.page.reload()
    assert StudentDrawing.parse(hand.text()).points == points
    assert cells(hand.page, "a-a") == ["50,5", "40"]
    hand.tool("delete")
    hand.tap(31.5 + 20j)
    assert (hand.page.input_value("[name=a-p]"), cells(hand.page, "a-p")) == ("", ["", ""])
    hand.tool("undo")
    assert (hand.page.input_value("[name=a-p]"), cells(hand.page, "a-p")) == ("(31.5 ; 20)", ["31.5", "20"])
    hand.close()


def test_what_another_page_wrote_is_drawn_once_it_is_taken(pencil):
    hand = pencil("two_circles")
    one, other = hand.page, hand.context.new_page()
    other.goto(one.url)
    hand.context.set_offline(True)
    for page, text in ((one, "20"), (other, "40")):
        type_cells(page, "a-p", text, "30")
        told(page, "No connection")
    one.close()
    hand.context.set_offline(False)
    other.reload()
    drawing, point = ("[data-other=a-drawing]", "[data-other=a-p]")
    other.locator(f"{drawing} >> text=Keep mine").click()
    other.locator(f"{point} >> text=Take that").click()
    until(lambda: (cells(other, "a-p"), other.input_value("[name=a-p]")) == (["20", "30"], "(20 ; 30)"))
    assert [(one["x"], one["y"]) for one in drawn_items(other, "a-drawing")] == [(20, 30)]


def test_two_fingers_zoom_so_that_a_tenth_of_a_millimetre_is_placed(pencil):
    hand = pencil("velocity_polygon")
    x, y = hand.place(70 + 40j)
    for _ in range(3):
        hand.touch("touchStart", (x - 15, y), (x + 15, y))
        for k in range(1, 6):
            hand.touch("touchMove", (x - 15 - 12 * k, y), (x + 15 + 12 * k, y))
        hand.touch("touchEnd")
    assert StudentDrawing.parse(hand.text()).items == {}
    assert hand.page.evaluate("scrollY") == hand.page.evaluate("scrollY")
    hand.dot(70.3 + 40.7j, "p")
    assert StudentDrawing.parse(hand.text()).points["p"] == pytest.approx(70.3 + 40.7j, abs=1e-6)


def test_all_is_done_by_keys(pencil):
    hand = pencil("velocity_polygon", "desk")
    page = hand.page
    page.focus("[data-tool=point]")
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")  # the toolbar is one stop
    for key in ("ArrowLeft", "ArrowUp", "Shift+ArrowUp", "Enter"):
        page.keyboard.press(key)
    start = json.loads(hand.text())["items"][0]
    assert (start["y"] * 10) % 10 == pytest.approx(1)
    page.focus("[data-name=p]")
    page.keyboard.press("Enter")
    assert page.input_value("[name=a-p]") != ""
    page.focus("[data-surface]")
    page.keyboard.press("2")
    assert page.get_attribute("[data-tool=vector]", "aria-pressed") == "true"
    assert page.inner_text(".surface-told") == "Vector"
    stood = []
    for key in ("Shift+Tab", "ArrowLeft", "ArrowLeft", "End", "Home", "ArrowRight", "ArrowRight", "Tab"):
        page.keyboard.press(key)
        stood.append(page.evaluate("Object.values({ ...document.activeElement.dataset })[0]"))
    assert stood == ["vector", "point", "snap", "snap", "point", "vector", "parallel", "paper"]
    page.keyboard.press("Shift+Tab")
    assert page.evaluate("document.activeElement.dataset.tool") == "vector"  # the chosen, not the last
    page.keyboard.press("Tab")
    page.keyboard.press(".")
    page.keyboard.press("Enter")
    for _ in range(12):
        page.keyboard.press("ArrowRight")
    assert f"x {start['x'] + 12:g}" in page.inner_text(".surface-told").replace(",", ".")
    page.keyboard.press("Enter")
    assert [one["k"] for one in json.loads(hand.text())["items"]] == ["point", "point", "vector"]
    page.keyboard.press("Delete")
    assert [one["k"] for one in json.loads(hand.text())["items"]] == ["point"]
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    assert [one["k"] for one in json.loads(hand.text())["items"]] == ["point"]
    hand.close()


def test_a_polygon_is_drawn_and_handed_in_by_keys_alone(desk):
    for size, lang in PLACES:
        hand = Typist(desk, "velocity_polygon", size, lang)
        values = constructions.velocity_polygon(hand)
        assert hand.keys < 200
        for part, value in values.items():
            hand.stand(f"[name=a-{part}]")
            hand.page.keyboard.type(f"{value:.5g}")
        hand.press(".practice-bar button[name=check]")
        hand.page.wait_for_selector("#summary .points")
        assert hand.page.evaluate("document.activeElement.id") == "summary"
        drawn = [part.id for part in hand.variant.parts if not part.choices]
        right = [part for part in drawn if hand.page.locator(f"#told-a-{part} .right").count()]
        assert right == drawn
        hand.close()


@pytest.mark.parametrize("exercise", ["velocity_polygon", "joint_graph"])
def test_the_surface_is_read_aloud_and_hit_by_a_thumb(pencil, exercise):
    for size, lang in PLACES:
        hand = pencil(exercise, size, lang)
        for tool in hand.page.locator("[data-tool]").evaluate_all(
            "all => all.map((one) => one.dataset.tool)"
        ):
            hand.tool(tool)
            assert (too_wide(hand.page), low(hand.page) if size == "telephone" else []) == (0, []), tool
        assert serious(hand.page) == []
        hand.page.set_viewport_size({"width": 320, "height": 568})
        assert too_wide(hand.page) == 0
        hand.page.set_viewport_size(dict(zip(("width", "height"), WIDTHS[size], strict=True)))
        hand.close()


#: Type answers into boxes that have no choices.
TYPE = """answers => { for (const [name, text] of Object.entries(answers)) {
  const box = document.querySelector(`[name="a-${name}"]`);
  box.value = text;
  box.dispatchEvent(new Event("input", { bubbles: true }));
} }"""
#: Pairs of names in a drawing that lie on each other: of a glyph's box, which is taller than letters, a third
#: is white.
OVERLAPPING = """(place = "[id$=drawing-ink] > g:nth-child(2)") => {
  const texts = document.querySelectorAll(`${place} text`);
  const names = Array.from(texts, one => [one.textContent, one.getBoundingClientRect()]);
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1
    && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > a.height / 3;
  const near = (k, a) => names.slice(0, k).filter(([, b]) => meet(a, b));
  return names.flatMap(([name, a], k) => near(k, a).map(([other]) => `${name} on ${other}`));
}"""


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_names_in_a_drawing_do_not_lie_on_each_other_on_the_narrowest_screen(desk, lang):
    class_, address, browser = desk
    context, wrong = context_of(browser, class_, address, MAX, lang), {}
    page = context.new_page()
    page.set_viewport_size({"width": 320, "height": 640})
    for name in [name for name in class_.site.course.names if class_.site.course[name].spec.drawing_mm]:
        page.goto(f"{address}/practice/{name}")
        variant = class_.site.variant(name, int(page.url.rpartition("/")[2]), lang)
        page.evaluate(
            TYPE, {part.id: right_answer(variant, part) for part in variant.parts if not part.choices}
        )
        page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        if found := page.evaluate(OVERLAPPING):
            wrong[name] = found
    context.close()
    assert wrong == {}


#: Typed one joint after the other.
NINE_BODIES = "1-3-7 R, 1-5 R, 2-6 R, 2-7 P, 2-9 R, 4-6 R, 4-9 R, 5-6 R, 5-8 R, 8-9 R".split(", ")


def test_names_in_a_joint_graph_do_not_lie_on_each_other(pencil):
    hand, found = pencil("joint_graph"), {}
    for answer in (
        "1-4 R, 2-5 R, 3-6 P",
        *(", ".join(NINE_BODIES[:count]) for count in range(1, len(NINE_BODIES) + 1)),
    ):
        hand.page.fill("[name=a-graph]", answer)
        assert hand.page.locator("[id$=drawing-ink] > g:nth-child(2) text.mid").count() > 3
        found[answer] = hand.page.evaluate(OVERLAPPING)
    assert not any(found.values()), found
    hand.close()


def test_a_paper_has_a_surface_for_each_exercise_that_is_drawn(desk):
    class_, address, browser = desk
    exercises = tuple(map(AskedExercise, ("velocity_polygon", "grashof", "joint_graph")))
    number = dealt(class_, assignment=replace(ASSIGNMENT, name="drawn", exercises=exercises))
    context = context_of(browser, class_, address, ZOE)
    page = context.new_page()
    faults = watched(page)
    for _ in range(2):
        page.goto(f"{address}/assignments/{number}")
        page.wait_for_selector("[data-surface=graph]")
    type_cells(page, "e1-a", "20", "30")
    type_line(page, "e1-b", "(70; 12,5)")
    page.fill("[name=e3-graph]", "1-2 R; 2-3 contact, 3-4-1 pivot")
    kinds = [drawn_items(page, f"e{k}-drawing") for k in (1, 3)]
    points = {"a": 20 + 30j, "b": 70 + 12.5j}
    assert StudentDrawing.parse(page.input_value("[name=e1-drawing]")).points == points
    assert [one["k"] for one in kinds[1]] == ["body"] * 4 + ["joint"] * 3
    assert [one.get("t") for one in kinds[1]][4:] == ["revolute", "higher", "revolute"]
    assert page.input_value("[name=e3-graph]") == "1-2 R; 2-3 contact, 3-4-1 pivot"  # what is typed stays
    told(page, "is kept|Saved")
    page.reload()
    assert len(drawn_items(page, "e3-drawing")) == 7
    assert StudentDrawing.parse(page.input_value("[name=e1-drawing]")).points == points
    assert (cells(page, "e1-a"), cells(page, "e1-b")) == (["20", "30"], ["70", "12,5"])
    draw_at(page, "e1-p", 90 + 40j)
    assert cells(page, "e1-p") == ["90", "40"]
    assert faults == []
    context.close()


#: Numbers at the edge of the paper that the surface cuts.
CUT_NUMBERS = """() => {
  const room = document.querySelector("[data-surface]").getBoundingClientRect();
  const numbers = Array.from(document.querySelectorAll("[id$=drawing-ink] > g:first-child text"));
  return numbers.map((one) => [one.textContent, one.getBoundingClientRect()])
    .filter(([, b]) => b.width && (b.left < room.left || b.right > room.right)).map(([text]) => text);
}"""


def test_numbers_of_the_paper_and_names_of_links_are_whole_on_the_narrowest_screen(desk):
    class_, address, browser = desk
    context, wrong = context_of(browser, class_, address, MAX), {}
    page = context.new_page()
    page.set_viewport_size({"width": 320, "height": 640})
    for name in class_.site.course.names:
        spec = class_.site.course[name].spec
        if not (spec.drawing_mm or spec.surface_mm):
            continue
        page.goto(f"{address}/practice/{name}")
        page.evaluate("document.querySelector('[data-tool=parallel]').click()")
        page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        if found := [*page.evaluate(CUT_NUMBERS), *page.evaluate(OVERLAPPING, ".surface-links")]:
            wrong[name] = found
    context.close()
    assert wrong == {}


def test_what_a_tap_did_stands_in_sight_above_the_end_of_the_screen(pencil):
    hand = pencil("velocity_polygon")
    page = hand.page
    page.set_viewport_size({"width": 390, "height": 560})
    hand.tool("perpendicular")
    page.evaluate("""const box = document.querySelector("[data-surface]").getBoundingClientRect();
        scrollBy({ top: box.bottom - innerHeight, behavior: "instant" })""")
    hand.touch("touchStart", (200, 400))
    hand.touch("touchEnd")
    told = page.locator(".surface-told")
    assert "direction" in told.inner_text()
    assert told.bounding_box()["y"] + told.bounding_box()["height"] <= 560
    hand.tool("delete")
    hand.tap(100 + 30j)
    assert told.inner_text() == "There is nothing here."


def test_a_measured_rate_takes_its_sign_from_a_second_tap(pencil):
    hand = pencil("velocity_polygon_slider")
    assert {"decimal"} == set(hand.page.eval_on_selector_all("[data-in]", "all => all.map(n => n.inputMode)"))
    hand.enter("scale", 10)
    hand.dot(40 + 40j, "p")
    hand.dot(70 + 40j, "b")
    hand.measure(40 + 40j, 70 + 40j)
    values = []
    for _ in range(3):
        hand.press("[data-put=r1_dot]")
        values.append((hand.answers()["r1_dot"], hand.page.inner_text(".surface-told").split(" = ")[1]))
    assert values == [("300", "300 mm/s"), ("-300", "−300 mm/s"), ("300", "300 mm/s")]


_MIDDLE = "n => { const b = n.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }"


def test_a_radius_may_be_a_term(pencil):
    hand = pencil("acceleration_polygon")
    hand.circle(80 + 45j, "300²/150/20")
    hand.circle(80 + 45j, "2,5^2*2/0.5")
    assert [one["r"] for one in drawn_items(hand.page, "a-drawing")] == [30, 25]
    hand.close()


def test_a_page_that_is_handed_out_draws_alone(desk, tmp_path):
    _, _, browser = desk
    course = coursework.open_course()
    sheet = handout(course["velocity_polygon"].variant(3, "fr"), "Zoé Martin")
    (tmp_path / "page.html").write_text(html.page(course.folder.template_folders, sheet), "utf-8")
    context = browser.new_context(viewport={"width": 390, "height": 844})
    page = context.new_page()
    faults = watched(page)
    page.goto(f"file://{tmp_path}/page.html")
    type_cells(page, "p", "80", "45,5")
    type_line(page, "a", "(60 ; 20)")
    draw_at(page, "b", 30 + 25j)
    page.reload()
    points = {"p": 80 + 45.5j, "a": 60 + 20j, "b": 30 + 25j}
    assert StudentDrawing.parse(page.input_value("[name=drawing]")).points == points
    assert [cells(page, name) for name in points] == [["80", "45,5"], ["60", "20"], ["30", "25"]]
    page.locator("[data-name=p]").evaluate(
        "n => scrollBy(0, n.getBoundingClientRect().bottom + 20 - innerHeight)"
    )
    x, y = page.locator("[data-name=p]").evaluate(_MIDDLE)
    assert y > 780  # where the bar of the page stands, which covers no control of the surface
    assert page.evaluate("([x, y]) => !!document.elementFromPoint(x, y).closest('[data-name=p]')", [x, y])
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert (scheme, too_wide(page), serious(page)) == (scheme, 0, [])
    page.on("dialog", lambda dialog: dialog.accept())
    page.click("#wipe")
    assert page.locator(".surface .dot").count() == 0
    assert [cells(page, name) for name in points] == [["", ""]] * 3
    assert faults == []
    context.close()


@pytest.mark.parametrize(
    "text",
    [
        '{"v": 1, "items": [{"k": "vector", "id": 1, "from": 7, "to": 8}]}',
        '{"v": 1, "items": [{"k": "__proto__", "id": 1}, {"k": "point", "id": 2, "n": "__proto__"}]}',
        '{"v": 1, "items": 7}',
        "[[[[",
        '{"v": 1, "items": [null, {"k": "body", "id": 1, "x": "<b>", "y": {}, "n": "<img src=x '
        'onerror=alert(1)>"}]}',
    ],
)
def test_what_is_no_drawing_stops_no_page(pencil, text):
    hand = pencil("velocity_polygon")
    hand.page.evaluate(
        "text => { const box = document.querySelector('[name=a-drawing]'); box.value = text; "
        "document.dispatchEvent(new Event('answers:filled')); }",
        text,
    )
    hand.dot(30 + 20j, "p")
    assert hand.page.locator("img[src=x]").count() == 0
    assert hand.page.input_value("[name=a-p]") == "(30 ; 20)"
    hand.close()
