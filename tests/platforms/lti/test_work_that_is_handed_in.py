"""A link of an exercise: a student's own variant, answers, feedback and points; what platforms are told, and
what erasing leaves."""

import io
import json
import zipfile
from datetime import timedelta

import httpx
import jwt
import pytest
from lti_platform import (
    AGS,
    CLIENT,
    DEEP,
    DEPLOYMENT,
    LTI,
    MEMBER,
    PLATFORM,
    SCOPES,
    SITE,
    TEACHER,
    TOOL,
    field,
    seal,
)
from site_people import TEACHER as ADA
from site_people import ZOE
from sqlalchemy import select, update
from tables import each_row

from coursework.database.tables import (
    METADATA,
    answer,
    assignment,
    identity,
    lti_launch,
    mark,
    submission,
    variant,
)
from coursework.issuing.roster import read_roster
from coursework.language.words import words
from coursework.platforms.lti.launch import launch_of
from coursework.platforms.lti.sending import wait_after
from coursework.platforms.lti.services import NotServed, Services
from coursework.platforms.lti.storage import Score
from coursework.site import worker

SAID = words("en")["lti"]
NAME = "slotted_mechanism"


def drawn(html, name=NAME):
    """The seed on a page."""
    return int(html.split(f"{name} · ")[1].split(" ")[0])


def variant_on(tool, html, name=NAME):
    """The variant of a page, as it was issued."""
    mine = variant.c.exercise == name, variant.c.seed == str(drawn(html, name))
    with tool.site.store.reading() as connection:
        record = connection.execute(select(variant.c.record).where(*mine)).scalars().first()
    return tool.course[name].from_record(record)


def right_answers(tool, html, wrong=(), name=NAME):
    """What a student writes who is right, but for some parts."""
    found = variant_on(tool, html, name)
    return {f"e1-{part.id}": written(found, part, part.id in wrong) for part in found.parts}


def written(found, part, wrong=False):
    value = found.solution()[part.quantity]
    if part.choices:
        letters = found.letters(part)
        return next(letter for case, letter in letters.items() if (case == value) != wrong)
    return f"{value * (3.7 if wrong else 1):.6g}"


def works(visitor, tool, wrong=(), **changed):
    """A student who enters and hands in; the feedback and the path."""
    page, path = visitor.enter(**changed)
    done = visitor.hand_in(path, page, right_answers(tool, page.text, wrong))
    assert done.status_code == 303, done.text
    return visitor.browser.get(path), path


# ---------------------------------------------------------------------- variants


def test_a_variant_is_the_student_s_own_and_stays(tool):
    first, _ = tool.visitor().enter()
    again, _ = tool.visitor().enter(name="Renamed", context={"id": "moved"})
    elsewhere, _ = tool.visitor().enter(resource_link={"id": "link-2"})
    others = [tool.visitor().enter(sub=f"s{k}", name=f"S{k}")[0] for k in range(5)]
    assert drawn(first.text) == drawn(again.text)
    given = {tuple(variant_on(tool, page.text).given.values()) for page in (first, elsewhere, *others)}
    assert len(given) == 7


def test_a_page_speaks_the_language_of_the_launch(tool):
    french, _ = tool.visitor().enter(launch_presentation={"locale": "fr_CA"})
    english, _ = tool.visitor().enter(launch_presentation={"locale": "en_US"})
    assert words("fr")["lti"]["hand_in"] in french.text
    assert '<html lang="fr">' in french.text
    assert SAID["hand_in"] in english.text


def test_a_sheet_holds_no_answer_and_runs_no_script(tool):
    page, _ = tool.visitor().enter()
    solution = variant_on(tool, page.text).solution()
    assert not [
        value
        for value in solution.values()
        if not isinstance(value, str) and f"{abs(value):.5g}" in page.text
    ]
    assert "<script" not in page.text
    assert "script-src 'none'" in page.text


# ----------------------------------------------------------------------- handing in


def test_right_answers_have_all_the_points_and_reach_the_gradebook(tool, visitor):
    page, _ = works(visitor, tool)
    assert "<b>9</b> / 9 points" in page.text.replace("\u00a0", " ")
    assert tool.send() == (1, 0)
    (score,) = tool.platform.scores
    assert (score["userId"], score["scoreGiven"], score["scoreMaximum"]) == ("ada", 9, 9)
    assert (score["activityProgress"], score["gradingProgress"]) == ("Completed", "FullyGraded")
    assert score["line"] == f"{SITE}/lines/9/scores?of=7"
    assert score["comment"].startswith("9 of 9 points (try 1). 1.1: right;")


def test_feedback_on_an_exercise_waits_for_no_worker(tool, visitor):
    tool.site.has_worker = True
    page, _ = works(visitor, tool)
    assert "<b>9</b> / 9 points" in page.text.replace("\u00a0", " ")
    assert tool.send() == (1, 0)


@pytest.mark.e2e
def test_in_a_rush_an_exercise_is_acknowledged_and_its_page_reloads_until_the_worker_has_marked_it(
    tool, monkeypatch
):
    tool.site.has_worker = True
    for k in range(6):
        other = tool.visitor()
        page, path = other.enter(sub=f"student {k}", custom={"exercise": NAME})
        assert other.hand_in(path, page, right_answers(tool, page.text)).status_code == 303
    assert not tool.one(mark.c.id)  # no form waits for a mark
    receipt = other.browser.get(path)
    assert words("en", "site")["lti"]["handed_in"] in receipt.text
    assert 3 <= int(receipt.headers["refresh"]) <= 5
    monkeypatch.setattr(worker, "_QUIET", timedelta(0))
    while worker.Worker(tool.site, "here").work_once():
        pass
    assert "<b>9</b> / 9 points" in other.browser.get(path).text.replace("\u00a0", " ")


def test_what_cannot_be_read_uses_no_try(tool, visitor):
    page, path = visitor.enter(custom={"exercise": NAME, "tries": "1"})
    answers = right_answers(tool, page.text) | {"e1-rA": "hello?", "e1-theta4": 'x" onfocus="<b>'}
    back = visitor.hand_in(path, page, answers)
    assert back.status_code == 422
    assert SAID["unread"] in back.text
    assert 'value="hello?"' in back.text
    assert "<b>" not in back.text.split("<main>")[1].replace("<b>9</b>", "")
    assert not tool.one(submission.c.id)
    verdicts = words("en")["feedback"]["verdicts"]
    assert f">{verdicts['correct']}<" not in back.text  # and tells nothing of the others
    assert SAID["empty"] in visitor.hand_in(path, page, {"e1-rA": "  "}).text
    assert visitor.hand_in(path, page, {"points": "9"}).status_code == 400
    assert visitor.hand_in(path, page, {"e1-rA": "1"}, _number="7" * 9).status_code == 400
    assert not tool.one(submission.c.id)
    assert visitor.hand_in(path, back, right_answers(tool, page.text)).status_code == 303
    assert len(tool.one(submission.c.id)) == 1


def test_tries_are_limited_where_the_link_says_so(tool, visitor):
    custom = {"exercise": NAME, "tries": "2", "counts": "last", "answers": "after"}
    page, path = works(visitor, tool, custom=custom)
    assert SAID["again"] in page.text
    sheet = visitor.browser.get(f"{path}?again=1")
    assert SAID["tries_left"]["one"].format(1) in sheet.text
    assert all(f'value="{text}"' in sheet.text for text in right_answers(tool, sheet.text).values())
    assert words("en")["feedback"]["right"] not in page.text
    visitor.hand_in(path, sheet, right_answers(tool, sheet.text, wrong=["rA", "swing"]))
    last = visitor.browser.get(f"{path}?again=1")
    assert SAID["no_try_left"] in last.text
    assert words("en")["feedback"]["right"] in last.text
    assert visitor.hand_in(path, sheet, {"e1-rA": "1"}, _number="3").status_code == 409
    tool.send()
    assert len(tool.platform.scores) == 1  # the first had not gone yet, and is no longer what counts
    assert tool.platform.scores[0]["scoreGiven"] < 9
    page, path = tool.visitor().enter(custom={**custom, "tries": "3", "counts": "best"})
    assert SAID["tries_left"]["one"].format(1) in page.text, "the teacher may change the rules"
    tool.lti.state.watch.look()
    tool.send()
    assert [one["scoreGiven"] for one in tool.platform.scores[1:]] == [9]


# --------------------------------------------------------------------- one store


def kept_of(tool, number):
    """What a person is given of their data, by table."""
    data = tool.browser(ADA).get(f"/desk/people/{number}/data").content
    return json.loads(zipfile.ZipFile(io.BytesIO(data)).read("everything.json"))


def test_answers_of_a_link_are_in_what_a_person_is_given_and_are_erased(tool, visitor):
    """Before, they stood in a file of their own, which no download and no erasing knew."""
    page, path = visitor.enter(name="Unmistakable")
    visitor.hand_in(path, page, right_answers(tool, page.text) | {"e1-rA": "0.123456 m"})
    bob = tool.visitor()
    works(bob, tool, sub="bob", name="Bob")
    ((ada,),) = tool.one(identity.c.person_id)[:1]
    kept = kept_of(tool, ada)
    assert [row["answer"] for row in kept["answer"] if row["part"] == "rA"] == ["0.123456 m"]
    assert {"submission", "marking", "mark", "issue", "identity", "lti_launch", "lti_session"} <= {
        k for k in kept if kept[k]
    }
    assert kept["lti_launch"][0]["maximum"] == 9
    erased = tool.browser(ADA).fill(f"/desk/people/{ada}/erase", {"name": "Unmistakable"})
    assert erased.status_code == 303
    assert visitor.browser.get(path).status_code == 403
    assert len(tool.one(submission.c.id)) == len(tool.one(lti_launch.c.id)) == 1
    for table in METADATA.tables.values():
        told = str(tool.one(*table.c))
        assert "Unmistakable" not in told, table.name
        assert "0.123456" not in told, table.name
    assert not [
        file for file in tool.site.lti.parent.glob("site.db*") if b"Unmistakable" in file.read_bytes()
    ]
    ((number,),) = tool.one(identity.c.person_id)
    tool.browser(ADA).fill(f"/desk/people/{number}/erase", {"name": "Bob"})
    assert [name for (name,) in tool.one(assignment.c.name)] == ["week3"], "nobody has a paper of the link"
    assert tool.visitor().enter()[0].status_code == 200


def test_the_desk_has_the_class_of_a_link_as_any_other(tool):
    works(tool.visitor(), tool, wrong=["rA"])
    ((number,),) = [(n,) for n, link in tool.one(assignment.c.id, assignment.c.link) if link]
    desk = tool.browser(ADA)
    page = desk.get(f"/desk/{number}").text
    assert "Ada Byron" in page
    assert "Slotted mechanism" in page
    issued = desk.get(f"/desk/assignments/{number}/issued.json").json()
    assert [item["student"] for item in issued["issued"]] == ["Ada Byron"]


# ------------------------------------------------------------------------- scores


@pytest.mark.e2e
def test_a_score_waits_while_the_platform_does_not_take_it(tool, visitor):
    _, path = works(visitor, tool)
    for down in (-1, 500, 503, 429, 403):
        tool.platform.down = down
        assert tool.send() == (0, 1)
        assert tool.send() == (0, 0)  # not at once again
        assert SAID["score_waits"] in visitor.browser.get(path).text.replace("’", "'")
        tool.ahead += 3700.0
        tool.begin()  # a restart loses nothing
    tool.platform.down = 0
    assert tool.send() == (1, 0)
    assert tool.platform.scores[0]["scoreGiven"] == 9


def test_each_failure_puts_the_next_attempt_off_for_longer(tool, monkeypatch):
    monkeypatch.setattr(tool, "clock", lambda: 1000.0 + tool.ahead)
    tool.begin()
    storage = tool.storage = tool.lti.state.watch._storage
    queue(tool, 1)
    tool.platform.down, delays = 503, []
    for _ in range(4):
        assert tool.send() == (0, 1)
        (waiting,) = storage.scores()
        delays.append((waiting.due - storage.now).total_seconds())
        tool.ahead += 3700
    assert (delays, waiting.failures) == ([5, 10, 20, 40], 4)


def test_waits_grow_to_an_hour():
    assert [wait_after(n) for n in (0, 1, 2, 3)] == [5, 10, 20, 40]
    assert wait_after(50) == wait_after(10**6) == 3600
    assert wait_after(0, 404) == 900


def launched(tool, **changed):
    """A launch of somebody whom the site knows, with their id."""
    launch = launch_of({**tool.platform.claims("n", **changed), "client_id": CLIENT})
    number = tool.ids[ZOE]
    tool.storage.record(launch, number, tool.number)
    return launch, number


def queue(tool, points, **changed):
    """Queue a score; whether it is new."""
    return tool.storage.put_score(*launched(tool, **changed), Score(points, 9))


def test_stamps_grow_even_where_the_clock_stands_or_goes_back(tool):
    stamps = []
    for points, ahead in ((1, 0.0), (2, 0.0), (3, -3600.0), (4, -3600.0)):
        tool.ahead = ahead
        assert queue(tool, points)
        assert not queue(tool, points)
        stamps.append(tool.storage.scores()[0].stamp)
    assert stamps == sorted(set(stamps))


def test_a_score_that_changes_while_one_is_on_its_way_is_sent_too(tool):
    queue(tool, 1)
    (sent,) = tool.storage.due()
    assert tool.storage.due() == [], "another process sends it not at once"
    queue(tool, 2)
    tool.storage.arrived(sent)
    (waiting,) = tool.storage.due()
    assert waiting.score.given == 2


def test_a_platform_that_has_a_later_score_is_told_again(tool):
    tool.platform.scores.append({"userId": "ada", "timestamp": "2999-01-01T00:00:00.000Z"})
    queue(tool, 2)
    before = tool.storage.scores()[0].stamp
    assert tool.send() == (0, 1)
    assert tool.storage.scores()[0].stamp >= before + timedelta(seconds=1)
    tool.platform.scores.clear()
    tool.ahead = 10.0
    assert tool.send() == (1, 0)


def test_a_token_that_is_no_longer_good_is_had_anew(tool):
    queue(tool, 1)
    assert tool.send() == (1, 0)
    tool.platform.tokens.clear()
    queue(tool, 2)
    assert tool.send() == (1, 0)
    assert tool.platform.asked_for("/token") == 2


def test_a_link_without_a_column_has_one_made_once(tool):
    for points in (1, 2):
        queue(tool, points, **{f"{AGS}claim/endpoint": {"scope": SCOPES, "lineitems": f"{SITE}/lines"}})
        assert tool.send() == (1, 0)
    assert [one["resourceLinkId"] for one in tool.platform.lines] == ["link-1"]
    assert {one["line"] for one in tool.platform.scores} == {f"{SITE}/lines/1/scores?of=7"}


def test_a_link_that_takes_no_points_sends_none(tool, visitor):
    page, _ = works(visitor, tool, **{f"{AGS}claim/endpoint": None})
    assert SAID["score_none"] in page.text
    assert not tool.storage.scores()


def test_a_score_that_was_never_queued_is_found_at_the_next_launch(tool, visitor):
    works(visitor, tool)
    with tool.site.store.begin() as connection:
        connection.execute(update(lti_launch).values(stamp=None, due=None))
    tool.visitor().enter(name="Ada B.")
    assert tool.send() == (1, 0)


# -------------------------------------------------------------------------- class

MEMBERS = [
    {
        "user_id": "ada",
        "name": "Ada Byron",
        "email": "ada@example.org",
        "lis_person_sourcedid": "n1",
        "roles": ["Learner"],
    },
    {"user_id": "bob", "given_name": "Bob", "family_name": "Noyce", "roles": [f"{MEMBER}Learner"]},
    {
        "user_id": "bob2",
        "name": "Bob Noyce",
        "email": "b2@example.org",
        "roles": [f"{MEMBER}Learner"],
        "status": "Active",
    },
    {"user_id": "gone", "name": "Gone", "roles": [f"{MEMBER}Learner"], "status": "Inactive"},
    {"user_id": "emmy", "name": "Emmy Noether", "roles": [f"{MEMBER}Instructor"]},
]


def test_the_roster_of_a_platform_is_one_that_build_reads(tool, tmp_path):
    tool.platform.members = MEMBERS
    teacher = tool.visitor()
    _, path = teacher.enter(sub="emmy", roles=TEACHER)
    file = tmp_path / "class.csv"
    file.write_bytes(teacher.browser.get(f"{path}/roster.csv").content)
    students = read_roster(file)
    assert [one.name for one in students] == ["Ada Byron", "Bob Noyce (bob)", "Bob Noyce (b2@example.org)"]
    assert students[0].columns["email"] == "ada@example.org"
    assert tool.platform.asked_for("/members") == 3  # pages of two


def test_a_class_without_a_roster_shows_who_came(tool):
    works(tool.visitor(), tool)
    tool.platform.down = 500
    page, _path = tool.visitor().enter(sub="emmy", roles=TEACHER)
    assert "Ada Byron" in page.text
    assert "answers 500" in page.text


def test_a_teacher_tries_the_sheet_and_nothing_is_kept_of_it(tool):
    teacher = tool.visitor()
    page, path = teacher.enter(sub="emmy", roles=TEACHER)
    assert words("en", "site")["lti"]["class"]["nobody"] in page.text
    sheet = teacher.browser.get(f"{path}/sheet")
    seed = drawn(sheet.text)
    parts = [part.id for part in tool.course[NAME].variant(seed).parts]
    unread = teacher.hand_in(f"{path}/sheet", sheet, {f"e1-{part}": "hello?" for part in parts[:1]})
    assert (unread.status_code, SAID["unread"] in unread.text) == (422, True)
    done = teacher.hand_in(f"{path}/sheet", sheet, {"e1-rA": "1 m"})
    assert done.status_code == 200
    assert SAID["preview"].split(".")[0] in done.text
    assert words("en")["feedback"]["right"] not in done.text
    assert teacher.hand_in(path, sheet, {"e1-rA": "1 m"}).status_code == 404
    for table in (submission, answer, mark, identity, lti_launch):
        assert not tool.one(table.c.id), table.name
    assert len(tool.one(assignment.c.id)) == 1
    _, path = teacher.enter(sub="emmy", roles=TEACHER, custom={"assignment": "week3"})
    assert "Midterm" in teacher.browser.get(f"{path}/sheet").text


def test_a_student_sees_nothing_of_the_class(tool, visitor):
    tool.platform.members = MEMBERS
    _, path = visitor.enter()
    for page in ("roster.csv", "sheet", "elsewhere", "../x"):
        assert visitor.browser.get(f"{path}/{page}").status_code in (403, 404), page


@each_row("roles", [([],), (["Mentor"],), ([f"{MEMBER}Observer"],), (["urn:lti:role:ims/lis/Boss"],)])
def test_who_is_neither_student_nor_teacher_sees_and_sends_nothing(tool, roles):
    visitor = tool.visitor()
    page, path = visitor.enter(roles=roles)
    assert page.status_code == 403
    assert visitor.browser.get(f"{path}/roster.csv").status_code == 403
    assert visitor.browser.post(path, data={"_seal": "x"}).status_code == 403


@each_row(
    ("custom", "why"),
    [
        ({}, "nothing_chosen"),
        ({"exercise": "gone"}, "unknown_choice"),
        ({"assignment": "gone"}, "unknown_choice"),
        ({"exercise": NAME, "parts": "zz"}, "unknown_choice"),
        ({"exercise": NAME, "tries": "many"}, "no_question"),
    ],
)
def test_a_link_that_opens_nothing_says_so(tool, custom, why):
    page, _ = tool.visitor().enter(custom=custom)
    assert page.status_code in (400, 404)
    assert SAID["refused"][why].split(".")[0] in page.text


def test_a_link_whose_content_is_changed_opens_the_new_one(tool, visitor):
    works(visitor, tool)
    page, _ = tool.visitor().enter(custom={"exercise": "grashof"})
    assert "grashof ·" in page.text
    assert SAID["hand_in"] in page.text


# --------------------------------------------------------------------- deep linking


def picking(visitor, **settings):
    told = {
        "deep_link_return_url": f"{SITE}/return?a=1&b=2",
        "accept_types": ["ltiResourceLink"],
        "accept_multiple": True,
        "data": "as it came",
        **settings,
    }
    return visitor.enter(
        sub="emmy",
        roles=TEACHER,
        message_type="LtiDeepLinkingRequest",
        resource_link=None,
        **{f"{DEEP}deep_linking_settings": told},
    )


def picked(visitor, form, **settings):
    page, path = picking(visitor, **settings)
    answer = visitor.browser.post(path, data={"_seal": seal(page.text), **form})
    assert answer.status_code == 200, answer.text
    assert 'action="https://learn.example.org/return?a=1&amp;b=2"' in answer.text
    token = field(answer.text, "JWT")
    key = next(
        one
        for one in visitor.platform.tool_keys()["keys"]
        if one["kid"] == jwt.get_unverified_header(token)["kid"]
    )
    return jwt.decode(token, jwt.PyJWK(key).key, algorithms=["RS256"], audience=SITE, issuer=CLIENT)


def test_what_is_picked_goes_back_signed(visitor):
    told = picked(
        visitor,
        {
            "offer": [f"exercise:{NAME}", "exercise:grashof"],
            "points": "20",
            "tries": "3",
            "counts": "last",
            "answers": "after",
        },
    )
    assert told[f"{LTI}message_type"] == "LtiDeepLinkingResponse"
    assert told[f"{LTI}deployment_id"] == DEPLOYMENT
    assert told[f"{DEEP}data"] == "as it came"
    items = told[f"{DEEP}content_items"]
    assert [one["custom"] for one in items] == [
        {"exercise": name, "tries": "3", "counts": "last", "answers": "after"} for name in (NAME, "grashof")
    ]
    assert items[0]["lineItem"] == {
        "scoreMaximum": 20,
        "label": "Slotted mechanism",
        "resourceId": f"exercise:{NAME}",
    }
    assert items[0]["url"] == f"{TOOL}/lti/launch"


def test_a_picked_link_opens_what_was_picked_and_is_no_offer_itself(tool, visitor):
    (item,) = picked(visitor, {"offer": "exercise:grashof"})[f"{DEEP}content_items"]
    page, _ = tool.visitor().enter(custom=item["custom"])
    found = variant_on(tool, page.text, "grashof")
    assert item["lineItem"]["scoreMaximum"] == sum(part.points for part in found.parts)
    page, _ = picking(tool.visitor())
    assert 'value="assignment:week3"' in page.text
    assert page.text.count("assignment:") == 1, "not that of the link"


def test_a_platform_that_takes_no_column_is_sent_none(visitor):
    (item,) = picked(visitor, {"offer": f"exercise:{NAME}"}, accept_lineitem=False)[f"{DEEP}content_items"]
    assert "lineItem" not in item


def test_leaving_without_a_link_goes_back_too(visitor):
    assert picked(visitor, {"cancel": "1"})[f"{DEEP}content_items"] == []


def test_exercises_are_found_in_both_languages(tool, visitor):
    page, path = picking(visitor)
    offered = page.text.count('name="offer"')
    assert offered == len(tool.course.names) + 1
    for sought in ("coulisse", "SLOTTED  mechanism", "slotted_mechanism"):
        found = visitor.browser.get(path, params={"q": sought}).text
        assert f'value="exercise:{NAME}"' in found
        assert 0 < found.count('name="offer"') < offered
    none = visitor.browser.get(path, params={"q": "<script>zz"}).text
    assert "&lt;script&gt;zz" in none
    assert "<script>" not in none


# ------------------------------------------------------------------------- keys


def test_an_old_key_serves_until_it_is_retired(tool, monkeypatch):
    monkeypatch.setattr("coursework.platforms.lti.keys._BITS", 2048)  # a longer one is looked for much longer
    old = tool.keys.signing
    token = Services(tool.platform.client, tool.keys)
    new = tool.keys.new()
    assert [one["kid"] for one in tool.keys.public["keys"]] == [old.kid, new.kid]
    assert tool.keys.signing.kid == new.kid
    queue(tool, 1)
    assert tool.send() == (1, 0)
    assert tool.visitor().browser.get("/lti/jwks").json() == tool.keys.public
    tool.keys.retire(old.kid[:12])
    assert [one["kid"] for one in tool.keys.public["keys"]] == [new.kid]
    assert token.token(PLATFORM, SCOPES)


def test_only_public_halves_are_published(tool):
    answer = tool.visitor().browser.get("/lti/jwks")
    assert all(set(one) == {"kty", "n", "e", "kid", "alg", "use"} for one in answer.json()["keys"])


def test_a_roster_that_leads_elsewhere_is_not_followed(tool):
    def answer(request):
        if request.url.path == "/token":
            return httpx.Response(200, json={"access_token": "t", "expires_in": 60})
        return httpx.Response(
            200, json={"members": []}, headers={"Link": '<https://evil.example.org/>; rel="next"'}
        )

    services = Services(httpx.Client(transport=httpx.MockTransport(answer)), tool.keys)
    with pytest.raises(NotServed, match="another server"):
        services.roster(PLATFORM, f"{SITE}/members")


@each_row(
    "elsewhere",
    [
        "http://169.254.169.254/latest",
        "http://127.0.0.1:5432/",
        "https://evil.example.org/x",
        "http://learn.example.org/",
    ],
)
def test_no_launch_says_where_the_server_sends_a_token_or_asks(elsewhere, tool):
    """Neither into the network behind it, nor in plain http."""
    asked = []

    def answer(request):
        asked.append(str(request.url))
        return httpx.Response(200, json={"access_token": "t", "expires_in": 60, "members": []})

    services = Services(httpx.Client(transport=httpx.MockTransport(answer)), tool.keys)
    with pytest.raises(NotServed, match="origins"):
        services.roster(PLATFORM, elsewhere)
    with pytest.raises(NotServed, match="origins"):
        services._request(PLATFORM, [], "POST", elsewhere, json={})
    assert not asked
    assert services.roster(PLATFORM, "https://frames.example.org/members") == [], (
        "an origin that the settings name"
    )
