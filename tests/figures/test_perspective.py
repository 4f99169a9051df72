"""Joints in space are seen from where they are told apart, each with the symbol of its kind."""

from itertools import combinations, product

from tables import each_row

import coursework
from coursework.figures.perspective import _DRAWN, _VIEWS, _face, _looking, in_perspective
from coursework.figures.placing import distance
from coursework.structure.spatial_chains import FREEDOMS

COURSE = coursework.open_course()


def rows(*joints):
    return [
        {"number": k, "bodies": (k - 1, k), "joint": kind, "along": along, "point": place, "freedoms": 1}
        for k, (kind, along, place) in enumerate(joints, 1)
    ]


def named(figure):
    """Where each named point is drawn, mm on paper."""
    return {it.label: it.p * figure.scale for it in figure.elements if type(it).__name__ == "point"}


def test_every_view_is_of_right_handed_axes_and_shows_each_by_at_least_a_quarter_of_its_length():
    for view in _VIEWS:
        see, forward = _looking(*view)
        x, y, z = (see(unit) for unit in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
        assert all(0.25 < abs(one) < 1 for one in (x, y, z))
        assert forward[0] > 0
        # Lengths across the line of sight are kept, and the axes turn as they should.
        assert abs(x**2 + y**2 + z**2) < 1e-12
        assert abs(abs(x) ** 2 + abs(y) ** 2 + abs(z) ** 2 - 2) < 1e-12
        assert (x.conjugate() * y).imag * forward[2] > 0


@each_row("along", "xyz")
def test_every_kind_of_joint_has_a_symbol_of_its_own(along):
    drawn = {
        kind: in_perspective(rows((kind, along, (0, 0, 0)), ("spherical", "x", (0, 40, 0)))).svg()
        for kind in FREEDOMS
        if kind in _DRAWN
    }
    assert len(set(drawn.values())) == len(_DRAWN) == 10
    for name in ("closed_chain", "serial_joints", "parallel_joints"):
        assert set(COURSE[name].spec.given["joint_1"].choices) <= set(_DRAWN)


def test_a_thread_lies_on_its_cylinder_and_a_pin_is_seen_beside_its_ball():
    for view, u in product(_VIEWS, ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))):
        see, forward = _looking(*view)
        # Plain lines are drawn beneath the sides of symbols.
        *_, thread = _DRAWN["helical"][0]((0, 0, 0), u, see, forward, 1.0)
        assert isinstance(thread, _face)
        pin, ball = _DRAWN["spherical_pin"][0]((0, 0, 0), u, see, forward, 1.0)
        assert abs(pin.points[0] - ball.center) > 1.3 * ball.radius


@each_row("seed", range(1, 41))
def test_points_and_bodies_of_a_chain_are_apart_on_paper(seed):
    variant = COURSE["closed_chain"].variant(seed)
    figure = variant.figure
    points = named(figure)
    ends = [points[name] for k in range(1, 5) for name in points if f"A_{k}" in name.split("=")]
    assert all(abs(p - q) > 4 for p, q in combinations(points.values(), 2))
    for k in range(4):
        p, q = ends[k], ends[(k + 1) % 4]
        for other in points.values():
            if p != q and min(abs(other - p), abs(other - q)) > 1:
                assert distance(other, p, q) > 1.0
