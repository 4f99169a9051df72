"""A paper's page is prepared before the assignment opens: the same page, never an old one, for nobody before
its time."""

import io
import re
import zipfile
from dataclasses import replace
from datetime import timedelta
from functools import partial

import pytest
from site_assignments import ASSIGNMENT, CLOSES, OPENS, dealt, handed_in, right
from site_people import MAX, TEACHER, ZOE, Class
from sqlalchemy import func, select, update

from coursework.database.dump import dump
from coursework.database.erasing import erase
from coursework.database.jobs import MARK, PREPARE, take_job
from coursework.database.prepared import drop_prepared
from coursework.database.publication import student_assignments
from coursework.database.tables import assignment, job, person, prepared
from coursework.issuing.assignment import AskedExercise
from coursework.rendering import papers
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.site.papers import opening
from coursework.site.papers.student_paper import StudentPaper, student_paper
from coursework.site.worker import Worker

SECOND = timedelta(seconds=1)
EVERY_BOX = replace(
    ASSIGNMENT, exercises=tuple(map(AskedExercise, ("slotted_mechanism", "velocity_polygon", "grashof")))
)
BEFORE = OPENS - timedelta(hours=1)


@pytest.fixture
def served(class_of_three):
    class_of_three.site.has_worker = True
    return class_of_three


def prepared_by_worker(one):
    """Let a worker that begins do all that there is to do."""
    worker = Worker(one.site, "test")
    worker.prepare_all()
    while worker.work_once():
        pass
    return worker


def rows(one, table=prepared):
    with one.site.store.reading() as connection:
        return connection.execute(select(table)).all()


def page_of(browser, number):
    """The page of a paper, whatever its tokens."""
    reply = browser.get(f"/assignments/{number}")
    assert reply.status_code == 200
    return re.sub("[0-9a-f]{64}", "", reply.text)


def never(*told):
    raise AssertionError("a page is made")


def paper_of(one, number, name, lang):
    with one.site.store.reading() as connection:
        (place,) = student_assignments(connection, one.ids[name], number)
        return student_paper(connection, one.site.course, place, one.ids[name], lang)


def texts_of(page):
    """Something typed in each box of a page, or ticked."""
    texts = {}
    for name in dict.fromkeys(re.findall(r'name="(e\d+-[^"]+)"(?![^>]* data-cell)', page)):
        ticks = re.findall(rf'<input type="(radio|checkbox)" name="{re.escape(name)}" value="([^"]*)"', page)
        values = [value for _, value in ticks[: 2 if ticks and ticks[0][0] == "checkbox" else 1]]
        texts[name] = ", ".join(values) if ticks else f"1 < 2 & \"{name}\" = 'é'\n</textarea>"
    return texts


# --------------------------------------------------------------------- the same page


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_a_prepared_page_is_the_page_made_directly_byte_for_byte(served, lang, monkeypatch):
    """Blank, and with something in each box; and what stands in the boxes is what the templates of a sheet
    print."""
    number = dealt(served, assignment=EVERY_BOX)
    browser, address = served.browser(ZOE, lang), f"/assignments/{number}"
    direct = page_of(browser, number)
    texts = texts_of(direct)
    with served.site.store.begin() as connection:
        drop_prepared(connection, number)
    prepared_by_worker(served)
    with monkeypatch.context() as context:
        context.setattr(StudentPaper, "pieces", never)
        assert page_of(browser, number) == direct
        sent = {f"text.{name}": text for name, text in texts.items()}
        assert (
            browser.fill(f"{address}/keep", sent | {f"over.{name}": "0" for name in texts}).status_code == 200
        )
        typed = browser.get(address).text
    own = paper_of(served, number, ZOE, lang)
    env = environment_of(served.site.course.folder.template_folders, lang)
    filled = {name: [text, *text.split(", ")] for name, text in texts.items()}
    files = [{"filled": filled, "draws": ("graph", "paper")}] * len(EVERY_BOX.exercises)
    bodies = [
        one["body"] for one in papers.context(own.paper, "html.j2", partial(render, env), files)["exercises"]
    ]
    assert len(bodies) == 3
    assert all(body in typed for body in bodies)
    assert typed.count(" checked>") >= 1
    assert len(re.findall(r' value="1 &lt; 2 &amp; ', typed)) >= 2


def test_another_process_reads_the_page_that_one_made(served, monkeypatch):
    number = dealt(served)
    first = page_of(served.browser(ZOE), number)
    monkeypatch.setattr(StudentPaper, "pieces", never)
    other = Class.of(served)
    assert page_of(other.browser(ZOE), number) == first
    other.site.store.close()


def test_it_is_prepared_in_the_persons_language_and_in_all_where_none_is_known(served):
    dealt(served)
    with served.site.store.begin() as connection:
        connection.execute(update(person).where(person.c.id == served.ids[ZOE]).values(lang="fr"))
    prepared_by_worker(served)
    found = sorted((row.person_id, row.lang) for row in rows(served))
    assert found == sorted([(served.ids[ZOE], "fr"), (served.ids[MAX], "en"), (served.ids[MAX], "fr")])


# ------------------------------------------------------------------- what is changed


def changed_title(one, number):
    other = replace(ASSIGNMENT, title={"en": "Changed"})
    dealt(one, assignment=other, before=content_now(one, number))


def content_now(one, number):
    from coursework.database.assignments import issued_content as stored

    with one.site.store.reading() as connection:
        return stored(connection, number, secret=True)


def changed_instructions(one, number):
    with one.site.store.begin() as connection:
        told = {"instructions": {"en": "Changed"}, "exercises": []}
        connection.execute(update(assignment).where(assignment.c.id == number).values(asked=told))


def changed_paper(one, number):
    dealt(one, before=content_now(one, number), make_up=(ZOE,))


@pytest.mark.parametrize("change", [changed_title, changed_instructions, changed_paper])
def test_what_is_changed_shows_at_once(served, change):
    number = dealt(served)
    prepared_by_worker(served)
    browser = served.browser(ZOE)
    before = page_of(browser, number)
    change(served, number)
    after = page_of(browser, number)
    assert after != before
    if change is changed_paper:
        codes = [f"· {seed} ·" for _, seed in served.issued.issued_to(ZOE).items()]
        assert all(code in after and code not in before for code in codes)
    else:
        assert "Changed" in after
        assert "Changed" not in before
    with served.site.store.begin() as connection:
        drop_prepared(connection, number)
    assert page_of(browser, number) == after


def test_a_course_that_another_process_took_has_the_pages_looked_at_anew(served):
    number = dealt(served)
    other = Class.of(served)
    other.site.has_worker = True
    worker = prepared_by_worker(other)
    with served.site.store.begin() as connection:
        drop_prepared(connection, number)
    worker.work_once()
    assert rows(served) == []
    served.site.take(served.site.reopened())
    worker.work_once()
    while worker.work_once():
        pass
    assert len(rows(served)) == 4
    other.site.store.close()


# ------------------------------------------------------------------- before it opens


def test_nobody_reads_a_prepared_page_before_it_opens(served, tmp_path):
    served.at = BEFORE
    number = dealt(served)
    prepared_by_worker(served)
    (body, *_) = [row.body for row in rows(served) if row.person_id == served.ids[ZOE] and row.lang == "en"]
    words = {one for one in re.findall(r">([^<>\n]{20,})<", body) if one not in ("Show your work.",)}
    assert len(words) > 5
    for name in (ZOE, MAX):
        browser = served.browser(name)
        for address in (
            "/",
            "/assignments",
            "/account",
            "/account/data",
            "/practice",
            f"/assignments/{number}",
            f"/assignments/{number}/paper.pdf",
            f"/assignments/{number}/notebook.ipynb",
            f"/assignments/{number}/feedback",
        ):
            reply = browser.get(address)
            assert not [one for one in words if one.encode() in reply.content], address
            assert not (address.startswith(f"/assignments/{number}") and reply.status_code == 200)
        assert browser.post(f"/assignments/{number}", data={"_seal": browser.seal}).status_code == 409
    with zipfile.ZipFile(io.BytesIO(served.browser(ZOE).get("/account/data").content)) as data:
        assert "prepared.csv" in data.namelist()
        assert not [name for name in data.namelist() if body[:40].encode() in data.read(name)]
    served.at = OPENS
    assert body in served.browser(ZOE).get(f"/assignments/{number}").text


def test_no_dump_holds_it(served, tmp_path):
    dealt(served)
    prepared_by_worker(served)
    assert rows(served)
    dump(served.site.store, tmp_path / "dump")
    assert (tmp_path / "dump" / "issue.csv").exists()
    assert not (tmp_path / "dump" / "prepared.csv").exists()


# --------------------------------------------------------------------- what is left


def test_erasing_leaves_nothing_whatever_is_under_way(served, monkeypatch):
    number = dealt(served)
    prepared_by_worker(served)
    with served.site.store.begin() as connection:
        opening.prepare_later(connection, number, served.at)
        erase(connection, served.ids[ZOE])
    assert (
        {row.person_id for row in rows(served)}
        == {row.person_id for row in rows(served, job)}
        == {served.ids[MAX]}
    )
    pieces = StudentPaper.pieces

    def erased_meanwhile(own):
        made = pieces(own)
        with served.site.store.begin() as connection:
            drop_prepared(connection, number)
            erase(connection, served.ids[MAX])
        return made

    monkeypatch.setattr(StudentPaper, "pieces", erased_meanwhile)
    with served.site.store.begin() as connection:
        drop_prepared(connection, number)
    opening.prepare(served.site, number, served.ids[MAX], served.at)
    assert rows(served) == []


@pytest.mark.parametrize("end", ["closed", "unpublished"])
def test_nothing_is_kept_once_it_is_over(served, end):
    number = dealt(served)
    prepared_by_worker(served)
    assert rows(served)
    if end == "closed":
        served.at = CLOSES + timedelta(minutes=1)
        Worker(served.site, "test").close()
        assert "Midterm" in served.browser(ZOE).get(f"/assignments/{number}").text
    else:
        served.browser(TEACHER).fill(f"/desk/assignments/{number}/unpublish")
    prepared_by_worker(served)
    assert rows(served) == []


# ----------------------------------------------------------------------- the worker


def test_publishing_has_the_pages_prepared_and_hand_ins_go_before_them(served):
    number = dealt(served, None)
    form = {
        "opens": f"{BEFORE:%Y-%m-%dT%H:%M}",
        "closes": f"{CLOSES:%Y-%m-%dT%H:%M}",
        "late": "refuse",
        "feedback": "never",
    }
    staff = served.browser(TEACHER)
    for _ in range(2):
        assert staff.fill(f"/desk/assignments/{number}/publish", form).status_code == 303
    assert [row.kind for row in rows(served, job)] == [PREPARE] * 2  # one each, however often it is published
    handed_in(served.browser(ZOE), number, right(served, ZOE))
    with served.site.store.begin() as connection:
        assert take_job(connection, "test", served.at).kind == MARK


def test_a_page_that_cannot_be_made_stops_nobody_and_is_not_told_as_a_hand_in(served, monkeypatch, caplog):
    number = dealt(served)
    whole = StudentPaper.pieces
    monkeypatch.setattr(
        StudentPaper, "pieces", lambda own: never() if own.student == ZOE and own.lang == "fr" else whole(own)
    )
    prepared_by_worker(served)
    assert {row.person_id for row in rows(served)} >= {served.ids[MAX]}
    assert f"the page of person {served.ids[ZOE]} of assignment {number} failed" in caplog.text
    with served.site.store.reading() as connection:
        assert connection.execute(select(func.count()).select_from(job)).scalar() == 0
