"""A moving figure: its paths look smooth, its labels stand apart, and it tells no answer before it is
given."""

import json
import re
from itertools import pairwise

import numpy as np
import pytest
from animations import FILMED, MOVING, Page, animation
from sweeps import at_once

from coursework.figures.moving import extent
from coursework.figures.text import read
from coursework.rendering import motion_page

PX = 0.3  #: how far a trajectory is drawn from the true one at most
#: Pixels of a mm on paper: on a telephone of 390 pixels, and on a desk where the drawing fills its column.
SCREENS = {"telephone": lambda size: 356 / size[0], "desk": lambda size: min(736 / size[0], 576 / size[1])}
COUNTS = (0, 1, 6)  #: of what is sent: a flag, the seconds of a turn
STILL = [name for name in MOVING if name not in FILMED]


def distances(points, line):
    """Of points (complex) from a line through others."""
    p, q = line[:-1, None], line[1:, None]
    along = np.clip(((points - p) * (q - p).conj()).real / np.maximum(abs(q - p) ** 2, 1e-30), 0, 1)
    return abs(p + along * (q - p) - points).min(axis=0)


@pytest.mark.parametrize("name", MOVING)
def test_every_trajectory_looks_like_the_true_one(name):
    moved = animation(name, 1, "en")
    shown = moved.drawing(("position",))
    ends = (moved.angles[0], moved.angles[0] + 360 if moved.closed else moved.angles[-1])
    fine = np.linspace(*ends, 6007)
    true = moved.stated_points(fine)
    paths = {t.point: t for t in shown.tracks if t.effect == "position" and not t.mark and not t.is_label}
    assert paths.keys() == moved.points.keys()
    for point, path in paths.items():
        drawn = path.numbers[0, 0::2] + 1j * path.numbers[0, 1::2]
        drawn = np.append(drawn, drawn[0]) if path.closed else drawn
        x, y = np.moveaxis(shown.on_paper(true[point].position), -1, 0)
        worst = distances((x + 1j * y)[::7], drawn).max()
        for screen in SCREENS.values():
            assert worst * screen(shown.size) <= PX, point


@pytest.mark.parametrize("name", STILL)
def test_between_two_instants_no_link_leaves_its_way_visibly(name):
    moved = animation(name, 1, "en")
    low, high = extent(moved.frames)
    size = max((high - low).real, (high - low).imag)
    for (a, one), (b, two) in pairwise(zip(moved.angles, moved.frames, strict=True)):
        if b - a < 360 / 36 / 16:
            continue  # towards the limit of a swing
        middle = moved.elements_at(float(a + b) / 2)
        for p, q, r in zip(
            *([z for e in frame for bar in e.bars() for z in bar] for frame in (one, middle, two)),
            strict=True,
        ):
            assert abs(q - (p + r) / 2) < 1.2e-3 * size


@pytest.mark.parametrize("name", MOVING)
def test_no_two_labels_lie_on_each_other_where_a_figure_begins(name):
    moved = animation(name, 1, "en")
    for effects in ((), moved.available):
        labels = [t for t in moved.drawing(effects).tracks if t.is_label]
        centres = np.array([t.numbers[moved.first] @ (1, 1j) for t in labels])
        names = _labels_of(moved, effects)
        assert len(names) == len(centres)
        for k, (one, z) in enumerate(zip(names, centres, strict=True)):
            for other, w in zip(names[:k], centres[:k], strict=True):
                reach = (np.array(read(one).box) + read(other).box) / 2
                assert abs((z - w).real) >= reach[0] or abs((z - w).imag) >= reach[1], (one, other)


def _labels_of(moved, effects):
    from coursework.figures import moving

    seen = []

    def spy(rows, *rest):
        seen[:] = [row[0].label for row in rows]
        return kept(rows, *rest)

    kept, moving.ride = moving.ride, spy
    try:
        moved.drawing(effects)
    finally:
        moving.ride = kept
    return seen


def sent(name, seed, lang):
    """What is sent before a question is answered: the names of the page, and its data."""
    names = motion_page.context(animation(name, seed, lang), is_answered=False)
    return names, json.loads(str(names["data"]))


@pytest.mark.parametrize("name", STILL)
def test_before_the_answers_nothing_is_sent_but_the_figure_itself(name):
    names, data = sent(name, 1, "en")
    page = Page(f"<div>{names['drawing']}</div>")
    told = {"data-effect", "data-key", "data-point"}
    assert not [attributes for _, attributes in page.tags if told & attributes.keys()]
    assert (names["readings"], names["effects"], names["points"], data["readings"]) == ((), [], [], [])
    figure = [t for t in animation(name, 1, "en").drawing(()).tracks if t.moves]
    assert len(data["tracks"]) == len(figure)
    places = [x for track in data["tracks"] for row in track["rows"] for x in row]
    assert all(round(x, 1) == x for x in places)  # as one measures them on paper


@pytest.mark.parametrize("name", STILL)
def test_no_right_answer_stands_in_what_is_sent_before(name):
    """In what is sent but the figure, which is to scale, and the steps of a driver whose angle is given."""
    moved = animation(name, 1, "en")
    variant = moved.variant
    names, data = sent(name, 1, "en")
    if moved.driver in variant.given:
        data |= {"angles": [], "degrees": []}
        names["angle"] = ""
    told = {n: v for n, v in names.items() if n not in ("words", "said", "data", "drawing", "first", "count")}
    steps = ("tracks", "crank", "times", "order", "first", "count")
    text = json.dumps({n: v for n, v in data.items() if n not in steps}) + repr(told)
    numbers = [float(x.replace("−", "-")) for x in re.findall(r"[-−]?\d+(?:[.]\d+)?", text)]
    for part in variant.parts:
        value = variant.key.reference[part.quantity] if part.sort.is_number else None
        if isinstance(value, float) and abs(value) > 1e-9:
            near = max(part.atol, part.rtol * abs(value))
            assert not [x for x in numbers if abs(x - value) <= near and x not in COUNTS], part.id


@pytest.mark.parametrize("name", ["quick_return", "toggle_press", "jack_mechanism"])
def test_a_driving_angle_that_is_asked_is_counted_from_the_statement(name):
    names, data = sent(name, 1, "en")
    assert not names["is_told"]
    assert (data["degrees"][data["first"]], names["angle"]) == (0, "0°")
    assert all(x == round(x) for x in data["degrees"])


@at_once(STILL, STILL[::5])
def test_points_that_no_figure_names_are_not_shown(names):
    assert list(animation("four_bar_motion").points) == ["A", "B"]
    for name in names:
        moved = animation(name, 1, "en")
        assert moved.points.keys() <= {getattr(e, "label", "") for e in moved.frames[0]}


@pytest.mark.parametrize("name", MOVING)
def test_every_mechanism_has_a_handle_that_turns_with_its_driver(name):
    moved = animation(name, 1, "en")
    pivot, way = moved.crank
    arms = (way - pivot) / np.exp(1j * np.radians(moved.angles))
    assert abs(arms - arms[0]).max() < 1e-6 * abs(arms[0])
    assert abs(arms[0]) > 0
