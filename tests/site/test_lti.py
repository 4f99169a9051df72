"""The site behind links of a learning platform: who comes, what they are dealt, their points, what the staff
sees."""

import html
import re
from dataclasses import replace
from datetime import timedelta

import pytest
from lti_platform import DEEP, LTI, MEMBER, PLATFORM, SITE, TEACHER, field
from site_accounts import PASSWORD, join
from site_assignments import CLOSES, USUAL
from site_linked import AT_ONCE_TOLD, Linked
from site_people import MAX, ZOE
from site_people import TEACHER as ADA
from sqlalchemy import func, select, update

from coursework.database.assignments import issued_of
from coursework.database.audit import noted
from coursework.database.decisions import GIVEN, decide
from coursework.database.publication import CHARGE, NEVER
from coursework.database.tables import account, drawing, identity, person, submission
from coursework.errors import BadInput
from coursework.gradebook.decisions import Decision
from coursework.site.lti.service import settings_of


@pytest.fixture
def linked(tmp_path):
    return Linked(tmp_path)


def text_of(page):
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", page.text)).split())


def hands_in(linked, name="Ada Byron", wrong=(), **changed):
    visitor, page, path = linked.enter(name=name, **changed)
    texts = linked.right(name)
    done = visitor.hand_in(path, page, {**texts, **dict.fromkeys(list(texts)[: len(wrong)], "1.2345")})
    assert done.status_code == 303, done.text
    return visitor, path


# ------------------------------------------------------------------------ who comes


def test_who_comes_is_dealt_a_paper_as_late_ones_are_and_everybody_keeps_theirs(linked):
    before = linked.right(ZOE)
    _, page, _ = linked.enter()
    assert "Midterm" in page.text
    assert linked.right(ZOE) == before
    with linked.site.store.reading() as connection:
        issued = issued_of(connection, linked.number)
        done = noted(connection)
    assert set(issued.students) == {ZOE, MAX, "Ada Byron"}
    assert {one.what for one in done} == {"came from a platform", "late ones added"}
    own = issued.issued_to("Ada Byron")["slotted_mechanism"]
    assert own not in {issued.issued_to(ZOE)["slotted_mechanism"], issued.issued_to(MAX)["slotted_mechanism"]}


def test_a_second_launch_is_the_same_person_with_the_same_paper(linked):
    _, first, _ = linked.enter()
    _, again, _ = linked.enter(name="Ada Lovelace", launch_presentation={"locale": "fr_FR"})
    assert len(linked.one(identity)) == 1
    seeds = [re.findall(r"slotted_mechanism · (\d+)", page.text) for page in (first, again)]
    assert seeds[0] == seeds[1] != []
    assert 'lang="fr"' in again.text
    assert linked.one(person.c.name, person.c.lang)[-1] == ("Ada Lovelace", "fr")


def test_nobody_is_taken_for_another_by_the_name(linked):
    linked.enter(name=ZOE, sub="stranger")
    ((tied,),) = linked.one(identity.c.person_id)
    assert tied != linked.ids[ZOE]
    with linked.site.store.reading() as connection:
        assert f"{ZOE} (stranger)" in issued_of(connection, linked.number).students


VERIFIED = replace(PLATFORM, emails_verified=True)


def test_a_person_of_the_roster_is_known_by_the_one_e_mail(tmp_path):
    linked = Linked(tmp_path, platform=VERIFIED)
    with linked.site.store.begin() as connection:
        connection.execute(
            update(person).where(person.c.id == linked.ids[ZOE]).values(columns={"Email": "zoe@uni.example"})
        )
    linked.enter(name="Zoé Martin", email="ZOE@uni.example")
    assert linked.one(identity.c.person_id) == [(linked.ids[ZOE],)]
    linked.enter(name="Zoé Again", sub="other", email="zoe@uni.example")
    assert len({one for (one,) in linked.one(identity.c.person_id)}) == 2  # she is somebody's already
    with linked.site.store.reading() as connection:
        assert [one.about["how"] for one in noted(connection) if one.what == "came from a platform"] == [
            "new",
            "roster",
        ]


def has_mail(linked, name, mail):
    with linked.site.store.begin() as connection:
        mine = person.c.id == linked.ids[name]
        connection.execute(update(person).where(mine).values(columns={"Email": mail}))


def test_an_e_mail_that_anybody_could_have_written_makes_nobody_somebody(linked):
    """The attacker has an account of their own on the platform, and wrote the victim's address into it."""
    has_mail(linked, ZOE, "zoe@uni.example")
    logins = dict(linked.one(account.c.person_id, account.c.login))
    for number, mail in enumerate(("zoe@uni.example", *logins.values())):
        linked.enter(sub=f"attacker {number}", name="Mallory", email=mail)
    tied = {one for (one,) in linked.one(identity.c.person_id)}
    assert len(tied) == 1 + len(logins)
    assert not tied & set(linked.ids.values())
    whos = str(linked.one(person.c.who, person.c.columns))
    assert whos.count("zoe@uni.example") == 1, "nor is a later roster tied to who came with it"


def test_who_has_a_password_is_tied_by_it_alone(tmp_path):
    linked = Linked(tmp_path, platform=VERIFIED)
    has_mail(linked, ZOE, "zoe@uni.example")
    join(linked, ZOE)
    _, page, _ = linked.enter(name="Zoé", email="zoe@uni.example")
    assert page.status_code == 403
    assert not linked.one(identity)
    place = re.search(r"/connect/[\w.-]+", page.text)[0]
    assert linked.browser(MAX).get(place).status_code == 403, "another's account cannot be connected there"
    assert linked.browser(ADA).get(place).status_code == 403
    assert linked.browser().get(place).status_code == 303
    zoe = linked.browser(ZOE)
    assert zoe.fill(place, {"now": "a guess"}).status_code == 422
    assert not linked.one(identity)
    assert zoe.get(place + "x").status_code == 410
    assert zoe.fill(place, {"now": PASSWORD}).status_code == 303
    assert linked.one(identity.c.person_id) == [(linked.ids[ZOE],)]
    assert zoe.fill(place, {"now": PASSWORD}).status_code == 410, "once"
    _, page, _ = linked.enter(name="Zoé", email="zoe@uni.example")
    assert page.status_code == 200


def test_the_staff_sees_who_was_tied_and_separates_them(linked):
    visitor, _, path = linked.enter()
    ((ada, _),) = [row for row in linked.one(person.c.id, person.c.name) if row.name == "Ada Byron"]
    staff = linked.browser(ADA)
    page = staff.get(f"/desk/people/{ada}").text
    assert "connected at the first launch" in page
    number = re.search(r'name="tie" value="(\d+)"', page)[1]
    other = f"/desk/people/{linked.ids[ZOE]}/separate"
    assert staff.fill(other, {"tie": number}).status_code == 404
    assert visitor.browser.get(path).status_code == 200
    assert staff.fill(f"/desk/people/{ada}/separate", {"tie": number}).status_code == 303
    assert not linked.one(identity)
    assert visitor.browser.get(path).status_code in (403, 404), "its sessions ended"
    with linked.site.store.reading() as connection:
        assert "separated from a platform" in {one.what for one in noted(connection)}
    linked.enter()
    assert linked.one(identity.c.person_id) != [(ada,)]


def test_signing_out_everywhere_ends_sessions_in_frames(tmp_path):
    linked = Linked(tmp_path, platform=VERIFIED)
    has_mail(linked, ZOE, "zoe@uni.example")
    visitor, _, path = linked.enter(name="Zoé", email="zoe@uni.example")
    assert visitor.browser.get(path).status_code == 200
    linked.browser(ZOE).fill("/account", {"do": "everywhere"})
    assert visitor.browser.get(path).status_code in (403, 404)


def test_no_address_makes_anybody_an_instructor(tmp_path):
    linked = Linked(tmp_path, platform=VERIFIED)
    logins = dict(linked.one(account.c.person_id, account.c.login))
    linked.enter(email=logins[linked.ids[ADA]])
    assert linked.one(identity.c.person_id)[0][0] != linked.ids[ADA]


def test_another_s_session_is_not_shown(linked):
    _, _, path = linked.enter()
    other, _, _ = linked.enter(sub="bob", name="Bob")
    assert other.browser.get(path).status_code in (403, 404)
    assert linked.visitor().browser.get(path).status_code in (403, 404)


# ------------------------------------------------------------------------ handing in


def test_a_score_is_that_of_the_class_page(linked):
    visitor, path = hands_in(linked, wrong=[0])
    (score,) = linked.sent()
    row = linked.points("Ada Byron")
    assert 0 < row.points < row.out_of
    assert (score["scoreGiven"], score["scoreMaximum"]) == (row.points, row.out_of)
    assert (score["userId"], score["gradingProgress"]) == ("ada", "FullyGraded")
    assert "Receipt" in text_of(visitor.browser.get(path))
    assert linked.one(submission.c.source) == [("site: from a platform",)]


def test_a_decision_sends_the_score_anew(linked):
    hands_in(linked, wrong=[0])
    linked.sent()
    assert linked.lti.state.watch.look() == 0
    before = linked.points("Ada Byron")
    part = "rA"
    with linked.site.store.begin() as connection:
        half = Decision("Ada Byron", "slotted_mechanism", "", part, GIVEN, 0.5, "half", by="Ada")
        decide(connection, linked.number, [half])
    assert linked.lti.state.watch.look() == 1
    assert linked.lti.state.watch.look() == 0
    last = linked.sent()[-1]
    assert len(linked.platform.scores) == 2
    assert last["scoreGiven"] == linked.points("Ada Byron").points == before.points + 0.5


def test_a_form_that_comes_twice_is_one_hand_in_and_tries_are_those_of_the_publication(linked):
    visitor, page, path = linked.enter()
    texts = linked.right("Ada Byron")
    for _ in range(2):
        assert visitor.hand_in(path, page, texts).status_code == 303
    assert linked.one(func.count(submission.c.id)) == [(1,)]
    sheet = visitor.browser.get(f"{path}?again=1")
    assert field(sheet.text, "_number") == "2"
    assert visitor.hand_in(path, sheet, texts | dict.fromkeys(list(texts)[:1], "7")).status_code == 303
    more = visitor.hand_in(path, sheet, texts, _number="3")
    assert more.status_code == 409
    assert linked.sent()[-1]["scoreGiven"] == linked.points("Ada Byron").points


def test_what_cannot_be_read_is_handed_in_only_when_one_insists_and_is_pending(linked):
    visitor, page, path = linked.enter()
    texts = linked.right("Ada Byron") | {"e1-rA": "hello?"}
    back = visitor.hand_in(path, page, texts)
    assert back.status_code == 422
    assert 'value="hello?"' in back.text
    assert visitor.hand_in(path, page, texts, _as_it_is="1").status_code == 303
    assert linked.sent()[-1]["gradingProgress"] == "PendingManual"
    with linked.site.store.begin() as connection:
        given = Decision("Ada Byron", "slotted_mechanism", "", "rA", GIVEN, 0.25, by="Ada")
        decide(connection, linked.number, [given])
    linked.lti.state.watch.look()
    assert linked.sent()[-1]["gradingProgress"] == "FullyGraded"


def test_what_is_late_is_charged_and_the_staff_sees_the_same_points(linked):
    linked.publish(replace(AT_ONCE_TOLD, late=CHARGE, late_percent=10.0))
    linked.at = CLOSES + timedelta(hours=1)
    hands_in(linked)
    row = linked.points("Ada Byron")
    assert linked.sent()[-1]["scoreGiven"] == pytest.approx(row.points * 0.9)
    _, page, _ = linked.enter(sub="emmy", name="Emmy", roles=TEACHER)
    assert f"{round(row.points * 0.9, 3):g} / {row.out_of:g}" in text_of(page)


# --------------------------------------------------------------------- when it is told


def test_no_score_goes_before_marks_are_told(tmp_path):
    linked = Linked(tmp_path, USUAL)
    visitor, path = hands_in(linked)
    linked.lti.state.watch.look()
    assert linked.sent() == []
    assert "Your points go to the course’s gradebook when they are published" in text_of(
        visitor.browser.get(path)
    )
    linked.at = CLOSES + timedelta(minutes=1)
    assert linked.lti.state.watch.look() == 1
    assert linked.sent()[0]["scoreGiven"] == linked.points("Ada Byron").points
    linked.publish(replace(USUAL, feedback=NEVER))


def test_what_is_not_published_opens_for_no_student(linked):
    linked.publish(None)
    _, page, _ = linked.enter()
    assert page.status_code == 404
    assert "not published" in text_of(page)
    assert not linked.one(identity)


def test_what_is_closed_deals_nothing(linked):
    linked.at = CLOSES + timedelta(hours=1)
    _, page, _ = linked.enter()
    assert page.status_code == 409
    with linked.site.store.reading() as connection:
        assert "Ada Byron" not in issued_of(connection, linked.number).students


# ------------------------------------------------------------------------- the staff


def picks(linked):
    settings = {
        "deep_link_return_url": f"{SITE}/return",
        "accept_types": ["ltiResourceLink"],
        "accept_presentation_document_targets": ["iframe"],
        "accept_multiple": True,
    }
    visitor = linked.visitor()
    page, _ = visitor.enter(
        sub="emmy",
        roles=TEACHER,
        **{
            f"{LTI}message_type": "LtiDeepLinkingRequest",
            f"{DEEP}deep_linking_settings": settings,
            f"{LTI}resource_link": None,
        },
    )
    return page


def test_an_instructor_picks_among_published_assignments(linked):
    assert 'value="assignment:week3"' in picks(linked).text
    assert 'value="exercise:slotted_mechanism"' in picks(linked).text
    linked.publish(None)
    assert "week3" not in picks(linked).text


def test_an_instructor_sees_the_class_and_no_person_is_made_of_them(linked):
    hands_in(linked, wrong=[0])
    before = len(linked.one(person))
    linked.platform.members = [
        {"user_id": "ada", "name": "Ada Byron", "roles": ["Learner"]},
        {"user_id": "new", "name": "New One", "roles": ["Learner"]},
    ]
    _, page, _ = linked.enter(sub="emmy", name="Emmy", roles=TEACHER)
    told, row = text_of(page), linked.points("Ada Byron")
    assert f"{row.points:g} / {row.out_of:g}" in told
    assert "New One" in told
    assert f"/desk/{linked.number}" in page.text
    assert len(linked.one(person)) == before


def test_who_teaches_another_course_of_the_platform_sees_nobody_of_this_one(linked):
    """A link may name any assignment: before, it showed names, points and marks of a class that is not
    theirs."""
    hands_in(linked)
    row = linked.points("Ada Byron")
    told = f"{row.points:g} / {row.out_of:g}"
    linked.platform.members = [{"user_id": "ada", "name": "Ada Byron", "roles": ["Learner"]}]
    other = {"id": "course-2", "title": "Elsewhere"}
    of_a_course = [[f"{MEMBER}{role}"] for role in ("Instructor", "Administrator", "ContentDeveloper")]
    for stated in (*of_a_course, [f"{MEMBER[:-1]}/Instructor#TeachingAssistant", TEACHER[0]]):
        _, page, _ = linked.enter(sub="eve", name="Eve", roles=stated, **{f"{LTI}context": other})
        assert page.status_code == 200
        assert told not in text_of(page), stated
        _, page, _ = linked.enter(sub="emmy", name="Emmy", roles=stated)
        assert told in text_of(page), stated
    with linked.site.store.reading() as connection:
        assert not connection.execute(select(identity).where(identity.c.subject.in_(["eve", "emmy"]))).all()


def test_the_staff_sees_which_scores_wait(linked):
    hands_in(linked)
    linked.platform.down = 500
    linked.lti.state.sender.send_due()
    told = text_of(linked.browser(ADA).get("/desk/lti"))
    assert "Ada Byron" in told
    assert "500" in told
    linked.platform.down = 0


def test_who_is_erased_is_forgotten_by_the_service_too(linked):
    hands_in(linked)
    visitor, path = hands_in(linked, name="Bob", sub="bob")
    ((ada, name),) = [row for row in linked.one(person.c.id, person.c.name) if row.name == "Ada Byron"]
    done = linked.browser(ADA).fill(f"/desk/people/{ada}/erase", {"name": name})
    assert done.status_code == 303
    assert {launch.person for *_, launch in linked.storage.opened()} == {"bob"}
    assert {one.launch.person for one in linked.storage.scores()} == {"bob"}
    assert visitor.browser.get(path).status_code == 200


# ------------------------------------------------------------------- headers, cookies


def test_frames_and_cookies_are_those_of_each_side(linked):
    visitor, page, _ = linked.enter()
    assert f"frame-ancestors {SITE}" in page.headers["content-security-policy"]
    assert "x-frame-options" not in page.headers
    assert {one.name.rpartition("-")[0] for one in visitor.browser.cookies.jar} == {"__Host-lti-at"}
    assert "coursework-session" not in {one.name for one in visitor.browser.cookies.jar}
    own = linked.browser(ZOE).get("/practice")
    assert "frame-ancestors 'none'" in own.headers["content-security-policy"]
    assert own.headers["x-frame-options"] == "DENY"


def test_a_folder_for_another_address_is_refused(tmp_path):
    (tmp_path / "platforms.toml").write_text('[service]\nurl = "https://old.example.org"\n', "utf-8")
    with pytest.raises(BadInput, match=r"https://old\.example\.org"):
        settings_of(tmp_path, "https://new.example.org")
    (tmp_path / "platforms.toml").write_text('[service]\nurl = "https://new.example.org/lti"\n', "utf-8")
    assert settings_of(tmp_path, "https://new.example.org").url == "https://new.example.org/lti"


def test_a_paper_in_a_frame_has_a_surface_whose_drawing_is_kept_with_what_is_handed_in(linked):
    visitor, page, path = linked.enter(custom={"exercise": "two_circles", "tries": "2"})
    assert "data-surface" in page.text
    assert re.findall(r'<script src="/static/([a-z_]+)\.js', page.text) == ["cells", "drawing_paper"]
    assert "script-src 'self'" in page.headers["content-security-policy"]
    assert "script-src 'self'" in html.unescape(page.text)
    drawing_ = '{"v": 1, "items": [{"k": "point", "id": 1, "x": 12.5, "y": 30, "n": "p"}], "scale": null}'
    answers = {"e1-kl": "2", "e1-p": "(12.5 ; 30)", "e1-drawing": drawing_, "_as_it_is": "1"}
    assert visitor.hand_in(path, page, answers).status_code == 303
    assert [row.text for row in linked.one(drawing.c.text)] == [drawing_]
    again = visitor.browser.get(path, params={"again": "1"})
    assert html.escape(drawing_, quote=False).replace('"', "&quot;") in again.text.replace("&#34;", "&quot;")
    broken = visitor.hand_in(
        path, again, {**answers, "e1-drawing": "</textarea><script>alert(1)</script>", "e1-kl": "3"}
    )
    assert broken.status_code == 303
    assert len(linked.one(drawing.c.text)) == 1
    assert "<script>alert" not in visitor.browser.get(path, params={"again": "1"}).text
    _, plain, _ = linked.enter(sub="eve", name="Eve")
    assert "script-src 'none'" in html.unescape(plain.text)
