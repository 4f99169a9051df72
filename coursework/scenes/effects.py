"""Effects that a scene may request, and the quantities that an exercise shows of each.

What belongs to an effect is what the solution's ``EFFECTS`` say. Of an effect that they leave out: the
unknowns of the loops are positions, and their rates are velocities and accelerations; without loops, of the
parts asked, those are positions that move with the driver's angle alone, velocities those that its speed
changes, accelerations those that its acceleration changes.
"""

from __future__ import annotations

from collections.abc import Mapping

from coursework.course.exercise import CourseExercise
from coursework.errors import WrongValue, unknown
from coursework.messages import Message
from coursework.model import Driver

KINEMATIC = ("position", "velocity", "acceleration", "coriolis")
ADVANTAGE = "advantage"
FORCES = ("load", "gravity", "inertia", "friction", "flywheel")
EFFECTS = (*KINEMATIC, ADVANTAGE, *FORCES)
#: What a scene of forces shows of the exercise's own quantities.
OF_FORCES = "forces"
#: What is never simulated, and what is said of it.
REFUSED = ("impact", "impacts", "clearance", "clearances", "play", "backlash")


def refusal(name: str) -> Message:
    """Return the message for an effect that is never simulated."""
    return Message(
        "{name}: impacts and clearances are not simulated; joints have no play, and nothing strikes",
        name=name,
    )


def check_turns(what: str, exercise: CourseExercise) -> None:
    """Refuse what belongs to a crank, where a jack drives.

    Raises
    ------
    WrongValue
        It names the length that drives.
    """
    jack = exercise.spec.driver.jack if exercise.spec.driver else None
    if jack is not None:
        raise WrongValue(
            "{what} belongs to a crank that turns; {exercise} is driven by the length {length} of a "
            "jack, from {shortest} to "
            "{longest}",
            what=Message(what),
            exercise=exercise.name,
            length=jack.length,
            shortest=jack.limits[0],
            longest=jack.limits[1],
        )


def check_effect(effect: str, exercise: CourseExercise) -> None:
    """Refuse an unknown effect.

    Raises
    ------
    WrongValue
        Impacts and clearances; a flywheel where a jack drives.
    UnknownName
        Any other.
    """
    if effect in REFUSED:
        raise WrongValue(refusal(effect))
    if effect == "flywheel":
        check_turns("a flywheel", exercise)
    names = (*EFFECTS, *exercise.solution.graph.effects())
    if effect not in names:
        raise unknown("effect", effect, names, exercise.name)


def of_exercise(exercise: CourseExercise, driver: Driver) -> Mapping[str, tuple[str, ...]]:
    """Return the quantities of each effect, in order."""
    stated = exercise.solution.effects
    usual = _of_loops(exercise) if exercise.solution.loops else _of_parts(exercise, driver)
    given = exercise.spec.given
    results = {
        effect: tuple(name for name in names if name not in given and name != driver.moved)
        for effect, names in usual.items()
    }
    return {**results, **stated}


def _of_loops(exercise: CourseExercise) -> dict[str, tuple[str, ...]]:
    computed = exercise.solution.graph.quantities
    loops = exercise.solution.loops.values()
    unknowns = tuple(n for n in dict.fromkeys(n for loop in loops for n in loop.names) if n in computed)
    rates = {name: pair for loop in loops for name, pair in loop.rates.items()}
    first, second = (
        tuple(rates[n][order] for n in unknowns if n in rates and rates[n][order] in computed)
        for order in (0, 1)
    )
    return {"position": unknowns, "velocity": first, "acceleration": second}


def _of_parts(exercise: CourseExercise, driver: Driver) -> dict[str, tuple[str, ...]]:
    graph = exercise.solution.graph
    requested = [p.quantity for p in exercise.spec.parts if p.sort.is_number]
    speed, acceleration = driver.speed, driver.acceleration
    moving, fast, faster = (graph.descendants((n,) if n else ()) for n in (driver.angle, speed, acceleration))
    return {
        "position": tuple(n for n in requested if n in moving and n not in fast | faster),
        "velocity": tuple(n for n in requested if n in fast and n not in faster),
        "acceleration": tuple(n for n in requested if n in faster),
    }
