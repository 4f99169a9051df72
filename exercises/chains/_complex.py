"""The mechanisms of complex_chain: plane linkages whose joints are those of solids in space."""

from typing import NamedTuple


class Layout(NamedTuple):
    """Bodies between which each joint lies, by place of the joint, and the body of the output; body 1 is the
    input."""

    between: tuple[tuple[int, int], ...]
    output: int

    @property
    def senses(self):
        """A row a joint: in each independent loop, whether it is met along, against or not."""
        paths, closing = {0: {}}, []
        for number, (one, other) in enumerate(self.between):
            if one in paths and other not in paths:
                paths[other] = {**paths[one], number: 1}
            else:
                closing.append((number, one, other))
        loops = [
            {
                k: (k == number) + paths[one].get(k, 0) - paths[other].get(k, 0)
                for k in range(len(self.between))
            }
            for number, one, other in closing
        ]
        return [[loop[k] for loop in loops] for k in range(len(self.between))]


_FOUR_BAR = ((0, 1), (1, 2), (2, 3), (3, 0))

#: Joints 1 to 4 are those of a four-bar O, A, B, C; joint 5 is at D, 6 at E, 7 at E and 8 at F.
LAYOUTS = {
    "rocker_slider": Layout((*_FOUR_BAR, (3, 4), (4, 5), (5, 0)), 5),
    "coupler_slider": Layout((*_FOUR_BAR, (2, 4), (4, 5), (5, 0)), 5),
    "two_guides": Layout((*_FOUR_BAR, (3, 4), (4, 5), (5, 0), (5, 0)), 5),
    "strut": Layout((*_FOUR_BAR, (3, 4), (4, 0)), 3),
}

POINTS = ("O", "A", "B", "C", "D", "E", "E", "F")  #: of the joints, in order
DIRECTIONS = ("z",) * 6 + ("x",) * 2


def points_of(xA, yA, xB, yB, xC, xD, yD, xE, yE):
    """Of each joint, x, y, z in mm; the second guide is 60 mm beyond the first."""
    E = (xE, yE, 0)
    return (0, 0, 0), (xA, yA, 0), (xB, yB, 0), (xC, 0, 0), (xD, yD, 0), E, E, (xE + 60, yE, 0)
