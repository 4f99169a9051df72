"""An exercise under work: its page follows each save, tells what does not hold as the commands do, and keeps
what worked last."""

import httpx
import pytest
from site_server import Served, until
from starlette.testclient import TestClient

from coursework.authoring.scaffold import new_course, new_exercise
from coursework.cli import run
from coursework.site.preview.preview_page import preview
from coursework.site.preview.under_work import EditedExercise

pytestmark = pytest.mark.e2e

NAME = "my_crank"


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("preview") / "mine"
    new_course(folder, ("fr", "en"))
    new_exercise(folder, NAME, ("fr", "en"))
    return folder


@pytest.fixture(scope="module")
def client(written):
    work = EditedExercise(str(written), NAME, variants=3)
    with TestClient(preview(work, "en"), base_url="http://127.0.0.1:8000") as client:
        yield client
    work.end()


@pytest.fixture
def at_work(client, written):
    """The page's client; files are given back as they were."""
    before = {path: path.read_text("utf-8") for path in written.rglob(f"{NAME}.*") if path.suffix != ".pyc"}
    yield client
    for path, text in before.items():
        if path.read_text("utf-8") != text:
            saved(client, path, lambda _, text=text: text)


def saved(client, path, change):
    """Save a file, and wait for the state that it makes."""
    before = client.get("/state").json()["stamp"].split(".")[0]
    path.write_text(change(path.read_text("utf-8")), "utf-8")
    until(lambda: client.get("/state").json()["stamp"].split(".")[0] != before)


def test_a_new_exercise_is_shown_at_once_in_every_view(at_work):
    assert 'src="/view/sheet?seed=0&amp;lang=en' in at_work.get("/").text
    sheet = at_work.get("/view/sheet?seed=4&lang=fr").text
    assert 'lang="fr"' in sheet
    assert at_work.get("/view/sheet?seed=5&lang=fr").text != sheet
    assert at_work.get("/view/pdf").content.startswith(b"%PDF")
    assert at_work.get("/view/solution").text != at_work.get("/view/sheet").text
    assert at_work.get("/view/solution_pdf").content.startswith(b"%PDF")
    assert "sine_and_cosine_exchanged" in at_work.get("/?view=key").text
    until(lambda: at_work.get("/state").json()["stamp"].endswith(".1"))
    assert "All checks passed." in at_work.get("/?view=check").text
    assert "Toutes les vérifications" in at_work.get("/?view=check&lang=fr").text


def test_the_page_follows_each_save_even_within_a_second_and_of_the_same_size(at_work, written):
    path = written / "exercises" / f"{NAME}.en.md.j2"
    for word in ("Alpha", "Bravo", "Gamma"):
        saved(
            at_work, path, lambda text, word=word: f"{text.partition('Word')[0].rstrip()}\n\nWord {word}.\n"
        )
        assert f"Word {word}." in at_work.get("/view/sheet?lang=en").text
    code = written / "solutions" / f"{NAME}.py"
    first = at_work.get("/?view=key").text
    saved(at_work, code, lambda text: text.replace("cos(", "sin(", 1))
    assert at_work.get("/?view=key").text != first


@pytest.mark.parametrize(
    ("file", "change", "says"),
    [
        ("exercises/{}.py", lambda text: text + "\ndef (:\n", "line"),
        ("solutions/{}.py", lambda text: "import no_such_library\n" + text, "no_such_library"),
        ("exercises/{}.en.md.j2", lambda text: "{{ no_such_value }}" + text, "no_such_value"),
    ],
)
def test_what_does_not_hold_is_told_beside_the_last_page_that_worked(at_work, written, file, change, says):
    good = {view: at_work.get(f"/view/{view}?lang=en").content for view in ("sheet", "solution")}
    view = "solution" if file.startswith("solutions") else "sheet"
    saved(at_work, written / file.format(NAME), change)
    page = at_work.get(f"/?view={view}&lang=en").text
    assert 'role="alert"' in page
    assert says in page
    assert "as it last worked" in page
    assert "Traceback" not in page
    assert at_work.get(f"/view/{view}?lang=en").content == good[view]
    until(lambda: at_work.get("/state").json()["stamp"].endswith(".1"))
    told = at_work.get("/?view=check&lang=en").text
    assert "All checks passed." not in told
    assert "✗" in told


def test_another_name_of_this_machine_leads_nowhere(at_work):
    for path in ("/", "/state", "/view/solution", "/static/site.css"):
        assert at_work.get(path, headers={"host": "evil.example"}).status_code == 421


@pytest.mark.parametrize("query", ["seed=-1", "seed=x", "seed=" + "9" * 30, "lang=xx", "view=../x", "seed=²"])
def test_an_address_that_makes_no_sense_is_the_usual_one(at_work, query):
    assert at_work.get(f"/?{query}").status_code == 200


def test_the_command_says_where_and_ends_cleanly(written):
    with Served(written.parent, "--course", written, "preview", NAME) as served:
        assert served.url.startswith("http://127.0.0.1:")
        assert httpx.get(served.url, follow_redirects=True, timeout=30).status_code == 200
        assert served.end() == 0


def test_an_exercise_that_is_not_there_is_told_with_the_nearest(written, capsys):
    assert run(["--course", str(written), "preview", "my_crnk"]) == 2
    assert f"did you mean '{NAME}'" in capsys.readouterr().err
