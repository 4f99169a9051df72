"""Shaking force of a slider-crank: two masses for the rod, primary and secondary force, and a
counterweight."""

from coursework.degrees import polar
from coursework.figures import Figure, angle_mark, circle, ground_pivot, line, link, pin, point, rail, slider
from coursework.kinematics.dyads import rrp
from coursework.model import Exercise, Part, detectable, drawn


def rod(r2, r3, theta2):
    """Vector AB."""
    A = polar(r2, theta2)
    return rrp(A, r3, 0.0) - A


def crank_off_the_axes_and_bisectors(theta2):
    """Neither of the forces vanishes."""
    return abs((theta2 + 22.5) % 45 - 22.5) >= 5


def rod_is_lighter_than_all(m3, m4):
    return m3 < 1.5 * m4


def forces_on_the_frame_are_visible(X, Y, F1):
    return (abs(X) > 0.15 * abs(F1)) & (abs(Y) > 0.15 * abs(F1))


def figure(rod, r2, s3, rc, theta2):
    O, A = 0j, polar(r2, theta2)
    B, G, half_rail = A + rod, A + s3 * rod, 0.5 * r2
    weight = polar(rc, theta2 + 180)
    return Figure(
        rail(B - half_rail, B + half_rail),
        line(O, B.real + 1.6 * half_rail, dashed=True),
        link(O, A, label="r_2"),
        link(O, weight),
        circle(weight, 0.16 * r2, label="m_c"),
        link(A, B, label="r_3"),
        slider(B),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        point(G, "G"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


def _visible(mistake):
    return detectable(mistake, "F1", "F2", "mc", "X", "Y", least=2.2)


EXERCISE = Exercise(
    given={
        "r2": drawn(30, 60, step=1, unit="mm"),
        "r3": drawn(lambda r2: 3 * r2, lambda r2: 5 * r2, step=5, unit="mm", positive=True),
        "s3": drawn(0.25, 0.4, step=0.01),
        "m2": drawn(0.3, 1.2, step=0.05, unit="kg"),
        "m3": drawn(0.4, 1, step=0.05, unit="kg"),
        "m4": drawn(0.4, 1.2, step=0.05, unit="kg"),
        "k": drawn(0.4, 0.7, step=0.05),
        "rc": drawn(25, 60, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(100, 350, step=10, unit="rad/s", positive=True),
    },
    helpers=(rod,),
    constraints=(
        crank_off_the_axes_and_bisectors,
        rod_is_lighter_than_all,
        forces_on_the_frame_are_visible,
        *map(
            _visible,
            (
                "rod_shared_the_other_way",
                "rod_left_out",
                "single_angle",
                "obliquity_forgotten",
                "rotating_masses_only",
                "all_masses",
                "secondary_left_out",
                "counterweight_left_out",
            ),
        ),
    ),
    parts=(
        Part("mA", unit="kg", points=1),
        Part("mB", unit="kg", points=1),
        Part("F1", unit="N", points=2),
        Part("F2", unit="N", points=2),
        Part("mc", unit="kg", points=2),
        Part("X", unit="N", points=2),
        Part("Y", unit="N", points=1),
    ),
    symbols={"mA": "m_A", "mB": "m_B", "mc": "m_c", "rc": "r_c", "F1": "F_1", "F2": "F_2"},
    figure=figure,
)
