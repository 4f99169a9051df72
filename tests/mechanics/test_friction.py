"""Friction: which side bears, long slides, journals, and where a mechanism jams; worked by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import UnknownName
from coursework.mechanics.friction import contacts
from coursework.mechanics.statement import Load
from coursework.scenes.added import BodyMass, SceneData
from coursework.scenes.scenes import Scene

COURSE = coursework.open_course()
#: A 3-4-5 triangle: the crank upright, the rod falls by 3 over 4.
UPRIGHT = {
    "r2": 30.0,
    "r3": 50.0,
    "e": 0.0,
    "theta2": 90.0,
    "omega2": 2.0,
    "alpha2": 0.0,
    "kv": 1.0,
    "ka": 1.0,
}


def upright(friction, omega=2.0, force=-400.0, lengths=None, **added):
    data = SceneData(loads=(Load("B", force=force),), friction=friction, lengths=lengths or {}, **added)
    scene = Scene(
        COURSE["slider_crank"], {**UPRIGHT, "omega2": omega}, ("load", "friction"), ("reaction B",), data
    )
    return scene.forces.over(np.radians([90.0]), np.array([omega]), np.zeros(1), joints=True)


def test_friction_in_a_slide_helps_to_hold_and_hinders_to_push():
    """400 N on the piston: R (4/5 + 3/5 / 2) in the rod one way, R (4/5 - 3/5 / 2) the other; the torque is
    0.03 m R."""
    assert upright({"B": 0.5}).effort[0] == pytest.approx(-0.03 * 400 * 0.8 / (0.8 + 0.3), rel=1e-13)
    assert upright({"B": 0.5}, omega=-2.0).effort[0] == pytest.approx(
        -0.03 * 400 * 0.8 / (0.8 - 0.3), rel=1e-13
    )


def test_past_the_angle_of_friction_the_slide_jams_one_way_and_not_the_other():
    """f tan theta3 = 1 at f = 4/3."""
    assert np.isnan(upright({"B": 1.34}, omega=-2.0).effort[0])
    assert np.isfinite(upright({"B": 1.33}, omega=-2.0).effort[0])
    assert np.isfinite(upright({"B": 5.0}).effort[0])


def test_jamming_is_told_with_its_angle():
    data = SceneData(loads=(Load("B", force=-400.0),), friction={"B": 2.2})
    scene = Scene(COURSE["slider_crank"], {**UPRIGHT, "omega2": -2.0}, ("load", "friction"), (), data)
    table = scene.over_cycle(72)
    jammed = np.isnan(table.columns["drive_torque"])
    tangent = np.abs(0.6 * np.sin(np.radians(table.columns["theta2"])))
    rod = tangent / np.sqrt(1 - tangent**2)
    assert jammed.any()
    assert rod[jammed].min() > 1 / 2.2 - 0.02
    assert f"jams at theta2 = {table.columns['theta2'][jammed][0]:g}" in table.notes[0]


def test_a_long_slide_bears_on_both_of_its_edges():
    """A pure moment on the piston: the edges bear M / l each, one above and one below, and both rub."""
    data = SceneData(loads=(Load("4", moment=6.0),), friction={"B": 0.1}, lengths={"B": 60.0})
    scene = Scene(COURSE["slider_crank"], UPRIGHT, ("load", "friction"), (), data)
    borne = scene.forces.over(np.radians([90.0]), np.array([2.0]), np.zeros(1), joints=True)
    # The piston moves to -x; the friction of 2 x 0.1 x 100 N, and what the rod's obliquity adds, holds it
    # back.
    edges = 6.0 / 0.06
    friction = borne.rubs["B slide"][0]
    normal, moment = borne.joints["B slide_n"][0], borne.joints["B slide_m"][0]
    assert moment == pytest.approx(-6.0, rel=1e-12)
    assert friction == pytest.approx(
        0.1 * (abs(normal / 2 + moment / 0.06) + abs(normal / 2 - moment / 0.06)), rel=1e-12
    )
    assert friction == pytest.approx(
        0.1 * 2 * edges, rel=1e-12
    )  # the normal force is smaller than what the edges bear
    assert borne.effort[0] == pytest.approx(
        friction * 60.0 / 2.0 / 1000, rel=1e-12
    )  # power in, power lost: F v / omega
    short = Scene(
        COURSE["slider_crank"],
        UPRIGHT,
        ("load", "friction"),
        (),
        SceneData(loads=data.loads, friction=data.friction),
    )
    assert short.forces.over(np.radians([90.0]), np.array([2.0]), np.zeros(1)).effort[0] == pytest.approx(
        0.0, abs=1e-12
    )


@each_row("way", [1.0, -1.0])
def test_a_journal_takes_its_coefficient_times_its_radius_times_what_it_bears(way):
    """A weight on the crank's pin, friction in the shaft alone: the drive adds f r m g whichever way it
    turns."""
    data = SceneData(bodies={"2": BodyMass(mass=20.0)}, friction={"O": (0.1, 15.0)})
    given = {**UPRIGHT, "omega2": way}
    scene = Scene(COURSE["slider_crank"], given, ("gravity", "friction"), (), data)
    effort = scene.forces.over(np.radians([0.0, 70.0]), np.full(2, way), np.zeros(2)).effort
    np.testing.assert_allclose(effort, way * 0.1 * 0.015 * 20 * 9.81, rtol=1e-12)


def test_power_in_is_power_lost_with_friction_everywhere():
    """At a constant rate over a turn, what the drive gives is what the contacts rub away."""
    mechanism = COURSE["three_loop_shaper"].solution.mechanism
    friction = {"E": 0.1, "G": 0.15, "C": (0.1, 8.0), "D": (0.05, 10.0)}
    data = SceneData(
        {b: BodyMass(2.0, 0.01) for b in mechanism.names}, friction=friction, lengths={"G": 80.0}
    )
    scene = Scene(
        COURSE["three_loop_shaper"],
        COURSE["three_loop_shaper"].variant(0).used,
        ("gravity", "friction"),
        (),
        data,
    )
    q = (np.arange(360) + 0.3) * (math.tau / 360)
    speed = np.full(360, scene._speed)
    borne = scene.forces.over(q, speed, np.zeros(360), joints=True)
    stance = scene.pose(q)
    lost, rubs = np.zeros(360), iter(scene.forces.contacts)
    for contact in rubs:
        bears = np.zeros((360, len(contact.reads)))
        for column, row in enumerate(contact.reads):
            bears[:, column] = sum(borne.joints[name] * share for name, share in row.items())
        lost += contact.size * np.hypot.reduce(bears, axis=1) * np.abs(contact.rate(stance) * speed)
    gravity = scene.without("friction").forces.over(q, speed, np.zeros(360)).effort
    np.testing.assert_allclose(
        borne.effort * speed, gravity * speed + lost, rtol=1e-9, atol=1e-9 * lost.max()
    )
    assert lost.min() > 0


def test_a_joint_that_is_not_there_is_told():
    scene = Scene(COURSE["slider_crank"], UPRIGHT, ("friction",), (), SceneData(friction={"Q": 0.1}))
    with pytest.raises(UnknownName, match="no slide 'Q'"):
        contacts(scene.linkage, scene.mechanism.friction)
    added = SceneData(friction={"Q": (0.1, 5.0)})
    with pytest.raises(UnknownName, match="no pin 'Q'"):
        Scene(COURSE["slider_crank"], UPRIGHT, ("friction",), (), added).forces  # noqa: B018
