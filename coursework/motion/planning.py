"""What a scene is going to evaluate, and why: said before anything is computed."""

from __future__ import annotations

from collections.abc import Iterator

from coursework.errors import counted
from coursework.motion import shown
from coursework.motion.effects import ADVANTAGE, KINEMATIC
from coursework.motion.scenes import INERTIA, Scene


def plan(scene: Scene) -> list[tuple[str, str]]:
    """What is evaluated at every instant and why, in order; the last lines say what is left out."""
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
    kinds = [shown.what(name)[0] for name in scene.extra]
    forces = any(not kind or kind == shown.REACTION for kind in kinds)
    if forces or set(kinds) - {"position"}:
        yield f"rates of the bodies ({counted(linkage.unknowns, 'unknown')})", "virtual power, velocities"
    if "acceleration" in kinds or (forces and scene.forces.needs_bends):
        why = "the effect inertia" if forces and scene.forces.needs_bends else "accelerations shown"
        yield "second derivatives of the bodies' angles", why
    if forces:
        yield from _of_forces(scene, shown.REACTION in kinds)


def _of_forces(scene: Scene, asked: bool) -> Iterator[tuple[str, str]]:
    forces, bodies = scene.forces, len(scene.linkage.origins)
    yield "the drive's effort by virtual power", "forces are called"
    if asked or forces.contacts:
        why = "reactions are shown" if asked else "friction follows what joints bear"
        yield f"equilibrium of {bodies} bodies, {3 * bodies} equations an instant", why
    if forces.contacts:
        names = dict.fromkeys(c.joint.name.removesuffix(" slide") for c in forces.contacts)
        yield f"friction by iteration at {', '.join(names)}", "the effect friction"


def _left_out(scene: Scene) -> Iterator[tuple[str, str]]:
    """What no effect of the scene needs."""
    if "acceleration" not in scene.called and INERTIA not in scene.called and "coriolis" not in scene.called:
        yield "no acceleration", "no effect needs one"
    if not any(e not in (*KINEMATIC, ADVANTAGE) for e in scene.called):
        yield "no force", "no effect needs one"
