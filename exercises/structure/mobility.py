"""Structure of a mechanism: its bodies, pairs, mobility and independent cycles (chapter 3, equations 2 and
3)."""

from coursework.model import Exercise, Part, drawn
from coursework.structure.numbered import to_count
from coursework.structure.scheme import kinematic_scheme


def tells(mechanism):
    return {"joints": to_count(int(mechanism))}


def figure(mechanism):
    """The scheme, without letters: bodies and joints are counted on it."""
    return kinematic_scheme(to_count(int(mechanism)), letters=False)


EXERCISE = Exercise(
    given={"mechanism": drawn(1000, 999999, shown=False)},
    parts=(
        Part("n", kind="integer", points=1),
        Part("b", kind="integer", points=1),
        Part("h", kind="integer", points=1),
        Part("w", kind="integer", points=1),
        Part("L", kind="integer", points=1),
        Part("N", kind="integer", points=1),
        Part("gamma", kind="integer", points=1),
    ),
    tells=tells,
    figure=figure,
)
