"""A mechanism of several loops: loops, ranks, mobility that is useful and internal, and what constraint
entails."""

import numpy as np

from coursework.figures import Figure, ground_pivot, line, link, note, pin, point, rail, slider
from coursework.model import Exercise, Part, chosen, drawn

from ._complex import DIRECTIONS, LAYOUTS, POINTS, points_of
from ._solids import mobility_of_loops

ON_FRAME = ("revolute", "cylindrical")
BETWEEN_BODIES = ("revolute", "cylindrical", "spherical", "annular")
GUIDES = ("prismatic", "cylindrical", "annular")


def four_bar_is_off_its_dead_points(xA, yA, xB, yB, xC):
    """Neither O, A, B nor A, B, C nearly in line; the crank and the rocker not nearly parallel."""
    in_line = abs(xA * (yB - yA) - yA * (xB - xA))
    rocker = abs((xB - xA) * (0 - yA) - (yB - yA) * (xC - xA))
    parallel = abs(xA * yB - yA * (xB - xC))
    return (in_line >= 1500) & (rocker >= 1500) & (parallel >= 800)


def tells(
    layout,
    joint_1,
    joint_2,
    joint_3,
    joint_4,
    joint_5,
    joint_6,
    joint_7,
    joint_8,
    xA,
    yA,
    xB,
    yB,
    xC,
    xD,
    yD,
    xE,
    yE,
):
    """The lines of the table, and the body of the output."""
    names = (joint_1, joint_2, joint_3, joint_4, joint_5, joint_6, joint_7, joint_8)
    points = points_of(xA, yA, xB, yB, xC, xD, yD, xE, yE)
    kind = LAYOUTS[layout]
    lines = zip(kind.between, names, POINTS, DIRECTIONS, points, strict=False)
    return {
        "joints": [
            {
                "bodies": sorted(between),
                "joint": name,
                "at": at,
                "along": along,
                "x": int(p[0]),
                "y": int(p[1]),
            }
            for between, name, at, along, p in lines
        ],
        "output": kind.output,
        "bodies": max(max(ends) for ends in kind.between),
        "layout": layout,
    }


def figure(layout, xA, yA, xB, yB, xC, xD, yD, xE, yE):
    """The skeleton in its plane; which joint is where, the table says."""
    O, A, B, C, D, E, _, F = (complex(x, y) for x, y, _ in points_of(xA, yA, xB, yB, xC, xD, yD, xE, yE))
    on_coupler = layout == "coupler_slider"
    elements = [
        link(O, A, label="S_1"),
        link(A, B, D, label="S_2") if on_coupler else link(A, B, label="S_2"),
        link(B, C) if on_coupler else link(B, C, D, label="S_3"),
        link(D, E, label="S_4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(D, "D"),
    ]
    if on_coupler:
        # Near C the bar is clear of the coupler's triangle.
        elements.append(note(0.25 * B + 0.75 * C + 12, "S_3"))
    if layout == "strut":
        return Figure(*elements, ground_pivot(E, "E"))
    end = F if layout == "two_guides" else E
    elements += [rail(E - 12, end + 12), slider(E), pin(E, "E", toward=90)]
    if layout == "two_guides":
        elements += [
            line(E, F, thin=False),
            slider(F),
            point(F, "F", toward=90),
            note((E + F) / 2 + 12j, "S_5"),
        ]
    else:
        elements.append(note(E + 22 + 8j, "S_5"))
    return Figure(*elements)


def mobility(
    layout,
    joint_1,
    joint_2,
    joint_3,
    joint_4,
    joint_5,
    joint_6,
    joint_7,
    joint_8,
    xA,
    yA,
    xB,
    yB,
    xC,
    xD,
    yD,
    xE,
    yE,
):
    """Of the whole chain, at the given position."""
    joints = (joint_1, joint_2, joint_3, joint_4, joint_5, joint_6, joint_7, joint_8)
    points = points_of(xA, yA, xB, yB, xC, xD, yD, xE, yE)
    layout = np.atleast_1d(layout)
    found = np.zeros(layout.shape, dtype=int)
    for name, kind in LAYOUTS.items():
        rows = layout == name
        count = len(kind.between)
        found[rows] = mobility_of_loops(
            kind.senses,
            [np.atleast_1d(joint)[rows] for joint in joints[:count]],
            DIRECTIONS[:count],
            [[np.broadcast_to(c, layout.shape)[rows] for c in point] for point in points[:count]],
        )
    return found


def mobility_is_small(mobility):
    return mobility <= 3


def _hidden(low, high):
    return drawn(low, high, step=20, unit="mm", shown=False)


EXERCISE = Exercise(
    given={
        "layout": chosen(*LAYOUTS, shown=False),
        **{
            f"joint_{k}": chosen(*names, shown=False)
            for k, names in enumerate(
                (ON_FRAME, *(BETWEEN_BODIES,) * 2, ON_FRAME, *(BETWEEN_BODIES,) * 2, GUIDES, GUIDES), start=1
            )
        },
        "xA": _hidden(-40, 20),
        "yA": _hidden(40, 60),
        "xB": _hidden(100, 140),
        "yB": _hidden(80, 120),
        "xC": _hidden(120, 160),
        "xD": _hidden(180, 220),
        "yD": _hidden(40, 80),
        "xE": _hidden(300, 340),
        "yE": _hidden(-20, 20),
    },
    helpers=(mobility,),
    constraints=(
        four_bar_is_off_its_dead_points,
        mobility_is_small,
    ),
    parts=(
        Part("n", kind="integer", points=1),
        Part("gamma", kind="integer", points=1),
        Part("Nc", kind="integer", points=1),
        Part("Ns", kind="integer", points=1),
        Part("i", kind="integer", points=1),
        Part("m", kind="integer", points=2),
        Part("m_internal", kind="integer", points=2),
        Part("m_useful", kind="integer", points=1),
        Part("role", kind="choice", choices=("clamp", "transforms", "adjusted"), points=1),
        Part("h", kind="integer", points=1),
        Part("rc", kind="integer", points=1),
        Part("statics", kind="choice", choices=("isostatic", "hyperstatic"), points=1),
    ),
    tells=tells,
    figure=figure,
    symbols={
        "Nc": "N_c",
        "rc": "r_c",
        "Ns": "N_s",
        "m_internal": "m_i",
        "m_useful": "m_u",
    },
)
