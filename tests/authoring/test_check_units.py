"""Formulas give the units that are declared: no false alarm over the course, and planted errors are all
told."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from sweeps import sampled

import coursework
from coursework.authoring.check_report import CheckReport, notes
from coursework.authoring.check_units import check_units
from coursework.authoring.checks import check
from coursework.course.builtin import builtin_root

HERE = Path(builtin_root())
NAMES = sorted(coursework.open_course())


def report_of(exercise, variants=3):
    report = CheckReport(exercise.name)
    check_units(exercise.variants(range(variants), "en", ("all",)), report)
    return report


@pytest.mark.parametrize("name", sampled(NAMES, (*NAMES[::4], "slider_crank_torque", "quick_return")))
def test_no_exercise_of_the_course_is_told_a_fault(course, name):
    report = report_of(course[name], 8)
    assert report.failures == []
    mixed = {p.quantity for p in course[name].spec.parts if len(p.sort.units(p.unit)) > 1}
    assert (
        set(report.unproved_units) <= {"kl", "kv", "ka"} | mixed
    )  # a round scale follows no unit, nor two columns one


def test_most_units_of_the_course_are_proved(course):
    names = ("slider_crank_torque", "four_bar_motion", "quick_return")
    assert [report_of(course[n], 3).counts["units proved"] for n in names] == [26, 15, 36]


TORQUE = "slider_crank/slider_crank_torque"
ADVANTAGE = "four_bar/mechanical_advantage"
MOTION = "four_bar/four_bar_motion"
SLOTTED = "slotted/slotted_mechanism"
RETURN = "quick_return/quick_return"
OFFSET = "quick_return/quick_return_offset"
CRANK = "slider_crank/slider_crank"
BALL = "gears/ball_reducer"
PLANETS = "gears/havens_planetary"
SHAPER = "loops/three_loop_shaper"
CORIOLIS = "slotted/coriolis"

#: Exercise, file, what is written, what is planted, what the check says.
PLANTS = {
    "a length in km": (
        SLOTTED,
        'Part("rA", unit="mm"',
        'Part("rA", unit="km"',
        "rA is declared in km, and its formula gives mm",
    ),
    "a length in cm": (
        RETURN,
        'Part("xC", unit="mm"',
        'Part("xC", unit="cm"',
        "xC is declared in cm, and its formula gives mm",
    ),
    "a length in m": (
        OFFSET,
        'Part("stroke", unit="mm"',
        'Part("stroke", unit="m"',
        "stroke is declared in m, ",
    ),
    "a length in kN": (SHAPER, 'Part("d5", unit="mm"', 'Part("d5", unit="kN"', "d5 is declared in kN, "),
    "a length in mm/s": (CRANK, 'Part("r1", unit="mm"', 'Part("r1", unit="mm/s"', "r1 is declared in mm/s, "),
    "a force in kN": (
        TORQUE,
        'Part("R_A", unit="N"',
        'Part("R_A", unit="kN"',
        "R_A is declared in kN, and its formula gives N",
    ),
    "an output force in kN": (
        ADVANTAGE,
        'Part("F_s", unit="N"',
        'Part("F_s", unit="kN"',
        "F_s is declared in kN, ",
    ),
    "a force for a torque": (
        TORQUE,
        'Part("torque", unit="N*m"',
        'Part("torque", unit="N"',
        "torque is declared in N, ",
    ),
    "a torque in N*mm": (TORQUE, 'Part("torque", unit="N*m"', 'Part("torque", unit="N*mm"', "torque "),
    "an angle in rad": (
        SLOTTED,
        'Part("theta4", unit="deg"',
        'Part("theta4", unit="rad"',
        "theta4 is declared in rad, and its formula gives deg",
    ),
    "an arc in rad": (RETURN, 'Part("beta", unit="deg"', 'Part("beta", unit="rad"', "beta "),
    "an arc that a number gives, in rad": (
        OFFSET,
        'Part("alpha", unit="deg"',
        'Part("alpha", unit="rad"',
        "alpha ",
    ),
    "an angle of the core in rad": (
        RETURN,
        '"DOB": "deg"',
        '"DOB": "rad"',
        "DOB is declared in rad, and its formula gives deg",
    ),
    "a length of the core in cm": (
        RETURN,
        '"OB": "mm"',
        '"OB": "cm"',
        "OB is declared in cm, and its formula gives mm",
    ),
    "a rate in turns a minute": (
        MOTION,
        'Part("omega4", unit="rad/s"',
        'Part("omega4", unit="tr/min"',
        "omega4 is declared in tr/min, and its formula gives rad/s",
    ),
    "a rate in degrees": (
        PLANETS,
        'Part("omega3", unit="rad/s"',
        'Part("omega3", unit="deg/s"',
        "omega3 is declared in deg/s, ",
    ),
    "a rate for an acceleration": (
        MOTION,
        'Part("alpha4", unit="rad/s^2"',
        'Part("alpha4", unit="rad/s"',
        "alpha4 is declared in rad/s, ",
    ),
    "a velocity in m/s": (
        CRANK,
        'Part("r1_dot", unit="mm/s"',
        'Part("r1_dot", unit="m/s"',
        "r1_dot is declared in m/s, ",
    ),
    "a velocity for an acceleration": (
        MOTION,
        'Part("a_B", unit="mm/s^2"',
        'Part("a_B", unit="mm/s"',
        "a_B is declared in mm/s, ",
    ),
    "a duration in ms": (
        RETURN,
        'Part("t_return", unit="s"',
        'Part("t_return", unit="ms"',
        "t_return is declared in ms, ",
    ),
    "a given length in cm beside one in mm": (
        SLOTTED,
        '"r2": drawn(40, 250, step=5, unit="mm")',
        '"r2": drawn(40, 250, step=5, unit="cm")',
        "cm",
    ),
    "a given crank in m": (
        ADVANTAGE,
        '"r2": drawn(30, 90, step=5, unit="mm")',
        '"r2": drawn(30, 90, step=5, unit="m")',
        " m",
    ),
    "a given rod in km": (
        OFFSET,
        'step=5, unit="mm", positive=True)',
        'step=5, unit="km", positive=True)',
        "km",
    ),
    "a given force in kN": (TORQUE, 'step=10, unit="N")', 'step=10, unit="kN")', "kN"),
    "a given input force in kN": (ADVANTAGE, 'step=10, unit="N")', 'step=10, unit="kN")', "F_s "),
    "a given angle in rad": (
        SLOTTED,
        '"theta1": fixed(90, unit="deg")',
        '"theta1": fixed(90, unit="rad")',
        "sin takes deg, and gets rad",
    ),
    "a given angle of the core in rad": (
        RETURN,
        '"angle_OAB": drawn(60, 140, step=5, unit="deg")',
        '"angle_OAB": drawn(60, 140, step=5, unit="rad")',
        "Degrees takes deg, and gets rad",
    ),
    "a given rate in turns a minute": (
        BALL,
        '"psi_dot": drawn(-150, 150, unit="rad/s"',
        '"psi_dot": drawn(-150, 150, unit="tr/min"',
        "omega is declared in rad/s, and its formula gives tr/min",
    ),
    "a given velocity in m/s": (
        CORIOLIS,
        'unit="mm/s"',
        'unit="m/s"',
        "a_coriolis is declared in mm/s^2, and its formula gives m/s^2",
    ),
    "a given mass in g": (
        TORQUE,
        '"m3": drawn(8, 18, step=0.5, unit="kg")',
        '"m3": drawn(8, 18, step=0.5, unit="g")',
        " N",
    ),
    "a given inertia in kg*mm^2": (
        TORQUE,
        '"J2": drawn(0.1, 0.6, step=0.05, unit="kg*m^2")',
        '"J2": drawn(0.1, 0.6, step=0.05, unit="kg*mm^2")',
        "M2 is declared in N*m, ",
    ),
    "a forgotten thousand in a torque": (
        ADVANTAGE,
        "return r2 * F_e / 1000",
        "return r2 * F_e",
        "Gamma_e is declared in N*m, and its formula gives N*mm",
    ),
    "a thousand the wrong way": (
        ADVANTAGE,
        "return r2 * F_e / 1000",
        "return r2 * F_e * 1000",
        "Gamma_e is declared in N*m, ",
    ),
    "a hundred for a thousand": (
        ADVANTAGE,
        "return r2 * F_e / 1000",
        "return r2 * F_e / 100",
        "Gamma_e is declared in N*m, ",
    ),
    "a forgotten thousand in a sum": (
        TORQUE,
        "R_A_x * sin(theta2)) / 1000 - M2",
        "R_A_x * sin(theta2)) - M2",
        "torque adds or compares N*mm and N*m",
    ),
    "UNITS of a sum in cm": (
        CRANK,
        '"p": "mm"',
        '"p": "cm"',
        "p is declared in cm, and its formula gives mm: p (",
    ),
    "UNITS of an angle in rad": (
        MOTION,
        '"phi": "deg"',
        '"phi": "rad"',
        "phi is declared in rad, and its formula gives deg",
    ),
    "UNITS of a length for an angle": (MOTION, '"psi": "deg"', '"psi": "mm"', "psi is declared in mm, "),
    "a square forgotten": (
        MOTION,
        "return r3 * omega3**2",
        "return r3 * omega3",
        "a_BA_n is declared in mm/s^2, and its formula gives mm/s",
    ),
    "a sine of radians": (
        SLOTTED,
        "return r2 * omega2 * sin(theta4 - theta2)",
        "return r2 * omega2 * np.sin(theta4 - theta2)",
        "sin takes rad, and gets deg",
    ),
}


def planted(folder, exercise, old, new):
    """A copy of the course with a fault in the exercise, its solution, or what solutions of its topic
    share."""
    shutil.copytree(HERE / "exercises", folder / "exercises")
    shutil.copytree(HERE / "solutions", folder / "solutions")
    topic, _, name = exercise.partition("/")
    files = [folder / kind / f"{exercise}.py" for kind in ("exercises", "solutions")]
    shared = sorted((folder / "solutions" / topic).glob("_*.py"))
    path = next(p for p in (*files, *shared) if old in p.read_text("utf-8"))
    path.write_text(path.read_text("utf-8").replace(old, new, 1), "utf-8")
    return coursework.open_course(folder)[name]


@pytest.mark.parametrize("plant", PLANTS)
def test_a_planted_fault_is_told(tmp_path, plant):
    exercise, old, new, told = PLANTS[plant]
    failures = report_of(planted(tmp_path, exercise, old, new)).failures
    assert any(told in failure for failure in failures), failures
    assert all(".py, line " in failure for failure in failures)


ON_PURPOSE = {
    "metres from millimetres": ("mm", "rad/s", "m/s", "return r * omega / 1000"),
    "by a power": ("mm", "rad/s", "m/s", "return r * omega * 1e-3"),
    "kilometres an hour": ("m", "rad/s", "km/h", "return 3.6 * r * omega"),
    "turns a minute": ("mm", "tr/min", "mm/s", "return r * omega * 2 * np.pi / 60"),
    "thirty over pi": ("mm", "tr/min", "mm/s", "return r * omega / (30 / np.pi)"),
    "degrees a second": ("mm", "deg/s", "mm/s", "return r * np.radians(omega)"),
    "degrees by hand": ("mm", "deg/s", "mm/s", "return r * omega * np.pi / 180"),
    "a constant with its unit": ("mm", "rad/s", "mm/s", "return r * omega + RISE * omega"),
    "one after the other": ("mm", "rad/s", "mm/s", "return reduce(np.multiply, (r, omega))"),
}
FORGOTTEN = {
    "no thousand": ("mm", "rad/s", "m/s", "return r * omega"),
    "the wrong way": ("mm", "rad/s", "m/s", "return r * omega * 1000"),
    "no 3.6": ("m", "rad/s", "km/h", "return r * omega"),
    "no turn": ("mm", "tr/min", "mm/s", "return r * omega"),
    "no degree": ("mm", "deg/s", "mm/s", "return r * omega"),
    "one after the other": ("mm", "rad/s", "mm/s", "return reduce(np.add, (r * omega, r))"),
    "a constant in another unit": ("cm", "rad/s", "cm/s", "return r * omega + RISE * omega"),
}


def crank_pin(small_course, r, omega, v, formula):
    """The small course's exercise, its rate by another formula, in other units."""
    path = small_course / "exercises" / "crank_pin.py"
    text = path.read_text("utf-8")
    for name, old, new in (("r", "mm", r), ("omega", "rad/s", omega)):
        before, found, after = text.partition(f'"{name}": drawn(')
        assert found
        text = before + found + after.replace(f'unit="{old}"', f'unit="{new}"', 1)
    for part in ("x", "y"):
        text = text.replace(f'Part("{part}", unit="mm"', f'Part("{part}", unit="{r}"')
    path.write_text(text.replace('unit="mm/s"', f'unit="{v}"'), "utf-8")
    path = small_course / "solutions" / "crank_pin.py"
    text = path.read_text("utf-8").replace("return r * omega\n", f"{formula}\n")
    path.write_text(text + '\nfrom functools import reduce\nRISE = 5\nUNITS = {"RISE": "mm"}\n', "utf-8")
    return coursework.open_course(small_course)["crank_pin"]


@pytest.mark.parametrize("case", ON_PURPOSE)
def test_a_conversion_on_purpose_passes(small_course, case):
    report = report_of(crank_pin(small_course, *ON_PURPOSE[case]))
    assert report.failures == []
    assert report.unproved_units == {}


@pytest.mark.parametrize("case", FORGOTTEN)
def test_a_forgotten_one_is_told(small_course, case):
    failures = report_of(crank_pin(small_course, *FORGOTTEN[case])).failures
    assert len(failures) == 1
    assert failures[0].startswith("v ")
    assert "v (crank_pin.py, line " in failures[0]


def test_what_cannot_be_followed_is_listed_and_not_counted(small_course):
    exercise = crank_pin(small_course, "mm", "rad/s", "mm/s", "return float(r) * omega")
    report = report_of(exercise)
    assert report.failures == []
    assert report.unproved_units == {"v": "it makes plain numbers of its values"}
    assert (report.counts["units proved"], report.counts["units not proved"]) == (2, 1)
    report.variants = 3
    assert "units not proved: v (it makes plain numbers of its values)" in notes([report])[0]
    assert report.as_json()["unproved_units"] == report.unproved_units


def test_the_check_counts_units(small_course):
    assert check(coursework.open_course(small_course)["crank_pin"], 10).counts["units proved"] == 3


def test_the_check_fails_on_a_unit(small_course):
    exercise = crank_pin(small_course, "mm", "rad/s", "km/s", "return r * omega")
    told = "v is declared in km/s, and its formula gives mm/s: v (crank_pin.py, line "
    failures = check(exercise, 10).failures
    assert any(f.startswith(told) for f in failures), failures
