"""Items in the real programs that play QTI: every exercise loads, right answers have full marks, and every
other answer is marked as we mark it, or differs under a feature that ``lost.csv`` lists.

Each runs where an environment variable names what it needs:

``COURSEWORK_QTI_SDK``
    The ``src`` folder of the qti-sdk (oat-sa/qti-sdk), for QTI 2.1; with ``php`` on the path, its extensions
    dom and mbstring. Its folder ``qtism/data/storage/xml/schemes`` holds the schemas of QTI 2.1 and 3.0.
``COURSEWORK_QTI_PLAYERS``
    The ``node_modules`` where ``npm install @citolab/qti-components qti3-item-player vue@2`` was run, for QTI
    3; with ``playwright`` for Python, and Chromium by ``COURSEWORK_CHROMIUM`` (``/usr/bin/chromium`` unless
    told).
``COURSEWORK_QTI_EXERCISES``
    Names of exercises, parted by commas; all unless told.
"""

from __future__ import annotations

import collections
import functools
import http.server
import json
import os
import re
import shutil
import subprocess
import threading
import zipfile
from pathlib import Path

import pytest
from qti_answers import items_of, judged, lost_of, recorded, sheets
from qti_evaluator import Player

import coursework
from coursework.platforms._qti_item import identifier_of
from coursework.platforms.platform import platform_of
from coursework.platforms.pools import of_exercises

COURSE = coursework.open_course()
HERE = Path(__file__).parent
SDK = os.environ.get("COURSEWORK_QTI_SDK", "")
PLAYERS = os.environ.get("COURSEWORK_QTI_PLAYERS", "")
CHROMIUM = os.environ.get("COURSEWORK_CHROMIUM", "/usr/bin/chromium")
NAMES = [n for n in os.environ.get("COURSEWORK_QTI_EXERCISES", "").split(",") if n] or COURSE.names

needs_sdk = pytest.mark.skipif(not SDK, reason="COURSEWORK_QTI_SDK names no qti-sdk")
needs_players = pytest.mark.skipif(not PLAYERS, reason="COURSEWORK_QTI_PLAYERS names no node_modules")
every_exercise = pytest.mark.parametrize("name", NAMES)

#: What the schemas of the sdk lack or mistake: a namespace of formulas, a schema of speech that libxml2
#: cannot read, one that is on the network.
_XLINK = "".join(
    f'<xs:attribute name="{name}"/>'
    for name in "href type role arcrole title show actuate label from to".split()
)


@functools.cache
def pool_of(name):
    return of_exercises(COURSE, [name], 1, 0, ["en"], None)


@pytest.fixture(scope="session")
def package(tmp_path_factory):
    """The unpacked package of an exercise on a platform."""

    @functools.cache
    def unpacked(name, platform):
        folder = tmp_path_factory.mktemp(f"{name}-{platform}")
        chosen = platform_of(platform)
        (file,) = chosen.files(pool_of(name).pool("en", chosen))
        whole = folder / "package.zip"
        whole.write_bytes(file.make())
        with zipfile.ZipFile(whole) as archive:
            archive.extractall(folder / "package")
        return folder / "package"

    return unpacked


def told(found):
    """Fail on what no feature explains; the count of the rest."""
    counted = collections.Counter(one.under for one in found)
    assert not counted[""], [one for one in found if not one.under][:5]
    return counted


def checked(name, play):
    """Every variant of the pool played with sheets of answers; ``play`` gives the outcomes of some sheets."""
    count, lost = collections.Counter(), lost_of(pool_of(name))
    for variant, given in items_of(pool_of(name), "en"):
        some = sheets(variant, given)
        outcomes = play(given, [sheet for sheet, _ in some])
        count += told(list(judged(lost, variant, given, [row for _, row in some], outcomes)))
    print(f"{name}: {sum(count.values())} answers, {dict(count)}")
    return count


# ------------------------------------------------------------------------- qti-sdk


def php(script, *arguments, asked=None):
    made = subprocess.run(
        ["php", "-d", "memory_limit=1G", str(HERE / script), *map(str, arguments)],
        input=json.dumps(asked),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert made.returncode == 0, made.stdout[-2000:] + made.stderr[-2000:]
    return made.stdout


@needs_sdk
@every_exercise
def test_the_sdk_marks_as_we_do(name, package):
    items = package(name, "qti21") / "items"

    def play(given, sheets):
        file = str(items / f"{identifier_of(given)}.xml")
        return json.loads(php("qti_sdk.php", SDK, asked={"items": {file: sheets}}))[file]

    assert checked(name, play)["same"]


@needs_sdk
def test_a_test_deals_one_variant_of_each_exercise_and_reports_its_answers(tmp_path):
    drawn = of_exercises(COURSE, ["grashof", "slotted_mechanism"], 3, 0, ["en"], None)
    chosen = platform_of("qti21")
    (file,) = chosen.files(drawn.pool("en", chosen))
    (tmp_path / "package.zip").write_bytes(file.make())
    with zipfile.ZipFile(tmp_path / "package.zip") as archive:
        archive.extractall(tmp_path / "package")
    right = {}
    for path in (tmp_path / "package" / "items").glob("*.xml"):
        right[path.stem] = Player(path.read_bytes()).right()
    dealt = set()
    for place in range(6):
        report = php(
            "qti_sitting.php", SDK, tmp_path / "package", asked={"student": f"s{place}", "answers": right}
        )
        items = re.findall(r'<itemResult identifier="([^"]+)"', report)
        assert [name.split("-")[1] for name in items] == ["grashof", "slotted_mechanism"]
        dealt.update(items)
        test = report[: report.index("<itemResult")]
        assert re.findall(r"<value>([0-9.]+)</value>", test) == ["13", "13"]  # SCORE and MAXSCORE
        assert f'sourcedId="s{place}"' in report
    assert len(dealt) > 2  # not the same to everybody


@pytest.fixture(scope="session")
def schemas(tmp_path_factory):
    """The schemas of the sdk, mended where libxml2 cannot use them."""
    folder = tmp_path_factory.mktemp("schemas") / "schemes"
    shutil.copytree(Path(SDK) / "qtism/data/storage/xml/schemes", folder)
    for path in (folder / "w3/mathml3").glob("*.xsd"):
        path.write_text(path.read_text("utf-8").replace("2010/Math/MathML", "1998/Math/MathML"), "utf-8")
    spoken = re.findall(
        r'ref="ssml11:([\w-]+)"', (folder / "qtiv3p0/imsqti_asiv3p0_sbacv1p0_v1p0.xsd").read_text()
    )
    head = '<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema" targetNamespace="{}">{}</xs:schema>'
    elements = "".join(f'<xs:element name="{name}"/>' for name in sorted(set(spoken)))
    (folder / "w3/ssml11/ssmlv1p1-core.xsd").write_text(
        head.format("http://www.w3.org/2001/10/synthesis", elements)
    )
    (folder / "xlink.xsd").write_text(head.format("http://www.w3.org/1999/xlink", _XLINK))
    return folder


SCHEMAS = {
    "qti21": ("imscp_v1p1.xsd", "qtiv2p1/imsqti_v2p1.xsd"),
    "qti3": ("qtiv3p0/imsqtiv3p0_imscpv1p2_v1p0.xsd", "qtiv3p0/imsqti_asiv3p0_sbacv1p0_v1p0.xsd"),
}


@needs_sdk
@pytest.mark.parametrize("platform", SCHEMAS)
@every_exercise
def test_every_file_is_valid_by_the_schemas(name, platform, package, schemas):
    manifest, content = SCHEMAS[platform]
    folder = package(name, platform)
    asked = {str(path): content for path in [folder / "test.xml", *(folder / "items").glob("*.xml")]}
    asked[str(folder / "imsmanifest.xml")] = manifest
    assert json.loads(php("qti_schemas.php", schemas, asked=asked)) == {}


# ------------------------------------------------------------------------- players


class _Files(http.server.SimpleHTTPRequestHandler):
    package = Path()

    def translate_path(self, path):
        for head, folder in (("/npm/", Path(PLAYERS)), ("/package/", type(self).package)):
            if path.startswith(head):
                return str(folder / path.removeprefix(head).partition("?")[0])
        return str(HERE / path.lstrip("/").partition("?")[0])

    def log_message(self, *_):
        pass


@pytest.fixture(scope="session")
def address():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), _Files)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_address[1]}"
    server.shutdown()
    server.server_close()


@pytest.fixture(scope="session")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as started:
        flags = ["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
        browser = started.chromium.launch(executable_path=CHROMIUM, args=flags)
        yield browser
        browser.close()


@pytest.fixture(scope="session", params=["citolab", "amp_up"])
def page(request, browser, address):
    """A player, ready; whatever it asks of another host fails the test."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.set_default_timeout(120_000)
    page.elsewhere = []
    page.on(
        "request",
        lambda one: (
            None if one.url.startswith((address, "data:", "blob:")) else page.elsewhere.append(one.url)
        ),
    )
    page.goto(f"{address}/qti_{request.param}.html")
    page.wait_for_function("window.ready")
    yield page
    page.close()


@needs_players
@every_exercise
def test_a_player_marks_as_we_do(name, page, package):
    _Files.package = package(name, "qti3")

    def play(given, sheets):
        names = page.evaluate(f"load('/package/items/{identifier_of(given)}.xml')")
        assert {*recorded(given, lambda one: None)} <= {*names}
        return page.evaluate("sheets => marked(sheets)", sheets)

    assert checked(name, play)["same"]
    assert page.elsewhere == []


@needs_players
def test_what_is_typed_is_marked_and_told(page, package):
    """Through the boxes, as a student does: a right number, a comma that the box refuses, a known error."""
    _Files.package = package("slotted_mechanism", "qti3")
    (_, given) = items_of(pool_of("slotted_mechanism"), "en")[0]
    page.evaluate(f"load('/package/items/{identifier_of(given)}.xml')")
    boxes = page.locator("qti-text-entry-interaction input, input.text-entry-default")
    assert boxes.count() == 9
    right, error = (
        given.questions[0].intervals[0],
        next(one for one in given.questions[1].intervals if not one.is_right and one.message),
    )
    boxes.nth(0).press_sequentially(f"{right.value:.6g}")
    boxes.nth(1).press_sequentially(f"{error.value:.6g}")
    boxes.nth(1).press("Tab")
    page.evaluate("finish()")
    page.wait_for_timeout(300)
    shown = [text for text in page.locator(".feedback:visible").all_inner_texts() if text]
    assert len(shown) == 2
    assert shown[0].startswith("right (1/1)")
    assert "(1/1)" not in shown[1]
    for box in boxes.all():
        assert box.evaluate("one => one.getAttribute('aria-label') || one.placeholder").startswith("Answer")


@needs_players
@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize(
    "name", ["slotted_mechanism", "velocity_polygon", "serial_joints", "geometrical_closure", "joint_twist"]
)
def test_nothing_hangs_over_and_formulas_are_laid_out(name, width, page, package):
    _Files.package = package(name, "qti3")
    (_, given) = items_of(pool_of(name), "en")[0]
    page.set_viewport_size({"width": width, "height": 900})
    page.evaluate(f"load('/package/items/{identifier_of(given)}.xml')")
    page.wait_for_timeout(300)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    size = "one => parseFloat(getComputedStyle(one).fontSize)"
    lowered, base = page.locator("msub > :nth-child(2)").first, page.locator("msub > :nth-child(1)").first
    assert lowered.evaluate(size) < base.evaluate(size)
    low, high = lowered.bounding_box(), base.bounding_box()
    assert low["y"] + low["height"] > high["y"] + high["height"]
    image = page.locator("img").first
    assert image.evaluate("one => one.naturalWidth") > 100
    assert image.get_attribute("alt")
