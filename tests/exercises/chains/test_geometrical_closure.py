"""Ball crank and fork: the law found in space at fifty digits, and equations judged in any form."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework

EXERCISE = coursework.open_course()["geometrical_closure"]
ASKED = ("theta3", "q", "epsilon", "omega3", "ratio", "swing")


def exact(R, h, e, theta1, omega1):
    """The fork turned in space until the product vanishes, by a search; its rate by differences in time."""
    with mpmath.workdps(50):
        R, h, e, omega1 = map(mpmath.mpf, (R, h, e, omega1))
        start = mpmath.radians(mpmath.mpf(theta1))

        def turn_of_fork(t):
            ball = (R * mpmath.cos(start + omega1 * t), R * mpmath.sin(start + omega1 * t), mpmath.mpf(0))
            arm = [b - c for b, c in zip(ball, (0, e, -h), strict=True)]

            def product(theta):
                return sum(a * y for a, y in zip(arm, (0, mpmath.cos(theta), mpmath.sin(theta)), strict=True))

            found = mpmath.findroot(product, (-mpmath.pi / 2, mpmath.pi / 2), solver="anderson", tol=1e-90)
            return found, arm[2] * mpmath.cos(found) - arm[1] * mpmath.sin(found)

        step = mpmath.mpf("1e-15")
        theta3, q = turn_of_fork(0)
        omega3 = (turn_of_fork(step)[0] - turn_of_fork(-step)[0]) / (2 * step)

        def lean(angle):
            return mpmath.atan((e - R * mpmath.sin(angle)) / h)

        y3 = (mpmath.cos(theta3), mpmath.sin(theta3))  # along y0 and z0
        turned = mpmath.matrix([[mpmath.cos(start), mpmath.sin(start), 0]])
        epsilon = mpmath.acos((turned * mpmath.matrix([0, *y3]))[0])
        ends = [lean(mpmath.findroot(lambda a: mpmath.diff(lean, a), near)) for near in (-1.5, 1.5)]
        return {
            "theta3": mpmath.degrees(theta3),
            "q": q,
            "epsilon": mpmath.degrees(epsilon),
            "omega3": omega3,
            "ratio": omega3 / omega1,
            "swing": mpmath.degrees(abs(ends[0] - ends[1])),
        }


@each_row("seed", range(10))
def test_every_number_agrees_with_fifty_digits(seed):
    given = dict(EXERCISE.variant(seed).given)
    found = EXERCISE.solve(**given, only=ASKED)
    for name, right in exact(**given).items():
        assert found[name] == pytest.approx(float(right), rel=1e-13), name


FORMS = {
    "closure_y": ("e - R*sin(theta1) = q*sin(theta3)", "2*q*sin(theta3) = 2*(e - R*sin(theta1))"),
    "closure_z": ("h/cos(theta3) = q", "h - q*cos(theta3) = 0", "theta3 = acos(h/q)"),
    "closure_angle": (
        "epsilon = acos(sin(theta1)*cos(theta3))",
        "2*cos(epsilon) = sin(theta1 + theta3) + sin(theta1 - theta3)",
        "cos(epsilon)/cos(theta3) = sin(theta1)",
    ),
    "law": (
        "tan(theta3) = (e - R*sin(theta1))/h",
        "h*tan(theta3) + R*sin(theta1) = e",
        "R*sin(theta1)*cos(theta3) + h*sin(theta3) - e*cos(theta3) = 0",
        "sin(theta3)/cos(theta3) = e/h - R/h*sin(theta1)",
        "theta3 = atan((e - R*sin(theta1))/h)",
        "-theta3 = arctan((R*sin(theta1) - e)/h)",
        "atan2(e - R*sin(theta1); h) = theta3",
        "cotan(theta3) = h/(e - R*sin(theta1))",
    ),
    "law_dot": (
        "omega3 = -omega1*h*R*cos(theta1)/(h^2 + (e - R*sin(theta1))^2)",
        "omega3/omega1 = -(R/h)*cos(theta1)/(1 + ((R*sin(theta1) - e)/h)^2)",
        "omega3*(1 + ((e - R*sin(theta1))/h)^2) + R*omega1*cos(theta1)/h = 0",
        "omega3 = -R/h*cos(theta1)*omega1*cos(atan((e - R*sin(theta1))/h))^2",
        "omega3 = -R/h*cos(theta1)*omega1*cos(atan2(e - R*sin(theta1); h))^2",
    ),
}
WRONG = {
    "closure_y": ("R*sin(theta1) + e = q*sin(theta3)", "R*sin(theta1) - e = q*cos(theta3)"),
    "closure_z": ("h*cos(theta3) = q",),
    "closure_angle": (
        "epsilon = theta1 + theta3",
        "cos(epsilon) = cos(theta1)*cos(theta3)",
        "cos(epsilon) = sin(theta1)",
        "epsilon = asin(sin(theta1)*cos(theta3))",
    ),
    "law": (
        "tan(theta3) = (R*sin(theta1) - e)/h",
        "tan(theta3) = e/h - R/h*cos(theta1)",
        "theta3 = atan((R*sin(theta1) - e)/h)",
        "theta3 = asin((e - R*sin(theta1))/h)",
        "cotan(theta3) = (e - R*sin(theta1))/h",
        "theta3 = 0",
    ),
    "law_dot": (
        "omega3 = -omega1*R*cos(theta1)/h",
        "omega3 = omega1",
        "omega3 = -R/h*cos(theta1)*omega1*cos(atan((e - R*sin(theta1))/h))",
        "omega3 = -R/h*cos(theta1)*omega1*sin(atan((e - R*sin(theta1))/h))^2",
    ),
}


def _verdicts(part, texts):
    variant = EXERCISE.variant(2)
    return [variant.grade({part: text})[part].verdict == "correct" for text in texts]


@each_row("part", FORMS)
def test_an_equation_is_right_in_any_form(part):
    assert _verdicts(part, FORMS[part]) == [True] * len(FORMS[part])
    assert _verdicts(part, WRONG[part]) == [False] * len(WRONG[part])


def test_the_law_holds_over_the_turn_and_its_derivative_is_the_rate():
    theta1 = np.linspace(-180, 180, 3601)
    found = EXERCISE.solve(R=45, h=70, e=-20, theta1=theta1, omega1=1, only=("theta3", "q", "omega3"))
    t1, t3 = np.radians(theta1), np.radians(found["theta3"])
    np.testing.assert_allclose(70 * np.sin(t3) + (45 * np.sin(t1) + 20) * np.cos(t3), 0, atol=1e-12)
    np.testing.assert_allclose(np.gradient(t3, t1)[1:-1], found["omega3"][1:-1], atol=2e-6)
    assert np.ptp(found["theta3"]) == pytest.approx(
        EXERCISE.solve(R=45, h=70, e=-20, only="swing")["swing"], rel=1e-12
    )


def test_without_an_offset_it_is_the_law_of_a_symmetric_fork():
    found = EXERCISE.solve(
        R=30, h=60, e=0, theta1=np.array([-40.0, 40.0]), omega1=2, only=("theta3", "omega3")
    )
    assert found["theta3"][0] == -found["theta3"][1]
    assert found["omega3"][0] == found["omega3"][1]
