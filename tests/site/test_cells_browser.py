"""Boxes of components in Chromium: they and the line follow each other, what is pasted is spread, without a
script they are joined, and a screen reader tells them apart."""

import pytest
from site_browser import desk_at, told, windows
from site_people import MAX, ZOE

pytestmark = pytest.mark.e2e
PART = "a-V_plane"


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    """Open a practice page of joint_twist for somebody."""
    with desk_at(tmp_path_factory.mktemp("site")) as desk, windows(desk, ZOE) as open_:
        yield lambda name, **how: open_("/practice/joint_twist", name=name, **how)


def cells(page, name=PART, count=3):
    return [page.input_value(f"#answer-{name}-{index}") for index in range(1, count + 1)]


def test_boxes_and_line_follow_each_other_and_what_is_pasted_is_spread(window):
    page = window(ZOE)
    page.fill(f"#answer-{PART}-1", "{1,5 ; 2 ; -3}")
    assert cells(page) == ["1,5", "2", "-3"]
    page.fill(f"#answer-{PART}-2", "20")
    assert page.input_value(f"#answer-{PART}") == "vx = 1,5; vy = 20; wz = -3"
    page.wait_for_selector("#read-a-V_plane:has-text('1.5; 20; −3')")
    page.fill("#answer-a-V_10-1", "{0 10; 0 20; 5 0}")  # a row of each column
    assert cells(page, "a-V_10", 6) == ["0", "0", "5", "10", "20", "0"]
    page.fill("#answer-a-W-2", "7")
    page.locator("#answer-a-W").evaluate("one => one.closest('details').open = true")
    page.fill("#answer-a-W", "1 2 3 | 4 5 6")
    assert cells(page, "a-W", 6) == ["1", "2", "3", "4", "5", "6"]
    told(page, "Saved")
    page.reload()
    assert [cells(page), cells(page, "a-W", 6)[5]] == [["1,5", "20", "-3"], "6"]
    page.click(f"#below-{PART} button[name=check]")
    page.wait_for_selector(f"#told-{PART} p")


def test_without_a_script_the_boxes_are_joined_and_filled_again(window):
    page = window(MAX, script=False)
    for index, text in enumerate(("1,5", "2", "-3"), 1):
        page.fill(f"#answer-{PART}-{index}", text)
    page.click(f"#below-{PART} button[name=check]")
    assert "(1.5; 2; −3)" in page.inner_text(f"#told-{PART}")
    assert (cells(page), page.input_value(f"#answer-{PART}")) == (["1,5", "2", "-3"], "")
    page.fill(f"#answer-{PART}-2", "")
    page.click(f"#below-{PART} button[name=check]")
    assert "blank" in page.inner_text(f"#read-{PART}")
    assert cells(page) == ["1,5", "", "-3"]


@pytest.mark.parametrize(("exercise", "lang"), [("joint_twist", "en"), ("velocity_polygon", "fr")])
def test_in_the_tree_for_screen_readers_each_box_and_button_has_a_name_of_its_own(window, exercise, lang):
    """In Chromium's own tree, where a formula in a label is not a name."""
    page = window(ZOE, lang=lang)
    page.goto(page.url.replace("/joint_twist/", f"/{exercise}/"))
    tree = page.context.new_cdp_session(page).send("Accessibility.getFullAXTree")["nodes"]
    named = {}
    for node in tree:
        if not node["ignored"]:
            named.setdefault(node["role"]["value"], []).append(node.get("name", {}).get("value", "").strip())
    for role in ("textbox", "button"):
        assert all(named[role])
        assert len(set(named[role])) == len(named[role]), named[role]
    groups = page.locator(".cells").evaluate_all("all => all.map((one) => one.getAttribute('aria-label'))")
    assert set(groups) <= set(named["group"])
    assert len(named["MathMLMath"]) > 50
    assert all(len(name.split()) >= 8 for name in named["image"])
