"""Groups of a class: pages, statistics and exports of one group, and what an assistant of a group sees and
does."""

import csv
import html
import io
import re
from urllib.parse import urljoin

import pytest
from site_people import MAX, TEACHER, ZOE, Class
from site_walk import Filled, text_of
from sqlalchemy import select, update

from coursework.database.areas import areas_of, put_areas
from coursework.database.people import put_account, put_person
from coursework.database.permissions import Area
from coursework.database.tables import account, person
from coursework.issuing.issued import Issued

CARA = "Cara"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    made = Filled(f"sqlite:///{tmp_path_factory.mktemp('groups')}/site.db")
    with made.site.store.begin() as connection:
        for name, group in ((ZOE, "TD  1"), (MAX, "td 2")):
            told = {"number": name, "groupe": group}
            connection.execute(update(person).where(person.c.id == made.ids[name]).values(columns=told))
        made.ids[CARA] = put_person(connection, identifier=CARA, name=CARA, lang="", columns={})
        put_account(connection, made.ids[CARA], login="cara@example.org", role="assistant")
        put_areas(connection, made.ids[CARA], [Area(None, "td 1")])
    return made


@pytest.mark.slow
def test_class_questions_and_files_are_of_the_group_that_is_chosen(site):
    """An instructor chooses; an assistant sees what is theirs, chosen or not."""
    wrong = []
    for name, group, shown in (
        (TEACHER, "", {ZOE, MAX}),
        (TEACHER, "TD 1", {ZOE}),
        (TEACHER, "td 2", {MAX}),
        (TEACHER, "td 9", set()),
        (CARA, "", {ZOE}),
        (CARA, "td 1", {ZOE}),
        (CARA, "td 2", set()),
    ):
        browser = site.browser(name)
        for end in (
            "",
            "/files/marks.csv",
            "/files/summary.csv",
            "/files/answers.csv",
            "/files/archive.zip",
            "/question",
        ):
            query = {"class_group": group, "exercise": "slotted_mechanism", "part": "rA"}
            reply = browser.get(f"/desk/{site.number}{end}", params=query)
            text = re.sub(r"of[ -]Max", "", text_of(reply))
            found = {student for student in (ZOE, MAX) if re.search(rf"(?<!\w){student}(?!\w)", text)}
            if reply.status_code != 200 or (found != shown and (end != "/question" or not found <= shown)):
                wrong.append((name, group, end, reply.status_code, found))
    assert not wrong


@pytest.mark.parametrize("name", [CARA, "Ivy"])
def test_no_link_of_the_desk_leads_where_its_reader_may_not_go(site, name):
    """To an assistant of a group, and to one of the whole assignment."""
    if name not in site.ids:
        with site.site.store.begin() as connection:
            site.ids[name] = put_person(connection, identifier=name, name=name, lang="", columns={})
            put_account(connection, site.ids[name], login=f"{name}@example.org", role="assistant")
            put_areas(connection, site.ids[name], [Area(site.number, None)])
    browser, seen, waiting, refused = site.browser(name), set(), ["/desk"], []
    while waiting:
        address = html.unescape(waiting.pop())
        page = re.sub(r"(?<=[?&])(?:sort|at|why|verdict)=[^&#]*&?", "", address.partition("#")[0]).rstrip(
            "?&"
        )
        if page in seen or not page.startswith("/desk"):
            continue
        seen.add(page)
        reply = browser.get(page)
        if reply.status_code in (403, 404):
            refused.append(page)
        elif "text/html" in reply.headers.get("content-type", ""):
            waiting += [urljoin(page, link) for link in re.findall(r'href="([^"]+)"', reply.text)]
    assert len(seen) > 8
    assert not refused
    assert (f"/desk/{site.number}/scans" in seen) == (name == "Ivy")


def test_statistics_of_a_group_count_its_students_alone(site):
    browser = site.browser(TEACHER)
    counts = []
    for group in ("", "td 1"):
        page = browser.get(f"/desk/{site.number}/questions", params={"class_group": group}).text
        counts.append(re.search(r'<td class="points">(\d+)</td>', page)[1])
    assert counts == ["2", "1"]
    assert 'value="td 2"' in page
    assert 'value="td 2"' not in site.browser(CARA).get(f"/desk/{site.number}/questions").text


def test_the_desk_of_an_assistant_lists_what_has_students_of_theirs(site):
    page = site.browser(CARA).get("/desk").text
    assert f'href="/desk/{site.number}"' in page
    assert f'href="/desk/{site.of_max}"' not in page


@pytest.mark.slow
def test_a_summary_of_a_group_has_the_lines_of_the_whole(site):
    def lines(group):
        reply = site.browser(TEACHER).get(
            f"/desk/{site.number}/files/summary.csv", params={"class_group": group}
        )
        return list(csv.DictReader(io.StringIO(reply.text.lstrip("\ufeff"))))

    whole = [row for row in lines("") if row["student"] == ZOE]
    assert lines("td 1") == whole


def test_an_assistant_of_a_group_decides_on_it_and_on_no_other(site):
    browser = site.browser(CARA)
    for name, status in ((ZOE, 200), (MAX, 404)):
        seed = site.variants[name].record["seed"]
        form = {
            "name": name,
            "exercise": "slotted_mechanism",
            "seed": str(seed),
            "part": "rA",
            "sitting": "1",
            "do": "accept",
        }
        assert browser.fill(f"/desk/{site.number}/student", form).status_code == status
    assert browser.get(f"/desk/{site.number}/scans").status_code == 404


@pytest.mark.slow
def test_an_invitation_of_an_assistant_states_their_groups(tmp_path):
    one = Class(f"sqlite:///{tmp_path}/site.db")
    with one.site.store.begin() as connection:
        told = {"groupe": "TD 1"}
        connection.execute(update(person).where(person.c.id == one.ids[ZOE]).values(columns=told))
    staff = one.browser(TEACHER)
    form = {
        "name": "Cara",
        "login": "cara@example.org",
        "role": "assistant",
        "assignment": "*",
        "group": "td 1",
    }
    assert staff.fill("/desk/people/add-staff", form).status_code == 200
    assert (
        staff.fill(
            "/desk/people/add-staff",
            {**form, "name": "Ivy", "login": "ivy@example.org", "role": "instructor"},
        ).status_code
        == 200
    )
    with one.site.store.reading() as connection:
        ids = {row.login: row.person_id for row in connection.execute(select(account))}
        found = [areas_of(connection, ids[f"{name}@example.org"]) for name in ("cara", "ivy")]
    assert found == [(Area(None, "td 1"),), ()]


def test_a_record_among_some_students_knows_nobody_else():
    content = {
        "format": 1,
        "roster": True,
        "students": {"Ann": {"number": "1"}, "Bo": {"number": "2"}},
        "issued": [
            {
                "student": name,
                "record": {
                    "exercise": "x",
                    "seed": seed,
                    "version": 1,
                    "parts": [{"id": "a", "points": 1}],
                    "given": {},
                },
            }
            for name, seed in (("Ann", 1), ("Bo", 2))
        ],
    }
    part = Issued(content, "test").among({"Ann"})
    assert (part.students, part.student("Bo"), part.student("?", [("", "2")]), part.student("ann")) == (
        ("Ann",),
        None,
        None,
        "Ann",
    )
    assert part.owners == {("x", 1): ("Ann",)}
