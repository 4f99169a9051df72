"""Polygons as every exercise with rates states them.

What an exercise states is compared with its positions, differentiated numerically: no rate of the solution is
used.
"""

from __future__ import annotations

import numpy as np
import pytest
from animations import WITH_POINTS, points_at
from courses_polygons import COURSE, DRIVES, PLACES, constructions, every_exercise, variants


def test_every_exercise_that_asks_a_rate_states_its_polygons():
    """All but those whose rates are one vector or turn about one axis, or arrows each at its own point, or
    torsors in space."""
    asking = {
        name
        for name in COURSE.names
        if any(part.unit in ("mm/s", "mm/s^2", "rad/s", "rad/s^2") for part in COURSE[name].spec.parts)
    }
    stating = {name for name in COURSE.names if COURSE[name].solution.polygons is not None}
    one_vector = {"coriolis", "flat_faced_cam", "cam_follower", "gear_train", "epicyclic_train"}
    arrows = {"ball_reducer", "havens_construction"}
    in_space = {"joint_twist", "geometrical_closure"}
    assert asking - stating <= one_vector | arrows | in_space
    # Polygons that are themselves the answer are compared with those of these exercises elsewhere.
    assert {name for name in stating if not COURSE[name].spec.drawing_mm} == set(PLACES)


def derivatives(name, variant):
    """Velocity and acceleration of every point, from positions at nearby angles of the crank."""
    moved, crank, wanted, points = PLACES[name]
    given = dict(variant.used)
    velocity, gain = DRIVES.get(name, ("omega2", "alpha2"))
    samples = given[moved] + np.linspace(-0.4, 0.4, 9)
    found = variant.exercise.solve(**{**given, moved: samples}, only=wanted)
    values = {**given, moved: samples, **found}
    along = values[crank] if crank == "L" else np.radians(np.unwrap(values[crank], period=360))
    along = along - along[4]
    rate, growth = given[velocity], given.get(gain, 0.0)
    width = np.abs(along).max()
    for point, place in points(values).items():
        fit = np.polynomial.polynomial.polyfit(along / width, np.broadcast_to(place, along.shape), 6)
        first, second = fit[1] / width, 2 * fit[2] / width**2
        yield point, first * rate, second * rate**2 + first * growth


@every_exercise
def test_image_points_are_the_derivatives_of_the_positions(name):
    compared = set()
    for variant in variants(name):
        polygons = {drawn.polygon.kind: drawn.polygon for drawn in variant.polygons()}
        for point, velocity, acceleration in derivatives(name, variant):
            for kind, value in (("velocity", velocity), ("acceleration", acceleration)):
                if kind in polygons and point in polygons[kind].points:
                    compared.add((kind, point))
                    gap = abs(polygons[kind].points[point] - value)
                    assert gap < 1e-4 * polygons[kind].size, (variant, kind, point)
    kinds = {kind for kind, _ in compared}
    stated = {
        d.polygon.kind: {p[0] for p in d.polygon.points if "'" not in p} for d in variants(name)[0].polygons()
    }
    assert kinds == set(stated)
    for kind, letters in stated.items():
        # Every image of a point is compared, but the pole and the end of the Coriolis term.
        assert letters - {"p", "k"} <= {point[0] for which, point in compared if which == kind}


@every_exercise
def test_ruler_and_compasses_find_every_point(name):
    """The construction done again: known vectors laid off, lines drawn by their directions alone and
    crossed."""
    for drawn in constructions(name):
        polygon = drawn.polygon
        at, lines = {polygon.pole: 0j}, {}
        for stage in polygon.stages:
            for side in stage.sides[-1:] if stage.kind == "crossing" else stage.sides:
                known = [end for end in (side.start, side.end) if end in at]
                if stage.kind == "result":
                    assert len(known) == 2
                    continue
                assert len(known) == 1, f"{side} hangs on nothing that is drawn"
                other = side.end if known == [side.start] else side.start
                if stage.kind == "known":
                    at[other] = at[known[0]] + side.value * (1 if other == side.end else -1)
                    continue
                assert stage.through == known[0]
                lines.setdefault(other, []).append((at[known[0]], side.along))
                if stage.kind == "crossing":
                    (p, u), (q, v) = lines[other]
                    along = ((q - p) * v.conjugate()).imag / (u * v.conjugate()).imag
                    at[other] = p + along * u
        assert all(len(found) == 2 for found in lines.values())
        assert list(at) == list(polygon.points)
        for point, z in polygon.points.items():
            assert abs(at[point] - z) < 1e-6 * polygon.size


@pytest.mark.parametrize("name", [name for name in PLACES if name in WITH_POINTS])
def test_ways_round_the_polygon_agree_with_the_points_in_motion(name):
    """Where the solution moves points for animations, the pole sees them move as its polygon says."""
    exercise = COURSE[name]
    for variant in variants(name)[:5]:
        moving = points_at(exercise, variant.used, exercise.driver_angle(variant.used))
        for drawn in variant.polygons():
            for point, value in moving.items():
                image = {"A": "a_2"}.get(point, point.lower())
                image = image if image in drawn.polygon.points else point.lower()
                expected = getattr(value, drawn.polygon.kind)
                if image in drawn.polygon.points and expected is not None:
                    assert abs(drawn.polygon.points[image] - expected) < 1e-8 * drawn.polygon.size
