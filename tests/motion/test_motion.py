"""Mechanisms move as they should: every length kept, vectors the slopes of paths, one file, nothing fetched."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import coursework
from coursework.api import Variant
from coursework.authoring.checks import check
from coursework.cli import run
from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, UnknownName, WrongValue
from coursework.figures import link, pin, rail, rotation_arrow
from coursework.figures.moving import drawing
from coursework.figures.riding import ride
from coursework.figures.text import read
from coursework.motion.animation import EFFECTS
from coursework.motion.scenes import Scene
from coursework.rendering.displayed import DisplayedAnimation as Animation

COURSE = coursework.open_course()
DRIVEN = [n for n in COURSE.names if COURSE[n].spec.driver is not None]
MOVING = [n for n in COURSE.names if COURSE[n].is_animated]
FILMED = [n for n in MOVING if COURSE[n].film is not None]
WITH_POINTS = [n for n in MOVING if COURSE[n].solution.motion is not None]
SVG = "{http://www.w3.org/2000/svg}"
_kept: dict[tuple, Animation] = {}


def animation(name, seed=1, lang="fr", effects=()):
    key = (name, seed, lang, tuple(effects))
    if key not in _kept:
        plain = COURSE[name].variant(seed, lang).animation()
        shown = plain.available if effects == "all" else effects
        _kept[key] = COURSE[name].variant(seed, lang).animation(shown, count=36)
    return _kept[key]


def outward_references(text):
    """Addresses and style imports that a reader of the file would go and fetch."""
    found = re.findall(r"""\b(?:src|srcset|href|action|poster)\s*=\s*["']?([^"'\s>]+)""", text)
    found += re.findall(r"url\(\s*[\"']?([^\"')]+)", text) + re.findall(r"@import[^;]*", text)
    return [f for f in found if not f.startswith("data:")]


@pytest.fixture
def four_bar_that_swings():
    """Neither bar turns fully: a triple rocker."""
    exercise = COURSE["four_bar_positions"]
    given = {"r1": 200.0, "r2": 100.0, "r3": 90.0, "r4": 80.0, "theta2": 20.0}
    return Animation(coursework.Variant(exercise, 0, given, "en"), count=24)


# ---------------------------------------------------------------------- frames


@pytest.mark.parametrize("name", DRIVEN)
@pytest.mark.parametrize("seed", [0, 5])
def test_every_driven_mechanism_keeps_the_length_of_its_links_over_the_cycle(name, seed):
    moved = animation(name, seed)
    links = [[e for e in elements if hasattr(e, "weld")] for elements in moved.frames]
    assert links[0]
    for one in zip(*links, strict=True):
        sides = np.array([[abs(q - p) for p, q in e.bars()] for e in one])
        assert np.ptp(sides, axis=0) == pytest.approx(0, abs=1e-9 * sides.max())


@pytest.mark.parametrize("name", DRIVEN)
def test_the_sheets_position_comes_first_and_a_loop_ends_where_it_began(name):
    moved = animation(name)
    assert moved.order[0] == moved.order[-1] == moved.first
    assert moved.frames[moved.first] == moved.variant.figure.elements
    angle = moved.variant.exercise.driver_angle(moved.variant.given)
    assert (moved.angles[moved.first] - angle) % 360 == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("name", DRIVEN)
def test_a_full_turn_visits_every_angle_once_the_way_the_driver_turns(name):
    moved = next(animation(name, seed) for seed in range(1, 30) if animation(name, seed).turns)
    speed = moved.variant.given.get(moved.variant.exercise.spec.driver.speed, 1.0)
    steps = np.diff(np.unwrap(moved.angles[list(moved.order)], period=360))
    assert steps == pytest.approx(np.full(36, np.sign(speed) * 10.0))


def test_a_linkage_that_does_not_turn_fully_swings_between_its_limits_and_back(four_bar_that_swings):
    moved = four_bar_that_swings
    low, high = moved.angles[[0, -1]]
    # Coupler and rocker in line: the triangle O, A, C has sides 200, 100 and 170.
    limit = np.degrees(np.arccos((200**2 + 100**2 - 170**2) / (2 * 200 * 100)))
    assert (low, high) == pytest.approx((-limit, limit), abs=1e-6)
    visited = moved.angles[list(moved.order)]
    assert {visited.max(), visited.min()} == {high, low}
    assert all(abs(a - b) == 1 for a, b in zip(moved.order, moved.order[1:], strict=False))
    assert (np.diff(visited) != 0).all()


def test_a_swing_slows_down_at_its_ends_as_a_pendulum_does(four_bar_that_swings):
    moved = four_bar_that_swings
    timed = [e for e in ET.fromstring(moved.svg()).iter() if e.get("keyTimes")]
    assert timed
    times = np.array([float(t) for t in timed[0].get("keyTimes").split(";")])
    assert (times[0], times[-1]) == (0, 1)
    assert len(times) == len(timed[0].get("values").split(";"))
    assert (np.diff(times) > 0).all()
    half = moved.angles[-1]  # the limits are opposite
    start = np.arcsin(moved.angles[moved.first] / half)
    assert half * np.sin(2 * np.pi * times + start) == pytest.approx(
        moved.angles[list(moved.order)], abs=0.01
    )


def test_paths_are_smooth_up_to_the_limits_of_a_swing(four_bar_that_swings):
    path = four_bar_that_swings.points["B_1"].position
    steps = np.abs(np.diff(path))
    assert max(steps[:10].max(), steps[-10:].max()) < 0.05 * steps.sum()


# --------------------------------------------------------------------- vectors


def motion_at(name, seed, turn, speed, acceleration):
    """The points of a variant, its driver at another angle, turning otherwise."""
    exercise = COURSE[name]
    variant, driver = exercise.variant(seed), exercise.spec.driver
    given = {**variant.used, **exercise.posed(variant.used, exercise.driver_angle(variant.used) + turn)}
    given |= {n: v for n, v in ((driver.speed, speed), (driver.acceleration, acceleration)) if n in given}
    graph = exercise.solution.graph.with_functions({"motion": exercise.solution.motion})
    return graph.evaluate(("motion",), given, exercise.spec.effects)["motion"]


def test_every_animated_mechanism_states_its_points():
    assert WITH_POINTS == MOVING
    assert set(DRIVEN) | set(FILMED) == set(MOVING)


@pytest.mark.parametrize("name", [n for n in WITH_POINTS if n not in FILMED])
@pytest.mark.parametrize("seed", [2, 9])
def test_velocities_and_accelerations_are_the_slopes_of_positions(name, seed):
    step, speed, sped_up = 0.01, 3.0, 7.0
    acceleration = sped_up if COURSE[name].spec.driver.acceleration else 0.0
    turns = np.arange(0.0, 360.0, 15.0)
    before, now, after = (motion_at(name, seed, turns + d, speed, acceleration) for d in (-step, 0.0, step))
    for point, moving in now.items():
        p, q, r = (np.asarray(one[point].position) for one in (before, now, after))
        slope, bend = (r - p) / (2 * np.radians(step)), (r - 2 * q + p) / np.radians(step) ** 2
        if moving.velocity is not None:
            wanted = slope * speed
            assert abs(moving.velocity - wanted).max() < 1e-6 * abs(wanted).max()
        if moving.acceleration is not None:
            wanted = bend * speed**2 + slope * acceleration
            assert abs(moving.acceleration - wanted).max() < 1e-5 * abs(wanted).max()


@pytest.mark.parametrize("name", WITH_POINTS)
def test_a_point_of_that_name_is_drawn_where_the_solution_says_that_it_is(name):
    moved = animation(name)
    labels = {getattr(e, "label", "") for e in moved.frames[0]}
    assert labels & moved.points.keys()
    for point in labels & moved.points.keys():
        for k, elements in enumerate(moved.frames):
            at = next(e.p for e in elements if getattr(e, "label", "") == point)
            assert abs(at - moved.points[point].position[k]) < 1e-9 * abs(at)


@pytest.mark.parametrize(
    ("name", "pivot", "block"),
    [
        ("slotted_mechanism", None, "A"),
        ("quick_return_shaper", None, "A"),
        ("quick_return_whitworth", None, "A"),
        ("three_loop_shaper", ("xD", "yD"), "E"),
    ],
)
def test_a_coriolis_term_is_what_neither_guide_nor_slide_explains(name, pivot, block):
    """In a frame that turns with the guide: a = a of the guide's point + a of the slide + the Coriolis term."""
    step, speed = 0.02, 2.0
    turns = np.arange(0.0, 360.0, 15.0)
    given = COURSE[name].variant(2).used
    O4 = complex(*(given[n] for n in pivot)) if pivot else 0j
    arms = [motion_at(name, 2, turns + d, speed, 0.0)[block].position - O4 for d in (-step, 0.0, step)]
    length = np.abs(arms)
    angle = np.unwrap(np.angle(arms), axis=0)
    rate = speed / np.radians(step)
    slide, turning = (length[2] - length[0]) / 2 * rate, (angle[2] - angle[0]) / 2 * rate
    slide_2 = (length[2] - 2 * length[1] + length[0]) * rate**2
    turning_2 = (angle[2] - 2 * angle[1] + angle[0]) * rate**2
    along = np.exp(1j * angle[1])
    A = motion_at(name, 2, turns, speed, 0.0)[block]
    guide = (1j * turning_2 - turning**2) * arms[1]
    assert abs(A.acceleration - guide - slide_2 * along - A.coriolis).max() < 1e-4 * abs(A.acceleration).max()
    assert abs(A.coriolis - 2j * turning * slide * along).max() < 1e-5 * abs(A.coriolis).max()


def test_vectors_have_one_scale_for_the_whole_cycle_and_the_legend_states_it():
    moved = animation("slotted_mechanism", 1, "fr", "all")
    tracks = moved.drawing(("velocity",)).tracks
    scale = moved.drawing(("velocity",)).scale
    head = next(t for t in tracks if t.effect == "velocity" and t.closed and not t.key)
    tail = next(t for t in tracks if t.effect == "velocity" and not t.closed and not t.key)
    drawn = np.hypot(*(head.numbers[:, :2] - tail.numbers[:, :2]).T)
    true = np.abs(moved.points["A"].velocity)
    assert drawn == pytest.approx(true / moved.scales["velocity"] * scale, rel=1e-9)
    key = next(t for t in tracks if t.key and t.closed)
    start = next(t for t in tracks if t.key and not t.closed)
    length = (key.numbers[0, 0] - start.numbers[0, 0]) / scale * moved.scales["velocity"]
    (told,) = moved._keys({"velocity"})
    assert told.words == f"Vitesse : {length:.0f} mm/s"


def test_the_readings_are_the_quantities_of_the_scene():
    moved = animation("slotted_mechanism", 1, "en", "all")
    scene = Scene(COURSE["slotted_mechanism"], moved.variant.used, ("velocity",))
    reading = next(r for r in moved.readings if r.symbol == COURSE["slotted_mechanism"].symbol("omega4"))
    assert "omega4" in scene.quantities
    assert reading.effects == ("velocity",)
    asked = {**moved.variant.used, "theta2": float(moved.angles[7])}
    alone = COURSE["slotted_mechanism"].solve(**asked, only="omega4")["omega4"]
    assert float(reading.values[7].replace("−", "-")) == pytest.approx(alone, rel=1e-3)


def test_a_crank_angle_that_is_an_answer_is_shown_and_the_assembly_kept():
    """The instant is given by the angle OAB, which takes every value twice a turn, its points on either side."""
    exercise = COURSE["quick_return"]
    variant = exercise.variant(3)
    given = variant.used
    assert exercise.driver_angle(given) == pytest.approx(
        exercise.solve(**given, only="theta2")["theta2"], abs=1e-9
    )
    turn = exercise.posed(given, np.arange(0.0, 360.0, 10.0) + 1.0)
    assert set(turn["A_side"]) == {"left", "right"}
    solved = exercise.solve(**{**given, **turn}, only=("theta2", "theta3", "theta4"))
    assert (solved["theta2"] % 360) == pytest.approx(np.arange(0.0, 360.0, 10.0) + 1.0, abs=1e-7)
    # The angle from rod AB to rocker DB keeps its sign: the dyad never passes through a straight line.
    between = np.sin(np.radians(solved["theta4"] - solved["theta3"]))
    assert abs(np.sign(between).sum()) == len(between)
    assert np.abs(np.diff(np.unwrap(solved["theta4"], period=360))).max() < 15


def test_a_driver_angle_that_nothing_says_is_a_fault_of_the_course():
    exercise = CourseExercise("quick_return", COURSE.folder, COURSE, Variant)
    exercise.spec = replace(exercise.spec, driver=replace(exercise.spec.driver, poses=None))
    with pytest.raises(BadCourse, match="theta2 is no given quantity"):
        exercise.variant(0).animation().svg()


# ----------------------------------------------------------------------- files


@pytest.mark.parametrize("name", MOVING)
def test_the_svg_moves_without_script_fetches_nothing_and_is_small(name):
    text = animation(name, effects="all").svg()
    svg = ET.fromstring(text)
    kinds = {e.tag.removeprefix(SVG) for e in svg.iter()}
    assert kinds & {"animate", "animateTransform"}
    assert not kinds & {"script", "foreignObject", "image", "use", "a"}
    assert not outward_references(text)
    assert not [a for e in svg.iter() for a in e.attrib if a.startswith("on")]
    assert len(COURSE[name].variant(1).animation(animation(name, effects="all").effects).svg()) < 600_000


@pytest.mark.parametrize("name", MOVING)
def test_every_animated_value_begins_as_the_still_picture_and_a_loop_ends_so(name):
    svg = ET.fromstring(animation(name).svg())
    animated = 0
    for thing in svg.iter():
        for change in [e for e in thing if e.get("values")]:
            values = change.get("values").split(";")
            assert len(values) == len(animation(name).order)
            assert len({re.sub(r"[-\d. ]+", "#", v) for v in values}) == 1  # the same shape at every instant
            still = thing.get(change.get("attributeName")).removeprefix("translate(").removesuffix(")")
            assert values[0] == still
            assert values[-1] == still or name in FILMED
            animated += 1
    stills = [e for e in svg.iter() if e.get("class") == "coursework-still"]
    assert animated == len(stills) > 3


def test_who_wants_no_motion_sees_the_first_instant():
    style = ET.fromstring(animation("slotted_mechanism").svg()).find(f"{SVG}style").text
    _, reduced = style.split("@media (prefers-reduced-motion:reduce)")
    assert ".coursework-moving{display:none}" in reduced
    assert ".coursework-still{display:inline}" in reduced


@pytest.mark.parametrize("name", MOVING)
def test_nothing_drawn_leaves_the_view_box(name):
    shown = animation(name, effects="all").drawing(EFFECTS)
    for track in shown.tracks:
        for column, size in ((0, shown.size[0]), (1, shown.size[1])):
            assert track.numbers[:, column::2].min() >= 0
            assert track.numbers[:, column::2].max() <= size


class _Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.data, self._in_data = [], "", False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self._in_data = dict(attrs).get("id") == "motion-data"

    def handle_data(self, data):
        if self._in_data:
            self.data += data

    def handle_endtag(self, tag):
        self._in_data = False


@pytest.mark.parametrize("name", MOVING)
@pytest.mark.parametrize(("lang", "play"), [("fr", "Animer"), ("en", "Play")])
def test_the_page_is_one_file_in_its_language(name, lang, play):
    text = animation(name, 1, lang).html()
    page = _Page(text)
    assert not outward_references(text)
    assert f'<html lang="{lang}">' in text
    assert f">{play}</button>" in text
    assert len(text) < 600_000
    ids = [a["id"] for _, a in page.tags if "id" in a]
    assert len(ids) == len(set(ids))
    labelled = {a.get("for") for tag, a in page.tags if tag == "label"}
    assert "angle" in labelled


@pytest.mark.parametrize("name", MOVING)
def test_the_page_holds_every_instant_of_everything_that_moves(name):
    moved = animation(name, effects="all")
    page = _Page(moved.html())
    data = json.loads(page.data)
    tracks = [a["data-track"] for _, a in page.tags if "data-track" in a]
    assert tracks == [str(k) for k in range(len(data["tracks"]))]
    assert {len(track["rows"]) for track in data["tracks"]} == {len(moved.angles)}
    assert len(data["readings"]) == sum("data-reading" in a for _, a in page.tags)
    assert len(data["times"]) == len(data["order"])
    assert (data["times"][0], data["times"][-1]) == (0, 1)
    slider = next(a for tag, a in page.tags if a.get("type") == "range")
    assert slider["max"] == str(len(moved.angles) - 1)
    assert slider["value"] == str(moved.first)
    boxes = {a["value"] for tag, a in page.tags if a.get("name") == "effect"}
    assert boxes == set(moved.available)


def test_an_effect_that_is_not_called_for_is_there_and_switched_off():
    page = _Page(animation("slotted_mechanism", effects=("velocity",)).html())
    hidden = {a["data-effect"]: "style" in a for _, a in page.tags if "data-effect" in a}
    assert hidden == {"position": True, "velocity": False, "acceleration": True, "coriolis": True}
    checked = {a["value"]: "checked" in a for _, a in page.tags if a.get("name") == "effect"}
    assert checked == {e: not off for e, off in hidden.items()}


@pytest.mark.parametrize("name", ["slotted_mechanism", "three_loop_shaper"])
def test_the_same_variant_gives_the_same_bytes(name):
    one, other = (COURSE[name].variant(4).animation() for _ in range(2))
    assert one.svg() == other.svg()
    assert one.html() == other.html()


# --------------------------------------------------------------------- labels


@pytest.mark.parametrize("name", MOVING)
def test_labels_on_the_move_lie_on_no_label_and_hardly_ever_on_a_line(name, monkeypatch):
    """Counted at every instant; a label that a line must pass under has a white rim."""
    seen = {}

    def spy(rows, segments, closed):
        seen["rows"], seen["segments"] = rows, segments
        seen["centres"] = ride(rows, segments, closed)
        return seen["centres"]

    monkeypatch.setattr("coursework.figures.moving.ride", spy)
    COURSE[name].variant(1).animation().drawing(("position",))
    centres = np.array(seen["centres"])
    half = np.array([read(row[0].label).box for row in seen["rows"]]) / 2
    reach = half[:, None, :] + half[None, :, :]
    between = centres[:, None] - centres[None, :]
    meets = (abs(between.real) < reach[..., :1]) & (abs(between.imag) < reach[..., 1:])
    meets[range(len(half)), range(len(half))] = False
    assert meets.mean() < 0.001
    a, b = seen["segments"]
    steps = np.linspace(0.0, 1.0, 41)
    on_line = []
    for place, (wide, tall) in zip(centres, half, strict=True):
        off = (a[..., None] + (b - a)[..., None] * steps) - place[:, None, None]
        on_line.append(((abs(off.real) < wide) & (abs(off.imag) < tall)).any(axis=(1, 2)))
    assert np.mean(on_line) < 0.05


# ------------------------------------------------------------------- what moves


def test_guides_stand_still_and_a_sense_of_rotation_does_not_jump():
    frames = [
        (rail(x - 5, x + 5), link(0, x), pin(x), rotation_arrow(0, 20, x, x + 30)) for x in (40.0, 60.0, 50.0)
    ]
    moving = [t for t in drawing(frames).tracks if t.moves]
    assert len(moving) == 2  # the link and its pin
    # The guide reaches from the first end of all to the last of all.
    shown = drawing(frames)
    guide = max(
        (t for t in shown.tracks if not t.mark and not t.moves), key=lambda t: np.ptp(t.numbers[0, 0::2])
    )
    assert np.ptp(guide.numbers[0, 0::2]) == pytest.approx(30 * shown.scale)


def test_an_element_that_is_not_always_there_is_left_out():
    frames = [(link(0, 50), pin(50, "A")), (link(0, 50j),), (link(0, -50), pin(-50, "A"))]
    assert len(drawing(frames).tracks) == 1


def test_where_nothing_moves_or_an_effect_is_unknown_the_error_says_so():
    with pytest.raises(BadCourse, match="names no driver"):
        COURSE["grashof"].variant(0).animation()
    with pytest.raises(UnknownName, match="velocity"):
        COURSE["slotted_mechanism"].variant(0).animation(("velocty",))
    with pytest.raises(WrongValue, match="no coriolis to show"):
        COURSE["four_bar_motion"].variant(0).animation(("coriolis",))


def test_a_students_copy_moves_without_solutions(small_course):
    import shutil

    source = small_course / "exercises" / "crank_pin.py"
    text = source.read_text("utf-8")
    assert "driver" not in text
    text = text.replace("import Exercise", "import Driver, Exercise")
    text = re.sub(r"figure=figure,", 'figure=figure, driver=Driver("theta"),', text)
    source.write_text(text, "utf-8")
    shutil.rmtree(small_course / "solutions")
    moved = coursework.open_course(small_course)["crank_pin"].variant(0).animation()
    assert moved.points == {}
    assert moved.readings == ()
    assert "<animate" in moved.svg()
    assert "motion-data" in moved.html()


FILM = """
from coursework.degrees import polar
from coursework.figures import Figure, link, pin
from coursework.solution import Film, Moving


def _turning(turned, r):
    return Figure(link(0, polar(r, turned / 4)), pin(polar(r, turned / 4), "A"))


def _turns(r):
    return {turns}


def motion(turned, r):
    return {{"A": Moving(polar(r, turned / 4))}}


FILM = Film(_turning, angle="turned", speed="omega", turns=_turns)
"""


def filmed(small_course, turns="2.3"):
    """The small course, its exercise with a film: a bar that turns a quarter as fast as what drives it."""
    for lang in ("en", "fr"):
        text = small_course / "solutions" / f"crank_pin.{lang}.md.j2"
        text.write_text(text.read_text("utf-8") + f"\n## motion\nr = {{{{ r }}}} ({lang}).\n", "utf-8")
    source = small_course / "solutions" / "crank_pin.py"
    source.write_text(source.read_text("utf-8") + FILM.format(turns=turns), "utf-8")
    return small_course


@pytest.mark.parametrize("way", [1, -1])
def test_a_film_shows_its_own_picture_over_its_turns_at_a_steady_pace(small_course, way):
    exercise = coursework.open_course(filmed(small_course))["crank_pin"]
    given = {**exercise.variant(0).given, "omega": way * 3.0}
    moved = Animation(coursework.Variant(exercise, 0, given, "en"), count=24)
    shown = moved.angles[list(moved.order)]
    assert shown[:-1] == pytest.approx(way * 15.0 * np.arange(56))
    assert shown[-1] == pytest.approx(way * 828.0)
    assert moved.times == pytest.approx(shown / shown[-1])
    assert moved.seconds == pytest.approx(2.3 * Animation(COURSE["slotted_mechanism"].variant(0)).seconds)
    at_A = [next(e.p for e in elements if getattr(e, "label", "") == "A") for elements in moved.frames]
    assert at_A == pytest.approx(given["r"] * np.exp(1j * np.radians(moved.angles) / 4))
    assert at_A == pytest.approx(moved.points["A"].position)
    # Nothing leads from the last picture back to the first.
    path = next(t for t in moved.drawing(("position",)).tracks if t.effect == "position" and not t.mark)
    assert not path.closed
    assert not moved.closed


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_a_film_has_its_own_words_and_the_page_says_that_it_starts_over(small_course, lang):
    variant = coursework.open_course(filmed(small_course))["crank_pin"].variant(0, lang)
    moved = variant.animation()
    assert moved.words.startswith("r = ")
    assert moved.words.endswith(f"({lang}).")
    page = moved.html()
    assert ("2.3 turns" if lang == "en" else "2,3 tours") in page
    assert ("statement" if lang == "en" else "énoncé") not in page
    data = json.loads(_Page(page).data)
    assert data["seconds"] == pytest.approx(13.8)
    assert data["film"] is True
    assert data["angles"][72].startswith("360")  # not the first angle once more


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_a_film_without_words_in_a_language_is_a_failure(small_course, lang):
    exercise = coursework.open_course(filmed(small_course))["crank_pin"]
    assert check(exercise, 1, rendered=0).failures == []
    text = small_course / "solutions" / f"crank_pin.{lang}.md.j2"
    text.write_text(text.read_text("utf-8").replace("## motion", "## omission"), "utf-8")
    found = check(coursework.open_course(small_course)["crank_pin"], 1, rendered=0).failures
    assert any(f"crank_pin.{lang}.md.j2" in f and "motion" in f for f in found)


@pytest.mark.parametrize("turns", ["0.0", "-1.0", "float('nan')", "float('inf')"])
def test_a_film_of_no_turns_is_refused(small_course, turns):
    exercise = coursework.open_course(filmed(small_course, turns))["crank_pin"]
    with pytest.raises(BadCourse, match=r"crank_pin.py: FILM: turns gives a number above 0"):
        exercise.variant(0).animation().svg()


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ('speed="omega"', 'speed="omga"', "speed='omga' is no given quantity"),
        ("FILM = Film(_turning", "FILM = Film(lambda: None", "figure gives a Figure"),
        ("2.3", "'2.3'", "turns gives a number"),
        ("2.3", "1e9", "turns gives a number above 0, at most"),
    ],
)
def test_a_film_that_cannot_be_shown_is_told_by_check(small_course, right, wrong, told):
    source = filmed(small_course) / "solutions" / "crank_pin.py"
    text = source.read_text("utf-8")
    assert right in text
    source.write_text(text.replace(right, wrong), "utf-8")
    found = check(coursework.open_course(small_course)["crank_pin"], 1, rendered=1).failures
    assert any(told in fault and "crank_pin.py: FILM" in fault for fault in found), found


def test_a_film_that_is_none_is_refused(small_course):
    source = filmed(small_course) / "solutions" / "crank_pin.py"
    source.write_text(source.read_text("utf-8") + "\nFILM = _turning\n", "utf-8")
    with pytest.raises(BadCourse, match=r"crank_pin.py: FILM is a Film"):
        coursework.open_course(small_course)["crank_pin"].variant(0).animation()


def test_without_solutions_there_is_no_film(small_course):
    import shutil

    shutil.rmtree(filmed(small_course) / "solutions")
    exercise = coursework.open_course(small_course)["crank_pin"]
    assert not exercise.is_animated
    with pytest.raises(BadCourse, match="no solution at hand states a FILM"):
        exercise.variant(0).animation()


def test_the_command_writes_both_files(tmp_path, capsys):
    assert (
        run(
            [
                "animate",
                "slotted_mechanism",
                "--seed",
                "3",
                "--effects",
                "velocity,coriolis",
                "--out",
                str(tmp_path),
            ]
        )
        == 0
    )
    assert {p.name for p in tmp_path.iterdir()} == {"slotted_mechanism.svg", "slotted_mechanism.html"}
    assert "Coriolis" not in (tmp_path / "slotted_mechanism.svg").read_text("utf-8")  # letters are outlines
    assert run(["animate", "slotted_mechanism", "--effects", "colour", "--out", str(tmp_path)]) == 2
    assert "no effect 'colour'" in capsys.readouterr().err


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_the_command_writes_a_film_in_both_languages(tmp_path, lang):
    assert (
        run(["animate", "ball_reducer", "--lang", lang, "--effects", "velocity", "--out", str(tmp_path)]) == 0
    )
    page = (tmp_path / "ball_reducer.html").read_text("utf-8")
    assert f'<html lang="{lang}">' in page
    assert "<animate" in (tmp_path / "ball_reducer.svg").read_text("utf-8")


@pytest.mark.parametrize("name", ["slotted_mechanism", "ball_reducer"])
def test_a_notebook_shows_the_moving_picture(name):
    shown = coursework.show_motion(COURSE[name].variant(1))
    assert shown._repr_html_().startswith('<img src="data:image/svg+xml;base64,')


def test_a_scene_names_no_hidden_quantity():
    scene = Scene(COURSE["slotted_mechanism"], COURSE["slotted_mechanism"].variant(0).used, ("velocity",))
    assert "_arm" in COURSE["slotted_mechanism"].plan(("omega4",))
    assert not [n for n in scene.over_cycle(4).evaluated if n.startswith("_")]
