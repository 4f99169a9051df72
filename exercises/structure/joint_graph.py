"""The joint graph of a mechanism, read off its kinematic scheme: joints as a list, bodies, pairs, independent
cycles."""

from coursework.model import Exercise, Part, drawn
from coursework.structure.numbered import to_count
from coursework.structure.scheme import kinematic_scheme


def tells(mechanism):
    return {"joints": to_count(int(mechanism))}


def figure(mechanism):
    """The scheme, without letters: the joints are read off it."""
    return kinematic_scheme(to_count(int(mechanism)), letters=False)


EXERCISE = Exercise(
    given={"mechanism": drawn(1000, 999999, shown=False)},
    parts=(
        Part("graph", kind="graph", points=4),
        Part("N", kind="integer", points=1),
        Part("L", kind="integer", points=1),
        Part("gamma", kind="integer", points=1),
    ),
    tells=tells,
    figure=figure,
)
