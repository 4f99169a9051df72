"""Figures of the lesson on rolling without slipping: the ball reducer and Havens' planetary gear."""

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    axes,
    centre_line,
    circle,
    contact,
    ground_pivot,
    line,
    link,
    note,
    pin,
    point,
    rotation_arrow,
    section,
    slot_link,
    trace,
    vector,
    wheel,
)

from ._joint_graphs import bodies, joint
from ._machines import rows_of

R, r = 40.0, 16.0  #: of the ball reducer that the figures show, mm
D, R2, R3, B, THETA1 = 30.0, 25.0, 15.0, 45.0, 110.0  #: of Havens' gear, mm and degrees


def wheel_on_the_ground():
    """Three points of a rolling wheel: at rest, and twice as fast as the centre."""
    radius, centre = 20.0, 20j
    ground = (complex(-42, -4), complex(48, -4), complex(48, 0), complex(-42, 0))
    return Figure(
        section(ground, label="S_1"),
        wheel(centre, radius, label="S_2"),
        line(0, 2 * centre, dashed=True),
        line(0, 2 * centre + 44),
        vector(centre, 22, r"V_C"),
        vector(2 * centre, 44, r"2V_C"),
        rotation_arrow(centre, 9, 250, 130, r"\omega"),
        point(centre, "C", toward=-45),
        point(2 * centre, "K", toward=110),
        contact(0, "I", toward=-150),
        paper_mm=(90, 50),
    )


def rolling_and_spin():
    """The rotation vector at a contact, split along the normal and in the tangent plane."""
    radius, centre = 17.0, 17j
    ground = (complex(-40, -5), complex(48, -5), complex(48, 0), complex(-40, 0))
    turn = complex(34, 22)
    return Figure(
        section(ground, label="S_1"),
        wheel(centre, radius),
        note(centre + complex(-9, 3), "S_2"),
        centre_line(0, centre + 32j, label=r"\vec{n}"),
        vector(centre, turn, r"\Omega_{2/1}"),
        vector(centre, turn.real, r"\Omega_t"),
        vector(centre, 1j * turn.imag, r"\Omega_n"),
        line(centre + turn, centre + turn.real, dashed=True),
        line(centre + turn, centre + 1j * turn.imag, dashed=True),
        contact(0, "I", toward=-120),
        paper_mm=(90, 48),
    )


def ball_graph():
    """Joint graph of the reducer: two pivots, four contacts."""
    places = {"0": 0j, "1": complex(38, 24), "2": complex(38, -24), "3": complex(76, 0)}
    return Figure(
        *bodies(places),
        *joint(places["0"], places["1"], "z"),
        *joint(places["0"], places["2"], "z"),
        *joint(places["0"], places["3"], "A", 5),
        *joint(places["0"], places["3"], "B", -5),
        *joint(places["1"], places["3"], "C"),
        *joint(places["2"], places["3"], "D"),
        paper_mm=(90, 48),
    )


def _turned_basis(at, name, angle_):
    size, turned = 26.0, 30.0
    x, y = polar(size, turned), polar(size, turned + 90)
    return [
        vector(at, complex(size), r"\vec{x}_0"),
        vector(at, complex(0, size), r"\vec{y}_0"),
        vector(at, x, rf"\vec{{x}}_{name}"),
        vector(at, y, rf"\vec{{y}}_{name}"),
        angle_mark(at, 0, turned, angle_, radius=15),
        angle_mark(at, 90, 90 + turned, angle_, radius=15),
        note(at + complex(-7, -6), r"\vec{z}"),
        circle(at, 2.2),
        point(at),
    ]


def bases():
    """The three changes of basis: input shaft, output shaft, line to the ball."""
    turns = (("1", r"\psi"), ("2", r"\theta"), ("a", r"\phi"))
    found = [element for k, turn in enumerate(turns) for element in _turned_basis(complex(62 * k), *turn)]
    return Figure(*found, paper_mm=(150, 50))


def _places():
    """O1, O3, A, B, C, D in the half-plane of z and O3: abscissa along x_a, ordinate along z."""
    O3 = complex(R + r)
    return {"O_1": 0j, "O_3": O3, "A": O3 + r, "B": O3 - 1j * r, "C": O3 - r, "D": O3 + 1j * r}


def ball_axis():
    """Draw the distances of the four points and of the centre from AB, the axis of the ball's rotation."""
    at = _places()
    along = polar(1.0, 45)
    feet = {
        name: at["A"] + ((at[name] - at["A"]) * along.conjugate()).real * along for name in ("O_3", "C", "D")
    }
    return Figure(
        circle(at["O_3"], r),
        centre_line(complex(0, -22), complex(0, 24), label="z"),
        centre_line(at["B"] - 18 * along, at["A"] + 16 * along),
        *(line(at[name], foot, dashed=True) for name, foot in feet.items()),
        vector(at["A"], 14 * along, r"\Omega_{3/0}"),
        contact(at["A"], "A", toward=-20),
        contact(at["B"], "B", toward=-100),
        contact(at["C"], "C", toward=180),
        contact(at["D"], "D", toward=90),
        point(at["O_3"], "O_3", toward=200),
        paper_mm=(100, 50),
    )


def speeds_from_above():
    """Looked at along z: the velocities of the points of the diameter AC, which grow from A."""
    A, O3, C, fast = complex(R + 2 * r), complex(R + r), complex(R), 22.0
    return Figure(
        arc(0, R, -35, 42),
        arc(0, R + 2 * r, -22, 25),
        *(line(polar(R + 2 * r, a), polar(R + 2 * r + 3, a + 2)) for a in range(-21, 24, 4)),
        circle(O3, r),
        line(0, A, dashed=True),
        line(A, C + 1j * fast, dashed=True),
        vector(C, 1j * fast, r"V_C"),
        vector(O3, 0.5j * fast, r"V_{O_3}"),
        line(0, C + 1j * fast, dashed=True),
        point(0, "O_1"),
        point(O3, "O_3", toward=-60),
        contact(A, "A", toward=-40),
        contact(C, "C", toward=-130),
        note(polar(R - 7, -28), "S_1"),
        note(polar(R + 2 * r + 8, 18), "S_0"),
        paper_mm=(100, 52),
    )


def central_axes():
    """The central axes of 3/0, 3/1 and 3/2 meet on z."""
    at = _places()
    S = complex(0, -(R + 2 * r))
    found = []
    for name, label in (("A", "3/0"), ("C", "3/1"), ("D", "3/2")):
        end = S + 1.24 * (at[name] - S)
        found.append(line(S, end, thin=False))
        found.append(note(end + 4 * (end - S) / abs(end - S), label))
    return Figure(
        circle(at["O_3"], r),
        centre_line(S - 8j, complex(0, 34), label="z"),
        centre_line(0, complex(R + 3 * r), label="x_a"),
        *found,
        point(at["O_3"], "O_3", toward=35),
        point(0, "O_1", toward=150),
        contact(at["A"], "A", toward=-30),
        contact(at["B"], "B", toward=-70),
        contact(at["C"], "C", toward=150),
        contact(at["D"], "D", toward=150),
        contact(S, "S", toward=200),
        paper_mm=(100, 74),
    )


def rolling_at_D():
    """Omega 3/2 as Omega 3/0 less that of the shaft; its part along z is the spin, the other the rolling."""
    omega = 30.0
    shaft = 2 * r * omega / (R + r)
    ball_turn, turn = complex(omega, omega), complex(omega, omega + shaft)
    return Figure(
        axes(0, 62, labels=("x_a", "z")),
        vector(0, ball_turn, r"\Omega_{3/0}"),
        vector(ball_turn, 1j * shaft, r"-\dot{\theta}\,z"),
        vector(0, turn, r"\Omega_{3/2}"),
        line(turn, complex(0, turn.imag), dashed=True),
        line(ball_turn, complex(omega), dashed=True),
        point(complex(0, turn.imag), r"\Omega_n", toward=180),
        point(complex(omega), r"\Omega_t", toward=-90),
        paper_mm=(80, 54),
    )


def havens_graph():
    """Joint graph of Havens' gear: four pivots, the slot twice, the rolling contact."""
    places = {
        "0": 0j,
        "1": complex(34, 26),
        "2": complex(74, 26),
        "3": complex(34, -26),
        "4": complex(74, -26),
    }
    return Figure(
        *bodies(places),
        *joint(places["0"], places["1"], "O_1"),
        *joint(places["1"], places["2"], "A_1"),
        *joint(places["0"], places["3"], "O_3"),
        *joint(places["3"], places["2"], "I"),
        *joint(places["0"], places["4"], "O_4"),
        *joint(places["4"], places["2"], "A_1", 6),
        *joint(places["4"], places["2"], "B_2", -6),
        paper_mm=(90, 52),
    )


def slot_translation():
    """The wheel seen from the guide: two points in one straight slot, so every point has one velocity."""
    A1, B2, radius, v = 0j, complex(34), 20.0, complex(17)
    I = polar(radius, 205)
    return Figure(
        section((complex(-40, -3), complex(66, -3), complex(66, -9), complex(-40, -9)), label="S_4"),
        section((complex(-40, 3), complex(66, 3), complex(66, 9), complex(-40, 9))),
        circle(A1, radius, label="2"),
        centre_line(complex(-40), complex(66)),
        vector(A1, v, "V_{2/4}"),
        vector(B2, v, "V_{2/4}"),
        vector(I, v, "V_{2/4}"),
        pin(A1, "A_1"),
        pin(B2, "B_2"),
        contact(I, "I"),
        paper_mm=(115, 55),
    )


def equal_projections():
    """Two points of one body: their velocities have one projection on the line that joins them."""
    A, B_, pole = 0j, complex(56, 14), complex(-30, -40)
    spin = -0.5j
    v_A, v_B = spin * (A - pole), spin * (B_ - pole)
    along = (B_ - A) / abs(B_ - A)
    common = (v_A / along).real * along
    outline = [
        complex(-9, -6),
        complex(24, -9),
        complex(62, 5),
        complex(66, 17),
        complex(40, 22),
        complex(-4, 10),
    ]
    return Figure(
        trace((*outline, outline[0]), dotted=False),
        line(A - 14 * along, B_ + 40 * along),
        vector(A, v_A, "V_A"),
        vector(B_, v_B, "V_B"),
        line(A + v_A, A + common, dashed=True),
        line(B_ + v_B, B_ + common, dashed=True),
        point(A + common, "H_A", toward=-70),
        point(B_ + common, "H_B", toward=-70),
        point(A, "A", toward=-120),
        point(B_, "B", toward=-80),
        paper_mm=(110, 60),
    )


def _havens(b=B):
    """The pose and the six velocities over omega1, complex."""
    crank, e = polar(1.0, THETA1), R2 + R3
    A1 = e * crank
    arm = D + A1
    along = arm / abs(arm)
    v10 = 1j * A1
    omega4 = (v10 / (1j * along)).real / abs(arm)
    v40 = 1j * omega4 * arm
    v40_B = 1j * omega4 * (abs(arm) + b) * along
    slide = v10 - v40
    return {
        "O4": complex(-D),
        "A1": A1,
        "B2": A1 + b * along,
        "I": R3 * crank,
        "along": along,
        "crank": crank,
        "v10": v10,
        "v40": v40,
        "v14": slide,
        "v40_B": v40_B,
        "v20": slide + v40_B,
        "v30": v10 - 1j * omega4 * R2 * crank,
    }


def _havens_parts(at):
    """The gear itself, beneath a construction."""
    return [
        slot_link(at["O4"], at["B2"] + 9 * at["along"]),
        circle(0j, R3),
        circle(at["A1"], R2),
        link(0j, at["A1"]),
        ground_pivot(at["O4"], "O_4"),
        ground_pivot(0j, "O_1"),
        pin(at["A1"], "A_1"),
        pin(at["B2"], "B_2"),
        contact(at["I"], "I"),
    ]


_SIZE = (112.0, 76.0)
_SCALE = 0.9  #: mm of mechanism for one mm of velocity over omega1


def havens():
    """The gear, with the velocity that is known."""
    at = _havens()
    return Figure(
        *_havens_parts(at),
        vector(at["A1"], _SCALE * at["v10"], "V_{1/0}"),
        angle_mark(0j, 0, THETA1, r"\theta_1", radius=8),
        note(polar(R3, -50) * 1.35, "3"),
        note(at["A1"] + polar(R2, 150) * 1.15, "2"),
        note(at["B2"] + 14 * at["along"], "4"),
        note(0.62 * at["A1"] + 5 * 1j * at["crank"], "1"),
        paper_mm=_SIZE,
    )


def havens_at_A1():
    """First step: the velocity of A1 along the slot and across it."""
    at = _havens()
    v10, v40, v14 = (_SCALE * at[name] for name in ("v10", "v40", "v14"))
    across = v40 / abs(v40)
    return Figure(
        *_havens_parts(at),
        line(at["A1"], at["A1"] + v40 + 14 * across, dashed=True),
        line(at["A1"] + v10 + 8 * at["along"] * -1, at["A1"] + v40 + 10 * at["along"], dashed=True),
        vector(at["A1"], v10, "V_{1/0}"),
        vector(at["A1"], v40, "V_{4/0}"),
        vector(at["A1"] + v40, v14, "V_{1/4}"),
        paper_mm=_SIZE,
    )


def havens_at_B2():
    """Second step: the guide carries B2 farther than A1, and the slide is added."""
    at = _havens()
    v40, v40_B, v14, v20 = (_SCALE * at[name] for name in ("v40", "v40_B", "v14", "v20"))
    return Figure(
        *_havens_parts(at),
        vector(at["A1"], v40, "V_{4/0}(A_1)"),
        line(at["O4"], at["B2"] + v40_B, dashed=True),
        vector(at["B2"], v40_B, "V_{4/0}(B_2)"),
        vector(at["B2"] + v40_B, v14, "V_{2/4}(B_2)"),
        vector(at["B2"], v20, "V_{2/0}(B_2)"),
        paper_mm=_SIZE,
    )


def havens_at_I():
    """Third step: equal projections on B2 I, and a direction across the crank."""
    at = _havens()
    v20, v30 = _SCALE * at["v20"], _SCALE * at["v30"]
    way = (at["I"] - at["B2"]) / abs(at["I"] - at["B2"])
    part = (v20 / way).real * way
    across = 1j * at["crank"]
    return Figure(
        *_havens_parts(at),
        line(at["B2"] - 8 * way, at["I"] + part + 8 * way),
        line(at["B2"] + v20, at["B2"] + part, dashed=True),
        line(at["I"] - 8 * across, at["I"] + v30 + 8 * across, dashed=True),
        line(at["I"] + part, at["I"] + v30, dashed=True),
        vector(at["B2"], v20, "V_{2/0}(B_2)"),
        vector(at["I"], v30, "V_{3/0}(I)"),
        point(at["B2"] + part, "H"),
        point(at["I"] + part, "K"),
        paper_mm=_SIZE,
    )


# ------------------------------------------------------------------ trains to be read


def trains_to_be_read():
    """Four trains of wheels by their pitch circles, the driver on the left or inside, with its sense."""

    def drawn(*wheels, inner=()):
        elements = [circle(at, r) for at, r in wheels]
        elements += [ground_pivot(at) for at, r in wheels]
        return [
            *elements,
            *(circle(at, r, dashed=True) for at, r in inner),
            rotation_arrow(0, 12.0, -40, 220, r"\omega"),
        ]

    drawings = [
        drawn((0, 20.0), (60, 40.0)),
        drawn((0, 20.0), (30, 10.0), (80, 40.0)),
        drawn((0, 20.0), (-20, 40.0)),
        drawn((0, 15.0), (45, 30.0), (95, 40.0), inner=((45, 10.0),)),
    ]
    return Figure(*rows_of(drawings, 4, 100 + 80j), paper_mm=(165, 60))
