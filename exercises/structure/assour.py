"""Assour groups of a mechanism, and its class for a driver (chapter 3, section 3.3.2)."""

from coursework.model import Exercise, Part, drawn
from coursework.structure.numbered import to_decompose
from coursework.structure.scheme import kinematic_scheme

CLASSES = ("I", "II", "III", "IV")


def tells(mechanism):
    found = to_decompose(int(mechanism))
    return {"joints": found.joints, "driver": found.driver, "body": found.body}


def figure(mechanism):
    """The scheme, with the motor as an arrow."""
    found = to_decompose(int(mechanism))
    return kinematic_scheme(found.joints, driver=found.driver)


EXERCISE = Exercise(
    given={"mechanism": drawn(1_000_000, 1_999_999, shown=False)},
    parts=(
        Part("group_count", kind="integer", points=1),
        Part("group_size", kind="integer", points=1),
        Part("group_class", kind="choice", choices=CLASSES, points=1),
        Part("assour_class", kind="choice", choices=CLASSES, points=2),
    ),
    symbols={"group_count": r"n_{\mathrm{g}}", "group_size": "k"},
    tells=tells,
    figure=figure,
    version=2,
)
