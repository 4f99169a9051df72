"""A wall of two layers between a warm room and the cold: resistance, heat flow, temperature between the
layers.

One question is a text, which a person marks.
"""

from coursework.figures import Figure, dimension, line, note, section, vector
from coursework.model import Exercise, Part, drawn


def heat_flows_out(T_i, T_e):
    return T_i - T_e >= 10


def neither_layer_negligible(e_1, e_2, lambda_1, lambda_2):
    """Else who exchanges them, or forgets one, is nearly right."""
    share = (e_1 / lambda_1) / (e_2 / lambda_2)
    return (share >= 0.05) & (share <= 20) & (abs(share - 1) >= 0.1)


def figure(e_1, e_2):
    height = 0.8 * (e_1 + e_2)
    inner, between, outer = 0, e_1, e_1 + e_2
    top = height * 1j
    reach = 0.35 * (e_1 + e_2)
    return Figure(
        section((inner, between, between + top, inner + top), "1"),
        section((between, outer, outer + top, between + top), "2", angle=-45),
        line(inner, inner + top, thin=False),
        line(between, between + top, thin=False),
        line(outer, outer + top, thin=False),
        note(inner - reach + 0.8 * top, "T_i"),
        note(outer + reach + 0.8 * top, "T_e"),
        note(between + 1.1 * top, "T_{12}"),
        vector(inner - reach + 0.4 * top, 0.8 * reach, r"\Phi"),
        dimension(between, inner, "e_1"),
        dimension(outer, between, "e_2"),
    )


EXERCISE = Exercise(
    given={
        "A": drawn(5, 40, step=1, unit="m^2"),
        "e_1": drawn(100, 400, step=10, unit="mm"),
        "lambda_1": drawn(0.3, 2, step=0.05, unit="W/(m*K)"),
        "e_2": drawn(40, 200, step=10, unit="mm"),
        "lambda_2": drawn(0.03, 0.15, step=0.005, unit="W/(m*K)"),
        "T_i": drawn(17, 24, step=0.5, unit="degC"),
        "T_e": drawn(-15, 12, step=1, unit="degC"),
    },
    constraints=(heat_flows_out, neither_layer_negligible),
    parts=(
        Part("R_th", unit="K/W", points=2),
        Part("Phi", unit="W", points=2),
        Part("T_12", unit="degC", atol=0.2, rtol=0, points=2),
        Part("why", kind="text", room=5, points=3),
    ),
    symbols={"R_th": r"R_{\text{th}}", "Phi": r"\Phi", "T_12": "T_{12}"},
    figure=figure,
)
