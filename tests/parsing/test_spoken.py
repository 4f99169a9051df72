"""Words beside numbers are read; what is not an answer is none; what may be two things waits. One table a
promise."""

import math

import pytest
from sweeps import whole_course

import coursework
from coursework.issuing.issuing import distinct_variants
from coursework.language.numbers import significant
from coursework.marking.answers import read
from coursework.marking.feedback import echo
from coursework.parsing.numbers import read_integer, read_number
from coursework.parsing.spoken import bare, refers_elsewhere, says_nothing

COURSE = coursework.open_course()


def test_numbers_with_words_signs_and_senses_are_read():
    table = [
        ("moins 18,32", "mm", -18.32),
        ("minus 18.32", "mm", -18.32),
        ("à peu près 15,2°", "deg", 15.2),
        ("roughly 15.2", "deg", 15.2),
        ("-414,6 ± 0,5", "mm", -414.6),
        ("414.6 mm +/- 0.5 mm", "mm", 414.6),
        ("200 mm + 70 mm", "mm", 270),
        ("20 cm - 70 mm", "mm", 130),
        ("270 + 0", "mm", 270),
        ("12 rad.s-²", "rad/s^2", 12),
        ("12 mm·s-¹", "mm/s", 12),
        ("105 deg 9 min", "deg", 105.15),
        ("105 degrés 9 minutes", "deg", 105.15),
        ("20,54 rad/s (sens horaire)", "rad/s", -20.54),
        ("-20.54 rad/s, clockwise", "rad/s", -20.54),
        ("20.54 rad/s counterclockwise", "rad/s", 20.54),
        ("201,5 mm/s vers la droite", "mm/s", 201.5),
        ("201.5 mm/s to the left", "mm/s", -201.5),
        ("d'où -39,4°", "deg", -39.4),
        ("soit environ 39,4 °", "deg", 39.4),
        ("on trouve −2,5 mm", "mm", -2.5),
        ("est égal à 3 mm", "mm", 3),
        ("⇒ 12,5 mm", "mm", 12.5),
        ("≅ -12,5 mm", "mm", -12.5),
        ("~= 12,5 mm", "mm", 12.5),
        ("-12,5 mm environ", "mm", -12.5),
        ("12,5 mm (arrondi)", "mm", 12.5),
        ("12,5 mm à 0,1 près", "mm", 12.5),
        ("39,417... °", "deg", 39.417),
        ("-39,4° [360°]", "deg", -39.4),
        ("39,4° (modulo 360°)", "deg", 39.4),
        ("[360]", "mm", 360),
        ("[12,5 mm]", "mm", 12.5),
        ("{1,25 cm}", "mm", 12.5),
        ("[-3,2] mm", "mm", -3.2),
        ("[2 + 1]*[3]", "1", 9),
        ("**12,5 mm**", "mm", 12.5),
        ("_12.5 mm_", "mm", 12.5),
        ("`12.5`", "mm", 12.5),
        ("rA = **12,5** mm.", "mm", 12.5),
        ("**1,25 * 10**1**", "mm", 12.5),
        ("2**3**2", "1", 512),
        ("2 ** 3", "1", 8),
        (" [360°]", "deg", 360),
        ("-3,94 x 10 puissance 1 °", "deg", -39.4),
        ("3,94 10exp1 mm", "mm", 39.4),
        ("(-)39,4 °", "deg", -39.4),
        ("39,4 degrés décimaux", "deg", 39.4),
        ("116,77 mm soit 11,677 cm", "mm", 116.77),
        ("15,4 mètres par seconde au carré", "mm/s^2", 15400),
        ("2 radians par seconde carrée", "rad/s^2", 2),
        ("2,05 (sans unité)", "1", 2.05),
        ("4,7 rad/s (sens anti-horaire)", "rad/s", 4.7),
        ("4,7 rad/s, sens négatif", "rad/s", -4.7),
        ("so, about 12 mm", "mm", 12),
        ("ω3 = 4,2 rad/s horaire", "rad/s", -4.2),
        ("4 rad/s ↻", "rad/s", -4),
        ("3 mm/s ↑", "mm/s", 3),
        ("v = 3 mm/s dirigée vers le bas", "mm/s", -3),
        ("12,5 mm (mesuré)", "mm", 12.5),
        ("12,5 mm ?", "mm", 12.5),
        ("la réponse est 12,5 mm", "mm", 12.5),
        ("4 rad/s sens rétrograde", "rad/s", -4),
        ("racine(2)", "1", math.sqrt(2)),
        ("square root of 2", "1", math.sqrt(2)),
        ("sin⁻¹(0,5)", "deg", 30),
        ("cos^-1(0.5)", "deg", 60),
        (
            "sqrt(185^2+115^2+2*185*115*sin(130))",
            "mm",
            math.sqrt(185**2 + 115**2 + 2 * 185 * 115 * math.sin(math.radians(130))),
        ),
        ("115 cos 25", "mm", 115 * math.cos(math.radians(25))),
        ("100 sin(1.5708)", "mm", 100),
        ("100 sin(π/6)", "mm", 50),
    ]
    wrong = []
    for text, unit, value in table:
        reading = read_number(text, unit, thousands=unit != "deg")
        if not (reading.values and math.isclose(reading.values[0], value, rel_tol=1e-6)):
            wrong.append((text, reading))
    assert wrong == []
    assert [read_integer(t).values for t in ("cinq", "five", "moins deux", "3 liaisons")] == [
        (5,),
        (5,),
        (-2,),
        (3,),
    ]


def test_what_may_be_degrees_or_radians_and_a_sign_against_its_words_wait():
    for text in (
        "115*sin(0.5)",
        "cos(3)",
        "-20 rad/s (counterclockwise)",
        "319.8 ± 50",
        "12 rad/s soit 13 rad/s",
        "1...5",
    ):
        assert read_number(text, "rad/s").status == "unreadable", text


def test_no_answer_in_words_is_none_and_another_place_is_told_as_such():
    none = (
        "?",
        "-",
        "/",
        "X",
        "…",
        "NSP",
        "je ne sais pas",
        "Désolé, pas eu le temps",
        "néant",
        "I don't know how",
        "n/a",
        "—",
        "pas trouvé",
    )
    assert [t for t in none if not says_nothing(t)] == []
    assert [t for t in ("12", "pivot", "3 ?", "wz", "je trouve 12") if says_nothing(t)] == []
    assert all(map(refers_elsewhere, ("voir feuille", "cf copie", "cf. copie", "see sheet")))


#: What leads to an answer, stands about it or behind it, and says nothing of it.
ABOUT_AN_ANSWER = (
    "réponse : {}",
    "Réponse: **{}**",
    "The answer is {}",
    "=> {}",
    "→ {}",
    "• {}",
    "c’est {}",
    "je pense que c'est {}",
    "I think it is {}",
    "donc {}",
    "[{}]",
    "({})",
    "{} (sûr)",
    "{}…",
    "**{}**",
    "`{}`",
)


def as_written(variant, part):
    """The right answer to a part as a text."""
    value = variant.key.reference[part.quantity]
    if part.kind == "choice":
        return variant.label(part.quantity, value)
    if isinstance(value, float) and part.unit != "1":
        return f"{significant(value, 6)} {part.unit}"
    return next(s.answer for s in part.sort.spellings(part, value, str) if isinstance(s.answer, str))


def test_what_stands_about_an_answer_of_any_kind_changes_no_verdict():
    """A part of each kind of the course, alone on its sheet."""
    kinds, changed = {}, []
    for name in COURSE.names:
        variant = COURSE[name].variant(3, "fr")
        for part in variant.parts:
            if not part.sort.is_open and kinds.setdefault(part.kind, name) == name:
                text = as_written(variant, part)
                verdict = variant.grade({part.id: text})[part.id].verdict
                assert verdict not in ("unreadable", "missing"), (name, part.id, text)
                said = [s.format(text) for s in ABOUT_AN_ANSWER]
                changed += [s for s in said if variant.grade({part.id: s})[part.id].verdict != verdict]
    assert len(kinds) > 10
    assert changed == []


def test_what_is_read_is_told_back_whole_in_every_exercise():
    cut = []
    for name in COURSE.names:
        variant = COURSE[name].variant(3, "fr")
        for part in variant.parts:
            value = variant.key.reference[part.quantity]
            if not part.sort.is_open and not isinstance(value, (int, float)):
                answer = value if isinstance(value, str) else value.tolist()
                (read_as, *_) = read(variant, part, answer).read_as
                if "…" in echo(read_as, "fr"):
                    cut.append((name, part.id, read_as))
    assert cut == []


def test_a_letter_or_another_answer_are_two_and_no_word_before_one():
    assert [bare(text) for text in ("d'où b", "d’où b", "d'ou b", "D'où : b")] == ["b"] * 4
    assert [bare(text) for text in ("d ou b", "D ou b")] == ["d ou b", "D ou b"]


def test_what_denies_or_doubts_an_answer_is_none():
    variant = COURSE["vocabulary"].variant(0, "fr")
    part = next(p for p in variant.parts if p.kind == "choice")
    label, other = (variant.label(part.quantity, case) for case in part.choices[:2])
    for text in (
        f"je pense que ce n'est pas {label}",
        f"I don't think it is {label}",
        f"c'est {label} ou {other}",
        f"I think {label}?",
        "I think so",
        "c'est",
        "réponse :",
    ):
        assert variant.grade({part.id: text})[part.id].verdict in ("unreadable", "missing"), text


@whole_course
@pytest.mark.parametrize("lang", ["fr", "en"])
def test_no_kind_of_part_calls_a_text_without_answer_unreadable(lang):
    """In every exercise: what says that there is no answer is missing, and another place waits as such."""
    wrong = []
    for name in COURSE.names:
        (variant,) = distinct_variants(COURSE[name], 0, 1, lang)
        parts = [
            p
            for p in variant.parts
            if not p.sort.is_open and p.kind not in ("wrench_pattern", "twist_pattern")
        ]
        for text, expected in (
            ("NSP", "missing"),
            ("pas le temps", "missing"),
            ("??", "missing"),
            ("see sheet", "unreadable"),
        ):
            marking = variant.grade({p.id: text for p in parts})
            wrong += [
                (name, p.id, text, marking[p.id].verdict) for p in parts if marking[p.id].verdict != expected
            ]
    assert wrong == []


@whole_course
def test_two_values_a_lost_superscript_and_a_raised_dot_wait_in_every_exercise():
    wrong = []
    for name in COURSE.names:
        (variant,) = distinct_variants(COURSE[name], 0, 1, "fr")
        for part in (p for p in variant.parts if p.kind == "number" and not p.judge):
            value = float(variant.key.reference[part.quantity])
            if not value or not 1e-3 < abs(value) < 1e6:
                continue
            right = significant(value, 5)
            power = math.floor(math.log10(abs(value)))
            doubtful = [f"{right} / {significant(value, 4)}", f"{right} / 7"]
            if 1 <= power <= 5:
                doubtful.append(f"{value / 10**power:.4f}.10{power}".replace(".", ",", 1))
            for text in doubtful:
                mark = variant.grade({part.id: text})[part.id]
                if mark.verdict not in ("unreadable", "correct"):
                    wrong.append((name, part.id, text, mark.verdict))
    assert wrong == []


def test_answers_are_quoted_as_they_were_typed():
    variant = COURSE["slotted_mechanism"].variant(1, "en")
    for text, quoted in (
        ("90<105", "90<105"),
        ("(17 | -680, 0)", "(17 | -680, 0)"),
        ("12 m/s²", "m/s²"),
        ("5 `x` $y$", "5 `x` $y$"),
    ):
        assert f"“{quoted}”" in variant.grade({"rA": text})["rA"].feedback
    assert read_number("5 rad/s**2", "rad/s^2").read_as == ("5 rad/s**2",)


def test_an_equation_is_read_with_dots_and_told_how_to_be_written():
    variant = COURSE["slotted_mechanism"].variant(1, "en", ("all",))
    marks = [
        variant.grade({"loop_1_x": t})["loop_1_x"]
        for t in ("r2*cos(theta2) = rA*cos(theta4)", "r2.cos(theta2)=rA.cos(theta4)")
    ]
    assert [m.verdict for m in marks] == ["correct", "correct"]
    assert "as an equation" in variant.grade({"loop_1_x": "r2 cos(theta2) ="})["loop_1_x"].feedback


def test_rows_of_two_by_commas_are_rows():
    variant = COURSE["joint_twist"].variant(1, "en", ("all",))
    parts = [p.id for p in variant.parts if p.kind == "twist_pattern"]
    assert parts
    for part in parts:
        by_commas, by_semicolons = (
            variant.grade({part: text})[part].read_as for text in ("{0 vx, wy 0, 0 vz}", "{0 vx; wy 0; 0 vz}")
        )
        assert by_commas == by_semicolons
