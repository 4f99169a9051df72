"""Epicyclic train: speeds by Willis' formula, with the ring, the sun or the carrier fixed, and the
torques."""

from coursework.degrees import polar
from coursework.figures import Figure, circle, ground_pivot, line, pin, wheel
from coursework.model import Exercise, Part, chosen, detectable, drawn


def input_turns_visibly(omega_a):
    return abs(omega_a) >= 20


def planets_do_not_touch(z1, z2):
    """Three of them, their teeth two modules clear."""
    return (z1 + z2) * 3**0.5 / 2 > z2 + 4


def planets_fit(z1, z2):
    """Three at equal angles: the teeth of sun and ring together are a multiple of three."""
    return (2 * z1 + 2 * z2) % 3 == 0


def planet_is_no_twin(z1, z2):
    return (abs(z1 - z2) >= 3) & (z1 != 2 * z2)


def figure(z1, z2):
    """With the module 2."""
    arms = [polar(z1 + z2, 90 + 120 * k) for k in range(3)]
    rim = z1 + 2 * z2
    return Figure(
        circle(0, rim + 7),
        circle(0, rim, label="3"),
        wheel(0, z1, label="1"),
        *(wheel(A, z2, label="2" if k == 2 else None) for k, A in enumerate(arms)),
        *(line(0, A, thin=False, label="4" if k == 1 else None) for k, A in enumerate(arms)),
        *(pin(A) for A in arms),
        ground_pivot(0),
        paper_mm=(70, 70),
    )


EXERCISE = Exercise(
    given={
        "z1": drawn(18, 48),
        "z2": drawn(15, 36),
        "mode": chosen(
            "ring", "sun", "carrier", shown=("omega_b", "omega24", "omega2", "Gamma_out", "Gamma_fix")
        ),
        "omega_a": drawn(-150, 150, step=2, unit="rad/s"),
        "Gamma_in": drawn(5, 60, step=1, unit="N*m"),
    },
    constraints=(
        input_turns_visibly,
        planets_do_not_touch,
        planets_fit,
        planet_is_no_twin,
        *(
            detectable(mistake, "omega_b", "omega24", "omega2", "Gamma_out", "Gamma_fix")
            for mistake in (
                "ring_as_far_as_a_planet",
                "planet_on_both_sides_left_out",
                "ratio_positive",
                "another_member_fixed",
                "carrier_left_out_of_the_planet",
                "sun_seen_from_the_frame",
                "torque_upside_down",
                "held_without_the_load",
                "torques_added",
            )
        ),
    ),
    parts=(
        Part("z3", kind="integer", points=1),
        Part("r0", points=1),
        Part("omega_b", unit="rad/s", points=3),
        Part("omega24", unit="rad/s", points=2),
        Part("omega2", unit="rad/s", points=1),
        Part("Gamma_out", unit="N*m", points=2),
        Part("Gamma_fix", unit="N*m", points=1),
    ),
    figure=figure,
    symbols={
        "omega_a": r"\omega_a",
        "omega_b": r"\omega_b",
        "omega24": r"\omega_{2/4}",
        "r0": "r_0",
        "Gamma_in": r"\Gamma_a",
        "Gamma_out": r"\Gamma_b",
        "Gamma_fix": r"\Gamma_c",
    },
)
