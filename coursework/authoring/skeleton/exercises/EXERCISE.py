"""A crank pin: where it is, and how fast it moves.

What is given and how it varies, what a good variant must satisfy, the picture, the questions.
The answers are those of the file of the same name in solutions/.
"""

from coursework.degrees import polar
from coursework.figures import Figure, angle_mark, axes, ground_pivot, link, pin
from coursework.model import Exercise, Part, drawn


def pin_off_the_axes(theta):
    """Return whether the draw is accepted; the parameters are quantities, given or computed, on arrays."""
    return theta % 90 >= 10


def figure(r, theta):
    O, A = 0, polar(r, theta)
    return Figure(
        axes(O, 1.2 * r),
        link(O, A, label="r"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        angle_mark(O, 0, theta, r"\theta"),
    )


EXERCISE = Exercise(
    given={
        "r": drawn(50, 200, step=5, unit="mm"),
        "theta": drawn(-175, 180, step=5, unit="deg"),
        "omega": drawn(2, 20, unit="rad/s"),
    },
    constraints=(pin_off_the_axes,),
    parts=(
        Part("x", unit="mm"),
        Part("y", unit="mm"),
        Part("v", unit="mm/s", points=2),
    ),
    figure=figure,
)
