"""Expressions of a mechanism's file know units: a length is one, however it is written, and a plain number is
none."""

import numpy as np
import pytest
from tables import each_row

from coursework.degrees import acos, atan2, sin, sqrt, tan
from coursework.errors import CourseworkError
from coursework.linkages.expressions import ExpressionReader
from coursework.messages import localised

UNITS = {"k": "1", "r2": "mm", "r3": "mm", "theta2": "deg", "omega2": "rad/s", "F": "N", "s": "mm"}
VALUES = {"k": 2.0, "r2": 60.0, "r3": 80.0, "theta2": 30.0, "omega2": 5.0, "F": 100.0, "s": 3.0}
FUNCTIONS = {"np": np, "abs": abs, **{f.__name__: f for f in (acos, atan2, sin, sqrt, tan)}}


@each_row(
    "text, unit, value",
    [
        ("k*100 mm", "mm", 200.0),
        ("100 mm*k", "mm", 200.0),
        ("10 cm + k*2 mm", "mm", 104.0),
        ("k*100 mm/2", "mm", 100.0),
        ("s*k", "mm", 6.0),
        ("r2*r3/r2", "mm", 80.0),
        ("sqrt(r2^2 + r3^2)", "mm", 100.0),
        ("min(r2, k*10 mm)", "mm", 20.0),
        ("tan(45 deg) * r2", "mm", 60.0),
        ("r2 * theta2", "mm", 60 * np.pi / 6),  # an arc
        ("k*90 deg", "deg", 180.0),
        ("theta2 + k*10°", "deg", 50.0),
        ("acos(r2 / (k*60 mm))", "deg", 60.0),
        ("atan2(r2, r2)", "deg", 45.0),
        ("F * r2", "N*m", 6.0),
        ("k*5 N*m", "N*m", 10.0),
        ("omega2 * r2", "mm/s", 300.0),
        ("omega2^2 * r2", "mm/s^2", 1500.0),
        ("r2 / r3", "1", 0.75),
    ],
)
def test_right_expressions_have_values_in_their_units(text, unit, value):
    code = ExpressionReader(UNITS).read(text, unit).code
    assert eval(code, FUNCTIONS, VALUES) == pytest.approx(value)


@each_row(
    "text, unit, found, in_french",
    [
        (
            "r2 + 5",
            "mm",
            "r2 is in mm, 5 without unit: they do not add up",
            "r2 est en mm, 5 sans unité : ils ne s’ajoutent pas",
        ),
        ("r2 + k", "mm", "r2 is in mm, k without unit: they do not add up", "k sans unité"),
        (
            "k*100",
            "mm",
            "'k*100' is without unit, where a value in mm stands",
            "'k*100' est sans unité, là où il faut une valeur en mm",
        ),
        ("k*10", "deg", "'k*10' is without unit, where a value in deg stands", "une valeur en deg"),
        (
            "theta2 + 5",
            "deg",
            "theta2 is in deg, 5 without unit: they do not add up",
            "theta2 est en deg, 5 sans unité",
        ),
        ("r2 * r3", "mm", "'r2 * r3' is in mm^2, where a value in mm stands", "est en mm^2"),
        ("k*5 kg", "mm", "'k*5 kg' is in kg, where a value in mm stands", "est en kg"),
        ("sqrt(r2^2 + 4)", "mm", "r2 ^ 2 is in mm^2, 4 without unit", "r2 ^ 2 est en mm^2, 4 sans unité"),
        (
            "sqrt(r2)",
            "mm",
            "the root of r2, which is in mm, has no unit",
            "la racine de r2, qui est en mm, n’a pas d’unité",
        ),
        (
            "min(3, r2)",
            "mm",
            "3 is without unit, r2 in mm: they cannot be compared",
            "on ne peut les comparer",
        ),
        (
            "sin(30)",
            "1",
            "sin takes a value in deg, such as sin(30 deg); 30 is without unit",
            "sin prend une valeur en deg, comme sin(30 deg) ; 30 est sans unité",
        ),
        (
            "acos(r2)",
            "deg",
            "acos takes a value without unit, such as acos(r2 / r3); r2 is in mm",
            "acos prend une valeur sans unité",
        ),
        (
            "2 r2",
            "mm",
            "a product has its sign: '2 * r2'; found '2 r2'",
            "un produit s’écrit avec son signe : '2 * r2'",
        ),
        ("5*mm", "mm", "'mm' is a unit, which stands beside a number: \"5 mm\"", "« mm » est une unité"),
        (
            "100 mmm",
            "mm",
            "no unit 'mmm'; did you mean 'mm'?",
            "aucune unité « mmm » ; vouliez-vous dire « mm » ?",
        ),
    ],
)
def test_wrong_expressions_are_refused_in_both_languages(text, unit, found, in_french):
    with pytest.raises(CourseworkError) as fault:
        ExpressionReader(UNITS).read(text, unit)
    assert found in str(fault.value)
    assert in_french in localised(fault.value, "fr").replace("\N{NARROW NO-BREAK SPACE}", " ")


def test_conditions_compare_what_has_one_dimension():
    reader = ExpressionReader(UNITS)
    code = reader.condition("k*20 mm < r2 < 30 cm and r2*r3 < 1 m^2 and theta2 > 0").code
    assert eval(code, FUNCTIONS, {n: np.array(v) for n, v in VALUES.items()})
    for text in ("r2 < 5", "r2 < theta2", "theta2 > 20", "r2*r3 < 4 mm"):
        with pytest.raises(CourseworkError, match="cannot be compared"):
            reader.condition(text)
