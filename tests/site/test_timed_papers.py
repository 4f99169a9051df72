"""A paper whose working time counts from its start: nobody gains a second, and nobody loses what was kept."""

from dataclasses import replace
from datetime import timedelta

import pytest
from lti_platform import seal
from site_assignments import CLOSES, FORM, OPENS, USUAL, dealt, handed_in, right
from site_linked import AT_ONCE_TOLD, Linked
from site_people import MAX, TEACHER, ZOE

from coursework.database.people import put_people, set_extra_time
from coursework.database.publication import CLOSED, Publication, published
from coursework.database.submissions import submissions_of
from coursework.issuing.roster import Student
from coursework.site.worker import SETTLES, Worker

SECOND, MINUTE = timedelta(seconds=1), timedelta(minutes=1)
TIMED = replace(USUAL, minutes=90, takes_saved=True)


@pytest.fixture
def number(class_of_three):
    class_of_three.at = OPENS
    return dealt(class_of_three, TIMED)


def kept(browser, number, text, over="0"):
    return browser.fill(f"/assignments/{number}/keep", {"text.e1-rA": text, "over.e1-rA": over})


def delivered(one, number, name=ZOE):
    with one.site.store.reading() as connection:
        return submissions_of(connection, number, one.ids[name])


def begun(one, number, name=ZOE):
    browser = one.browser(name)
    assert browser.fill(f"/assignments/{number}/start").status_code == 303
    return browser


def test_nothing_of_a_paper_is_told_or_taken_before_its_start(class_of_three, number):
    browser, other = class_of_three.browser(ZOE), class_of_three.browser(MAX)
    begun(class_of_three, number, MAX)
    page = browser.get(f"/assignments/{number}")
    assert page.status_code == 200
    assert "1 hour 30 minutes" in page.text
    assert 'name="e1-rA"' not in page.text
    for path in ("paper.pdf", "notebook.ipynb", "read-back", "feedback"):
        assert browser.get(f"/assignments/{number}/{path}").status_code == 409, path
    assert kept(browser, number, "1").status_code == 409
    assert browser.fill(f"/assignments/{number}/hand-in", {"e1-rA": "1", "_number": "1"}).status_code == 409
    assert 'name="e1-rA"' in other.get(f"/assignments/{number}").text
    assert class_of_three.browser(ZOE).get(f"/assignments/{number}/start").status_code == 405, (
        "a link starts nothing"
    )


def test_the_time_counts_from_the_start_to_the_second_for_every_browser(class_of_three, number):
    """Opening again, starting again, another browser, forms of before: none of them gains time."""
    browser = begun(class_of_three, number)
    class_of_three.at += 90 * MINUTE - SECOND
    second = begun(class_of_three, number)
    page = second.get(f"/assignments/{number}").text
    assert 'data-remaining="1"' in page
    assert kept(second, number, "1").status_code == 200
    class_of_three.at += SECOND
    assert kept(browser, number, "2", "1").status_code == 200, "the very moment is in time"
    class_of_three.at += SECOND
    for one in (browser, second, class_of_three.browser(ZOE)):
        assert kept(one, number, "3", "2").status_code == 409
        assert one.fill(f"/assignments/{number}/start").status_code == 303
        assert one.fill(f"/assignments/{number}/hand-in", {"e1-rA": "4", "_number": "2"}).status_code == 409
    (only,) = delivered(class_of_three, number)
    assert (only.source, only.number) == ("site: as saved when it closed", 1)


@pytest.mark.slow
def test_what_was_kept_is_handed_in_at_the_end_of_each(class_of_three, number):
    """While others still write; and nobody's before its end."""
    kept(begun(class_of_three, number), number, "11")
    class_of_three.at += 30 * MINUTE
    kept(begun(class_of_three, number, MAX), number, "12")
    class_of_three.at += 61 * MINUTE
    class_of_three.browser(MAX).get("/assignments")
    class_of_three.browser(TEACHER).get(f"/desk/{number}")
    assert [len(delivered(class_of_three, number, name)) for name in (ZOE, MAX)] == [1, 0]
    class_of_three.at += 30 * MINUTE
    class_of_three.browser(TEACHER).get(f"/desk/{number}")
    assert [len(delivered(class_of_three, number, name)) for name in (ZOE, MAX)] == [1, 1]


@pytest.mark.slow
def test_the_worker_hands_in_at_each_end_without_anybody(class_of_three, number):
    class_of_three.site.has_worker = True
    worker = Worker(class_of_three.site, "w")
    for name in (ZOE, MAX):
        kept(begun(class_of_three, number, name), number, "11")
        class_of_three.at += 20 * MINUTE
    ends = OPENS + 90 * MINUTE
    found = []
    for at in (ends + SETTLES, ends + SETTLES + SECOND, ends + 20 * MINUTE + SETTLES + SECOND):
        class_of_three.at = at
        worker.close()
        found.append([len(delivered(class_of_three, number, name)) for name in (ZOE, MAX)])
    assert found == [[0, 0], [1, 0], [1, 1]]


@pytest.mark.slow
def test_a_clock_set_back_opens_no_paper_again(class_of_three, number):
    browser = begun(class_of_three, number)
    kept(browser, number, "1")
    class_of_three.at += 91 * MINUTE
    assert kept(browser, number, "2", "1").status_code == 409
    class_of_three.at -= 60 * MINUTE
    assert kept(browser, number, "3", "1").status_code == 409
    assert browser.fill(f"/assignments/{number}/start").status_code == 303
    assert (
        'name="e1-rA"' not in browser.get(f"/assignments/{number}").text
        or "data-remaining" not in browser.get(f"/assignments/{number}").text
    )


@pytest.mark.slow
def test_a_late_start_ends_with_the_class_and_that_is_said_before(class_of_three, number):
    class_of_three.at = CLOSES - 12 * MINUTE
    browser = class_of_three.browser(ZOE)
    assert "after 12 minutes" in browser.get(f"/assignments/{number}").text
    begun(class_of_three, number)
    assert 'data-remaining="720"' in browser.get(f"/assignments/{number}").text
    class_of_three.at = CLOSES + SECOND
    assert kept(browser, number, "1").status_code == 409
    assert class_of_three.browser(MAX).fill(f"/assignments/{number}/start").status_code == 303
    assert kept(class_of_three.browser(MAX), number, "1").status_code == 409


@pytest.mark.slow
def test_extra_time_lengthens_the_paper_and_the_window_and_is_shown(class_of_three, number):
    """A third more of 90 minutes are 120; and a paper of 100 minutes has 134, in whole minutes."""
    staff = class_of_three.browser(TEACHER)
    told = {"person": [str(class_of_three.ids[ZOE]), str(class_of_three.ids[MAX])], "extra_time": "1/3"}
    assert staff.fill("/desk/people/extra-time", told).status_code == 303
    assert staff.get("/desk/people").text.count("<td>+ 1/3</td>") == 2
    assert (
        staff.fill(
            "/desk/people/extra-time", {**told, "person": told["person"][1], "extra_time": "0"}
        ).status_code
        == 303
    )
    class_of_three.at = CLOSES - 60 * MINUTE
    browser, other = begun(class_of_three, number), begun(class_of_three, number, MAX)
    page = browser.get(f"/assignments/{number}").text
    assert 'data-remaining="5400"' in page, "until half an hour after the class"
    assert "with your extra time" in page
    assert 'data-remaining="3600"' in other.get(f"/assignments/{number}").text
    assert "2 hours" in staff.get(f"/desk/assignments/{number}").text
    class_of_three.at = CLOSES + 30 * MINUTE
    assert [kept(one, number, "1").status_code for one in (browser, other)] == [200, 409]
    class_of_three.at += SECOND
    assert kept(browser, number, "2", "1").status_code == 409
    assert Publication(minutes=100).personal(None, 1 / 3).minutes == 134


@pytest.mark.slow
def test_answers_wait_for_who_has_extra_time(class_of_three):
    number = dealt(class_of_three, replace(TIMED, feedback=CLOSED, answers=CLOSED, minutes=240))
    class_of_three.at = OPENS
    browser = begun(class_of_three, number)
    handed_in(browser, number, {"e1-rA": "1"})
    with class_of_three.site.store.begin() as connection:
        set_extra_time(connection, [class_of_three.ids[MAX]], 1 / 3)
    shown = str(round(float(right(class_of_three, ZOE)["e1-rA"]), 1))
    for at, expected in ((CLOSES + SECOND, False), (CLOSES + 80 * MINUTE + SECOND, True)):
        class_of_three.at = at
        assert (shown in browser.get(f"/assignments/{number}/feedback").text) is expected


def test_a_roster_gives_extra_time_and_does_not_undo_what_was_set_by_hand(class_of_three):
    store = class_of_three.site.store

    def extra(cell=None):
        with store.begin() as connection:
            columns = {} if cell is None else {"tiers temps": cell}
            put_people(connection, [Student(ZOE, columns=columns)])
        with store.reading() as connection:
            from coursework.database.people import person_by_id

            return person_by_id(connection, class_of_three.ids[ZOE]).extra_time

    assert extra("oui") == pytest.approx(1 / 3)
    with store.begin() as connection:
        set_extra_time(connection, [class_of_three.ids[ZOE]], 0.5)
    assert (extra("oui"), extra(""), extra()) == (0.5, 0.5, 0.5)
    assert extra("25 %") == 0.25
    assert extra("non") is None


@pytest.mark.slow
def test_an_extension_in_minutes_opens_an_ended_paper_again_for_several_at_once(class_of_three, number):
    staff = class_of_three.browser(TEACHER)
    browser = begun(class_of_three, number)
    kept(browser, number, "1")
    class_of_three.at += 91 * MINUTE
    assert kept(browser, number, "2", "1").status_code == 409
    told = {
        "person": [str(class_of_three.ids[name]) for name in (ZOE, MAX)],
        "minutes": "100",
        "reason": "fire alarm",
    }
    assert staff.fill(f"/desk/assignments/{number}/extend", told).status_code == 303
    assert kept(browser, number, "2", "1").status_code == 200
    assert handed_in(browser, number, {"e1-rA": "2"}, "1").status_code == 303
    assert [one.number for one in delivered(class_of_three, number)] == [1, 2]
    assert 'data-remaining="6000"' in begun(class_of_three, number, MAX).get(f"/assignments/{number}").text


@pytest.mark.slow
def test_other_minutes_published_while_it_runs_count_from_the_start(class_of_three, number):
    browser = begun(class_of_three, number)
    staff = class_of_three.browser(TEACHER)
    form = {**FORM, "late": "refuse", "late_percent": "", "late_until": "", "minutes": "45"}
    assert staff.fill(f"/desk/assignments/{number}/publish", form).status_code == 303
    with class_of_three.site.store.reading() as connection:
        assert published(connection, number).takes_saved
    assert 'data-remaining="2700"' in browser.get(f"/assignments/{number}").text
    refused = staff.fill(f"/desk/assignments/{number}/publish", {**FORM, "minutes": "45"})
    assert refused.status_code == 422
    assert "takes no late work" in refused.text
    assert staff.fill(f"/desk/assignments/{number}/publish", {**form, "minutes": "1e9"}).status_code == 422


@pytest.mark.slow
def test_only_who_adds_people_gives_extra_time(class_of_three):
    told = {"person": str(class_of_three.ids[ZOE]), "extra_time": "1/2"}
    assert class_of_three.browser(ZOE).fill("/desk/people/extra-time", told).status_code == 403
    staff = class_of_three.browser(TEACHER)
    assert staff.fill("/desk/people/extra-time", {**told, "extra_time": "a bit"}).status_code == 422
    assert staff.fill("/desk/people/extra-time", {"extra_time": "1/2"}).status_code == 422


@pytest.mark.slow
def test_a_frame_of_a_platform_starts_the_paper_first(tmp_path):
    linked = Linked(tmp_path)
    linked.publish(replace(AT_ONCE_TOLD, minutes=30, takes_saved=True))
    visitor, page, path = linked.enter()
    assert "Start now" in page.text
    assert "e1-rA" not in page.text

    def sent(**fields):
        return visitor.browser.post(path, data={"_seal": seal(page.text), **fields}).status_code

    assert sent(_number="1", **linked.right("Ada Byron")) == 409
    assert sent(_start="1") == 303
    sheet = visitor.browser.get(path)
    assert "e1-rA" in sheet.text
    linked.at += 31 * MINUTE
    assert visitor.hand_in(path, sheet, linked.right("Ada Byron")).status_code == 409
