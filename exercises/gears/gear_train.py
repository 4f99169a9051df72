"""Ordinary gear train: two stages, an idler, and an output wheel with outer or inner teeth."""

from coursework.degrees import polar
from coursework.figures import Figure, circle, ground_pivot, line, rotation_arrow, wheel
from coursework.model import Exercise, Part, chosen, detectable, drawn


def input_turns_visibly(omega1):
    return abs(omega1) >= 30


def wheels_of_one_shaft_differ(z3, z4):
    return z3 >= z4 + 10


def idler_is_no_twin(z1, z2, z3):
    """Its number of teeth, put where it does not belong, would show."""
    return (z2 != z1) & (z2 != z3)


def figure(z1, z2, z3, z4, z5, m, omega1, mode):
    R1, R2, R3, R4, R5 = (m * z / 2 for z in (z1, z2, z3, z4, z5))
    O1 = 0j
    O2 = O1 + polar(R1 + R2, 25)
    O3 = O2 + polar(R2 + R3, -20)
    inner = mode == "internal"
    O5 = O3 + (polar(R5 - R4, -65) if inner else polar(R4 + R5, 0))
    turn = 40 if omega1 > 0 else -40
    rim = (circle(O5, R5 + 3 * m),) if inner else ()
    return Figure(
        wheel(O1, R1, label="1"),
        wheel(O2, R2, label="2"),
        wheel(O3, R3, label="3"),
        *rim,
        circle(O5, R5, label="5") if inner else wheel(O5, R5, label="5"),
        circle(O3, R4, label="4"),
        line(O1, O2, dashed=True),
        line(O2, O3, dashed=True),
        line(O3, O5, dashed=True),
        *(ground_pivot(O) for O in (O1, O2, O3, O5)),
        rotation_arrow(O1, 0.65 * R1, 180 - turn, 180 + turn, r"\omega_1"),
        paper_mm=(110, 75),
    )


EXERCISE = Exercise(
    given={
        "z1": drawn(15, 26),
        "z2": drawn(20, 40),
        "z3": drawn(36, 60),
        "z4": drawn(15, 24),
        "z5": drawn(54, 96, step=2),
        "m": drawn(1, 3, step=0.5, unit="mm"),
        "omega1": drawn(-150, 150, step=2, unit="rad/s"),
        "Gamma1": drawn(2, 20, step=0.5, unit="N*m", shown=("Gamma5",)),
        "eta": drawn(0.94, 0.98, step=0.01),
        "mode": chosen("external", "internal"),
    },
    constraints=(
        input_turns_visibly,
        wheels_of_one_shaft_differ,
        idler_is_no_twin,
        *(
            detectable(mistake, "r", "omega2", "omega5", "a", "v", "Gamma5")
            for mistake in (
                "idler_for_the_wheel_it_drives",
                "all_in_a_row",
                "idler_by_the_wheel_after_it",
                "other_kind_of_teeth",
                "diameter_for_radius",
                "torque_as_the_speed",
                "efficiency_of_one_mesh",
                "torque_without_losses",
            )
        ),
    ),
    parts=(
        Part("k", kind="integer", points=1),
        Part("r", points=2),
        Part("omega2", unit="rad/s", points=1),
        Part("omega5", unit="rad/s", points=1),
        Part("a", unit="mm", points=1),
        Part("v", unit="mm/s", points=1),
        Part("Gamma5", unit="N*m", points=2),
    ),
    figure=figure,
    symbols={"Gamma1": r"\Gamma_1", "Gamma5": r"\Gamma_5", "eta": r"\eta"},
)
