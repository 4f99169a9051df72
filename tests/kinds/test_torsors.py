"""Twists and wrenches: read in two columns or as text, right component by component, their slips by name."""

from __future__ import annotations

import numpy as np
import pytest
from course_of_every_kind import Asking
from tables import each_row

from coursework.kinds.kind import kind_of
from coursework.model import Part

TWIST = Part("V", kind="twist")
WRENCH = Part("W", kind="wrench")
IN_METRES = Part("W", kind="wrench", unit="N*m")
MAY_MOVE = Part("free", kind="twist_pattern")
TRANSMITS = Part("held", kind="wrench_pattern")

SPIN = np.array([0.0, 0.0, 5.0, 10.0, 20.0, 0.0])
PUSH = np.array([10.0, 20.0, 0.0, 0.0, 0.0, 5.0])
IN_PLANE = np.array([10.0, 20.0, 5.0])


def read(part, answer, reference):
    return part.sort.read(answer, part, Asking(reference))


def distance(part, answer, reference):
    reading = read(part, answer, reference)
    assert reading.status == "read", (answer, reading)
    return min(part.sort.distance(part, value, reference) for value in reading.values)


AS_WRITTEN = [
    "{0 10; 0 20; 5 0}",
    "{0 0 5 | 10 20 0}",
    "{0, 0, 5 | 10, 20, 0}_A",
    "0; 0; 5; 10; 20; 0",
    "0 0 5 10 20 0",
    "0,0,5,10,20,0",
    "0 10\n0 20\n5 0",
    "{\n0 | 10\n0 | 20\n5 | 0\n}_{(A, R)}",
    "0, 10; 0, 20; 5, 0",
    [[0, 0, 5], [10, 20, 0]],
    [[0, 10], [0, 20], [5, 0]],
    (0, 0, 5, 10, 20, 0),
    np.array([[0, 10], [0, 20], [5, 0]]),
    "np.array([[0, 0, 5], [10, 20, 0]])",
    "[[0 10]\n [0 20]\n [5 0]]",
    r"\begin{Bmatrix} 0 & 10 \\ 0 & 20 \\ 5 & 0 \end{Bmatrix}_A",
    r"$\left\{\begin{array}{cc}0&10\\0&20\\5&0\end{array}\right\}_{(A,R)}$",
    "{V}_A = {0 0 5 | 10 20 0}",
    "_A{0 10; 0 20; 5 0}_R",
    "(0;0;5), (10;20;0)",
    "ω = (0;0;5), v = (10;20;0)",
    "v = (10;20;0) ; ω = (0;0;5)",
    "{Ω: (0,0,5) | V: (10,20,0)}",
    "wz=5; wx=0; wy=0; vx=10; vy=20; vz=0",
    {"ωx": 0, "ωy": 0, "ωz": 5, "vx": 10, "vy": 20, "vz": 0},
    "{0,0 0,0 5,0 | 10,0 20,0 0,0}",
    "{0 0 10/2 | 2*5 20 0}",
    "{0 0 5 | 0,01 0,02 0} rad/s, m/s",
    "{0 0 5 rad/s | 0.01 0.02 0 m/s}",
    "0 rad/s 10 mm/s; 0 20; 5 0",
    "{0 0 5 | 1 2 0} cm/s",
    "{0 0 5 | 0,01 0,02 0} SI",
    "{−0 0 5 | 10 20 0}",
]


@each_row("answer", AS_WRITTEN)
def test_a_twist_is_read_as_people_write_it(answer):
    assert distance(TWIST, answer, SPIN) < 1e-9


@each_row(
    "answer",
    [
        "{10 0; 20 0; 0 5}",
        "10 N; 20; 0; 0; 0; 5 N.mm",
        "{10 20 0 | 0 0 0,005} N, N.m",
        "{10 20 0 | 0 0 0.005} N·m",
        "M = (0,0,5); R = (10,20,0)",
        "X=10 ; Y=20 ; Z=0 ; L=0 ; M=0 ; N=5",
        "{0.01 0.02 0 kN | 0 0 5}",
    ],
)
def test_a_wrench_is_read_in_any_unit_of_its_columns(answer):
    assert distance(WRENCH, answer, PUSH) < 1e-9


@each_row(
    "answer",
    [
        "10; 20; 5",
        "vx = 10; vy = 20; wz = 5",
        "ωz = 5 ; vx = 10 ; vy = 20",
        "{- 10; - 20; 5 -}",
        "{- - 5 | 10 20 -}",
        "{0 10; 0 20; 5 0}",
        [10, 20, 5],
        "10 mm/s 20 mm/s 5 rad/s",
        "0,01 m/s ; 0,02 m/s ; 5",
    ],
)
def test_a_plane_twist_is_three_components_or_a_table_with_dashes(answer):
    assert distance(TWIST, answer, IN_PLANE) < 1e-9


def test_a_plane_wrench_is_a_force_and_a_moment():
    for answer in ("10; 20; 5", "{10 -; 20 -; - 5}", "X=10, Y=20, N=5", "N = 5; X = 10; Y = 20"):
        assert distance(WRENCH, answer, IN_PLANE) < 1e-9


@each_row(
    "answer", ["?", "12 +", "((((", "1 2 3", "{0 0 5 | 10 20}", "{0 0 5 | 10 20 -}", "je ne sais pas", 5]
)
def test_what_is_no_torsor_is_told_so(answer):
    reading = read(TWIST, answer, SPIN)
    assert reading.status == "unreadable"
    assert TWIST.sort.faults.get(reading.code, reading.code) in ("not_torsor", "unknown_unit")


@each_row(
    "answer",
    [
        "(" * 900 + "0 0 5 10 20 0" + ")" * 900,
        "{" * 3000,
        "[[[[" * 500,
        "0 " * 5000,
        "; | " * 900,
        "=" * 3000,
        "wz_" * 900,
        "{0 0 5 | " * 300,
    ],
)
@each_row("part", [TWIST, MAY_MOVE])
def test_hostile_texts_are_refused(part, answer):
    assert read(part, answer, SPIN).status == "unreadable"


def test_a_unit_of_another_kind_is_told():
    assert read(TWIST, "{0 0 5 | 10 20 0} kg", SPIN).status == "wrong_unit"
    assert read(TWIST, "{0 0 5 N | 10 20 0}", SPIN).status == "wrong_unit"


def test_nothing_written_is_missing():
    for answer in ("", "  ", None):
        assert read(TWIST, answer, SPIN).status == "missing"


def test_each_column_has_its_own_margin():
    big = np.array([0.0, 0.0, 0.5, 4000.0, 0.0, 0.0])
    for off, right in ((0.99, True), (1.01, False)):
        for place, width in ((2, 0.005), (3, 40.0), (0, 0.005), (5, 40.0)):
            value = big.copy()
            value[place] += off * width
            assert (TWIST.sort.distance(TWIST, value, big) <= 1) is right, place


def test_the_margin_that_is_told_is_that_of_the_moments():
    light = np.array([500.0, 0.0, 0.0, 0.0, 0.0, 20.0])
    assert WRENCH.half_width(WRENCH.sort.size(light)) == pytest.approx(0.2)
    assert WRENCH.half_width(WRENCH.sort.size(np.array([500.0, 0.0, 0.0, 0.0, 0.0, 0.0]))) == pytest.approx(
        5.0
    )
    off = light + np.array([0.0, 0.0, 4.9, 0.0, 0.19, 0.0])
    assert WRENCH.sort.distance(WRENCH, off, light) <= 1
    off[4] = 0.21
    assert WRENCH.sort.distance(WRENCH, off, light) > 1


@each_row(
    ("value", "names"),
    [
        ((0, 0, 5, 10, 27, 0), [r"$v_y$"]),
        ((0, 1, 5, 10, 20, 9), [r"$\omega_y$ and $v_z$"]),
        ((1,) * 6, []),
        (SPIN, []),
    ],
)
def test_the_components_that_are_not_right_are_named_where_others_are(value, names):
    remarks = TWIST.sort.remarks(TWIST, np.array(value, float), SPIN, "en")
    assert [components for _, components in remarks] == names


def test_noughts_count():
    value = np.array([0.0, 0.0, 5.0, 10.0, 20.0, 1.0])
    assert TWIST.sort.distance(TWIST, value, SPIN) > 1
    assert TWIST.sort.share(TWIST, value, SPIN) == pytest.approx(5 / 6)
    assert TWIST.sort.share(TWIST, np.zeros(6), SPIN) == 0, "noughts alone are no work"


@each_row(
    ("answer", "slip"),
    [
        ("{0 0 -5 | -10 -20 0}", "sign"),
        ("{0 0 5 | -10 -20 0}", "moment_sign"),
        ("{10 20 0 | 0 0 5}", "columns"),
        ("{0 0 5 | 0.01 0.02 0}", "unit"),
        ("{0 0 5 | 35 -70 0}", "other_point"),
        ("{0 0 5 | 35 -70 9}", ""),
        ("{0 1 5 | 35 -70 0}", ""),
    ],
)
def test_slips_are_named(answer, slip):
    value = read(TWIST, answer, SPIN).values[0]
    assert list(TWIST.sort.slips(TWIST, value, SPIN, {})) == ([slip] if slip else [])


def test_at_another_point_is_so_for_any_point_and_any_axis():
    rng = np.random.default_rng(5)
    for _ in range(200):
        w, v, arm = rng.normal(size=(3, 3))
        reference = np.concatenate([w, v])
        moved = np.concatenate([w, v + 3 * np.cross(w, arm)])
        if WRENCH.sort.distance(WRENCH, moved, reference) > 1:
            assert "other_point" in WRENCH.sort.slips(WRENCH, moved, reference, {})
        beside = np.concatenate([w, v + 3 * np.cross(w, arm) + 0.5 * w])
        assert not list(WRENCH.sort.slips(WRENCH, beside, reference, {}))


@each_row(
    ("answer", "named"),
    [
        ("{0 vx; 0 0; wz 0}", "wz vx"),
        ("wz, vx", "wz vx"),
        ("ωz et vx", "wz vx"),
        ("ω_z ; v_x", "wz vx"),
        ("0 0 wz | vx 0 0", "wz vx"),
        ([[0, 0, 1], [1, 0, 0]], "wz vx"),
        ({"vx", "wz"}, "wz vx"),
        ("{0 *; 0 0; * 0}", "wz vx"),
        (r"\begin{Bmatrix} 0 & v_x \\ 0 & 0 \\ \omega_z & 0 \end{Bmatrix}", "wz vx"),
        ("{0 libre; 0 0; libre 0}", "wz vx"),
        ("0", ""),
        ("aucune", ""),
        ("{ }", ""),
        ("{0}", ""),
        ("{0 0; 0 0; 0 0}", ""),
        ("{- vx; - vy; wz -}", "wz vx vy"),
        ("vx 0 wz", "wz vx"),
    ],
)
def test_a_pattern_is_a_table_or_names(answer, named):
    assert read(MAY_MOVE, answer, "").values == (frozenset(named.split()),)


@each_row("answer", ["((((", "?", "12 +", "{", "je ne sais pas", "vz?", "1 = 1 = 1"])
def test_what_is_no_pattern_is_told_so(answer):
    assert read(MAY_MOVE, answer, "").status == "unreadable"


def test_the_pattern_of_a_wrench_has_letters_of_its_own():
    for answer in ("X, Y, M", "{X 0; Y M; 0 0}", "X_1 ; Y_1 ; M_1", "Fx Fy My"):
        assert read(TRANSMITS, answer, "").values == (frozenset({"X", "Y", "M"}),)
    assert read(TRANSMITS, "{X12 L12; Y12 M12; Z12 0}", "").values == (frozenset("XYZLM"),)


def test_a_pattern_right_in_part_earns_its_part():
    share = MAY_MOVE.sort.share
    assert share(MAY_MOVE, frozenset({"wz"}), "wz vx") == 0.5
    assert share(MAY_MOVE, frozenset({"wz", "vx", "vy"}), "wz vx") == 0.5
    assert share(MAY_MOVE, frozenset(kind_of("twist").form.names), "wz vx") == 0
    assert MAY_MOVE.sort.distance(MAY_MOVE, frozenset({"vx", "wz"}), "wz vx") == 0


def test_what_is_blocked_for_what_is_free_is_told():
    slips = TRANSMITS.sort.slips
    assert list(slips(TRANSMITS, frozenset("MN"), "X Y Z L", {})) == ["complement"]
    assert list(slips(TRANSMITS, frozenset("LM"), "X Y", {})) == ["columns"]


@each_row("part", [TWIST, WRENCH, IN_METRES])
def test_every_way_of_writing_a_right_answer_is_right(part):
    rng = np.random.default_rng(3)
    for count in (6, 3):
        for _ in range(20):
            reference = np.round(rng.normal(size=count) * 40, 2) * rng.integers(0, 2, count)
            reference[2] = 4.0
            for spelled in part.sort.spellings(part, reference, str):
                assert distance(part, spelled.answer, reference) <= 1, spelled


def test_a_table_is_printed_with_dashes_in_the_plane():
    assert TWIST.sort.formula(IN_PLANE, str) == (
        r"\left\{\begin{matrix} - & 10.0 \\ - & 20.0 \\ 5.0 & - \end{matrix}\right\}"
    )
    assert MAY_MOVE.sort.latex("wz vx", {}) == (
        r"\left\{\begin{matrix} 0 & v_x \\ 0 & 0 \\ \omega_z & 0 \end{matrix}\right\}"
    )
    assert TRANSMITS.sort.latex("X N", {}).count("0") == 4
