"""On a sheet with letters a choice is read by letter, place, words, and a tick; what says two things is not
read."""

from sweeps import whole_course
from tables import each_row

from coursework.parsing.choices import read_choice

GUIDE = {
    "rotates": ("fait un tour complet", "makes a full turn"),
    "oscillates": ("oscille", "it oscillates"),
    "none": ("aucune", "none"),
}
LETTERS = {"rotates": "a", "oscillates": "b", "none": "c"}
CLASSES = {"II": ("classe II", "class II"), "III": ("classe III", "class III"), "none": ("aucune", "none")}
COUNTED = {"zero": ("0",), "three": ("3",), "one": ("1",)}
BARS = {
    "two_cranks": ("deux manivelles", "two cranks"),
    "both": ("une manivelle et un balancier", "a crank and a rocker"),
    "two_rockers": ("deux balanciers", "two rockers"),
}
NATURES = {
    "helical": ("un mouvement hélicoïdal", "mouvement hélicoïdal", "a helical motion", "helical motion"),
    "rotation": ("une rotation", "rotation", "a rotation", "rotation"),
    "translation": ("une translation", "translation", "a translation", "translation"),
}


def lettered(choices):
    return dict(zip(choices, "abc", strict=True))


@each_row(
    "text",
    [
        "b",
        "B",
        "(b)",
        "b)",
        "b.",
        "[b]",
        " b ",
        "réponse b",
        "Réponse : b",
        "answer B",
        "option b)",
        "la réponse b",
        "c'est la b",
        "2",
        "2.",
        "(2)",
        "2)",
        2,
        "2.0",
        "n°2",
        "réponse 2",
        "answer 2",
        "b (it oscillates)",
        "b) oscille",
        "b: oscille",
        "b - oscille",
        "b oscille",
        "oscille (b)",
        "oscille, b",
        "b (r2 < r1)",
        "oscille",
        "it oscillates",
        "oscillates",
        "2) oscille",
        "1) oscille",
        "☐ a ☒ b ☐ c",
        "[ ] a [x] b",
        "[x] b",
        "b [x]",
        "a [ ] b [x] c [ ]",
        "☐ a) fait un tour complet ☒ b) oscille",
        "a b[x] c",
        "a [x]b c",
        "a\nb [x]\nc",
        "[ ] a\n[X] b\n[ ] c",
        "( ) a) fait un tour complet (x) b) oscille",
        "✓ b",
    ],
)
def test_letter_place_words_and_tick_are_read(text):
    assert read_choice(text, GUIDE, LETTERS).values == ("oscillates",)


@each_row(
    ("text", "code"),
    [
        *[
            (s, "two_values")
            for s in ("a) oscille", "a oscille", "a (it oscillates)", "oscille (a)", "b, c", "b c")
        ],
        *[(s, "two_values") for s in ("☒ a ☒ b", "[x] a [x] b [ ] c", "[x] b c")],
        *[
            (s, "not_a_choice")
            for s in ("d", "0", "4", "II", "b because", "b ou c", "aa", "a [x] b", "a b [x] c", "[x]")
        ],
        *[(s, "not_a_choice") for s in ("☐ a ☐ b", "b (none, r2 < r1)", "-2", "2,5", True, 2.0)],
    ],
)
def test_what_says_two_things_or_none_waits_for_a_person(text, code):
    reading = read_choice(text, GUIDE, LETTERS)
    assert (reading.status, reading.code, reading.values) == ("unreadable", code, ())


@each_row(
    ("choices", "text", "key"),
    [
        *[(CLASSES, s, "II") for s in ("2", "II", "class 2", "a", "a) II", "classe II (a)")],
        *[(CLASSES, s, "III") for s in ("3", "III", "b", "b) III")],
        *[(COUNTED, s, "three") for s in ("3", "b", "three")],
        *[(COUNTED, s, "one") for s in ("1", "c")],
        *[
            (NATURES, s, "rotation")
            for s in ("2", "b", "a rotation", "A rotation", "une rotation", "b) rotation")
        ],
        *[(BARS, s, "both") for s in ("b", "a crank and a rocker")],
    ],
)
def test_a_number_that_labels_begin_with_keeps_its_meaning(choices, text, key):
    assert read_choice(text, choices, lettered(choices)).values == (key,)


@each_row(
    ("choices", "text"),
    [
        (CLASSES, "1"),
        (CLASSES, "4"),
        (COUNTED, "2"),
        (BARS, "2"),
        (BARS, "1"),
        (BARS, "3"),
        (CLASSES, "b) II"),
        (NATURES, "a) rotation"),
        (NATURES, "a: rotation"),
    ],
)
def test_a_number_or_a_letter_that_could_be_two_things_is_not_read(choices, text):
    assert read_choice(text, choices, lettered(choices)).status == "unreadable"


def test_a_label_of_one_letter_that_is_not_its_own_is_not_read():
    points = {"C": ("C",), "A": ("A",), "B": ("B",)}
    assert read_choice("B", points, lettered(points)).code == "two_values"
    assert read_choice("B", points, {"A": "a", "B": "b", "C": "c"}).values == ("B",)


@each_row(
    "text",
    ["it oscillates (not c)", "oscille (c)", "b) oscille (c is wrong)", "b (oscille) (c)", "b (not c)"],
)
def test_a_letter_in_a_remark_that_is_not_its_own_is_not_passed_over(text):
    assert read_choice(text, GUIDE, LETTERS).status == "unreadable"


@each_row("text", ["a) same", "b) same", "same (a)", "b (same)"])
def test_a_letter_does_not_choose_among_choices_of_one_label(text):
    choices = {"p": ("same",), "q": ("same",), "other": ("another",)}
    assert read_choice(text, choices, lettered(choices)).code == "two_values"


@each_row("text", ["b", "B)", "(b)", "2", "2.", "réponse b", "☐ a ☒ b", "b [x]"])
def test_on_a_sheet_without_letters_none_is_read(text):
    assert read_choice(text, GUIDE).status == "unreadable"


@whole_course
def test_whatever_was_read_without_letters_is_read_alike_with_them_or_waits():
    """Over the course, in both languages: every code, label, head and beginning; letters never make another
    of it."""
    import coursework
    from coursework.parsing.labels import head

    course, tried = coursework.open_course(), 0
    for name in course.names:
        for lang in ("fr", "en"):
            for variant in course[name].variants(range(4), lang):
                for part in (p for p in variant.parts if p.choices):
                    known, letters = variant.labels(part), variant.letters(part)
                    for key, labels in known.items():
                        said = {key, *labels, *map(head, labels), *(" ".join(s.split()[:3]) for s in labels)}
                        for text in said:
                            before = read_choice(text, known).values
                            now = read_choice(text, known, letters).values
                            assert now == before, (name, part.id, text)
                            tried += 1
                        marked = variant.called(part, key)
                        assert read_choice(marked, known, letters).values == (key,), (name, part.id, marked)
                        assert read_choice(letters[key].upper(), known, letters).values == (key,)
    assert tried > 3000
