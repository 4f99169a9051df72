"""Plan of a scene: the quantities to evaluate and the reasons, before anything is computed."""

from __future__ import annotations

from collections.abc import Iterator

from coursework.errors import counted
from coursework.scenes import shown
from coursework.scenes.effects import ADVANTAGE, KINEMATIC
from coursework.scenes.scenes import Scene
from coursework.scenes.staged import INERTIA


def plan(scene: Scene) -> list[tuple[str, str]]:
    """Return the quantities evaluated at every instant with their reasons, in order, then those left out."""
    return [*_of_exercise(scene), *_of_mechanism(scene), *_left_out(scene)]


def _of_exercise(scene: Scene) -> Iterator[tuple[str, str]]:
    graph = scene.exercise.solution.graph
    met: list[str] = []
    for effect in scene.called:
        wanted = [n for n in scene.quantities if n in scene.shown_by(effect)]
        if wanted:
            yield from _quantities(scene, wanted, f"{effect}: {', '.join(wanted)}", met)
    named = [n for n in scene.show if n in graph.names]
    if named:
        yield from _quantities(scene, named, f"named to be shown: {', '.join(named)}", met)


def _quantities(scene: Scene, wanted: list[str], why: str, met: list[str]) -> Iterator[tuple[str, str]]:
    new = [n for n in scene.evaluated(wanted) if n not in met]
    met += new
    once = " (once, not at every instant)" if set(wanted) <= scene.constants else ""
    yield ", ".join(new) or "nothing more", why + once


def _of_mechanism(scene: Scene) -> Iterator[tuple[str, str]]:
    if not scene.extra or scene.exercise.solution.mechanism is None:
        return
    linkage, wanted = scene.linkage, ", ".join(scene.extra)
    angles = [n for n in linkage.mechanism.angles if n != scene.driver.angle]
    yield ", ".join(angles) or "the driver's angle", f"how the bodies stand: {wanted}"
    kinds = {shown.split_request(name)[0] for name in scene.extra}
    forces = bool(kinds & {"", shown.REACTION})
    bends = forces and INERTIA in scene.effects and bool(linkage.masses)
    if forces or kinds - {"position"}:
        yield f"rates of the bodies ({counted(linkage.unknowns, 'unknown')})", "virtual power, velocities"
    if "acceleration" in kinds or bends:
        why = "the effect inertia" if bends else "accelerations shown"
        yield "second derivatives of the bodies' angles", why
    if forces:
        yield from _of_forces(scene, shown.REACTION in kinds)


def _of_forces(scene: Scene, requested: bool) -> Iterator[tuple[str, str]]:
    bodies = len(scene.linkage.origins)
    for load in scene.mechanism.loads if "load" in scene.effects else ():
        yield f"the load on {load.on}", "the effect load"
    yield "the drive's effort by virtual power", "forces are called"
    if requested or scene.contacts:
        why = "reactions are shown" if requested else "friction follows what joints bear"
        yield f"equilibrium of {bodies} bodies, {3 * bodies} equations an instant", why
    if scene.contacts:
        names = dict.fromkeys(c.joint.name.removesuffix(" slide") for c in scene.contacts)
        yield f"friction by iteration at {', '.join(names)}", "the effect friction"


def _left_out(scene: Scene) -> Iterator[tuple[str, str]]:
    """Yield what no effect of the scene and no shown quantity requires."""
    kinds = {shown.split_request(name)[0] for name in scene.extra}
    bent = {"acceleration", "coriolis", INERTIA} & {*scene.called, *kinds}
    values = scene.evaluated(scene.quantities)
    if not bent and not set(values) & set(scene.accelerations):
        yield "no acceleration", "no effect needs one"
    if not kinds & {"", shown.REACTION} and not any(e not in (*KINEMATIC, ADVANTAGE) for e in scene.called):
        yield "no force", "no effect needs one"
