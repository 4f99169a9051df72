"""Sheets made by hand, in both languages, for the tests of the rendering."""

from __future__ import annotations

import cmath
from dataclasses import replace

from coursework.figures import Figure, angle_mark, axes, dimension, ground_pivot, link, pin, slider, slot_link
from coursework.sheets.sheet import (
    Answer,
    AnswerSheet,
    FeedbackLine,
    FeedbackSheet,
    GivenValue,
    Handout,
    Question,
    Remark,
    Step,
)

TEXTS = {
    "fr": {
        "course": "Cinématique des mécanismes plans",
        "title": "Mécanisme à coulisse",
        "statement": (
            "La manivelle $O_2A$, de longueur $r_2$, tourne autour du pivot fixe $O_2$. Son extrémité "
            "$A$ porte un "
            "coulisseau qui glisse dans la rainure d'un guide articulé au bâti en $O_4$. On pose "
            r"$\overrightarrow{O_4O_2} = r_1\,\mathrm{e}^{i\theta_1}$ et "
            r"$\overrightarrow{O_4A} = r_A\,\mathrm{e}^{i\theta_4}$, avec $r_A > 0$."
            "\n\n"
            "Les angles se mesurent depuis l'axe $x$, dans le sens direct. L'égalité des deux chemins "
            "de $O_4$ vers $A$ s'écrit :"
            "\n\n"
            r"$$r_A\,\mathrm{e}^{i\theta_4} = r_1\,\mathrm{e}^{i\theta_1} + r_2\,\mathrm{e}^{i\theta_2}$$"
        ),
        "alt": "Mécanisme à coulisse : manivelle O2A, guide rainuré O4A, bâti O4O2 vertical",
        "prompts": (
            "Écrire l'équation qui donne $r_A$ en fonction de $r_1$, $r_2$, $\\theta_1$ et $\\theta_2$.",
            "Distance du coulisseau au pivot du guide",
            "Angle du guide",
            "Le guide fait-il des tours complets ?",
            "Amplitude du mouvement du guide",
            "Vitesse de glissement du coulisseau dans la rainure",
            "Vitesse angulaire du guide",
            "Accélération angulaire du guide",
            "Accélération de Coriolis, mesurée suivant $i\\,\\mathrm{e}^{i\\theta_4}$",
            "Coordonnées de $A$ dans le repère $(O_4, x, y)$",
        ),
        "choices": (("rotates", "il fait des tours complets"), ("oscillates", "il oscille")),
        "tolerance": "à 1 % près",
        "angle_tolerance": "à 0,5° près",
        "introduction": "La boucle $O_4$, $O_2$, $A$ se ferme : ses deux chemins donnent le même vecteur.",
        "words": (
            "Le vecteur $\\overrightarrow{O_4A}$ a pour norme",
            "et pour direction",
            "En dérivant la fermeture, il vient",
        ),
        "remark": "L'arc tangente du quotient oublie le quadrant : il se trompe de 180° quand $x_A < 0$.",
        "says": "Le signe est opposé : relisez le sens positif des angles.",
    },
    "en": {
        "course": "Kinematics of plane mechanisms",
        "title": "Slotted mechanism",
        "statement": (
            "The crank $O_2A$, of length $r_2$, turns about the fixed pivot $O_2$. Its end $A$ carries "
            "a block that "
            "slides in the slot of a guide hinged to the frame at $O_4$. Write "
            r"$\overrightarrow{O_4O_2} = r_1\,\mathrm{e}^{i\theta_1}$ and "
            r"$\overrightarrow{O_4A} = r_A\,\mathrm{e}^{i\theta_4}$, with $r_A > 0$."
            "\n\n"
            "Angles are measured from the $x$ axis, anticlockwise. The two ways from $O_4$ to $A$ "
            "give the same vector:"
            "\n\n"
            r"$$r_A\,\mathrm{e}^{i\theta_4} = r_1\,\mathrm{e}^{i\theta_1} + r_2\,\mathrm{e}^{i\theta_2}$$"
        ),
        "alt": "Slotted mechanism: crank O2A, slotted guide O4A, vertical frame O4O2",
        "prompts": (
            "Write the equation that gives $r_A$ from $r_1$, $r_2$, $\\theta_1$ and $\\theta_2$.",
            "Distance from the block to the guide's pivot",
            "Angle of the guide",
            "Does the guide make full turns?",
            "Swing of the guide",
            "Sliding velocity of the block in the slot",
            "Angular velocity of the guide",
            "Angular acceleration of the guide",
            "Coriolis acceleration, measured along $i\\,\\mathrm{e}^{i\\theta_4}$",
            "Coordinates of $A$ in the frame $(O_4, x, y)$",
        ),
        "choices": (("rotates", "it makes full turns"), ("oscillates", "it swings")),
        "tolerance": "within 1%",
        "angle_tolerance": "within 0.5°",
        "introduction": "The loop $O_4$, $O_2$, $A$ closes: its two paths give the same vector.",
        "words": (
            "The vector $\\overrightarrow{O_4A}$ has the norm",
            "and the direction",
            "The rate of the closure gives",
        ),
        "remark": "The arctangent of the quotient forgets the quadrant: it is off by 180° when $x_A < 0$.",
        "says": "The sign is opposite: look again at which way angles are positive.",
    },
}

_QUESTIONS = (
    ("relation", "", "", "equation", 1),
    ("rA", "r_A", "mm", "number", 1),
    ("theta4", r"\theta_4", "°", "angle", 2),
    ("guide", "", "", "choice", 0.5),
    ("swing", r"\Delta\theta_4", "°", "number", 1),
    ("rA_dot", r"\dot r_A", "mm/s", "number", 2),
    ("omega4", r"\omega_4", "rad/s", "number", 2),
    ("alpha4", r"\alpha_4", "rad/s²", "number", 2),
    ("a_coriolis", r"a_c", "mm/s²", "number", 1),
    ("A", "A", "mm", "point", 1.5),
)

# What no student's sheet may hold: the answers of this variant, as digits.
ANSWER_DIGITS = ("319.8", "319,8", "104.64", "104,64", "104.6", "104,6")


def figure() -> Figure:
    pivot, centre = 0j, 228.6j
    tip = centre + 114.3 * cmath.exp(1j * cmath.pi * 0.75)
    angle = cmath.phase(tip) * 180 / cmath.pi
    return Figure(
        axes(pivot, 90),
        slot_link(pivot, tip * 1.25),
        link(centre, tip, label="r_2"),
        slider(tip, direction=angle),
        ground_pivot(pivot, label="O_4"),
        ground_pivot(centre, label="O_2"),
        pin(tip, label="A"),
        angle_mark(pivot, 0, angle, label=r"\theta_4"),
        angle_mark(centre, 0, 135, label=r"\theta_2"),
        dimension(pivot, centre, label="r_1", offset=-60),
    )


def handout(lang: str, *, student: str = "") -> Handout:
    text = TEXTS[lang]
    questions = tuple(
        Question(
            number=number,
            id=name,
            symbol=symbol,
            prompt=prompt,
            unit=unit,
            kind=kind,
            choices=text["choices"] if kind == "choice" else (),
            points=points,
            tolerance=text["angle_tolerance"] if unit == "°" else text["tolerance"] if unit else "",
        )
        for number, ((name, symbol, unit, kind, points), prompt) in enumerate(
            zip(_QUESTIONS, text["prompts"], strict=True), start=1
        )
    )
    given = (
        GivenValue("r1", "r_1", "228.6", "mm"),
        GivenValue("theta1", r"\theta_1", "90", "°"),
        GivenValue("r2", "r_2", "114.3", "mm"),
        GivenValue("theta2", r"\theta_2", "135", "°"),
        GivenValue("omega2", r"\omega_2", "-12.5", "rad/s"),
        GivenValue("alpha2", r"\alpha_2", "0", "rad/s²"),
    )
    return Handout(
        lang=lang,
        course=text["course"],
        exercise="slotted_mechanism",
        version=1,
        seed=42,
        student=student,
        title=text["title"],
        statement=text["statement"],
        given=given,
        figure=figure(),
        figure_alt=text["alt"],
        questions=questions,
        record={
            "exercise": "slotted_mechanism",
            "version": 1,
            "seed": 42,
            "lang": lang,
            "given": {g.name: {"value": float(g.value), "unit": g.unit} for g in given},
        },
    )


def answer_sheet(lang: str, *, student: str = "") -> AnswerSheet:
    text = TEXTS[lang]
    sheet = handout(lang, student=student)
    values = {
        "rA": r"$\num{319.8}\,\mathrm{mm}$",
        "theta4": r"$\num{104.64}\text{°}$",
        "guide": text["choices"][1][1],
    }
    margins = {"rA": "3,2 mm" if lang == "fr" else "3.2 mm", "theta4": "0,5°" if lang == "fr" else "0.5°"}
    steps = (
        Step(
            "rA",
            "r_A",
            r"\sqrt{r_1^2 + r_2^2 + 2\,r_1 r_2\cos(\theta_2 - \theta_1)}",
            r"\sqrt{\num{228.6}^2 + \num{114.3}^2 + 2\times\num{228.6}\times\num{114.3}\cos(135^\circ "
            r"- 90^\circ)}",
            r"\num{319.8}\ \mathrm{mm}",
            text["words"][0],
            (),
            True,
        ),
        Step(
            "theta4",
            r"\theta_4",
            r"\operatorname{atan2}(y_A, x_A)",
            "",
            r"\num{104.64}^\circ",
            text["words"][1],
            (Remark(text["remark"], r"$\num{-75.4}^{\circ}$"),),
            True,
        ),
        Step(
            "omega4",
            r"\omega_4",
            r"\frac{r_2\,\omega_2\left(\cos\theta_2\cos\theta_4 + \sin\theta_2\sin\theta_4\right)}{r_A}",
            r"\frac{\num{114.3}\times(\num{-12.5})\left(\cos 135^\circ\cos\num{104.64}^\circ + \sin "
            r"135^\circ\sin\num{104.64}^\circ\right)}{\num{319.8}}",
            r"\num{-3.855}\ \mathrm{rad/s}",
            text["words"][2],
            (),
            True,
        ),
    )
    answers = tuple(
        Answer(question, values.get(question.id, r"$\num{-3.855}$"), margins.get(question.id, ""))
        for question in sheet.questions
    )
    return AnswerSheet(sheet, answers, steps, text["introduction"], None)


def feedback_sheet(lang: str, *, student: str = "") -> FeedbackSheet:
    text = TEXTS[lang]
    sheet = handout(lang, student=student)
    outcomes = {
        "rA": ("0,32 m", "320 mm", "correct", 1, ""),
        "theta4": ("-75.4", "-75.4°", "mistake:arctan_without_quadrant", 1, text["remark"]),
        "guide": ("", "", "missing", 0, ""),
        "omega4": ("3,9 rad/s", "3.9 rad/s", "slip:sign", 1, text["says"]),
        "alpha4": ("<b>#x$", "", "unreadable", 0, ""),
    }
    lines = tuple(
        FeedbackLine(question, *outcomes[question.id][:4], question.points, outcomes[question.id][4])
        for question in sheet.questions
        if question.id in outcomes
    )
    return FeedbackSheet(sheet, lines, sum(line.points for line in lines), sum(line.out_of for line in lines))


def many_given(lang: str) -> Handout:
    """A sheet with no figure and nineteen given quantities."""
    given = tuple(GivenValue(f"r{k}", f"r_{{{k}}}", f"{k * 12.5}", "mm") for k in range(1, 19))
    choice = GivenValue("mode", r"\text{mode}", "ouvert" if lang == "fr" else "open", "", is_number=False)
    return replace(handout(lang), given=(*given, choice), figure=None, figure_alt="")
