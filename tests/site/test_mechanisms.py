"""A mechanism that staff write or draw on the site: from nothing to a marked exercise, and what an attacker
may try with it."""

import html
import re
import tempfile
import tomllib
from contextlib import contextmanager
from pathlib import Path

import pytest
from site_own_course import OwnCourse
from site_people import TEACHER, ZOE
from tables import each_row

from coursework import open_course
from coursework.authoring.linkage_editing import questions
from coursework.authoring.linkage_files import LINKAGES, mechanism_alone
from coursework.database.assignments import put_issued
from coursework.language.words import words
from coursework.site.mechanisms.mechanism_view import CheckedBoxes, mechanism_view

pytestmark = pytest.mark.e2e

TEXT = words("en", "site")["mechanisms"]["start"]


@pytest.fixture
def own(tmp_path):
    return OwnCourse(tmp_path)


def sent(browser, address="new", /, **form):
    return browser.fill(f"/mechanisms/{address}", {"text": TEXT, **form})


def test_from_nothing_to_a_marked_exercise(own):
    staff = own.browser(TEACHER)
    assert "theta2" in staff.get("/mechanisms/new").text
    assert sent(staff, do="save", name="mine").headers["location"] == "/mechanisms/mine?saved=1"
    assert (own.folder / "mine.toml").read_text("utf-8") == TEXT
    assert "My mechanism" in staff.get("/mechanisms").text
    sheet = own.browser(ZOE).get("/practice/mine").headers["location"]
    variant = own.site.variant("mine", int(sheet.rpartition("/")[2]), "en")
    right = f"{variant.solution()['theta3']:.6g}"
    leads_to = own.browser(ZOE).fill(sheet, {"a-theta3": right, "check": "theta3"}).headers["location"]
    checked = own.browser(ZOE).get(leads_to)
    assert words("en")["feedback"]["verdicts"]["correct"].casefold() in checked.text.casefold()


def test_a_changed_file_is_what_the_site_shows_next(own):
    staff = own.browser(TEACHER)
    sent(staff, do="save", name="mine")
    before = own.site.variant("mine", 5, "en").given["xC"]
    assert (
        sent(staff, "mine", do="save", name="mine", text=TEXT.replace('"200 mm"', '"210 mm"')).status_code
        == 303
    )
    assert (before, own.site.variant("mine", 5, "en").given["xC"]) == (200, 210)


NAMES = [
    "",
    "../evil",
    "..",
    "a/b",
    "course",
    "new",
    "Ünï",
    "a" * 61,
    "import",
    "mine.toml",
    "mine\n",
    "toggle",
    "MINE",
    "con.",
]


@each_row("name", [n for n in NAMES if n.strip() == n])
def test_a_name_leads_nowhere_else(name, tmp_path_factory):
    own = OwnCourse(tmp_path_factory.mktemp("own"))
    before = sorted(own.folder.parent.rglob("*"))
    reply = sent(own.browser(TEACHER), do="save", name=name)
    assert reply.status_code == 422
    assert sorted(own.folder.parent.rglob("*")) == before
    assert "toggle" in own.folder.joinpath("toggle.toml").read_text("utf-8").casefold()


@each_row(
    "path",
    [
        "/mechanisms/..%2f..%2fetc%2fpasswd",
        "/mechanisms/course",
        "/mechanisms/absent",
        "/mechanisms/new/../x",
    ],
)
def test_an_address_shows_no_other_file(path, tmp_path_factory):
    staff = OwnCourse(tmp_path_factory.mktemp("own")).browser(TEACHER)
    assert staff.get(path).status_code == 404


def test_what_is_wrong_is_not_saved_and_named_with_its_line(own):
    staff = own.browser(TEACHER)
    wrong = TEXT.replace('r3 = "175 mm"', 'r3 = "175 N"')
    reply = sent(staff, do="save", name="mine", text=wrong)
    assert (reply.status_code, (own.folder / "mine.toml").exists()) == (422, False)
    assert re.search(r"mine\.toml, line \d+: ", reply.text)
    assert wrong in html.unescape(reply.text)


def test_the_built_in_course_is_never_written(class_of_three):
    reply = sent(class_of_three.browser(TEACHER), do="save", name="mine")
    assert reply.status_code == 422
    assert not (class_of_three.site.course.folder.root / "exercises" / "mine.toml").exists()
    file = sent(class_of_three.browser(TEACHER), do="file", name="mine")
    assert (file.text, 'filename="mine.toml"' in file.headers["content-disposition"]) == (TEXT, True)


def test_what_students_have_in_an_assignment_is_not_changed(own):
    variant = own.site.course["toggle"].variant(3, "en")
    content = {
        "format": 1,
        "roster": False,
        "assignment": {"name": "a", "title": {"en": "A"}, "exercises": ["toggle"]},
        "students": {ZOE: {}},
        "issued": [{"student": ZOE, "record": variant.record}],
    }
    with own.site.store.begin() as connection:
        put_issued(connection, content)
    before = (own.folder / "toggle.toml").read_bytes()
    assert sent(own.browser(TEACHER), "toggle", do="save", name="toggle").status_code == 422
    assert (own.folder / "toggle.toml").read_bytes() == before


def test_a_script_in_a_file_is_text_on_its_page(own):
    text = TEXT.replace("My mechanism", "<script>alert(1)</script>")
    reply = sent(own.browser(TEACHER), text=text + "# </textarea><script>alert(2)</script>")
    assert "<script>alert" not in reply.text


def test_endless_work_is_stopped(own, own_process):
    many = "\n".join(f'q{k} = {{ from = "1 mm", to = "9 mm", step = "0.000001 mm" }}' for k in range(90))
    impossible = ", ".join(f'"q{k} * q{k + 1} < -1 mm * 1 mm"' for k in range(80))
    text = TEXT.replace("[given]", f"[given]\nrequire = [{impossible}]\n{many}")
    reply = sent(own.browser(TEACHER), text=text)
    assert (reply.status_code, 'class="fault"' in reply.text) == (200, True)


def test_staff_find_the_mechanism_from_its_exercise(own):
    staff, zoe = own.browser(TEACHER), own.browser(ZOE)
    sheet = staff.get("/practice/toggle").headers["location"]
    for address in (sheet, "/explore/toggle"):
        assert 'href="/mechanisms/toggle"' in staff.get(address).text
    assert "/mechanisms" not in zoe.get("/explore/toggle").text
    assert staff.get("/mechanisms/toggle").status_code == 200


# ----------------------------------------------------------------------- check boxes


@each_row("name", ["toggle", "slider_crank", "geared_five_bar", "scotch_yoke"])
def test_boxes_write_what_they_say(name, tmp_path_factory):
    text = (LINKAGES / "exercises" / f"{name}.toml").read_text("utf-8")
    asked = tomllib.loads(text)["ask"].get("positions", ["theta3"])[0]
    view = mechanism_view(text, name, "en", CheckedBoxes((), ("mobility mobility", f"positions {asked}")))
    assert view.fault == ""
    now = tomllib.loads(view.text)
    assert {k: v for k, v in now["ask"].items() if k != "torque"} == {"mobility": True, "positions": [asked]}
    assert {k: v for k, v in now.items() if k not in ("given", "ask")} == {
        k: v for k, v in tomllib.loads(text).items() if k not in ("given", "ask")
    }


#: What boxes do not say, in a file that asks more: weights, a load of a driven length, a coordinate, a table
#: behind the questions.
MORE = {
    "tipper": "xG",
    "piston_engine": "xA",
    "two_loops": "yE",
    "needle_bar": "xP",
}


@each_row("name, coordinate", list(MORE.items()))
def test_what_boxes_do_not_say_stays(name, coordinate):
    text = (LINKAGES / "exercises" / f"{name}.toml").read_text("utf-8")
    text = text.replace('positions = ["', f'positions = ["{coordinate}", "')
    text += (
        f"\n[ask.points]\n{coordinate} = 3\n# of a book\n[[known]]\ngiven = {{}}\ngives = {{ {coordinate} "
        f'= "1 mm" }}\n'
    )
    stated = tomllib.loads(text)
    first = stated["ask"]["positions"][1]
    view = mechanism_view(text, name, "en", CheckedBoxes((), (f"positions {first}", "polygon velocity")))
    now = tomllib.loads(view.text)
    assert now["ask"]["positions"] == [coordinate, first]
    assert now["ask"]["polygon"] == ["velocity"]
    kept = {k: v for k, v in stated["ask"].items() if k in ("thrust", "torque", "points")}
    assert {k: v for k, v in now["ask"].items() if k in ("thrust", "torque", "points")} == kept
    assert now["known"] == stated["known"]
    assert "# of a book\n[[known]]" in view.text


@pytest.mark.slow
def test_what_boxes_offer_makes_an_exercise():
    """Of every sort of driver, slide and wheel: each polygon, equation, centre and rate that a box offers has
    variants and answers."""
    faults = {}
    for name in (
        "needle_bar",
        "digger_arm",
        "planet_wheel",
        "geared_five_bar",
        "slotted_ram",
        "crossed_slides",
    ):
        text = (LINKAGES / "exercises" / f"{name}.toml").read_text("utf-8")
        with own_file(text, name) as made:
            boxes = [f"{key} {box.name}" for key, able in questions(made).items() for box in able]
        drawn = [box for box in boxes if box.startswith("polygon")]
        for chosen in filter(None, (drawn, [box for box in boxes if box not in drawn])):
            if fault := mechanism_view(text, name, "en", CheckedBoxes((), tuple(chosen))).fault:
                faults[name, chosen[0]] = fault
    assert faults == {}


@contextmanager
def own_file(text, name):
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / f"{name}.toml"
        path.write_text(text, "utf-8")
        with mechanism_alone(path, open_course) as (_, made):
            yield made


def test_a_drawing_says_what_is_wrong_without_its_file_first():
    drawn = "# drawing: {}\n" + TEXT.partition("\n")[2].replace(
        '4 = { at = "C", points = { B = "r4" } }\n', ""
    )
    view = mechanism_view(drawn, "mine", "fr")
    assert (
        view.problem
        == "la pièce 3 ne tient qu’en A ; il faut un second point commun ou une glissière pour la tenir"
    )
    assert re.fullmatch(r"mine\.toml, ligne \d+", view.place)
    assert mechanism_view("# drawing: {}\ntitle = 'x'\n", "mine", "fr").problem.startswith(
        "Rien n’est encore dessiné"
    )


def test_titles_are_written_as_text():
    titles = (("fr", 'Bielle "courte" # \\'), ("en", "Short rod"))
    view = mechanism_view(TEXT, "mine", "en", CheckedBoxes((), ("positions theta3",), titles))
    assert (view.fault, tomllib.loads(view.text)["title"]) == ("", dict(titles))
    intruding = (("en", "{{ 7 * 7 }}"),)
    assert "49" not in mechanism_view(TEXT, "mine", "en", CheckedBoxes((), (), intruding)).fault


def test_a_length_varies_around_its_value_and_back():
    view = mechanism_view(TEXT, "mine", "en", CheckedBoxes(("r3",), ("positions theta3",)))
    assert tomllib.loads(view.text)["given"]["r3"] == {"from": "140 mm", "to": "210 mm", "step": "5 mm"}
    again = mechanism_view(view.text, "mine", "en", CheckedBoxes((), ("positions theta3",)))
    assert tomllib.loads(again.text)["given"]["r3"] == "175 mm"
