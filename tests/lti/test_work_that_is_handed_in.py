"""A student's own variant, answers, feedback and points; a teacher's class; what platforms are told."""

import csv
import io
import json
import shutil

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
    Tool,
    field,
    seal,
)

from coursework.cli import run
from coursework.issuing.assignment import Assignment
from coursework.issuing.roster import read_roster
from coursework.issuing.variant_assignment import keyed
from coursework.language.words import words
from coursework.lti.launch import launch_of
from coursework.lti.sending import wait_after
from coursework.lti.services import Services
from coursework.lti.storage import Score

SAID = words("en")["lti"]
NAME = "slotted_mechanism"


def drawn(html, name=NAME):
    """The seed on a page."""
    return int(html.split(f"{name} · ")[1].split(" ")[0])


def variant_on(tool, html, name=NAME, assignment=""):
    """The variant of a page, which its code draws with the secret of the service alone."""
    asked = Assignment(assignment or name, ())
    return tool.course[name].variant(drawn(html, name), secret=keyed(tool.storage.secret(), asked))


def right_answers(tool, html, wrong=(), name=NAME, assignment=""):
    """What a student writes who is right, but for some parts."""
    variant = variant_on(tool, html, name, assignment)
    return {part.id: written(variant, part, part.id in wrong) for part in variant.parts}


def written(variant, part, wrong=False):
    value = variant.solution()[part.quantity]
    if part.choices:
        letters = variant.letters(part)
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
    again, _ = tool.visitor().enter()
    other, _ = tool.visitor().enter(sub="bob", name="Bob")
    elsewhere, _ = tool.visitor().enter(resource_link={"id": "link-2"})
    assert drawn(first.text) == drawn(again.text)
    assert len({drawn(page.text) for page in (first, other, elsewhere)}) == 3


def test_a_code_is_a_function_of_secret_issuer_link_and_person(tool, tmp_path, course):
    first, _ = tool.visitor().enter()
    moved = Tool(tmp_path / "other", course)
    shutil.copy(tool.storage.path, moved.storage.path)
    with moved.storage._writing() as file:
        file.execute("DELETE FROM papers")
    fresh, _ = moved.visitor().enter(name="Renamed", context={"id": "moved"})
    assert drawn(first.text) == drawn(fresh.text)
    strange, _ = Tool(tmp_path / "strange", course).visitor().enter()
    assert drawn(first.text) != drawn(strange.text)


def test_no_two_students_of_a_link_have_the_same_variant(tool):
    pages = [tool.visitor().enter(sub=f"s{k}", name=f"S{k}")[0].text for k in range(12)]
    records = [variant_on(tool, page).given for page in pages]
    assert len({tuple(one.values()) for one in records}) == 12


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
    assert tool.sender.send_due() == (1, 0)
    (score,) = tool.platform.scores
    assert (score["userId"], score["scoreGiven"], score["scoreMaximum"]) == ("ada", 9, 9)
    assert (score["activityProgress"], score["gradingProgress"]) == ("Completed", "FullyGraded")
    assert score["line"] == f"{SITE}/lines/9/scores?of=7"
    assert score["comment"].startswith("9 of 9 points (try 1). 1: right;")


def test_marks_are_those_of_the_package(tool, visitor):
    page, path = visitor.enter()
    answers = right_answers(tool, page.text) | {"theta4": "1", "omega4": "2 kg", "rA": "0,1 m"}
    visitor.hand_in(path, page, answers)
    marking = variant_on(tool, page.text).in_language("en").grade(answers)
    (made,) = tool.storage.tries(place(NAME))
    assert (made.points, made.out_of) == (marking.points, marking.out_of)
    told = visitor.browser.get(path).text
    assert words("en")["feedback"]["verdicts"]["wrong_unit"] in told


def place(name, link="link-1"):
    return f"{json.dumps([SITE, CLIENT, DEPLOYMENT, link])} exercise:{name}"


def test_a_form_that_is_sent_twice_counts_once(tool, visitor):
    page, path = visitor.enter()
    answers = right_answers(tool, page.text, wrong=["rA"])
    for _ in range(3):
        assert visitor.hand_in(path, page, answers).status_code == 303
    assert len(tool.storage.tries(place(NAME))) == 1
    assert tool.sender.send_due() == (1, 0)
    assert tool.sender.send_due() == (0, 0)


def test_what_cannot_be_read_uses_no_try(tool, visitor):
    page, path = visitor.enter(custom={"exercise": NAME, "tries": "1"})
    answers = right_answers(tool, page.text) | {"rA": "hello?", "theta4": 'x" onfocus="<b>'}
    back = visitor.hand_in(path, page, answers)
    assert back.status_code == 422
    assert SAID["unread"] in back.text
    assert 'value="hello?"' in back.text
    assert "<b>" not in back.text.split("<main>")[1].replace("<b>9</b>", "")
    assert not tool.storage.tries(place(NAME))
    verdicts = words("en")["feedback"]["verdicts"]
    assert f">{verdicts['correct']}<" not in back.text  # and tells nothing of the others
    done = visitor.hand_in(path, back, right_answers(tool, page.text))
    assert done.status_code == 303
    assert tool.storage.tries(place(NAME))[0].points == 9


def test_what_cannot_be_read_may_be_handed_in_for_a_person_to_look_at(tool, visitor):
    page, path = visitor.enter()
    done = visitor.hand_in(path, page, {"rA": "hello?"}, _as_it_is="1")
    assert done.status_code == 303
    tool.sender.send_due()
    assert tool.platform.scores[0]["gradingProgress"] == "PendingManual"


def test_an_empty_sheet_is_no_try(tool, visitor):
    page, path = visitor.enter()
    assert SAID["empty"] in visitor.hand_in(path, page, {"rA": "  "}).text
    assert not tool.storage.tries(place(NAME))


def test_a_field_that_is_no_box_is_refused(tool, visitor):
    page, path = visitor.enter()
    assert visitor.hand_in(path, page, {"points": "9"}).status_code == 400
    assert visitor.hand_in(path, page, {"rA": "1"}, _number="7" * 9).status_code == 400


def test_tries_are_limited_where_the_link_says_so(tool, visitor):
    custom = {"exercise": NAME, "tries": "2", "counts": "last", "answers": "after"}
    page, path = works(visitor, tool, custom=custom)
    assert SAID["again"] in page.text
    sheet = visitor.browser.get(f"{path}?again=1")
    assert SAID["tries_left"]["one"].format(1) in sheet.text
    assert words("en")["feedback"]["right"] not in page.text
    visitor.hand_in(path, sheet, right_answers(tool, sheet.text, wrong=["rA", "swing"]))
    last = visitor.browser.get(f"{path}?again=1")
    assert SAID["no_try_left"] in last.text
    assert words("en")["feedback"]["right"] in last.text
    more = visitor.browser.post(path, data={"_seal": field(sheet.text, "_seal"), "_number": "3", "rA": "1"})
    assert more.status_code == 409
    tool.sender.send_due()
    assert len(tool.platform.scores) == 1  # the first had not gone yet, and is no longer what counts
    assert tool.platform.scores[0]["scoreGiven"] < 9


def test_the_best_try_counts_unless_told(tool, visitor):
    _, path = works(visitor, tool)
    tool.sender.send_due()
    sheet = visitor.browser.get(f"{path}?again=1")
    visitor.hand_in(path, sheet, right_answers(tool, sheet.text, wrong=["rA"]))
    tool.sender.send_due()
    assert [one["scoreGiven"] for one in tool.platform.scores] == [9]


def test_what_an_older_try_held_stands_in_the_boxes_again(tool, visitor):
    _, path = works(visitor, tool, wrong=["rA"])
    sheet = visitor.browser.get(f"{path}?again=1")
    assert all(
        f'value="{text}"' in sheet.text for text in right_answers(tool, sheet.text, wrong=["rA"]).values()
    )


# ------------------------------------------------------------------------- scores


@pytest.mark.e2e
@pytest.mark.parametrize("down", [-1, 500, 503, 429, 403])
def test_a_score_waits_while_the_platform_does_not_take_it(tool, visitor, down):
    page, path = visitor.enter()
    tool.platform.down = down
    visitor.hand_in(path, page, right_answers(tool, page.text))
    assert tool.sender.send_due() == (0, 1)
    assert tool.sender.send_due() == (0, 0)  # not at once again
    assert SAID["score_waits"] in visitor.browser.get(path).text.replace("’", "'")
    tool.platform.down, tool.ahead = 0, 3700.0
    tool.app = tool.made()  # a restart loses nothing
    assert tool.sender.send_due() == (1, 0)
    assert tool.platform.scores[0]["scoreGiven"] == 9


def test_each_failure_puts_the_next_attempt_off_for_longer(tool, monkeypatch):
    monkeypatch.setattr(tool.storage, "_clock", lambda: 1000.0 + tool.ahead)
    tool.storage.put_score(launched(tool.platform), Score(1, 9))
    tool.platform.down, delays = 503, []
    for _ in range(4):
        assert tool.sender.send_due() == (0, 1)
        (waiting,) = tool.storage.scores().values()
        delays.append(waiting.due - tool.storage._clock())
        tool.ahead += 3700
    assert (delays, waiting.failures) == ([5, 10, 20, 40], 4)


def test_waits_grow_to_an_hour():
    assert [wait_after(n) for n in (0, 1, 2, 3)] == [5, 10, 20, 40]
    assert wait_after(50) == wait_after(10**6) == 3600
    assert wait_after(0, 404) == 900


def launched(platform, **changed):
    claims = platform.claims("n", **changed)
    return launch_of({**claims, "client_id": CLIENT})


def test_stamps_grow_even_where_the_clock_stands_or_goes_back(tool):
    launch = launched(tool.platform)
    stamps = []
    for points, ahead in ((1, 0.0), (2, 0.0), (3, -3600.0), (4, -3600.0)):
        tool.ahead = ahead
        assert tool.storage.put_score(launch, Score(points, 9))
        assert not tool.storage.put_score(launch, Score(points, 9))
        stamps.append(next(iter(tool.storage.scores().values())).stamp)
    assert stamps == sorted(set(stamps))


def test_a_score_that_changes_while_one_is_on_its_way_is_sent_too(tool):
    launch = launched(tool.platform)
    tool.storage.put_score(launch, Score(1, 9))
    ((_, sent),) = tool.storage.due()
    tool.storage.put_score(launch, Score(2, 9))
    tool.storage.arrived(sent)
    ((_, waiting),) = tool.storage.due()
    assert waiting.score.given == 2


def test_a_platform_that_has_a_later_score_is_told_again(tool):
    launch = launched(tool.platform)
    tool.platform.scores.append({"userId": "ada", "timestamp": "2999-01-01T00:00:00.000Z"})
    tool.storage.put_score(launch, Score(2, 9))
    assert tool.sender.send_due() == (0, 1)
    tool.platform.scores.clear()
    tool.ahead = 10.0
    assert tool.sender.send_due() == (1, 0)


def test_a_token_that_is_no_longer_good_is_had_anew(tool):
    launch = launched(tool.platform)
    tool.storage.put_score(launch, Score(1, 9))
    assert tool.sender.send_due() == (1, 0)
    tool.platform.tokens.clear()
    tool.storage.put_score(launch, Score(2, 9))
    assert tool.sender.send_due() == (1, 0)
    assert tool.platform.asked_for("/token") == 2


def test_a_link_without_a_column_has_one_made_once(tool):
    for person in ("ada", "bob"):
        launch = launched(
            tool.platform,
            sub=person,
            **{f"{AGS}claim/endpoint": {"scope": SCOPES, "lineitems": f"{SITE}/lines"}},
        )
        tool.storage.put_score(launch, Score(1, 9))
    assert tool.sender.send_due() == (2, 0)
    assert [one["resourceLinkId"] for one in tool.platform.lines] == ["link-1"]
    assert {one["line"] for one in tool.platform.scores} == {f"{SITE}/lines/1/scores?of=7"}


def test_a_link_that_takes_no_points_sends_none(tool, visitor):
    page, _ = works(visitor, tool, **{f"{AGS}claim/endpoint": None})
    assert SAID["score_none"] in page.text
    assert not tool.storage.scores()


def test_a_score_that_was_never_queued_is_found_at_the_next_launch(tool, visitor):
    works(visitor, tool)
    with tool.storage._writing() as file:
        file.execute("DELETE FROM scores")
    tool.visitor().enter()
    assert tool.sender.send_due() == (1, 0)


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


def test_a_teacher_sees_who_has_what(tool):
    works(tool.visitor(), tool, wrong=["rA"])
    tool.visitor().enter(sub="zoe", name="Zoé <script>")
    tool.sender.send_due()
    tool.platform.members = MEMBERS
    page, _ = tool.visitor().enter(sub="emmy", name="Emmy Noether", roles=TEACHER)
    rows = [row for row in page.text.split("<tr>") if 'scope="row"' in row]
    names = [row.partition('scope="row">')[2].partition("</th>")[0].partition(" <span")[0] for row in rows]
    assert names == ["Ada Byron", "Bob Noyce", "Bob Noyce", "Zoé &lt;script&gt;"]
    assert f"{NAME} {tool.storage.papers(place(NAME))[0].records[0]['seed']}" in rows[0]
    assert SAID["class"]["arrived"] in rows[0]
    assert SAID["class"]["not_opened"] in rows[1]
    assert SAID["class"]["outside"] in rows[3]


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


def test_the_answers_of_a_class_are_graded_by_the_command_line(tool, tmp_path):
    works(tool.visitor(), tool, wrong=["rA"])
    works(tool.visitor(), tool, sub="bob", name="Bob")
    teacher = tool.visitor()
    _, path = teacher.enter(sub="emmy", roles=TEACHER)
    for name in ("answers.csv", "issued.json"):
        (tmp_path / name).write_bytes(teacher.browser.get(f"{path}/{name}").content)
    assert (
        run(
            [
                "grade",
                str(tmp_path / "answers.csv"),
                "--issued",
                str(tmp_path / "issued.json"),
                "--out",
                str(tmp_path / "marks"),
            ]
        )
        == 0
    )
    rows = list(csv.DictReader(io.StringIO((tmp_path / "marks/summary.csv").read_text("utf-8-sig"))))
    told = {one.person: one.points for one in tool.storage.tries(place(NAME))}
    assert {row["student"]: float(row["points"]) for row in rows} == {
        "Ada Byron": told["ada"],
        "Bob": told["bob"],
    }


def test_a_teacher_tries_the_sheet_and_no_points_are_sent(tool):
    teacher = tool.visitor()
    _, path = teacher.enter(sub="emmy", roles=TEACHER)
    sheet = teacher.browser.get(f"{path}/sheet")
    done = teacher.hand_in(f"{path}/sheet", sheet, right_answers(tool, sheet.text))
    assert done.status_code == 200
    assert SAID["preview"].split(".")[0] in done.text
    assert not tool.storage.scores()
    assert not tool.storage.tries(place(NAME))
    assert not tool.storage.papers(place(NAME))


@pytest.mark.parametrize("page", ["roster.csv", "answers.csv", "issued.json", "sheet", "elsewhere", "../x"])
def test_a_student_sees_nothing_of_the_class(tool, visitor, page):
    tool.platform.members = MEMBERS
    _, path = visitor.enter()
    assert visitor.browser.get(f"{path}/{page}").status_code in (403, 404)


@pytest.mark.parametrize("roles", [[], ["Mentor"], [f"{MEMBER}Observer"], ["urn:lti:role:ims/lis/Boss"]])
def test_who_is_neither_student_nor_teacher_sees_and_sends_nothing(tool, roles):
    visitor = tool.visitor()
    page, path = visitor.enter(roles=roles)
    assert page.status_code == 403
    assert visitor.browser.get(f"{path}/answers.csv").status_code == 403
    assert visitor.browser.post(path, data={"_seal": "x"}).status_code == 403


@pytest.mark.parametrize(
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


def picked(visitor, form, **settings):
    told = {
        "deep_link_return_url": f"{SITE}/return?a=1&b=2",
        "accept_types": ["ltiResourceLink"],
        "accept_multiple": True,
        "data": "as it came",
        **settings,
    }
    page, path = visitor.enter(
        sub="emmy",
        roles=TEACHER,
        message_type="LtiDeepLinkingRequest",
        resource_link=None,
        **{f"{DEEP}deep_linking_settings": told},
    )
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
    assert items[0]["url"] == f"{TOOL}/launch"


def test_a_picked_link_opens_what_was_picked(tool, visitor):
    (item,) = picked(visitor, {"offer": "exercise:grashof"})[f"{DEEP}content_items"]
    page, _ = tool.visitor().enter(custom=item["custom"])
    assert "grashof ·" in page.text
    worth = sum(part["points"] for part in tool.storage.papers(place("grashof"))[0].records[0]["parts"])
    assert item["lineItem"]["scoreMaximum"] == worth


def test_a_platform_that_takes_no_column_is_sent_none(visitor):
    (item,) = picked(visitor, {"offer": f"exercise:{NAME}"}, accept_lineitem=False)[f"{DEEP}content_items"]
    assert "lineItem" not in item


def test_leaving_without_a_link_goes_back_too(visitor):
    assert picked(visitor, {"cancel": "1"})[f"{DEEP}content_items"] == []


def test_exercises_are_found_in_both_languages(tool, visitor):
    told = {"deep_link_return_url": f"{SITE}/return", "accept_types": ["ltiResourceLink"]}
    page, path = visitor.enter(
        roles=TEACHER,
        message_type="LtiDeepLinkingRequest",
        resource_link=None,
        **{f"{DEEP}deep_linking_settings": told},
    )
    offered = page.text.count('name="offer"')
    assert offered == len(tool.course.names)
    for sought in ("coulisse", "SLOTTED  mechanism", "slotted_mechanism"):
        found = visitor.browser.get(path, params={"q": sought}).text
        assert f'value="exercise:{NAME}"' in found
        assert 0 < found.count('name="offer"') < offered
    none = visitor.browser.get(path, params={"q": "<script>zz"}).text
    assert "&lt;script&gt;zz" in none
    assert "<script>" not in none


# ---------------------------------------------------------------------- assignments

STATED = """
title = {{ fr = "Devoir 3", en = "Week 3" }}
versions = {versions}
[[exercises]]
name = "slotted_mechanism"
parts = ["rA", "theta4"]
points = 6
[[exercises]]
name = "grashof"
[marking]
follow_through = 0.5
"""


def assigned(tmp_path, course, versions='"each"'):
    file = tmp_path / "week3.toml"
    file.write_text(STATED.format(versions=versions), "utf-8")
    return Tool(tmp_path / "lti", course, [file])


def test_an_assignment_is_one_paper_of_all_its_exercises(tmp_path, course):
    tool = assigned(tmp_path, course)
    visitor = tool.visitor()
    page, path = visitor.enter(custom={"assignment": "week3"})
    assert "Week 3" in page.text
    assert 'name="e1-rA"' in page.text
    first = right_answers(tool, page.text, assignment="week3")
    grashof = variant_on(tool, page.text, "grashof", "week3")
    answers = {"e1-rA": first["rA"], "e1-theta4": first["theta4"]}
    for part in grashof.parts:
        answers[f"e2-{part.id}"] = written(grashof, part)
    assert visitor.hand_in(path, page, answers).status_code == 303
    told = visitor.browser.get(path).text
    total = 6 + sum(part.points for part in grashof.parts)
    assert f"<b>{total:g}</b> / {total:g} points" in told.replace("\u00a0", " ")
    again = visitor.browser.get(f"{path}?again=1").text
    assert "checked" in again


@pytest.mark.parametrize(("versions", "most"), [("1", 1), ("2", 2)])
def test_versions_are_dealt_out_in_links_too(tmp_path, course, versions, most):
    tool = assigned(tmp_path, course, versions)
    seeds = {
        drawn(tool.visitor().enter(sub=f"s{k}", custom={"assignment": "week3"})[0].text) for k in range(8)
    }
    assert len(seeds) == most


def test_an_assignment_is_among_what_may_be_picked(tmp_path, course):
    tool = assigned(tmp_path, course)
    (item,) = picked(tool.visitor(), {"offer": "assignment:week3"})[f"{DEEP}content_items"]
    assert item["custom"] == {"assignment": "week3"}
    assert item["title"] == "Week 3"


# ------------------------------------------------------------------ keys and erasing


def test_an_old_key_serves_until_it_is_retired(tool):
    old = tool.keys.signing
    token = Services(tool.platform.client, tool.keys)
    new = tool.keys.new()
    assert [one["kid"] for one in tool.keys.public["keys"]] == [old.kid, new.kid]
    assert tool.keys.signing.kid == new.kid
    launch = launched(tool.platform)
    tool.storage.put_score(launch, Score(1, 9))
    assert tool.sender.send_due() == (1, 0)
    assert tool.visitor().browser.get("/jwks").json() == tool.keys.public
    tool.keys.retire(old.kid[:12])
    assert [one["kid"] for one in tool.keys.public["keys"]] == [new.kid]
    assert token.token(PLATFORM, SCOPES)


def test_only_public_halves_are_published(tool):
    answer = tool.visitor().browser.get("/jwks")
    assert all(set(one) == {"kty", "n", "e", "kid", "alg", "use"} for one in answer.json()["keys"])


def test_a_roster_that_leads_elsewhere_is_not_followed(tool):
    from coursework.lti.services import NotServed

    def answer(request):
        if request.url.path == "/token":
            return httpx.Response(200, json={"access_token": "t", "expires_in": 60})
        return httpx.Response(
            200, json={"members": []}, headers={"Link": '<https://evil.example.org/>; rel="next"'}
        )

    services = Services(httpx.Client(transport=httpx.MockTransport(answer)), tool.keys)
    with pytest.raises(NotServed, match="elsewhere"):
        services.roster(PLATFORM, f"{SITE}/members")


@pytest.mark.parametrize(
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
    from coursework.lti.services import NotServed

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


def test_a_person_is_forgotten_whole(tool, visitor):
    _page, path = works(visitor, tool)
    works(tool.visitor(), tool, sub="bob", name="Bob")
    assert tool.storage.forget("ada") == 5
    assert visitor.browser.get(path).status_code == 403
    assert [one.person for one in tool.storage.papers(place(NAME))] == ["bob"]
    data = b"".join(file.read_bytes() for file in tool.storage.path.parent.glob("lti.sqlite*"))
    assert b"Bob" in data
