"""A moving picture is one file that fetches nothing, in its language, readable at every instant."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from animations import COURSE, FILMED, MOVING, SVG, Page, animation
from sweeps import sampled

import coursework
from coursework.cli import run
from coursework.figures import angle_mark, dimension, link, pin, rail, rotation_arrow
from coursework.figures.elements import bar
from coursework.figures.moving import drawing
from coursework.figures.riding import ride
from coursework.figures.text import read
from coursework.scenes.animation import _without_sizes
from coursework.scenes.gauges import EFFECTS

pytestmark = pytest.mark.e2e

#: A crank, a coupler, and the film of a ball always; all that move, slow.
few_moving = pytest.mark.parametrize(
    "name", sampled(MOVING, ["slotted_mechanism", "four_bar_motion", "ball_reducer"])
)


def outward_references(text):
    """Addresses and style imports that a reader of the file would go and fetch."""
    found = re.findall(r"""\b(?:src|srcset|href|action|poster)\s*=\s*["']?([^"'\s>]+)""", text)
    found += re.findall(r"url\(\s*[\"']?([^\"')]+)", text) + re.findall(r"@import[^;]*", text)
    return [f for f in found if not f.startswith("data:")]


@few_moving
def test_the_svg_moves_without_script_fetches_nothing_and_is_small(name):
    text = animation(name, effects="all").svg()
    svg = ET.fromstring(text)
    kinds = {e.tag.removeprefix(SVG) for e in svg.iter()}
    assert kinds & {"animate", "animateTransform"}
    assert not kinds & {"script", "foreignObject", "image", "use", "a"}
    assert not outward_references(text)
    assert not [a for e in svg.iter() for a in e.attrib if a.startswith("on")]
    assert len(COURSE[name].variant(1).animation(animation(name, effects="all").effects).svg()) < 600_000


@few_moving
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


@few_moving
def test_nothing_drawn_leaves_the_view_box(name):
    shown = animation(name, effects="all").drawing(EFFECTS)
    for track in shown.tracks:
        for column, size in ((0, shown.size[0]), (1, shown.size[1])):
            assert track.numbers[:, column::2].min() >= 0
            assert track.numbers[:, column::2].max() <= size


@few_moving
@pytest.mark.parametrize(("lang", "play"), [("fr", "Animer"), ("en", "Play")])
def test_the_page_is_one_file_in_its_language(name, lang, play):
    text = animation(name, 1, lang).html()
    page = Page(text)
    assert not outward_references(text)
    assert f'<html lang="{lang}">' in text
    assert f">{play}</button>" in text
    assert len(text) < 600_000
    ids = [a["id"] for _, a in page.tags if "id" in a]
    assert len(ids) == len(set(ids))
    labelled = {a.get("for") for tag, a in page.tags if tag == "label"}
    assert "angle" in labelled


@few_moving
def test_the_page_holds_every_instant_of_everything_that_moves(name):
    moved = animation(name, effects="all")
    page = Page(moved.html())
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
    page = Page(animation("slotted_mechanism", effects=("velocity",)).html())
    hidden = {a["data-effect"]: "style" in a for _, a in page.tags if "data-effect" in a}
    assert hidden == {"position": True, "velocity": False, "acceleration": True, "coriolis": True}
    checked = {a["value"]: "checked" in a for _, a in page.tags if a.get("name") == "effect"}
    assert checked == {e: not off for e, off in hidden.items()}


@pytest.mark.parametrize("name", sampled(["slotted_mechanism", "three_loop_shaper"]))
def test_the_same_variant_gives_the_same_bytes(name):
    one, other = (COURSE[name].variant(4).animation() for _ in range(2))
    assert one.svg() == other.svg()
    assert one.html() == other.html()


@pytest.fixture
def ridden(monkeypatch):
    """The labels of the last drawing: half sides of boxes, centres at every instant, what is drawn."""
    seen = {}

    def spy(rows, segments, closed):
        seen["half"] = np.array([read(row[0].label).box for row in rows]) / 2
        seen["segments"], seen["centres"] = segments, np.array(ride(rows, segments, closed))
        return seen["centres"]

    monkeypatch.setattr("coursework.figures.moving.ride", spy)
    return seen


def _on_one_another(half, centres):
    """Whether one label lies on another: label, other, instant."""
    reach = half[:, None, :] + half[None, :, :]
    between = centres[:, None] - centres[None, :]
    meets = (abs(between.real) < reach[..., :1]) & (abs(between.imag) < reach[..., 1:])
    meets[range(len(half)), range(len(half))] = False
    return meets


def _on_lines(half, centres, segments):
    """Whether a label lies on something drawn: label, instant."""
    a, b = segments
    steps = np.linspace(0.0, 1.0, 41)
    for place, (wide, tall) in zip(centres, half, strict=True):
        off = (a[..., None] + (b - a)[..., None] * steps) - place[:, None, None]
        yield ((abs(off.real) < wide) & (abs(off.imag) < tall)).any(axis=(1, 2))


@few_moving
def test_labels_on_the_move_lie_on_no_label_and_hardly_ever_on_a_line(name, ridden):
    """Counted at every instant; a label that a line must pass under has a white rim."""
    COURSE[name].variant(1).animation().drawing(("position",))
    assert _on_one_another(ridden["half"], ridden["centres"]).mean() < 0.001
    assert np.mean(list(_on_lines(**ridden))) < 0.06


@pytest.mark.parametrize(("name", "seed"), [("havens_planetary", 2), ("quick_return_whitworth", 2)])
def test_names_of_a_still_lie_on_no_other_name_and_on_no_vector(name, seed, ridden):
    moved = COURSE[name].variant(seed).animation(("velocity",))
    moved.stills(4, (82.0, 60.0))
    half, centres = ridden["half"], ridden["centres"]
    assert centres.shape[1] == 4
    assert not _on_one_another(half, centres).any()
    # The vectors come last; a crowded picture has names at its first instant alone.
    vectors = tuple(ends[:1, -len(moved.points) :] for ends in ridden["segments"])
    assert not np.any(list(_on_lines(half, centres[:, :1], vectors)))


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


@pytest.mark.parametrize(("top", "stands"), [(10j, True), (3 + 10j, False)])
def test_the_distance_of_two_fixed_lines_stands_where_the_piston_does_not_reach(top, stands):
    """That of two points of a body goes with it."""
    frames = [(link(0, x), dimension(x, x + top, "e", offset=0)) for x in (40.0, 60.0, 50.0)]
    shown = drawing(frames)
    assert (sum(t.moves for t in shown.tracks) == 1) is stands  # the link alone
    still = [t for t in shown.tracks if not t.moves and not t.mark]
    assert {round((x + shown.corner.real) / shown.scale) for t in still for x in t.numbers[0, 0::2]} == (
        {60} if stands else set()
    )


def test_an_element_that_is_not_always_there_is_left_out():
    frames = [(link(0, 50), pin(50, "A")), (link(0, 50j),), (link(0, -50), pin(-50, "A"))]
    assert len(drawing(frames).tracks) == 1


def test_the_command_writes_both_files(tmp_path, capsys):
    assert (
        run([*"animate slotted_mechanism --seed 3 --effects velocity,coriolis --out".split(), str(tmp_path)])
        == 0
    )
    assert {p.name for p in tmp_path.iterdir()} == {"slotted_mechanism.svg", "slotted_mechanism.html"}
    assert "Coriolis" not in (tmp_path / "slotted_mechanism.svg").read_text("utf-8")  # letters are outlines
    assert run(["animate", "slotted_mechanism", "--effects", "colour", "--out", str(tmp_path)]) == 2
    assert "no effect 'colour'" in capsys.readouterr().err


@pytest.mark.parametrize("name", sampled(["slotted_mechanism", "ball_reducer"]))
def test_a_notebook_shows_the_moving_picture(name):
    shown = coursework.show_motion(COURSE[name].variant(1))
    assert shown._repr_html_().startswith('<img src="data:image/svg+xml;base64,')


def test_stills_have_no_room_for_lengths_and_angles():
    """They keep the figure's points and bodies: as many drawn things but its labels of sizes."""
    shaper = animation("three_loop_shaper", 2)
    frame = shaper.frames[0]
    bare = _without_sizes(frame)
    assert any(isinstance(one, angle_mark) for one in frame)
    assert not any(isinstance(one, (angle_mark, dimension)) for one in bare)
    assert [one.label for one in bare if isinstance(one, pin)] == [
        one.label for one in frame if isinstance(one, pin)
    ]
    assert any(isinstance(one, bar) and one.label for one in frame)
    assert not any(isinstance(one, bar) and one.label and not one.label.isdigit() for one in bare)
    assert len(shaper.stills(4, (80.0, 46.0))) == 4
