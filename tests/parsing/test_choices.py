"""A choice is known by all that people write for it, and by nothing that says another."""

import random

from strategies import CHOICES
from sweeps import at_once, seeds
from tables import each_row

import coursework
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.parsing.choices import read_choice

COURSE = coursework.open_course()
WITH_CHOICES = [n for n in COURSE.names if any(part.kind == "choice" for part in COURSE[n].spec.parts)]


@each_row(
    ("text", "key"),
    [(s, "crank-rocker") for s in ("crank-rocker", "Crank Rocker", "MANIVELLE BALANCIER", "a) crank-rocker")]
    + [
        (s, "double_crank")
        for s in ("double_crank", "double crank", "drag  link", "b) drag link", "3. Double manivelle")
    ]
    + [(s, "at_rest") for s in ("A et B sont a l’arret", "a and b are at rest.", "C : at rest")],
)
def test_a_choice_is_known_by_key_or_label(text, key):
    assert read_choice(text, CHOICES).values == (key,)


@each_row(
    ("text", "code"),
    [
        ("rocker", "not_a_choice"),
        ("b) rocker", "not_a_choice"),
        (True, "not_a_choice"),
        (1.0, "not_a_choice"),
        ("x" * 10_000, "too_long"),
        *[(s, "not_a_choice") for s in ("a", "(a)", "b)", "c", "d", "0", "1", 1, "2)", "3", "II")],
    ],
)
def test_what_is_no_choice_says_so(text, code):
    reading = read_choice(text, CHOICES)
    assert (reading.status, reading.code, reading.text) == ("unreadable", code, str(text))


CLASSES = {"IV": ("IV",), "III": ("III, celle du plus haut groupe",), "II": ("classe II", "class II")}
PAIRS = {
    "one": ("une paire", "paire", "one pair"),
    "two": ("deux paires", "two pairs"),
    "three": ("trois paires",),
}
COUNTS = {"zero": ("0",), "three": ("3",), "one": ("1",)}


@each_row(
    ("text", "choices", "key"),
    [
        *[
            (s, CLASSES, "III")
            for s in (
                "3",
                3,
                "3.0",
                "(3)",
                "3)",
                "III",
                "iii",
                "classe III",
                "la classe 3",
                "class 3",
                "trois",
            )
        ],
        *[(s, CLASSES, "II") for s in ("2", "II", "classe II", "2.", "two")],
        ("4", CLASSES, "IV"),
        *[(s, PAIRS, "two") for s in ("2", "deux", "Two", "2 paires", "2 pairs", "deux paires")],
        *[(s, PAIRS, "one") for s in ("1", "une", "un", "one", "1 paire")],
        *[(s, COUNTS, "three") for s in ("3", "trois", "three")],
        ("zéro", COUNTS, "zero"),
        ("1", COUNTS, "one"),
    ],
)
def test_a_number_names_the_label_that_it_begins_and_never_a_place(text, choices, key):
    assert read_choice(text, choices).values == (key,)


@each_row(
    ("text", "choices"),
    [
        ("1", CLASSES),
        ("5", CLASSES),
        ("2", COUNTS),
        ("4", PAIRS),
        ("2 pivots", PAIRS),
        ("b", CLASSES),
        ("2 ou 3", CLASSES),
        (
            "1",
            {
                "two_rockers": ("deux balanciers",),
                "one": ("une manivelle",),
                "two_cranks": ("deux manivelles",),
            },
        ),
    ],
)
def test_a_number_that_begins_no_label_or_tells_none_apart_is_no_choice(text, choices):
    assert read_choice(text, choices).code == "not_a_choice"


def test_a_mark_that_names_another_choice_than_the_label_behind_it_is_two():
    assert read_choice("2) III", CLASSES).code == "two_values"


@seeds(12, 60)
def test_a_number_names_the_same_choice_of_every_exercise_however_it_is_written(seeds):
    """No number, Roman numeral or letter reads as a choice whose labels do not begin with that number."""
    romans, course = ("", "I", "II", "III", "IV", "V"), coursework.open_course()
    for name in ("vocabulary", "assour"):
        for variant in course[name].variants(seeds, "fr"):
            for part in (p for p in variant.parts if p.kind == "choice"):
                known = variant.labels(part)
                for n in range(1, 6):
                    found = {
                        read_choice(text, known).values for text in (str(n), f"({n})", f"{n}.", romans[n])
                    } - {()}
                    for (key,) in found:
                        begins = {
                            label.lstrip("$wmu_= ").replace("classe ", "").replace("class ", "")
                            for label in known[key]
                        }
                        words = {1: ("un", "one"), 2: ("deux", "two"), 3: ("trois", "three")}.get(n, ())
                        assert any(b.startswith((str(n), romans[n], *words)) for b in begins), (
                            part.id,
                            n,
                            key,
                        )
                for letter in "bcdefgh":
                    assert letter in known or not read_choice(letter, known).values


def test_a_label_of_two_choices_chooses_neither():
    assert read_choice("same", {"p": ("same",), "q": ("same",)}).code == "two_values"


@each_row(
    ("text", "key"),
    [
        ("isostatique", "iso"),
        ("Hyperstatic", "hyper"),
        ("un pivot", "pivot"),
        ("none", "none"),
        ("aucune", "none"),
        ("II", "II"),
    ],
)
def test_a_choice_is_known_by_what_stands_before_its_explanation(text, key):
    choices = {
        "iso": ("isostatique, tout se calcule", "isostatic, all is known"),
        "hyper": ("hyperstatique, rien ne va", "hyperstatic, some is not"),
        "pivot": ("un pivot (rotation seule)", "a pivot (rotation alone)"),
        "none": ("aucune : tout est libre", "none: all is free"),
        "II": ("II",),
        "twice": ("II, deux fois",),
    }
    assert read_choice(text, choices).values == (key,)


FORMULAS = {
    "one": ("$w = 1$",),
    "minus_one": ("$w = -1$",),
    "zero": ("$w = 0$",),
    "two": ("$w = 2$",),
    "six": ("$h = N_s - 6$",),
    "rank": ("$h = N_s - r_s$",),
    "turn": ("une rotation", "rotation"),
}


@each_row(
    ("text", "key"),
    [
        *[(s, "minus_one") for s in ("w = − 1", "w = -1", "w=-1", "w = −1", "$w = -1$", "-1", "− 1", "W=-1")],
        *[(s, "one") for s in ("w = 1", "w=1", "w =1", "1", "a) w = 1")],
        *[(s, "zero") for s in ("0", "w=0")],
        ("2", "two"),
        *[(s, "rank") for s in ("h=N_s-r_s", "h = N_s − r_s", "h = Ns - rs", "N_s - r_s")],
        ("h=N_s-6", "six"),
        *[(s, "turn") for s in ("la rotation", "c'est une rotation", "a rotation", "Rotation")],
    ],
)
def test_a_formula_offered_is_read_with_its_signs_whatever_its_spaces(text, key):
    assert read_choice(text, FORMULAS).values == (key,)


@each_row(
    ("text", "code"),
    [
        ("w = -2", "not_a_choice"),
        ("-0,5", "not_a_choice"),
        ("3", "not_a_choice"),
        ("h = N_s + 6", "not_a_choice"),
    ],
)
def test_a_sign_or_a_place_never_makes_another_formula(text, code):
    assert read_choice(text, FORMULAS).code == code


@at_once(WITH_CHOICES, WITH_CHOICES[::4])
def test_no_two_cases_of_the_course_have_one_label(course, names):
    for name in names:
        for lang in ("fr", "en"):
            for variant in course[name].variants(range(3), lang):
                for part in (p for p in variant.parts if p.kind == "choice"):
                    known = variant.labels(part)
                    for key, labels in known.items():
                        for label in (key, *labels):
                            assert read_choice(label, known).values == (key,), (name, part.id, label)


JOINTS = {
    "revolute": ("une liaison pivot", "liaison pivot", "a revolute joint", "revolute joint"),
    "cylindrical": (
        "une liaison pivot glissant",
        "liaison pivot glissant",
        "a cylindrical joint",
        "cylindrical joint",
    ),
    "free": ("l'absence de liaison", "no joint at all"),
    "double-rocker": ("un double balancier dont la bielle tourne", "double balancier dont la bielle tourne"),
    "rocker-crank": ("balancier-manivelle : l'entrée oscille",),
    "limit": ("cas limite de la loi : les barres s'alignent",),
    "both": ("une manivelle et un balancier",),
    "bodies": ("même point, pièces différentes",),
    "places": ("même endroit, mêmes pièces",),
    "oscillates": ("oscille",),
    "rotates": ("fait un tour complet", "makes a full turn"),
}


@each_row(
    ("text", "key"),
    [
        *[
            (s, "revolute")
            for s in (
                "pivot",
                "un pivot",
                "Pivot.",
                "liaison pivot",
                "revolute",
                "a revolute joint",
                "« pivot »",
            )
        ],
        *[(s, "cylindrical") for s in ("pivot glissant", "un pivot glissant", "cylindrical")],
        *[
            (s, "double-rocker")
            for s in ("double balancier", "un double balancier", "Double balancier dont la bielle")
        ],
        *[(s, "limit") for s in ("cas limite", "un cas limite", "cas limite de la loi")],
        ("balancier-manivelle", "rocker-crank"),
        ("même point pièces différentes", "bodies"),
        *[
            (s, "oscillates")
            for s in ("oscille (r2 < r1)", "il oscille (r2 < r1)", "&laquo; oscille &raquo;")
        ],
        ("fait un tour complet (r2 > r1)", "rotates"),
    ],
)
def test_a_choice_is_known_by_what_tells_it_from_all_others(text, key):
    assert read_choice(text, JOINTS).values == (key,)


@each_row(
    "text",
    [
        "liaison",
        "glissant",
        "balancier",
        "double",
        "un double",
        "manivelle",
        "une manivelle",
        "no",
        "joint",
        "cas",
        "même",
        "même point pièces",
        "oscille (puis fait un tour complet)",
        "oscille (pivot)",
        "limite",
        "tour complet",
        "double balancier qui tourne",
        "de la loi",
    ],
)
def test_a_piece_that_tells_too_little_is_no_choice(text):
    values = read_choice(text, JOINTS).values
    assert values == () or (text, values) == ("même point pièces", ("bodies",))


@at_once(WITH_CHOICES, WITH_CHOICES[::6])
def test_no_piece_of_a_label_reads_as_another_choice(course, names):
    """Every run of words of every label of the course, with the others' words dropped or exchanged."""
    rng, tried = random.Random(5), set()
    for name in names:
        for variant in course[name].variants(range(12), "fr"):
            for part in (p for p in variant.parts if p.kind == "choice" and (name, p.id) not in tried):
                tried.add((name, part.id))
                known = variant.labels(part)
                for key, labels in known.items():
                    for label in labels:
                        pieces = label.split()
                        runs = [
                            pieces[a:b] for a in range(len(pieces)) for b in range(a + 1, len(pieces) + 1)
                        ]
                        for run in rng.sample(runs, min(len(runs), 25)):
                            text = " ".join(run)
                            found = read_choice(text, known).values
                            if found in ((), (key,)) or {"un", "une", "one", "deux", "two"} & {*run}:
                                continue  # a number may be that of another label
                            own = {
                                w.casefold()
                                for s in (found[0], *known[found[0]])
                                for w in s.replace("-", " ").split()
                            }
                            assert all(
                                w.strip(",.:()").casefold() in {o.strip(",.:()") for o in own} for w in run
                            ), (text, key, found)
    assert len(tried) > 40 * len(names) / len(WITH_CHOICES)


def test_a_head_of_two_choices_chooses_neither():
    assert read_choice("none", {"p": ("none, ever",), "q": ("none (yet)",)}).code == "two_values"


@each_row(
    ("text", "labels"),
    [
        ("A_B", {"a-b": ["one way"], "a b": ["another"]}),  # by their keys
        ("same", {"p": ["same"], "q": ["same"]}),  # by their labels
        ("none", {"p": ["none, ever"], "q": ["none (yet)"]}),  # by what these begin with
        (
            "pivot",
            {"p": ["liaison pivot"], "q": ["pivot joint"], "none": ["aucune"]},
        ),  # but for a common noun
        ("-1", {"p": ["$w = -1$"], "q": ["$v = -1$"], "zero": ["$w = 0$"]}),  # by a value
        ("2", {"p": ["class II"], "q": ["class III"], "two": ["w = 2"]}),  # by a number and by a value
        ("a two", {"p": ["a", "one"], "q": ["two"]}),  # by an article that is a label
        ("double balancier", {"p": ["double balancier qui tourne"], "q": ["double balancier qui oscille"]}),
        ("same (r2 < r1)", {"p": ["same"], "q": ["same"], "other": ["another"]}),  # before a remark
    ],
)
def test_what_two_choices_are_called_chooses_neither_by_whatever_way_it_is_read(text, labels):
    """Not even the first of them: a person looks."""
    for choices in (labels, dict(reversed(labels.items()))):
        assert read_choice(text, choices).values == ()


@each_row("name", ["serial_joints", "parallel_joints"])
def test_a_joint_is_known_by_each_name_that_a_graph_takes_for_it(name):
    """In both languages, whatever the language of the sheet."""
    course = coursework.open_course()
    for lang in ("fr", "en"):
        variant = course[name].variant(0, lang, parts=["equivalent"])
        (part,) = variant.parts
        for language in ("fr", "en"):
            for case, names in words(language)["graph"]["kinds"].items():
                for joint in names if case in part.choices else ():
                    assert read(variant, part, joint).values == (case,), (lang, joint)
