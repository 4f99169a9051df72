"""Havens planetary gear, constructed: five velocities drawn from that of A1, each with its reason."""

from coursework.degrees import polar
from coursework.model import Exercise, Part, drawn, in_turn

from .._drawn import all_long, on_paper, told_angle, told_number
from .havens_planetary import arm, figure

REASONS = ("fixed_pivot", "slot", "translation", "composition", "no_slip", "equiprojectivity")


def guide_turns_fully(d, r2, r3):
    return (0.2 * (r2 + r3) < d) & (d < 0.8 * (r2 + r3))


def crank_off_the_axes(theta1):
    return theta1 % 90 != 0


def crank_turns_visibly(omega1):
    return abs(omega1) >= 2


def equiprojectivity_tells(arm, r2, r3, b, theta1):
    """The line B2 I is far enough from the crank to find the length of what is square to it."""
    crank = polar(1.0, theta1)
    line = (r2 * crank + b * arm / abs(arm)) / crank
    return abs(line.imag) > 0.35 * abs(line)


def vectors_are_long_enough_to_draw(v10, v40, v24, v20, v30):
    """The shortest is a sixth of the longest at least."""
    return all_long(1 / 6, *map(on_paper, (v10, v40, v24, v20, v30)))


def tells(d, r2, r3, b, theta1):
    guide, crank = arm(d, r2, r3, theta1), polar(1.0, theta1)
    return {
        "theta4": told_angle(guide),
        "rA": told_number(abs(guide)),
        "line": told_angle(-r2 * crank - b * guide / abs(guide)),
    }


def _reason(quantity):
    return Part(quantity, kind="choice", choices=REASONS)


def _vector(quantity, points=1):
    return Part(quantity, unit="mm", kind="point", points=points, judge="drawing")


def _read(quantity, unit):
    return Part(quantity, unit=unit, judge="drawing")


WHY = in_turn(
    3,
    ("r2", "theta1", "omega1"),
    *map(_reason, ("why_v40", "why_v14", "why_v24", "why_v20", "why_v30")),
)

EXERCISE = Exercise(
    given={
        "r2": drawn(20, 40, step=2, unit="mm"),
        "r3": drawn(20, 40, step=2, unit="mm"),
        "d": drawn(lambda r2, r3: 0.2 * (r2 + r3), lambda r2, r3: 0.8 * (r2 + r3), unit="mm", positive=True),
        "b": drawn(30, 70, step=2, unit="mm"),
        "theta1": drawn(-175, 180, step=5, unit="deg"),
        "omega1": drawn(-20, 20, unit="rad/s"),
    },
    helpers=(arm,),
    constraints=(
        guide_turns_fully,
        crank_off_the_axes,
        crank_turns_visibly,
        equiprojectivity_tells,
        vectors_are_long_enough_to_draw,
    ),
    parts=(
        _read("kv", "mm/s/mm"),
        _vector("v10"),
        _vector("v40", 2),
        WHY[0],
        _vector("v14", 2),
        WHY[1],
        _vector("v24", 1),
        WHY[2],
        _vector("v20", 2),
        WHY[3],
        _vector("v30", 2),
        WHY[4],
        _read("omega4", "rad/s"),
        _read("omega3", "rad/s"),
    ),
    figure=figure,
    tells=tells,
    drawing_mm=(160, 80),
    version=2,
    symbols={
        "kv": "k_v",
        "v10": r"\vec V_{1/0}(A_1)",
        "v40": r"\vec V_{4/0}(A_1)",
        "v14": r"\vec V_{1/4}(A_1)",
        "v24": r"\vec V_{2/4}(B_2)",
        "v20": r"\vec V_{2/0}(B_2)",
        "v30": r"\vec V_{3/0}(I)",
    },
)
