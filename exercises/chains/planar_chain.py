"""A closed chain taken as plane: what each joint is in the plane, and what the plane study does not see."""

import numpy as np

from coursework.figures import Figure, axes, line, note, point
from coursework.model import Exercise, Part, chosen, drawn

from ._solids import INCLINED, direction, freedoms_of, mobility_of_loops, table

PLANAR = ("revolute", "prismatic", "point_contact", "free")

#: The joints that are drawn; those with one motion only are in the plane for some of their directions.
JOINTS = (
    "revolute",
    "prismatic",
    "cylindrical",
    "spherical",
    "planar",
    "annular",
    "line_contact",
    "point_contact",
)


#: With the frame, joints of few freedoms: otherwise hardly a chain would be hyperstatic.
WITH_FRAME = ("revolute", "prismatic", "cylindrical")


def _has_plane_motion(joint, along):
    """In the plane xy: turning about z, sliding in the plane; a line contact with its normal in the plane."""
    turns_away = (joint == "revolute") & (along != "z")
    slides_away = (joint == "prismatic") & (along == "z")
    stands_up = (joint == "line_contact") & (along == "y")  # its normal is along z
    return ~(turns_away | slides_away | stands_up)


def all_joints_move_in_the_plane(
    joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4
):
    return (
        _has_plane_motion(joint_1, direction_1)
        & _has_plane_motion(joint_2, direction_2)
        & _has_plane_motion(joint_3, direction_3)
        & _has_plane_motion(joint_4, direction_4)
    )


def _is_free(joint, along):
    return ((joint == "planar") | (joint == "point_contact")) & (along == "z")


def one_joint_at_most_is_free(
    joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4
):
    """A joint that hinders nothing makes the rest of the loop idle."""
    free = [
        _is_free(joint, along)
        for joint, along in (
            (joint_1, direction_1),
            (joint_2, direction_2),
            (joint_3, direction_3),
            (joint_4, direction_4),
        )
    ]
    return np.sum(free, axis=0) <= 1


def few_freedoms_in_space(joint_1, joint_2, joint_3, joint_4):
    """With many, a chain is isostatic in space as well, and there is nothing to compare."""
    return sum(freedoms_of(joint) for joint in (joint_1, joint_2, joint_3, joint_4)) <= 8


def tells(
    joint_1,
    direction_1,
    joint_2,
    direction_2,
    joint_3,
    direction_3,
    joint_4,
    direction_4,
    x2,
    y2,
    x3,
    y3,
    x4,
    y4,
):
    """The lines of the table."""
    names = (joint_1, joint_2, joint_3, joint_4)
    along = (direction_1, direction_2, direction_3, direction_4)
    places = ((0, 0), (x2, y2), (x3, y3), (x4, y4))
    return {
        "joints": [
            {"x": int(x), "y": int(y), **row}
            for row, (x, y) in zip(_rows(names, along, places), places, strict=True)
        ]
    }


def _rows(names, along, places):
    around = zip(names, along, places, strict=True)
    return table(*[((k, (k + 1) % 4), name, way, (x, y, 0)) for k, (name, way, (x, y)) in enumerate(around)])


def figure(x2, y2, x3, y3, x4, y4):
    """The bodies between their joints, whatever these are."""
    points = (0j, complex(x2, y2), complex(x3, y3), complex(x4, y4))
    middle = sum(points) / 4
    elements = [axes(complex(-25, -25), 30)]
    for k, (p, q) in enumerate(zip(points, (*points[1:], points[0]), strict=True), start=1):
        away = (p + q) / 2 - middle
        elements.append(line(p, q, dashed=k == 4, thin=False))
        elements.append(note((p + q) / 2 + 9 * away / abs(away), f"S_{k % 4}"))
    elements += [
        point(p, f"A_{k}", toward=float(np.degrees(np.angle(p - middle))))
        for k, p in enumerate(points, start=1)
    ]
    return Figure(*elements)


def mobility(
    joint_1,
    direction_1,
    joint_2,
    direction_2,
    joint_3,
    direction_3,
    joint_4,
    direction_4,
    x2,
    y2,
    x3,
    y3,
    x4,
    y4,
):
    """In the plane, at the given position."""
    return mobility_of_loops(
        [[1]] * 4,
        (joint_1, joint_2, joint_3, joint_4),
        (direction_1, direction_2, direction_3, direction_4),
        ((0, 0, 0), (x2, y2, 0), (x3, y3, 0), (x4, y4, 0)),
        in_plane=True,
    )


def moves(mobility):
    return mobility >= 1


def mobility_is_small(mobility):
    return mobility <= 3


EXERCISE = Exercise(
    given={
        **{
            name: spec
            for k in (1, 2, 3, 4)
            for name, spec in (
                (f"joint_{k}", chosen(*(JOINTS if k in (2, 3) else WITH_FRAME), shown=False)),
                (f"direction_{k}", direction(*(INCLINED if k == 2 else ()))),
            )
        },
        "x2": drawn(-20, 20, step=20, unit="mm", shown=False),
        "y2": drawn(40, 80, step=20, unit="mm", shown=False),
        "x3": drawn(80, 120, step=20, unit="mm", shown=False),
        "y3": drawn(40, 100, step=20, unit="mm", shown=False),
        "x4": drawn(80, 140, step=20, unit="mm", shown=False),
        "y4": drawn(-20, 0, step=20, unit="mm", shown=False),
    },
    helpers=(mobility,),
    constraints=(
        all_joints_move_in_the_plane,
        one_joint_at_most_is_free,
        few_freedoms_in_space,
        moves,
        mobility_is_small,
    ),
    parts=(
        *(Part(f"planar_{k}", kind="choice", choices=PLANAR, points=1) for k in (1, 2, 3, 4)),
        Part("gamma", kind="integer", points=1, by_request=True),  # one loop, always
        Part("Nc", kind="integer", points=0.5),
        Part("rc", kind="integer", points=0.5),
        Part("m", kind="integer", points=0.5),
        Part("Ns", kind="integer", points=0.5),
        Part("rs", kind="integer", points=0.5),
        Part("h", kind="integer", points=0.5),
        Part("h_space", kind="integer", points=5),
        Part("comparison", kind="choice", choices=("sound", "hidden", "plane"), points=2),
    ),
    tells=tells,
    version=3,
    figure=figure,
    symbols={
        "Nc": "N_c",
        "rc": "r_c",
        "Ns": "N_s",
        "rs": "r_s",
        "h_space": r"h_{\mathrm{3D}}",
    },
)
