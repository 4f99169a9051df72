"""A student's assignments: what is shown when, what is kept, and that a hand-in counts once."""

import csv
import io
import json
import re
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from site_assignments import ASSIGNMENT, CLOSES, OPENS, USUAL, code_of, dealt, handed_in, right
from site_people import MAX, TEACHER, ZOE
from tables import each_row

from coursework.database.current_marks import adjusted_sheets
from coursework.database.publication import (
    Extension,
    Publication,
    extend,
    publish,
    published,
    set_counting_attempt,
)
from coursework.database.submissions import submissions_of
from coursework.site.desk.class_cache import class_now
from coursework.site.papers import submission

SECOND = timedelta(seconds=1)


@pytest.fixture
def number(class_of_three):
    return dealt(class_of_three)


def delivered(one, number, name=ZOE):
    with one.site.store.reading() as connection:
        return submissions_of(connection, number, one.ids[name])


def marks(one, number, name=ZOE):
    with one.site.store.reading() as connection:
        return adjusted_sheets(connection, number, name)[-1]


def seen(reply):
    """The text of a page, with plain spaces."""
    return re.sub("[\u00a0\u202f]", " ", reply.text)


# ------------------------------------------------------------------------- what is shown


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_the_list_tells_what_is_open_to_come_and_closed(class_of_three, lang):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE, lang)
    words = {"en": ("Open", "Upcoming", "Closed"), "fr": ("Ouverts", "À venir", "Fermés")}[lang]
    for at, shown in ((OPENS, words[0]), (OPENS - SECOND, words[1]), (CLOSES + SECOND, words[2])):
        class_of_three.at = at
        with class_of_three.site.store.begin() as connection:
            publish(connection, number, USUAL)
        assert f"<h2>{shown}</h2>" in browser.get("/assignments").text


def test_nothing_of_a_paper_is_shown_before_it_opens(class_of_three):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    for path in ("", "/paper.pdf", "/notebook.ipynb", "/feedback"):
        class_of_three.at = OPENS - SECOND
        assert browser.get(f"/assignments/{number}{path}").status_code == 409
    class_of_three.at = OPENS
    assert browser.get(f"/assignments/{number}").status_code == 200


def test_an_assignment_that_is_not_published_is_not_there(class_of_three):
    number = dealt(class_of_three, None)
    browser = class_of_three.browser(ZOE)
    assert browser.get(f"/assignments/{number}").status_code == 404
    assert "Midterm" not in browser.get("/assignments").text


def test_of_anothers_assignment_nothing_is_there(class_of_three):
    number = dealt(class_of_three, names=(ZOE,))
    zoe, other = class_of_three.browser(ZOE), class_of_three.browser(MAX)
    code = code_of(handed_in(zoe, number, right(class_of_three, ZOE)))
    paths = (
        "",
        "/paper.pdf",
        "/notebook.ipynb",
        "/feedback",
        f"/receipts/{code}",
        f"/receipts/{code}.json",
        f"/receipts/{code}.txt",
    )
    for browser in (other, class_of_three.browser(TEACHER)):
        for path in paths:
            assert browser.get(f"/assignments/{number}{path}").status_code == 404
        for path in ("", "/keep", "/hand-in", "/file"):
            assert browser.fill(f"/assignments/{number}{path}", {"_number": "1"}).status_code == 404
    assert class_of_three.browser().get(f"/assignments/{number}").status_code == 303


def test_anothers_receipt_of_the_same_assignment_is_not_there(class_of_three):
    number = dealt(class_of_three)
    code = code_of(handed_in(class_of_three.browser(ZOE), number, right(class_of_three, ZOE)))
    for path in ("", ".json", ".txt"):
        assert (
            class_of_three.browser(MAX).get(f"/assignments/{number}/receipts/{code}{path}").status_code == 404
        )


def test_a_paper_holds_no_answer_and_nobody_elses_variant(class_of_three):
    number = dealt(class_of_three)
    mine, theirs = right(class_of_three, ZOE), class_of_three.issued.issued_to(MAX)
    page = class_of_three.browser(ZOE).get(f"/assignments/{number}").text
    assert not [text for text in mine.values() if text.isascii() and "." in text and text in page]
    assert not [seed for seed in theirs.values() if str(seed) in page]


def test_the_pdf_and_the_notebook_are_of_the_very_same_variant(class_of_three):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    seeds = set(map(str, class_of_three.issued.issued_to(ZOE).values()))
    notebook = browser.get(f"/assignments/{number}/notebook.ipynb").text
    page = browser.get(f"/assignments/{number}").text
    assert all(seed in notebook and seed in page for seed in seeds)
    assert browser.get(f"/assignments/{number}/paper.pdf").content.startswith(b"%PDF")


# ----------------------------------------------------------------------- what is kept


def test_what_is_typed_is_kept_read_back_and_comes_again(class_of_three):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    sent = {"text.e1-rA": "319,8 mm", "over.e1-rA": "0"}
    told = browser.fill(f"/assignments/{number}/keep", sent).json()
    assert told["versions"] == {"e1-rA": 1}
    assert told["read"]["e1-rA"] == "read as 319.8 mm"
    assert 'value="319,8 mm"' in browser.get(f"/assignments/{number}").text


def test_two_tabs_do_not_overwrite_one_another(class_of_three):
    number = dealt(class_of_three)
    browser, address = class_of_three.browser(ZOE), f"/assignments/{number}/keep"
    browser.fill(address, {"text.e1-rA": "1", "over.e1-rA": "0"})
    told = browser.fill(address, {"text.e1-rA": "2", "over.e1-rA": "0"}).json()
    assert told["others"] == {"e1-rA": {"text": "1", "version": 1}}
    assert browser.fill(address, {"text.e1-rA": "2", "over.e1-rA": "1"}).json()["versions"] == {"e1-rA": 2}


def test_a_form_without_a_script_is_kept_as_well(class_of_three):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    browser.fill(f"/assignments/{number}", {"e1-rA": "319,8", "_versions": "{}"})
    assert 'value="319,8"' in browser.get(f"/assignments/{number}").text


@pytest.mark.parametrize("field", [{"text.nothing": "1"}, {"text.e1-rA": "1", "over.e1-rA": "x"}])
def test_what_is_no_box_is_not_kept(class_of_three, field):
    number = dealt(class_of_three)
    assert class_of_three.browser(ZOE).fill(f"/assignments/{number}/keep", field).status_code == 400


def test_after_it_closed_nothing_is_kept_and_that_is_said(class_of_three):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    class_of_three.at = CLOSES + SECOND
    reply = browser.fill(f"/assignments/{number}/keep", {"text.e1-rA": "1", "over.e1-rA": "0"})
    assert (reply.status_code, "no longer accepted" in reply.json()["told"]) == (409, True)


def test_what_was_kept_before_it_closed_is_said_to_be_kept(class_of_three):
    """A device whose last answer from the site got lost asks once more."""
    number = dealt(class_of_three)
    browser, address = class_of_three.browser(ZOE), f"/assignments/{number}/keep"
    browser.fill(address, {"text.e1-rA": "1", "over.e1-rA": "0"})
    class_of_three.at = CLOSES + SECOND
    again = browser.fill(address, {"text.e1-rA": "1", "over.e1-rA": "0"})
    assert (again.status_code, again.json()["versions"]) == (200, {"e1-rA": 1})
    assert browser.fill(address, {"text.e1-rA": "2", "over.e1-rA": "1"}).status_code == 409


# ---------------------------------------------------------------------- handing in


def test_answers_are_read_back_before_anything_counts(class_of_three):
    number = dealt(class_of_three)
    page = class_of_three.browser(ZOE).fill(
        f"/assignments/{number}", {"e1-rA": "319,8 cm", "e1-theta4": "about that", "e2-linkage_type": "<b>&"}
    )
    for piece in ("read as 319.8", "cannot be read as a number", "left blank", "&lt;b&gt;&amp;"):
        assert piece in page.text
    assert not delivered(class_of_three, number)


def test_a_hand_in_is_marked_and_has_a_receipt(class_of_three):
    number = dealt(class_of_three)
    browser, texts = class_of_three.browser(ZOE), right(class_of_three, ZOE)
    reply = handed_in(browser, number, texts)
    told = browser.get(reply.headers["location"] + ".json").json()
    assert (told["answered"], told["asked"], told["late_seconds"]) == (5, 5, 0)
    assert {part: answer for _, _, part, answer in told["answers"]} == {n[3:]: t for n, t in texts.items()}
    assert {line.verdict for sheet in marks(class_of_three, number) for line in sheet.lines.values()} == {
        "correct"
    }
    assert told["sha256"] in browser.get(reply.headers["location"]).text


def test_going_back_from_a_receipt_sends_no_form_again_and_leads_to_the_receipt(class_of_three):
    number = dealt(class_of_three)
    browser, address = class_of_three.browser(ZOE), f"/assignments/{number}"
    assert browser.get(f"{address}/read-back").headers["location"] == address  # nothing is typed
    sent = browser.post(address, data={"_seal": browser.seal, "e1-rA": "1"})
    assert (sent.status_code, sent.headers["location"]) == (303, f"{address}/read-back")
    assert "read as 1" in browser.get(f"{address}/read-back").text
    reply = browser.fill(f"{address}/hand-in", {"e1-rA": "1", "_number": "1"})
    assert browser.get(f"{address}/read-back").headers["location"] == reply.headers["location"]
    browser.fill(f"{address}/keep", {"text.e1-rA": "2", "over.e1-rA": "1"})
    page = browser.get(f"{address}/read-back")  # something else was typed since
    assert (page.status_code, page.headers["cache-control"]) == (200, "no-store")
    assert "read as 2" in page.text


def test_a_time_is_told_by_its_moment_and_its_zone(class_of_three):
    number = dealt(class_of_three)
    reply = handed_in(class_of_three.browser(ZOE), number, {"e1-rA": "1"})
    page = class_of_three.browser(ZOE).get(reply.headers["location"]).text
    ((at, zone, text),) = re.findall(r'<time datetime="([^"]*)" data-zone="(\w+)" data-exact>([^<]*)<', page)
    assert (datetime.fromisoformat(at), text.endswith(f"({zone})")) == (class_of_three.at, True)


@pytest.mark.parametrize(("publication", "times"), [(USUAL, True), (Publication(), False)])
def test_a_time_zone_is_named_where_there_are_times(class_of_three, publication, times):
    number = dealt(class_of_three, publication)
    class_of_three.at = OPENS
    for address in ("/assignments", f"/assignments/{number}"):
        assert ("Times are in the time zone" in class_of_three.browser(ZOE).get(address).text) is times


def test_blank_answers_are_handed_in_too(class_of_three):
    number = dealt(class_of_three)
    handed_in(class_of_three.browser(ZOE), number, {"e1-rA": "1"})
    assert [len(one.lines) for one in marks(class_of_three, number)] == [2, 3]


def test_nothing_typed_is_not_handed_in(class_of_three):
    number = dealt(class_of_three)
    assert class_of_three.browser(ZOE).fill(f"/assignments/{number}", {"e1-rA": " "}).status_code == 422


def test_pressed_twice_or_sent_again_it_is_handed_in_once(class_of_three):
    number = dealt(class_of_three)
    browser, texts = class_of_three.browser(ZOE), right(class_of_three, ZOE)
    first = handed_in(browser, number, texts)
    second = browser.fill(f"/assignments/{number}/hand-in", {**texts, "_number": "1"})
    assert code_of(first) == code_of(second)
    assert "counts once" in browser.get(second.headers["location"]).text
    class_of_three.at = CLOSES + SECOND  # sent again when the line is back
    third = browser.fill(f"/assignments/{number}/hand-in", {**texts, "_number": "1"})
    assert code_of(first) == code_of(third)
    assert len(delivered(class_of_three, number)) == 1


def test_another_tab_with_something_else_is_told_and_loses_nothing(class_of_three):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    handed_in(browser, number, {"e1-rA": "1"})
    reply = handed_in(browser, number, {"e1-rA": "2", "_versions": '{"e1-rA": 1}'})
    assert "Something else" in browser.get(reply.headers["location"]).text
    assert len(delivered(class_of_three, number)) == 1
    assert 'value="2"' in browser.get(f"/assignments/{number}").text


def test_two_hand_ins_at_once_are_one(class_of_three):
    from concurrent.futures import ThreadPoolExecutor

    number = dealt(class_of_three)
    texts = right(class_of_three, ZOE)
    browsers = [class_of_three.browser(ZOE) for _ in range(4)]
    with ThreadPoolExecutor(4) as pool:
        replies = list(
            pool.map(lambda b: b.fill(f"/assignments/{number}/hand-in", {**texts, "_number": "1"}), browsers)
        )
    assert len({code_of(reply) for reply in replies}) == 1
    assert len(delivered(class_of_three, number)) == 1


def test_there_are_so_many_tries_and_each_has_its_receipt(class_of_three):
    number = dealt(class_of_three)
    browser, texts = class_of_three.browser(ZOE), right(class_of_three, ZOE)
    codes = {code_of(handed_in(browser, number, {**texts, "e1-rA": str(k)}, str(k))) for k in (1, 2)}
    assert len(codes) == 2
    assert browser.fill(f"/assignments/{number}/hand-in", {**texts, "_number": "3"}).status_code == 409
    last = delivered(class_of_three, number)[-1]
    assert browser.get(f"/assignments/{number}").headers["location"].endswith(last.receipt)
    assert [one.number for one in delivered(class_of_three, number)] == [1, 2]


def test_the_same_answers_once_more_cost_no_try(class_of_three):
    number = dealt(class_of_three)
    browser, texts = class_of_three.browser(ZOE), right(class_of_three, ZOE)
    first = handed_in(browser, number, texts)
    again = handed_in(browser, number, texts, "2")
    assert code_of(again) == code_of(first)
    assert "counts once" in browser.get(again.headers["location"]).text
    assert len(delivered(class_of_three, number)) == 1


@each_row("bad", ["", "0", "x", "1e9", "-1"])
def test_a_form_that_says_no_number_is_refused(class_of_three, number, bad):
    reply = class_of_three.browser(ZOE).fill(f"/assignments/{number}/hand-in", {"e1-rA": "1", "_number": bad})
    assert reply.status_code == 400


@each_row("bad", ['{"e1-rA": 1e999}', '{"e1-rA": "x"}', "[1]", "[" * 60_000])
def test_versions_that_are_none_are_refused(class_of_three, number, bad):
    sent = {"e1-rA": "1", "_versions": bad}
    assert class_of_three.browser(ZOE).fill(f"/assignments/{number}", sent).status_code == 400


# --------------------------------------------------------------------------- dates


def tried(one, number, at, name=ZOE):
    """What comes of handing in at a moment: late by so many seconds, or the status of the refusal."""
    one.at = at
    before = len(delivered(one, number, name))
    reply = one.browser(name).fill(
        f"/assignments/{number}/hand-in", {"e1-rA": str(before), "_number": str(before + 1)}
    )
    return delivered(one, number, name)[-1].late if reply.status_code == 303 else reply.status_code


LATE = replace(USUAL, tries=None, late="accept", late_until=CLOSES + timedelta(hours=2))


@pytest.mark.parametrize(
    ("publication", "at", "becomes"),
    [
        (USUAL, OPENS - SECOND, 409),
        (USUAL, OPENS, 0),
        (USUAL, CLOSES, 0),
        (USUAL, CLOSES + SECOND, 409),
        (LATE, CLOSES, 0),
        (LATE, CLOSES + SECOND, 1),
        (LATE, CLOSES + timedelta(hours=2), 7200),
        (LATE, CLOSES + timedelta(hours=2) + SECOND, 409),
        (replace(LATE, late_until=None), CLOSES + timedelta(days=9), 9 * 86400),
        (Publication(), datetime(2199, 1, 1, tzinfo=UTC), 0),
    ],
)
def test_what_comes_at_an_edge_is_taken_told_late_or_refused(class_of_three, publication, at, becomes):
    number = dealt(class_of_three, publication)
    assert tried(class_of_three, number, at) == becomes


def test_an_extension_wins_for_its_person_alone(class_of_three):
    number = dealt(class_of_three)
    until = CLOSES + timedelta(hours=1)
    with class_of_three.site.store.begin() as connection:
        more = Extension(until, 3, "ill", "Ada", OPENS)
        extend(connection, number, class_of_three.ids[ZOE], more)
    assert tried(class_of_three, number, until) == 0
    assert tried(class_of_three, number, until, MAX) == 409
    assert tried(class_of_three, number, until + SECOND) == 409
    assert "3" in class_of_three.browser(ZOE).get("/assignments").text


def test_a_clock_set_back_opens_nothing_again_and_takes_nothing_back(class_of_three):
    number = dealt(class_of_three, replace(USUAL, feedback="closed"))
    browser = class_of_three.browser(ZOE)
    handed_in(browser, number, right(class_of_three, ZOE))
    class_of_three.at = CLOSES + SECOND
    assert browser.get(f"/assignments/{number}/feedback").status_code == 200
    class_of_three.at = OPENS + SECOND
    assert browser.get(f"/assignments/{number}/feedback").status_code == 200
    assert tried(class_of_three, number, OPENS + SECOND) == 409
    class_of_three.at = OPENS - timedelta(days=400)
    assert browser.get(f"/assignments/{number}/feedback").status_code == 200


def test_a_clock_set_back_counts_hand_ins_by_number(class_of_three):
    number = dealt(class_of_three, replace(USUAL, opens=None))
    assert tried(class_of_three, number, OPENS) == 0
    assert tried(class_of_three, number, OPENS - timedelta(days=2)) == 0
    assert [one.number for one in delivered(class_of_three, number)] == [1, 2]


def test_publishing_anew_with_later_dates_opens_again(class_of_three):
    number = dealt(class_of_three)
    class_of_three.at = CLOSES + SECOND
    class_of_three.browser(ZOE).get("/assignments")
    with class_of_three.site.store.begin() as connection:
        assert published(connection, number).reached is not None
        publish(connection, number, replace(USUAL, closes=CLOSES + timedelta(days=1)))
    assert tried(class_of_three, number, CLOSES + SECOND) == 0


def test_what_was_saved_when_it_closed_is_handed_in_for_who_handed_in_nothing(class_of_three):
    number = dealt(class_of_three, replace(USUAL, takes_saved=True))
    zoe, other = class_of_three.browser(ZOE), class_of_three.browser(MAX)
    for browser in (zoe, other):
        browser.fill(f"/assignments/{number}/keep", {"text.e1-rA": "5", "over.e1-rA": "0"})
    handed_in(other, number, {"e1-rA": "6", "_versions": '{"e1-rA": 1}'})
    class_of_three.at = CLOSES + SECOND
    for _ in range(2):
        class_of_three.browser(MAX).get("/assignments")  # whoever comes first
    (saved,) = delivered(class_of_three, number)
    assert (saved.late, saved.received_at <= CLOSES) == (0, True)
    assert len(delivered(class_of_three, number, MAX)) == 1
    assert "for you" in zoe.get(f"/assignments/{number}/receipts/{saved.receipt}").text


def test_what_was_saved_is_not_lost_when_the_process_falls_as_it_is_handed_in(class_of_three, monkeypatch):
    number = dealt(class_of_three, replace(USUAL, takes_saved=True))
    class_of_three.browser(ZOE).fill(f"/assignments/{number}/keep", {"text.e1-rA": "5", "over.e1-rA": "0"})
    class_of_three.at = CLOSES + SECOND
    with monkeypatch.context() as falling:
        falling.setattr(submission, "_saved", lambda *all_of_it: 1 / 0)
        assert class_of_three.browser(MAX).get("/assignments").status_code == 500
    class_of_three.browser(MAX).get("/assignments")
    assert len(delivered(class_of_three, number)) == 1


def test_what_was_saved_counts_at_the_desk_before_any_student_comes(class_of_three):
    number = dealt(class_of_three, replace(USUAL, takes_saved=True))
    class_of_three.browser(ZOE).fill(f"/assignments/{number}/keep", {"text.e1-rA": "5", "over.e1-rA": "0"})
    class_of_three.at = CLOSES + timedelta(minutes=2)
    now = class_now(class_of_three.site, number)
    assert {one.lines["rA"].answer for one in now.machine.values() if "rA" in one.lines} == {"5"}


def test_a_fault_of_the_marking_is_no_fault_of_handing_in(class_of_three, monkeypatch):
    number = dealt(class_of_three)
    with monkeypatch.context() as falling:
        falling.setattr(submission, "mark_submission", lambda *all_of_it: 1 / 0)
        assert handed_in(class_of_three.browser(ZOE), number, right(class_of_three, ZOE)).status_code == 303
    assert not marks(class_of_three, number)
    class_of_three.at += timedelta(minutes=2)
    assert len(class_now(class_of_three.site, number).machine) == 2


def test_which_hand_in_counts_is_said_anew_at_the_desk_at_once(class_of_three):
    number = dealt(class_of_three)
    browser, texts = class_of_three.browser(ZOE), right(class_of_three, ZOE)
    handed_in(browser, number, texts)
    handed_in(browser, number, {"e1-rA": "1"}, "2")
    for counts, sitting in (("best", 1), ("last", 2)):
        with class_of_three.site.store.begin() as connection:
            set_counting_attempt(connection, number, counts)
        assert class_now(class_of_three.site, number).results[ZOE].sitting == sitting


def test_who_has_an_extension_is_handed_in_for_when_that_is_over(class_of_three):
    number = dealt(class_of_three, replace(USUAL, takes_saved=True))
    with class_of_three.site.store.begin() as connection:
        until = CLOSES + timedelta(hours=1)
        extend(connection, number, class_of_three.ids[ZOE], Extension(until, None, "ill", "Ada", OPENS))
    class_of_three.browser(ZOE).fill(f"/assignments/{number}/keep", {"text.e1-rA": "5", "over.e1-rA": "0"})
    for at, count in ((CLOSES + SECOND, 0), (until + SECOND, 1)):
        class_of_three.at = at
        class_of_three.browser(MAX).get("/assignments")
        assert len(delivered(class_of_three, number)) == count


# ------------------------------------------------------------------- what is told when

TOLD_WHEN = [
    ("at_once", {}, OPENS, 200),
    ("closed", {}, CLOSES, 409),
    ("closed", {}, CLOSES + SECOND, 200),
    ("date", {"feedback_on": CLOSES + SECOND}, CLOSES, 409),
    ("date", {"feedback_on": CLOSES + SECOND}, CLOSES + SECOND, 200),
    ("never", {}, CLOSES + timedelta(days=99), 409),
]


@pytest.mark.parametrize(("when", "more", "at", "status"), TOLD_WHEN)
def test_feedback_is_told_when_the_publication_says(class_of_three, when, more, at, status):
    number = dealt(class_of_three, replace(USUAL, feedback=when, **more))
    class_of_three.at = OPENS
    browser = class_of_three.browser(ZOE)
    handed_in(browser, number, {**right(class_of_three, ZOE), "e1-rA": "1"})
    class_of_three.at = at
    assert browser.get(f"/assignments/{number}/feedback").status_code == status


def test_right_answers_wait_until_it_has_closed_for_everybody(class_of_three):
    number = dealt(class_of_three, replace(USUAL, feedback="at_once", answers="closed"))
    texts, browser = right(class_of_three, ZOE), class_of_three.browser(ZOE)
    shown = str(round(float(texts["e1-rA"]), 1))
    handed_in(browser, number, {"e1-rA": "1"})
    with class_of_three.site.store.begin() as connection:
        until = CLOSES + timedelta(hours=1)
        extend(connection, number, class_of_three.ids[MAX], Extension(until, None, "ill", "Ada", OPENS))
    for at, is_told in ((OPENS, False), (CLOSES + SECOND, False), (until, False), (until + SECOND, True)):
        class_of_three.at = at
        assert (shown in browser.get(f"/assignments/{number}/feedback").text) is is_told


def test_an_assignment_that_never_shows_answers_shows_none(class_of_three):
    assignment = replace(ASSIGNMENT, answers="never")
    number = dealt(class_of_three, replace(USUAL, answers="closed"), assignment=assignment)
    browser = class_of_three.browser(ZOE)
    handed_in(browser, number, {"e1-rA": "1"})
    class_of_three.at = CLOSES + timedelta(days=9)
    shown = str(round(float(right(class_of_three, ZOE)["e1-rA"]), 1))
    assert shown not in browser.get(f"/assignments/{number}/feedback").text


def test_what_is_late_costs_beside_the_points_and_no_answer_costs_more(class_of_three):
    rule = replace(
        LATE, late_until=CLOSES + timedelta(days=5), late="charge", late_percent=10.0, feedback="at_once"
    )
    number = dealt(class_of_three, rule)
    browser = class_of_three.browser(ZOE)
    class_of_three.at = CLOSES + timedelta(days=1, seconds=1)
    texts = right(class_of_three, ZOE)
    assert "20 %" in seen(browser.fill(f"/assignments/{number}", texts))
    handed_in(browser, number, texts)
    out_of = sum(sheet.out_of for sheet in marks(class_of_three, number))
    assert sum(sheet.points for sheet in marks(class_of_three, number)) == out_of
    page = seen(browser.get(f"/assignments/{number}/feedback"))
    assert f"{0.8 * out_of:g} of {out_of:g}" in page
    assert "Mark with this deduction: 16" in page
    desk = class_of_three.browser(TEACHER)
    desk.get(f"/desk/{number}")
    assert zoes_total(desk, number) == {"points": f"{out_of:g}", "late": f"{0.2 * out_of:g}", "mark": "16"}
    assert "for lateness" in seen(desk.get(f"/desk/{number}/student?name={ZOE}"))
    # In time after all: the class is told, though nothing was handed in, marked or decided since.
    with class_of_three.site.store.begin() as connection:
        more = Extension(class_of_three.at, None, "ill", "Ada", OPENS)
        extend(connection, number, class_of_three.ids[ZOE], more)
    assert zoes_total(desk, number) == {"points": f"{out_of:g}", "mark": "20"}
    assert "deduction" not in seen(browser.get(f"/assignments/{number}/feedback"))


def zoes_total(desk, number):
    """What the class's summary says of her."""
    text = desk.get(f"/desk/{number}/files/summary.csv").content.decode("utf-8-sig")
    row = next(row for row in csv.DictReader(io.StringIO(text)) if row["student"] == ZOE)
    return {name: row[name] for name in ("points", "late", "mark") if name in row}


def test_of_two_tries_the_one_counts_that_is_better_with_what_is_taken_off(class_of_three):
    number = dealt(class_of_three, replace(LATE, late="charge", late_percent=50.0))
    browser, texts = class_of_three.browser(ZOE), right(class_of_three, ZOE)
    most = dict(list(texts.items())[:-1])
    handed_in(browser, number, most)
    class_of_three.at = CLOSES + timedelta(hours=1)
    handed_in(browser, number, texts, "2")
    first, second = (
        sum(one.points for one in marks(class_of_three, number) if one.sitting == n) for n in (1, 2)
    )
    assert second / 2 < first < second
    assert zoes_total(class_of_three.browser(TEACHER), number)["points"] == f"{first:g}"


# ---------------------------------------------------------------------------- files


def notebook_of(browser, number, answers):
    notebook = json.loads(browser.get(f"/assignments/{number}/notebook.ipynb").text)
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if "answers" in cell["metadata"].get("tags", []):
            for part, text in answers.items():
                source = source.replace(f'"{part}": None', f'"{part}": "{text}"').replace(
                    f'"{part}": ""', f'"{part}": "{text}"'
                )
            cell["source"] = source
    return json.dumps(notebook).encode()


def test_a_filled_notebook_is_read_back_and_handed_in(class_of_three):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    sent = {"file": ("my work.ipynb", notebook_of(browser, number, {"rA": "319,8", "theta4": "12"}))}
    page = browser.fill(f"/assignments/{number}/file", files=sent)
    assert (page.status_code, "read as 319.8" in page.text) == (200, True)
    assert not delivered(class_of_three, number)


def test_a_json_file_of_anothers_sheet_gives_nothing(class_of_three):
    number = dealt(class_of_three)
    seed = class_of_three.issued.issued_to(MAX)["slotted_mechanism"]
    content = [{"student": MAX, "exercise": "slotted_mechanism", "seed": seed, "answers": {"rA": "319,8"}}]
    sent = {"file": ("x.json", json.dumps(content).encode())}
    page = class_of_three.browser(ZOE).fill(f"/assignments/{number}/file", files=sent)
    assert page.status_code == 422
    assert "319,8" not in page.text


@each_row("name", ["x.parquet", "x.py", "x", "../x.toml"])
def test_a_file_of_another_kind_is_refused(class_of_three, number, name):
    page = class_of_three.browser(ZOE).fill(f"/assignments/{number}/file", files={"file": (name, b"1")})
    assert page.status_code == 422


def test_code_in_a_notebook_is_never_run(class_of_three, tmp_path):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    data = notebook_of(browser, number, {}).replace(
        b"answers = {", f"open('{tmp_path}/run', 'w'); answers = {{".encode()
    )
    browser.fill(f"/assignments/{number}/file", files={"file": ("x.ipynb", data)})
    assert not list(tmp_path.glob("run"))


# --------------------------------------------------------------------------- receipts


def test_staff_look_a_receipt_up_and_compare_its_digest(class_of_three):
    number = dealt(class_of_three)
    browser, staff = class_of_three.browser(ZOE), class_of_three.browser(TEACHER)
    reply = handed_in(browser, number, right(class_of_three, ZOE))
    told = browser.get(reply.headers["location"] + ".json").json()
    page = staff.get(
        "/desk/receipts", params={"code": told["receipt"].lower(), "digest": told["sha256"]}
    ).text
    assert ZOE in page
    assert "The same answers were handed in" in page
    assert (
        "Other answers"
        in staff.get("/desk/receipts", params={"code": told["receipt"], "digest": "0" * 64}).text
    )
    assert "has issued no such receipt" in staff.get("/desk/receipts", params={"code": "AAAA-AAAA-AAAA"}).text
    assert browser.get("/desk/receipts").status_code == 403
