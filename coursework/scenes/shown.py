"""Quantities that a scene can show beside the exercise's own: motions of points, joint reactions, the drive.

``drive_torque``, or ``drive_thrust`` of a jack, ``drive_power``, ``kinetic_energy``; ``position B``,
``velocity B``, ``acceleration B``, ``coriolis A``; ``reaction B``, of a pin or a slide.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from coursework.errors import WrongValue, unknown
from coursework.mechanics.forces import ForceResults
from coursework.mechanics.linkage import MM, Linkage, SlideJoint
from coursework.mechanics.rates import Stance
from coursework.messages import Message
from coursework.solution import Moving

DRIVE = ("drive_torque", "drive_thrust", "drive_power", "kinetic_energy")
OF_POINTS = ("position", "velocity", "acceleration", "coriolis")
REACTION = "reaction"

Columns = dict[str, tuple[Any, str]]  #: values and unit, by name


def split_request(name: str) -> tuple[str, str]:
    """Split ``"velocity B"`` into the kind and the point or joint; the kind of a plain quantity is empty."""
    kind, _, of = name.strip().partition(" ")
    return (kind, of.strip()) if of and kind in (*OF_POINTS, REACTION) else ("", name.strip())


def check(name: str, linkage: Linkage, quantities: Iterable[str]) -> None:
    """Refuse a name that a scene cannot show.

    Raises
    ------
    UnknownName
        No such quantity, point or joint.
    """
    kind, of = split_request(name)
    if kind == REACTION:
        joints = [*joint_points(linkage)]
        if of not in joints:
            raise unknown("joint", of, joints, Message("the mechanism"))
    elif kind == "coriolis":
        if of not in [s.name.removesuffix(" slide") for s in turning_slides(linkage)]:
            raise WrongValue("no Coriolis term at {of}: no body slides there on one that turns", of=of)
    elif kind:
        if of not in linkage.mechanism.points:
            raise unknown("point", of, linkage.mechanism.points, Message("the mechanism"))
    elif of == "drive_thrust" and linkage.pushed is None:
        raise WrongValue(Message("no jack drives the mechanism; show drive_torque"))
    elif of == "drive_torque" and linkage.pushed is not None:
        raise WrongValue(Message("a jack drives the mechanism, not a crank; show drive_thrust"))
    elif of not in DRIVE and of not in quantities:
        kinds = [f"{kind} …" for kind in (*OF_POINTS, REACTION)]
        raise unknown("quantity to show", of, [*quantities, *DRIVE, *kinds])


def turning_slides(linkage: Linkage) -> tuple[SlideJoint, ...]:
    """Return the slides whose guide turns, where a Coriolis term exists."""
    return tuple(s for s in linkage.slides if linkage.coordinates[s.on] != -1)


def joint_points(linkage: Linkage) -> dict[str, list[str]]:
    """Return the joints at each point, by their names in a scene."""
    results: dict[str, list[str]] = {}
    names = [
        *(p.name for p in linkage.pins),
        *(s.name for s in linkage.slides),
        *(g.name for g in linkage.gears),
    ]
    for joint in names:
        for name in dict.fromkeys((joint, joint.split(" ")[0])):
            results.setdefault(name, []).append(joint)
    return results


def of_point(kind: str, point: str, stance: Stance, speed: np.ndarray, acceleration: np.ndarray) -> Columns:
    """Return two components and, for a rate, the magnitude: mm, mm/s, mm/s^2, in the ground's frame."""
    if kind == "coriolis":
        (slide,) = (s for s in turning_slides(stance.linkage) if s.name.removesuffix(" slide") == point)
        return {f"a_coriolis_{point}": (stance.coriolis(slide, speed) / MM, "mm/s^2")}
    body_point = stance.linkage.owner(point)
    if kind == "position":
        position = stance.place(body_point) / MM
        return {f"x_{point}": (position.real, "mm"), f"y_{point}": (position.imag, "mm")}
    if kind == "velocity":
        return _vector(f"v_{point}", stance.rate(body_point) * speed / MM, "mm/s")
    return _vector(f"a_{point}", stance.acceleration(body_point, speed, acceleration) / MM, "mm/s^2")


def of_moving(kind: str, point: str, moving: Moving) -> Columns:
    """Return the same columns for a point that a solution moves itself; empty where the solution leaves them
    out."""
    values = getattr(moving, kind)
    if values is None:
        return {}
    values = np.asarray(values, dtype=complex)
    if kind == "position":
        return {f"x_{point}": (values.real, "mm"), f"y_{point}": (values.imag, "mm")}
    letter, unit = {"velocity": ("v", "mm/s"), "acceleration": ("a", "mm/s^2")}[kind]
    return _vector(f"{letter}_{point}", values, unit)


def _vector(name: str, values: np.ndarray, unit: str) -> Columns:
    return {f"{name}_x": (values.real, unit), f"{name}_y": (values.imag, unit), name: (np.abs(values), unit)}


def of_joint(point: str, linkage: Linkage, borne: ForceResults) -> Columns:
    """Return the reactions of the joints at a point, on the body that slides or is pinned on."""
    results: Columns = {}
    for name in joint_points(linkage)[point]:
        results |= _of_one(name, borne.joints, borne.rubs)
    return results


def _of_one(name: str, joints: Mapping[str, np.ndarray], rubs: Mapping[str, np.ndarray]) -> Columns:
    """Return the force of a pin; the normal force, moment and friction of a slide; or the force of a gear."""
    label = name.removesuffix(" slide").replace(" ", "_")
    if f"{name}_x" in joints:
        force = joints[f"{name}_x"] + 1j * joints[f"{name}_y"]
        turned = {f"Mf_{label}": (rubs[name], "N*m")} if name in rubs else {}
        return {**_vector(f"R_{label}", force, "N"), **turned}
    if f"{name}_t" in joints:
        return {f"T_{label}": (joints[f"{name}_t"], "N")}
    rubbed = {f"T_{label}": (rubs[name], "N")} if name in rubs else {}
    bearing = {f"N_{label}": (joints[f"{name}_n"], "N"), f"M_{label}": (joints[f"{name}_m"], "N*m")}
    return {**bearing, **rubbed}
